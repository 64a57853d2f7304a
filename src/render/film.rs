//! Clips as frames: what each shows, and for how long.

use super::cell::{Cell, Shows};
use super::error::Error;
use super::grid::Grid;
use super::still::Which;
use super::view::{Style, View};
use super::{Background, Session};
use crate::asset::Asset;
use crate::sample::Fps;
use image::RgbaImage;
use std::f64::consts::TAU;

/// The most frames that moving pictures may have.
pub const MOST_FRAMES: u64 = 100_000;
/// The longest that a frame may be shown, seconds: formats count in 16 bits.
const LONGEST: f64 = 30.0;
/// How long a turntable takes for a turn where no clip says, seconds.
const TURN: f64 = 4.0;
/// Viewers show what is meant to last less than this for longer, seconds.
const SHORTEST: f64 = 0.02;
/// Pixels by which the last pose may miss the first for nobody to see it.
const MEETING: f64 = 0.5;

/// Moving pictures of clips, ready to be drawn frame by frame.
#[derive(Clone, Debug)]
pub struct Film {
    view: View,
    grid: Grid,
    clips: Vec<Which>,
    plan: Plan,
    turntable: bool,
}

/// When frames begin, and what times of the clip they show.
#[derive(Clone, Debug, PartialEq)]
struct Plan {
    frames: Vec<Frame>,
    seconds: f64,
    closed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    /// Seconds from the film's start.
    begins: f64,
    /// The time of the clip that it shows, seconds.
    shows: f64,
}

impl Film {
    /// Number of frames; at least one.
    pub fn frames(&self) -> usize {
        self.plan.frames.len()
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        self.grid.size
    }

    /// How long it lasts: as long as the longest of its clips.
    pub fn seconds(&self) -> f64 {
        self.plan.seconds
    }

    /// Whether the last pose meets the first, so that the film can run for ever.
    pub fn closed(&self) -> bool {
        self.plan.closed
    }

    /// Whether its pictures have an alpha channel.
    pub fn transparent(&self) -> bool {
        self.view.style.background == Background::Transparent
    }

    /// How long each frame is shown, in whole units of which a second has so
    /// many; together they are the film's length, rounded once.
    pub fn delays(&self, per_second: u32) -> Vec<u32> {
        self.plan.delays(per_second)
    }
}

impl Session {
    /// Makes moving pictures ready of some clips next to each other, in step:
    /// `fps` frames a second over the longest of them, a shorter one rests at its
    /// end. A turntable turns once meanwhile.
    pub fn film(
        &mut self,
        asset: &mut Asset,
        clips: &[Which],
        style: &Style,
        fps: Fps,
        turntable: bool,
    ) -> Result<Film, Error> {
        let grid = Grid::beside(clips.len() as u32, style.size)?;
        let view = self.view(asset, clips, style, turntable)?;
        let moving = self.longest(clips);
        let (seconds, closed) = match (moving > 0.0, turntable) {
            (true, _) => (moving, self.closes(asset, clips, &view)?),
            (false, true) => (TURN, true),
            (false, false) => return Err(Error::NothingMoves),
        };
        let plan = Plan::new(seconds, fps, closed)?;
        Ok(Film { view, grid, clips: clips.to_vec(), plan, turntable })
    }

    /// Draws a frame of a film, which must be one of this session's.
    pub fn frame(&mut self, asset: &mut Asset, film: &Film, index: usize) -> Result<RgbaImage, Error> {
        let t = film.plan.frames[index].shows;
        let turn = if film.turntable { TAU * t / film.plan.seconds } else { 0.0 };
        let several = film.clips.len() > 1;
        let cell = |&clip: &Which| Cell {
            clip,
            shows: Shows::Moment { t, turn },
            words: [several.then(|| self.title(clip)), None],
        };
        let cells: Vec<Cell> = film.clips.iter().map(cell).collect();
        Ok(self.cells(asset, &film.view, &film.grid, &cells)?.0)
    }

    /// Whether all clips end together where they began, as the picture shows it.
    fn closes(&mut self, asset: &mut Asset, clips: &[Which], view: &View) -> Result<bool, Error> {
        let longest = self.longest(clips);
        for &clip in clips {
            if longest - self.duration(clip) > SHORTEST {
                return Ok(false);
            }
            let mut seen = |t: f64| {
                let pose = self.pose(asset, clip, t)?;
                let frame = view.frame(&pose, 0.0);
                let place = |corner| frame.on_picture(corner, view.style.size);
                Ok::<Vec<_>, Error>(pose.corners(&self.model).map(place).collect())
            };
            let (first, last) = (seen(0.0)?, seen(longest)?);
            if !first.into_iter().zip(last).all(|(first, last)| meet(first, last)) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// Whether two places on the picture are the same to the eye; those behind the
/// camera are.
fn meet(a: Option<(f64, f64)>, b: Option<(f64, f64)>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => libm::hypot(a.0 - b.0, a.1 - b.1) < MEETING,
        (a, b) => a == b,
    }
}

impl Plan {
    /// A frame every `1/fps` seconds; the last one stays until the end. What is
    /// not closed ends with its last pose, for half of the last frame's time.
    fn new(seconds: f64, fps: Fps, closed: bool) -> Result<Plan, Error> {
        let interval = fps.interval();
        if interval > LONGEST {
            return Err(Error::Rate(fps));
        }
        // A hair more, as 10 s at 25 frames a second are 250 of them.
        let count = (seconds / interval * (1.0 + 1e-9)).floor().max(1.0);
        if count > MOST_FRAMES as f64 {
            return Err(Error::Frames(count as u64));
        }
        let frame = |i: u64| Frame { begins: fps.time(i), shows: fps.time(i) };
        let mut frames: Vec<Frame> = (0..count as u64).map(frame).collect();
        if let (false, Some(last)) = (closed, frames.last_mut()) {
            let half = (seconds - last.begins) / 2.0;
            if half >= SHORTEST - 1e-9 {
                frames.push(Frame { begins: seconds - half, shows: seconds });
            } else {
                last.shows = seconds;
            }
        }
        Ok(Plan { frames, seconds, closed })
    }

    fn delays(&self, per_second: u32) -> Vec<u32> {
        let unit = |seconds: f64| (seconds * f64::from(per_second)).round() as u32;
        let begins = self.frames.iter().map(|frame| unit(frame.begins));
        let ends = self.frames.iter().skip(1).map(|frame| unit(frame.begins)).chain([unit(self.seconds)]);
        begins.zip(ends).map(|(begin, end)| end - begin).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(seconds: f64, fps: &str, closed: bool) -> Plan {
        Plan::new(seconds, fps.parse().unwrap(), closed).unwrap()
    }

    #[test]
    fn delays_add_up_to_the_duration() {
        for fps in ["25", "30", "23.976", "12", "7", "1/3"] {
            for seconds in [10.0, 3.7777, 0.5, 0.01, 61.0 / 7.0] {
                for closed in [true, false] {
                    let plan = plan(seconds, fps, closed);
                    for per_second in [100, 1000] {
                        let delays = plan.delays(per_second);
                        let sum: u32 = delays.iter().sum();
                        assert_eq!(
                            sum,
                            (seconds * f64::from(per_second)).round() as u32,
                            "{seconds} s, {fps}"
                        );
                        assert!(delays.iter().all(|d| *d > 0 && *d < 65536), "{delays:?}");
                    }
                    let worst = plan.delays(100).into_iter().min().unwrap();
                    assert!(worst >= 2 || seconds < 0.02, "{seconds} s, {fps}: {worst}");
                }
            }
        }
        assert_eq!(plan(0.2, "30", true).delays(100), [3, 4, 3, 3, 4, 3]);
    }

    #[test]
    fn open_films_end_with_the_last_pose_and_closed_ones_before_it() {
        let shows = |plan: Plan| plan.frames.iter().map(|f| f.shows).collect::<Vec<_>>();
        assert_eq!(shows(plan(0.2, "10", true)), [0.0, 0.1]);
        assert_eq!(shows(plan(0.2, "10", false)), [0.0, 0.1, 0.2]);
        assert_eq!(plan(0.2, "10", false).delays(100), [10, 5, 5]);
        // Too short to be halved.
        assert_eq!(shows(plan(0.06, "50", false)), [0.0, 0.02, 0.06]);
        assert_eq!(shows(plan(10.0, "25", true)).len(), 250);
    }

    #[test]
    fn too_many_and_too_slow_frames_are_refused() {
        let film = |seconds, fps: &str| Plan::new(seconds, fps.parse().unwrap(), true);
        assert!(matches!(film(1e6, "25"), Err(Error::Frames(25_000_000))));
        assert!(matches!(film(1e6, "1/31"), Err(Error::Rate(_))));
        assert!(matches!(film(f64::MAX, "1"), Err(Error::Frames(_))));
    }
}

//! Numbers by which to choose a scheme: how fast, how smooth, how far astray, how large.
//!
//! Derivatives come from running the curve's own formula on [`Jet`]s, never from
//! differences of samples. What each figure means and how exact it is:
//! docs/math/compare.md.

mod chord;
mod keys;
mod samples;

#[cfg(test)]
mod tests;

pub use keys::{KeysNeeded, MAX_STEP, MOST_KEYS, TOLERANCES};

use crate::clip::{Clip, Through};
use crate::curve::{Arc, Ends, Motion, NotClosed, Piece, Scheme};
use crate::math::{Jet, Quat, Vec3};
use crate::reduce::is_corner;
use chord::Chord;
use rayon::prelude::*;
use samples::Samples;
use serde::Serialize;

/// What is known of one motion. Degrees and seconds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Figures {
    /// Angular speed, degrees a second.
    pub speed: Spread,
    /// Length of the angular acceleration, degrees a second squared.
    pub acceleration: Spread,
    /// What jumps at keys.
    pub jumps: Jumps,
    /// How much further from one key of its segment the motion gets than the other key
    /// is, degrees.
    pub overshoot: Peak,
    /// How far the motion gets from the arc between the two keys of its segment, degrees.
    pub stray: Peak,
    /// Keys that LINEAR playback needs, one for each of [`TOLERANCES`].
    pub keys: [KeysNeeded; TOLERANCES.len()],
}

/// How large something is over a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Where it is largest.
    pub largest: Peak,
    /// Root of the mean square over time.
    pub rms: f64,
}

/// A largest value and its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// How large.
    pub value: f64,
    /// When, seconds since the first key.
    pub time: f64,
}

/// The largest jumps at keys: at those with a segment on either side, and where a loop
/// closes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Jumps {
    /// Of the rotation itself, degrees.
    pub rotation: Peak,
    /// Of the angular velocity, degrees a second.
    pub velocity: Peak,
    /// Of the angular acceleration, degrees a second squared.
    pub acceleration: Peak,
}

/// What is known of one box, by scheme.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoxFigures {
    /// The box, from 1; 1 for a body.
    #[serde(rename = "box")]
    pub index: usize,
    /// In the order of the schemes.
    pub methods: Vec<Method>,
}

/// What is known of one box by one scheme.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Method {
    /// The scheme's name; none for control rotations, which have none.
    pub scheme: Option<&'static str>,
    /// What is known of it.
    #[serde(flatten)]
    pub figures: Figures,
}

/// The figures of a clip's boxes, of `only` one (from 0) or of all, by some schemes.
/// Control rotations need neither schemes nor ends. Keys are counted as long as there are
/// no more than [`MOST_KEYS`] in all, and estimated after that.
///
/// Fails where other schemes than slerp are to close ends that do not meet.
pub fn clip(
    clip: &Clip,
    schemes: &[Scheme],
    ends: Ends,
    only: Option<usize>,
) -> Result<Vec<BoxFigures>, NotClosed> {
    let controls = clip.through == Through::Controls;
    if !controls && schemes.iter().any(|&scheme| scheme != Scheme::Slerp) {
        ends.accept(clip)?;
    }
    let schemes: Vec<Option<Scheme>> =
        if controls { vec![None] } else { schemes.iter().copied().map(Some).collect() };
    let tracks = (0..clip.tracks.len()).filter(|i| only.is_none_or(|only| only == *i));
    let rows: Vec<Row> = tracks
        .flat_map(|track| schemes.iter().map(move |&scheme| Row { clip, track, scheme, ends }))
        .collect();
    let mut figures: Vec<Figures> = rows.par_iter().map(Row::estimated).collect();
    let counted = keys::affordable(figures.iter().map(|figures| &figures.keys));
    let count =
        |(figures, row): (&mut Figures, &Row)| keys::count(&mut figures.keys, counted, || row.motion());
    figures.par_iter_mut().zip(&rows).for_each(count);
    let mut boxes: Vec<BoxFigures> = Vec::new();
    for (Row { track, scheme, .. }, figures) in rows.iter().zip(figures) {
        let (index, method) = (track + 1, Method { scheme: scheme.map(Scheme::name), figures });
        match boxes.last_mut().filter(|last| last.index == index) {
            Some(same) => same.methods.push(method),
            None => boxes.push(BoxFigures { index, methods: vec![method] }),
        }
    }
    Ok(boxes)
}

/// What has figures of its own: a track by a scheme, or along its control rotations.
struct Row<'a> {
    clip: &'a Clip,
    track: usize,
    scheme: Option<Scheme>,
    ends: Ends,
}

impl Row<'_> {
    fn motion(&self) -> Motion<'_> {
        let (times, rotations) = (&self.clip.times, &self.clip.tracks[self.track]);
        match self.scheme {
            Some(scheme) => Motion::new(times, rotations, scheme, self.ends),
            None => Motion::through_controls(times, rotations),
        }
    }

    fn estimated(&self) -> Figures {
        let rotations = &self.clip.tracks[self.track];
        if self.scheme.is_some() {
            return estimated(&self.motion(), rotations, self.ends == Ends::Closed);
        }
        let keys: Vec<Quat> = rotations.iter().copied().step_by(3).collect();
        estimated(&self.motion(), &keys, false)
    }
}

/// The figures of a motion. `keys` are the rotations at its times, with continuous signs;
/// a motion that `loops` also meets itself where its end runs into its start.
pub fn motion(motion: Motion, keys: &[Quat], loops: bool) -> Figures {
    let mut figures = estimated(&motion, keys, loops);
    let counted = keys::affordable([&figures.keys]);
    keys::count(&mut figures.keys, counted, || motion);
    figures
}

/// The figures of a motion, keys not counted yet.
fn estimated(motion: &Motion, keys: &[Quat], loops: bool) -> Figures {
    let pieces = pieces(motion);
    let times = motion.times();
    // Closed ends move the last key.
    let end = if loops { motion.at(times[times.len() - 1]) } else { keys[keys.len() - 1] };
    let key = |i: usize| if i + 1 == keys.len() { end } else { keys[i] };
    let chord = |piece: &Piece| {
        let after = times.partition_point(|&t| t <= piece.start).clamp(1, times.len() - 1);
        Chord::new(key(after - 1), key(after), piece.at(0.0))
    };
    let mut totals = Totals::new(times[0]);
    for (i, piece) in pieces.iter().enumerate() {
        if i > 0 && is_corner(&pieces[i - 1], piece) {
            totals.needed.stop();
        }
        totals.add(piece, &chord(piece));
    }
    let [speed, acceleration, overshoot, stray] = totals.peaks;
    let [speed_rms, acceleration_rms] = totals.squares.map(|square| (square / totals.seconds).sqrt());
    Figures {
        speed: Spread { largest: speed, rms: speed_rms },
        acceleration: Spread { largest: acceleration, rms: acceleration_rms },
        jumps: jumps(&pieces, loops),
        overshoot,
        stray,
        keys: totals.needed.needed(),
    }
}

/// What adds up along a motion.
struct Totals {
    /// The largest of all [`measures`].
    peaks: [Peak; 4],
    /// Integrals of the squares of speed and acceleration.
    squares: [f64; 2],
    seconds: f64,
    needed: keys::Estimate,
}

impl Totals {
    fn new(start: f64) -> Totals {
        let peaks = [Peak { value: 0.0, time: start }; 4];
        let needed = keys::Estimate::default();
        Totals { peaks, squares: [0.0; 2], seconds: 0.0, needed }
    }

    fn add(&mut self, piece: &Piece, chord: &Chord) {
        let (measure, seconds) = (|u: f64| measures(piece, chord, u), piece.duration());
        let samples = Samples::of(measure);
        samples.raise(&mut self.peaks, measure, |u| time(piece, u));
        for (which, square) in self.squares.iter_mut().enumerate() {
            *square += seconds * samples.integral(|values| values[which] * values[which]);
        }
        self.needed.add(|f| seconds * samples.integral(|&[speed, acceleration, ..]| f(speed, acceleration)));
        self.seconds += seconds;
    }
}

/// The pieces of a motion but for the ramp that stands for a jump: a jump has no speed.
fn pieces(motion: &Motion) -> Vec<Piece> {
    let times = motion.times();
    let (mut t, last) = (times[0], times[times.len() - 1]);
    let mut pieces: Vec<Piece> = Vec::with_capacity(times.len());
    while t < last {
        let piece = motion.piece_at(t);
        t = piece.end;
        if motion.ramp() != Some(piece.start) {
            pieces.push(piece);
        }
    }
    pieces
}

/// When a piece is at a place.
fn time(piece: &Piece, u: f64) -> f64 {
    piece.start + u * piece.duration()
}

/// A motion at a time: radians and seconds, in the body's frame.
struct State {
    rotation: Quat,
    velocity: Vec3,
    acceleration: Vec3,
}

fn state(piece: &Piece, u: f64) -> State {
    let (jet, rate) = (piece.at(Jet::<f64>::variable(u)), 1.0 / piece.duration());
    // The jet's are half of the angular ones, by u.
    State {
        rotation: jet.value(),
        velocity: jet.half_velocity() * (2.0 * rate),
        acceleration: jet.half_acceleration() * (2.0 * rate * rate),
    }
}

/// Speed, acceleration, overshoot and stray, degrees and seconds.
fn measures(piece: &Piece, chord: &Chord, u: f64) -> [f64; 4] {
    let State { rotation, velocity, acceleration } = state(piece, u);
    let [overshoot, stray] = chord.measure(rotation);
    [velocity.length(), acceleration.length(), overshoot, stray].map(f64::to_degrees)
}

fn jumps(pieces: &[Piece], loops: bool) -> Jumps {
    let (first, last) = (&pieces[0], &pieces[pieces.len() - 1]);
    let inner = pieces.windows(2).map(|pair| (&pair[0], &pair[1], pair[1].start));
    let seam = loops.then_some((last, first, last.end));
    let mut largest = [Peak { value: 0.0, time: first.start }; 3];
    for (before, after, time) in inner.chain(seam) {
        let (a, b) = (state(before, 1.0), state(after, 0.0));
        let rotation = a.rotation.angle_to(b.rotation);
        let (velocity, acceleration) = (b.velocity - a.velocity, b.acceleration - a.acceleration);
        let found = [rotation, velocity.length(), acceleration.length()];
        for (largest, found) in largest.iter_mut().zip(found) {
            largest.rise(found.to_degrees(), time);
        }
    }
    let [rotation, velocity, acceleration] = largest;
    Jumps { rotation, velocity, acceleration }
}

impl Peak {
    /// Takes a value that is larger.
    fn rise(&mut self, value: f64, time: f64) {
        if value > self.value {
            *self = Peak { value, time };
        }
    }
}

//! The path on the common clock, and how the root turns on its way.

use super::ground::merged;
use super::{Error, Move, Orient, Shape, Turn};
use crate::curve::{Ends, Motion, Scheme};
use crate::math::Quat;
use crate::orient::{self, Attitude, Frame, Level, Levelled, Tangent, Upright};
use crate::path::{self, Path};
use crate::read::PathFile;
use crate::sample::Travel;
use glam::DVec3;

/// The path, and when it begins on the common clock.
pub(super) struct Way {
    pub(super) path: Path,
    pub(super) start: f64,
    /// Orientation by keys: their times on the common clock, and they themselves.
    pub(super) keys: (Vec<f64>, Vec<Quat>),
    /// The file gives some of them.
    pub(super) any_given: bool,
    /// Turns the model to fit +Z forward and +Y up.
    model: Quat,
    /// The path's knots on the common clock.
    pub(super) knots: Vec<f64>,
    /// When its velocity jumps, its start and end included.
    jumps: Vec<f64>,
    /// The stretches before corners in which a file turns.
    ramps: Vec<(f64, f64)>,
}

/// How long before a corner the turn begins that a file shows for its jump, seconds.
const RAMP: f64 = 1e-3;

/// In how many pieces a line is drawn from key point to key point.
const LINE_STEPS: u32 = 32;

impl Way {
    /// The path of a file that begins at `start` on the clock; one without times lasts as
    /// long as the rotation keys, up to `rest`, where there are any.
    pub(super) fn new(file: &PathFile, start: f64, rest: Option<f64>, shape: &Shape) -> Result<Way, Error> {
        let frame = shape.frame.or(file.frame).unwrap_or(Frame::Gltf);
        let points: Vec<DVec3> = file.points.iter().map(|&p| frame.vector_to_gltf(p.into())).collect();
        let scaled = |t: f64| t / shape.time_scale;
        let times: Option<Vec<f64>> =
            file.times.as_ref().map(|times| times.iter().copied().map(scaled).collect());
        let unsaid = file.times.is_none() && shape.speed.is_none();
        // Asking for a speed wins over the header's duration.
        let said = file.duration.filter(|_| shape.speed.is_none());
        let duration = said.map(scaled).or(rest.filter(|_| unsaid));
        let options = path::Options {
            ends: shape.path_ends,
            timing: shape.timing,
            ease: shape.ease,
            duration,
            speed: shape.speed.map(|speed| speed * shape.time_scale),
        };
        let mut path = Path::new(file.kind, &points, times.as_deref(), &options)?;
        if unsaid && duration.is_none() && shape.time_scale != 1.0 {
            let duration = Some(scaled(path.duration()));
            path = Path::new(file.kind, &points, None, &path::Options { duration, ..options })?;
        }
        let given: Vec<Option<Quat>> =
            file.orientations.iter().map(|given| given.map(|q| frame.rotation_to_gltf(q))).collect();
        let model = orient::model_frame(shape.model_forward, shape.model_up)?;
        let on_clock = |times: &[f64]| -> Vec<f64> { times.iter().map(|t| start + t).collect() };
        let keys = orient::keyed(&path, &given, shape.level).into_iter().map(|q| q * model);
        let keys = apart(on_clock(path.key_times()).into_iter().zip(keys));
        // At a corner the object turns at once; a channel can only turn quickly.
        let ramps = path.corners().iter().map(|t| t - RAMP).filter(|&t| t > 0.0);
        let times = path.key_times().iter().chain(path.jumps()).chain(path.corners()).copied().chain(ramps);
        let knots = merged(times.map(|t| start + t));
        let end = path.duration();
        let jumps = path.jumps().iter().copied().chain([0.0, end]).map(|t| start + t).filter(|&t| t > 0.0);
        let ramp = |&t: &f64| (start + (t - RAMP).max(0.0), start + t);
        let (jumps, ramps) = (merged(jumps), path.corners().iter().map(ramp).collect());
        let any_given = given.iter().any(Option::is_some);
        Ok(Way { path, start, keys, any_given, model, knots, jumps, ramps })
    }

    pub(super) fn end(&self) -> f64 {
        self.start + self.path.duration()
    }

    /// The place at a time of the clock.
    pub(super) fn place(&self, t: f64) -> DVec3 {
        self.path.position(t - self.start)
    }

    /// Places to draw a line through, with times as shares of the path's.
    pub(super) fn trace(&self) -> Vec<(f64, DVec3)> {
        let duration = self.path.duration();
        let knots = self.path.key_times().windows(2).filter(|pair| pair[1] > pair[0]);
        let steps = knots.flat_map(|pair| {
            (0..LINE_STEPS).map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(LINE_STEPS))
        });
        steps.chain([duration]).map(|t| (t / duration, self.path.position(t))).collect()
    }

    /// How the root turns by keys.
    pub(super) fn keyed(&self, shape: &Shape, scheme: Scheme) -> Motion<'_> {
        let (times, keys) = &self.keys;
        Motion::new(times, keys, scheme, key_ends(shape.ends)).with_tcb(shape.tcb)
    }

    /// How the root turns, if it does.
    pub(super) fn attitude<'a>(&'a self, orient: Orient, shape: &Shape, scheme: Scheme) -> Option<Move<'a>> {
        match orient {
            Orient::None => None,
            Orient::Keyed => Some(Move::Keys(self.keyed(shape, scheme))),
            Orient::Tangent => Some(self.facing(Tangent::new(&self.path), shape.level)),
            Orient::Upright => Some(self.facing(Upright::new(&self.path, shape.bank), shape.level)),
        }
    }

    /// A time of the clock as one of the path. From the float32 time nearest to a corner on,
    /// which may lie just before it, the turn is done.
    fn past_corner(&self, t: f64) -> f64 {
        let corners = self.path.corners();
        let next = corners.partition_point(|corner| self.start + corner < t);
        let here = |corner: &&f64| f64::from((self.start + **corner) as f32) <= t;
        corners.get(next).filter(here).copied().unwrap_or(t - self.start)
    }

    fn facing<'a>(&'a self, attitude: impl Attitude + 'a, level: Level) -> Move<'a> {
        let turn = |at: Box<dyn Attitude + 'a>| -> Move<'a> {
            let at = Box::new(move |t| at.at(self.past_corner(t)) * self.model);
            Move::Attitude(Turn { at, knots: &self.knots, ramps: &self.ramps })
        };
        if level == Level::default() {
            turn(Box::new(attitude))
        } else {
            turn(Box::new(Levelled::new(attitude, level)))
        }
    }
}

impl Travel for &Way {
    fn at(&self, t: f64) -> DVec3 {
        self.place(t)
    }

    fn acceleration_bound(&self, from: f64, to: f64) -> f64 {
        if to <= self.start || from >= self.end() {
            return 0.0;
        }
        self.path.acceleration_bound(from - self.start, to - self.start)
    }

    fn speed_bound(&self, from: f64, to: f64) -> f64 {
        self.path.speed_bound(from - self.start, to - self.start)
    }

    fn cubic(&self, from: f64, to: f64) -> Option<[DVec3; 4]> {
        let (start, end) = (self.start, self.end());
        if to <= start || from >= end {
            return Some([self.place(from); 4]);
        }
        if from < start || to > end {
            return None;
        }
        self.path.cubic(from - start, to - start)
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn jumps(&self) -> &[f64] {
        &self.jumps
    }
}

/// What orientation by keys does at its ends: the path's own ends close it; its keys need
/// not be equal there.
pub(super) fn key_ends(ends: Ends) -> Ends {
    if ends == Ends::Closed { Ends::Natural } else { ends }
}

/// Keys at times that float32 can tell apart: of several at one time the last counts,
/// which faces the way on.
fn apart(keys: impl Iterator<Item = (f64, Quat)>) -> (Vec<f64>, Vec<Quat>) {
    let mut kept: Vec<(f64, Quat)> = Vec::new();
    for (time, key) in keys {
        match kept.last_mut() {
            Some(last) if last.0 as f32 == time as f32 => last.1 = key,
            _ => kept.push((time, key)),
        }
    }
    kept.into_iter().unzip()
}

//! Landing: pitch and roll taken away towards an end of the course.

use super::facing::{Facing, tilt, turned};
use super::passage::{Passage, passages};
use super::{Attitude, Signs, Tangent, smoothstep, wrapped};
use crate::math::{Quat, Vec3};
use glam::DVec3;

/// Forward nearer to the vertical than this, radians, has no heading.
const NO_HEADING: f64 = std::f64::consts::PI / 180.0;

/// How many keys or segments are levelled, counted from either end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Level {
    /// From the start.
    pub start: usize,
    /// Up to the end.
    pub end: usize,
}

/// Heading of a direction, radians from +Z towards +X.
fn heading(forward: DVec3) -> f64 {
    forward.x.atan2(forward.z)
}

/// The level rotation of a heading.
fn yaw(heading: f64) -> Quat {
    Quat::exp(Vec3::new(0.0, heading / 2.0, 0.0))
}

/// Levels the first and last keys: each keeps its heading; one whose forward is
/// vertical has that of the last key before it that is not, else +Z.
pub(super) fn level_keys(keys: &mut [Quat], level: Level) {
    let (from_start, to_end) = (level.start, keys.len().saturating_sub(level.end));
    let mut last = 0.0;
    for (i, key) in keys.iter_mut().enumerate() {
        let forward = turned(*key, DVec3::Z);
        if tilt(forward) >= NO_HEADING {
            last = heading(forward);
        }
        if i < from_start || i >= to_end {
            *key = yaw(last);
        }
    }
}

/// An attitude that is level at an end of its course.
///
/// Over the last `end` segments pitch and roll fade by smoothstep, from all of them
/// where those segments start to none at the end; over the first `start` ones the same
/// backwards. The heading stays that of the course. Where forward is within 1° of the
/// vertical there is none: the last one before it counts, else +Z; if the course leaves
/// the vertical again, the heading turns to the new one in between.
pub struct Levelled<A> {
    attitude: A,
    vertical: Vec<Passage>,
    /// Level at 0, as it was from `lift` on; as it was up to `sink`, level at the end.
    lift: f64,
    sink: f64,
    tilts: Tilts,
    signs: Signs,
}

/// Pitch and roll at the nodes where some of them is taken, signs continued from where none is.
#[derive(Default)]
struct Tilts {
    /// From a node backwards.
    lifted: Signs,
    lifts: usize,
    /// From a node on.
    sunk: Signs,
    sinks: usize,
}

impl Tilts {
    /// Pitch and roll soon after a node, with their sign.
    fn follow(&self, node: usize, tilt: Quat) -> Quat {
        match node.checked_sub(self.sinks) {
            Some(since) => self.sunk.follow(since, tilt),
            None => self.lifted.follow(self.lifts.saturating_sub(node), tilt),
        }
    }
}

impl<A: Attitude> Levelled<A> {
    /// Levels an attitude over the first and last segments between key times.
    pub fn new(attitude: A, level: Level) -> Self {
        let course = attitude.tangent().course();
        let (keys, end) = (course.key_times(), course.duration());
        let lift = if level.start == 0 { 0.0 } else { keys.get(level.start).copied().unwrap_or(end) };
        let before_last = keys.len().checked_sub(1 + level.end).and_then(|i| keys.get(i));
        let sink = if level.end == 0 { end } else { before_last.copied().unwrap_or(0.0) };
        let vertical = passages(attitude.tangent(), NO_HEADING);
        let mut levelled =
            Levelled { attitude, vertical, lift, sink, tilts: Tilts::default(), signs: Signs::default() };
        levelled.tilts = levelled.tilts();
        levelled.signs = Signs::continued(levelled.nodes(), |i| levelled.turned(levelled.time(i)));
        levelled
    }

    fn nodes(&self) -> usize {
        self.attitude.tangent().nodes()
    }

    fn time(&self, node: usize) -> f64 {
        self.attitude.tangent().node(node).0
    }

    /// The shorter way round where nothing of them is taken yet, and continued from there to
    /// either end.
    fn tilts(&self) -> Tilts {
        let node = |t: f64| self.attitude.tangent().index(t);
        let (lifts, sinks) = (node(self.lift.min(self.sink)), node(self.sink));
        let short = |i: usize| self.tilt(self.time(i)).1.aligned_to(Quat::IDENTITY);
        Tilts {
            lifted: Signs::continued(lifts + 1, |i| short(lifts - i)),
            lifts,
            sunk: Signs::continued(self.nodes() - sinks, |i| short(sinks + i)),
            sinks,
        }
    }

    /// The level rotation at a time, and what pitch and roll add to it.
    fn tilt(&self, t: f64) -> (Quat, Quat) {
        let rotation = self.attitude.at(t);
        let level = yaw(self.heading(t, turned(rotation, DVec3::Z)));
        (level, level.conjugate() * rotation)
    }

    /// The heading at a time, radians.
    fn heading(&self, t: f64, forward: DVec3) -> f64 {
        let next = self.vertical.partition_point(|passage| passage.end < t);
        match self.vertical.get(next) {
            Some(passage) if passage.start <= t => through(passage, t),
            _ => heading(forward),
        }
    }

    /// How much of pitch and roll is left at a time, 0 to 1.
    fn left(&self, t: f64) -> f64 {
        let end = self.attitude.tangent().course().duration();
        let lifted = if self.lift > 0.0 { smoothstep(t / self.lift) } else { 1.0 };
        let sinking = if self.sink < end { smoothstep((end - t) / (end - self.sink)) } else { 1.0 };
        lifted * sinking
    }

    fn turned(&self, t: f64) -> Quat {
        let left = self.left(t);
        if left == 1.0 {
            return self.attitude.at(t);
        }
        let (level, tilt) = self.tilt(t);
        let tilt = self.tilts.follow(self.attitude.tangent().index(t), tilt);
        level * Quat::exp(tilt.log() * left)
    }
}

impl<A: Attitude> Attitude for Levelled<A> {
    fn at(&self, t: f64) -> Quat {
        self.signs.follow(self.attitude.tangent().index(t), self.turned(t))
    }

    fn tangent(&self) -> &Tangent<'_> {
        self.attitude.tangent()
    }
}

/// The heading while forward is vertical.
fn through(passage: &Passage, t: f64) -> f64 {
    let of = |facing: Facing| heading(facing.forward);
    let before = passage.before.map_or(0.0, of);
    let Some(after) = passage.after.map(of) else { return before };
    let part = (t - passage.start) / (passage.end - passage.start).max(f64::MIN_POSITIVE);
    before + smoothstep(part) * wrapped(after - before)
}

//! Landing: pitch and roll taken away towards an end of the course.

use super::facing::{tilt, turned};
use super::passage::{Passage, meet_at_seam, passages};
use super::steps::{Spot, Steps};
use super::{Attitude, Course, Signs, smoothstep, wrapped};
use crate::math::{Quat, Vec3};
use glam::DVec3;
use std::ops::Range;

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
    libm::atan2(forward.x, forward.z)
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
    /// Where that is.
    parts: Vec<Part>,
}

/// Segments of which some pitch and roll is taken.
struct Part {
    segments: Range<usize>,
    /// Signs of pitch and roll: the shorter way round where nothing of them is taken yet.
    tilts: Signs,
    /// Signs of what is left: as the attitude's where nothing is taken yet.
    signs: Signs,
}

impl<A: Attitude> Levelled<A> {
    /// Levels an attitude over the first and last segments between key times.
    pub fn new(attitude: A, level: Level) -> Self {
        let course = attitude.steps().course;
        let (keys, end) = (course.key_times(), course.duration().max(0.0));
        let lift = if level.start == 0 { 0.0 } else { keys.get(level.start).copied().unwrap_or(end) };
        let before_last = keys.len().checked_sub(1 + level.end).and_then(|i| keys.get(i));
        let sink = if level.end == 0 { end } else { before_last.copied().unwrap_or(0.0) };
        let vertical = vertical(attitude.steps());
        let between = |from: f64, to: f64| attitude.steps().between(course.place(from), course.place(to));
        let (lifted, sunk) = (between(0.0, lift.min(sink)), between(sink, end));
        let mut levelled = Levelled { attitude, vertical, lift, sink, parts: Vec::new() };
        let parts = [levelled.part(lifted, true), levelled.part(sunk, false)];
        levelled.parts = parts.into_iter().flatten().collect();
        levelled
    }

    /// What is taken of some segments, if there are any, up to their end or from their start.
    fn part(&self, segments: Range<usize>, up_to_end: bool) -> Option<Part> {
        let steps = self.attitude.steps();
        let last = segments.clone().next_back()?;
        let untaken = if up_to_end { steps.spots(last).last() } else { steps.spots(segments.start).next() }?;
        let continued = |rotation: &(dyn Fn(&Spot) -> Quat + Sync), untaken: Quat| {
            let signs = Signs::continued(steps, segments.clone(), rotation);
            if up_to_end { signs.ending_as(untaken) } else { signs.starting_as(untaken) }
        };
        let tilts = continued(&|spot| self.tilt(spot).1, Quat::IDENTITY);
        let signs = continued(&|spot| self.taken(spot, &tilts), self.attitude.at_spot(&untaken));
        Some(Part { segments, tilts, signs })
    }

    /// The level rotation at a spot, and what pitch and roll add to it.
    fn tilt(&self, spot: &Spot) -> (Quat, Quat) {
        let rotation = self.attitude.at_spot(spot);
        let level = yaw(self.heading(spot.place.x, turned(rotation, DVec3::Z)));
        (level, level.conjugate() * rotation)
    }

    /// The heading at a place, radians.
    fn heading(&self, x: f64, forward: DVec3) -> f64 {
        let next = self.vertical.partition_point(|passage| passage.end < x);
        match self.vertical.get(next) {
            Some(passage) if passage.start <= x => through(self.attitude.steps().course, passage, x),
            _ => heading(forward),
        }
    }

    /// How much of pitch and roll is left at a place, 0 to 1.
    fn left(&self, x: f64) -> f64 {
        let course = self.attitude.steps().course;
        let (t, end) = (course.time(x), course.duration());
        let lifted = if self.lift > 0.0 { smoothstep(t / self.lift) } else { 1.0 };
        let sinking = if self.sink < end { smoothstep((end - t) / (end - self.sink)) } else { 1.0 };
        lifted * sinking
    }

    /// The rotation with some pitch and roll taken, its sign as it comes.
    fn taken(&self, spot: &Spot, tilts: &Signs) -> Quat {
        let left = self.left(spot.place.x);
        if left == 1.0 {
            return self.attitude.at_spot(spot);
        }
        let tilt = tilts.follow(self.attitude.steps(), spot, |spot| self.tilt(spot).1);
        yaw(self.heading(spot.place.x, spot.place.forward)) * Quat::exp(tilt.log() * left)
    }
}

impl<A: Attitude> Attitude for Levelled<A> {
    fn at_spot(&self, spot: &Spot) -> Quat {
        let part = self.parts.iter().find(|part| part.segments.contains(&spot.segment));
        let Some(part) = part else { return self.attitude.at_spot(spot) };
        part.signs.follow(self.attitude.steps(), spot, |spot| self.taken(spot, &part.tilts))
    }

    fn steps(&self) -> &Steps<'_> {
        self.attitude.steps()
    }
}

/// Where a course has no heading; what runs across its seam has its edges on both sides of it.
fn vertical(steps: &Steps) -> Vec<Passage> {
    let mut found = passages(steps, NO_HEADING);
    if meet_at_seam(steps, &found)
        && let [first, .., last] = &mut found[..]
    {
        (first.before, last.after) = (last.before, first.after);
    }
    found
}

/// The heading while forward is vertical.
fn through(course: &dyn Course, passage: &Passage, x: f64) -> f64 {
    let of = |spot: Spot| heading(spot.place.forward);
    let before = passage.before.map_or(0.0, of);
    let Some(after) = passage.after.map(of) else { return before };
    let [start, end, t] = [passage.start, passage.end, x].map(|x| course.time(x));
    let part = (t - start) / (end - start).max(f64::MIN_POSITIVE);
    before + smoothstep(part) * wrapped(after - before)
}

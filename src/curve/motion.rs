//! One track's keys, or its control rotations, as a function of time.

use super::arc::GreatArc;
use super::cumulative::CumulativeCubic;
use super::lanes::{self, Inner};
use super::scheme::Segment;
use super::track::Track;
use super::{Arc, Ends, Rates, Scheme, Tcb, natural_c2, ramp_start};
use crate::math::{Quat, Scalar, Vec3};
use std::sync::{Arc as Shared, OnceLock};

/// The motion of one box: its keys, the scheme between them, and the ends; or its control
/// rotations.
#[derive(Clone, Debug)]
pub struct Motion<'a> {
    track: Track<'a>,
    course: Course,
}

/// What runs through the keys.
#[derive(Clone, Debug)]
enum Course {
    /// A scheme from key to key.
    Scheme(Scheme, Tcb, Option<Solution>),
    /// A cubic a segment, of its first key, its two control rotations and its last key.
    Controls,
}

/// Velocities at all keys, worked out when they are first needed; clones share them.
type Solution = Shared<OnceLock<Box<[Vec3]>>>;

/// A stretch of time on which a motion is smooth.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// When it begins, seconds.
    pub start: f64,
    /// When it ends, seconds.
    pub end: f64,
    shape: Shape,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Rest(Quat),
    Ramp(GreatArc),
    Segment(Segment),
    Cubic(CumulativeCubic),
}

impl Piece {
    /// The place of a time within the piece: 0 at its start, 1 at its end. Times outside
    /// are clamped.
    pub fn parameter(&self, t: f64) -> f64 {
        ((t - self.start) / (self.end - self.start)).clamp(0.0, 1.0)
    }

    /// The rotations at many parameters, by vector code.
    pub(super) fn fill(&self, us: &[f64], out: &mut [Quat]) {
        match &self.shape {
            Shape::Rest(q) => out.fill(*q),
            Shape::Ramp(arc) => lanes::fill(arc, us, out),
            Shape::Segment(segment) => segment.fill(us, out),
            Shape::Cubic(cubic) => lanes::fill(cubic, us, out),
        }
    }

    /// The piece's length, seconds.
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }
}

impl Arc for Piece {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        self.shape.at(u)
    }

    fn rates(&self) -> Rates {
        self.shape.rates()
    }
}

impl Arc for Shape {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        match self {
            Shape::Rest(q) => Quat::constant(*q),
            Shape::Ramp(arc) => arc.at(u),
            Shape::Segment(segment) => segment.at(u),
            Shape::Cubic(cubic) => cubic.at(u),
        }
    }

    fn rates(&self) -> Rates {
        match self {
            Shape::Rest(_) => Rates { speed: 0.0, acceleration: 0.0 },
            Shape::Ramp(arc) => arc.rates(),
            Shape::Segment(segment) => segment.rates(),
            Shape::Cubic(cubic) => cubic.rates(),
        }
    }
}

impl<'a> Motion<'a> {
    /// The motion through `keys` at `times`, as a [`crate::clip::Clip`] holds them.
    pub fn new(times: &'a [f64], keys: &'a [Quat], scheme: Scheme, ends: Ends) -> Motion<'a> {
        // With two keys a scheme has no neighbours to go by, and is slerp.
        let scheme = if keys.len() == 2 && scheme.has_ends() { Scheme::Slerp } else { scheme };
        let ends = if scheme.has_ends() { ends } else { Ends::Natural };
        let last = keys[keys.len() - 1];
        let last = if ends == Ends::Closed { keys[0].aligned_to(last) } else { last };
        // Held ends show the keys next to them: there a curve that smooths begins and ends.
        let margin = usize::from(ends == Ends::Hold && !scheme.passes_keys());
        let solution = scheme.velocities().map(|_| Solution::default());
        let track = Track { times, keys, last, ends, margin };
        Motion { track, course: Course::Scheme(scheme, Tcb::default(), solution) }
    }

    /// The same with tension, continuity and bias for the scheme that has them.
    pub fn with_tcb(mut self, tcb: Tcb) -> Motion<'a> {
        if let Course::Scheme(_, of_scheme, _) = &mut self.course {
            *of_scheme = tcb;
        }
        self
    }

    /// The motion along control rotations: segment i runs from `times[i]` to
    /// `times[i + 1]` along the cumulative cubic of the controls 3i to 3i + 3. It passes
    /// through the first and the last of them; the two between say how it leaves and
    /// arrives, at 3ω₁/h and 3ω₃/h, where ω is the logarithm of the step from a control to
    /// the next. Neither schemes nor ends apply.
    ///
    /// n + 1 times that increase and 3n + 1 unit quaternions for n ≥ 1, each in the
    /// hemisphere of the one before it, so that every step is the short way.
    /// Source: Kim, Kim and Shin 1995; docs/math/cumulative-bezier.md.
    pub fn through_controls(times: &'a [f64], controls: &'a [Quat]) -> Motion<'a> {
        let last = controls[controls.len() - 1];
        let track = Track { times, keys: controls, last, ends: Ends::Natural, margin: 0 };
        Motion { track, course: Course::Controls }
    }

    /// Times of the keys, seconds; of control rotations, where segments begin and end.
    pub fn times(&self) -> &'a [f64] {
        self.track.times
    }

    /// Whether it is held from key to key.
    pub fn is_step(&self) -> bool {
        matches!(&self.course, Course::Scheme(scheme, ..) if scheme.is_step())
    }

    /// Where the ramp of a jump begins, if this motion has one.
    pub fn ramp(&self) -> Option<f64> {
        self.holds().then(|| ramp_start(self.track.times[0], self.track.times[1]))
    }

    /// Key i, which the motion passes unless its scheme smooths.
    pub(crate) fn key(&self, i: usize) -> Quat {
        self.track.key(i)
    }

    /// The rotation at a time; before the first and after the last key that key's.
    pub fn at(&self, t: f64) -> Quat {
        let piece = self.piece_at(t);
        piece.at(piece.parameter(t))
    }

    /// The motion at increasing times, in order: as [`Motion::at`] but for the last digits of
    /// float64, and by vector code.
    pub fn at_all<T: Copy + Into<f64>>(&self, times: &[T]) -> Vec<Quat> {
        lanes::at_all(self, times)
    }

    /// Bounds of the rates, by seconds, of segments that follow each other: of those that
    /// vector code can tell them of, and that run from key to key.
    pub(crate) fn rates_of(&self, segments: std::ops::Range<usize>) -> Vec<Option<Rates>> {
        match self.inner() {
            Some(inner) => lanes::rates(&inner, segments, self.tcb()),
            None => vec![None; segments.len()],
        }
    }

    /// The piece that holds a time: of two that meet there, the later one. From the last
    /// key on the motion rests.
    pub fn piece_at(&self, t: f64) -> Piece {
        let times = self.track.times;
        let last = times.len() - 2;
        let end = times[last + 1];
        if t >= end {
            let shape = if self.holds() { Shape::Rest(self.track.keys[last]) } else { self.rest(last) };
            return Piece { start: end, end: f64::INFINITY, shape };
        }
        let segment = times.partition_point(|&key| key <= t).saturating_sub(1).min(last);
        self.piece(segment, t)
    }

    /// The segment that holds a time; `near` is one that does not lie behind it.
    pub(crate) fn segment_at(&self, t: f64, near: usize) -> usize {
        let times = self.track.times;
        let last = times.len() - 2;
        // From key to key, then in strides that double.
        let (mut low, mut stride) = (near, 1);
        while low + stride <= last && times[low + stride] <= t {
            low += stride;
            stride *= 2;
        }
        let high = (low + stride).min(last + 1);
        low + times[low + 1..high].partition_point(|&key| key <= t)
    }

    /// The segments that can be worked out side by side, if the scheme is one of those.
    pub(super) fn inner(&self) -> Option<Inner<'a>> {
        let Course::Scheme(scheme, ..) = &self.course else { return None };
        let Track { times, keys, .. } = self.track;
        // Two keys at either end: the second has an end for a neighbour.
        let segments = 2..times.len().saturating_sub(3);
        let kernels = scheme.kernels().filter(|_| !self.holds())?;
        let has_ends = scheme.has_ends();
        Some(Inner { kernels, has_ends, times, keys, segments })
    }

    pub(super) fn tcb(&self) -> Tcb {
        match &self.course {
            Course::Scheme(_, tcb, _) => *tcb,
            Course::Controls => Tcb::default(),
        }
    }

    /// The piece of segment `i`, from key i to key i + 1, that holds the time t.
    pub fn piece(&self, i: usize, t: f64) -> Piece {
        let (start, end) = (self.track.times[i], self.track.times[i + 1]);
        match self.ramp() {
            Some(ramp) if i == 0 && t < ramp => {
                Piece { start, end: ramp, shape: Shape::Rest(self.track.key(0)) }
            }
            Some(ramp) if i == 0 => {
                let arc = GreatArc::new(self.track.key(0), self.track.key(1));
                Piece { start: ramp, end, shape: Shape::Ramp(arc) }
            }
            Some(_) if i + 2 == self.track.times.len() => {
                Piece { start, end, shape: Shape::Rest(self.track.key(i)) }
            }
            _ => Piece { start, end, shape: self.segment(i) },
        }
    }

    /// Whether velocities at keys were found where a scheme asks for them.
    pub(super) fn is_solved(&self) -> bool {
        match &self.course {
            Course::Scheme(Scheme::NaturalC2, ..) => natural_c2::is_solved(&self.track),
            _ => true,
        }
    }

    /// Whether segment i swings round or jumps where slerps that are blended come apart.
    pub(crate) fn swings(&self, i: usize) -> bool {
        matches!(self.segment(i), Shape::Segment(Segment::BarryGoldman(pyramid)) if pyramid.swings())
    }

    /// Where the first segment starts that spins, and swings round or jumps, seconds.
    pub(crate) fn first_spin(&self) -> Option<f64> {
        let Course::Scheme(Scheme::BarryGoldman, ..) = self.course else { return None };
        let spins = |i: usize| matches!(self.segment(i), Shape::Segment(Segment::BarryGoldman(pyramid)) if pyramid.spins());
        let times = &self.track.times;
        (0..times.len() - 1).find(|&i| spins(i)).map(|i| times[i])
    }

    fn holds(&self) -> bool {
        self.track.ends == Ends::Hold
    }

    /// Where the motion rests that has run through its last segment.
    fn rest(&self, last: usize) -> Shape {
        match &self.course {
            Course::Scheme(scheme, ..) if !scheme.passes_keys() => Shape::Rest(self.segment(last).at(1.0)),
            _ => Shape::Rest(self.track.last),
        }
    }

    fn segment(&self, i: usize) -> Shape {
        match &self.course {
            Course::Controls => Shape::Cubic(self.cubic(i)),
            Course::Scheme(scheme, tcb, _) => {
                let velocities = self.solved().map_or([Vec3::ZERO; 2], |all| [all[i], all[i + 1]]);
                Shape::Segment(scheme.segment(&self.track.span(i, velocities, *tcb)))
            }
        }
    }

    /// Finds what a scheme needs of all keys at once, if it does; else the first use does.
    pub(crate) fn solve(&self) {
        self.solved();
    }

    fn solved(&self) -> Option<&[Vec3]> {
        let Course::Scheme(scheme, _, solution) = &self.course else { return None };
        let (solution, solve) = (solution.as_ref()?, scheme.velocities()?);
        Some(solution.get_or_init(|| solve(&self.track)))
    }

    /// The cubic of control rotations from time i to time i + 1.
    fn cubic(&self, i: usize) -> CumulativeCubic {
        let controls = &self.track.keys[3 * i..];
        let step = |k: usize| (controls[k].conjugate() * controls[k + 1]).log();
        CumulativeCubic::new(controls[0], [step(0), step(1), step(2)])
    }
}

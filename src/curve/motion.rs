//! One track's keys, or its control rotations, as a function of time.

use super::arc::GreatArc;
use super::cumulative::CumulativeCubic;
use super::rule::{End, Neighbour, Span};
use super::scheme::Segment;
use super::{Arc, Ends, Rates, Scheme, ramp_start};
use crate::math::{Quat, Scalar};

/// The motion of one box: its keys, the scheme between them, and the ends; or its control
/// rotations.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    times: &'a [f64],
    /// Keys, or control rotations.
    keys: &'a [Quat],
    /// The last key, which closed ends make equal to the first.
    last: Quat,
    course: Course,
}

/// What runs through the keys.
#[derive(Clone, Copy, Debug)]
enum Course {
    /// A scheme from key to key.
    Keys(Scheme, Ends),
    /// A cubic a segment, of its first key, its two control rotations and its last key.
    Controls,
}

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

    /// The piece's length, seconds.
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }
}

impl Arc for Piece {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        match &self.shape {
            Shape::Rest(q) => Quat::constant(*q),
            Shape::Ramp(arc) => arc.at(u),
            Shape::Segment(segment) => segment.at(u),
            Shape::Cubic(cubic) => cubic.at(u),
        }
    }

    fn rates(&self) -> Rates {
        match &self.shape {
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
        // With two keys every scheme is slerp; slerp has no use for neighbours.
        let scheme = if keys.len() == 2 { Scheme::Slerp } else { scheme };
        let ends = if scheme == Scheme::Slerp { Ends::Natural } else { ends };
        let last = keys[keys.len() - 1];
        let last = if ends == Ends::Closed { keys[0].aligned_to(last) } else { last };
        Motion { times, keys, last, course: Course::Keys(scheme, ends) }
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
        Motion { times, keys: controls, last: controls[controls.len() - 1], course: Course::Controls }
    }

    /// Times of the keys, seconds; of control rotations, where segments begin and end.
    pub fn times(&self) -> &'a [f64] {
        self.times
    }

    /// Where the ramp of a jump begins, if this motion has one.
    pub fn ramp(&self) -> Option<f64> {
        self.holds().then(|| ramp_start(self.times[0], self.times[1]))
    }

    /// The rotation at a time; before the first and after the last key that key's.
    pub fn at(&self, t: f64) -> Quat {
        let piece = self.piece_at(t);
        piece.at(piece.parameter(t))
    }

    /// The piece that holds a time: of two that meet there, the later one. From the last
    /// key on the motion rests.
    pub fn piece_at(&self, t: f64) -> Piece {
        let last = self.times.len() - 2;
        let end = self.times[last + 1];
        if t >= end {
            let resting = if self.holds() { self.keys[last] } else { self.last };
            return Piece { start: end, end: f64::INFINITY, shape: Shape::Rest(resting) };
        }
        let segment = self.times.partition_point(|&key| key <= t).saturating_sub(1).min(last);
        self.piece(segment, t)
    }

    /// The piece of segment `i`, from key i to key i + 1, that holds the time t.
    pub fn piece(&self, i: usize, t: f64) -> Piece {
        let (start, end) = (self.times[i], self.times[i + 1]);
        let segment = |scheme: Scheme| Shape::Segment(scheme.segment(&self.span(i)));
        let scheme = match self.course {
            Course::Controls => return Piece { start, end, shape: Shape::Cubic(self.cubic(i)) },
            Course::Keys(scheme, Ends::Hold) => scheme,
            Course::Keys(scheme, _) => return Piece { start, end, shape: segment(scheme) },
        };
        let rest = Shape::Rest(self.key(i));
        match self.ramp() {
            Some(ramp) if i == 0 && t < ramp => Piece { start, end: ramp, shape: rest },
            Some(ramp) if i == 0 => {
                let arc = GreatArc::new(self.key(0), self.key(1));
                Piece { start: ramp, end, shape: Shape::Ramp(arc) }
            }
            _ if i + 2 == self.keys.len() => Piece { start, end, shape: rest },
            _ => Piece { start, end, shape: segment(scheme) },
        }
    }

    fn ends(&self) -> Ends {
        match self.course {
            Course::Keys(_, ends) => ends,
            Course::Controls => Ends::Natural,
        }
    }

    fn holds(&self) -> bool {
        self.ends() == Ends::Hold
    }

    /// The cubic of control rotations from time i to time i + 1.
    fn cubic(&self, i: usize) -> CumulativeCubic {
        let controls = &self.keys[3 * i..];
        let step = |k: usize| (controls[k].conjugate() * controls[k + 1]).log();
        CumulativeCubic::new(controls[0], [step(0), step(1), step(2)])
    }

    /// Key i as the motion passes it.
    fn key(&self, i: usize) -> Quat {
        if i + 1 == self.keys.len() { self.last } else { self.keys[i] }
    }

    /// Segment i, between two keys, and what surrounds it.
    fn span(&self, i: usize) -> Span {
        Span {
            before: self.before(i),
            start: self.key(i),
            end: self.key(i + 1),
            h: self.interval(i),
            after: self.after(i + 1),
            end_rule: if self.ends() == Ends::Clamped { End::Rest } else { End::Natural },
        }
    }

    /// Time from key i to key i + 1.
    fn interval(&self, i: usize) -> f64 {
        self.times[i + 1] - self.times[i]
    }

    /// The key before key i.
    fn before(&self, i: usize) -> Option<Neighbour> {
        if i > 0 {
            return Some(Neighbour { key: self.key(i - 1), h: self.interval(i - 1) });
        }
        let last = self.keys.len() - 1;
        match self.ends() {
            Ends::Repeat => Some(Neighbour { key: self.key(0), h: self.interval(0) }),
            // The sign that makes the last key the first.
            Ends::Closed => {
                Some(Neighbour { key: self.with_seam_sign(self.key(last - 1)), h: self.interval(last - 1) })
            }
            Ends::Natural | Ends::Clamped | Ends::Hold => None,
        }
    }

    /// The key after key i.
    fn after(&self, i: usize) -> Option<Neighbour> {
        let last = self.keys.len() - 1;
        if i < last {
            return Some(Neighbour { key: self.key(i + 1), h: self.interval(i) });
        }
        match self.ends() {
            Ends::Repeat => Some(Neighbour { key: self.last, h: self.interval(last - 1) }),
            Ends::Closed => Some(Neighbour { key: self.with_seam_sign(self.key(1)), h: self.interval(0) }),
            Ends::Natural | Ends::Clamped | Ends::Hold => None,
        }
    }

    fn with_seam_sign(&self, q: Quat) -> Quat {
        if self.key(0).dot(self.last) < 0.0 { -q } else { q }
    }
}

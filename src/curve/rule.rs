//! What a scheme is asked for, and what it is told.

use super::track::Track;
use super::{Arc, Rates, Tcb};
use crate::math::{Number, Quat, Scalar, Vec3};

/// Where a scheme's motion has no jumps in speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothness {
    /// The motion itself jumps at keys.
    Jumps,
    /// Not at the keys.
    Corners,
    /// At the keys too, where they are evenly spaced in time.
    EvenKeys,
    /// Everywhere.
    Always,
    /// Everywhere, and its acceleration has none either.
    Twice,
}

/// A neighbouring key and the time to it, seconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbour<N = f64> {
    pub(super) key: Quat<N>,
    pub(super) h: N,
    /// Whether no key lies beyond it.
    pub(super) is_end: bool,
}

/// What shapes the motion where a neighbour is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// It starts and stops without acceleration.
    Natural,
    /// The end key counts as its own neighbour.
    Repeat,
    /// It starts and stops at this share of the end segment's mean velocity.
    Chord(f64),
}

/// One segment with its surroundings: two keys h seconds apart, and their neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span<N = f64> {
    /// The key before; none at an end.
    pub(super) before: Option<Neighbour<N>>,
    pub(super) start: Quat<N>,
    pub(super) end: Quat<N>,
    pub(super) h: N,
    /// The key after; none at an end.
    pub(super) after: Option<Neighbour<N>>,
    pub(super) end_rule: End,
    /// Lengths of this segment, in the middle, and of two on either side, seconds; what
    /// lies beyond an end mirrors what lies before it.
    pub(super) intervals: [N; 5],
    /// Half the angular velocities at both keys, in the key's own frame, per second: of
    /// schemes that work them out for a whole track, else zero.
    pub(super) velocities: [Vec3<N>; 2],
    pub(super) tcb: Tcb,
}

impl<N: Number> Span<N> {
    /// The key before; where the end key counts twice, that.
    #[inline(always)]
    pub(super) fn before_or_repeated(&self) -> Option<Neighbour<N>> {
        self.before.or_else(|| self.repeated(self.start))
    }

    /// The key after; where the end key counts twice, that.
    #[inline(always)]
    pub(super) fn after_or_repeated(&self) -> Option<Neighbour<N>> {
        self.after.or_else(|| self.repeated(self.end))
    }

    #[inline(always)]
    fn repeated(&self, key: Quat<N>) -> Option<Neighbour<N>> {
        (self.end_rule == End::Repeat).then_some(Neighbour { key, h: self.h, is_end: true })
    }
}

/// Half the angular velocities at all keys of a track, in the key's own frame, per second.
pub(super) type Velocities = fn(&Track) -> Box<[Vec3]>;

/// A scheme: how the curve between two keys follows from them and their neighbours.
pub(super) trait Rule {
    /// As the user names it.
    const NAME: &'static str;
    /// In a line, for the help text.
    const SUMMARY: &'static str;
    const SMOOTHNESS: Smoothness;
    /// Whether the curve meets every key.
    const PASSES_KEYS: bool = true;
    /// Whether anything but its two keys shapes a segment: else ends change nothing.
    const HAS_ENDS: bool = true;
    /// How velocities at keys follow from the whole track, if they do.
    const VELOCITIES: Option<Velocities> = None;
    type Arc: Arc + Copy;
    fn arc(span: &Span) -> Self::Arc;
}

/// A scheme whose curve is worked out for many segments side by side too: its formulas hold
/// for any kind of number.
pub(super) trait Broad {
    type Curve<N: Number>: Formula<N> + Paced<N>;
    fn curve<N: Number>(span: &Span<N>) -> Self::Curve<N>;

    /// Whether the formulas keep their digits for a segment with a neighbour on either side, of whose
    /// intervals none is many times another.
    fn is_tame(_span: &Span) -> bool {
        true
    }
}

/// A curve made of numbers N, as a function of u.
pub(super) trait Formula<N> {
    fn point<S: Scalar + From<N>>(&self, u: S) -> Quat<S>;
}

/// A curve whose rates have bounds in closed form, for any kind of number.
pub(super) trait Paced<N> {
    /// As [`Arc::rates`].
    fn pace(&self) -> Rates<N>;
}

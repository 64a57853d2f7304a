//! A segment with what surrounds it: all that a scheme is told.

use super::Tcb;
use crate::math::{Number, Quat, Vec3};

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

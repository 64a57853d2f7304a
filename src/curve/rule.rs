//! What a scheme is asked for.

use super::span::Span;
use super::track::Track;
use super::{Arc, Rates};
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

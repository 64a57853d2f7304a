//! `bessel`: the velocity at a key is the time-weighted mean of those around it.

use super::Tcb;
use super::cumulative::{Corner, CumulativeCubic, Handles};
use super::rule::{Broad, Rule, Smoothness};
use super::span::Span;
use crate::math::{Number, Vec3};

/// Bessel's tangents (de Boor 1978) on angular velocities; docs/math/bessel.md.
pub(super) struct Bessel;

impl Rule for Bessel {
    const NAME: &'static str = "bessel";
    const SUMMARY: &'static str = "smooth on even and uneven keys alike; the default";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        Bessel::curve(span)
    }
}

impl Handles for Bessel {
    #[inline(always)]
    fn leaving<N: Number>(corner: &Corner<N>, h: N, _tcb: Tcb) -> Vec3<N> {
        velocity(corner, [N::constant(1.0); 2]) * (h * N::constant(1.0 / 3.0))
    }
}

/// (a h₊v₋ + b h₋v₊)/(h₋ + h₊) with the weights a and b: the nearer neighbour weighs more.
/// Half the angular velocity at the key, in its own frame, per second.
#[inline(always)]
pub(super) fn velocity<N: Number>(Corner { before, key, after }: &Corner<N>, [a, b]: [N; 2]) -> Vec3<N> {
    let one = N::constant(1.0);
    let arriving = N::log(before.key.conjugate() * *key) * (one / before.h);
    let leaving = N::log(key.conjugate() * after.key) * (one / after.h);
    let weight = before.h / (before.h + after.h);
    arriving * (a * (one - weight)) + leaving * (b * weight)
}

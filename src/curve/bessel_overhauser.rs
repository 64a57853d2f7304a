//! `bessel-overhauser`: `bessel` by powers and products of quaternions.

use super::Tcb;
use super::cumulative::{Corner, CumulativeCubic, Handles, log_of_product};
use super::rule::{Broad, Rule, Smoothness};
use super::span::Span;
use crate::math::{Number, Quat, Vec3};

/// Bessel's tangents as a product of powers; docs/math/bessel-overhauser.md.
pub(super) struct BesselOverhauser;

impl Rule for BesselOverhauser {
    const NAME: &'static str = "bessel-overhauser";
    const SUMMARY: &'static str = "smooth on uneven keys; equals catmull-rom on even ones";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        BesselOverhauser::curve(span)
    }
}

impl Handles for BesselOverhauser {
    #[inline(always)]
    fn leaving<N: Number>(corner: &Corner<N>, h: N, _tcb: Tcb) -> Vec3<N> {
        velocity(corner) * (h * N::constant(1.0 / 3.0))
    }
}

/// log(X^{h₊/h₋} Y^{h₋/h₊}) / (h₋ + h₊), X and Y the steps to and from the key.
///
/// Only the powers are quaternions. The quotient stays a vector: as a power it would
/// wrap once the time unit is small enough.
#[inline(always)]
fn velocity<N: Number>(Corner { before, key, after }: &Corner<N>) -> Vec3<N> {
    let (to, first) = power(before.key.conjugate() * *key, after.h / before.h);
    let (from, second) = power(key.conjugate() * after.key, before.h / after.h);
    log_of_product(first * second, to + from) * (N::constant(1.0) / (before.h + after.h))
}

/// A power of a rotation: its logarithm, and itself.
#[inline(always)]
fn power<N: Number>(q: Quat<N>, exponent: N) -> (Vec3<N>, Quat<N>) {
    let (angle, axis) = N::polar(q);
    let turn = angle * exponent;
    let (sin, cos) = turn.sin_cos();
    (axis * turn, Quat { w: cos, v: axis * sin })
}

/// Whether a power at a key may turn by half a turn or more: of angles up to π/2 the sine
/// is 2/π or more. At the price of two products.
pub(super) fn may_wrap(before: Quat, key: Quat, after: Quat, h0: f64, h1: f64) -> bool {
    let long = |from: Quat, to: Quat, ratio: f64| {
        let step = from.conjugate() * to;
        step.w <= 0.0 || step.v.dot(step.v) * ratio * ratio >= 1.0
    };
    long(before, key, h1 / h0) || long(key, after, h0 / h1)
}

/// The larger turn of the two powers at a key, radians: beyond half a turn the power's
/// logarithm is not the one that was meant.
pub(super) fn largest_power(before: Quat, key: Quat, after: Quat, h0: f64, h1: f64) -> f64 {
    let to = (before.conjugate() * key).log() * (h1 / h0);
    let from = (key.conjugate() * after).log() * (h0 / h1);
    2.0 * to.length().max(from.length())
}

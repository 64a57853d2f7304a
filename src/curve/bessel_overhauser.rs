//! `bessel-overhauser`: `bessel` by powers and products of quaternions.

use super::cumulative::{Corner, CumulativeCubic, from_handles, log_of_product};
use super::rule::{Rule, Smoothness, Span};
use crate::math::{Quat, Vec3};

/// Bessel's tangents as a product of powers; docs/math/bessel-overhauser.md.
pub(super) struct BesselOverhauser;

impl Rule for BesselOverhauser {
    const NAME: &'static str = "bessel-overhauser";
    const SUMMARY: &'static str = "smooth on uneven keys; equals catmull-rom on even ones";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        from_handles(span, |corner, h| velocity(corner) * (h / 3.0))
    }
}

/// log(X^{h₊/h₋} Y^{h₋/h₊}) / (h₋ + h₊), X and Y the steps to and from the key.
///
/// Only the powers are quaternions. The quotient stays a vector: as a power it would
/// wrap once the time unit is small enough.
fn velocity(Corner { before, key, after }: &Corner) -> Vec3 {
    let (to, from) = powers(before.key, *key, after.key, before.h, after.h);
    log_of_product(Quat::exp(to) * Quat::exp(from), || to + from) * (1.0 / (before.h + after.h))
}

/// The logarithms of the two powers.
fn powers(before: Quat, key: Quat, after: Quat, h0: f64, h1: f64) -> (Vec3, Vec3) {
    let to = (before.conjugate() * key).log() * (h1 / h0);
    let from = (key.conjugate() * after).log() * (h0 / h1);
    (to, from)
}

/// The larger turn of the two powers at a key, radians: beyond half a turn the power's
/// logarithm is not the one that was meant.
pub(super) fn largest_power(before: Quat, key: Quat, after: Quat, h0: f64, h1: f64) -> f64 {
    let (to, from) = powers(before, key, after, h0, h1);
    2.0 * to.length().max(from.length())
}

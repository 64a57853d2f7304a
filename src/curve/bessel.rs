//! `bessel`: the velocity at a key is the time-weighted mean of those around it.

use super::cumulative::{Corner, CumulativeCubic, from_handles};
use super::rule::{Rule, Smoothness, Span};
use crate::math::Vec3;

/// Bessel's tangents (de Boor 1978) on angular velocities; docs/math/bessel.md.
pub(super) struct Bessel;

impl Rule for Bessel {
    const NAME: &'static str = "bessel";
    const SUMMARY: &'static str = "smooth on even and uneven keys alike; the default";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        from_handles(span, |corner, h| velocity(corner) * (h / 3.0))
    }
}

/// (h₊v₋ + h₋v₊)/(h₋ + h₊): the nearer neighbour weighs more. Half the angular velocity
/// at the key, in its own frame, per second.
fn velocity(Corner { before, key, after }: &Corner) -> Vec3 {
    let arriving = (before.key.conjugate() * *key).log() * (1.0 / before.h);
    let leaving = (key.conjugate() * after.key).log() * (1.0 / after.h);
    let weight = before.h / (before.h + after.h);
    arriving * (1.0 - weight) + leaving * weight
}

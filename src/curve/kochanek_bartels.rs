//! `kochanek-bartels`: `bessel` with tension, continuity and bias.

use super::Tcb;
use super::cumulative::{Corner, CumulativeCubic, from_both_handles};
use super::rule::{Rule, Smoothness, Span};
use crate::math::Vec3;

/// Kochanek and Bartels 1984 on angular velocities; docs/math/kochanek-bartels.md.
pub(super) struct KochanekBartels;

impl Rule for KochanekBartels {
    const NAME: &'static str = "kochanek-bartels";
    const SUMMARY: &'static str = "bessel with --tension, --continuity and --bias";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        let Tcb { tension, continuity, bias } = span.tcb;
        let weights = |sign: f64| {
            let (before, after) = (1.0 + sign * continuity, 1.0 - sign * continuity);
            [(1.0 - tension) * before * (1.0 + bias), (1.0 - tension) * after * (1.0 - bias)]
        };
        let (leaving, arriving) = (weights(1.0), weights(-1.0));
        from_both_handles(
            span,
            |corner, h| velocity(corner, leaving) * (h / 3.0),
            |corner, h| velocity(corner, arriving) * (h / 3.0),
        )
    }
}

/// (a h₊v₋ + b h₋v₊)/(h₋ + h₊) with the weights a and b: half the angular velocity on one
/// side of the key, in its own frame, per second.
fn velocity(Corner { before, key, after }: &Corner, [a, b]: [f64; 2]) -> Vec3 {
    let arriving = (before.key.conjugate() * *key).log() * (1.0 / before.h);
    let leaving = (key.conjugate() * after.key).log() * (1.0 / after.h);
    let weight = before.h / (before.h + after.h);
    arriving * (a * (1.0 - weight)) + leaving * (b * weight)
}

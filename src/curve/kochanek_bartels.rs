//! `kochanek-bartels`: `bessel` with tension, continuity and bias.

use super::Tcb;
use super::bessel::velocity;
use super::cumulative::{Corner, CumulativeCubic, Handles};
use super::rule::{Broad, Rule, Smoothness};
use super::span::Span;
use crate::math::{Number, Vec3};

/// Kochanek and Bartels 1984 on angular velocities; docs/math/kochanek-bartels.md.
pub(super) struct KochanekBartels;

impl Rule for KochanekBartels {
    const NAME: &'static str = "kochanek-bartels";
    const SUMMARY: &'static str = "bessel with --tension, --continuity and --bias";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        KochanekBartels::curve(span)
    }
}

impl Handles for KochanekBartels {
    #[inline(always)]
    fn leaving<N: Number>(corner: &Corner<N>, h: N, tcb: Tcb) -> Vec3<N> {
        velocity(corner, weights(tcb, 1.0)) * (h * N::constant(1.0 / 3.0))
    }

    #[inline(always)]
    fn arriving<N: Number>(corner: &Corner<N>, h: N, tcb: Tcb) -> Vec3<N> {
        velocity(corner, weights(tcb, -1.0)) * (h * N::constant(1.0 / 3.0))
    }
}

/// How much the velocities before and after a key weigh for the step that leaves it
/// (`sign` 1), or leads to it (−1).
#[inline(always)]
fn weights<N: Number>(Tcb { tension, continuity, bias }: Tcb, sign: f64) -> [N; 2] {
    let (before, after) = (1.0 + sign * continuity, 1.0 - sign * continuity);
    let (a, b) = ((1.0 - tension) * before * (1.0 + bias), (1.0 - tension) * after * (1.0 - bias));
    [N::constant(a), N::constant(b)]
}

//! `catmull-rom`: at each key the curve runs parallel to the chord of its neighbours.

use super::Tcb;
use super::cumulative::{Corner, CumulativeCubic, Handles, log_of_product};
use super::rule::{Broad, Rule, Smoothness};
use super::span::Span;
use crate::math::{Number, Vec3};

/// Catmull and Rom 1974, for rotations in the form of Kim, Kim and Shin 1995;
/// docs/math/catmull-rom.md.
pub(super) struct CatmullRom;

impl Rule for CatmullRom {
    const NAME: &'static str = "catmull-rom";
    const SUMMARY: &'static str = "smooth on even keys; jumps in speed on uneven ones";
    const SMOOTHNESS: Smoothness = Smoothness::EvenKeys;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        CatmullRom::curve(span)
    }
}

impl Handles for CatmullRom {
    #[inline(always)]
    fn leaving<N: Number>(corner: &Corner<N>, _h: N, _tcb: Tcb) -> Vec3<N> {
        chord(corner) * N::constant(1.0 / 6.0)
    }
}

/// log q₀⁻¹q₂ for the neighbours q₀, q₂ of a key.
#[inline(always)]
fn chord<N: Number>(Corner { before, key, after }: &Corner<N>) -> Vec3<N> {
    let sum = N::log(before.key.conjugate() * *key) + N::log(key.conjugate() * after.key);
    log_of_product(before.key.conjugate() * after.key, sum)
}

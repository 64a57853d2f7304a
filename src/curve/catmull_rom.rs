//! `catmull-rom`: at each key the curve runs parallel to the chord of its neighbours.

use super::cumulative::{Corner, CumulativeCubic, from_handles, log_of_product};
use super::rule::{Rule, Smoothness, Span};
use crate::math::Vec3;

/// Catmull and Rom 1974, for rotations in the form of Kim, Kim and Shin 1995;
/// docs/math/catmull-rom.md.
pub(super) struct CatmullRom;

impl Rule for CatmullRom {
    const NAME: &'static str = "catmull-rom";
    const SUMMARY: &'static str = "smooth on even keys; jumps in speed on uneven ones";
    const SMOOTHNESS: Smoothness = Smoothness::EvenKeys;
    type Arc = CumulativeCubic;

    fn arc(span: &Span) -> CumulativeCubic {
        from_handles(span, |corner, _h| chord(corner) * (1.0 / 6.0))
    }
}

/// log q₀⁻¹q₂ for the neighbours q₀, q₂ of a key.
fn chord(Corner { before, key, after }: &Corner) -> Vec3 {
    log_of_product(before.key.conjugate() * after.key, || {
        (before.key.conjugate() * *key).log() + (key.conjugate() * after.key).log()
    })
}

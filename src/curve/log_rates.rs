//! What logarithms and exponentials make of rates: bounds that the curves made of them share.
//!
//! exp X turns at the velocity A X′, no longer than X′, and its acceleration is A X″ and at most
//! [`BEND`] |X′||X × X′| more. The other way, L = log d changes by A⁻¹ times the velocity of d, and
//! |A⁻¹y − y| is at most [`stretch`] times |L × y|. A is that of docs/math/natural-c2.md, whose own
//! tests hold both; how they are used: docs/math/deviation.md.

use crate::math::Number;

/// See this file's head.
pub(super) const BEND: f64 = 1.5;

/// The norm of A⁻¹ for vectors no longer than an angle below π: angle / sin angle.
#[inline(always)]
pub(super) fn stretch<N: Number>(angle: N) -> N {
    let (k, sine) = (N::constant, angle.sin_cos().0);
    angle.below(f64::MIN_POSITIVE, k(1.0), angle / sine.larger(k(f64::MIN_POSITIVE)))
}

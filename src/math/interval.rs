//! Numbers known to lie in a range.
//!
//! Every operation returns a range that holds all results its operands allow, wider by
//! what rounding may have cut off: a formula evaluated over a range of u bounds the
//! curve over that range, proven, not sampled. A range is kept as its middle and its radius:
//! products take no comparisons, and are at most half again as wide as they had to be, of narrow
//! ranges hardly wider. Sources: Moore 1966; Rump 1999.

use super::{Scalar, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The numbers within a radius of a middle; all numbers if either is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    mid: f64,
    rad: f64,
}

/// What covers the roundings of a radius, of which there are seven at most, each by half of
/// [`f64::EPSILON`] downwards.
const ROUNDED: f64 = 1.0 + 4.0 * f64::EPSILON;

impl Interval {
    /// The numbers from `lo` to `hi`.
    pub fn new(lo: f64, hi: f64) -> Interval {
        Interval::hull(lo, hi, 0.0)
    }

    /// All numbers: nothing is known.
    pub const WHOLE: Interval = Interval { mid: 0.0, rad: f64::INFINITY };

    /// The numbers from `lo` to `hi`, either end known to a few units in the last place.
    pub(super) fn around(lo: f64, hi: f64) -> Interval {
        // The special functions behind these ends are good to about 1e-15.
        Interval::hull(lo, hi, 4e-15)
    }

    /// The numbers from `lo` to `hi`, either end known to so much of itself.
    fn hull(lo: f64, hi: f64, error: f64) -> Interval {
        let mid = 0.5 * lo + 0.5 * hi;
        Interval::rounded(mid, (hi - mid).max(mid - lo) + error * lo.abs().max(hi.abs()))
    }

    /// A middle that was rounded once, and a radius without that.
    fn rounded(mid: f64, rad: f64) -> Interval {
        // The last term is for what is too small for all its digits.
        Interval { mid, rad: (rad + f64::EPSILON * mid.abs()) * ROUNDED + f64::MIN_POSITIVE }
    }

    /// No number in the range is smaller.
    pub fn lo(self) -> f64 {
        let lo = (self.mid - self.rad).next_down();
        if lo.is_nan() { f64::NEG_INFINITY } else { lo }
    }

    /// No number in the range is larger.
    pub fn hi(self) -> f64 {
        let hi = (self.mid + self.rad).next_up();
        if hi.is_nan() { f64::INFINITY } else { hi }
    }

    /// No number in the range has a larger absolute value.
    pub fn magnitude(self) -> f64 {
        let largest = (self.mid.abs() + self.rad).next_up();
        if largest.is_nan() { f64::INFINITY } else { largest }
    }

    /// A wave of period 2π and height 1 over the range, with its values at the ends and the place of
    /// a crest.
    fn wave(self, [a, b]: [f64; 2], crest: f64) -> Interval {
        let (from, to) = (self.lo(), self.hi());
        let holds = |place: f64| ((to - place) / TAU).floor() >= ((from - place) / TAU).ceil();
        let ends = Interval::around(a.min(b), a.max(b));
        Interval::new(
            if holds(crest + PI) { -1.0 } else { ends.lo().max(-1.0) },
            if holds(crest) { 1.0 } else { ends.hi().min(1.0) },
        )
    }
}

impl Vec3<Interval> {
    /// An upper bound of the length of every vector in the box.
    pub fn longest(self) -> f64 {
        let square = |i: Interval| i.magnitude().powi(2);
        (square(self.x) + square(self.y) + square(self.z)).sqrt().next_up() * (1.0 + f64::EPSILON)
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Interval::rounded(self.mid + b.mid, self.rad + b.rad)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Interval::rounded(self.mid - b.mid, self.rad + b.rad)
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Interval { mid: -self.mid, rad: self.rad }
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let rad = self.mid.abs() * b.rad + self.rad * (b.mid.abs() + b.rad);
        Interval::rounded(self.mid * b.mid, rad)
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let (lo, hi) = (b.lo(), b.hi());
        if lo <= 0.0 && hi >= 0.0 {
            return Interval::WHOLE;
        }
        self * Interval::hull(1.0 / hi, 1.0 / lo, f64::EPSILON)
    }
}

impl From<f64> for Interval {
    fn from(x: f64) -> Self {
        Interval { mid: x, rad: 0.0 }
    }
}

impl Scalar for Interval {
    fn sqrt(self) -> Self {
        Interval::hull(self.lo().max(0.0).sqrt(), self.hi().max(0.0).sqrt(), f64::EPSILON)
    }

    fn sin_cos(self) -> (Self, Self) {
        // Also where nothing is known.
        if !(self.rad < PI && self.mid.is_finite()) {
            return (Interval::new(-1.0, 1.0), Interval::new(-1.0, 1.0));
        }
        let ((sin_lo, cos_lo), (sin_hi, cos_hi)) = (libm::sincos(self.lo()), libm::sincos(self.hi()));
        (self.wave([sin_lo, sin_hi], FRAC_PI_2), self.wave([cos_lo, cos_hi], 0.0))
    }

    fn cos_sinc_of_square(self) -> (Self, Self) {
        let (lo, hi) = (self.lo().max(0.0), self.hi().max(0.0));
        if hi > PI * PI {
            return (Interval::new(-1.0, 1.0), Interval::new(-0.22, 1.0));
        }
        let ((cos_lo, sinc_lo), (cos_hi, sinc_hi)) = (lo.cos_sinc_of_square(), hi.cos_sinc_of_square());
        (Interval::around(cos_hi, cos_lo), Interval::around(sinc_hi, sinc_lo))
    }

    fn angle_over_sine(self, _sine_squared: Self) -> Self {
        let (lo, hi) = (self.lo(), self.hi().min(1.0));
        if lo <= -1.0 {
            return Interval::WHOLE; // grows without bound towards −1
        }
        let at = |c: f64| c.angle_over_sine((1.0 - c) * (1.0 + c));
        Interval::around(at(hi), at(lo))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn range() -> impl Strategy<Value = (Interval, f64)> {
        (-7.0..7.0f64, 0.0..3.0f64, 0.0..=1.0f64)
            .prop_map(|(lo, width, at)| (Interval::new(lo, lo + width), (lo + width * at).min(lo + width)))
    }

    fn holds(range: Interval, x: f64) -> bool {
        range.lo() <= x && x <= range.hi()
    }

    proptest! {
        #[test]
        fn arithmetic_holds_every_result((a, x) in range(), (b, y) in range()) {
            prop_assert!(holds(a + b, x + y));
            prop_assert!(holds(a - b, x - y));
            prop_assert!(holds(a * b, x * y));
            prop_assert!(holds(a / b, x / y));
        }

        #[test]
        fn rounding_is_covered(x in proptest::num::f64::ANY, y in proptest::num::f64::ANY) {
            // The error of a rounded result, which is a float.
            let (a, b) = (Interval::from(x), Interval::from(y));
            let (sum, product) = (a + b, a * b);
            let off = |z: f64| f64::mul_add(x, y, -z).abs();
            prop_assert!(!(x * y).is_finite() || off(x * y) <= product.rad);
            let rest = (x - ((x + y) - y)).abs().max((y - ((x + y) - x)).abs());
            prop_assert!(!(x + y).is_finite() || rest.min(f64::EPSILON * (x + y).abs()) <= sum.rad);
        }

        #[test]
        fn what_is_unknown_stays_so((a, _) in range()) {
            for lost in [Interval::WHOLE, Interval::from(f64::MAX) * Interval::from(f64::MAX), a / (a - a)] {
                let unknown = [lost + a, a - lost, lost * a, a * lost, lost * Interval::from(0.0), lost / a, lost.sqrt()];
                prop_assert!(unknown.into_iter().all(|i| i.magnitude() == f64::INFINITY));
                let (sin, cos) = lost.sin_cos();
                prop_assert!(holds(sin, -1.0) && holds(sin, 1.0) && holds(cos, -1.0) && holds(cos, 1.0));
            }
        }

        #[test]
        fn functions_hold_every_result((a, x) in range()) {
            let (sin, cos) = a.sin_cos();
            prop_assert!(holds(sin, x.sin()) && holds(cos, x.cos()));
            let (square, inside) = (a * a, x * x);
            prop_assert!(holds(square.sqrt(), inside.sqrt()));
            let (cos, sinc) = square.cos_sinc_of_square();
            prop_assert!(square.magnitude() > PI * PI || sinc.magnitude() <= 1.01);
            let (at_cos, at_sinc) = inside.cos_sinc_of_square();
            prop_assert!(holds(cos, at_cos) && holds(sinc, at_sinc));
        }

        #[test]
        fn angle_over_sine_holds_every_result(c in -0.99..1.0f64, width in 0.0..0.5f64, at in 0.0..=1.0f64) {
            let hi = (c + width).min(1.0);
            let x = c + (hi - c) * at;
            let range = Interval::new(c, hi).angle_over_sine(Interval::constant(0.0));
            prop_assert!(holds(range, x.angle_over_sine((1.0 - x) * (1.0 + x))));
        }
    }
}

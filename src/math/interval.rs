//! Numbers known to lie in a range.
//!
//! Every operation returns a range that holds all results its operands allow, one
//! float wider on either side for what rounding may have cut off: a formula
//! evaluated over a range of u bounds the curve over that range, proven, not
//! sampled. Source: Moore 1966.

use super::{Scalar, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The numbers from `lo` to `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs)]
pub struct Interval {
    pub lo: f64,
    pub hi: f64,
}

impl Interval {
    /// The numbers from `lo` to `hi`, exactly.
    pub const fn new(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    /// All numbers: nothing is known.
    pub const WHOLE: Interval = Interval::new(f64::NEG_INFINITY, f64::INFINITY);

    /// The numbers from `lo` to `hi`, either end known to a few units in the last place.
    pub(super) fn around(lo: f64, hi: f64) -> Interval {
        // The special functions behind these ends are good to about 1e-15.
        let slack = |x: f64| 4e-15 * x.abs() + 1e-300;
        Interval { lo: lo - slack(lo), hi: hi + slack(hi) }
    }

    /// The numbers from `lo` to `hi`, which are rounded: an end's float at least further out.
    fn outward(lo: f64, hi: f64) -> Interval {
        // No less than the distance to the next float, which takes longer to find.
        let ulp = |x: f64| f64::EPSILON * x.abs() + f64::MIN_POSITIVE;
        Interval { lo: (lo - ulp(lo)).min(f64::MAX), hi: (hi + ulp(hi)).max(f64::MIN) }
    }

    fn is_finite(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// The largest absolute value in the range.
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// Sine over the range: its ends, and ±1 where a crest or trough lies inside.
    fn sin(self) -> Interval {
        let width = self.hi - self.lo;
        if width >= TAU || width.is_nan() {
            return Interval::new(-1.0, 1.0);
        }
        let (a, b) = (self.lo.sin(), self.hi.sin());
        let holds = |crest: f64| ((self.hi - crest) / TAU).floor() >= ((self.lo - crest) / TAU).ceil();
        let ends = Interval::around(a.min(b), a.max(b));
        Interval::new(
            if holds(-FRAC_PI_2) { -1.0 } else { ends.lo.max(-1.0) },
            if holds(FRAC_PI_2) { 1.0 } else { ends.hi.min(1.0) },
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
        Interval::outward(self.lo + b.lo, self.hi + b.hi)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Interval::outward(self.lo - b.hi, self.hi - b.lo)
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Interval::new(-self.hi, -self.lo)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        if !self.is_finite() || !b.is_finite() {
            return Interval::WHOLE; // 0 · ∞ is no number
        }
        // Of numbers; f64::min looks for what is none.
        let min = |a: f64, b: f64| if a < b { a } else { b };
        let max = |a: f64, b: f64| if a > b { a } else { b };
        let [p, q, r, s] = [self.lo * b.lo, self.lo * b.hi, self.hi * b.lo, self.hi * b.hi];
        Interval::outward(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)))
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        if b.lo <= 0.0 && b.hi >= 0.0 {
            return Interval::WHOLE;
        }
        self * Interval::outward(1.0 / b.hi, 1.0 / b.lo)
    }
}

impl From<f64> for Interval {
    fn from(x: f64) -> Self {
        Interval::new(x, x)
    }
}

impl Scalar for Interval {
    fn sqrt(self) -> Self {
        Interval::outward(self.lo.max(0.0).sqrt(), self.hi.max(0.0).sqrt())
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), (self + Interval::around(FRAC_PI_2, FRAC_PI_2)).sin())
    }

    fn cos_sinc_of_square(self) -> (Self, Self) {
        let (lo, hi) = (self.lo.max(0.0), self.hi.max(0.0));
        let ((cos_lo, sinc_lo), (cos_hi, sinc_hi)) = (lo.cos_sinc_of_square(), hi.cos_sinc_of_square());
        if hi > PI * PI {
            return (Interval::new(-1.0, 1.0), Interval::new(-0.22, 1.0));
        }
        (Interval::around(cos_hi, cos_lo), Interval::around(sinc_hi, sinc_lo))
    }

    fn angle_over_sine(self, _sine_squared: Self) -> Self {
        if self.lo <= -1.0 {
            return Interval::WHOLE; // grows without bound towards −1
        }
        let at = |c: f64| c.angle_over_sine((1.0 - c) * (1.0 + c));
        Interval::around(at(self.hi.min(1.0)), at(self.lo))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn range() -> impl Strategy<Value = (Interval, f64)> {
        (-7.0..7.0f64, 0.0..3.0f64, 0.0..=1.0f64)
            .prop_map(|(lo, width, at)| (Interval::new(lo, lo + width), lo + width * at))
    }

    fn holds(range: Interval, x: f64) -> bool {
        range.lo <= x && x <= range.hi
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
        fn ends_are_rounded_outwards(x in proptest::num::f64::ANY) {
            let out = Interval::outward(x, x);
            // Beyond the largest number there is nothing but infinity.
            prop_assert!(x.is_nan() || out.lo <= x.next_down() && out.hi >= x.next_up());
        }

        #[test]
        fn functions_hold_every_result((a, x) in range()) {
            let (sin, cos) = a.sin_cos();
            prop_assert!(holds(sin, x.sin()) && holds(cos, x.cos()));
            let square = Interval::new(a.lo.abs(), a.lo.abs() + (a.hi - a.lo));
            let inside = square.lo + (x - a.lo);
            prop_assert!(holds(square.sqrt(), inside.sqrt()));
            let (cos, sinc) = square.cos_sinc_of_square();
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

//! What a number must offer so that the formulas of [`crate::curve`] run on it.

use super::{Quat, Vec3};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or something that computes like one: plain (`f64`), with its
/// derivatives ([`super::Jet`]), or known only to lie in a range
/// ([`super::Interval`]).
///
/// The functions are those by which rotations differ from vectors, and the root. Each is
/// analytic where the curves need it, so that a formula written with them has no
/// branches and can be differentiated or bounded as it stands.
pub trait Scalar:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The scalar that stands for the number `x`.
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::from(x)
    }

    /// The square root, of a number above 0.
    fn sqrt(self) -> Self;

    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);

    /// cos √x and sin √x / √x, for x ≥ 0.
    fn cos_sinc_of_square(self) -> (Self, Self);

    /// φ / sin φ for an angle φ in [0, π) that is given by its cosine (`self`) and
    /// the square of its sine, of which the accurate one may be used.
    fn angle_over_sine(self, sine_squared: Self) -> Self;
}

impl Scalar for f64 {
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }

    fn cos_sinc_of_square(self) -> (Self, Self) {
        let x = self.sqrt();
        let (sin, cos) = libm::sincos(x);
        // Below 1e-8 the quotient's limit is exact to the last bit.
        (cos, if x < 1e-8 { 1.0 } else { sin / x })
    }

    fn angle_over_sine(self, sine_squared: Self) -> Self {
        let sine = sine_squared.sqrt();
        if sine == 0.0 { 1.0 } else { libm::atan2(sine, self) / sine }
    }
}

/// A plain number, of which keys are made: `f64`, or one of many ([`super::Lane`]).
pub trait Number: Scalar + PartialOrd {
    /// The logarithm of a unit quaternion.
    fn log(q: Quat<Self>) -> Vec3<Self>;

    /// Length and unit direction of the logarithm of a unit quaternion; both zero where its
    /// vector part is smaller than any normal number.
    fn polar(q: Quat<Self>) -> (Self, Vec3<Self>);

    /// The length of a vector.
    fn length(v: Vec3<Self>) -> Self;

    /// `then` where this number is below a limit, else `otherwise`.
    fn below(self, limit: f64, then: Self, otherwise: Self) -> Self;

    /// The larger of two numbers.
    fn larger(self, other: Self) -> Self;
}

impl Number for f64 {
    fn log(q: Quat) -> Vec3 {
        q.log()
    }

    fn polar(q: Quat) -> (f64, Vec3) {
        let sine = q.v.length();
        // The inverse of a smaller number may be infinite.
        if sine < f64::MIN_POSITIVE {
            (0.0, Vec3::ZERO)
        } else {
            (libm::atan2(sine, q.w), q.v * (1.0 / sine))
        }
    }

    fn length(v: Vec3) -> f64 {
        v.length()
    }

    fn below(self, limit: f64, then: f64, otherwise: f64) -> f64 {
        if self < limit { then } else { otherwise }
    }

    fn larger(self, other: f64) -> f64 {
        self.max(other)
    }
}

/// The length of a vector of any number of components, to a few units in the last place; it does
/// not overflow or underflow before the length itself does.
pub(super) fn norm<const N: usize>(components: [f64; N]) -> f64 {
    let square: f64 = components.iter().map(|x| x * x).sum();
    // What underflows beside such a sum is below its last digit.
    if (1e-280..1e280).contains(&square) {
        square.sqrt()
    } else {
        components.into_iter().fold(0.0, libm::hypot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn norm_is_the_length_at_every_scale(v in prop::array::uniform4(-1.0..1.0f64), exponent in -300..300i32) {
            let scale = 2f64.powi(exponent);
            let exact = v.iter().copied().fold(0.0, f64::hypot) * scale;
            let ours = norm(v.map(|x| x * scale));
            prop_assert!((ours - exact).abs() <= 1e-15 * exact, "{ours} {exact}");
        }
    }

    #[test]
    fn norm_at_the_ends_of_the_range() {
        assert_eq!(norm([0.0; 3]), 0.0);
        assert_eq!(norm([5e-324, 0.0, 0.0]), 5e-324);
        assert_eq!(norm([0.0, f64::MAX, 0.0]), f64::MAX);
        assert_eq!(norm([3e-200, 0.0, 4e-200]), 5e-200);
        assert_eq!(norm([f64::INFINITY, 0.0]), f64::INFINITY);
        assert!(norm([f64::NAN, 1.0]).is_nan());
    }

    #[test]
    fn cos_sinc_is_continuous_where_the_branch_is() {
        for x in [0.0, 1e-300, 1e-18, 0.99e-16, 1.01e-16, 1e-10, 1.0, 9.0] {
            let (cos, sinc) = f64::cos_sinc_of_square(x);
            assert!((cos - x.sqrt().cos()).abs() < 1e-15);
            let series = 1.0 - x / 6.0 + x * x / 120.0;
            if x < 1e-4 {
                assert!((sinc - series).abs() < 1e-15, "{x}");
            }
        }
    }

    #[test]
    fn angle_over_sine_inverts_the_sine() {
        for angle in [1e-200, 1e-12, 1e-6, 0.1, 1.5, 3.0, 3.13] {
            let (sin, cos) = f64::sin_cos(angle);
            let ratio = cos.angle_over_sine(sin * sin);
            assert!((ratio * sin - angle).abs() <= 4e-16 * angle.max(1e-3), "{angle}");
        }
    }
}

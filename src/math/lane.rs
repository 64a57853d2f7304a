//! A number whose functions have no branches and call nothing, so that a loop over many of
//! them becomes vector code.
//!
//! On rotations' angles the functions differ from those of the platform's library by a few
//! units of 1e-16, and their last digits are the same on every machine: only sums, products,
//! quotients and roots, which IEEE 754 rounds in one way, and none of them fused.
//!
//! Sine and cosine: the angle less the nearest multiple of π/2, in three parts (Cody and
//! Waite 1980), then Taylor's series on |r| ≤ π/4, where what follows the terms that are
//! taken is below 8e-20 and 2e-18. Arc tangent: the nearest of 0, π/8 and π/4 is taken off
//! by its addition theorem, and the series on |q| ≤ tan π/16 leaves 4e-18.

use super::{Number, Quat, Scalar, Vec3, widest};
use fearless_simd::{Simd, dispatch};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, FRAC_PI_8, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// One of many numbers that are computed side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Lane(pub f64);

impl Lane {
    /// Up to this angle sine and cosine are as exact as is said; far beyond it they are not.
    pub const LARGEST_ANGLE: f64 = 1e6;
}

macro_rules! operators {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl $operator for Lane {
            type Output = Lane;
            #[inline(always)]
            fn $method(self, b: Lane) -> Lane {
                Lane(self.0 $symbol b.0)
            }
        }
    )*};
}

operators!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Lane {
    type Output = Lane;
    #[inline(always)]
    fn neg(self) -> Lane {
        Lane(-self.0)
    }
}

impl From<f64> for Lane {
    #[inline(always)]
    fn from(x: f64) -> Lane {
        Lane(x)
    }
}

impl Scalar for Lane {
    #[inline(always)]
    fn sqrt(self) -> Lane {
        Lane(self.0.sqrt())
    }

    #[inline(always)]
    fn sin_cos(self) -> (Lane, Lane) {
        let (sin, cos) = sin_cos(self.0);
        (Lane(sin), Lane(cos))
    }

    #[inline(always)]
    fn cos_sinc_of_square(self) -> (Lane, Lane) {
        let x = self.0.sqrt();
        let (sin, cos) = sin_cos(x);
        let small = x < 1e-8;
        (Lane(cos), Lane(if small { 1.0 } else { sin / if small { 1.0 } else { x } }))
    }

    #[inline(always)]
    fn angle_over_sine(self, sine_squared: Lane) -> Lane {
        let sine = sine_squared.0.sqrt();
        let zero = sine == 0.0;
        Lane(if zero { 1.0 } else { angle(sine, self.0) / if zero { 1.0 } else { sine } })
    }
}

impl Number for Lane {
    #[inline(always)]
    fn log(q: Quat<Lane>) -> Vec3<Lane> {
        q.smooth_log()
    }

    #[inline(always)]
    fn polar(q: Quat<Lane>) -> (Lane, Vec3<Lane>) {
        let sine = Lane::length(q.v);
        let least = f64::MIN_POSITIVE;
        let scale = sine.below(least, Lane(0.0), Lane(1.0) / sine);
        (sine.below(least, Lane(0.0), Lane(angle(sine.0, q.w.0))), q.v * scale)
    }

    #[inline(always)]
    fn length(v: Vec3<Lane>) -> Lane {
        v.dot(v).sqrt()
    }

    #[inline(always)]
    fn below(self, limit: f64, then: Lane, otherwise: Lane) -> Lane {
        if self.0 < limit { then } else { otherwise }
    }

    #[inline(always)]
    fn larger(self, other: Lane) -> Lane {
        if self.0 < other.0 { other } else { self }
    }
}

/// Half the angles between rotations, pair by pair.
pub(crate) fn half_angles(a: &[Quat], b: &[Quat]) -> Vec<f64> {
    #[inline(always)]
    fn fill<S: Simd>(_: S, a: &[Quat], b: &[Quat], angles: &mut [f64]) {
        for ((half, &a), &b) in angles.iter_mut().zip(a).zip(b) {
            let step = a.conjugate() * b;
            *half = angle(step.v.dot(step.v).sqrt(), step.w.abs());
        }
    }
    let mut angles = vec![0.0; a.len()];
    dispatch!(widest(), simd => fill(simd, a, b, &mut angles));
    angles
}

/// Slerps the shorter way between pairs of rotations, each to its own share.
pub(crate) fn slerps(pairs: &[[Quat; 2]], shares: &[f64]) -> Vec<Quat> {
    #[inline(always)]
    fn fill<S: Simd>(_: S, pairs: &[[Quat; 2]], shares: &[f64], out: &mut [Quat]) {
        for ((q, &[a, b]), &share) in out.iter_mut().zip(pairs).zip(shares) {
            let (a, b) = (Quat::<Lane>::constant(a), Quat::<Lane>::constant(b));
            let turn = a.conjugate() * b;
            let sign = turn.w.below(0.0, Lane(-1.0), Lane(1.0));
            let shorter = Quat { w: turn.w * sign, v: turn.v * sign };
            let there = a * Quat::exp(Lane::log(shorter) * Lane(share));
            *q = Quat { w: there.w.0, v: Vec3::new(there.v.x.0, there.v.y.0, there.v.z.0) };
        }
    }
    let mut out = vec![Quat::IDENTITY; pairs.len()];
    dispatch!(widest(), simd => fill(simd, pairs, shares, &mut out));
    out
}

/// a₀ + a₁x + a₂x² + …, by four sums of every fourth term, which do not wait for each other.
#[inline(always)]
fn polynomial<const N: usize>(x: f64, coefficients: [f64; N]) -> f64 {
    let square = x * x;
    let fourth = square * square;
    let mut sums = [0.0; 4];
    for k in (0..N).rev() {
        sums[k % 4] = if k + 4 < N { coefficients[k] + fourth * sums[k % 4] } else { coefficients[k] };
    }
    (sums[0] + sums[1] * x) + (sums[2] + sums[3] * x) * square
}

/// ±1/(first · (first + 1)), times the next two, and so on: the terms of sine and cosine.
const fn factorials<const N: usize>(first: u32) -> [f64; N] {
    let (mut terms, mut term, mut k, mut i) = ([0.0; N], 1.0, first, 0);
    while i < N {
        term *= -((k * (k + 1)) as f64);
        terms[i] = 1.0 / term;
        k += 2;
        i += 1;
    }
    terms
}

/// −1/3, 1/5, −1/7 …: the terms of the arc tangent.
const fn odd_numbers<const N: usize>() -> [f64; N] {
    let (mut terms, mut i) = ([0.0; N], 0);
    while i < N {
        let odd = (2 * i + 3) as f64;
        terms[i] = if i % 2 == 0 { -1.0 / odd } else { 1.0 / odd };
        i += 1;
    }
    terms
}

const SINE: [f64; 8] = factorials(2);
const COSINE: [f64; 8] = factorials(1);
const ARC_TANGENT: [f64; 10] = odd_numbers();

#[inline(always)]
fn sin_cos(x: f64) -> (f64, f64) {
    /// Added and taken off again, it rounds to a whole number, which is then in the low bits.
    const ROUNDING: f64 = 1.5 * (1u64 << 52) as f64;
    /// π/2 in three parts; the first two have 33 bits, so that small multiples are exact.
    const PARTS: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
    let rounded = x * FRAC_2_PI + ROUNDING;
    let (quarters, k) = (rounded.to_bits(), rounded - ROUNDING);
    let r = ((x - k * PARTS[0]) - k * PARTS[1]) - k * PARTS[2];
    let z = r * r;
    let sin = r + r * z * polynomial(z, SINE);
    let cos = 1.0 + z * polynomial(z, COSINE);
    // Bits, not branches: at odd quarters the two change places, and signs follow.
    let odd = 0u64.wrapping_sub(quarters & 1);
    let pick = |a: f64, b: f64| (a.to_bits() & odd) | (b.to_bits() & !odd);
    let signs = [(quarters & 2) << 62, (quarters.wrapping_add(1) & 2) << 62];
    (f64::from_bits(pick(cos, sin) ^ signs[0]), f64::from_bits(pick(sin, cos) ^ signs[1]))
}

/// The angle in 0..=π of a sine, at least 0, and a cosine, of any common scale above 0.
#[inline(always)]
fn angle(sin: f64, cos: f64) -> f64 {
    const TAN_16TH: f64 = 0.198_912_367_379_658;
    const TAN_3_16THS: f64 = 0.668_178_637_919_298_9;
    const TAN_8TH: f64 = 0.414_213_562_373_095_03;
    let across = cos.abs();
    let flat = sin < across;
    let (low, high) = if flat { (sin, across) } else { (across, sin) };
    let (near, middle) = (low > TAN_3_16THS * high, low > TAN_16TH * high);
    let tangent = if near {
        1.0
    } else if middle {
        TAN_8TH
    } else {
        0.0
    };
    let offset = if near {
        FRAC_PI_4
    } else if middle {
        FRAC_PI_8
    } else {
        0.0
    };
    let q = (low - tangent * high) / (high + tangent * low);
    let z = q * q;
    let octant = offset + (q + q * z * polynomial(z, ARC_TANGENT));
    let quadrant = if flat { octant } else { FRAC_PI_2 - octant };
    if cos < 0.0 { PI - quadrant } else { quadrant }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn parts_of_a_quarter_are_a_quarter() {
        // 1.5707963267948966 and what float64 leaves of it, 6.123233995736766e-17.
        let low = 1.570_796_326_734_125_6 - FRAC_PI_2 + 6.077_100_506_303_966e-11;
        assert!((low - 6.123_233_995_736_766e-17).abs() < 1e-20);
    }

    proptest! {
        // The reduced angle is off by half a unit of π/4's last place, a polynomial's last
        // sum by another; the library's own result by a half.
        #[test]
        fn sine_and_cosine(x in prop_oneof![-4.0..4.0f64, -1e3..1e3f64, -1e6..1e6f64, Just(0.0)]) {
            let (sin, cos) = Lane(x).sin_cos();
            prop_assert!((sin.0 - x.sin()).abs() < 3e-16 && (cos.0 - x.cos()).abs() < 3e-16, "{x}");
        }

        #[test]
        fn sine_over_angle(x in prop_oneof![0.0..10.0f64, 0.0..1e-6f64, Just(0.0)]) {
            let (ours, theirs) = (Lane(x).cos_sinc_of_square(), x.cos_sinc_of_square());
            prop_assert!((ours.0.0 - theirs.0).abs() < 4e-16 && (ours.1.0 - theirs.1).abs() < 4e-16, "{x}");
        }

        #[test]
        fn polar_is_the_logarithm(v in prop::array::uniform3(-1.5..1.5f64), scale in prop_oneof![Just(1.0), Just(1e-310), Just(0.0)], sign in any::<bool>()) {
            let q = Quat::exp(Vec3::new(v[0], v[1], v[2]) * scale);
            let q = if sign { -q } else { q };
            let (angle, axis) = f64::polar(q);
            let lane = Lane::polar(Quat::constant(q));
            prop_assert!((lane.0.0 - angle).abs() < 1e-15);
            for (a, b) in [(lane.1.x.0, axis.x), (lane.1.y.0, axis.y), (lane.1.z.0, axis.z)] {
                prop_assert!((a - b).abs() < 1e-15);
            }
            prop_assert!(scale == 1.0 || (angle == 0.0 && axis == Vec3::ZERO));
            prop_assert!(scale < 1.0 || (axis * angle - q.log()).length() < 1e-14);
        }

        #[test]
        fn pairs_agree_with_the_plain_formulas(
            a in prop::array::uniform3(-1.5..1.5f64), b in prop::array::uniform3(-1.5..1.5f64), u in 0.0..1.0f64,
        ) {
            let [a, b] = [a, b].map(|[x, y, z]| Quat::exp(Vec3::new(x, y, z)));
            let half = half_angles(&[a], &[b])[0];
            prop_assert!((half - 0.5 * a.angle_to(b)).abs() < 1e-15);
            let theirs = glam::DQuat::from(a).slerp(glam::DQuat::from(b), u);
            // Both lose digits where two rotations are nearly half a turn apart.
            prop_assert!(slerps(&[[a, b]], &[u])[0].angle_to(theirs.into()) < 1e-7);
        }

        #[test]
        fn angle_over_sine(angle in prop_oneof![0.0..3.0f64, 0.0..1e-6f64, Just(0.0), 3.0..3.13f64]) {
            let (sin, cos) = angle.sin_cos();
            let (ours, theirs) = (Lane(cos).angle_over_sine(Lane(sin * sin)).0, cos.angle_over_sine(sin * sin));
            // The angle is good to a unit in the last place, the quotient to another.
            prop_assert!((ours - theirs).abs() <= 5e-16 * theirs, "{angle}: {ours} {theirs}");
        }
    }
}

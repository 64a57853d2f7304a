//! The two ways in which players blend two rotations.
//!
//! `slerp` turns at constant speed, as glTF asks for; `nlerp` blends the four numbers
//! straight and normalises. Both run along the same great arc of φ (half the turn):
//! slerp is at uφ, nlerp at ψ(u) = atan2(u sin φ, 1 − u + u cos φ). With
//! D = 1 − 2u(1−u)(1 − cos φ), the square of the blend's length, ψ′ = sin φ / D and
//! ψ″ = 2 (1 − 2u)(1 − cos φ) sin φ / D².

use crate::curve::Rates;
use crate::math::Quat;

/// How a player blends two rotations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Blend {
    Slerp,
    Nlerp,
}

impl Blend {
    /// The rotation at u between two keys, the shorter way; its length is not one by
    /// `nlerp`, which no angle minds.
    #[inline]
    pub(crate) fn between(self, a: Quat, b: Quat, u: f64) -> Quat {
        match self {
            Blend::Slerp => {
                let turn = a.conjugate() * b;
                let turn = if turn.w < 0.0 { -turn } else { turn };
                a * Quat::exp(turn.log() * u)
            }
            Blend::Nlerp => {
                let b = if a.dot(b) < 0.0 { -b } else { b };
                Quat { w: a.w * (1.0 - u) + b.w * u, v: a.v * (1.0 - u) + b.v * u }
            }
        }
    }
}

/// How much the lengths of two quaternions of four float32 numbers can differ: each
/// number is within 2⁻²⁵ of what makes its length 1.
pub(crate) const LENGTHS: f64 = 1.2e-7;

/// How much the lengths of neighbours differ, at most, or [`LENGTHS`]: quaternions of numbers
/// with fewer digits are less even.
pub(crate) fn lengths(written: &[[f32; 4]]) -> f64 {
    let length = |q: &[f32; 4]| q.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>().sqrt();
    let difference = |pair: &[[f32; 4]]| (length(&pair[0]) - length(&pair[1])).abs();
    written.windows(2).map(difference).fold(LENGTHS, f64::max)
}

/// What players may differ by, half an angle, in blending keys whose lengths are not
/// quite one, but differ by so much, and which are `turn` apart: the longer of two pulls the blend
/// towards it, by at most the difference of their lengths times sin uφ sin (1−u)φ / sin φ if it is one
/// of sines, or u(1−u) sin φ / D by `nlerp`: of either the half way is the most, tan(φ/2) / 2.
pub(crate) fn uneven_lengths(turn: f64, lengths: f64) -> f64 {
    0.5 * lengths * libm::tan(0.5 * turn)
}

/// Below this turn the drift is taken for a cube: digits would cancel.
const SMALL: f64 = 0.01;
/// Drift over the cube of the turn is √3/108 for tiny turns and grows with them: up to
/// `SMALL` it is at most this.
const CUBE: f64 = 0.016_038;

/// The same ratio up to half a radian, where it is 0.016241.
const MODERATE: f64 = 0.5;
const MODERATE_CUBE: f64 = 0.016_25;

/// The largest |ψ(u) − uφ|: how far `nlerp` gets from slerp between two keys that are φ
/// (half the turn, at most π/2) apart, as half an angle.
///
/// It is where ψ′ = φ: 2u(1−u)(1 − cos φ) = 1 − sin φ / φ.
#[inline]
pub(crate) fn largest_drift(turn: f64) -> f64 {
    if turn < SMALL { CUBE * turn * turn * turn } else { larger_drift(turn) }
}

/// The same or up to 1.4 % more, at the price of two products for turns of up to half a
/// radian.
#[inline]
pub(crate) fn drift_bound(turn: f64) -> f64 {
    if turn <= MODERATE { MODERATE_CUBE * turn * turn * turn } else { largest_drift(turn) }
}

fn larger_drift(turn: f64) -> f64 {
    let (sin, cos) = libm::sincos(turn);
    let product = (1.0 - sin / turn) / (2.0 * (1.0 - cos));
    let u = 0.5 * (1.0 - (1.0 - 4.0 * product).max(0.0).sqrt());
    let drift = (u * turn - libm::atan2(u * sin, 1.0 - u + u * cos)).abs();
    // Rounding is 1e-16 of the turn.
    drift + 1e-15 * turn
}

/// Largest speed and acceleration of `nlerp` from u = a to u = b, by u, as half angles.
pub(crate) fn rates(turn: f64, a: f64, b: f64) -> Rates {
    let (sin, cos) = libm::sincos(turn);
    let square = |u: f64| 1.0 - 2.0 * u * (1.0 - u) * (1.0 - cos);
    let least = square(0.5f64.clamp(a.min(b), a.max(b)));
    let off_centre = (1.0 - 2.0 * a).abs().max((1.0 - 2.0 * b).abs());
    // Rounding up covers that of these few operations.
    let up = 1.0 + 1e-14;
    Rates {
        speed: up * sin / least,
        acceleration: up * 2.0 * off_centre * (1.0 - cos) * sin / (least * least),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    fn keys(turn: f64) -> (Quat, Quat) {
        let a = Quat::exp(Vec3::new(0.3, -0.2, 0.5));
        (a, a * Quat::exp(Vec3::new(0.48, 0.6, 0.64) * turn))
    }

    /// Angle along the arc, signed: nlerp ahead of slerp is positive.
    fn drift(turn: f64, u: f64) -> f64 {
        let (a, b) = keys(turn);
        let gone = |blend: Blend| 0.5 * a.angle_to(blend.between(a, b, u));
        gone(Blend::Nlerp) - gone(Blend::Slerp)
    }

    #[test]
    fn both_meet_at_the_ends_and_half_way() {
        for turn in [1e-3, 0.2, 1.5] {
            for u in [0.0, 0.5, 1.0] {
                assert!(drift(turn, u).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn largest_drift_is_the_largest() {
        for turn in [1e-4, 0.0099, 0.0101, 0.05, 0.157, 0.5, 1.0, 1.57] {
            let measured = (0..=2000).map(|i| drift(turn, f64::from(i) / 2000.0).abs()).fold(0.0, f64::max);
            let bound = largest_drift(turn);
            // Measuring loses rounding; between its steps the crest is flat to 1e-6, and the
            // constant of small turns is 3e-5 above the truth.
            assert!(bound >= measured - 1e-16, "{turn}: {bound:e} {measured:e}");
            assert!(bound <= measured * (1.0 + 5e-5) + 1e-15, "{turn}: {bound:e} {measured:e}");
        }
        // A step of 18° drifts by less than 0.01°.
        assert!(2.0 * largest_drift(9f64.to_radians()).to_degrees() < 0.01);
    }

    #[test]
    fn drift_over_the_cube_grows() {
        let ratio = |turn: f64| largest_drift(turn) / turn.powi(3);
        let ratios: Vec<f64> = (1..=150).map(|i| ratio(0.0104 * f64::from(i))).collect();
        assert!(ratios.windows(2).all(|r| r[1] >= r[0] * (1.0 - 1e-8)));
        assert!(ratio(MODERATE) < MODERATE_CUBE && ratio(MODERATE) > 0.999 * MODERATE_CUBE);
        // Below 0.0104 the ratio lies between the limit and its value there.
        assert!(CUBE > ratios[0] && CUBE < 3f64.sqrt() / 108.0 * (1.0 + 1e-4));
    }

    #[test]
    fn rates_hold_the_differences() {
        for turn in [0.1, 0.7, 1.5] {
            let at = |u: f64| u * turn + drift(turn, u);
            for i in 0..40 {
                let (a, d) = (f64::from(i) / 40.0, 1.0 / 40.0);
                let rates = rates(turn, a, a + d);
                let d = d / 4.0;
                for u in [a + d, a + 2.0 * d, a + 3.0 * d] {
                    let speed = (at(u + d) - at(u - d)) / (2.0 * d);
                    let acceleration = (at(u + d) - 2.0 * at(u) + at(u - d)) / (d * d);
                    assert!(speed <= rates.speed + 1e-12);
                    assert!(acceleration.abs() <= rates.acceleration + 1e-10);
                    // On a fortieth the rates change by little.
                    assert!(acceleration.abs() >= 0.7 * rates.acceleration - 0.1 * turn.powi(3));
                }
            }
        }
    }

    #[test]
    fn longer_quaternions_pull_no_further_than_said() {
        for turn in [0.05, 0.5, 1.5] {
            let (a, b) = keys(turn);
            let long = Quat { w: b.w * (1.0 + LENGTHS), v: b.v * (1.0 + LENGTHS) };
            let straight = |u: f64| [1.0 - u, u];
            let sines = |u: f64| [((1.0 - u) * turn).sin(), (u * turn).sin()];
            for weights in [&straight as &dyn Fn(f64) -> [f64; 2], &sines] {
                let pulls = (0..=100).map(|i| {
                    let [first, second] = weights(f64::from(i) / 100.0);
                    let blend =
                        |b: Quat| Quat { w: a.w * first + b.w * second, v: a.v * first + b.v * second };
                    0.5 * blend(b).angle_to(blend(long))
                });
                let worst = pulls.fold(0.0, f64::max);
                let said = uneven_lengths(turn, LENGTHS);
                assert!(worst <= said + 1e-14 && worst > 0.99 * said, "{worst:e} {said:e}");
            }
        }
    }
}

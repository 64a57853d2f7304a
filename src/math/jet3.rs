//! Numbers that carry their first three derivatives.
//!
//! As [`super::Jet`], a derivative further: what the jerk of a motion needs. Source:
//! Griewank & Walther 2008, chapter 13; the rule of Faà di Bruno for f of a function.

use super::{Quat, Scalar, Vec3, stumpff};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value with its first, second and third derivative by one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet3(pub [f64; 4]);

impl Jet3 {
    /// The variable itself, at `value`.
    pub fn variable(value: f64) -> Jet3 {
        Jet3([value, 1.0, 0.0, 0.0])
    }

    /// f of this jet, f given with its derivatives at the value.
    fn chain(self, f: [f64; 4]) -> Jet3 {
        let [_, u1, u2, u3] = self.0;
        Jet3([
            f[0],
            f[1] * u1,
            f[2] * u1 * u1 + f[1] * u2,
            f[3] * u1 * u1 * u1 + 3.0 * f[2] * u1 * u2 + f[1] * u3,
        ])
    }

    fn zip(self, b: Jet3, of: impl Fn(f64, f64) -> f64) -> Jet3 {
        Jet3(std::array::from_fn(|i| of(self.0[i], b.0[i])))
    }
}

impl Add for Jet3 {
    type Output = Jet3;
    fn add(self, b: Jet3) -> Jet3 {
        self.zip(b, |a, b| a + b)
    }
}

impl Sub for Jet3 {
    type Output = Jet3;
    fn sub(self, b: Jet3) -> Jet3 {
        self.zip(b, |a, b| a - b)
    }
}

impl Neg for Jet3 {
    type Output = Jet3;
    fn neg(self) -> Jet3 {
        Jet3(self.0.map(|a| -a))
    }
}

impl Mul for Jet3 {
    type Output = Jet3;
    fn mul(self, b: Jet3) -> Jet3 {
        let (a, b) = (self.0, b.0);
        Jet3([
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
            a[3] * b[0] + 3.0 * (a[2] * b[1] + a[1] * b[2]) + a[0] * b[3],
        ])
    }
}

impl Div for Jet3 {
    type Output = Jet3;
    fn div(self, b: Jet3) -> Jet3 {
        let r = 1.0 / b.0[0];
        self * b.chain([r, -r * r, 2.0 * r * r * r, -6.0 * r * r * r * r])
    }
}

impl From<f64> for Jet3 {
    fn from(x: f64) -> Jet3 {
        Jet3([x, 0.0, 0.0, 0.0])
    }
}

impl Scalar for Jet3 {
    fn sqrt(self) -> Jet3 {
        let x = self.0[0];
        let root = x.sqrt();
        let first = 0.5 / root;
        self.chain([root, first, -0.5 * first / x, 0.75 * first / (x * x)])
    }

    fn sin_cos(self) -> (Jet3, Jet3) {
        let (sin, cos) = libm::sincos(self.0[0]);
        (self.chain([sin, cos, -sin, -cos]), self.chain([cos, -sin, -cos, sin]))
    }

    fn cos_sinc_of_square(self) -> (Jet3, Jet3) {
        // c_k′ = (k c_{k+2} − c_{k+1}) / 2, three times.
        let c: [f64; 8] = stumpff(self.0[0]);
        let first = 0.5 * (c[3] - c[2]);
        let second = 0.25 * (3.0 * (c[5] - c[4]) + c[3]);
        let third = 0.125 * (15.0 * (c[7] - c[6]) + 6.0 * c[5] - c[4]);
        (
            self.chain([c[0], -0.5 * c[1], -0.5 * first, -0.5 * second]),
            self.chain([c[1], first, second, third]),
        )
    }

    fn angle_over_sine(self, _sine_squared: Jet3) -> Jet3 {
        self.chain(angle_over_sine_derivatives(self.0[0]))
    }
}

/// g, g′, g″ and g‴ at c for g(c) = arccos c / √(1 − c²), which solves (1 − c²) g′ = c g − 1;
/// hence (1 − c²) g⁽ⁿ⁺¹⁾ = (2n + 1) c g⁽ⁿ⁾ + n² g⁽ⁿ⁻¹⁾ for n ≥ 1. Near c = 1, where that
/// divides by nearly 0, the series Σ a_k (1 − c)ᵏ with a₀ = 1, a_{k+1} = a_k (k+1)/(2k+3):
/// thirty terms leave 8⁻³⁰ for 1 − c ≤ 1/4.
fn angle_over_sine_derivatives(c: f64) -> [f64; 4] {
    let c = c.min(1.0);
    let y = 1.0 - c;
    if y >= 0.25 {
        let sine_squared = y * (1.0 + c);
        let g = c.angle_over_sine(sine_squared);
        let first = (c * g - 1.0) / sine_squared;
        let second = (g + 3.0 * c * first) / sine_squared;
        return [g, first, second, (4.0 * first + 5.0 * c * second) / sine_squared];
    }
    let (mut g, mut a, mut power) = ([0.0; 4], 1.0, [0.0, 0.0, 0.0, 1.0]); // powers k−3 … k of y
    for k in 0..30 {
        let n = f64::from(k);
        g[0] += a * power[3];
        g[1] -= a * n * power[2];
        g[2] += a * n * (n - 1.0) * power[1];
        g[3] -= a * n * (n - 1.0) * (n - 2.0) * power[0];
        a *= (n + 1.0) / (2.0 * n + 3.0);
        power = [power[1], power[2], power[3], power[3] * y];
    }
    g
}

impl Quat<Jet3> {
    /// Angular velocity, acceleration and jerk, radians, by the jet's variable: each the
    /// derivative of the one before as seen from outside, written in the body's axes.
    ///
    /// With q′ = q v, half the velocity is v, half the acceleration v′ the vector part of
    /// q⁻¹ q″, and v″ = vec(q⁻¹ q‴) − v × v′ + |v|² v. Seen from outside, a vector a in the
    /// body's axes changes by a′ + 2v × a: the jerk is 2v″ + 4v × v′.
    pub fn angular_rates(self) -> [Vec3; 3] {
        let part =
            |i: usize| Quat { w: self.w.0[i], v: Vec3::new(self.v.x.0[i], self.v.y.0[i], self.v.z.0[i]) };
        let inverse = part(0).conjugate();
        let [v, acceleration, third] = [1, 2, 3].map(|i| (inverse * part(i)).v);
        let across = v.cross(acceleration);
        [v * 2.0, acceleration * 2.0, (third + across + v * v.dot(v)) * 2.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Jet;

    /// The third derivative as a central difference of the second, which [`Jet`] gives.
    fn difference(f: impl Fn(Jet) -> Jet, x: f64) -> f64 {
        let h = 1e-4;
        let second = |x: f64| f(Jet::variable(x)).second;
        (second(x + h) - second(x - h)) / (2.0 * h)
    }

    #[track_caller]
    fn agree(jet: Jet3, plain: impl Fn(Jet) -> Jet, x: f64) {
        let lower = plain(Jet::variable(x));
        for (ours, theirs) in jet.0.iter().zip([lower.value, lower.first, lower.second]) {
            assert!((ours - theirs).abs() < 1e-12 * (1.0 + theirs.abs()), "{x}: {jet:?} {lower:?}");
        }
        // The difference errs by h² times a fifth derivative, and eps/h.
        let third = difference(plain, x);
        assert!((jet.0[3] - third).abs() < 1e-5 * (1.0 + third.abs()), "{x}: {jet:?} {third}");
    }

    #[test]
    fn every_function_agrees_with_the_lower_jet_and_its_differences() {
        for x in [1e-3, 0.3, 0.9, 1.1, 4.0] {
            let u = Jet3::variable(x);
            agree(u.cos_sinc_of_square().0, |u| u.cos_sinc_of_square().0, x);
            agree(u.cos_sinc_of_square().1, |u| u.cos_sinc_of_square().1, x);
        }
        for x in [0.3, 1.0, 4.0] {
            agree(Jet3::variable(x).sqrt(), |u| u.sqrt(), x);
        }
        for x in [-0.6, 0.0, 0.4, 0.74, 0.76, 0.98] {
            let (u, one) = (Jet3::variable(x), Jet3::constant(1.0));
            agree(u.angle_over_sine(one), |u| u.angle_over_sine(u), x);
            agree(u.sin_cos().0 / (u + one + one), |u| u.sin_cos().0 / (u + Jet::constant(2.0)), x);
        }
    }

    #[test]
    fn powers_have_their_derivatives() {
        let u = Jet3::variable(2.0);
        assert_eq!((u * u * u).0, [8.0, 12.0, 12.0, 6.0]);
        let one = Jet3::constant(1.0);
        assert_eq!((one / u).0, [0.5, -0.25, 0.25, -0.375]);
    }

    #[test]
    fn a_growing_turn_about_one_axis_has_jerk() {
        // The angle is 0.7 u³: 2.1 u², 4.2 u and 4.2.
        let u = Jet3::variable(0.6);
        let axis = Vec3::constant(Vec3::new(0.6, 0.0, 0.8));
        let q = Quat::exp(axis * (u * u * u * Jet3::constant(0.35)));
        let [speed, acceleration, jerk] = q.angular_rates().map(Vec3::length);
        assert!((speed - 2.1 * 0.36).abs() < 1e-14);
        assert!((acceleration - 4.2 * 0.6).abs() < 1e-13);
        assert!((jerk - 4.2).abs() < 1e-12);
    }

    #[test]
    fn a_spinning_top_has_the_jerk_of_its_precession() {
        // Spin b about x, carried round z at a: ω = a z + b x(t), where x(t) turns at a;
        // ω′ is ab long, and ω″, seen from outside, a²b.
        let (a, b) = (1.3, 2.9);
        let u = Jet3::variable(0.8);
        let about =
            |axis: Vec3, rate: f64| Quat::exp(Vec3::constant(axis) * (u * Jet3::constant(0.5 * rate)));
        let q = about(Vec3::new(0.0, 0.0, 1.0), a) * about(Vec3::new(1.0, 0.0, 0.0), b);
        let [speed, acceleration, jerk] = q.angular_rates().map(Vec3::length);
        assert!((speed - (a * a + b * b).sqrt()).abs() < 1e-13);
        assert!((acceleration - a * b).abs() < 1e-13);
        assert!((jerk - a * a * b).abs() < 1e-12);
    }
}

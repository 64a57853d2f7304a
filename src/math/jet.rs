//! Numbers that carry their first and second derivative.
//!
//! A formula evaluated at `Jet::variable(u)` yields its value and both derivatives
//! with respect to u, exact to rounding: the rules of differentiation, applied
//! along the way. Source: Griewank & Walther 2008, chapter 13 (Taylor arithmetic).

use super::{Interval, Quat, Scalar, Vec3};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value with its first and second derivative by one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<B = f64> {
    /// The value.
    pub value: B,
    /// The first derivative.
    pub first: B,
    /// The second derivative.
    pub second: B,
}

/// What a jet's components must offer besides [`Scalar`]: the two special functions
/// with their first two derivatives.
pub trait Base: Scalar {
    /// f, f′ and f″ at x for cos √x, and the same for sin √x / √x.
    fn cos_sinc_derivatives(self) -> ([Self; 3], [Self; 3]);
    /// g, g′ and g″ at c for g(c) = arccos c / √(1 − c²).
    fn angle_over_sine_derivatives(self) -> [Self; 3];
}

impl<B: Scalar> Jet<B> {
    /// The variable itself, at `value`.
    pub fn variable(value: B) -> Self {
        Jet { value, first: B::constant(1.0), second: B::constant(0.0) }
    }

    /// f of this jet by the chain rule, f given with its derivatives at `value`.
    fn chain(self, [f, df, ddf]: [B; 3]) -> Self {
        Jet { value: f, first: df * self.first, second: ddf * self.first * self.first + df * self.second }
    }
}

impl<B: Scalar> Add for Jet<B> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Jet { value: self.value + b.value, first: self.first + b.first, second: self.second + b.second }
    }
}

impl<B: Scalar> Sub for Jet<B> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Jet { value: self.value - b.value, first: self.first - b.first, second: self.second - b.second }
    }
}

impl<B: Scalar> Neg for Jet<B> {
    type Output = Self;
    fn neg(self) -> Self {
        Jet { value: -self.value, first: -self.first, second: -self.second }
    }
}

impl<B: Scalar> Mul for Jet<B> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let both = self.first * b.first;
        Jet {
            value: self.value * b.value,
            first: self.first * b.value + self.value * b.first,
            second: self.second * b.value + (both + both) + self.value * b.second,
        }
    }
}

impl<B: Scalar> Div for Jet<B> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let (one, two) = (B::constant(1.0), B::constant(2.0));
        let r = one / b.value;
        self * b.chain([r, -(r * r), two * r * r * r])
    }
}

impl<B: Base> From<f64> for Jet<B> {
    fn from(x: f64) -> Self {
        Jet { value: B::constant(x), first: B::constant(0.0), second: B::constant(0.0) }
    }
}

impl<B: Base> Scalar for Jet<B> {
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let first = B::constant(0.5) / root;
        self.chain([root, first, B::constant(-0.5) * first / self.value])
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain([sin, cos, -sin]), self.chain([cos, -sin, -cos]))
    }

    fn cos_sinc_of_square(self) -> (Self, Self) {
        let (cos, sinc) = self.value.cos_sinc_derivatives();
        (self.chain(cos), self.chain(sinc))
    }

    fn angle_over_sine(self, _sine_squared: Self) -> Self {
        self.chain(self.value.angle_over_sine_derivatives())
    }
}

impl<B: Base> Quat<Jet<B>> {
    /// Angular velocity (half of it: the unit of logarithms) in the body's frame, by
    /// the jet's variable: the vector part of q⁻¹ q′.
    pub fn half_velocity(self) -> Vec3<B> {
        (self.part(|j| j.value).conjugate() * self.part(|j| j.first)).v
    }

    /// Half the angular acceleration in the body's frame, by the jet's variable: the
    /// vector part of q⁻¹ q″ (q⁻¹′ q′ is a real number).
    pub fn half_acceleration(self) -> Vec3<B> {
        (self.part(|j| j.value).conjugate() * self.part(|j| j.second)).v
    }

    /// The quaternion of the values alone.
    pub fn value(self) -> Quat<B> {
        self.part(|j| j.value)
    }

    fn part(self, of: impl Fn(Jet<B>) -> B) -> Quat<B> {
        Quat { w: of(self.w), v: Vec3::new(of(self.v.x), of(self.v.y), of(self.v.z)) }
    }
}

/// The first Stumpff functions c₀, c₁, …, c_k(x) = Σᵢ (−x)ⁱ / (k + 2i)!, for x ≥ 0: c₀ and
/// c₁ are cos √x and sin √x / √x, and c_k = 1/k! − x c_{k+2}. Source: Stumpff 1959.
pub(crate) fn stumpff<const N: usize>(x: f64) -> [f64; N] {
    if x < 1.0 {
        // The last two by the series, of which ten terms leave less than k!/(k + 20)! of the
        // first; the others from those.
        let mut c = [0.0; N];
        let first = |k: usize| 1.0 / (1..=k).map(|i| i as f64).product::<f64>();
        for (k, sum) in c.iter_mut().enumerate().skip(N - 2) {
            let mut term = first(k);
            for i in 0..10 {
                *sum += term;
                let n = (k + 2 * i) as f64;
                term *= -x / ((n + 1.0) * (n + 2.0));
            }
        }
        for k in (0..N - 2).rev() {
            c[k] = first(k) - x * c[k + 2];
        }
        return c;
    }
    let (cos, sinc) = x.cos_sinc_of_square();
    let (mut c, mut factorial) = ([0.0; N], 1.0);
    c[..2].copy_from_slice(&[cos, sinc]);
    for k in 2..N {
        // From (k − 2)! to (k − 1)!.
        c[k] = (1.0 / factorial - c[k - 2]) / x;
        factorial *= (k - 1) as f64;
    }
    c
}

/// Derivatives of c₀ and c₁ from c_k′ = (k c_{k+2} − c_{k+1}) / 2.
fn from_stumpff<B: Scalar>(c: [B; 6]) -> ([B; 3], [B; 3]) {
    let k = B::constant;
    let first = (c[3] - c[2]) * k(0.5);
    let second = (k(3.0) * c[5] - k(3.0) * c[4] + c[3]) * k(0.25);
    ([c[0], c[1] * k(-0.5), first * k(-0.5)], [c[1], first, second])
}

impl Base for f64 {
    fn cos_sinc_derivatives(self) -> ([f64; 3], [f64; 3]) {
        from_stumpff(stumpff(self))
    }

    fn angle_over_sine_derivatives(self) -> [f64; 3] {
        let c = self.min(1.0);
        let y = 1.0 - c;
        if y < 0.25 {
            return near_one(y);
        }
        let sine_squared = y * (1.0 + c);
        let g = c.angle_over_sine(sine_squared);
        let dg = (c * g - 1.0) / sine_squared;
        [g, dg, (g + 3.0 * c * dg) / sine_squared]
    }
}

/// arccos c / √(1 − c²) and its derivatives by c as a series in y = 1 − c: Σ a_k yᵏ with
/// a₀ = 1 and a_{k+1} = a_k (k+1)/(2k+3). From the third on, terms of g″ fall by a third and
/// more for y ≤ 1/4: what is left after one is less than it.
fn near_one(y: f64) -> [f64; 3] {
    let (mut g, mut dg, mut ddg) = (0.0, 0.0, 0.0);
    let (mut a, mut power) = (1.0, [0.0, 0.0, 1.0]); // powers k−2, k−1, k of y
    for k in 0..30 {
        let n = f64::from(k);
        let last = n * (n - 1.0) * a * power[0];
        g += a * power[2];
        dg -= n * a * power[1];
        ddg += last;
        if k > 2 && last < 1e-18 {
            break;
        }
        a *= (n + 1.0) / (2.0 * n + 3.0);
        power = [power[1], power[2], power[2] * y];
    }
    [g, dg, ddg]
}

impl Base for Interval {
    fn cos_sinc_derivatives(self) -> ([Interval; 3], [Interval; 3]) {
        from_stumpff(self.stumpff_ranges())
    }

    fn angle_over_sine_derivatives(self) -> [Interval; 3] {
        let (lo, hi) = (self.lo(), self.hi().min(1.0));
        if lo <= -1.0 {
            return [Interval::WHOLE; 3];
        }
        // Every coefficient of the series in 1 − c is positive, so g and g″ fall and g′
        // grows over the whole of (−1, 1].
        let at_least = lo.angle_over_sine_derivatives();
        let at_most = hi.angle_over_sine_derivatives();
        [
            Interval::around(at_most[0], at_least[0]),
            Interval::around(at_least[1], at_most[1]),
            Interval::around(at_most[2], at_least[2]),
        ]
    }
}

impl Interval {
    /// Ranges of the Stumpff functions over this interval; they fall up to x = π².
    fn stumpff_ranges(self) -> [Interval; 6] {
        const LEAST: [f64; 6] = [-1.0, -0.22, 0.0, 0.0, 0.0, 0.0];
        let (lo, hi) = (self.lo().max(0.0), self.hi().max(0.0));
        let at_lo: [f64; 6] = stumpff(lo);
        let far = hi > std::f64::consts::PI.powi(2);
        let at_hi = if far { LEAST } else { stumpff(hi) };
        let top = if far { stumpff(0.0) } else { at_lo };
        std::array::from_fn(|k| Interval::around(at_hi[k], top[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of a function and its two derivatives.
    fn differences(f: impl Fn(f64) -> f64, x: f64) -> [f64; 3] {
        let h = 1e-4;
        let (below, at, above) = (f(x - h), f(x), f(x + h));
        [at, (above - below) / (2.0 * h), (above - 2.0 * at + below) / (h * h)]
    }

    fn assert_near(ours: [f64; 3], theirs: [f64; 3], what: &str) {
        // The second difference loses eps/h² = 2e-8 and errs by h² f⁗/12.
        for (a, b) in ours.iter().zip(theirs) {
            assert!((a - b).abs() < 2e-6 * (1.0 + b.abs()), "{what}: {ours:?} {theirs:?}");
        }
    }

    #[test]
    fn special_functions_match_differences() {
        for x in [0.01, 0.5, 0.999, 1.001, 3.0, 9.0] {
            let (cos, sinc) = x.cos_sinc_derivatives();
            assert_near(cos, differences(|x| x.sqrt().cos(), x), "cos");
            assert_near(sinc, differences(|x| x.sqrt().sin() / x.sqrt(), x), "sinc");
        }
        for c in [-0.7, 0.0, 0.5, 0.7499, 0.7501, 0.99] {
            let g = |c: f64| c.acos() / (1.0 - c * c).sqrt();
            assert_near(c.angle_over_sine_derivatives(), differences(g, c), "g");
        }
    }

    #[test]
    fn both_branches_meet() {
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        let (below, above) = (1.0f64.next_down(), 1.0f64);
        assert!(near(below.cos_sinc_derivatives().0, above.cos_sinc_derivatives().0));
        assert!(near(below.cos_sinc_derivatives().1, above.cos_sinc_derivatives().1));
        assert!(near(0.75f64.angle_over_sine_derivatives(), 0.75f64.next_up().angle_over_sine_derivatives()));
    }

    #[test]
    fn quotient_rule() {
        let u = Jet::variable(0.3);
        let (sin, cos) = u.sin_cos();
        let tan = sin / cos;
        let t = 0.3f64.tan();
        assert!((tan.first - (1.0 + t * t)).abs() < 1e-14);
        assert!((tan.second - 2.0 * t * (1.0 + t * t)).abs() < 1e-14);
    }

    #[test]
    fn square_root_rule() {
        let root = (Jet::variable(0.3) * Jet::constant(4.0) + Jet::constant(1.0)).sqrt();
        // √(1 + 4u): 2/√, −4/√³.
        let x = 2.2f64.sqrt();
        assert!((root.value - x).abs() < 1e-15 && (root.first - 2.0 / x).abs() < 1e-15);
        assert!((root.second + 4.0 / x.powi(3)).abs() < 1e-15);
    }

    #[test]
    fn steady_turn_has_velocity_and_no_acceleration() {
        let u = Jet::variable(0.4);
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let q = Quat::exp(Vec3::constant(axis) * (u * Jet::constant(1.5)));
        assert!((q.half_velocity() - axis * 1.5).length() < 1e-14);
        assert!(q.half_acceleration().length() < 1e-14);
    }
}

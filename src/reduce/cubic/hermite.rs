//! One interval of CUBICSPLINE playback: Hermite's cubic of the numbers in the file.

use crate::curve::Rates;
use crate::math::Quat;
use crate::reduce::value::{Numbers, Step, Value};

/// Covers the rounding of the few operations that bounds take.
const UP: f64 = 1.0 + 1e-12;

/// A cubic over u in 0..=1, by its ends and its derivatives by u there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hermite<const N: usize> {
    pub(crate) ends: [Numbers<N>; 2],
    pub(crate) slopes: [Numbers<N>; 2],
}

/// Where a fitted cubic meets its curve between the ends.
///
/// The error of an interpolating cubic is about a quartic that vanishes at both ends and
/// at these two places. Chebyshev's fourth polynomial, stretched so that its outer zeros
/// are the ends, is the smallest of those; its inner zeros are at tan(π/8) of the way
/// from the middle to an end.
const MEETS: [f64; 2] = [0.5 - 0.5 * TAN_EIGHTH, 0.5 + 0.5 * TAN_EIGHTH];
const TAN_EIGHTH: f64 = std::f64::consts::SQRT_2 - 1.0;

impl<const N: usize> Hermite<N> {
    /// The cubic between two ends that meets `inner` at the two places of a good fit.
    pub(crate) fn through(ends: [Numbers<N>; 2], inner: impl Fn(f64) -> Numbers<N>) -> Hermite<N> {
        let flat = Hermite { ends, slopes: [Numbers::ZERO; 2] };
        let [a, b] = MEETS.map(|u| inner(u) - flat.at(u));
        // u(1−u)² m₀ − u²(1−u) m₁ at u and at 1 − u: two equations, mirror images.
        let u = MEETS[0];
        let (near, far) = (u * (1.0 - u) * (1.0 - u), u * u * (1.0 - u));
        let scale = 1.0 / (near * near - far * far);
        let slopes = [(a * near - b * far) * scale, (a * far - b * near) * scale];
        Hermite { ends, slopes }
    }

    /// The value at u.
    pub(crate) fn at(&self, u: f64) -> Numbers<N> {
        let v = 1.0 - u;
        let ends = self.ends[0] * (v * v * (1.0 + 2.0 * u)) + self.ends[1] * (u * u * (1.0 + 2.0 * v));
        ends + self.slopes[0] * (u * v * v) - self.slopes[1] * (u * u * v)
    }

    /// The first three derivatives by u.
    fn derivatives(&self, u: f64) -> [Numbers<N>; 3] {
        let [p, q] = self.ends;
        let [m, n] = self.slopes;
        // p + m u + c u² + d u³
        let c = (q - p) * 3.0 - m * 2.0 - n;
        let d = (p - q) * 2.0 + m + n;
        [m + c * (2.0 * u) + d * (3.0 * u * u), c * 2.0 + d * (6.0 * u), d * 6.0]
    }

    /// Bézier's control points of the part from u = a to u = b.
    pub(crate) fn control_points(&self, a: f64, b: f64) -> [Numbers<N>; 4] {
        let (from, to) = (self.at(a), self.at(b));
        let third = (b - a) / 3.0;
        let slope = |u: f64| self.derivatives(u)[0] * third;
        [from, from + slope(a), to - slope(b), to]
    }
}

/// A value that CUBICSPLINE playback blends as N numbers.
pub trait Flat<const N: usize>: Value<Stored = [f32; N]> {
    /// The value as numbers that follow `before` continuously.
    fn flat(self, before: Option<Numbers<N>>) -> Numbers<N>;
    /// What a player makes of blended numbers.
    fn shown(numbers: Numbers<N>) -> Self;
    /// Upper bounds of the speed and the acceleration of what is shown of numbers that have
    /// these values and derivatives by u half way of a part, up to `reach` on either side.
    fn shown_rates(numbers: Numbers<N>, derivatives: [Numbers<N>; 3], reach: f64) -> Rates;
}

impl<const N: usize> Flat<N> for Numbers<N> {
    fn flat(self, _before: Option<Numbers<N>>) -> Numbers<N> {
        self
    }

    fn shown(numbers: Numbers<N>) -> Self {
        numbers
    }

    fn shown_rates(_: Numbers<N>, [first, second, third]: [Numbers<N>; 3], reach: f64) -> Rates {
        let acceleration = second.length() + third.length() * reach;
        Rates { speed: UP * (first.length() + acceleration * reach), acceleration: UP * acceleration }
    }
}

/// Rotations are normalised. With the length r and the direction n of the numbers, the
/// direction turns by n′ = H′⊥ / r, and along the sphere its second derivative is
/// (H″⊥ − 2 (n·H′) n′) / r, where ⊥ means at a right angle to n.
impl Flat<4> for Quat {
    fn flat(self, before: Option<Numbers<4>>) -> Numbers<4> {
        let numbers = Numbers(self.to_xyzw());
        match before {
            Some(before) if before.dot(numbers) < 0.0 => numbers * -1.0,
            _ => numbers,
        }
    }

    fn shown(numbers: Numbers<4>) -> Quat {
        Quat::from_xyzw((numbers * (1.0 / numbers.length())).0)
    }

    fn shown_rates(h: Numbers<4>, [first, second, third]: [Numbers<4>; 3], reach: f64) -> Rates {
        let bend = second.length() + third.length() * reach;
        let fastest = first.length() + bend * reach;
        let (length, moved) = (h.length(), fastest * reach);
        let shortest = length - moved;
        // What is no number is unbounded too.
        let near = shortest > 0.25 * length;
        if !near {
            return Rates { speed: f64::INFINITY, acceleration: f64::INFINITY };
        }
        let n = h * (1.0 / length);
        let across = |v: Numbers<4>| v - n * n.dot(v);
        // By how much n, n·H′ and H′⊥ / r can differ from those half way.
        let turned = moved / shortest;
        let first_off = bend * reach + fastest * turned;
        let (along, turn) = (n.dot(first), across(first) * (1.0 / length));
        let turn_off = (first_off + turn.length() * moved) / shortest;
        let bent = (across(second) - turn * (2.0 * along)).length();
        let second_off = third.length() * reach + bend * turned;
        let product_off = first_off * (turn.length() + turn_off) + along.abs() * turn_off;
        Rates {
            speed: UP * (turn.length() + turn_off),
            acceleration: UP * (bent + second_off + 2.0 * product_off) / shortest,
        }
    }
}

impl<const N: usize> Hermite<N> {
    /// Upper bounds of the speed and acceleration, by u, of what is shown from u = a to b.
    pub(crate) fn rates<V: Flat<N>>(&self, a: f64, b: f64) -> Rates {
        let middle = 0.5 * (a + b);
        V::shown_rates(self.at(middle), self.derivatives(middle), 0.5 * (b - a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic() -> Hermite<4> {
        let ends = [Numbers([0.1, -0.2, 0.3, 0.92]), Numbers([0.5, 0.4, -0.1, 0.76])];
        Hermite { ends, slopes: [Numbers([0.3, 1.1, -0.4, -0.2]), Numbers([0.2, 0.6, -0.9, 0.1])] }
    }

    #[test]
    fn cubic_polynomials_are_met_everywhere() {
        let power = |u: f64| Numbers([1.0 - 2.0 * u * u * u, u * (1.0 - u), 3.0 * u]);
        let fitted = Hermite::through([power(0.0), power(1.0)], power);
        for i in 0..=20 {
            let u = f64::from(i) / 20.0;
            assert!((fitted.at(u) - power(u)).length() < 1e-14, "{u}");
        }
        let [leaving, arriving] = fitted.slopes;
        assert!((leaving - Numbers([0.0, 1.0, 3.0])).length() < 1e-13);
        assert!((arriving - Numbers([-6.0, -1.0, 3.0])).length() < 1e-13);
    }

    #[test]
    fn quartics_are_met_as_well_as_can_be() {
        // Chebyshev: the smallest monic quartic that vanishes at both ends is at most
        // (1 / (2 cos π/8))⁴ / 8.
        let fitted = Hermite::through([Numbers([0.0]), Numbers([1.0])], |u| Numbers([u.powi(4)]));
        let off = |u: f64| (fitted.at(u) - Numbers([u.powi(4)])).length();
        let worst = (0..=4000).map(|i| off(f64::from(i) / 4000.0)).fold(0.0, f64::max);
        let best = (0.5 / (std::f64::consts::PI / 8.0).cos()).powi(4) / 8.0;
        assert!((worst - best).abs() < 1e-6 * best, "{worst} {best}");
    }

    #[test]
    fn parts_have_their_control_points() {
        let (cubic, a, b) = (cubic(), 0.2, 0.7);
        let points = cubic.control_points(a, b);
        for i in 0..=10 {
            let u = f64::from(i) / 10.0;
            let v = 1.0 - u;
            let weights = [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u];
            let sum = points.iter().zip(weights).fold(Numbers::ZERO, |sum, (p, w)| sum + *p * w);
            assert!((sum - cubic.at(a + u * (b - a))).length() < 1e-14);
        }
    }

    #[test]
    fn rates_hold_what_is_shown_and_are_near() {
        let cubic = cubic();
        let shown = |u: f64| Quat::shown(cubic.at(u));
        let d = 1e-4;
        for parts in [4, 64] {
            for i in 0..parts {
                let (a, b) = (f64::from(i) / f64::from(parts), f64::from(i + 1) / f64::from(parts));
                let rates = cubic.rates::<Quat>(a, b);
                let (mut fastest, mut sharpest): (f64, f64) = (0.0, 0.0);
                for k in 0..=16 {
                    let u = a + (b - a) * f64::from(k) / 16.0;
                    let (before, here, after) = (shown(u - d), shown(u), shown(u + d));
                    let (back, on) = (here.step_to(before), here.step_to(after));
                    fastest = fastest.max((on - back).length() / (2.0 * d));
                    sharpest = sharpest.max((on + back).length() / (d * d));
                }
                assert!(
                    rates.speed >= fastest * (1.0 - 1e-6) && rates.acceleration >= sharpest * (1.0 - 1e-5)
                );
                if parts == 64 {
                    // On a 64th what is not known exactly is about 1/64 of |H′|³ and |H′||H″|.
                    assert!(rates.acceleration <= sharpest + 1.0, "{} {sharpest}", rates.acceleration);
                    assert!(rates.speed <= fastest + 0.2, "{} {fastest}", rates.speed);
                }
            }
        }
    }
}

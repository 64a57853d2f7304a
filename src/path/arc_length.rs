//! The length of a curve as a function of its parameter, and the parameter of a length.

use super::bezier::Bezier;

/// Nodes in (0, 1) and weights of Gauss–Legendre quadrature with ten points on −1..=1,
/// which is exact for polynomials up to degree 19; the other five mirror these.
const NODES: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// The error of a panel, relative to its length: a thousandth of what is promised.
const ACCURACY: f64 = 1e-12;

/// A step of Newton's method, in panels, after which the next would be lost in rounding.
const CONVERGED: f64 = 1e-8;

/// How often a panel is halved at most.
const DEPTH: u32 = 50;

/// The arc length of a curve without a point of rest inside: panels of its parameter
/// that are so short that one quadrature is accurate on each, and on any part of it.
#[derive(Clone, Debug)]
pub(super) struct ArcLength {
    /// Where panels meet: the parameter and the length up to there; first 0, 0.
    marks: Vec<(f64, f64)>,
}

impl ArcLength {
    /// Panels are halved until quadrature on the halves confirms that on the whole to
    /// a relative 1e-12 of its own length (or rounding of the curve's).
    pub(super) fn new(curve: &Bezier) -> ArcLength {
        let whole = quadrature(curve, 0.0, 1.0);
        let mut arc = ArcLength { marks: vec![(0.0, 0.0)] };
        arc.panel(curve, (0.0, 1.0), whole, 1e-15 * whole, DEPTH);
        arc.marks.shrink_to_fit();
        arc
    }

    fn panel(&mut self, curve: &Bezier, (a, b): (f64, f64), whole: f64, rounding: f64, depth: u32) {
        let middle = 0.5 * (a + b);
        let (left, right) = (quadrature(curve, a, middle), quadrature(curve, middle, b));
        let error = (left + right - whole).abs();
        if error <= (ACCURACY * (left + right)).max(rounding) || depth == 0 {
            let so_far = self.length();
            self.marks.push((middle, so_far + left));
            self.marks.push((b, so_far + left + right));
        } else {
            self.panel(curve, (a, middle), left, rounding, depth - 1);
            self.panel(curve, (middle, b), right, rounding, depth - 1);
        }
    }

    /// The length of the whole curve.
    pub(super) fn length(&self) -> f64 {
        self.marks.last().map_or(0.0, |mark| mark.1)
    }

    /// The length of the curve up to u.
    pub(super) fn up_to(&self, curve: &Bezier, u: f64) -> f64 {
        let after = self.marks.partition_point(|mark| mark.0 <= u).clamp(1, self.marks.len() - 1);
        let (from, length) = self.marks[after - 1];
        length + quadrature(curve, from, u)
    }

    /// The u up to which the curve is `s` long, 0 and 1 for lengths outside.
    ///
    /// Newton's method on the quadrature within one panel, from where the cubic with the panel's
    /// speeds at its ends is as long; where it would leave the bracket, or the speed is zero,
    /// the bracket is halved instead.
    pub(super) fn parameter(&self, curve: &Bezier, s: f64) -> f64 {
        if s <= 0.0 {
            return 0.0;
        }
        if s >= self.length() {
            return 1.0;
        }
        let after = self.marks.partition_point(|mark| mark.1 <= s).clamp(1, self.marks.len() - 1);
        let ((a, from), (b, to)) = (self.marks[after - 1], self.marks[after]);
        let (mut low, mut high) = (a, b);
        let mut u = a + (b - a) * guess(curve, (a, b), to - from, (s - from) / (to - from));
        for _ in 0..100 {
            let excess = quadrature(curve, a, u) - (s - from);
            if excess > 0.0 {
                high = u
            } else {
                low = u
            }
            let next = u - excess / curve.derivative(u).length();
            if next == u || excess.abs() <= 1e-15 * s || high - low <= f64::EPSILON * b {
                break;
            }
            // Not a number (0/0) fails the comparison too.
            let inside = next > low && next < high;
            // The next step is about the square of this one, in panels.
            if inside && (next - u).abs() <= CONVERGED * (b - a) {
                return next;
            }
            u = if inside { next } else { 0.5 * (low + high) };
        }
        u
    }
}

/// About what part of a panel from a to b a part x of its length takes: Hermite's cubic, or x where
/// the speed at an end is so low that it is no guide.
fn guess(curve: &Bezier, (a, b): (f64, f64), length: f64, x: f64) -> f64 {
    let slope = |u: f64| length / (curve.derivative(u).length() * (b - a));
    let (m, n, rest) = (slope(a), slope(b), 1.0 - x);
    let guess = x * x * (3.0 - 2.0 * x) + x * rest * (m * rest - n * x);
    if m < 3.0 && n < 3.0 { guess } else { x }
}

/// ∫|B′| from a to b.
fn quadrature(curve: &Bezier, a: f64, b: f64) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let speed = |u: f64| curve.derivative(u).length();
    half * NODES.iter().map(|&(x, w)| w * (speed(middle - half * x) + speed(middle + half * x))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn the_rule_is_exact_up_to_degree_nineteen() {
        for degree in 0..=18 {
            let sum: f64 = NODES.iter().map(|(x, w)| 2.0 * w * x.powi(degree)).sum();
            if degree % 2 == 0 {
                assert!((sum - 2.0 / f64::from(degree + 1)).abs() < 1e-15, "{degree}");
            }
        }
        // Degree 20 must fail, or the test above says nothing.
        let sum: f64 = NODES.iter().map(|(x, w)| 2.0 * w * x.powi(20)).sum();
        assert!((sum - 2.0 / 21.0).abs() > 1e-7);
    }

    #[test]
    fn a_parabola_has_its_length_in_closed_form() {
        // y = x² from 0 to 1: √5/2 + asinh(2)/4.
        let curve = Bezier::new(vec![DVec3::ZERO, DVec3::new(0.5, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0)]);
        let arc = ArcLength::new(&curve);
        let length = |x: f64| 0.5 * x * (1.0 + 4.0 * x * x).sqrt() + 0.25 * (2.0 * x).asinh();
        assert!((arc.length() - length(1.0)).abs() < 1e-14);
        for i in 0..=1000 {
            let u = f64::from(i) / 1000.0;
            assert!((arc.parameter(&curve, length(u)) - u).abs() < 1e-14, "{u}");
        }
    }
}

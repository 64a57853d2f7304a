//! A Bézier curve of any degree, its derivatives and its parts.

use glam::DVec3;

/// A Bézier curve over u in 0..=1.
#[derive(Clone, Debug)]
pub(super) struct Bezier {
    /// Control points P₀ … P_N, two or more.
    points: Vec<DVec3>,
    /// Control points N(Pᵢ₊₁ − Pᵢ) of the derivative, the hodograph.
    hodograph: Vec<DVec3>,
    /// The length of the longest of those.
    fastest: f64,
}

impl Bezier {
    /// The curve of degree `points.len()` − 1, which is at least 1.
    pub(super) fn new(points: Vec<DVec3>) -> Bezier {
        let hodograph = differences(&points);
        let fastest = longest(&hodograph);
        Bezier { points, hodograph, fastest }
    }

    /// The cubic from `start` to `end` with these derivatives at its ends.
    pub(super) fn hermite(start: DVec3, leaving: DVec3, arriving: DVec3, end: DVec3) -> Bezier {
        Bezier::new(vec![start, start + leaving / 3.0, end - arriving / 3.0, end])
    }

    /// Control points.
    pub(super) fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Control points of the first derivative.
    pub(super) fn hodograph(&self) -> &[DVec3] {
        &self.hodograph
    }

    /// Control points of the second derivative; none for a straight line.
    pub(super) fn second_hodograph(&self) -> Vec<DVec3> {
        differences(&self.hodograph)
    }

    /// B(u).
    pub(super) fn at(&self, u: f64) -> DVec3 {
        de_casteljau(&self.points, u)[0]
    }

    /// B′(u).
    pub(super) fn derivative(&self, u: f64) -> DVec3 {
        de_casteljau(&self.hodograph, u)[0]
    }

    /// B′(u) and B″(u).
    pub(super) fn derivatives(&self, u: f64) -> [DVec3; 2] {
        de_casteljau(&self.hodograph, u)
    }

    /// Its control points as those of a cubic, if its degree is 3 at most.
    pub(super) fn cubic(&self) -> Option<[DVec3; 4]> {
        let points = &self.points[..];
        match *points {
            [a, b] => Some([a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b]),
            [a, b, c] => Some([a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c]),
            [a, b, c, d] => Some([a, b, c, d]),
            _ => None,
        }
    }

    /// The largest control point of the derivative, an upper bound of |B′|.
    pub(super) fn fastest(&self) -> f64 {
        self.fastest
    }

    /// The curve up to u and the curve from u on.
    pub(super) fn split(&self, u: f64) -> [Bezier; 2] {
        let mut points = self.points.clone();
        let (mut left, mut right) = (vec![points[0]], vec![points[points.len() - 1]]);
        while points.len() > 1 {
            points = points.windows(2).map(|p| p[0].lerp(p[1], u)).collect();
            left.push(points[0]);
            right.push(points[points.len() - 1]);
        }
        right.reverse();
        [Bezier::new(left), Bezier::new(right)]
    }

    /// The curve from u = a to u = b, a < b.
    pub(super) fn part(&self, a: f64, b: f64) -> Bezier {
        let from_a = if a > 0.0 { &self.split(a)[1] } else { self };
        if b < 1.0 { from_a.split((b - a) / (1.0 - a))[0].clone() } else { from_a.clone() }
    }
}

/// The longest of some vectors.
pub(super) fn longest(vectors: &[DVec3]) -> f64 {
    vectors.iter().map(|v| v.length()).fold(0.0, f64::max)
}

/// N(Pᵢ₊₁ − Pᵢ): the control points of the derivative.
fn differences(points: &[DVec3]) -> Vec<DVec3> {
    let degree = points.len().saturating_sub(1) as f64;
    points.windows(2).map(|p| (p[1] - p[0]) * degree).collect()
}

/// Value and derivative by repeated interpolation, which is stable for every degree.
/// Source: de Casteljau; Farin, Curves and Surfaces for CAGD, chapters 4 and 5.
fn de_casteljau(points: &[DVec3], u: f64) -> [DVec3; 2] {
    match *points {
        // Lines, cubics and their derivatives, of which there may be thousands.
        [a] => [a, DVec3::ZERO],
        [a, b] => reduce(&mut [a, b], u),
        [a, b, c] => reduce(&mut [a, b, c], u),
        [a, b, c, d] => reduce(&mut [a, b, c, d], u),
        _ => reduce(&mut points.to_vec(), u),
    }
}

/// Inlined, where the number of points is known.
#[inline(always)]
fn reduce(points: &mut [DVec3], u: f64) -> [DVec3; 2] {
    let degree = points.len() - 1;
    for left in (2..=degree).rev() {
        for i in 0..left {
            points[i] = points[i].lerp(points[i + 1], u);
        }
    }
    match points {
        [value] => [*value, DVec3::ZERO],
        [a, b, ..] => [a.lerp(*b, u), (*b - *a) * degree as f64],
        [] => [DVec3::ZERO; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: [DVec3; 4] = [
        DVec3::new(0.201, 0.096, 0.100),
        DVec3::new(0.108, 0.682, 0.200),
        DVec3::new(0.727, 0.746, 0.300),
        DVec3::new(0.432, 0.197, 2.743),
    ];

    /// B(u) = Σ C(N,i) (1−u)ᴺ⁻ⁱ uⁱ Pᵢ, as it is printed.
    fn bernstein(points: &[DVec3], u: f64) -> DVec3 {
        let n = points.len() - 1;
        let mut choose = 1.0;
        let mut sum = DVec3::ZERO;
        for (i, p) in points.iter().enumerate() {
            sum += *p * (choose * (1.0 - u).powi((n - i) as i32) * u.powi(i as i32));
            choose *= (n - i) as f64 / (i + 1) as f64;
        }
        sum
    }

    #[test]
    fn the_printed_table_is_met() {
        let curve = Bezier::new(TABLE.to_vec());
        let expected = [(0.10, [0.192751, 0.256021, 0.132343]), (0.25, [0.239162, 0.436269, 0.211609])];
        for (u, point) in expected {
            assert!((curve.at(u) - DVec3::from_array(point)).length() < 2e-4, "{u}: {}", curve.at(u));
        }
    }

    #[test]
    fn every_degree_agrees_with_bernstein() {
        for degree in 1..=20 {
            let point = |i: usize| DVec3::new((i as f64).sin(), (2.0 * i as f64).cos(), i as f64 / 10.0);
            let points: Vec<DVec3> = (0..=degree).map(point).collect();
            let curve = Bezier::new(points.clone());
            for i in 0..=50 {
                let u = f64::from(i) / 50.0;
                assert!((curve.at(u) - bernstein(&points, u)).length() < 1e-14, "degree {degree} at {u}");
            }
            assert_eq!([curve.at(0.0), curve.at(1.0)], [points[0], points[degree]]);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_polynomial() {
        let curve = Bezier::new(TABLE.to_vec());
        let [p0, p1, p2, p3] = TABLE;
        for i in 0..=20 {
            let (u, v) = (f64::from(i) / 20.0, 1.0 - f64::from(i) / 20.0);
            let first = 3.0 * (v * v * (p1 - p0) + 2.0 * u * v * (p2 - p1) + u * u * (p3 - p2));
            let second = 6.0 * (v * (p2 - 2.0 * p1 + p0) + u * (p3 - 2.0 * p2 + p1));
            let [d1, d2] = curve.derivatives(u);
            assert!((d1 - first).length() < 1e-14 && (d2 - second).length() < 1e-13, "{u}");
        }
    }

    #[test]
    fn parts_are_the_same_curve() {
        let curve = Bezier::new(TABLE.to_vec());
        for (a, b) in [(0.0, 1.0), (0.2, 0.7), (0.0, 0.3), (0.9, 1.0)] {
            let part = curve.part(a, b);
            for i in 0..=10 {
                let u = f64::from(i) / 10.0;
                assert!((part.at(u) - curve.at(a + u * (b - a))).length() < 1e-15, "{a}..{b} at {u}");
            }
        }
    }
}

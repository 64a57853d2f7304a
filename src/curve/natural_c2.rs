//! `natural-c2`: rotation vectors as cubics, joined without jumps in acceleration.
//!
//! In the frame of its first key a segment's rotation vector is a cubic of time. The
//! velocities at all keys are those for which no acceleration jumps, found for a whole
//! track at once. Source: Kang and Park 1999; docs/math/natural-c2.md.

mod solve;

pub(super) use solve::is_solved;

use super::log_rates::BEND;
use super::rule::{Rule, Smoothness, Velocities};
use super::span::Span;
use super::{Arc, Rates};
use crate::math::{Quat, Scalar, Vec3, stumpff};

pub(super) struct NaturalC2;

impl Rule for NaturalC2 {
    const NAME: &'static str = "natural-c2";
    const SUMMARY: &'static str = "no jumps in acceleration either; every key shapes the whole";
    const SMOOTHNESS: Smoothness = Smoothness::Twice;
    const VELOCITIES: Option<Velocities> = Some(solve::velocities);
    type Arc = VectorCubic;

    fn arc(span: &Span) -> VectorCubic {
        let [first, last] = span.velocities.map(|velocity| velocity * span.h);
        VectorCubic::hermite(span.start, span.end, first, last)
    }
}

/// start · exp(a u + b u² + c u³).
#[derive(Clone, Copy, Debug)]
pub(super) struct VectorCubic {
    start: Quat,
    a: Vec3,
    b: Vec3,
    c: Vec3,
}

impl VectorCubic {
    /// From `start` to `end`, with half the angular velocities at both, per u.
    fn hermite(start: Quat, end: Quat, first: Vec3, last: Vec3) -> VectorCubic {
        let step = (start.conjugate() * end).log();
        // The vector's own derivative at the end, from the velocity there.
        let last = Tangent::at(step).vector_rate(last);
        let (b, c) = (step * 3.0 - first * 2.0 - last, first + last - step * 2.0);
        VectorCubic { start, a: first, b, c }
    }
}

impl Arc for VectorCubic {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let k = Vec3::constant;
        let vector = (k(self.a) + (k(self.b) + k(self.c) * u) * u) * u;
        Quat::constant(self.start) * Quat::exp(vector)
    }

    /// With X the vector, the velocity is X′ but for parts across X that are shortened, and
    /// the acceleration differs from such a part of X″ by at most 1.5 |X′||X × X′|.
    /// Derived in docs/math/deviation.md.
    fn rates(&self) -> Rates {
        let Self { a, b, c, .. } = *self;
        // Bernstein coefficients of X′, and the two ends of X″.
        let speed = longest([a, a + b, a + b * 2.0 + c * 3.0]);
        let straight = longest([b * 2.0, b * 2.0 + c * 6.0]);
        // X × X′ = u² a×b + 2u³ a×c + u⁴ b×c.
        let across = a.cross(b).length() + 2.0 * a.cross(c).length() + b.cross(c).length();
        Rates { speed, acceleration: straight + BEND * speed * across }
    }
}

fn longest<const N: usize>(vectors: [Vec3; N]) -> f64 {
    vectors.into_iter().map(Vec3::length).fold(0.0, f64::max)
}

/// How velocity and acceleration follow from a vector X and its derivatives for the
/// rotation exp X, in the frame that turns: with x = |X|,
/// velocity = A X′ and A = 1 − f X× + g X×X×, f = sin²x/x², g = (2x − sin 2x)/2x³.
#[derive(Clone, Copy, Debug)]
struct Tangent {
    vector: Vec3,
    /// f and g.
    turning: [f64; 2],
    /// f′/x and g′/x, derivatives by x.
    bending: [f64; 2],
    /// (1 − x cot x)/x², of the inverse 1 + X× + … X×X×.
    inverse: f64,
}

impl Tangent {
    /// At a vector shorter than π.
    fn at(vector: Vec3) -> Tangent {
        let square = vector.dot(vector);
        let [_, _, c2, c3, c4, c5] = stumpff::<6>(4.0 * square);
        let [_, sinc, s2, s3, ..] = stumpff::<6>(square);
        Tangent {
            vector,
            turning: [2.0 * c2, 4.0 * c3],
            bending: [16.0 * c4 - 8.0 * c3, 48.0 * c5 - 16.0 * c4],
            inverse: (s2 - s3) / sinc,
        }
    }

    /// A y: the velocity of a vector that changes by y.
    fn velocity(&self, y: Vec3) -> Vec3 {
        let (x, [f, g]) = (self.vector, self.turning);
        let across = x.cross(y);
        y - across * f + x.cross(across) * g
    }

    /// A⁻¹ w: the change of the vector at the velocity w.
    fn vector_rate(&self, w: Vec3) -> Vec3 {
        let across = self.vector.cross(w);
        w + across + self.vector.cross(across) * self.inverse
    }

    /// What the acceleration has besides A X″, for X′ = y = z: linear in both.
    fn bend(&self, y: Vec3, z: Vec3) -> Vec3 {
        let (x, [f, g], g0) = (self.vector, self.bending, self.turning[1]);
        let along = x.dot(y);
        let across = x.cross(z);
        x.cross(across) * (g * along) - across * (f * along) + y.cross(across) * g0
    }
}

#[cfg(test)]
mod tests {
    use super::super::log_rates::stretch;
    use super::*;
    use crate::math::Jet;

    #[test]
    fn velocity_and_acceleration_are_those_of_the_exponential() {
        let (x, y, z) = (Vec3::new(0.3, -0.8, 0.4), Vec3::new(1.1, 0.2, -0.7), Vec3::new(-0.4, 0.9, 0.5));
        for scale in [1e-9, 1e-3, 0.5, 1.0, 1.6, 3.2] {
            let x = x * scale;
            let jet = |x: f64, y: f64, z: f64| Jet { value: x, first: y, second: z };
            let vector = Vec3::new(jet(x.x, y.x, z.x), jet(x.y, y.y, z.y), jet(x.z, y.z, z.z));
            let (q, tangent) = (Quat::exp(vector), Tangent::at(x));
            assert!((q.half_velocity() - tangent.velocity(y)).length() < 1e-14);
            let acceleration = tangent.velocity(z) + tangent.bend(y, y);
            assert!((q.half_acceleration() - acceleration).length() < 1e-13, "{scale}");
            // Near a full turn (x = π) the inverse grows without bound.
            assert!((tangent.vector_rate(tangent.velocity(y)) - y).length() < 1e-13, "{scale}");
        }
    }

    #[test]
    fn the_inverse_is_bounded_as_rates_of_logarithms_say() {
        for i in 1..3140 {
            let x = 1e-3 * f64::from(i);
            let y = Vec3::new(0.0, 1.0, 0.0);
            let tangent = Tangent::at(Vec3::new(x, 0.0, 0.0));
            let (inverse, limit) = (tangent.vector_rate(y), stretch(x) + 1e-12);
            // Of a vector across, which both stretch the most.
            assert!(inverse.length() <= limit && (inverse - y).length() <= limit * x, "{x}");
        }
    }

    #[test]
    fn bending_is_bounded_as_the_rates_say() {
        for i in 1..=4000 {
            let x = 5e-3 * f64::from(i);
            let tangent = Tangent::at(Vec3::new(x, 0.0, 0.0));
            let [f, g] = tangent.bending;
            let (f, g, g0) = ((f * x).abs(), (g * x * x).abs(), tangent.turning[1].abs());
            // Each falls as 1/x² or faster beyond.
            assert!(f + g + g0 < BEND, "{x}: {f} {g} {g0}");
        }
    }
}

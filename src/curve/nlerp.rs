//! `nlerp`: the straight line between two quaternions, brought back to unit length.

use super::arc::direction;
use super::rule::{Rule, Smoothness};
use super::span::Span;
use super::{Arc, Rates};
use crate::math::{Quat, Scalar};

/// docs/math/nlerp.md.
pub(super) struct Nlerp;

impl Rule for Nlerp {
    const NAME: &'static str = "nlerp";
    const SUMMARY: &'static str = "slerp's arc, but fastest in the middle: how Blender interpolates";
    const SMOOTHNESS: Smoothness = Smoothness::Corners;
    const HAS_ENDS: bool = false;
    type Arc = Chord;

    fn arc(span: &Span) -> Chord {
        let (angle, axis) = direction((span.start.conjugate() * span.end).log());
        Chord { start: span.start, across: span.start * Quat { w: 0.0, v: axis }, angle }
    }
}

/// The points of a chord of the unit sphere, pushed out onto it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    start: Quat,
    across: Quat,
    angle: f64,
}

impl Arc for Chord {
    /// (1−u) start + u end, and end = start cos φ + across sin φ.
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let k = S::constant;
        let (sin, versine) = (libm::sin(self.angle), 2.0 * libm::sin(0.5 * self.angle).powi(2));
        let (x, y) = (k(1.0) - u * k(versine), u * k(sin));
        let length = (x * x + y * y).sqrt();
        let (x, y) = (x / length, y / length);
        let (a, b) = (Quat::constant(self.start), Quat::constant(self.across));
        Quat { w: a.w * x + b.w * y, v: a.v * x + b.v * y }
    }

    /// The angle's derivatives are sin φ/n and 4 sin φ s²(1 − 2u)/n² with s = sin φ/2 and
    /// n = 1 − 4u(1−u)s²: the first is largest half way, the second where
    /// (1−2u)² = cot²(φ/2)/3, or at an end where that lies outside.
    fn rates(&self) -> Rates {
        let (s, c) = libm::sincos(0.5 * self.angle);
        let sin = 2.0 * s * c;
        let crest = if 3.0 * s * s > c * c { 9.0 / (16.0 * 3f64.sqrt() * s * c.powi(3)) } else { 1.0 };
        Rates { speed: 2.0 * s / c, acceleration: 4.0 * sin * s * s * crest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    #[test]
    fn it_is_the_blend_brought_to_unit_length() {
        let start = Quat::exp(Vec3::new(0.3, -0.2, 0.5));
        for angle in [0.0, 1e-9, 1e-3, 0.5, 1.2, 1.57] {
            let end = start * Quat::exp(Vec3::new(0.48, 0.6, 0.64) * angle);
            let (angle, axis) = direction((start.conjugate() * end).log());
            let chord = Chord { start, across: start * Quat { w: 0.0, v: axis }, angle };
            for u in [0.0, 0.1, 0.5, 0.8, 1.0] {
                let mix = |a: f64, b: f64| (1.0 - u) * a + u * b;
                let v = [mix(start.v.x, end.v.x), mix(start.v.y, end.v.y), mix(start.v.z, end.v.z)];
                let blend = Quat { w: mix(start.w, end.w), v: Vec3::new(v[0], v[1], v[2]) };
                let (found, length) = (chord.at(u), blend.norm());
                assert!(
                    (found.w - blend.w / length).abs() < 1e-15 && (found.v.y - v[1] / length).abs() < 1e-15
                );
            }
        }
    }
}

//! What every scheme's segment can do, and the simplest of them.

use super::Rates;
use crate::math::{Quat, Scalar, Vec3};

/// A rotation as a smooth function of u in 0..=1.
pub trait Arc {
    /// The rotation at u, a unit quaternion whose sign is continuous in u.
    fn at<S: Scalar>(&self, u: S) -> Quat<S>;

    /// Bounds that hold for all u in 0..=1, in closed form: cheap, and near the truth
    /// where the curve turns little.
    fn rates(&self) -> Rates;
}

/// The shortest turn from one rotation to another, at constant speed.
///
/// With the angle φ between the quaternions and the unit quaternion m at a right angle
/// to the start, `start` cos uφ + m sin uφ: equal to sin((1−u)φ)/sin φ · start +
/// sin(uφ)/sin φ · end, but without a quotient that fails for tiny φ.
/// Source: Shoemake 1985; docs/math/slerp.md.
#[derive(Clone, Copy, Debug)]
pub(super) struct GreatArc {
    start: Quat,
    across: Quat,
    angle: f64,
}

impl GreatArc {
    /// The logarithm of the step from start to end.
    pub(super) fn step(&self) -> Vec3 {
        (self.start.conjugate() * self.across).v * self.angle
    }

    /// The arc from `start` to `end`, both of unit length; their signs count.
    pub(super) fn new(start: Quat, end: Quat) -> GreatArc {
        let log = (start.conjugate() * end).log();
        let (angle, axis) = direction(log);
        GreatArc { start, across: start * Quat { w: 0.0, v: axis }, angle }
    }
}

impl Arc for GreatArc {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let (sin, cos) = (u * S::constant(self.angle)).sin_cos();
        let (a, b) = (Quat::constant(self.start), Quat::constant(self.across));
        Quat { w: a.w * cos + b.w * sin, v: a.v * cos + b.v * sin }
    }

    fn rates(&self) -> Rates {
        Rates { speed: self.angle, acceleration: 0.0 }
    }
}

/// Length and unit direction of a vector; the zero vector has the direction zero.
pub(super) fn direction(v: Vec3) -> (f64, Vec3) {
    let length = v.length();
    if length == 0.0 { (0.0, Vec3::ZERO) } else { (length, v * (1.0 / length)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_formula_of_sines() {
        let start = Quat::exp(Vec3::new(0.3, -0.2, 0.5));
        for angle in [1e-9, 1e-4, 0.3, 1.2, 1.57, 2.8] {
            let end = start * Quat::exp(Vec3::new(0.48, 0.6, 0.64) * angle);
            let arc = GreatArc::new(start, end);
            let phi: f64 = angle;
            for u in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let (a, b) = (((1.0 - u) * phi).sin() / phi.sin(), (u * phi).sin() / phi.sin());
                let q = arc.at(u);
                let expected = [a * start.w + b * end.w, a * start.v.x + b * end.v.x];
                // The quotients lose 1 / sin φ in accuracy towards half a turn.
                let limit = 1e-15 / phi.sin().max(0.3);
                assert!((q.w - expected[0]).abs() < limit && (q.v.x - expected[1]).abs() < limit);
            }
        }
    }
}

//! What every scheme's segment can do, and the simplest of them.

use super::Rates;
use super::rule::{Formula, Paced};
use crate::math::{Number, Quat, Scalar, Vec3};

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
pub(super) struct GreatArc<N = f64> {
    start: Quat<N>,
    across: Quat<N>,
    angle: N,
}

impl<N: Number> GreatArc<N> {
    /// The logarithm of the step from start to end.
    #[inline(always)]
    pub(super) fn step(&self) -> Vec3<N> {
        (self.start.conjugate() * self.across).v * self.angle
    }

    /// The arc from `start` to `end`, both of unit length; their signs count.
    #[inline(always)]
    pub(super) fn new(start: Quat<N>, end: Quat<N>) -> GreatArc<N> {
        let (angle, axis) = N::polar(start.conjugate() * end);
        GreatArc { start, across: start * Quat { w: N::from(0.0), v: axis }, angle }
    }
}

impl<N: Copy> Formula<N> for GreatArc<N> {
    #[inline(always)]
    fn point<S: Scalar + From<N>>(&self, u: S) -> Quat<S> {
        let (sin, cos) = (u * S::from(self.angle)).sin_cos();
        let (a, b) = (Quat::<S>::constant(self.start), Quat::<S>::constant(self.across));
        Quat { w: a.w * cos + b.w * sin, v: a.v * cos + b.v * sin }
    }
}

impl Arc for GreatArc {
    #[inline(always)]
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        self.point(u)
    }

    fn rates(&self) -> Rates {
        self.pace()
    }
}

impl<N: Number> Paced<N> for GreatArc<N> {
    #[inline(always)]
    fn pace(&self) -> Rates<N> {
        Rates { speed: self.angle, acceleration: N::from(0.0) }
    }
}

/// Length and unit direction of a vector; the zero vector has the direction zero.
#[inline(always)]
pub(super) fn direction<N: Number>(v: Vec3<N>) -> (N, Vec3<N>) {
    let length = N::length(v);
    let scale = length.below(f64::MIN_POSITIVE, N::from(0.0), N::from(1.0) / length);
    (length, v * scale)
}

/// A share of a step, which is given by its length and its unit axis: by the sine of an angle, of
/// which bounds do not lose sight beyond a turn.
#[inline(always)]
pub(super) fn turn<N, S: Scalar + From<N>>((length, axis): (N, Vec3<N>), share: S) -> Quat<S> {
    let (sin, cos) = (share * S::from(length)).sin_cos();
    Quat { w: cos, v: Vec3::constant(axis) * sin }
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

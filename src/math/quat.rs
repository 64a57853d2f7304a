//! Quaternions: product, exponential, logarithm, signs.
//!
//! A rotation by the angle θ about the unit axis n is the unit quaternion
//! (cos θ/2, n sin θ/2); its logarithm is the vector n θ/2, half the rotation
//! vector. Source: Shoemake 1985; docs/math/rotation.md.

use super::scalar::norm;
use super::{Scalar, Vec3};
use std::ops::{Mul, Neg};

/// A quaternion w + x i + y j + z k (Hamilton's product: `a * b` applies `b` first).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quat<S = f64> {
    /// The scalar part.
    pub w: S,
    /// The vector part: x, y, z.
    pub v: Vec3<S>,
}

/// Two keys whose scalar product is smaller than this are 180° apart.
const HALF_TURN: f64 = 1e-12;

impl Quat {
    /// The rotation that changes nothing.
    pub const IDENTITY: Quat = Quat::from_wxyz([1.0, 0.0, 0.0, 0.0]);

    /// From the order of `.dat` files.
    pub const fn from_wxyz([w, x, y, z]: [f64; 4]) -> Quat {
        Quat { w, v: Vec3::new(x, y, z) }
    }

    /// From the order of glTF, glam, SciPy and ROS.
    pub const fn from_xyzw([x, y, z, w]: [f64; 4]) -> Quat {
        Quat { w, v: Vec3::new(x, y, z) }
    }

    /// In the order of `.dat` files.
    pub const fn to_wxyz(self) -> [f64; 4] {
        [self.w, self.v.x, self.v.y, self.v.z]
    }

    /// In the order of glTF, glam, SciPy and ROS.
    pub const fn to_xyzw(self) -> [f64; 4] {
        [self.v.x, self.v.y, self.v.z, self.w]
    }

    /// Norm; does not overflow or underflow before the norm itself does.
    pub fn norm(self) -> f64 {
        norm([self.w, self.v.x, self.v.y, self.v.z])
    }

    /// The logarithm of a unit quaternion: n θ/2 with θ/2 in [0, π].
    ///
    /// The scalar part may be negative: the logarithm then is longer than a quarter
    /// turn's, and `exp` returns to this very sign. At −1 exactly, where every axis
    /// would do, it is zero, and so is it at 1.
    pub fn log(self) -> Vec3 {
        let sine = self.v.length();
        if sine == 0.0 {
            return Vec3::ZERO;
        }
        let angle = libm::atan2(sine, self.w);
        let ratio = angle / sine;
        // Beside −1 the ratio of half a turn to almost nothing is no number, though the axis is.
        if ratio.is_finite() {
            self.v * ratio
        } else {
            Vec3::new(self.v.x / sine, self.v.y / sine, self.v.z / sine) * angle
        }
    }

    /// The rotation angle between two unit quaternions, radians, in [0, π]; signs do
    /// not matter. Accurate for tiny angles, where an arc cosine is not.
    pub fn angle_to(self, other: Quat) -> f64 {
        let relative = self.conjugate() * other;
        2.0 * libm::atan2(relative.v.length(), relative.w.abs())
    }

    /// `self` or −`self` (the same rotation), whichever lies in `before`'s hemisphere.
    ///
    /// Half a turn away from `before` both do. Then the sign is chosen by the rotation
    /// between them: its first of x, y, z that is not zero becomes positive, so that a
    /// sign in the file decides nothing.
    #[inline]
    pub fn aligned_to(self, before: Quat) -> Quat {
        let cosine = before.dot(self);
        let sign = if cosine.abs() >= HALF_TURN { cosine } else { half_turn_sign(before.conjugate() * self) };
        if sign < 0.0 { -self } else { self }
    }
}

/// The sign by which neighbours exactly half a turn apart follow each other: that of the
/// axis's first part.
#[cold]
fn half_turn_sign(relative: Quat) -> f64 {
    let v = relative.v;
    [v.x, v.y, v.z].into_iter().find(|c| c.abs() > HALF_TURN).unwrap_or(1.0)
}

impl<S: Scalar> Quat<S> {
    /// The same quaternion in another kind of scalar.
    #[inline(always)]
    pub fn constant<N>(q: Quat<N>) -> Self
    where
        S: From<N>,
    {
        Quat { w: S::from(q.w), v: Vec3::constant(q.v) }
    }

    /// The inverse of a unit quaternion.
    #[inline(always)]
    pub fn conjugate(self) -> Self {
        Quat { w: self.w, v: -self.v }
    }

    /// The scalar product of two quaternions as vectors of four.
    #[inline(always)]
    pub fn dot(self, other: Self) -> S {
        self.w * other.w + self.v.dot(other.v)
    }

    /// exp of a vector: rotation about it by twice its length.
    #[inline(always)]
    pub fn exp(v: Vec3<S>) -> Self {
        let (cos, sinc) = v.dot(v).cos_sinc_of_square();
        Quat { w: cos, v: v * sinc }
    }

    /// [`Quat::log`] for any scalar, for a rotation that is less than a full turn.
    #[inline(always)]
    pub fn smooth_log(self) -> Vec3<S> {
        self.v * self.w.angle_over_sine(self.v.dot(self.v))
    }
}

impl<S: Scalar> Mul for Quat<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Quat { w: self.w * b.w - self.v.dot(b.v), v: b.v * self.w + self.v * b.w + self.v.cross(b.v) }
    }
}

impl<S: Scalar> Neg for Quat<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Quat { w: -self.w, v: -self.v }
    }
}

impl From<Quat> for glam::DQuat {
    fn from(q: Quat) -> Self {
        glam::DQuat::from_array(q.to_xyzw())
    }
}

impl From<glam::DQuat> for Quat {
    fn from(q: glam::DQuat) -> Self {
        Quat::from_xyzw(q.to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn any_vector(length: std::ops::Range<f64>) -> impl Strategy<Value = Vec3> {
        ([-1.0..1.0f64, -1.0..1.0, -1.0..1.0], length).prop_filter_map("too short", |(v, length)| {
            let v = Vec3::new(v[0], v[1], v[2]);
            (v.length() > 1e-3).then(|| v * (length / v.length()))
        })
    }

    fn distance(a: Quat, b: Quat) -> f64 {
        let d = [a.w - b.w, a.v.x - b.v.x, a.v.y - b.v.y, a.v.z - b.v.z];
        d.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    #[test]
    fn beside_minus_one_the_axis_counts() {
        for sine in [1e-300, 3e-308, 1.5e-323, 5e-324] {
            let log = Quat { w: -1.0, v: Vec3::new(0.0, -sine, 0.0) }.log();
            assert!((log - Vec3::new(0.0, -PI, 0.0)).length() < 1e-15, "{sine:e}: {log:?}");
        }
    }

    proptest! {
        #[test]
        fn log_undoes_exp_over_the_full_range(v in any_vector(0.0..3.13)) {
            let back = Quat::exp(v).log();
            prop_assert!((back - v).length() < 1e-12, "{v:?} {back:?}");
        }

        #[test]
        fn exp_undoes_log_with_its_sign(v in any_vector(0.0..3.1)) {
            let q = -Quat::exp(v);
            prop_assert!(distance(Quat::exp(q.log()), q) < 1e-12);
        }

        #[test]
        fn product_agrees_with_glam(a in any_vector(0.0..3.0), b in any_vector(0.0..3.0)) {
            let (a, b) = (Quat::exp(a), Quat::exp(b));
            let theirs = glam::DQuat::from(a) * glam::DQuat::from(b);
            prop_assert!(distance(a * b, theirs.into()) < 1e-14);
        }

        #[test]
        fn tiny_angles_keep_their_digits(v in any_vector(1e-12..1e-9)) {
            let q = Quat::exp(v);
            prop_assert!((q.log() - v).length() < 1e-12 * v.length());
            prop_assert!((Quat::IDENTITY.angle_to(q) - 2.0 * v.length()).abs() < 1e-12 * v.length());
        }

        #[test]
        fn alignment_does_not_see_signs(a in any_vector(0.0..1.0), axis in any_vector(1.0..1.1)) {
            let a = Quat::exp(a);
            let half_turn = Quat { w: 0.0, v: axis * (1.0 / axis.length()) };
            let b = a * half_turn;
            prop_assert_eq!(b.aligned_to(a), (-b).aligned_to(a));
            prop_assert!(distance(b.aligned_to(a), -b.aligned_to(-a)) < 1e-15);
        }
    }

    #[test]
    fn logarithms_near_half_and_full_turns() {
        for angle in [1.0, 3.0, PI - 1e-5, PI - 1e-9] {
            let half = angle / 2.0;
            let q = Quat::from_wxyz([f64::cos(half), 0.0, f64::sin(half), 0.0]);
            assert!((q.log().y - half).abs() < 1e-12, "{angle}");
            let beyond = Quat::from_wxyz([-f64::cos(half), 0.0, f64::sin(half), 0.0]);
            assert!((beyond.log().y - (PI - half)).abs() < 1e-12);
        }
    }
}

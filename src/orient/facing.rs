//! A forward and an up, and the turns between them.

use crate::math::{Quat, Vec3};
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::TAU;

/// Directions whose sum is shorter than this are opposite: both round to unit length,
/// so that the plane between them is noise of 1e-16 / 1e-8.
const REVERSAL: f64 = 1e-8;

/// Where forward's sine against the vertical is below this, it has no side to put up
/// on: as for [`REVERSAL`].
const PLUMB: f64 = 1e-8;

/// Which way an object looks: two unit vectors at a right angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facing {
    pub(super) forward: DVec3,
    pub(super) up: DVec3,
}

impl Facing {
    /// The object as it is modelled.
    pub(super) const START: Facing = Facing { forward: DVec3::Z, up: DVec3::Y };

    /// Along a unit vector, with `up` as near as it can be; not along it.
    pub(super) fn new(forward: DVec3, up: DVec3) -> Facing {
        let across = up - forward * up.dot(forward);
        Facing { forward, up: across.try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector()) }
    }

    /// Along a unit vector, with up as near to +Y as it can be. Straight up or down
    /// it is what pitching from +Z makes of it: −Z on the way up, +Z on the way down.
    pub(super) fn upright(forward: DVec3) -> Facing {
        let up = if libm::hypot(forward.x, forward.z) < PLUMB { DVec3::Z * -forward.y } else { DVec3::Y };
        Facing::new(forward, up)
    }

    /// Turned by the shortest arc to another direction; by 180° about up.
    pub(super) fn turned_to(self, forward: DVec3) -> Facing {
        if self.is_against(forward) {
            return Facing::new(forward, self.up);
        }
        let sum = self.forward + forward;
        // The arc is the half turn about the old forward, then the one about the bisector.
        let half_turn = |v: DVec3, axis: DVec3| axis * (2.0 * axis.dot(v)) - v;
        Facing::new(forward, half_turn(-self.up, sum.normalize()))
    }

    /// Whether another direction is the opposite one.
    pub(super) fn is_against(self, forward: DVec3) -> bool {
        (self.forward + forward).length() < REVERSAL
    }

    /// The side to which +X, the object's left, points.
    pub(super) fn left(self) -> DVec3 {
        self.up.cross(self.forward)
    }

    /// Turned about forward, radians, right-handed: the left side goes up.
    pub(super) fn rolled(self, angle: f64) -> Facing {
        let (sin, cos) = libm::sincos(angle);
        Facing::new(self.forward, self.up * cos - self.left() * sin)
    }

    /// The roll that brings up to another up that is at a right angle to forward.
    pub(super) fn roll_to(self, up: DVec3) -> f64 {
        libm::atan2(-self.left().dot(up), self.up.dot(up))
    }

    /// The roll that brings up as near to +Y as it can be.
    pub(super) fn roll_to_upright(self) -> f64 {
        self.roll_to(Facing::upright(self.forward).up)
    }

    /// The rotation that takes +Z to forward and +Y to up.
    pub(super) fn rotation(self) -> Quat {
        DQuat::from_mat3(&DMat3::from_cols(self.left(), self.up, self.forward)).normalize().into()
    }
}

/// Angle between a unit vector and the vertical, up or down, radians, 0 to π/2.
pub(super) fn tilt(forward: DVec3) -> f64 {
    libm::atan2(libm::hypot(forward.x, forward.z), forward.y.abs())
}

/// A vector turned by a rotation.
pub(crate) fn turned(q: Quat, v: DVec3) -> DVec3 {
    DQuat::from(q) * v
}

/// The rotation about forward, radians.
pub(super) fn roll(angle: f64) -> Quat {
    // Of so many turns as a lean may be asked for, what is left of two.
    Quat::exp(Vec3::new(0.0, 0.0, (angle % (2.0 * TAU)) / 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortest_arcs_agree_with_rotation_by_the_cross_product() {
        let from = Facing::upright(DVec3::new(0.6, 0.48, 0.64));
        for to in [DVec3::X, DVec3::NEG_Y, DVec3::new(-0.36, 0.48, -0.8), from.forward] {
            let axis = from.forward.cross(to);
            let arc =
                DQuat::from_scaled_axis(axis.normalize_or_zero() * axis.length().atan2(from.forward.dot(to)));
            assert!((from.turned_to(to).up - arc * from.up).length() < 1e-14, "{to}");
        }
    }

    #[test]
    fn a_reversal_turns_about_up() {
        let from = Facing::upright(DVec3::new(0.6, 0.48, 0.64));
        assert!((from.turned_to(-from.forward).up - from.up).length() < 1e-15);
    }

    #[test]
    fn rolls_are_undone_by_their_measure() {
        let from = Facing::upright(DVec3::new(0.6, 0.48, 0.64));
        for angle in [-3.0, -0.4, 1e-9, 2.0] {
            let rolled = from.rolled(angle);
            assert!((from.roll_to(rolled.up) - angle).abs() < 1e-14);
            let q = from.rotation() * roll(angle);
            assert!(q.angle_to(rolled.rotation()) < 1e-14);
            assert!((turned(q, DVec3::Y) - rolled.up).length() < 1e-14);
            assert!((turned(q, DVec3::Z) - rolled.forward).length() < 1e-14);
        }
    }

    #[test]
    fn vertical_facings_are_what_pitching_makes_of_them() {
        assert_eq!(Facing::upright(DVec3::Y).up, DVec3::NEG_Z);
        assert_eq!(Facing::upright(DVec3::NEG_Y).up, DVec3::Z);
        assert_eq!(Facing::upright(DVec3::X).up, DVec3::Y);
    }
}

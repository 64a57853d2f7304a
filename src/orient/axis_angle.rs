//! Rotations as an axis and an angle.

use crate::math::Quat;
use glam::DVec3;

/// The unit axis and the angle about it, degrees, 0 to 180, of a unit quaternion; the
/// identity has the axis x.
///
/// With w ≥ 0 the angle is 2 atan2(|v|, w) and the axis v / |v|: 2 acos w would lose
/// every angle below 1e-8.
pub fn axis_angle(q: Quat) -> (DVec3, f64) {
    let q = if q.w < 0.0 { -q } else { q };
    let sine = q.v.length();
    if sine == 0.0 {
        return (DVec3::X, 0.0);
    }
    let axis = DVec3::new(q.v.x / sine, q.v.y / sine, q.v.z / sine);
    (axis, (2.0 * libm::atan2(sine, q.w)).to_degrees())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    #[test]
    fn angles_of_every_size_keep_their_digits_under_either_sign() {
        for degrees in [1e-300, 1e-12, 1e-6, 1.0, 90.0, 179.0, 180.0] {
            let q = Quat::exp(Vec3::new(0.48, -0.6, 0.64) * (f64::to_radians(degrees) / 2.0));
            for q in if degrees < 180.0 { [q, -q] } else { [q, q] } {
                let (axis, angle) = axis_angle(q);
                assert!((angle - degrees).abs() <= 1e-15 * degrees, "{degrees} {angle}");
                assert!((axis - DVec3::new(0.48, -0.6, 0.64)).length() < 1e-15);
            }
        }
    }

    #[test]
    fn the_identity_has_the_axis_x() {
        assert_eq!(axis_angle(Quat::IDENTITY), (DVec3::X, 0.0));
        assert_eq!(axis_angle(-Quat::IDENTITY), (DVec3::X, 0.0));
    }
}

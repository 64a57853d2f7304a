//! Euler angles in aerospace order: yaw, then pitch, then roll.

use super::wrapped;
use crate::math::{Quat, Vec3};
use std::f64::consts::FRAC_PI_2;

/// Pitches nearer than this to ±90°, radians, have no roll: what is left of it is
/// rounding of 1e-16 / 1e-12, and leaving it out moves nothing by more than 1e-12.
const POLE: f64 = 1e-12;

/// Roll about x, pitch about y and yaw about z, degrees: q = q_z(yaw) q_y(pitch) q_x(roll).
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs)]
pub struct Euler {
    pub roll: f64,
    pub pitch: f64,
    pub yaw: f64,
}

impl Euler {
    /// The rotation of these angles, in the convention of axes in which they are meant.
    pub fn rotation(self) -> Quat {
        // Two whole turns leave the quaternion as it is, and this remainder is exact: so angles of
        // any size keep their digits.
        let half = |degrees: f64| (degrees % 720.0).to_radians() / 2.0;
        Quat::exp(Vec3::new(0.0, 0.0, half(self.yaw)))
            * Quat::exp(Vec3::new(0.0, half(self.pitch), 0.0))
            * Quat::exp(Vec3::new(half(self.roll), 0.0, 0.0))
    }

    /// The angles of a rotation: roll and yaw in (−180, 180], pitch in −90..=90; at the
    /// poles roll is 0.
    ///
    /// With half angles, w + y and z − x are (cos θ + sin θ) times cosine and sine of
    /// ψ − φ, w − y and z + x are (cos θ − sin θ) times those of ψ + φ: no term loses
    /// digits anywhere. docs/math/orientation.md.
    pub fn from_rotation(q: Quat) -> Euler {
        let [w, x, y, z] = q.to_wxyz();
        let (above, below) = (libm::hypot(w + y, z - x), libm::hypot(w - y, z + x));
        let pitch = 2.0 * libm::atan2(above, below) - FRAC_PI_2;
        let (difference, sum) = (libm::atan2(z - x, w + y), libm::atan2(z + x, w - y));
        let (roll, yaw) = if below < POLE {
            (0.0, 2.0 * difference)
        } else if above < POLE {
            (0.0, 2.0 * sum)
        } else {
            (sum - difference, sum + difference)
        };
        Euler { roll: wrapped(roll).to_degrees(), pitch: pitch.to_degrees(), yaw: wrapped(yaw).to_degrees() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> impl Iterator<Item = Euler> {
        let turns = || (-11..=12).map(|i| f64::from(i) * 15.0);
        let pitches = [-90.0, -89.999999, -89.9, -60.0, -0.1, 0.0, 1e-7, 45.0, 89.9, 89.999999, 90.0];
        let each =
            move |pitch| turns().flat_map(move |roll| turns().map(move |yaw| Euler { roll, pitch, yaw }));
        pitches.into_iter().flat_map(each)
    }

    #[test]
    fn rotations_come_back_from_their_angles() {
        for angles in grid() {
            let q = angles.rotation();
            let back = Euler::from_rotation(q);
            assert!(back.rotation().angle_to(q) < 3e-15, "{angles:?} {back:?}");
            assert!((back.pitch - angles.pitch).abs() < 1e-13, "{angles:?} {back:?}");
        }
    }

    #[test]
    fn angles_come_back_away_from_the_poles_and_roll_is_nought_at_them() {
        for angles in grid() {
            let back = Euler::from_rotation(angles.rotation());
            if angles.pitch.abs() == 90.0 {
                assert_eq!(back.roll, 0.0, "{angles:?}");
            } else {
                // Roll and yaw lose 1 / cos of the pitch.
                let limit = 1e-13 / angles.pitch.to_radians().cos();
                let near = |a: f64, b: f64| wrapped((a - b).to_radians()).to_degrees().abs() < limit;
                assert!(near(back.roll, angles.roll) && near(back.yaw, angles.yaw), "{angles:?} {back:?}");
            }
        }
    }

    #[test]
    fn whole_turns_change_nothing_however_many() {
        let few = Euler { roll: 30.0, pitch: -20.0, yaw: 50.0 };
        for turns in [-2.0, 2.0, 1e6, 2f64.powi(40)] {
            let many = Euler { roll: few.roll + 360.0 * turns, yaw: few.yaw - 360.0 * turns, ..few };
            let (many, few) = (many.rotation(), few.rotation());
            assert!(many.angle_to(few) < 3e-15 && many.dot(few) > 0.0, "{turns}");
        }
        for huge in [1e155, -1e300, f64::MAX] {
            let q = Euler { roll: huge, pitch: huge, yaw: huge }.rotation();
            assert!((q.norm() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn the_order_is_yaw_pitch_roll() {
        let (half, other) = (0.5f64.sqrt(), 0.0);
        let q = Euler { roll: 90.0, pitch: 0.0, yaw: 90.0 }.rotation();
        // q_z(90°) q_x(90°) = (1 + k)(1 + i) / 2 = (1 + i + j + k) / 2.
        assert!(q.angle_to(Quat::from_wxyz([0.5; 4])) < 1e-15);
        let pitched = Euler { roll: 0.0, pitch: 90.0, yaw: 0.0 }.rotation();
        assert!(pitched.angle_to(Quat::from_wxyz([half, other, half, other])) < 1e-15);
    }
}

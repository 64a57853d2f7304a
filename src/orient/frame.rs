//! Whose x, y and z the numbers are.

use crate::math::{Quat, Vec3};
use glam::DVec3;

/// A convention of axes, the same for the world and for the object in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frame {
    /// glTF: x left, y up, z forward.
    #[default]
    Gltf,
    /// Aerospace: x forward, y right, z down.
    Frd,
    /// ROS (REP 103): x forward, y left, z up.
    Flu,
}

impl Frame {
    /// Every convention.
    pub const ALL: [Frame; 3] = [Frame::Gltf, Frame::Frd, Frame::Flu];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Frame::Gltf => "gltf",
            Frame::Frd => "frd",
            Frame::Flu => "flu",
        }
    }

    /// The convention of a name.
    pub fn from_name(name: &str) -> Option<Frame> {
        Frame::ALL.into_iter().find(|frame| frame.name() == name)
    }

    /// A vector of this convention in glTF's.
    pub fn vector_to_gltf(self, v: DVec3) -> DVec3 {
        match self {
            Frame::Gltf => v,
            Frame::Frd => DVec3::new(-v.y, -v.z, v.x),
            Frame::Flu => DVec3::new(v.y, v.z, v.x),
        }
    }

    /// A vector of glTF's convention in this one.
    pub fn vector_from_gltf(self, v: DVec3) -> DVec3 {
        match self {
            Frame::Gltf => v,
            Frame::Frd => DVec3::new(v.z, -v.x, -v.y),
            Frame::Flu => DVec3::new(v.z, v.x, v.y),
        }
    }

    /// A rotation of this convention in glTF's: the axes are all right-handed, so the
    /// angle stays and the axis is a vector like any other.
    pub fn rotation_to_gltf(self, q: Quat) -> Quat {
        with_axis(q, |v| self.vector_to_gltf(v))
    }

    /// A rotation of glTF's convention in this one.
    pub fn rotation_from_gltf(self, q: Quat) -> Quat {
        with_axis(q, |v| self.vector_from_gltf(v))
    }
}

fn with_axis(q: Quat, change: impl Fn(DVec3) -> DVec3) -> Quat {
    let v = change(DVec3::new(q.v.x, q.v.y, q.v.z));
    Quat { w: q.w, v: Vec3::new(v.x, v.y, v.z) }
}

#[cfg(test)]
mod tests {
    use super::super::Euler;
    use super::super::facing::turned;
    use super::*;

    #[test]
    fn axes_go_where_their_names_say() {
        let (forward, left, up) = (DVec3::Z, DVec3::X, DVec3::Y);
        assert_eq!(
            [DVec3::X, DVec3::Y, DVec3::Z].map(|v| Frame::Frd.vector_to_gltf(v)),
            [forward, -left, -up]
        );
        assert_eq!([DVec3::X, DVec3::Y, DVec3::Z].map(|v| Frame::Flu.vector_to_gltf(v)), [forward, left, up]);
    }

    #[test]
    fn changes_are_undone_and_agree_on_vectors_and_rotations() {
        let (q, v) = (Quat::exp(Vec3::new(0.3, -0.8, 0.5)), DVec3::new(1.0, 2.0, -3.0));
        for frame in Frame::ALL {
            assert_eq!(frame.vector_from_gltf(frame.vector_to_gltf(v)), v);
            assert_eq!(frame.rotation_from_gltf(frame.rotation_to_gltf(q)), q);
            let there = turned(frame.rotation_to_gltf(q), frame.vector_to_gltf(v));
            assert!((there - frame.vector_to_gltf(turned(q, v))).length() < 1e-14, "{frame:?}");
            assert_eq!(Frame::from_name(frame.name()), Some(frame));
        }
    }

    /// Where the nose points, in glTF's axes.
    fn nose(roll: f64, pitch: f64, yaw: f64) -> DVec3 {
        turned(Frame::Frd.rotation_to_gltf(Euler { roll, pitch, yaw }.rotation()), DVec3::Z)
    }

    #[test]
    fn aerospace_angles_turn_the_nose_as_pilots_say() {
        assert!((nose(0.0, 0.0, 90.0) - DVec3::NEG_X).length() < 1e-15, "yaw turns it level, to the right");
        assert!(
            (nose(0.0, 30.0, 0.0) - DVec3::new(0.0, 0.5, 0.75f64.sqrt())).length() < 1e-15,
            "pitch lifts it"
        );
        assert!((nose(90.0, 0.0, 0.0) - DVec3::Z).length() < 1e-15, "roll does not move it");
    }

    #[test]
    fn positive_roll_in_frd_lowers_the_right_wing() {
        let q = Frame::Frd.rotation_to_gltf(Euler { roll: 30.0, pitch: 0.0, yaw: 0.0 }.rotation());
        assert!((turned(q, DVec3::NEG_X).y + 0.5).abs() < 1e-15);
    }
}

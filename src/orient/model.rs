//! Models whose forward is not +Z.

use super::facing::Facing;
use crate::math::Quat;
use glam::DVec3;

/// An axis of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
    MinusX,
    MinusY,
    MinusZ,
}

/// A forward and an up along one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the model's forward ({}) and up ({}) lie along one line; give an up at a right angle to forward",
    .forward.name(), .up.name()
)]
#[expect(missing_docs)]
pub struct ParallelAxes {
    pub forward: Axis,
    pub up: Axis,
}

impl Axis {
    /// Every axis.
    pub const ALL: [Axis; 6] = [Axis::X, Axis::Y, Axis::Z, Axis::MinusX, Axis::MinusY, Axis::MinusZ];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Axis::X => "X",
            Axis::Y => "Y",
            Axis::Z => "Z",
            Axis::MinusX => "-X",
            Axis::MinusY => "-Y",
            Axis::MinusZ => "-Z",
        }
    }

    /// The axis of a name, in either case.
    pub fn from_name(name: &str) -> Option<Axis> {
        Axis::ALL.into_iter().find(|axis| axis.name().eq_ignore_ascii_case(name))
    }

    fn vector(self) -> DVec3 {
        match self {
            Axis::X => DVec3::X,
            Axis::Y => DVec3::Y,
            Axis::Z => DVec3::Z,
            Axis::MinusX => DVec3::NEG_X,
            Axis::MinusY => DVec3::NEG_Y,
            Axis::MinusZ => DVec3::NEG_Z,
        }
    }
}

/// The rotation that takes a model's forward to +Z and its up to +Y. It is applied
/// first: a path's rotation times this one turns the model along the path.
pub fn model_frame(forward: Axis, up: Axis) -> Result<Quat, ParallelAxes> {
    let (front, top) = (forward.vector(), up.vector());
    if front.dot(top) != 0.0 {
        return Err(ParallelAxes { forward, up });
    }
    Ok(Facing { forward: front, up: top }.rotation().conjugate())
}

#[cfg(test)]
mod tests {
    use super::super::facing::turned;
    use super::*;

    #[test]
    fn every_pair_of_axes_is_turned_or_refused() {
        for (forward, up) in Axis::ALL.into_iter().flat_map(|a| Axis::ALL.map(|b| (a, b))) {
            let parallel = forward.name().trim_start_matches('-') == up.name().trim_start_matches('-');
            match model_frame(forward, up) {
                Ok(q) => {
                    assert!((turned(q, forward.vector()) - DVec3::Z).length() < 1e-15, "{forward:?} {up:?}");
                    assert!((turned(q, up.vector()) - DVec3::Y).length() < 1e-15, "{forward:?} {up:?}");
                    assert!(!parallel);
                }
                Err(refused) => assert!(parallel && refused == ParallelAxes { forward, up }),
            }
        }
    }

    #[test]
    fn the_refusal_names_both() {
        let message = model_frame(Axis::MinusY, Axis::Y).expect_err("parallel").to_string();
        assert!(message.contains("(-Y)") && message.contains("(Y)"), "{message}");
    }

    #[test]
    fn names_lead_back() {
        assert!(Axis::ALL.into_iter().all(|axis| Axis::from_name(axis.name()) == Some(axis)));
        assert_eq!(Axis::from_name("-x"), Some(Axis::MinusX));
        assert_eq!(Axis::from_name("W"), None);
    }
}

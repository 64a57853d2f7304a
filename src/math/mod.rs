//! Quaternions over any scalar, and the scalars: `f64`, jets, intervals, lanes.

mod interval;
mod jet;
mod jet3;
mod lane;
mod level;
mod quat;
mod scalar;
mod vec3;

pub use interval::Interval;
pub use jet::Jet;
pub(crate) use jet::stumpff;
pub use jet3::Jet3;
pub use lane::Lane;
pub(crate) use lane::{half_angles, slerps};
pub(crate) use level::widest;
pub use quat::Quat;
pub use scalar::{Number, Scalar};
pub use vec3::Vec3;

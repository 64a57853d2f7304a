//! Quaternions over any scalar, and the scalars: `f64`, jets, intervals.

mod interval;
mod jet;
mod jet3;
mod quat;
mod scalar;
mod vec3;

pub use interval::Interval;
pub use jet::Jet;
pub(crate) use jet::stumpff;
pub use jet3::Jet3;
pub use quat::Quat;
pub use scalar::Scalar;
pub use vec3::Vec3;

//! Says what a file is.

mod gltf;
mod keyframes;
mod path;

pub use self::gltf::{ClipSummary, GltfSummary, Parts, TreeNode, gltf};
pub use self::keyframes::{KeyframesSummary, keyframes};
pub use self::path::{PathSummary, path, rotations};

//! Says what a file is.

mod gltf;
mod keyframes;

pub use self::gltf::{ClipSummary, GltfSummary, Parts, TreeNode, gltf};
pub use self::keyframes::{KeyframesSummary, keyframes};

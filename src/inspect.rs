//! Says what a file is.

mod gltf;

pub use self::gltf::{ClipSummary, GltfSummary, Parts, TreeNode, gltf};

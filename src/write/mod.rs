//! Samples to glTF.
//!
//! A [`Scene`] is what stands still: nodes, meshes, materials. The samples go to a
//! [`Buffer`] as they are made; [`Animation`]s say which of its bytes they are; and
//! [`document`] describes all of it in JSON, written last into the room that was kept.

mod container;
mod document;
mod free_body;
mod glider;
mod mesh;
mod scene;

pub use container::{Bin, Buffer, Glb, LARGEST_GLB, glb_size};
pub use document::{Animation, Channel, Data, Property, document};
pub use mesh::{Material, Mesh, Part};
pub use scene::{Node, Scene};

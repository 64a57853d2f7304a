//! Samples to glTF.
//!
//! A [`Scene`] is what stands still: nodes, meshes, materials. The samples go to a
//! [`Buffer`] as they are made; [`Animation`]s say which of its bytes they are; and
//! [`document`] describes all of it in JSON, written last into the room that was kept.

mod container;
mod document;
mod free_body;
mod glider;
mod line;
mod mesh;
mod scene;
mod trace;

pub use container::{Bin, Buffer, Glb, LARGEST_GLB, glb_size};
pub use document::{Animation, Channel, Component, Data, Interpolation, Property, document};
pub use line::Line;
pub use mesh::{Material, Mesh, Part};
pub use scene::{Lens, Node, Object, Scene, Shape};
#[cfg(feature = "plot")]
pub(crate) use trace::helix;
pub use trace::{Colour, Trace};

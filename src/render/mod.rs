//! Draws a glTF file at a time of one of its clips.

mod colour;
mod cpu;
mod error;
mod frame;
mod gpu;
mod layer;
mod scene;
mod shade;
#[cfg(test)]
mod tests;
mod texture;
mod triangle;

pub use error::Error;
pub use layer::Background;

/// The most pixels a side that a picture may have.
pub const MOST_PIXELS: u32 = 16384;

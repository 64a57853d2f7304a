//! Draws a glTF file: at a time of one of its clips, or its motion.
//!
//! [`thumbnail`] makes one picture; a [`Session`] reads the file once and
//! makes many: moments, contact sheets, ghosts, clips side by side, and the
//! frames of a [`Film`], which [`encode`] writes as GIF, APNG or WebP.
//! [`side_by_side`] shows two files. What is drawn is glTF 2.0's core: triangles
//! and lines in a tree of nodes that translations, rotations and scales move,
//! with base colours, textures and vertex colours. Skins and morph targets rest,
//! and a note says so.
//!
//! The flow is `load` (file to parts and nodes), `pose` (nodes at a time),
//! `view` (where the camera stands), `scene` (what a renderer needs), then
//! `gpu` or `cpu`, which draw alike, `layer` (onto a background), and `cell`
//! (with lines and words, into a grid).

mod background;
mod camera;
mod cell;
mod colour;
mod cpu;
pub mod encode;
mod error;
mod film;
mod floor;
mod frame;
mod framing;
mod ghost;
#[cfg(feature = "render")]
mod gpu;
#[cfg(not(feature = "render"))]
#[path = "no_gpu.rs"]
mod gpu;
mod grid;
mod label;
mod layer;
mod load;
mod look;
mod mesh;
mod overlap;
mod pair;
mod pose;
mod scene;
mod session;
mod shade;
mod still;
mod stroke;
#[cfg(test)]
mod tests;
mod texture;
mod time;
mod triangle;
mod view;

pub use background::Background;
pub use error::Error;
pub use film::{Film, MOST_FRAMES};
pub use look::{ClipLook, LEAST_VISIBLE, Look};
pub use pair::{Moment, side_by_side};
pub use session::Session;
pub use still::Which;
pub use time::Time;
pub use view::Style;

use crate::asset::Asset;
use image::RgbaImage;

/// The most pixels a side that a picture may have.
pub const MOST_PIXELS: u32 = 16384;

/// What to draw with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Renderer {
    /// A graphics adapter, or the built-in renderer where there is none or it
    /// fails.
    #[default]
    Auto,
    /// A graphics adapter, real or emulated, by wgpu.
    Wgpu,
    /// The built-in software renderer, which draws the same on every machine.
    Cpu,
}

/// What picture to make; the default is half way through the first clip.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Times beyond the clip are clamped, with a note.
    pub time: Time,
    /// The clip's name; the first clip without one.
    pub clip: Option<String>,
    /// What to draw with.
    pub renderer: Renderer,
    /// How it looks.
    pub style: Style,
}

impl Default for Options {
    fn default() -> Self {
        Options { time: Time::Fraction(0.5), clip: None, renderer: Renderer::Auto, style: Style::default() }
    }
}

/// A picture, and how it came about.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Picture {
    /// sRGB, not premultiplied.
    pub pixels: RgbaImage,
    /// The share of pixels, 0 to 1, that anything was drawn to.
    pub covered: f64,
    /// What it was drawn with, in words.
    pub renderer: String,
    /// What was not drawn or done otherwise than asked, a sentence each.
    pub notes: Vec<String>,
}

impl Picture {
    /// The picture as a PNG file.
    pub fn png(&self) -> Vec<u8> {
        let mut file = Vec::new();
        let encoder = image::codecs::png::PngEncoder::new(&mut file);
        let written = self.pixels.write_with_encoder(encoder);
        debug_assert!(written.is_ok(), "writing to memory cannot fail: {written:?}");
        file
    }
}

/// Draws one picture of a file, framed so that the whole clip stays in view.
pub fn thumbnail(asset: &mut Asset, options: &Options) -> Result<Picture, Error> {
    let mut session = Session::new(asset, options.renderer)?;
    let clip = session.clip(options.clip.as_deref())?;
    session.picture(asset, clip, options.time, &options.style)
}

/// Looks whether a file shows anything, and whether its clips move it.
pub fn look(asset: &mut Asset, size: (u32, u32), renderer: Renderer) -> Result<Look, Error> {
    Session::new(asset, renderer)?.look(asset, size)
}

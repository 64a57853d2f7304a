//! Films as files: GIF, APNG, WebP.
//!
//! A writer takes frames that were worked out elsewhere, on any thread: what
//! changed since the frame before, packed as its format wants it.

mod apng;
mod changes;
mod gif;
mod palette;
#[cfg(test)]
mod tests;
mod webp;

pub use apng::Apng;
pub use gif::Gif;
pub use webp::Webp;

use super::error::Error;
use super::overlap::overlap;
use super::{Film, Session};
use crate::asset::Asset;
use image::RgbaImage;
use std::io::{self, Seek, Write};

/// What a file says about all of its frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Head {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// How many frames there will be.
    pub frames: u32,
    /// Again and again instead of once.
    pub repeats: bool,
    /// Whether the pictures have an alpha channel.
    pub transparent: bool,
}

/// Writes moving pictures in one format.
pub trait Encode<W>: Sized {
    /// A frame made ready to be written.
    type Packed: Send;
    /// Units that a second has in this format.
    const PER_SECOND: u32;

    /// Begins a file.
    fn new(out: W, head: Head) -> io::Result<Self>;

    /// Works out a frame, of which `before` is the one before; on any thread.
    fn pack(head: Head, frame: &RgbaImage, before: Option<&RgbaImage>) -> Self::Packed;

    /// Writes the next frame, to be shown for so many units.
    fn write(&mut self, packed: Self::Packed, delay: u32) -> io::Result<()>;

    /// Ends the file.
    fn finish(self) -> io::Result<()>;
}

/// What changed in a frame, ready to be written.
#[derive(Debug)]
pub struct Patch {
    area: changes::Area,
    bytes: Vec<u8>,
}

/// A format of moving pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// 256 colours a frame, transparent or not, times in 1/100 s.
    Gif,
    /// PNG with frames: all colours, lossless.
    Apng,
    /// WebP with frames: all colours, lossless, the smallest.
    Webp,
}

impl Format {
    /// The format of files whose names end so.
    pub fn of_ending(ending: &str) -> Option<Format> {
        match ending.to_ascii_lowercase().as_str() {
            "gif" => Some(Format::Gif),
            "apng" => Some(Format::Apng),
            "webp" => Some(Format::Webp),
            _ => None,
        }
    }
}

/// Draws a film and writes it; drawing, packing and writing overlap, with a few
/// frames in memory. It repeats for ever when `repeats` says so. `advance` is
/// called after each frame.
pub fn film<W: Write + Seek + Send>(
    (session, asset): (&mut Session, &mut Asset),
    film: &Film,
    (format, repeats): (Format, bool),
    out: W,
    advance: impl FnMut() + Send,
) -> Result<(), Error> {
    match format {
        Format::Gif => make::<W, Gif<W>>((session, asset), film, repeats, out, advance),
        Format::Apng => make::<W, Apng<W>>((session, asset), film, repeats, out, advance),
        Format::Webp => make::<W, Webp<W>>((session, asset), film, repeats, out, advance),
    }
}

fn make<W: Send, E: Encode<W> + Send>(
    (session, asset): (&mut Session, &mut Asset),
    film: &Film,
    repeats: bool,
    out: W,
    mut advance: impl FnMut() + Send,
) -> Result<(), Error> {
    let frames = film.frames() as u32;
    let head = Head { size: film.size(), frames, repeats, transparent: film.transparent() };
    let delays = film.delays(E::PER_SECOND);
    let mut file = E::new(out, head)?;
    overlap(
        film.frames(),
        |index| session.frame(asset, film, index),
        |frame, before| E::pack(head, frame, before),
        |index, packed| {
            file.write(packed, delays[index])?;
            advance();
            Ok(())
        },
    )?;
    Ok(file.finish()?)
}

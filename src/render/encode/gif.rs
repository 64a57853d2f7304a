//! GIF.

use super::changes::Area;
use super::palette::Palette;
use super::{Encode, Head};
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use image::RgbaImage;
use std::borrow::Cow;
use std::io::{self, Write};

/// Writes GIF: of each frame what changed, in a palette of its own, so that
/// pictures of few colours are exact. What is less than half opaque is
/// transparent.
pub struct Gif<W: Write>(Encoder<W>);

/// The palette's entry for what is left as it was, or for nothing.
const CLEAR: u8 = 0;

impl<W: Write> Encode<W> for Gif<W> {
    type Packed = Frame<'static>;
    const PER_SECOND: u32 = 100;

    fn new(out: W, head: Head) -> io::Result<Self> {
        let (width, height) = (side(head.size.0)?, side(head.size.1)?);
        let mut encoder = Encoder::new(out, width, height, &[]).map_err(failure)?;
        if head.repeats {
            encoder.set_repeat(Repeat::Infinite).map_err(failure)?;
        }
        Ok(Gif(encoder))
    }

    fn pack(head: Head, frame: &RgbaImage, before: Option<&RgbaImage>) -> Self::Packed {
        let opaque = |pixel: &[u8; 4]| pixel[3] >= 128;
        // What shines through must be wiped away before the next frame, which
        // so depends on none before.
        let before = before.filter(|_| !head.transparent);
        let area = match head.transparent {
            true => Area::seen(frame, opaque),
            false => Area::changed(frame, before),
        };
        let drawn = |pixel: &[u8; 4], old: Option<&[u8; 4]>| opaque(pixel) && Some(pixel) != old;
        let pixels = || {
            area.rows(frame).zip(rows_of(before, area)).flat_map(|(row, old)| {
                row.iter()
                    .enumerate()
                    .map(move |(x, pixel)| drawn(pixel, old.map(|old| &old[x])).then_some(pixel))
            })
        };
        let palette = Palette::of(pixels().flatten().map(|[r, g, b, _]| [*r, *g, *b]), 255);
        let mut index = palette.lookup();
        let indices: Vec<u8> =
            pixels().map(|pixel| pixel.map_or(CLEAR, |[r, g, b, _]| 1 + index([*r, *g, *b]))).collect();
        let mut packed = Frame {
            left: area.left as u16,
            top: area.top as u16,
            width: area.width as u16,
            height: area.height as u16,
            transparent: Some(CLEAR),
            dispose: if head.transparent { DisposalMethod::Background } else { DisposalMethod::Keep },
            palette: Some([&[0; 3], palette.colours().as_flattened()].concat()),
            buffer: Cow::Owned(indices),
            ..Frame::default()
        };
        packed.make_lzw_pre_encoded();
        packed
    }

    fn write(&mut self, mut packed: Self::Packed, delay: u32) -> io::Result<()> {
        packed.delay = delay.try_into().unwrap_or(u16::MAX);
        self.0.write_lzw_pre_encoded_frame(&packed).map_err(failure)
    }

    fn finish(self) -> io::Result<()> {
        self.0.into_inner().map_err(failure)?.flush()
    }
}

/// The rows of the frame before within an area, if there is one.
fn rows_of(frame: Option<&RgbaImage>, area: Area) -> impl Iterator<Item = Option<&[[u8; 4]]>> {
    let rows = frame.into_iter().flat_map(move |frame| area.rows(frame)).map(Some);
    rows.chain(std::iter::repeat(None))
}

fn side(pixels: u32) -> io::Result<u16> {
    pixels.try_into().map_err(|_| io::Error::other("GIF holds at most 65535 pixels a side"))
}

fn failure(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

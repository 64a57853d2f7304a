//! PNG with frames.

use super::changes::Area;
use super::{Encode, Head, Patch};
use image::RgbaImage;
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, EncodingError, Writer};
use std::io::{self, Write};

/// Writes APNG: all colours, and of each frame what changed. Fast rather than
/// small.
pub struct Apng<W: Write>(Writer<W>);

impl<W: Write> Encode<W> for Apng<W> {
    type Packed = Patch;
    const PER_SECOND: u32 = 1000;

    fn new(out: W, head: Head) -> io::Result<Self> {
        let mut encoder = Encoder::new(out, head.size.0, head.size.1);
        encoder.set_color(if head.transparent { ColorType::Rgba } else { ColorType::Rgb });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        encoder.set_animated(head.frames, if head.repeats { 0 } else { 1 }).map_err(failure)?;
        encoder.set_blend_op(BlendOp::Source).map_err(failure)?;
        encoder.set_dispose_op(DisposeOp::None).map_err(failure)?;
        Ok(Apng(encoder.write_header().map_err(failure)?))
    }

    fn pack(head: Head, frame: &RgbaImage, before: Option<&RgbaImage>) -> Self::Packed {
        let area = Area::changed(frame, before);
        Patch { area, bytes: area.bytes(frame, head.transparent) }
    }

    fn write(&mut self, Patch { area, bytes }: Patch, delay: u32) -> io::Result<()> {
        let Apng(writer) = self;
        let mut set = || {
            writer.set_frame_delay(delay.try_into().unwrap_or(u16::MAX), Self::PER_SECOND as u16)?;
            // An area is checked at every step, so it must fit at each.
            writer.set_frame_position(0, 0)?;
            writer.set_frame_dimension(area.width, area.height)?;
            writer.set_frame_position(area.left, area.top)?;
            writer.write_image_data(&bytes)
        };
        set().map_err(failure)
    }

    fn finish(self) -> io::Result<()> {
        self.0.finish().map_err(failure)
    }
}

fn failure(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

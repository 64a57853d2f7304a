//! WebP with frames: `image-webp`'s lossless still pictures in the container
//! that Google's specification describes (RIFF chunks VP8X, ANIM, ANMF).

use super::changes::Area;
use super::{Encode, Head, Patch};
use image::RgbaImage;
use image_webp::{ColorType, EncodingError, WebPEncoder};
use std::io::{self, Seek, SeekFrom, Write};

/// Writes WebP: all colours, and of each frame what changed.
pub struct Webp<W> {
    out: W,
    /// Bytes written after the first 8.
    length: u64,
}

/// Bits of a VP8X chunk.
const HAS_ALPHA: u8 = 0x10;
const HAS_ANIMATION: u8 = 0x02;
/// Bit of an ANMF chunk: the frame replaces what was there, alpha included.
const DO_NOT_BLEND: u8 = 0x02;
/// What stands before the payload of the one chunk of a still picture: `RIFF`,
/// its length, `WEBP`, `VP8L`, its length.
const BEFORE_PAYLOAD: usize = 20;

impl<W: Write + Seek> Encode<W> for Webp<W> {
    type Packed = io::Result<Patch>;
    const PER_SECOND: u32 = 1000;

    fn new(mut out: W, head: Head) -> io::Result<Self> {
        // The length is written over in the end.
        out.write_all(b"RIFF\0\0\0\0WEBP")?;
        let mut webp = Webp { out, length: 4 };
        let flags = HAS_ANIMATION | if head.transparent { HAS_ALPHA } else { 0 };
        let [width, height] = [head.size.0, head.size.1].map(|side| three(side - 1));
        webp.chunk(b"VP8X", &[&[flags, 0, 0, 0], &width, &height])?;
        let times: u16 = if head.repeats { 0 } else { 1 };
        webp.chunk(b"ANIM", &[&[0; 4], &times.to_le_bytes()])?;
        Ok(webp)
    }

    fn pack(head: Head, frame: &RgbaImage, before: Option<&RgbaImage>) -> Self::Packed {
        let area = Area::changed(frame, before).even();
        let colour = if head.transparent { ColorType::Rgba8 } else { ColorType::Rgb8 };
        let mut still = Vec::new();
        let bytes = area.bytes(frame, head.transparent);
        WebPEncoder::new(&mut still).encode(&bytes, area.width, area.height, colour).map_err(failure)?;
        Ok(Patch { area, bytes: still })
    }

    fn write(&mut self, packed: Self::Packed, delay: u32) -> io::Result<()> {
        let Patch { area, bytes: still } = packed?;
        let payload = still.get(BEFORE_PAYLOAD - 8..).filter(|p| p.starts_with(b"VP8L"));
        let payload = payload.ok_or_else(|| io::Error::other("a picture is not as WebP's are"))?;
        let place = [area.left / 2, area.top / 2, area.width - 1, area.height - 1].map(three);
        self.chunk(b"ANMF", &[place.as_flattened(), &three(delay), &[DO_NOT_BLEND], payload])
    }

    fn finish(mut self) -> io::Result<()> {
        let length = u32::try_from(self.length).map_err(|_| io::Error::other("WebP holds at most 4 GiB"))?;
        self.out.seek(SeekFrom::Start(4))?;
        self.out.write_all(&length.to_le_bytes())?;
        self.out.seek(SeekFrom::End(0))?;
        self.out.flush()
    }
}

impl<W: Write> Webp<W> {
    /// Writes a chunk of some pieces, with a byte more where they are odd.
    fn chunk(&mut self, name: &[u8; 4], pieces: &[&[u8]]) -> io::Result<()> {
        let length: usize = pieces.iter().map(|piece| piece.len()).sum();
        self.out.write_all(name)?;
        self.out.write_all(&(length as u32).to_le_bytes())?;
        pieces.iter().try_for_each(|piece| self.out.write_all(piece))?;
        self.out.write_all(&[0][..length % 2])?;
        self.length += 8 + length.next_multiple_of(2) as u64;
        Ok(())
    }
}

/// The lower 24 bits.
fn three(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

fn failure(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

//! Bytes in their order: the .glb container, and the .bin beside a .gltf.
//!
//! Source: glTF 2.0 specification, chapter 4 (GLB File Format).

use std::io::{self, Seek, SeekFrom, Write};

/// Where samples go as they are made.
pub trait Buffer {
    /// Appends bytes.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()>;
    /// How many were appended.
    fn length(&self) -> u64;
}

/// The most bytes a .glb can have: its lengths are 32-bit numbers.
pub const LARGEST_GLB: u64 = u32::MAX as u64;

const HEADER: u64 = 12;
const CHUNK_HEADER: u64 = 8;
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// A .glb file under construction: room for the JSON, then the binary chunk as it comes.
#[derive(Debug)]
pub struct Glb<W> {
    out: W,
    /// Bytes kept for the JSON, a multiple of 4.
    room: u64,
    length: u64,
}

/// The size of a .glb with so much JSON and so much binary data.
pub fn glb_size(json: usize, binary: u64) -> u64 {
    HEADER + 2 * CHUNK_HEADER + json.next_multiple_of(4) as u64 + binary.next_multiple_of(4)
}

impl<W: Write + Seek> Glb<W> {
    /// Begins a file, `out` being at its start, with room for `json` bytes of JSON.
    pub fn new(mut out: W, json: usize) -> io::Result<Glb<W>> {
        let room = json.next_multiple_of(4) as u64;
        out.seek(SeekFrom::Start(HEADER + CHUNK_HEADER + room + CHUNK_HEADER))?;
        Ok(Glb { out, room, length: 0 })
    }

    /// Writes the JSON and the headers; returns the output, flushed.
    ///
    /// Panics if the JSON is longer than the room kept for it or the file longer than
    /// [`LARGEST_GLB`]: both are the caller's to know beforehand.
    pub fn finish(mut self, json: &[u8]) -> io::Result<W> {
        assert!(json.len() as u64 <= self.room, "the JSON fits into the room kept for it");
        let padding = self.length.next_multiple_of(4) - self.length;
        self.append(&[0; 3][..padding as usize])?;
        let total = HEADER + 2 * CHUNK_HEADER + self.room + self.length;
        let word = |x: u64| u32::try_from(x).expect("a .glb is at most 4 GiB").to_le_bytes();
        let mut head = Vec::with_capacity((total - self.length) as usize);
        head.extend(b"glTF");
        head.extend(2u32.to_le_bytes());
        head.extend(word(total));
        head.extend(word(self.room));
        head.extend(JSON.to_le_bytes());
        head.extend(json);
        head.resize((HEADER + CHUNK_HEADER + self.room) as usize, b' ');
        head.extend(word(self.length));
        head.extend(BIN.to_le_bytes());
        self.out.seek(SeekFrom::Start(0))?;
        self.out.write_all(&head)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

impl<W: Write> Buffer for Glb<W> {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)?;
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn length(&self) -> u64 {
        self.length
    }
}

/// A .bin file under construction, hashed on the way: its name carries its content.
#[derive(Debug)]
pub struct Bin<W> {
    out: W,
    length: u64,
    hasher: blake3::Hasher,
}

impl<W: Write> Bin<W> {
    /// Begins a file.
    pub fn new(out: W) -> Bin<W> {
        Bin { out, length: 0, hasher: blake3::Hasher::new() }
    }

    /// The output, flushed, and sixteen hexadecimal digits of its content's hash.
    pub fn finish(mut self) -> io::Result<(W, String)> {
        self.out.flush()?;
        let digits = self.hasher.finalize().to_hex()[..16].to_owned();
        Ok((self.out, digits))
    }
}

impl<W: Write> Buffer for Bin<W> {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)?;
        self.hasher.update(bytes);
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn length(&self) -> u64 {
        self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn glb_reads_back() {
        let mut glb = Glb::new(Cursor::new(Vec::new()), 21).unwrap();
        glb.append(b"abcde").unwrap();
        let bytes = glb.finish(b"{\"asset\":{}}").unwrap().into_inner();
        assert_eq!(bytes.len() as u64, glb_size(21, 5));
        let read = gltf::Glb::from_slice(&bytes).unwrap();
        assert_eq!(read.header.length as usize, bytes.len());
        assert_eq!(read.json.as_ref(), b"{\"asset\":{}}            ");
        assert_eq!(read.bin.unwrap().as_ref(), b"abcde\0\0\0");
    }

    #[test]
    fn bin_knows_its_content() {
        let finish = |bytes: &[u8]| {
            let mut bin = Bin::new(Vec::new());
            bin.append(bytes).unwrap();
            bin.finish().unwrap()
        };
        assert_eq!(finish(b"abc").0, b"abc");
        assert_ne!(finish(b"abc").1, finish(b"abd").1);
        assert_eq!(finish(b"abc").1.len(), 16);
    }
}

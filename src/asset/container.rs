//! The outer form of a file: a `.glb`'s header and chunks, or plain text.
//!
//! Reading here forgives what it can (a wrong total length, odd padding, a
//! chunk cut short): [`crate::check`] judges the same facts.

use std::io::{Read, SeekFrom};

use super::{Error, Source};

/// `glTF`, the first four bytes of a `.glb`.
pub const MAGIC: [u8; 4] = *b"glTF";
/// The type of the chunk that holds the JSON.
pub const JSON: [u8; 4] = *b"JSON";
/// The type of the chunk that holds the first buffer.
pub const BIN: [u8; 4] = *b"BIN\0";

/// Bytes of a `.glb`'s header, and of each chunk's header.
const HEADER: u64 = 12;
const CHUNK_HEADER: u64 = 8;

/// Chunks that are looked at; a file of nothing but empty chunks must not
/// keep anyone busy.
const CHUNKS: usize = 64;

/// How a file is put together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Container {
    /// A `.glb`: header and chunks.
    Glb(Glb),
    /// A `.gltf`: JSON text of this many bytes.
    Text {
        /// Bytes in the file.
        length: u64,
    },
}

/// A `.glb`'s header and chunks, as they claim to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Glb {
    /// Bytes in the file.
    pub length: u64,
    /// Bytes in the file according to its header.
    pub declared: u64,
    /// The chunks in their order, as far as the file reaches.
    pub chunks: Vec<Chunk>,
    /// Where reading chunks ended: the end of the file, where all is well.
    pub end: u64,
}

/// A chunk of a `.glb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Its type, [`JSON`] or [`BIN`] or another.
    pub kind: [u8; 4],
    /// Where its data begins in the file.
    pub start: u64,
    /// Bytes of data according to its header.
    pub declared: u64,
    /// Bytes of data that the file really has.
    pub length: u64,
}

impl Container {
    /// Reads the header and walks the chunks.
    pub(super) fn read(main: &mut dyn Source) -> Result<Container, Error> {
        let length = main.seek(SeekFrom::End(0))?;
        main.rewind()?;
        let mut magic = [0; 4];
        if length >= 4 {
            main.read_exact(&mut magic)?;
        }
        if magic == MAGIC { glb(main, length).map(Container::Glb) } else { text(main, length) }
    }

    /// The JSON text, without a byte-order mark and without zero bytes after
    /// it, and whether it had them.
    pub(super) fn json(&self, main: &mut dyn Source) -> Result<(Vec<u8>, JsonForm), Error> {
        let (start, length) = match self {
            Container::Text { length } => (0, *length),
            Container::Glb(glb) => match glb.chunks.first() {
                Some(chunk) if chunk.kind == JSON => (chunk.start, chunk.length),
                Some(chunk) => {
                    let kind = chunk.kind.escape_ascii();
                    let problem = format!("its first chunk must be `JSON` and is `{kind}`");
                    return Err(Error::NotGltf(problem));
                }
                None => return Err(Error::NotGltf("it ends before its JSON chunk".into())),
            },
        };
        main.seek(SeekFrom::Start(start))?;
        let mut json = Vec::new();
        main.take(length).read_to_end(&mut json)?;
        let form = JsonForm {
            byte_order_mark: json.starts_with(BYTE_ORDER_MARK),
            zero_padded: json.last() == Some(&0),
        };
        if form.byte_order_mark {
            json.drain(..BYTE_ORDER_MARK.len());
        }
        while json.last() == Some(&0) {
            json.pop();
        }
        Ok((json, form))
    }

    /// Where the binary chunk begins, and how many bytes it really has.
    pub fn bin(&self) -> Option<(u64, u64)> {
        let Container::Glb(glb) = self else {
            return None;
        };
        let chunk = glb.chunks.iter().find(|chunk| chunk.kind == BIN)?;
        Some((chunk.start, chunk.length))
    }

    /// Bytes in the file.
    pub fn length(&self) -> u64 {
        match self {
            Container::Glb(glb) => glb.length,
            Container::Text { length } => *length,
        }
    }
}

/// What was taken off the JSON text before it was parsed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JsonForm {
    /// It began with a byte-order mark.
    pub byte_order_mark: bool,
    /// Zero bytes came after it.
    pub zero_padded: bool,
}

/// What some editors put before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The rest of a `.glb` after its magic.
fn glb(main: &mut dyn Source, length: u64) -> Result<Glb, Error> {
    if length < HEADER {
        return Err(Error::NotGltf(format!(
            "it has {length} bytes, and the header of a .glb alone has {HEADER}"
        )));
    }
    let version = u32_from(main)?;
    if version != 2 {
        return Err(Error::NotGltf(format!("its header must say version 2 and says {version}")));
    }
    let declared = u64::from(u32_from(main)?);
    let (mut chunks, mut at) = (Vec::new(), HEADER);
    while length - at >= CHUNK_HEADER && chunks.len() < CHUNKS {
        main.seek(SeekFrom::Start(at))?;
        let claimed = u64::from(u32_from(main)?);
        let mut kind = [0; 4];
        main.read_exact(&mut kind)?;
        // Beyond its end according to the header, only what must be a chunk.
        if at >= declared && kind != JSON && kind != BIN {
            break;
        }
        let start = at + CHUNK_HEADER;
        let chunk = Chunk { kind, start, declared: claimed, length: claimed.min(length - start) };
        at = start + chunk.length;
        chunks.push(chunk);
    }
    Ok(Glb { length, declared, chunks, end: at })
}

/// A `.gltf` must at least begin like a JSON object: nobody waits for a large
/// video to be read to its end before hearing that it is no glTF.
fn text(main: &mut dyn Source, length: u64) -> Result<Container, Error> {
    main.rewind()?;
    let mut head = Vec::new();
    main.take(4096).read_to_end(&mut head)?;
    let head = head.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&head);
    match head.iter().find(|byte| !byte.is_ascii_whitespace()) {
        Some(b'{') => Ok(Container::Text { length }),
        Some(_) => {
            Err(Error::NotGltf("a .glb begins with `glTF`, a .gltf with `{`; this file does neither".into()))
        }
        None => Err(Error::NotGltf("the file is empty".into())),
    }
}

fn u32_from(main: &mut dyn Source) -> Result<u32, Error> {
    let mut bytes = [0; 4];
    main.read_exact(&mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}

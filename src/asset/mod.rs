//! Any glTF 2.0 file, opened for reading: JSON parsed, buffers read on demand.
//!
//! [`Asset`] holds the JSON and, for the rest, only where it lies: accessors
//! are read from the file in blocks when they are asked for, so a file of
//! 4 GiB needs no more memory than a small one. Every number in the file is a
//! claim by a stranger: each is checked against the bytes that are there
//! before anything is read or allocated.
//!
//! The library opens no files. The caller hands in the main file as a
//! [`Source`] and opens a `.gltf`'s other files through [`Resolve`].

mod accessor;
pub mod container;
mod parse;
pub mod play;
#[cfg(test)]
pub(crate) mod tests;
mod uri;

use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

use gltf::json::Root;

pub(crate) use accessor::Layout;
pub use accessor::Shape;
pub use container::Container;

/// What a glTF file or one of its buffers is read from: a file, a cursor.
pub trait Source: Read + Seek + Send {}

impl<T: Read + Seek + Send> Source for T {}

/// Opens the files that a `.gltf` names.
pub trait Resolve: Send {
    /// Opens the file at `uri`, relative to the folder of the main file.
    ///
    /// `uri` is percent-decoded and a relative path without `..`; whether links
    /// on its way may be followed is for the implementation to say.
    fn open(&self, uri: &str) -> io::Result<Box<dyn Source>>;
}

/// Opens nothing: for a file that must stand alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Resolve for NoFiles {
    fn open(&self, uri: &str) -> io::Result<Box<dyn Source>> {
        let reason = format!("no other file is opened here, not even `{uri}`");
        Err(io::Error::new(io::ErrorKind::Unsupported, reason))
    }
}

/// Why a glTF file, or a part of it, cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file itself cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// Neither `.glb` nor `.gltf`.
    #[error("not a glTF 2.0 file: {0}")]
    NotGltf(String),
    /// The JSON text is broken.
    #[error("the JSON of this file is broken: {0}")]
    Json(String),
    /// The JSON is JSON, but not glTF's.
    #[error("the JSON of this file does not follow the glTF 2.0 schema: {0}")]
    Schema(String),
    /// One part of the file is not what the JSON says it is.
    #[error("{pointer}: {problem}")]
    Data {
        /// JSON pointer to the part.
        pointer: String,
        /// What is wrong with it.
        problem: String,
    },
}

impl Error {
    /// A problem with the part at `pointer`.
    pub(crate) fn data(pointer: impl Into<String>, problem: impl Into<String>) -> Self {
        Error::Data { pointer: pointer.into(), problem: problem.into() }
    }
}

/// An opened glTF file.
pub struct Asset {
    root: Root,
    json: Vec<u8>,
    json_form: container::JsonForm,
    container: Container,
    main: Box<dyn Source>,
    resolve: Box<dyn Resolve>,
    /// One for each of the JSON's buffers; `None` until first used.
    stores: Vec<Option<Store>>,
}

/// Where a buffer's bytes are.
enum Store {
    /// In the main file, from this byte on.
    Main { start: u64, length: u64 },
    /// Decoded from a `data:` URI.
    Inline(Vec<u8>),
    /// In another file.
    File { source: Box<dyn Source>, length: u64 },
}

impl Store {
    fn length(&self) -> u64 {
        match self {
            Store::Main { length, .. } | Store::File { length, .. } => *length,
            Store::Inline(bytes) => bytes.len() as u64,
        }
    }
}

impl std::fmt::Debug for Asset {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Asset").field("container", &self.container).finish_non_exhaustive()
    }
}

impl Asset {
    /// Opens a `.glb` or `.gltf`, told apart by the first bytes.
    ///
    /// Fails only where no glTF JSON can be had; what else is wrong with the
    /// file shows when that part is read, or in [`crate::check`].
    pub fn open(mut main: Box<dyn Source>, resolve: Box<dyn Resolve>) -> Result<Asset, Error> {
        let container = Container::read(&mut *main)?;
        let (json, json_form) = container.json(&mut *main)?;
        let root = parse::root(&json)?;
        let stores = root.buffers.iter().map(|_| None).collect();
        Ok(Asset { root, json, json_form, container, main, resolve, stores })
    }

    /// The parsed JSON. Its indices are unchecked: use `get`, never `[]`.
    ///
    /// An animation channel without a node has `u32::MAX` as its node.
    pub fn root(&self) -> &Root {
        &self.root
    }

    /// The JSON's own text, without padding.
    pub fn json(&self) -> &[u8] {
        &self.json
    }

    /// What was taken off the JSON's text.
    pub fn json_form(&self) -> container::JsonForm {
        self.json_form
    }

    /// How the file is put together.
    pub fn container(&self) -> &Container {
        &self.container
    }

    /// Bytes of the file itself, as far as it has such.
    pub(crate) fn main_bytes(&mut self, bytes: Range<u64>) -> Result<Vec<u8>, Error> {
        let length = self.container.length();
        let (start, end) = (bytes.start.min(length), bytes.end.min(length));
        let mut out = vec![0; end.saturating_sub(start) as usize];
        let read = self.main.seek(SeekFrom::Start(start)).and_then(|_| self.main.read_exact(&mut out));
        read.map_err(|error| Error::data("", error.to_string()))?;
        Ok(out)
    }

    /// How many bytes a buffer really has, whatever its `byteLength` says.
    pub fn buffer_length(&mut self, buffer: usize) -> Result<u64, Error> {
        Ok(self.store(buffer)?.length())
    }

    /// How many bytes there are in the file and its buffers together.
    fn stored_bytes(&mut self) -> u64 {
        let others = (0..self.stores.len()).map(|buffer| match self.store(buffer) {
            Ok(Store::Main { .. }) | Err(_) => 0,
            Ok(store) => store.length(),
        });
        others.fold(0, u64::saturating_add).saturating_add(self.container.length())
    }

    /// The bytes of a buffer view.
    pub fn view(&mut self, view: usize) -> Result<Vec<u8>, Error> {
        let pointer = || format!("/bufferViews/{view}");
        let span = self.view_span(view)?;
        // The span is known to lie within bytes that exist.
        let length = usize::try_from(span.length)
            .map_err(|_| Error::data(pointer(), "is larger than this machine's memory"))?;
        let mut bytes = vec![0; length];
        self.read_at(span.buffer, span.start, &mut bytes)?;
        Ok(bytes)
    }

    /// An image as it is stored, PNG or JPEG: from a buffer view, a `data:`
    /// URI or another file.
    pub fn image(&mut self, image: usize) -> Result<Vec<u8>, Error> {
        let pointer = format!("/images/{image}");
        let Some(stored) = self.root.images.get(image) else {
            return Err(Error::data(pointer, "there is no such image"));
        };
        if let Some(view) = stored.buffer_view {
            return self.view(view.value());
        }
        let Some(text) = &stored.uri else {
            return Err(Error::data(pointer, "has neither a bufferView nor a uri"));
        };
        let mut bytes = Vec::new();
        match open_uri(text, &*self.resolve, &format!("{pointer}/uri"))? {
            Store::Inline(inline) => bytes = inline,
            Store::File { mut source, .. } => {
                source.read_to_end(&mut bytes).map_err(|e| Error::data(pointer, e.to_string()))?;
            }
            Store::Main { .. } => {}
        }
        Ok(bytes)
    }

    /// Fills `out` from a buffer, starting at byte `offset` of it.
    pub(crate) fn read_at(&mut self, buffer: usize, offset: u64, out: &mut [u8]) -> Result<(), Error> {
        let pointer = || format!("/buffers/{buffer}");
        let length = self.store(buffer)?.length();
        let end = offset.checked_add(out.len() as u64);
        if end.is_none_or(|end| end > length) {
            return Err(Error::data(
                pointer(),
                format!("has {length} bytes, too few to read {} from byte {offset}", out.len()),
            ));
        }
        let failed = |e: io::Error| Error::data(pointer(), e.to_string());
        let (source, start) = match &mut self.stores[buffer] {
            Some(Store::Inline(bytes)) => {
                // Within bounds: a slice's length fits usize.
                let start = offset as usize;
                out.copy_from_slice(&bytes[start..start + out.len()]);
                return Ok(());
            }
            Some(Store::Main { start, .. }) => (&mut self.main, *start),
            Some(Store::File { source, .. }) => (source, 0),
            None => return Err(Error::data(pointer(), "is not open")),
        };
        source.seek(SeekFrom::Start(start + offset)).map_err(failed)?;
        source.read_exact(out).map_err(failed)
    }

    /// A buffer's bytes, found and opened at first use.
    fn store(&mut self, buffer: usize) -> Result<&Store, Error> {
        if buffer >= self.stores.len() {
            let pointer = format!("/buffers/{buffer}");
            return Err(Error::data(pointer, "there is no such buffer"));
        }
        if self.stores[buffer].is_none() {
            let opened = self.open_store(buffer)?;
            self.stores[buffer] = Some(opened);
        }
        self.stores[buffer].as_ref().ok_or_else(|| Error::data(format!("/buffers/{buffer}"), "is not open"))
    }

    fn open_store(&mut self, buffer: usize) -> Result<Store, Error> {
        let pointer = format!("/buffers/{buffer}");
        if let Some(uri) = &self.root.buffers[buffer].uri {
            return open_uri(uri, &*self.resolve, &format!("{pointer}/uri"));
        }
        match self.container.bin() {
            Some((start, length)) if buffer == 0 => Ok(Store::Main { start, length }),
            _ => Err(Error::data(pointer, "has no uri, and there is no binary chunk it could stand for")),
        }
    }
}

/// The bytes behind a URI.
fn open_uri(text: &str, resolve: &dyn Resolve, pointer: &str) -> Result<Store, Error> {
    let wrong = |problem: String| Error::data(pointer, problem);
    match uri::parse(text).map_err(wrong)? {
        uri::Uri::Data(bytes) => Ok(Store::Inline(bytes)),
        uri::Uri::Path(path) => {
            let failed = |e: io::Error| wrong(format!("`{path}` cannot be read: {e}"));
            let mut source = resolve.open(&path).map_err(failed)?;
            let length = source.seek(SeekFrom::End(0)).map_err(failed)?;
            source.rewind().map_err(failed)?;
            Ok(Store::File { source, length })
        }
    }
}

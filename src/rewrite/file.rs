//! The changed file: JSON with some values replaced, buffers with some bytes replaced.

use super::content::{Content, Kind, contents};
use super::json::{self, Changes, Edits, Span};
use super::layout::{Buffers, NewView, Settled};
use super::plan::Change;
use super::refs::Fixed;
use super::verify::Strayed;
use super::{ClipFacts, Error, Facts};
use crate::asset::Asset;
use crate::asset::container::{BIN, Container, JSON, MAGIC};
use crate::asset::play::Interpolation;
use gltf::json::validation::Checked;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::mem;
use std::ops::Range;

/// A reduced file.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// The bytes of the .glb or .gltf; none where nothing can be saved.
    pub main: Option<Vec<u8>>,
    /// The new files beside it.
    pub files: Vec<External>,
    /// What became of it.
    pub facts: Facts,
}

/// A buffer in a file of its own.
#[derive(Clone, Debug)]
pub struct External {
    /// Its index in the file's `buffers`.
    pub buffer: usize,
    /// Sixteen digits of its content's hash: what its URI was asked for with.
    pub hash: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// Writes the changes, unless that would not make the file smaller.
pub(super) fn write(
    asset: &mut Asset,
    fixed: &Fixed,
    changes: Vec<Change>,
    uri: impl FnMut(&str) -> String,
) -> Result<Reduced, Error> {
    let length = asset.container().length();
    let unchanged = Facts { clips: clips(asset, &[]), bytes_before: length, bytes_after: length };
    let unchanged = Reduced { main: None, files: Vec::new(), facts: unchanged };
    if changes.is_empty() {
        return Ok(unchanged);
    }
    let clips = clips(asset, &changes);
    let written = Writing::new(asset, fixed, changes).finish(asset, fixed, uri)?;
    if written.after >= written.before {
        return Ok(unchanged);
    }
    let facts = Facts { clips, bytes_before: written.before, bytes_after: written.after };
    Ok(Reduced { main: Some(written.main), files: written.files, facts })
}

fn clips(asset: &Asset, changes: &[Change]) -> Vec<ClipFacts> {
    let root = asset.root();
    let count = |index: usize| root.accessors.get(index).map_or(0, |accessor| accessor.count.0 as usize);
    let mut clips = Vec::with_capacity(root.animations.len());
    for animation in &root.animations {
        let keys: usize = animation.samplers.iter().map(|sampler| count(sampler.input.value())).sum();
        let name = animation.name.clone();
        clips.push(ClipFacts { name, keys_before: keys, keys_after: keys, deviation: Strayed::default() });
    }
    for Change { sampler, found } in changes {
        let clip: &mut ClipFacts = &mut clips[sampler.animation];
        clip.keys_after = clip.keys_after + found.times.len() - sampler.keys;
        clip.deviation.note(sampler.property, found.deviation);
    }
    clips
}

/// A changed sampler's accessors.
struct Sampler {
    animation: usize,
    sampler: usize,
    input: usize,
    output: usize,
    interpolation: Interpolation,
}

/// What every accessor holds after the changes.
struct Writing {
    /// Accessors that were there before and now hold something else.
    old: BTreeMap<usize, Content>,
    new: Vec<Content>,
    samplers: Vec<Sampler>,
    replaced: BTreeSet<usize>,
    home: usize,
    /// Accessors by what they hold.
    alike: HashMap<Kind, Vec<usize>>,
    /// The number of the first new accessor.
    next: usize,
}

struct Written {
    main: Vec<u8>,
    files: Vec<External>,
    before: u64,
    after: u64,
}

impl Writing {
    fn new(asset: &Asset, fixed: &Fixed, changes: Vec<Change>) -> Writing {
        let samplers = || changes.iter().map(|change| change.sampler);
        let changed: BTreeSet<(usize, usize)> = samplers().map(|s| (s.animation, s.sampler)).collect();
        let mut kept = fixed.accessors.clone();
        for (a, animation) in asset.root().animations.iter().enumerate() {
            for (s, sampler) in animation.samplers.iter().enumerate() {
                if !changed.contains(&(a, s)) {
                    kept.extend([sampler.input.value(), sampler.output.value()]);
                }
            }
        }
        let used = samplers().flat_map(|sampler| [sampler.input, sampler.output]);
        let home = samplers().next().map_or(0, |sampler| buffer_of(asset, sampler.output));
        let mut writing = Writing {
            old: BTreeMap::new(),
            new: Vec::new(),
            samplers: Vec::new(),
            replaced: used.filter(|accessor| !kept.contains(accessor)).collect(),
            home,
            alike: HashMap::new(),
            next: asset.root().accessors.len(),
        };
        for (change, (times, values)) in changes.iter().zip(contents(&changes)) {
            let Change { sampler, found } = change;
            let input = writing.place(sampler.input, times);
            let output = writing.place(sampler.output, values);
            let (animation, sampler) = (sampler.animation, sampler.sampler);
            let interpolation = found.interpolation;
            writing.samplers.push(Sampler { animation, sampler, input, output, interpolation });
        }
        writing
    }

    /// The accessor of some content: the one that held the old, one that holds the same,
    /// or a new one.
    fn place(&mut self, slot: usize, content: Content) -> usize {
        let kind = content.kind();
        if self.replaced.contains(&slot) && !self.old.contains_key(&slot) {
            self.alike.entry(kind).or_default().push(slot);
            self.old.insert(slot, content);
            return slot;
        }
        let alike = self.alike.get(&kind).into_iter().flatten();
        if let Some(&same) = alike.into_iter().find(|&&index| self.bytes(index) == content.bytes) {
            return same;
        }
        let new = self.next + self.new.len();
        self.alike.entry(kind).or_default().push(new);
        self.new.push(content);
        new
    }

    /// What an accessor holds.
    fn bytes(&self, index: usize) -> &[u8] {
        let new = index.checked_sub(self.next).and_then(|new| self.new.get(new));
        new.or_else(|| self.old.get(&index)).map_or(&[], |content| &content.bytes)
    }

    fn finish(
        mut self,
        asset: &mut Asset,
        fixed: &Fixed,
        uri: impl FnMut(&str) -> String,
    ) -> Result<Written, Error> {
        let mut buffers = Buffers::new(asset, fixed, &self.replaced, self.home);
        for (&slot, content) in &mut self.old {
            buffers.replace(slot, mem::take(&mut content.bytes));
        }
        for (index, content) in (self.next..).zip(&mut self.new) {
            buffers.append(index, &mem::take(&mut content.bytes));
        }
        let settled = buffers.settle();
        let bytes = Bytes::new(asset, &settled, uri)?;
        let text = std::str::from_utf8(asset.json()).map_err(|_| wrong("the text"))?;
        let edits = Document { text, asset, settled: &settled, writing: &self, bytes: &bytes }.edits()?;
        let text = edits.apply(text).ok_or_else(|| wrong("/"))?;
        let before = asset.container().length() + bytes.before;
        let main = contained(asset, &text, bytes.bin)?;
        let after = main.len() as u64 + bytes.files.iter().map(|file| file.bytes.len() as u64).sum::<u64>();
        Ok(Written { main, files: bytes.files, before, after })
    }
}

fn buffer_of(asset: &Asset, accessor: usize) -> usize {
    let view = asset.root().accessors.get(accessor).and_then(|stored| stored.buffer_view);
    view.and_then(|view| asset.root().get(view)).map_or(0, |view| view.buffer.value())
}

fn wrong(place: impl Into<String>) -> Error {
    Error::Json(place.into())
}

/// The buffers that change.
struct Bytes {
    /// The new length of each, and its new URI, if it has one.
    lengths: BTreeMap<usize, (u64, Option<String>)>,
    home: Option<NewView>,
    bin: Option<Vec<u8>>,
    files: Vec<External>,
    /// Bytes of the old files.
    before: u64,
}

impl Bytes {
    fn new(
        asset: &mut Asset,
        settled: &Settled,
        mut uri: impl FnMut(&str) -> String,
    ) -> Result<Bytes, Error> {
        let (lengths, files) = (BTreeMap::new(), Vec::new());
        let mut all = Bytes { lengths, home: None, bin: None, files, before: 0 };
        for buffer in settled.buffers() {
            let old = asset.buffer_length(buffer)?;
            let stored = asset.root().buffers.get(buffer);
            let used = stored.map_or(old, |stored| stored.byte_length.0.min(old));
            let has_uri = stored.is_some_and(|stored| stored.uri.is_some());
            let mut read = |range: Range<u64>, out: &mut Vec<u8>| {
                let before = out.len();
                out.resize(before + range.end.saturating_sub(range.start) as usize, 0);
                asset.read_at(buffer, range.start, &mut out[before..])
            };
            let (mut new, home) =
                settled.bytes(buffer, used, &mut read)?.ok_or_else(|| wrong("/bufferViews"))?;
            let length = new.len() as u64;
            // Padding is made anew.
            if has_uri || old - used > 3 {
                read(used..old, &mut new)?;
            }
            all.home = all.home.or(home);
            let stated = asset.root().buffers.get(buffer).and_then(|stored| stored.uri.as_deref());
            let uri = match stated {
                None => {
                    all.bin = Some(new);
                    None
                }
                Some(data) if data.starts_with("data:") => Some(data_uri(data, &new)),
                Some(_) => {
                    all.before += old;
                    let hash = blake3::hash(&new).to_hex()[..16].to_owned();
                    let uri = uri(&hash);
                    all.files.push(External { buffer, hash, bytes: new });
                    Some(uri)
                }
            };
            all.lengths.insert(buffer, (length, uri));
        }
        Ok(all)
    }
}

/// The JSON beside all that it has to say.
struct Document<'a> {
    text: &'a str,
    asset: &'a Asset,
    settled: &'a Settled,
    writing: &'a Writing,
    bytes: &'a Bytes,
}

impl Document<'_> {
    fn edits(&self) -> Result<Edits, Error> {
        let mut edits = Edits::default();
        self.accessors(&mut edits)?;
        self.views(&mut edits)?;
        self.buffers(&mut edits)?;
        self.samplers(&mut edits)?;
        Ok(edits)
    }

    /// An array of the root object, and its elements.
    fn list(&self, key: &str) -> Result<(Span, Vec<Span>), Error> {
        let array = json::root(self.text).and_then(|root| json::member(self.text, &root, key));
        let found = array.and_then(|array| Some((array.clone(), json::elements(self.text, &array)?)));
        found.ok_or_else(|| wrong(format!("/{key}")))
    }

    fn change(&self, edits: &mut Edits, span: &Span, changes: Changes) -> Result<(), Error> {
        if changes.is_empty() {
            return Ok(());
        }
        let new = changes.apply(self.text, span).ok_or_else(|| wrong("/"))?;
        edits.replace(span.clone(), new);
        Ok(())
    }

    fn accessors(&self, edits: &mut Edits) -> Result<(), Error> {
        let (array, spans) = self.list("accessors")?;
        let stored = &self.asset.root().accessors;
        for (index, (span, stored)) in spans.iter().zip(stored).enumerate() {
            let mut changes = Changes::default();
            if let Some(content) = self.writing.old.get(&index) {
                content.describe(&mut changes, stored.min.is_some() || stored.max.is_some());
            }
            if let Some(place) = self.settled.accessors.get(&index) {
                if stored.buffer_view.map(|view| view.value()) != Some(place.view) {
                    changes.set("bufferView", place.view);
                }
                if stored.byte_offset.unwrap_or_default().0 != place.offset {
                    changes.set("byteOffset", place.offset);
                }
            }
            self.change(edits, span, changes)?;
        }
        let place = |index| self.settled.accessors.get(&index).ok_or_else(|| wrong("/accessors"));
        let new = (stored.len()..).zip(&self.writing.new);
        let new = new.map(|(index, content)| Ok(content.accessor(place(index)?)));
        self.append(edits, &array, &new.collect::<Result<Vec<_>, Error>>()?)
    }

    fn append(&self, edits: &mut Edits, array: &Span, new: &[String]) -> Result<(), Error> {
        if new.is_empty() {
            return Ok(());
        }
        edits.append(self.text, array, new).ok_or_else(|| wrong("/"))
    }

    fn views(&self, edits: &mut Edits) -> Result<(), Error> {
        let (array, spans) = self.list("bufferViews")?;
        for (index, (span, stored)) in spans.iter().zip(&self.asset.root().buffer_views).enumerate() {
            let mut changes = Changes::default();
            if let Some(range) = self.settled.views.get(&index) {
                if stored.byte_offset.unwrap_or_default().0 != range.start {
                    changes.set("byteOffset", range.start);
                }
                if stored.byte_length.0 != range.end - range.start {
                    changes.set("byteLength", range.end - range.start);
                }
            }
            self.change(edits, span, changes)?;
        }
        let home = self.bytes.home.map(|view| {
            let NewView { buffer, offset, length } = view;
            format!("{{\"buffer\":{buffer},\"byteOffset\":{offset},\"byteLength\":{length}}}")
        });
        self.append(edits, &array, home.as_slice())
    }

    fn buffers(&self, edits: &mut Edits) -> Result<(), Error> {
        let (_, spans) = self.list("buffers")?;
        for (index, (length, uri)) in &self.bytes.lengths {
            let mut changes = Changes::default();
            changes.set("byteLength", length);
            if let Some(uri) = uri {
                changes.set("uri", serde_json::Value::from(uri.as_str()));
            }
            let span = spans.get(*index).ok_or_else(|| wrong("/buffers"))?;
            self.change(edits, span, changes)?;
        }
        Ok(())
    }

    fn samplers(&self, edits: &mut Edits) -> Result<(), Error> {
        let (_, animations) = self.list("animations")?;
        let lists = animations.iter().map(|animation| {
            let array = json::member(self.text, animation, "samplers")?;
            json::elements(self.text, &array)
        });
        let lists: Vec<Option<Vec<Span>>> = lists.collect();
        for Sampler { animation, sampler, input, output, interpolation } in &self.writing.samplers {
            let pointer = || wrong(format!("/animations/{animation}/samplers/{sampler}"));
            let stored = self.asset.root().animations.get(*animation).and_then(|a| a.samplers.get(*sampler));
            let list = lists.get(*animation).and_then(Option::as_ref);
            let span = list.and_then(|list| list.get(*sampler)).ok_or_else(pointer)?;
            let mut changes = Changes::default();
            changes.set("input", input);
            changes.set("output", output);
            if stored.ok_or_else(pointer)?.interpolation != Checked::Valid(*interpolation) {
                changes.set("interpolation", serde_json::json!(interpolation));
            }
            self.change(edits, span, changes)?;
        }
        Ok(())
    }
}

/// The JSON in the container that it came in, with the other chunks as they were.
fn contained(asset: &mut Asset, text: &str, bin: Option<Vec<u8>>) -> Result<Vec<u8>, Error> {
    let glb = match asset.container().clone() {
        Container::Glb(glb) => glb,
        Container::Text { .. } => {
            let mark = if asset.json_form().byte_order_mark { 3 } else { 0 };
            let after = mark + asset.json().len() as u64;
            let before = asset.main_bytes(0..mark)?;
            return Ok([&before, text.as_bytes(), &asset.main_bytes(after..u64::MAX)?].concat());
        }
    };
    let mut json = text.trim_end().as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    // What comes before the new binary chunk's data, these, and what comes after.
    let (mut head, mut bin, mut tail) = ([MAGIC, 2u32.to_le_bytes(), [0; 4]].concat(), bin, Vec::new());
    let mut data = None;
    for chunk in &glb.chunks {
        let after = if data.is_some() { &mut tail } else { &mut head };
        match (chunk.kind, bin.take()) {
            (BIN, Some(mut bin)) => {
                bin.resize(bin.len().next_multiple_of(4), 0);
                after.extend(word(bin.len())?);
                after.extend(BIN);
                data = Some(bin);
            }
            (kind, other) => {
                bin = other;
                let is_json = kind == JSON && after.len() == 12 && data.is_none();
                let stored = match is_json {
                    true => Cow::Borrowed(&json),
                    false => Cow::Owned(asset.main_bytes(chunk.start..chunk.start + chunk.length)?),
                };
                after.extend(word(stored.len())?);
                after.extend(kind);
                after.extend_from_slice(&stored);
            }
        }
    }
    let rest = asset.main_bytes(glb.end..u64::MAX)?;
    let mut file = data.unwrap_or_default();
    let counted = if glb.declared >= glb.length { rest.len() } else { 0 };
    let length = word(head.len() + file.len() + tail.len() + counted)?;
    head[8..12].copy_from_slice(&length);
    // Its memory is moved within itself rather than copied.
    file.splice(0..0, head);
    file.extend(tail);
    file.extend(rest);
    Ok(file)
}

/// A length as a .glb has it.
fn word(length: usize) -> Result<[u8; 4], Error> {
    u32::try_from(length).map(u32::to_le_bytes).map_err(|_| Error::TooLarge(length as u64))
}

/// A data: URI of the same media type, in base64 (RFC 4648).
pub(super) fn data_uri(old: &str, bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let head = old.split(',').next().unwrap_or("data:");
    let head = head.strip_suffix(";base64").unwrap_or(head);
    let mut uri = format!("{head};base64,");
    for group in bytes.chunks(3) {
        let bits = group.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte));
        let bits = bits << (8 * (3 - group.len()));
        for i in 0..4 {
            let sextet = (bits >> (18 - 6 * i)) & 63;
            uri.push(if i <= group.len() { char::from(ALPHABET[sextet as usize]) } else { '=' });
        }
    }
    uri
}

//! The changed file: JSON with some values replaced, buffers with some bytes replaced.

use super::json::{self, Changes, Edits, Span};
use super::layout::{Buffers, NewView, Place, Settled};
use super::plan::Change;
use super::refs::Fixed;
use super::track::Stored;
use super::verify::Strayed;
use super::{ClipFacts, Error, Facts};
use crate::asset::Asset;
use crate::asset::container::{BIN, Container, JSON, MAGIC};
use crate::asset::play::{Interpolation, Property};
use gltf::json::validation::Checked;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A reduced file.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// The bytes of the .glb or .gltf; those of the input where nothing can be saved.
    pub main: Vec<u8>,
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
    main: &[u8],
    asset: &mut Asset,
    fixed: &Fixed,
    changes: Vec<Change>,
    uri: impl FnMut(&str) -> String,
) -> Result<Reduced, Error> {
    let facts = |changes: &[Change], before: u64, after: u64| Facts {
        clips: clips(asset, changes),
        bytes_before: before,
        bytes_after: after,
    };
    let unchanged = Facts { ..facts(&[], main.len() as u64, main.len() as u64) };
    let changed_facts = facts(&changes, 0, 0);
    let unchanged = Reduced { main: main.to_vec(), files: Vec::new(), facts: unchanged };
    if changes.is_empty() {
        return Ok(unchanged);
    }
    let written = Writing::new(asset, fixed, &changes).finish(main, asset, fixed, uri)?;
    if written.after >= written.before {
        return Ok(unchanged);
    }
    let facts = Facts { bytes_before: written.before, bytes_after: written.after, ..changed_facts };
    Ok(Reduced { main: written.main, files: written.files, facts })
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
    for Change { track, found } in changes {
        let clip: &mut ClipFacts = &mut clips[track.animation];
        clip.keys_after = clip.keys_after + found.times.len() - track.times.len();
        clip.deviation.note(track.property, found.deviation);
    }
    clips
}

/// What an accessor holds from now on.
#[derive(Clone, Debug)]
struct Content {
    /// Times of keys, not values.
    times: bool,
    kind: &'static str,
    stored: Stored,
    count: usize,
    /// As JSON, number by number.
    min: String,
    max: String,
    bytes: Vec<u8>,
}

impl Content {
    fn times(times: &[f32]) -> Content {
        Content { times: true, ..Content::new("SCALAR", 1, Stored::FLOATS, times) }
    }

    fn new(kind: &'static str, components: usize, stored: Stored, numbers: &[f32]) -> Content {
        let bound = |pick: fn(f32, f32) -> f32| {
            let part = |c: usize| numbers.iter().skip(c).step_by(components).copied().reduce(pick);
            let all: Vec<String> =
                (0..components).map(|c| stored.as_json(part(c).unwrap_or_default())).collect();
            format!("[{}]", all.join(","))
        };
        Content {
            times: false,
            kind,
            stored,
            count: numbers.len() / components,
            min: bound(f32::min),
            max: bound(f32::max),
            bytes: stored.bytes(numbers),
        }
    }

    /// Changes an accessor that was there; bounds stay where they were stated.
    fn describe(&self, accessor: &mut Changes, bounds: bool) {
        accessor.set("componentType", self.stored.component.as_gl_enum());
        accessor.set("count", self.count);
        let mut optional = |key, value: Option<&str>| match value {
            Some(value) => accessor.set(key, value),
            None => accessor.remove(key),
        };
        optional("normalized", self.stored.normalized.then_some("true"));
        let bounds = bounds || self.times;
        optional("min", bounds.then_some(&self.min));
        optional("max", bounds.then_some(&self.max));
        optional("sparse", None);
    }

    /// A new accessor.
    fn accessor(&self, place: &Place) -> String {
        let offset =
            if place.offset == 0 { String::new() } else { format!("\"byteOffset\":{},", place.offset) };
        let normalized = if self.stored.normalized { "\"normalized\":true," } else { "" };
        let (min, max) = (&self.min, &self.max);
        let bounds = if self.times { format!(",\"min\":{min},\"max\":{max}") } else { String::new() };
        format!(
            "{{\"bufferView\":{},{offset}\"componentType\":{},{normalized}\"count\":{},\"type\":\"{}\"{bounds}}}",
            place.view,
            self.stored.component.as_gl_enum(),
            self.count,
            self.kind,
        )
    }

    /// What makes two accessors one.
    fn identity(&self) -> Identity {
        (self.times, self.kind, self.stored.component.as_gl_enum(), self.bytes.clone())
    }
}

/// Use, type, component type and bytes.
type Identity = (bool, &'static str, u32, Vec<u8>);

impl Stored {
    /// A number as it is stored, as JSON.
    fn as_json(self, x: f32) -> String {
        let bytes = self.bytes(&[x]);
        match (self == Stored::FLOATS, &bytes[..]) {
            (true, _) => serde_json::Value::from(f64::from(x)).to_string(),
            (_, &[a]) if x < 0.0 => a.cast_signed().to_string(),
            (_, &[a]) => a.to_string(),
            (_, &[a, b]) if x < 0.0 => i16::from_le_bytes([a, b]).to_string(),
            (_, &[a, b]) => u16::from_le_bytes([a, b]).to_string(),
            (_, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]).to_string(),
            _ => x.to_string(),
        }
    }
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
    same: HashMap<Identity, usize>,
}

struct Written {
    main: Vec<u8>,
    files: Vec<External>,
    before: u64,
    after: u64,
}

impl Writing {
    fn new(asset: &Asset, fixed: &Fixed, changes: &[Change]) -> Writing {
        let changed: BTreeSet<(usize, usize)> =
            changes.iter().map(|change| (change.track.animation, change.track.sampler)).collect();
        let mut kept = fixed.accessors.clone();
        for (a, animation) in asset.root().animations.iter().enumerate() {
            for (s, sampler) in animation.samplers.iter().enumerate() {
                if !changed.contains(&(a, s)) {
                    kept.extend([sampler.input.value(), sampler.output.value()]);
                }
            }
        }
        let used = changes.iter().flat_map(|change| [change.track.input, change.track.output]);
        let home = changes.first().map_or(0, |change| buffer_of(asset, change.track.output));
        let mut writing = Writing {
            old: BTreeMap::new(),
            new: Vec::new(),
            samplers: Vec::new(),
            replaced: used.filter(|accessor| !kept.contains(accessor)).collect(),
            home,
            same: HashMap::new(),
        };
        let next = asset.root().accessors.len();
        for Change { track, found } in changes {
            let (kind, components) = match track.property {
                Property::Rotation => ("VEC4", 4),
                Property::Translation | Property::Scale => ("VEC3", 3),
                Property::MorphTargetWeights => ("SCALAR", 1),
            };
            let values = Content::new(kind, components, found.stored, &found.values);
            let input = writing.place(track.input, Content::times(&found.times), next);
            let output = writing.place(track.output, values, next);
            let (animation, sampler) = (track.animation, track.sampler);
            let interpolation = found.interpolation;
            writing.samplers.push(Sampler { animation, sampler, input, output, interpolation });
        }
        writing
    }

    /// The accessor of some content: the one that held the old, one that holds the same,
    /// or a new one.
    fn place(&mut self, slot: usize, content: Content, next: usize) -> usize {
        let key = content.identity();
        if self.replaced.contains(&slot) && !self.old.contains_key(&slot) {
            self.same.entry(key).or_insert(slot);
            self.old.insert(slot, content);
            return slot;
        }
        let new = next + self.new.len();
        let index = *self.same.entry(key).or_insert(new);
        if index == new {
            self.new.push(content);
        }
        index
    }

    fn finish(
        self,
        main: &[u8],
        asset: &mut Asset,
        fixed: &Fixed,
        uri: impl FnMut(&str) -> String,
    ) -> Result<Written, Error> {
        let next = asset.root().accessors.len();
        let mut buffers = Buffers::new(asset, fixed, &self.replaced, self.home);
        for (&slot, content) in &self.old {
            buffers.replace(slot, content.bytes.clone());
        }
        for (index, content) in (next..).zip(&self.new) {
            buffers.append(index, &content.bytes);
        }
        let settled = buffers.settle();
        let bytes = Bytes::new(asset, &settled, uri)?;
        let text = std::str::from_utf8(asset.json()).map_err(|_| wrong("the text"))?;
        let edits = Document { text, asset, settled: &settled, writing: &self, bytes: &bytes }.edits()?;
        let text = edits.apply(text).ok_or_else(|| wrong("/"))?;
        let before = main.len() as u64 + bytes.before;
        let main = contained(main, asset, &text, bytes.bin)?;
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
            let mut old = vec![0; asset.buffer_length(buffer)? as usize];
            asset.read_at(buffer, 0, &mut old)?;
            let (used, rest) = match asset.root().buffers.get(buffer) {
                Some(stored) => old.split_at(old.len().min(stored.byte_length.0 as usize)),
                None => (&old[..], &[][..]),
            };
            let (mut new, home) = settled.bytes(buffer, used).ok_or_else(|| wrong("/bufferViews"))?;
            all.home = all.home.or(home);
            let length = new.len() as u64;
            let stated = asset.root().buffers.get(buffer).and_then(|stored| stored.uri.as_deref());
            // Padding is made anew.
            if stated.is_some() || rest.len() > 3 {
                new.extend(rest);
            }
            let uri = match stated {
                None => {
                    all.bin = Some(new);
                    None
                }
                Some(data) if data.starts_with("data:") => Some(data_uri(data, &new)),
                Some(_) => {
                    all.before += old.len() as u64;
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
fn contained(main: &[u8], asset: &Asset, text: &str, bin: Option<Vec<u8>>) -> Result<Vec<u8>, Error> {
    let glb = match asset.container() {
        Container::Glb(glb) => glb,
        Container::Text { .. } => {
            let mark = if asset.json_form().byte_order_mark { 3 } else { 0 };
            let after = main.get(mark + asset.json().len()..).unwrap_or_default();
            return Ok([main.get(..mark).unwrap_or_default(), text.as_bytes(), after].concat());
        }
    };
    let mut json = text.trim_end().as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let bin = bin.map(|mut bin| {
        bin.resize(bin.len().next_multiple_of(4), 0);
        bin
    });
    let (mut chunks, mut is_first_bin) = (Vec::new(), true);
    for chunk in &glb.chunks {
        let data = match (chunk.kind, &bin) {
            (JSON, _) if chunks.is_empty() => &json[..],
            (BIN, Some(bin)) if is_first_bin => bin,
            _ => main.get(chunk.start as usize..(chunk.start + chunk.length) as usize).unwrap_or_default(),
        };
        is_first_bin &= chunk.kind != BIN;
        let length = u32::try_from(data.len()).map_err(|_| Error::TooLarge(data.len() as u64))?;
        chunks.extend(length.to_le_bytes());
        chunks.extend(chunk.kind);
        chunks.extend(data);
    }
    let rest = main.get(glb.end as usize..).unwrap_or_default();
    let counted = if glb.declared >= glb.length { rest.len() } else { 0 };
    let length = (12 + chunks.len() + counted) as u64;
    let word = u32::try_from(length).map_err(|_| Error::TooLarge(length))?;
    Ok([&MAGIC[..], &2u32.to_le_bytes(), &word.to_le_bytes(), &chunks, rest].concat())
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

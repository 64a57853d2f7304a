//! Where new data go in the buffers: in the place of the old where nothing else is there,
//! at the end of a buffer otherwise. What is not replaced keeps its bytes and, to a
//! multiple of four, its place.

use super::refs::Fixed;
use crate::asset::{Asset, Error, Layout};
use gltf::json::validation::Checked;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Some bytes of a buffer, and what takes their place.
#[derive(Clone, Debug)]
struct Patch {
    range: Range<u64>,
    bytes: Vec<u8>,
}

/// Where an accessor's data are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) view: usize,
    pub(super) offset: u64,
}

/// New data for the buffers of a file.
pub(super) struct Buffers<'a> {
    asset: &'a Asset,
    /// Patches by buffer and by where they begin; none overlaps another.
    patches: BTreeMap<usize, BTreeMap<u64, Patch>>,
    /// What must keep its bytes, by buffer: from where to where, none overlapping.
    live: BTreeMap<usize, BTreeMap<u64, u64>>,
    /// Where views begin and end, by buffer.
    bounds: BTreeMap<usize, BTreeSet<u64>>,
    /// Data at the end, each with its accessor.
    home: Vec<u8>,
    places: BTreeMap<usize, u64>,
    home_buffer: usize,
    fixed_views: &'a BTreeSet<usize>,
}

impl<'a> Buffers<'a> {
    /// `replaced` are the accessors whose data nothing needs any more. `home` is the
    /// buffer that takes what has no place.
    pub(super) fn new(
        asset: &'a Asset,
        fixed: &'a Fixed,
        replaced: &BTreeSet<usize>,
        home: usize,
    ) -> Buffers<'a> {
        let mut buffers = Buffers {
            asset,
            patches: BTreeMap::new(),
            live: BTreeMap::new(),
            bounds: BTreeMap::new(),
            home: Vec::new(),
            places: BTreeMap::new(),
            home_buffer: home,
            fixed_views: &fixed.views,
        };
        let root = asset.root();
        let kept = (0..root.accessors.len()).filter(|index| !replaced.contains(index));
        let mut live: Vec<(usize, Range<u64>)> = kept.filter_map(|index| buffers.range(index)).collect();
        let sparse = root.accessors.iter().filter_map(|accessor| accessor.sparse.as_ref());
        let sparse = sparse.flat_map(|s| [s.indices.buffer_view.value(), s.values.buffer_view.value()]);
        let opaque: BTreeSet<usize> = sparse.chain(fixed.views.iter().copied()).collect();
        live.extend(opaque.into_iter().filter_map(|view| buffers.view(view)));
        live.sort_by_key(|(buffer, range)| (*buffer, range.start));
        for (buffer, range) in live {
            let ranges = buffers.live.entry(buffer).or_default();
            match ranges.last_entry() {
                Some(mut last) if *last.get() >= range.start => {
                    let end = range.end.max(*last.get());
                    last.insert(end);
                }
                _ => drop(ranges.insert(range.start, range.end)),
            }
        }
        for view in 0..root.buffer_views.len() {
            let Some((buffer, range)) = buffers.view(view) else { continue };
            buffers.bounds.entry(buffer).or_default().extend([range.start, range.end]);
        }
        buffers
    }

    /// The buffer and the bytes of a view.
    fn view(&self, view: usize) -> Option<(usize, Range<u64>)> {
        let stored = self.asset.root().buffer_views.get(view)?;
        let start = stored.byte_offset.unwrap_or_default().0;
        Some((stored.buffer.value(), start..start.checked_add(stored.byte_length.0)?))
    }

    /// The buffer and the bytes of an accessor's elements, first to last.
    fn range(&self, accessor: usize) -> Option<(usize, Range<u64>)> {
        let stored = self.asset.root().accessors.get(accessor)?;
        let view = stored.buffer_view?.value();
        let (Checked::Valid(kind), Checked::Valid(component)) = (stored.type_, stored.component_type) else {
            // Of unknown length: the whole view.
            return self.view(view);
        };
        let (buffer, bytes) = self.view(view)?;
        let layout = Layout::new(kind, component.0);
        let stride = self.asset.root().buffer_views.get(view)?.byte_stride.map(|stride| stride.0 as u64);
        let stride = stride.filter(|&stride| stride > 0).unwrap_or(layout.stride());
        let start = bytes.start.checked_add(stored.byte_offset.unwrap_or_default().0)?;
        let length = u64::try_from(layout.span(stride, stored.count.0)).ok()?;
        Some((buffer, start..start.checked_add(length)?))
    }

    /// The bytes of an accessor, if nothing else lies there.
    fn free(&self, accessor: usize) -> Option<(usize, Range<u64>)> {
        let stored = self.asset.root().accessors.get(accessor)?;
        let (buffer, range) = self.range(accessor)?;
        let own = stored.buffer_view?.value();
        if stored.sparse.is_some() || self.fixed_views.contains(&own) {
            return None;
        }
        // The last that begins before the range ends is the one that could reach into it.
        let live = self.live.get(&buffer).and_then(|live| live.range(..range.end).next_back());
        let taken = self.patches.get(&buffer).and_then(|patches| patches.range(..range.end).next_back());
        let ends = [live.map(|(_, &end)| end), taken.map(|(_, patch)| patch.range.end)];
        let bounds = self.bounds.get(&buffer)?;
        let whole = range.start < range.end && bounds.range(range.start + 1..range.end).next().is_none();
        let free = whole && ends.into_iter().flatten().all(|end| end <= range.start);
        free.then_some((buffer, range))
    }

    /// Gives an accessor that is replaced new data: aligned to 4 bytes, as they must be
    /// for float32.
    pub(super) fn replace(&mut self, accessor: usize, bytes: Vec<u8>) {
        let strided = self.asset.root().accessors.get(accessor).and_then(|stored| stored.buffer_view);
        let strided =
            strided.and_then(|view| self.asset.root().get(view)).is_some_and(|v| v.byte_stride.is_some());
        let Some((buffer, range)) = self.free(accessor) else {
            return self.append(accessor, &bytes);
        };
        let old = range.end - range.start;
        let patch = if strided || range.start % 4 != 0 {
            self.append(accessor, &bytes);
            // Something stays, for no view is empty.
            let left = if old % 4 == 0 { 4 } else { old % 4 };
            vec![0; left as usize]
        } else {
            let mut bytes = bytes;
            while bytes.len() as u64 % 4 != old % 4 {
                bytes.push(0);
            }
            bytes
        };
        self.patches.entry(buffer).or_default().insert(range.start, Patch { range, bytes: patch });
    }

    /// Puts the data of an accessor, which may be a new one, at the end of a buffer.
    pub(super) fn append(&mut self, accessor: usize, bytes: &[u8]) {
        self.home.resize(self.home.len().next_multiple_of(4), 0);
        self.places.insert(accessor, self.home.len() as u64);
        self.home.extend(bytes);
    }

    /// All places and bytes, once all data are known.
    pub(super) fn settle(self) -> Settled {
        let shifts = self.shifts();
        let root = self.asset.root();
        let home_view = root.buffer_views.len();
        let mut settled = Settled {
            patches: BTreeMap::new(),
            accessors: BTreeMap::new(),
            views: BTreeMap::new(),
            home: None,
        };
        for (index, stored) in root.accessors.iter().enumerate() {
            let Some(view) = stored.buffer_view.map(|view| view.value()) else { continue };
            let Some((buffer, bytes)) = self.view(view) else { continue };
            let offset = stored.byte_offset.unwrap_or_default().0;
            let at = shifts.moved(buffer, bytes.start.saturating_add(offset));
            let offset = at.saturating_sub(shifts.moved(buffer, bytes.start));
            settled.accessors.insert(index, Place { view, offset });
        }
        let home = self.places.iter().map(|(&index, &offset)| (index, Place { view: home_view, offset }));
        settled.accessors.extend(home);
        for view in 0..home_view {
            if let Some((buffer, bytes)) = self.view(view) {
                let moved = shifts.moved(buffer, bytes.start)..shifts.moved(buffer, bytes.end);
                settled.views.insert(view, moved);
            }
        }
        if !self.home.is_empty() {
            settled.home = Some((self.home_buffer, self.home));
        }
        settled.patches = self.patches;
        settled
    }

    fn shifts(&self) -> Shifts {
        let sums = |patches: &BTreeMap<u64, Patch>| {
            let mut sum = 0;
            let shift = |patch: &Patch| {
                sum += patch.bytes.len() as i64 - (patch.range.end - patch.range.start) as i64;
                (patch.range.end, sum)
            };
            patches.values().map(shift).collect()
        };
        Shifts(self.patches.iter().map(|(&buffer, patches)| (buffer, sums(patches))).collect())
    }
}

/// By buffer: the ends of patches, and how far what follows them moves.
struct Shifts(BTreeMap<usize, Vec<(u64, i64)>>);

impl Shifts {
    /// Where a byte goes that is in no patch, or the first of one.
    fn moved(&self, buffer: usize, at: u64) -> u64 {
        let Some(shifts) = self.0.get(&buffer) else { return at };
        let before = shifts.partition_point(|(end, _)| *end <= at);
        let shift = before.checked_sub(1).map_or(0, |last| shifts[last].1);
        at.saturating_add_signed(shift)
    }
}

/// A buffer's new bytes, and the view at its end, if it has it.
pub(super) type Rebuilt = (Vec<u8>, Option<NewView>);

/// Room for what stands around a buffer's changed bytes, mostly.
const SPARE: usize = 1 << 18;

/// Where everything is, and the bytes to make it so.
pub(super) struct Settled {
    patches: BTreeMap<usize, BTreeMap<u64, Patch>>,
    /// Places of all accessors with data, new ones included.
    pub(super) accessors: BTreeMap<usize, Place>,
    /// The bytes of all views within their buffers, old ones only.
    pub(super) views: BTreeMap<usize, Range<u64>>,
    /// The buffer with a view more at its end, and the bytes there.
    home: Option<(usize, Vec<u8>)>,
}

/// A view more.
#[derive(Clone, Copy, Debug)]
pub(super) struct NewView {
    pub(super) buffer: usize,
    pub(super) offset: u64,
    pub(super) length: u64,
}

impl Settled {
    /// The buffers that change.
    pub(super) fn buffers(&self) -> BTreeSet<usize> {
        self.patches.keys().copied().chain(self.home.iter().map(|home| home.0)).collect()
    }

    /// A buffer's new bytes, and the view at its end, if it has it. Of its `length` bytes
    /// `read` appends some; none where a patch lies beyond them.
    pub(super) fn bytes(
        &self,
        buffer: usize,
        length: u64,
        read: &mut impl FnMut(Range<u64>, &mut Vec<u8>) -> Result<(), Error>,
    ) -> Result<Option<Rebuilt>, Error> {
        let patched = |patches: &BTreeMap<u64, Patch>| patches.values().map(|patch| patch.bytes.len()).sum();
        let patched: usize = self.patches.get(&buffer).map_or(0, patched);
        let home = self.home.as_ref().map_or(0, |home| home.1.len());
        let (mut new, mut at) = (Vec::with_capacity(patched + home + SPARE), 0);
        for patch in self.patches.get(&buffer).into_iter().flat_map(BTreeMap::values) {
            if patch.range.start < at || patch.range.end > length {
                return Ok(None);
            }
            read(at..patch.range.start, &mut new)?;
            new.extend_from_slice(&patch.bytes);
            at = patch.range.end;
        }
        read(at..length, &mut new)?;
        let Some((_, home)) = self.home.as_ref().filter(|home| home.0 == buffer) else {
            return Ok(Some((new, None)));
        };
        new.resize(new.len().next_multiple_of(4), 0);
        let view = NewView { buffer, offset: new.len() as u64, length: home.len() as u64 };
        new.extend_from_slice(home);
        Ok(Some((new, Some(view))))
    }
}

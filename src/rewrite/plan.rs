//! Which tracks change: those that take fewer bytes, and one at least that lasts as long
//! as its clip.

use super::found::Found;
use super::refs::Fixed;
use super::track::Sampler;
use crate::asset::Asset;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// A sampler and its new keys.
#[derive(Clone, Debug)]
pub(super) struct Change {
    pub(super) sampler: Sampler,
    pub(super) found: Found,
}

/// About what one more accessor takes in the JSON.
const ACCESSOR: i64 = 128;

/// The changes that are worth it.
pub(super) fn changes(asset: &mut Asset, fixed: &Fixed, all: Vec<Change>) -> Vec<Change> {
    let mut changes = worthwhile(asset, fixed, all);
    keep_durations(asset, &mut changes);
    changes.retain(|change| change.found.times.len() < change.sampler.keys);
    changes
}

/// The changes that save bytes: each by itself, its old times staying where others use
/// them, and then all others of the same times together if these can go.
fn worthwhile(asset: &Asset, fixed: &Fixed, all: Vec<Change>) -> Vec<Change> {
    let mut users: BTreeMap<usize, usize> = BTreeMap::new();
    for sampler in asset.root().animations.iter().flat_map(|animation| &animation.samplers) {
        *users.entry(sampler.input.value()).or_default() += 1;
    }
    let mut groups: BTreeMap<usize, Vec<Change>> = BTreeMap::new();
    for change in all {
        groups.entry(change.sampler.input).or_default().push(change);
    }
    let mut written = HashSet::new();
    let mut chosen = Vec::new();
    for (input, group) in groups {
        let alone = users.get(&input) == Some(&group.len()) && !fixed.accessors.contains(&input);
        let mut rest = Vec::new();
        for change in group {
            let times = bits(&change);
            if saved(&change, fixed, written.contains(&times)) > 0 {
                written.insert(times);
                chosen.push(change);
            } else {
                rest.push(change);
            }
        }
        let mut new = HashSet::new();
        let times = rest.first().map_or(0, |change| 4 * change.sampler.keys as i64 + ACCESSOR);
        let mut shared = |times: Vec<u32>| written.contains(&times) || !new.insert(times);
        let total: i64 = rest.iter().map(|change| saved(change, fixed, shared(bits(change)))).sum();
        if alone && total + times > 0 {
            written.extend(new);
            chosen.extend(rest);
        }
    }
    chosen.sort_by_key(|change| (change.sampler.animation, change.sampler.sampler));
    chosen
}

/// New times, told apart by their bits.
fn bits(change: &Change) -> Vec<u32> {
    change.found.times.iter().map(|time| time.to_bits()).collect()
}

/// Bytes that a change saves if the old times stay; `shared` are new times that are
/// written already.
fn saved(change: &Change, fixed: &Fixed, shared: bool) -> i64 {
    let Change { sampler, found } = change;
    let bytes = |numbers: usize, size: usize| (numbers * size) as i64;
    let old = if fixed.accessors.contains(&sampler.output) { 0 } else { sampler.bytes as i64 };
    let times = if shared { 0 } else { bytes(found.times.len(), 4) + ACCESSOR };
    old - bytes(found.values.len(), found.stored.component.size()) - times
}

/// Lets a held value last to its clip's end where nothing else does.
fn keep_durations(asset: &mut Asset, changes: &mut [Change]) {
    for clip in asset.clips() {
        let changed: BTreeSet<usize> = changes
            .iter()
            .filter(|change| change.sampler.animation == clip.animation)
            .map(|change| change.sampler.sampler)
            .collect();
        let end = clip.duration;
        let mut others = clip.channels.iter().filter(|channel| !changed.contains(&channel.sampler));
        let lasts = |time: Option<&f32>| time.is_some_and(|&time| f64::from(time) >= end);
        let kept = others.any(|channel| {
            let last = asset.floats(channel.input, channel.keys - 1..channel.keys);
            last.is_ok_and(|last| lasts(last.first()))
        });
        let mut mine: Vec<&mut Change> =
            changes.iter_mut().filter(|change| change.sampler.animation == clip.animation).collect();
        if kept || mine.iter().any(|change| lasts(change.found.times.last())) {
            continue;
        }
        mine.retain(|change| lasts(Some(&change.sampler.last)));
        let smallest = mine.into_iter().min_by_key(|change| change.found.values.len());
        if let Some(change) = smallest {
            change.found = change.found.clone().until(end as f32);
        }
    }
}

//! Which tracks change: those that take fewer bytes, and one at least that lasts as long
//! as its clip.

use super::keys::Found;
use super::refs::Fixed;
use super::track::Track;
use crate::asset::Asset;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// A track and its new keys.
#[derive(Clone, Debug)]
pub(super) struct Change {
    pub(super) track: Track,
    pub(super) found: Found,
}

/// About what one more accessor takes in the JSON.
const ACCESSOR: i64 = 128;

/// The changes that are worth it.
pub(super) fn changes(
    asset: &mut Asset,
    fixed: &Fixed,
    tracks: Vec<Track>,
    found: Vec<Option<Found>>,
) -> Vec<Change> {
    let pairs = tracks.into_iter().zip(found);
    let all: Vec<Change> = pairs.filter_map(|(track, found)| Some(Change { track, found: found? })).collect();
    let mut changes = worthwhile(asset, fixed, all);
    keep_durations(asset, &mut changes);
    changes.retain(|change| change.found.times.len() < change.track.times.len());
    changes
}

/// Times are counted once where they are shared.
fn worthwhile(asset: &Asset, fixed: &Fixed, all: Vec<Change>) -> Vec<Change> {
    let mut users: BTreeMap<usize, i64> = BTreeMap::new();
    for sampler in asset.root().animations.iter().flat_map(|animation| &animation.samplers) {
        *users.entry(sampler.input.value()).or_default() += 1;
    }
    for change in &all {
        *users.entry(change.track.input).or_default() -= 1;
    }
    let mut slots = HashSet::new();
    let mut written = HashSet::new();
    let worth = |change: &Change| {
        let Change { track, found } = change;
        let bytes = |numbers: usize, size: usize| (numbers * size) as i64;
        let old = bytes(track.values.len(), track.stored.component.size());
        let new = bytes(found.values.len(), found.stored.component.size());
        let times = found.times.iter().map(|time| time.to_bits()).collect::<Vec<u32>>();
        let gone = users.get(&track.input) == Some(&0) && !fixed.accessors.contains(&track.input);
        let slot = gone && !slots.contains(&track.input);
        let cost = match (slot, written.contains(&times)) {
            (true, _) => bytes(times.len(), 4) - bytes(track.times.len(), 4),
            (false, true) => 0,
            (false, false) => bytes(times.len(), 4) + ACCESSOR,
        };
        let kept = if fixed.accessors.contains(&track.output) { old } else { 0 };
        let worth = new + cost + kept < old;
        if worth {
            slots.insert(track.input);
            written.insert(times);
        }
        worth
    };
    let mut worth = worth;
    all.into_iter().filter(|change| worth(change)).collect()
}

/// Lets a held value last to its clip's end where nothing else does.
fn keep_durations(asset: &mut Asset, changes: &mut [Change]) {
    for clip in asset.clips() {
        let changed: BTreeSet<usize> = changes
            .iter()
            .filter(|change| change.track.animation == clip.animation)
            .map(|change| change.track.sampler)
            .collect();
        let end = clip.duration;
        let mut others = clip.channels.iter().filter(|channel| !changed.contains(&channel.sampler));
        let lasts = |time: Option<&f32>| time.is_some_and(|&time| f64::from(time) >= end);
        let kept = others.any(|channel| {
            let last = asset.floats(channel.input, channel.keys - 1..channel.keys);
            last.is_ok_and(|last| lasts(last.first()))
        });
        let mut mine: Vec<&mut Change> =
            changes.iter_mut().filter(|change| change.track.animation == clip.animation).collect();
        if kept || mine.iter().any(|change| lasts(change.found.times.last())) {
            continue;
        }
        mine.retain(|change| lasts(change.track.times.last()));
        let smallest = mine.into_iter().min_by_key(|change| change.found.values.len());
        if let Some(change) = smallest {
            change.found = change.found.clone().until(end as f32);
        }
    }
}

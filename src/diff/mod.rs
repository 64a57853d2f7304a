//! How differently two glTF files move.
//!
//! [`files`] matches the clips and nodes of any two files by name, plays both as the
//! specification says, and finds the largest differences: of each node relative to its
//! parent and in the world, with their times. A shorter clip holds its last pose while
//! the longer one goes on.
//!
//! What is found is attained: the files do differ by that much at that time. It is the
//! largest of all where both move along straight lines or in steps, as the difference of
//! two lines is largest at an end. Elsewhere every interval between neighbouring keys of
//! either file is looked at in five places, and the most promising peaks between them are
//! sought out; between two of those places, h seconds apart, two slerps can be off by at
//! most h/2 · (|ω₂ − ω₁| + |ω₁| · φ) more, where ω are their angular velocities and φ the
//! largest angle there.

mod matching;
mod measure;
mod reel;
mod report;
mod rig;
mod stale;
mod sweep;
#[cfg(test)]
mod tests;

pub use matching::By;
pub use measure::Measure;
pub use report::{Found, Limits};
pub use stale::{Stale, stale};
pub use sweep::Which;

use crate::asset::play::{Channel, Clip, Property};
use crate::asset::{self, Asset};
use gltf::json::validation::Checked;
use matching::{Map, Pair};
use rig::Rig;
use serde::Serialize;
use std::collections::HashSet;
use sweep::{Side, Worst, sweep};

/// How differently two files move.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
#[non_exhaustive]
pub struct Diff {
    /// The clips that both have, in the first file's order; where there is none, what
    /// they show at rest.
    pub clips: Vec<ClipDiff>,
    /// What the second file lacks.
    pub only_in_a: Alone,
    /// What the first file lacks.
    pub only_in_b: Alone,
    /// What belongs together though no name says so.
    pub matched_otherwise: Vec<Matched>,
    /// Channels that only an extension can play, and so were not compared.
    pub not_compared: Vec<String>,
    /// Whether both files have clips, and none of them belongs to one of the other's.
    #[serde(skip)]
    clips_in_vain: bool,
}

/// Something of both files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Both<T> {
    /// In the first file.
    pub a: T,
    /// In the second file.
    pub b: T,
}

/// How differently a clip moves.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
#[non_exhaustive]
pub struct ClipDiff {
    /// Its names; None where it has none, or the files were compared at rest.
    pub clip: Both<Option<String>>,
    /// Its index among the animations; None where the files were compared at rest.
    pub animation: Option<Both<usize>>,
    /// How long it is, seconds.
    pub seconds: Both<f64>,
    /// The nodes that both files have, in the first file's order.
    pub nodes: Vec<NodeDiff>,
}

/// How differently a node moves in a clip.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
#[non_exhaustive]
pub struct NodeDiff {
    /// Its names, or its numbers where it has none.
    pub node: Both<String>,
    /// Its index among the nodes.
    pub index: Both<usize>,
    /// The largest differences; none where it does not differ.
    pub differences: Vec<Difference>,
}

/// The largest difference of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// What differs.
    pub measure: Measure,
    /// By how much, in the measure's unit.
    pub off: f64,
    /// When, seconds.
    pub time: f64,
}

/// What only one of two files has.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Alone {
    /// Names of clips.
    pub clips: Vec<String>,
    /// Names of nodes, or their numbers.
    pub nodes: Vec<String>,
    /// Channels of nodes and clips that both have.
    pub channels: Vec<AloneChannel>,
}

/// A channel that the other file does not have; there the property rests.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct AloneChannel {
    /// Name of the clip.
    pub clip: String,
    /// Name of the node.
    pub node: String,
    /// `rotation`, `translation`, `scale` or `weights`.
    pub property: &'static str,
}

/// Two things that belong together though no name says so.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Matched {
    /// `clip` or `node`.
    pub kind: &'static str,
    /// Their names, or their numbers.
    #[serde(flatten)]
    pub names: Both<String>,
    /// How they found each other.
    pub by: By,
}

/// Why two files were not compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// One of them cannot be played.
    #[error("{error}")]
    Asset {
        /// Which of them.
        which: Which,
        /// What is wrong with it.
        error: asset::Error,
    },
    /// A name that was to stand for another is in neither clips nor nodes.
    #[error("expected a clip or a node named `{name}`, found none")]
    Name {
        /// Which file should have it.
        which: Which,
        /// The name.
        name: String,
    },
}

/// Compares two files. `map` holds names of clips and nodes of the first file, each with
/// the name of what it should be matched with in the second.
pub fn files(a: &mut Asset, b: &mut Asset, map: &[(String, String)]) -> Result<Diff, Error> {
    let (a_file, b_file) = (File::new(a, Which::A)?, File::new(b, Which::B)?);
    for (old, new) in map {
        a_file.expect(old, Which::A)?;
        b_file.expect(new, Which::B)?;
    }
    let map = Map::new(map);
    let nodes = matching::nodes(&a_file.rig, &b_file.rig, &map);
    let clips = matching::clips(&a_file.names(), &b_file.names(), &map);
    let mut diff = Diff {
        clips: Vec::new(),
        only_in_a: a_file.alone(&nodes, &clips, |pair| pair.a),
        only_in_b: b_file.alone(&nodes, &clips, |pair| pair.b),
        matched_otherwise: otherwise(&a_file, &b_file, &nodes, &clips),
        not_compared: Vec::new(),
        clips_in_vain: clips.is_empty() && !(a_file.clips.is_empty() || b_file.clips.is_empty()),
    };
    for (file, name) in [(&a_file, "the first file"), (&b_file, "the second file")] {
        diff.not_compared.extend(file.skipped.iter().map(|pointer| format!("{pointer} of {name}")));
    }
    for pair in &clips {
        let of = (&a_file.clips[pair.a], &b_file.clips[pair.b]);
        note_channels(&mut diff, (&a_file, &b_file), of, &nodes);
        diff.clips.push(compare((&mut *a, &a_file, Some(of.0)), (&mut *b, &b_file, Some(of.1)), &nodes)?);
    }
    if clips.is_empty() {
        diff.clips.push(compare((a, &a_file, None), (b, &b_file, None), &nodes)?);
    }
    Ok(diff)
}

/// What is known of a file before it is played.
struct File {
    rig: Rig,
    clips: Vec<Clip>,
    /// Pointers to channels that only an extension can play.
    skipped: Vec<String>,
}

impl File {
    fn new(asset: &mut Asset, which: Which) -> Result<File, Error> {
        let clips = asset.clips();
        let mut skipped = Vec::new();
        let failed = |error| Error::Asset { which, error };
        for clip in &clips {
            unplayed(asset, clip, &mut skipped).map_err(failed)?;
        }
        Ok(File { rig: Rig::of(asset).map_err(failed)?, clips, skipped })
    }

    fn names(&self) -> Vec<Option<String>> {
        self.clips.iter().map(|clip| clip.name.clone()).collect()
    }

    fn expect(&self, name: &str, which: Which) -> Result<(), Error> {
        let clips = self.clips.iter().map(|clip| &clip.name);
        let mut names = clips.chain(self.rig.joints.iter().map(|joint| &joint.name)).flatten();
        match names.any(|known| known == name) {
            true => Ok(()),
            false => Err(Error::Name { which, name: name.to_owned() }),
        }
    }

    /// What is in none of the pairs.
    fn alone(&self, nodes: &[Pair], clips: &[Pair], of: fn(&Pair) -> usize) -> Alone {
        let taken = |pairs: &[Pair]| pairs.iter().map(of).collect::<HashSet<usize>>();
        let (nodes, clips) = (taken(nodes), taken(clips));
        let free = (0..self.rig.joints.len()).filter(|node| !nodes.contains(node));
        Alone {
            clips: self.clips.iter().filter(|clip| !clips.contains(&clip.animation)).map(clip_name).collect(),
            nodes: free.map(|node| self.rig.name(node)).collect(),
            channels: Vec::new(),
        }
    }
}

/// Channels that were left out of a clip: those that an extension plays are noted, others
/// are errors, for without them the clip would not be what its viewers see.
fn unplayed(asset: &mut Asset, clip: &Clip, skipped: &mut Vec<String>) -> Result<(), asset::Error> {
    let played: HashSet<usize> = clip.channels.iter().map(|channel| channel.index).collect();
    let count = asset.root().animations[clip.animation].channels.len();
    for index in (0..count).filter(|index| !played.contains(index)) {
        let target = &asset.root().animations[clip.animation].channels[index].target;
        let of_extension = target.node.value() == u32::MAX as usize || target.path == Checked::Invalid;
        if of_extension {
            skipped.push(format!("/animations/{}/channels/{index}", clip.animation));
        } else {
            asset.channel(clip.animation, index)?;
        }
    }
    Ok(())
}

/// A clip's name, or its number.
fn clip_name(clip: &Clip) -> String {
    clip.name.clone().unwrap_or_else(|| format!("animation {}", clip.animation))
}

fn otherwise(a: &File, b: &File, nodes: &[Pair], clips: &[Pair]) -> Vec<Matched> {
    let clips = clips.iter().filter_map(|pair| {
        let names = Both { a: clip_name(&a.clips[pair.a]), b: clip_name(&b.clips[pair.b]) };
        Some(Matched { kind: "clip", names, by: pair.by? })
    });
    let nodes = nodes.iter().filter_map(|pair| {
        let names = Both { a: a.rig.name(pair.a), b: b.rig.name(pair.b) };
        Some(Matched { kind: "node", names, by: pair.by? })
    });
    clips.chain(nodes).collect()
}

/// Notes what moves in one of two clips and rests in the other.
fn note_channels(diff: &mut Diff, (a, b): (&File, &File), clips: (&Clip, &Clip), nodes: &[Pair]) {
    let moved = |clip: &Clip| -> HashSet<(usize, &'static str)> {
        clip.channels.iter().map(|channel| (channel.node, property(channel))).collect()
    };
    let (in_a, in_b) = (moved(clips.0), moved(clips.1));
    let note = |alone: bool, found: &mut Vec<AloneChannel>, clip: &Clip, node: String, property| {
        if alone {
            found.push(AloneChannel { clip: clip_name(clip), node, property });
        }
    };
    for pair in nodes {
        for property in ["rotation", "translation", "scale", "weights"] {
            let (of_a, of_b) = (in_a.contains(&(pair.a, property)), in_b.contains(&(pair.b, property)));
            note(of_a && !of_b, &mut diff.only_in_a.channels, clips.0, a.rig.name(pair.a), property);
            note(of_b && !of_a, &mut diff.only_in_b.channels, clips.1, b.rig.name(pair.b), property);
        }
    }
}

fn property(channel: &Channel) -> &'static str {
    match channel.property {
        Property::Rotation => "rotation",
        Property::Translation => "translation",
        Property::Scale => "scale",
        Property::MorphTargetWeights => "weights",
    }
}

/// One file in a comparison: itself, what is known of it, its clip.
type Player<'a> = (&'a mut Asset, &'a File, Option<&'a Clip>);

fn compare(a: Player, b: Player, nodes: &[Pair]) -> Result<ClipDiff, Error> {
    let ((a, a_file, a_clip), (b, b_file, b_clip)) = (a, b);
    let pairs: Vec<(usize, usize)> = nodes.iter().map(|pair| (pair.a, pair.b)).collect();
    let sides = (Side::new(&a_file.rig, a_clip), Side::new(&b_file.rig, b_clip));
    let found = sweep((a, sides.0), (b, sides.1), &pairs);
    let found = found.map_err(|(which, error)| Error::Asset { which, error })?;
    let seconds = |clip: Option<&Clip>| clip.map_or(0.0, |clip| clip.duration);
    let nodes = nodes.iter().zip(found).map(|(pair, worst)| NodeDiff {
        node: Both { a: a_file.rig.name(pair.a), b: b_file.rig.name(pair.b) },
        index: Both { a: pair.a, b: pair.b },
        differences: differences(worst),
    });
    Ok(ClipDiff {
        clip: Both {
            a: a_clip.and_then(|clip| clip.name.clone()),
            b: b_clip.and_then(|clip| clip.name.clone()),
        },
        animation: a_clip.zip(b_clip).map(|(a, b)| Both { a: a.animation, b: b.animation }),
        seconds: Both { a: seconds(a_clip), b: seconds(b_clip) },
        nodes: nodes.collect(),
    })
}

fn differences(worst: measure::ByMeasure<Worst>) -> Vec<Difference> {
    let all = Measure::ALL.iter().zip(worst);
    all.filter(|(_, worst)| worst.off > 0.0)
        .map(|(&measure, worst)| Difference { measure, off: measure.of_gauge(worst.off), time: worst.time })
        .collect()
}

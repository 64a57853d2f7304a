//! What to say of two files: findings where limits are set, and lines for people.

use super::{Alone, Both, ClipDiff, Diff, Difference, Measure, NodeDiff};
use crate::check::{Code, Report};

/// What two files may differ by; without a limit a difference is told, not judged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Of rotations, local and in the world, degrees.
    pub degrees: Option<f64>,
    /// Of places, local and in the world, units.
    pub units: Option<f64>,
    /// Of scales.
    pub scale: Option<f64>,
    /// Of morph weights.
    pub weight: Option<f64>,
}

impl Limits {
    /// The limit of a measure.
    pub fn of(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::LocalRotation | Measure::WorldRotation => self.degrees,
            Measure::LocalTranslation | Measure::WorldTranslation => self.units,
            Measure::LocalScale => self.scale,
            Measure::Weights => self.weight,
        }
    }
}

/// A difference, and of what.
#[derive(Clone, Copy, Debug)]
pub struct Found<'a> {
    /// The clip.
    pub clip: &'a ClipDiff,
    /// The node.
    pub node: &'a NodeDiff,
    /// By how much, and when.
    pub difference: Difference,
}

impl ClipDiff {
    /// The clip in words.
    pub fn title(&self) -> String {
        let Some(animation) = self.animation else { return "at rest".to_owned() };
        let name = |name: &Option<String>, index: usize| match name {
            Some(name) => name.clone(),
            None => format!("animation {index}"),
        };
        let (a, b) = (name(&self.clip.a, animation.a), name(&self.clip.b, animation.b));
        format!("clip {}", both(&a, &b))
    }

    /// The node that differs most by a measure.
    pub fn largest(&self, measure: Measure) -> Option<Found<'_>> {
        let of_it = |node: &NodeDiff| node.differences.iter().copied().find(|d| d.measure == measure);
        let found = self
            .nodes
            .iter()
            .filter_map(|node| of_it(node).map(|difference| Found { clip: self, node, difference }));
        found.reduce(|a, b| if b.difference.off > a.difference.off { b } else { a })
    }
}

/// Two names as one where they are the same.
fn both(a: &str, b: &str) -> String {
    if a == b { a.to_owned() } else { format!("{a} ({b} in the second)") }
}

impl Diff {
    /// The largest difference of all clips and nodes by a measure.
    pub fn largest(&self, measure: Measure) -> Option<Found<'_>> {
        let found = self.clips.iter().filter_map(|clip| clip.largest(measure));
        found.reduce(|a, b| if b.difference.off > a.difference.off { b } else { a })
    }

    /// The difference most worth a picture: what exceeds its limit by the largest
    /// factor; where nothing has a limit, the largest turn in the world, else the largest
    /// way, else anything.
    pub fn most_telling(&self, limits: &Limits) -> Option<Found<'_>> {
        use Measure::*;
        let order = [WorldRotation, WorldTranslation, LocalRotation, LocalTranslation, LocalScale, Weights];
        let found: Vec<Found> = order.iter().filter_map(|&measure| self.largest(measure)).collect();
        let share = |found: &Found| {
            let limit = limits.of(found.difference.measure)?;
            Some(found.difference.off / limit.max(f64::MIN_POSITIVE))
        };
        let judged = found.iter().filter_map(|found| Some((share(found)?, *found)));
        let worst = judged.reduce(|a, b| if b.0 > a.0 { b } else { a });
        worst.map(|(_, found)| found).or(found.first().copied())
    }

    /// What is amiss, as findings about the second file.
    pub fn report(&self, limits: &Limits) -> Report {
        let mut report = Report::default();
        if self.clips.iter().all(|clip| clip.nodes.is_empty()) {
            let message = "no node of one file belongs to a node of the other: expected names that both \
                           have; --map OLD=NEW says what belongs together";
            report.add(Code::NothingInCommon, "/nodes", message);
        }
        if self.clips_in_vain {
            let message = format!(
                "no clip belongs to a clip of the other file, so only the poses at rest were compared: the \
                 first file has {}, this one {}; --map OLD=NEW says what belongs together",
                self.only_in_a.clips.join(", "),
                self.only_in_b.clips.join(", ")
            );
            report.add(Code::NothingInCommon, "/animations", message);
        }
        self.clips.iter().for_each(|clip| judge(clip, limits, &mut report));
        note_alone(&self.only_in_a, "the first file", &mut report);
        note_alone(&self.only_in_b, "the second file", &mut report);
        for matched in &self.matched_otherwise {
            let Both { a, b } = &matched.names;
            let message = format!("{} {} was matched {}", matched.kind, both(a, b), matched.by.words());
            let place = if matched.kind == "clip" { "/animations" } else { "/nodes" };
            report.add(Code::MatchedOtherwise, place, message);
        }
        for place in &self.not_compared {
            let message = format!("{place}: no glTF node and property, so only an extension can play it");
            report.add(Code::NotCompared, "/animations", message);
        }
        report
    }

    /// The differences for people, without the findings.
    pub fn text(&self) -> String {
        let mut lines = String::new();
        for clip in &self.clips {
            let differ = clip.nodes.iter().filter(|node| !node.differences.is_empty()).count();
            let nodes = match clip.nodes.len() {
                1 => "1 node".to_owned(),
                n => format!("{n} nodes"),
            };
            lines += &format!("{}{}: {nodes} compared, {differ} differ\n", clip.title(), lengths(clip));
            for found in Measure::ALL.iter().filter_map(|&measure| clip.largest(measure)) {
                lines += &line(&found);
            }
        }
        lines
    }
}

/// How long a clip is, where it moves.
fn lengths(clip: &ClipDiff) -> String {
    let Both { a, b } = clip.seconds;
    match clip.animation {
        None => String::new(),
        // Times are float32 in the file: more digits would be noise.
        Some(_) if a == b => format!(" ({} s)", a as f32),
        Some(_) => format!(" ({} s, in the second {} s)", a as f32, b as f32),
    }
}

/// One line: how much, where and when.
fn line(found: &Found) -> String {
    let Difference { measure, off, time } = found.difference;
    let (words, unit) = (measure.words(), measure.unit());
    let node = both(&found.node.node.a, &found.node.node.b);
    let when = if found.clip.animation.is_some() { format!(" at {time:.6} s") } else { String::new() };
    format!("  {words:<18}{:>12}{unit:<6} {node}{when}\n", amount(off))
}

/// A number for people: tiny ones by their order.
fn amount(off: f64) -> String {
    if (1e-3..1e9).contains(&off) { format!("{off:.6}") } else { format!("{off:.2e}") }
}

fn judge(clip: &ClipDiff, limits: &Limits, report: &mut Report) {
    let place =
        clip.animation.map_or("/nodes".to_owned(), |animation| format!("/animations/{}", animation.b));
    let exceeds =
        |difference: &Difference| limits.of(difference.measure).is_some_and(|limit| difference.off > limit);
    for found in Measure::ALL.iter().filter_map(|&measure| clip.largest(measure)) {
        let Difference { measure, off, time } = found.difference;
        let Some(limit) = limits.of(measure).filter(|_| exceeds(&found.difference)) else { continue };
        let of_it = |node: &&NodeDiff| node.differences.iter().any(|d| d.measure == measure && exceeds(d));
        let others = match clip.nodes.iter().filter(of_it).count() - 1 {
            0 => String::new(),
            1 => "; 1 more node exceeds it".to_owned(),
            n => format!("; {n} more nodes exceed it"),
        };
        let (words, unit) = (measure.words(), measure.unit());
        let node = both(&found.node.node.a, &found.node.node.b);
        let when = if clip.animation.is_some() { format!(", at {time:.6} s") } else { String::new() };
        let message = format!(
            "{}: {words} of node {node} differs by {}{unit}{when}; at most {limit}{unit} is allowed{others}",
            clip.title(),
            amount(off),
        );
        report.add(Code::DifferenceLimit, place.clone(), message);
    }
    if clip.seconds.a != clip.seconds.b {
        let Both { a, b } = clip.seconds;
        let message = format!(
            "{} lasts {} s in the first file and {} s in the second; the shorter one holds its last pose",
            clip.title(),
            a as f32,
            b as f32
        );
        report.add(Code::LengthDiffers, place, message);
    }
}

fn note_alone(alone: &Alone, file: &str, report: &mut Report) {
    for clip in &alone.clips {
        report.add(Code::OnlyInOne, "/animations", format!("only {file} has the clip {clip}"));
    }
    for node in &alone.nodes {
        report.add(Code::OnlyInOne, "/nodes", format!("only {file} has the node {node}"));
    }
    for channel in &alone.channels {
        let super::AloneChannel { clip, node, property } = channel;
        let message = format!("clip {clip}: only {file} has a channel for the {property} of {node}");
        report.add(Code::OnlyInOne, "/animations", message);
    }
}

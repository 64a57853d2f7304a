//! The passes over binary data: every accessor once, several at a time.
//!
//! Reading takes turns (there is one file), judging runs in parallel.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, PoisonError};

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;
use rayon::prelude::*;

use super::{Code, Report, Severity, buffers, rotations, times, values};
use crate::asset::play::{Block, Channel, Keys, Property};
use crate::asset::{Asset, Error};

/// An asset that several threads read by turns.
pub(super) struct Shared<'a>(Mutex<&'a mut Asset>);

/// Numbers read at once: few enough to stay in a core's cache.
const NUMBERS: usize = 1 << 16;

impl<'a> Shared<'a> {
    /// The asset, for one read.
    pub(super) fn asset(&self) -> MutexGuard<'_, &'a mut Asset> {
        // Whoever panicked while reading left nothing half done.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All numbers of an accessor, a block at a time, each with the number of
    /// its first element; `raw` leaves normalised integers as they are.
    pub(super) fn blocks(
        &self,
        accessor: usize,
        raw: bool,
        mut block: impl FnMut(usize, &[f32]),
    ) -> Result<(), Error> {
        let mut shape = self.asset().shape(accessor)?;
        shape.normalized &= !raw;
        let at_once = (NUMBERS / shape.components).max(1);
        let (mut first, mut numbers) = (0, Vec::new());
        while first < shape.count {
            let last = shape.count.min(first + at_once);
            self.asset().floats_into(&shape, first..last, &mut numbers)?;
            block(first, &numbers);
            first = last;
        }
        Ok(())
    }

    /// All keys of a channel, a block at a time.
    pub(super) fn keys(&self, channel: &Channel, mut block: impl FnMut(Block<'_>)) -> Result<(), Error> {
        let mut keys = Keys::new(channel);
        loop {
            keys.read(&mut self.asset())?;
            match keys.block() {
                Some(keys) => block(keys),
                None => return Ok(()),
            }
        }
    }
}

/// One pass over one accessor or channel.
enum Job {
    Times { accessor: usize, place: String },
    Rotations { channel: Box<Channel>, place: String },
    Values { accessor: usize, finite: bool },
}

pub(super) fn check(asset: &mut Asset, report: &mut Report) {
    let jobs = jobs(asset);
    let shared = Shared(Mutex::new(asset));
    let done: Vec<_> = jobs.par_iter().map(|job| run(&shared, job)).collect();
    let sound = report.worst() < Some(Severity::Error);
    let mut ends = BTreeMap::new();
    for (job, (found, result)) in jobs.iter().zip(done) {
        report.extend(found.into_findings());
        match (job, result) {
            (Job::Times { accessor, .. }, Ok(last)) => {
                ends.insert(*accessor, last);
            }
            // Of a broken structure the reason is told already.
            (_, Err(error)) if sound => unreadable(error, report),
            _ => {}
        }
    }
    lengths(asset, &ends, report);
}

fn unreadable(error: Error, report: &mut Report) {
    match error {
        Error::Data { pointer, problem } => report.add(Code::BufferUnreadable, pointer, problem),
        other => report.add(Code::BufferUnreadable, "", other.to_string()),
    }
}

fn run(shared: &Shared<'_>, job: &Job) -> (Report, Result<f64, Error>) {
    let mut report = Report::default();
    let result = match job {
        Job::Times { accessor, place } => times::check(shared, *accessor, place, &mut report),
        Job::Rotations { channel, place } => {
            rotations::check(shared, channel, place, &mut report).map(|()| 0.0)
        }
        Job::Values { accessor, finite } => {
            values::check(shared, *accessor, *finite, &mut report).map(|()| 0.0)
        }
    };
    (report, result)
}

fn jobs(asset: &mut Asset) -> Vec<Job> {
    let mut jobs = Vec::new();
    let mut looked_at = BTreeSet::new();
    for a in 0..asset.root().animations.len() {
        for (s, input) in inputs(asset, a) {
            if looked_at.insert(input) {
                let place = format!("/animations/{a}/samplers/{s}/input");
                jobs.push(Job::Times { accessor: input, place });
            }
        }
        let mut samplers = BTreeSet::new();
        for c in 0..asset.root().animations[a].channels.len() {
            let Ok(channel) = asset.channel(a, c) else {
                continue;
            };
            if channel.property == Property::Rotation && samplers.insert(channel.sampler) {
                looked_at.insert(channel.output);
                let place = format!("/animations/{a}/samplers/{}/output", channel.sampler);
                jobs.push(Job::Rotations { channel: Box::new(channel), place });
            }
        }
    }
    let stored = (0..asset.root().accessors.len()).filter(|&accessor| is_stored(asset, accessor));
    jobs.extend(stored.map(|accessor| Job::Values { accessor, finite: !looked_at.contains(&accessor) }));
    jobs
}

/// Whether the numbers of an accessor are in the file as such: extensions
/// that compress may leave its buffer view or its buffer out.
fn is_stored(asset: &Asset, accessor: usize) -> bool {
    let root = asset.root();
    let stored = &root.accessors[accessor];
    match stored.buffer_view.and_then(|view| root.get(view)) {
        Some(view) if view.buffer.value() == 0 => true,
        Some(view) => !buffers::filled_by_extension(root, view.buffer.value()),
        None => stored.sparse.is_some() || root.extensions_used.is_empty(),
    }
}

/// Samplers of an animation and their accessors of times, where these are of
/// the type that times have.
fn inputs(asset: &Asset, animation: usize) -> Vec<(usize, usize)> {
    let root = asset.root();
    let samplers = root.animations[animation].samplers.iter().enumerate();
    let scalars = samplers.filter(|(_, sampler)| {
        root.get(sampler.input).is_some_and(|input| {
            let float = matches!(&input.component_type, Checked::Valid(c) if c.0 == ComponentType::F32);
            float && input.type_ == Checked::Valid(Type::Scalar)
        })
    });
    scalars.map(|(s, sampler)| (s, sampler.input.value())).collect()
}

/// Compares the ends of channels in a clip, and of clips, by the last times
/// of their inputs.
fn lengths(shared_asset: &Asset, ends: &BTreeMap<usize, f64>, report: &mut Report) {
    let mut clips = Vec::new();
    for (a, animation) in shared_asset.root().animations.iter().enumerate() {
        let ends = animation.samplers.iter().filter_map(|s| ends.get(&s.input.value()));
        let Some((first, last)) = span(ends.copied()) else {
            continue;
        };
        clips.push(last);
        if first < last {
            report.add(
                Code::ChannelLengths,
                format!("/animations/{a}"),
                format!(
                    "its channels end from {} s to {} s; the shorter ones hold their last value",
                    first as f32, last as f32
                ),
            );
        }
    }
    if let Some((shortest, longest)) = span(clips.into_iter()).filter(|(a, b)| a < b) {
        report.add(
            Code::ClipLengths,
            "/animations",
            format!("the clips last from {} s to {} s", shortest as f32, longest as f32),
        );
    }
}

/// The least and the greatest.
fn span(mut numbers: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let first = numbers.next()?;
    Some(numbers.fold((first, first), |(least, greatest), x| (least.min(x), greatest.max(x))))
}

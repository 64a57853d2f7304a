//! What stands in the buffer, in order, known before anything is sampled.

use super::chosen::{Chosen, Values, little_endian, rotation_bytes};
use super::facts::{Found, Late};
use super::{ClipPlan, When};
use crate::math::Quat;
use crate::moves::{Move, Mover, Stream};
use crate::sample::{self, Encoding, Rotation, Timeline, Travel, Writing};
use crate::write::{Buffer, Channel, Component, Data, Interpolation, Object, Property, Scene};
use std::io;

/// The buffer after the scene's own bytes, and the channels that refer to it.
pub(super) struct Layout<'p> {
    pub(super) blocks: Vec<Block<'p>>,
    /// By clip.
    pub(super) channels: Vec<Vec<Channel>>,
    /// Bytes of the buffer.
    pub(super) length: u64,
    stream: &'p Stream,
    writing: Writing,
}

/// A stretch of the buffer that is written at once.
pub(super) struct Block<'p> {
    clip: usize,
    content: Content<'p>,
}

enum Content<'p> {
    Times(&'p Timeline<'p>),
    /// Times that were worked out beforehand.
    OwnTimes(Vec<f32>),
    /// Rotations, one track after another.
    Rotations {
        tracks: Vec<Rotation<'p>>,
        timeline: &'p Timeline<'p>,
        of: Whose,
    },
    Travel {
        travel: &'p dyn Travel,
        timeline: &'p Timeline<'p>,
        of: Whose,
    },
    /// The scales of what is hidden first and seen then.
    Appearance,
    /// The values of a move that has keys of its own.
    Chosen(&'p Values),
}

/// Whose samples a block holds.
#[derive(Clone, Copy, PartialEq)]
enum Whose {
    Object,
    /// An object's whose copies wrap: all samples but the last, then all samples. Every
    /// copy's are a window of these.
    Ring,
    /// An object's whose copies start late: the first sample, in which they wait, then all.
    Late,
    Cameras,
}

impl Whose {
    /// How many samples a track has that is sampled `count` times.
    fn samples(self, count: u64) -> u64 {
        match self {
            Whose::Ring => 2 * count - 1,
            Whose::Late => count + 1,
            Whose::Object | Whose::Cameras => count,
        }
    }
}

/// What an accessor needs to know of times.
#[derive(Clone, Copy)]
struct Times {
    data: Data,
    span: [f32; 2],
}

impl<'p> Layout<'p> {
    pub(super) fn new(
        scene: &Scene,
        clips: &'p [ClipPlan<'p>],
        stream: &'p Stream,
        writing: Writing,
    ) -> Layout<'p> {
        let length = scene.bytes().len() as u64;
        let mut layout = Layout { blocks: Vec::new(), channels: Vec::new(), length, stream, writing };
        let mut grids: Vec<(&Timeline, Vec<Times>)> = Vec::new();
        let mut keys: Vec<(&[f32], Times)> = Vec::new();
        for (i, clip) in clips.iter().enumerate() {
            let mut channels = Vec::new();
            match &clip.when {
                When::Grid { object, cameras } => {
                    let times = layout.shared(i, object, &mut grids, stream.count);
                    channels.extend(layout.object(i, clip, object, scene, &times));
                    if let Some(timeline) = cameras {
                        let times = layout.shared(i, timeline, &mut grids, 1)[0];
                        channels.extend(layout.cameras(i, clip, timeline, scene, times));
                    }
                }
                When::Chosen { object, cameras } => {
                    let root = &scene.objects[0];
                    let object = clip
                        .object
                        .iter()
                        .zip(object)
                        .map(|((mover, a_move), chosen)| (node(root, *mover), a_move, chosen));
                    let cameras = clip
                        .cameras
                        .iter()
                        .zip(cameras)
                        .map(|((camera, a_move), chosen)| (scene.cameras[*camera], a_move, chosen));
                    for (node, a_move, chosen) in object.chain(cameras) {
                        channels.push(layout.chosen(i, node, a_move, chosen, &mut keys));
                    }
                }
            }
            layout.channels.push(channels);
        }
        layout
    }

    /// The times of a timeline and of so many copies, shared with those that have the same.
    fn shared(
        &mut self,
        clip: usize,
        timeline: &'p Timeline<'p>,
        known: &mut Vec<(&'p Timeline<'p>, Vec<Times>)>,
        count: usize,
    ) -> Vec<Times> {
        let same =
            |(other, times): &&(&Timeline, Vec<Times>)| other.is_same(timeline) && times.len() >= count;
        if let Some((_, times)) = known.iter().find(same) {
            return times.clone();
        }
        let times = self.object_times(clip, timeline, count);
        known.push((timeline, times.clone()));
        times
    }

    /// The channel of a move that has keys of its own.
    fn chosen(
        &mut self,
        clip: usize,
        node: usize,
        a_move: &Move,
        chosen: &'p Chosen,
        known: &mut Vec<(&'p [f32], Times)>,
    ) -> Channel {
        let own = &chosen.times[..];
        let times = match known.iter().find(|(other, _)| *other == own) {
            Some((_, times)) => *times,
            None => {
                let count = own.len() as u64;
                let offset = self.add(clip, Content::OwnTimes(own.to_vec()), 4 * count);
                let times = Times { data: Data { offset, count }, span: [own[0], own[own.len() - 1]] };
                known.push((own, times));
                times
            }
        };
        let count = times.data.count * chosen.values.per_key();
        let offset = self.add(clip, Content::Chosen(&chosen.values), count * self.size(a_move));
        let channel = self.channel(node, a_move, times, Data { offset, count });
        Channel { interpolation: chosen.interpolation, ..channel }
    }

    /// How many rotations and places are written.
    pub(super) fn samples(&self) -> u64 {
        let samples = |block: &Block| match &block.content {
            Content::Rotations { tracks, timeline, of } => {
                tracks.len() as u64 * of.samples(timeline.len() as u64)
            }
            Content::Travel { timeline, of, .. } => of.samples(timeline.len() as u64),
            Content::Chosen(values) => values.keys() as u64,
            Content::Times(_) | Content::OwnTimes(_) | Content::Appearance => 0,
        };
        self.blocks.iter().map(samples).sum()
    }

    /// Adds a block and says where it stands.
    fn add(&mut self, clip: usize, content: Content<'p>, bytes: u64) -> u64 {
        let offset = self.length;
        self.blocks.push(Block { clip, content });
        self.length += bytes;
        offset
    }

    fn times(&mut self, clip: usize, timeline: &'p Timeline<'p>) -> Times {
        let count = timeline.len() as u64;
        let offset = self.add(clip, Content::Times(timeline), 4 * count);
        Times { data: Data { offset, count }, span: [0.0, timeline.last()] }
    }

    /// The times of an object and of each of its copies.
    fn object_times(&mut self, clip: usize, timeline: &'p Timeline<'p>, count: usize) -> Vec<Times> {
        let mut times = vec![self.times(clip, timeline)];
        let way: Vec<f32> = if count > 1 { all(timeline) } else { Vec::new() };
        for copy in 1..count {
            let own = copy_times(&way, self.stream, copy);
            let span = [own[0], own[own.len() - 1]];
            let count = own.len() as u64;
            let offset = self.add(clip, Content::OwnTimes(own), 4 * count);
            times.push(Times { data: Data { offset, count }, span });
        }
        times
    }

    /// The values of an object, and the channels of all its copies.
    fn object(
        &mut self,
        clip: usize,
        plan: &'p ClipPlan<'p>,
        timeline: &'p Timeline<'p>,
        scene: &Scene,
        times: &[Times],
    ) -> Vec<Channel> {
        let of = match self.stream {
            Stream { count: 1, .. } => Whose::Object,
            Stream { wrap: true, .. } => Whose::Ring,
            Stream { wrap: false, .. } => Whose::Late,
        };
        let moves: Vec<&Move> = plan.object.iter().map(|(_, a_move)| a_move).collect();
        let offsets = self.values(clip, &moves, timeline, of);
        let way: Vec<f32> = if of == Whose::Ring { all(timeline) } else { Vec::new() };
        let count = timeline.len() as u64;
        let mut channels = Vec::new();
        for (copy, (object, times)) in scene.objects.iter().zip(times).enumerate() {
            let first = match of {
                // The first copy's last sample is that of the second round.
                Whose::Ring if copy == 0 => count - 1,
                Whose::Ring => phase(&way, self.stream, copy) as u64,
                Whose::Late if copy == 0 => 1,
                Whose::Late | Whose::Object | Whose::Cameras => 0,
            };
            let count = times.data.count;
            for ((mover, a_move), offset) in plan.object.iter().zip(&offsets) {
                let values = Data { offset: offset + first * self.size(a_move), count };
                channels.push(self.channel(node(object, *mover), a_move, *times, values));
            }
            if copy > 0 && !self.stream.wrap {
                channels.push(self.appearance(clip, object.root, self.stream.start(copy)));
            }
        }
        channels
    }

    /// Hides a node until it starts.
    fn appearance(&mut self, clip: usize, node: usize, start: f64) -> Channel {
        let span = [0.0, start as f32];
        let times = self.add(clip, Content::OwnTimes(span.to_vec()), 8);
        let values = self.add(clip, Content::Appearance, 24);
        let [times, values] = [times, values].map(|offset| Data { offset, count: 2 });
        Channel {
            node,
            property: Property::Scale,
            interpolation: Interpolation::Step,
            component: Component::F32,
            times,
            span,
            values,
        }
    }

    fn cameras(
        &mut self,
        clip: usize,
        plan: &'p ClipPlan<'p>,
        timeline: &'p Timeline<'p>,
        scene: &Scene,
        times: Times,
    ) -> Vec<Channel> {
        let moves: Vec<&Move> = plan.cameras.iter().map(|(_, a_move)| a_move).collect();
        let offsets = self.values(clip, &moves, timeline, Whose::Cameras);
        let count = timeline.len() as u64;
        let moves = plan.cameras.iter().zip(offsets);
        let channel = |((camera, a_move), offset): (&(usize, Move), u64)| {
            self.channel(scene.cameras[*camera], a_move, times, Data { offset, count })
        };
        moves.map(channel).collect()
    }

    /// Adds the values of all moves, rotations first, and says where each one's begin.
    fn values(
        &mut self,
        clip: usize,
        moves: &[&'p Move<'p>],
        timeline: &'p Timeline<'p>,
        of: Whose,
    ) -> Vec<u64> {
        let samples = of.samples(timeline.len() as u64);
        let tracks: Vec<Rotation> = moves.iter().filter_map(|a_move| a_move.rotation()).collect();
        let sizes: Vec<u64> = moves.iter().map(|a_move| samples * self.size(a_move)).collect();
        let rotations = sizes[..tracks.len()].iter().sum();
        let mut offset = self.add(clip, Content::Rotations { tracks, timeline, of }, rotations);
        for travel in moves.iter().filter_map(|a_move| a_move.travel()) {
            self.add(clip, Content::Travel { travel, timeline, of }, 12 * samples);
        }
        let mut offsets = Vec::new();
        for size in sizes {
            offsets.push(offset);
            offset += size;
        }
        offsets
    }

    /// Bytes of one sample.
    fn size(&self, a_move: &Move) -> u64 {
        match (a_move, self.writing.encoding) {
            (Move::Travel(_), _) => 12,
            (_, Encoding::Float) => 16,
            (_, Encoding::Normalized16) => 8,
        }
    }

    fn channel(&self, node: usize, a_move: &Move, times: Times, values: Data) -> Channel {
        let (property, component) = match (a_move, self.writing.encoding) {
            (Move::Travel(_), _) => (Property::Translation, Component::F32),
            (_, Encoding::Float) => (Property::Rotation, Component::F32),
            (_, Encoding::Normalized16) => (Property::Rotation, Component::I16),
        };
        let Times { data, span } = times;
        let interpolation = if self.writing.hold { Interpolation::Step } else { Interpolation::Linear };
        Channel { node, property, interpolation, component, times: data, span, values }
    }

    /// By how much copies can be late or early, their times being rounded once more, and
    /// what that makes.
    pub(super) fn lateness(&self, moves: &[(Mover, Move)]) -> Late {
        if self.stream.count == 1 {
            return Late::default();
        }
        let end = self.stream.once + self.stream.start(self.stream.count);
        let late = f64::from((end as f32).next_up()) - f64::from(end as f32);
        let speeds = || moves.iter().map(|(_, a_move)| a_move);
        Late {
            degrees: speeds()
                .filter_map(|a_move| a_move.turning_bound())
                .map(|v| v.map(|v| v * late))
                .collect(),
            units: speeds()
                .filter_map(Move::travel)
                .map(|way| way.speed_bound(0.0, self.stream.once) * late)
                .sum(),
        }
    }
}

impl Block<'_> {
    /// Writes the block, and notes what is found out.
    pub(super) fn write(
        &self,
        writing: Writing,
        buffer: &mut impl Buffer,
        progress: &mut impl FnMut(u64),
        found: &mut [Found],
    ) -> io::Result<()> {
        let found = &mut found[self.clip];
        match &self.content {
            Content::Times(timeline) => (0..timeline.chunks()).try_for_each(|chunk| {
                let times: Vec<[f32; 1]> = timeline.chunk(chunk).1.into_iter().map(|t| [t]).collect();
                buffer.append(&little_endian(&times))
            }),
            Content::OwnTimes(times) => {
                let times: Vec<[f32; 1]> = times.iter().map(|&t| [t]).collect();
                buffer.append(&little_endian(&times))
            }
            Content::Chosen(values) => {
                progress(values.keys() as u64);
                buffer.append(&values.bytes(writing.encoding))
            }
            Content::Appearance => buffer.append(&little_endian(&[[0f32; 3], [1.0; 3]])),
            Content::Rotations { tracks, timeline, of } => {
                let append = |rotations: &[[f32; 4]]| {
                    progress(rotations.len() as u64);
                    buffer.append(&rotation_bytes(rotations, writing.encoding))
                };
                found.of(*of == Whose::Cameras).tracks = rotations(tracks, timeline, *of, writing, append)?;
                Ok(())
            }
            Content::Travel { travel, timeline, of } => {
                let append = |places: &[[f32; 3]]| {
                    progress(places.len() as u64);
                    buffer.append(&little_endian(places))
                };
                let distance = places(*travel, timeline, *of, writing.hold, append)?;
                if writing.bound {
                    found.of(*of == Whose::Cameras).distances.push(distance);
                }
                Ok(())
            }
        }
    }
}

/// Samples rotations and hands them on, over and again as what they belong to needs it.
fn rotations(
    tracks: &[Rotation],
    timeline: &Timeline,
    of: Whose,
    writing: Writing,
    mut append: impl FnMut(&[[f32; 4]]) -> io::Result<()>,
) -> io::Result<Vec<sample::TrackFacts>> {
    match of {
        Whose::Ring => rotations_twice(tracks, timeline, writing, &mut append),
        Whose::Late => sample::rotations(tracks, timeline, writing, first_twice(timeline.len(), append)),
        Whose::Object | Whose::Cameras => sample::rotations(tracks, timeline, writing, append),
    }
}

/// The same of places; returns how far off they are.
fn places(
    travel: &dyn Travel,
    timeline: &Timeline,
    of: Whose,
    hold: bool,
    mut append: impl FnMut(&[[f32; 3]]) -> io::Result<()>,
) -> io::Result<f64> {
    if of == Whose::Ring {
        let mut left = timeline.len() - 1;
        sample::translations(travel, timeline, hold, |places| append(all_but_last(places, &mut left)))?;
    }
    if of == Whose::Late {
        return sample::translations(travel, timeline, hold, first_twice(timeline.len(), append));
    }
    sample::translations(travel, timeline, hold, append)
}

/// Writes each track without its last sample, then whole, its signs following on.
fn rotations_twice(
    tracks: &[Rotation],
    timeline: &Timeline,
    writing: Writing,
    append: &mut impl FnMut(&[[f32; 4]]) -> io::Result<()>,
) -> io::Result<Vec<sample::TrackFacts>> {
    let mut facts = Vec::new();
    for track in tracks {
        let (mut left, mut last) = (timeline.len() - 1, None);
        sample::rotations(std::slice::from_ref(track), timeline, writing, |rotations| {
            let rotations = all_but_last(rotations, &mut left);
            last = rotations.last().copied().or(last);
            append(rotations)
        })?;
        let mut turn = None;
        facts.extend(sample::rotations(std::slice::from_ref(track), timeline, writing, |rotations| {
            let follows = |first: [f32; 4]| {
                let before = last.map_or(first, |before| before).map(f64::from);
                Quat::from_xyzw(before).dot(Quat::from_xyzw(first.map(f64::from))) >= 0.0
            };
            if *turn.get_or_insert_with(|| !follows(rotations[0])) {
                append(&rotations.iter().map(|q| q.map(|x| -x)).collect::<Vec<_>>())
            } else {
                append(rotations)
            }
        })?);
    }
    Ok(facts)
}

/// Hands samples on, the first of every `count` twice.
fn first_twice<T>(
    count: usize,
    mut append: impl FnMut(&[T]) -> io::Result<()>,
) -> impl FnMut(&[T]) -> io::Result<()> {
    let mut seen = 0;
    move |samples| {
        if seen % count == 0 {
            append(&samples[..1])?;
        }
        seen += samples.len();
        append(samples)
    }
}

/// The samples before the last one, of which `left` are left.
fn all_but_last<'s, T>(samples: &'s [T], left: &mut usize) -> &'s [T] {
    let some = &samples[..samples.len().min(*left)];
    *left -= some.len();
    some
}

fn all(timeline: &Timeline) -> Vec<f32> {
    (0..timeline.chunks()).flat_map(|chunk| timeline.chunk(chunk).1).collect()
}

/// Which sample of the way a copy that wraps shows first.
fn phase(way: &[f32], stream: &Stream, copy: usize) -> usize {
    let phase = stream.phase(copy) as f32;
    way.partition_point(|&t| t < phase).min(way.len() - 1)
}

/// When a copy shows the samples of its window, or of the way.
fn copy_times(way: &[f32], stream: &Stream, copy: usize) -> Vec<f32> {
    let exact: Vec<f64> = if stream.wraps() {
        let first = phase(way, stream, copy);
        let start = f64::from(way[first]);
        let end = f64::from(way[way.len() - 1]);
        let (before, after) = (&way[..=first], &way[first..way.len() - 1]);
        let after = after.iter().map(|&t| f64::from(t) - start);
        after.chain(before.iter().map(|&t| f64::from(t) + (end - start))).collect()
    } else {
        // It waits from the clip's start on.
        std::iter::once(0.0).chain(way.iter().map(|&t| f64::from(t) + stream.start(copy))).collect()
    };
    let mut times: Vec<f32> = Vec::with_capacity(exact.len());
    for time in exact {
        // Later numbers are coarser; what falls together is told apart again.
        let least = times.last().map_or(0.0, |last| last.next_up());
        times.push((time as f32).max(least));
    }
    times
}

/// The node of an object that moves.
fn node(object: &Object, mover: Mover) -> usize {
    match mover {
        Mover::Root => object.root,
        Mover::Track(track) => object.turned[track],
    }
}

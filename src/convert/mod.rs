//! The stages in a row: inputs in, a glTF file out.
//!
//! A [`Plan`] knows everything about the output but the samples: what will be warned
//! about, and how large it becomes. Writing it streams; memory holds the keys.

mod facts;
mod recipe;

pub use facts::ClipFacts;

use crate::clip::{Clip, Warning};
use crate::curve::{self, Scheme};
use crate::moves::{Ground, Move, Mover};
use crate::sample::{self, Fps, Rotation, Timeline, TooFine, TrackFacts};
use crate::write::{
    Animation, Bin, Buffer, Channel, Data, Glb, LARGEST_GLB, Property, Scene, document, glb_size,
};
use recipe::recipe;
use std::io::{self, Seek, Write};

/// How motion becomes animations.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the animations; with several schemes each adds its own.
    pub name: String,
    /// The inputs' names as the file keeps them: keyframes, then path.
    pub inputs: Vec<String>,
    /// One animation a scheme.
    pub schemes: Vec<Scheme>,
    /// Samples per second.
    pub fps: Fps,
    /// Whether every key time is a sample too.
    pub key_times: bool,
}

/// Why keyframes and options make no file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Frames that float32 cannot tell apart.
    #[error("{0}: {1}")]
    TooFine(String, TooFine),
    /// Keys that float32 cannot tell apart.
    #[error(
        "{source_name}:{}: the keys in lines {} and {} are so close that float32, glTF's number for times, \
         cannot tell them apart {seconds} s after the first key; leave one of them out{}",
        .lines.1, .lines.0, .lines.1, if *.key_times { ", or say --no-key-times" } else { "" }
    )]
    KeysTooClose {
        /// The input's name.
        source_name: String,
        /// The lines of both.
        lines: (usize, usize),
        /// When the first of them is, from the first key on.
        seconds: f64,
        /// Whether leaving the key times out helps.
        key_times: bool,
    },
    /// More than a .glb can hold.
    #[error(
        "{source_name}: the output would have {:.2} GiB, and a .glb ends at 4 GiB; {}{}write a .gltf",
        *.bytes as f64 / (1u64 << 30) as f64, advice(*.largest_fps, *.key_times),
        if *.several_schemes { "choose fewer schemes, or " } else { "or " }
    )]
    TooLarge {
        /// The input's name.
        source_name: String,
        /// How large it would be.
        bytes: u64,
        /// A rate at which it fits, if there is one.
        largest_fps: Option<Fps>,
        /// Whether it fits with the key times.
        key_times: bool,
        /// Whether there are schemes to leave out.
        several_schemes: bool,
    },
}

fn advice(largest_fps: Option<Fps>, key_times: bool) -> String {
    let flag = if key_times { "" } else { " with --no-key-times" };
    largest_fps.map_or(String::new(), |fps| format!("sample at --fps {fps} or less{flag}, "))
}

/// An output that is known but for its samples.
pub struct Plan<'a> {
    ground: &'a Ground<'a>,
    source_name: &'a str,
    options: &'a Options,
    scene: Scene,
    /// What each clip's nodes do, and when.
    clips: Vec<ClipPlan<'a>>,
    warnings: Vec<Warning>,
}

/// One clip: what every node does by a scheme, and when it is sampled.
struct ClipPlan<'a> {
    scheme: Scheme,
    moves: Vec<(Mover, Move<'a>)>,
    timeline: Timeline<'a>,
}

impl ClipPlan<'_> {
    /// Bytes of one sample of everything, its time too.
    fn sample_size(&self) -> u64 {
        4 + self.moves.iter().map(size).sum::<u64>()
    }
}

impl<'a> Plan<'a> {
    /// Plans the output of what was put together from `source_name`; `options.schemes` is
    /// not empty. Where no scheme makes a difference, there is one clip.
    pub fn new(
        ground: &'a Ground<'a>,
        source_name: &'a str,
        options: &'a Options,
    ) -> Result<Plan<'a>, Error> {
        let schemes = if ground.has_schemes() { &options.schemes[..] } else { &options.schemes[..1] };
        let clip = |&scheme: &Scheme| {
            let timeline = ground.timeline(scheme, options.fps, options.key_times)?;
            Ok(ClipPlan { scheme, moves: ground.moves(scheme), timeline })
        };
        let clips = schemes.iter().map(clip).collect::<Result<_, _>>();
        let clips = clips.map_err(|error| too_fine(error, ground, source_name))?;
        let warnings = warnings(ground, options);
        Ok(Plan { ground, source_name, options, scene: scene(ground), clips, warnings })
    }

    /// What the user should know before a sample is made.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// How many rotations and places will be written.
    pub fn samples(&self) -> u64 {
        self.clips.iter().map(|clip| (clip.moves.len() * clip.timeline.len()) as u64).sum()
    }

    /// Writes a .glb to `out`, which stands at its start. `progress` is told of every so
    /// many rotations and places.
    pub fn write_glb<W: Write + Seek>(
        &self,
        out: W,
        progress: impl FnMut(u64),
    ) -> io::Result<(W, Vec<ClipFacts>)> {
        let mut glb = Glb::new(out, self.widest_json())?;
        let (animations, facts) = self.samples_to(&mut glb, progress)?;
        let length = glb.length();
        Ok((glb.finish(&document(&self.scene, &animations, length, None))?, facts))
    }

    /// Writes the .bin of a .gltf to `out` and returns the .gltf's JSON; `name` makes the
    /// .bin's file name, as the .gltf refers to it, of its content's hash.
    pub fn write_gltf<W: Write>(
        &self,
        out: W,
        name: impl FnOnce(&str) -> String,
        progress: impl FnMut(u64),
    ) -> io::Result<(W, Vec<u8>, Vec<ClipFacts>)> {
        let mut bin = Bin::new(out);
        let (animations, facts) = self.samples_to(&mut bin, progress)?;
        let length = bin.length();
        let (out, hash) = bin.finish()?;
        Ok((out, document(&self.scene, &animations, length, Some(name(&hash))), facts))
    }

    /// Refuses a plan whose .glb would be larger than a .glb can be.
    pub fn fits_glb(&self) -> Result<(), Error> {
        let json = self.widest_json();
        let bytes = glb_size(json, self.binary_length());
        if bytes <= LARGEST_GLB {
            return Ok(());
        }
        let sample: u64 = self.clips.iter().map(ClipPlan::sample_size).sum();
        let room = LARGEST_GLB - glb_size(json, self.scene.bytes().len() as u64);
        let samples = room as f64 / sample as f64;
        let rate = |others: usize| Fps::at_most((samples - others as f64) / self.ground.duration());
        // Both ends, and the start of a ramp.
        let with_keys = rate(self.ground.knots().len() + 3).filter(|_| self.options.key_times);
        let source_name = self.source_name.to_owned();
        let largest_fps = with_keys.or_else(|| rate(3));
        let key_times = with_keys.is_some() || !self.options.key_times;
        let several_schemes = self.clips.len() > 1;
        Err(Error::TooLarge { source_name, bytes, largest_fps, key_times, several_schemes })
    }

    fn binary_length(&self) -> u64 {
        let clips = self.clips.iter().map(|clip| clip.sample_size() * clip.timeline.len() as u64);
        self.scene.bytes().len() as u64 + clips.sum::<u64>()
    }

    /// An upper bound of the JSON's length: that of a document whose numbers all take the
    /// most digits.
    fn widest_json(&self) -> usize {
        // Numbers of the most digits a float64 and a float32 can take.
        let widest = TrackFacts { deviation: Some(-f64::MIN_POSITIVE), ..TrackFacts::default() };
        let last = -f32::MIN_POSITIVE;
        let animation = |ClipPlan { scheme, moves, .. }: &ClipPlan| {
            let channels = moves.iter().map(|a_move| self.channel(a_move, Data::WIDEST, last, Data::WIDEST));
            let tracks = vec![widest; moves.len()];
            let extras = recipe(self.ground, self.options, *scheme, &tracks, widest.deviation);
            Animation { name: self.name(*scheme), extras, channels: channels.collect() }
        };
        let animations: Vec<Animation> = self.clips.iter().map(animation).collect();
        document(&self.scene, &animations, u64::MAX, None).len()
    }

    fn samples_to(
        &self,
        buffer: &mut impl Buffer,
        mut progress: impl FnMut(u64),
    ) -> io::Result<(Vec<Animation>, Vec<ClipFacts>)> {
        buffer.append(&self.scene.bytes())?;
        let mut shared: Vec<(&Timeline, Data)> = Vec::new();
        let (mut animations, mut facts) = (Vec::new(), Vec::new());
        for ClipPlan { scheme, moves, timeline } in &self.clips {
            let times = match shared.iter().find(|(known, _)| known.is_same(timeline)) {
                Some(&(_, times)) => times,
                None => append_times(buffer, timeline)?,
            };
            shared.push((timeline, times));
            let mut at = buffer.length();
            let rotations: Vec<Rotation> = moves.iter().filter_map(|(_, turn)| turn.rotation()).collect();
            let tracks = sample::rotations(&rotations, timeline, |rotations| {
                progress(rotations.len() as u64);
                buffer.append(&little_endian(rotations))
            })?;
            let mut distance = None;
            for travel in moves.iter().filter_map(|(_, travel)| travel.travel()) {
                let bound = sample::translations(travel, timeline, |places| {
                    progress(places.len() as u64);
                    buffer.append(&little_endian(places))
                })?;
                distance = Some(bound);
            }
            let mut channels = Vec::new();
            for a_move in moves {
                channels.push(self.channel(
                    a_move,
                    times,
                    timeline.last(),
                    Data { offset: at, count: times.count },
                ));
                at += size(a_move) * times.count;
            }
            let extras = recipe(self.ground, self.options, *scheme, &tracks, distance);
            animations.push(Animation { name: self.name(*scheme), extras, channels });
            facts.push(ClipFacts::new(self.name(*scheme), scheme.name(), times.count, tracks, distance));
        }
        Ok((animations, facts))
    }

    fn name(&self, scheme: Scheme) -> String {
        match self.clips.as_slice() {
            [_] => self.options.name.clone(),
            _ => format!("{}-{}", self.options.name, scheme.name()),
        }
    }

    fn channel(&self, (mover, a_move): &(Mover, Move), times: Data, last: f32, values: Data) -> Channel {
        let node = match *mover {
            Mover::Root => 0,
            Mover::Track(track) => self.scene.turned[track],
        };
        let property = match a_move {
            Move::Travel(_) => Property::Translation,
            Move::Keys(_) | Move::Attitude(_) => Property::Rotation,
        };
        Channel { node, property, times, span: [0.0, last], values }
    }
}

/// Bytes of one sample.
fn size((_, a_move): &(Mover, Move)) -> u64 {
    match a_move {
        Move::Travel(_) => 12,
        Move::Keys(_) | Move::Attitude(_) => 16,
    }
}

/// What there is to see: the body that keyframes turn, or a glider.
fn scene(ground: &Ground) -> Scene {
    match &ground.inputs().keyframes {
        Some(keyframes) => Scene::of(keyframes.clip.body, keyframes.clip.tracks.len()),
        None => Scene::glider(ground.extent()),
    }
}

fn append_times(buffer: &mut impl Buffer, timeline: &Timeline) -> io::Result<Data> {
    let data = Data { offset: buffer.length(), count: timeline.len() as u64 };
    for chunk in 0..timeline.chunks() {
        let times: Vec<[f32; 1]> = timeline.chunk(chunk).1.into_iter().map(|t| [t]).collect();
        buffer.append(&little_endian(&times))?;
    }
    Ok(data)
}

fn little_endian<const N: usize>(values: &[[f32; N]]) -> Vec<u8> {
    let bits: Vec<u32> = values.as_flattened().iter().map(|x| x.to_bits().to_le()).collect();
    bytemuck::cast_slice(&bits).to_vec()
}

fn too_fine(error: TooFine, ground: &Ground, source_name: &str) -> Error {
    let source_name = source_name.to_owned();
    match (error, &ground.inputs().keyframes, &ground.inputs().path) {
        (TooFine::Keys { key }, Some(keyframes), None) => {
            let clip = &keyframes.clip;
            let lines = (clip.lines.of(key), clip.lines.of(key + 1));
            let key_times = clip.duration() as f32 > 0.0;
            Error::KeysTooClose { source_name, lines, seconds: clip.times[key], key_times }
        }
        (other, ..) => Error::TooFine(source_name, other),
    }
}

fn warnings(ground: &Ground, options: &Options) -> Vec<Warning> {
    let inputs = ground.inputs();
    let mut warnings = Vec::new();
    if let Some(keyframes) = &inputs.keyframes {
        warnings.extend_from_slice(&keyframes.warnings);
        warnings.extend(close_keys(&keyframes.clip, options));
        let (clip, ends) = (&keyframes.clip, ground.shape().ends);
        let place = |key| clip.place(key);
        for &scheme in &options.schemes {
            warnings.extend(curve::warnings(&clip.times, &clip.tracks, &place, scheme, ends));
        }
    }
    warnings.extend(inputs.path.iter().flat_map(|path| path.warnings.iter().cloned()));
    warnings.dedup();
    warnings
}

/// Keys so close that some viewers merge them.
fn close_keys(clip: &Clip, options: &Options) -> Option<Warning> {
    const APART: f64 = 1e-3;
    let gap = |i: usize| clip.times[i + 1] - clip.times[i];
    let close = || (0..clip.times.len() - 1).filter(|&i| gap(i) < APART * (1.0 - 1e-9));
    let count = if options.key_times { close().count() } else { 0 };
    let worst = close().min_by(|&a, &b| gap(a).total_cmp(&gap(b)))?;
    (count > 0).then(|| {
        let message = format!(
            "{count} key{} less than 1 ms after the one before, the closest {:.3} ms at {}; Blender merges keys \
             closer than 0.42 ms",
            if count == 1 { " comes" } else { "s come" },
            1e3 * gap(worst),
            clip.place(worst + 1)
        );
        Warning::new("CLOSE_KEYS", message)
    })
}

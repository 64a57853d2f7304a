//! The stages in a row: keyframes in, a glTF file out.
//!
//! A [`Plan`] knows everything about the output but the samples: what will be warned
//! about, and how large it becomes. Writing it streams; memory holds the keys.

use crate::clip::{Clip, Warning};
use crate::curve::{self, Ends, Motion, NotClosed, Scheme};
use crate::read::Keyframes;
use crate::sample::{self, Fps, Rotation, Steps, Timeline, TooFine, TrackFacts};
use crate::write::{
    Animation, Bin, Buffer, Channel, Data, Glb, LARGEST_GLB, Property, Scene, document, glb_size,
};
use serde::Serialize;
use std::io::{self, Seek, Write};

/// How rotations become animations.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the animations; with several schemes each adds its own.
    pub name: String,
    /// The input's name as the file keeps it.
    pub input: String,
    /// One animation a scheme.
    pub schemes: Vec<Scheme>,
    /// What the motion does at its ends.
    pub ends: Ends,
    /// Samples per second.
    pub fps: Fps,
    /// Whether every key time is a sample too.
    pub key_times: bool,
}

/// Why keyframes and options make no file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Closed ends that do not meet.
    #[error("{0}: {1}")]
    NotClosed(String, NotClosed),
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

/// What a clip of the output is made from, as its `extras` say it.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Recipe<'a> {
    dat2glb: &'a str,
    scheme: &'a str,
    ends: &'a str,
    fps: String,
    key_times: bool,
    quat_order: &'a str,
    inputs: [Input<'a>; 1],
    /// Upper bounds of the angle between playback (slerp) and the curve, by box.
    deviation_degrees: Vec<Option<f64>>,
}

#[derive(Serialize)]
struct Input<'a> {
    name: &'a str,
    blake3: &'a str,
}

/// What became of one scheme.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipFacts {
    /// Name of the animation.
    pub name: String,
    /// Its scheme.
    pub scheme: &'static str,
    /// Samples of each box.
    pub samples: u64,
    /// An upper bound of the angle between playback (slerp) and the curve, degrees: the
    /// largest of all boxes. None where one of them has none.
    pub deviation_degrees: Option<f64>,
    /// The largest turn from sample to sample, degrees.
    pub largest_step_degrees: f64,
    /// The same by track.
    #[serde(skip)]
    pub tracks: Vec<TrackFacts>,
}

/// An output that is known but for its samples.
#[derive(Debug)]
pub struct Plan<'a> {
    keyframes: &'a Keyframes,
    source_name: &'a str,
    options: &'a Options,
    scene: Scene,
    /// One a scheme.
    timelines: Vec<Timeline<'a>>,
    warnings: Vec<Warning>,
}

impl<'a> Plan<'a> {
    /// Plans the output of keyframes read from `source_name`; `options.schemes` is not
    /// empty.
    pub fn new(
        keyframes: &'a Keyframes,
        source_name: &'a str,
        options: &'a Options,
    ) -> Result<Plan<'a>, Error> {
        let clip = &keyframes.clip;
        if options.schemes.iter().any(|&scheme| scheme != Scheme::Slerp) {
            options.ends.accept(clip).map_err(|error| Error::NotClosed(source_name.to_owned(), error))?;
        }
        let timeline = |&scheme: &Scheme| {
            let ramp = motion(clip, 0, scheme, options.ends).ramp();
            Timeline::new(&clip.times, ramp, options.fps, options.key_times)
        };
        let timelines = options.schemes.iter().map(timeline).collect::<Result<_, _>>();
        let timelines = timelines.map_err(|error| too_fine(error, clip, source_name))?;
        let mut warnings = keyframes.warnings.clone();
        warnings.extend(close_keys(clip, options));
        for &scheme in &options.schemes {
            warnings.extend(curve::warnings(clip, scheme, options.ends));
        }
        warnings.dedup();
        let scene = Scene::of(clip.body, clip.tracks.len());
        Ok(Plan { keyframes, source_name, options, scene, timelines, warnings })
    }

    /// How many boxes turn.
    pub fn boxes(&self) -> usize {
        self.keyframes.clip.tracks.len()
    }

    /// What the user should know before a sample is made.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// How many rotations will be written.
    pub fn samples(&self) -> u64 {
        self.timelines.iter().map(|t| t.len() as u64).sum::<u64>() * self.keyframes.clip.tracks.len() as u64
    }

    /// Writes a .glb to `out`, which stands at its start. `progress` is told of every so
    /// many rotations.
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
        let clip = &self.keyframes.clip;
        let sample = 16 * clip.tracks.len() as u64 + 4;
        let room = LARGEST_GLB - glb_size(json, self.scene.bytes().len() as u64);
        let samples = room as f64 / sample as f64 / self.timelines.len() as f64;
        let rate = |others: usize| Fps::at_most((samples - others as f64) / clip.duration());
        // Both ends, and the start of a ramp.
        let with_keys = rate(clip.times.len() + 3).filter(|_| self.options.key_times);
        let source_name = self.source_name.to_owned();
        let largest_fps = with_keys.or_else(|| rate(3));
        let key_times = with_keys.is_some() || !self.options.key_times;
        let several_schemes = self.timelines.len() > 1;
        Err(Error::TooLarge { source_name, bytes, largest_fps, key_times, several_schemes })
    }

    fn binary_length(&self) -> u64 {
        let times: u64 = self.timelines.iter().map(|t| 4 * t.len() as u64).sum();
        self.scene.bytes().len() as u64 + times + 16 * self.samples()
    }

    /// An upper bound of the JSON's length: that of a document whose numbers all take the
    /// most digits.
    fn widest_json(&self) -> usize {
        // Numbers of the most digits a float64 and a float32 can take.
        let widest = TrackFacts { deviation: Some(-f64::MIN_POSITIVE), ..TrackFacts::default() };
        let last = -f32::MIN_POSITIVE;
        let facts = vec![widest; self.keyframes.clip.tracks.len()];
        let animation = |&scheme: &Scheme| {
            let channels =
                self.scene.turned.iter().map(|&node| channel(node, Data::WIDEST, last, Data::WIDEST));
            Animation {
                name: self.name(scheme),
                extras: self.recipe(scheme, &facts),
                channels: channels.collect(),
            }
        };
        let animations: Vec<Animation> = self.options.schemes.iter().map(animation).collect();
        document(&self.scene, &animations, u64::MAX, None).len()
    }

    fn samples_to(
        &self,
        buffer: &mut impl Buffer,
        mut progress: impl FnMut(u64),
    ) -> io::Result<(Vec<Animation>, Vec<ClipFacts>)> {
        buffer.append(&self.scene.bytes())?;
        let mut shared: Vec<(Option<f64>, Data)> = Vec::new();
        let (mut animations, mut facts) = (Vec::new(), Vec::new());
        for (&scheme, timeline) in self.options.schemes.iter().zip(&self.timelines) {
            let clip = &self.keyframes.clip;
            let motions = (0..clip.tracks.len()).map(|track| motion(clip, track, scheme, self.options.ends));
            let rotations: Vec<Rotation> = motions.map(Rotation::Motion).collect();
            // Timelines differ by their ramps only.
            let ramp = motion(clip, 0, scheme, self.options.ends).ramp();
            let times = match shared.iter().find(|known| known.0 == ramp) {
                Some(&(_, times)) => times,
                None => append_times(buffer, timeline)?,
            };
            shared.push((ramp, times));
            let first = buffer.length();
            let known = sample::rotations(&rotations, timeline, |rotations| {
                progress(rotations.len() as u64);
                buffer.append(bytemuck::cast_slice(&little_endian(rotations)))
            })?;
            let values =
                |track: usize| Data { offset: first + 16 * times.count * track as u64, count: times.count };
            let channels = self.scene.turned.iter().enumerate();
            let channels =
                channels.map(|(track, &node)| channel(node, times, timeline.last(), values(track)));
            animations.push(Animation {
                name: self.name(scheme),
                extras: self.recipe(scheme, &known),
                channels: channels.collect(),
            });
            facts.push(self.facts(scheme, times.count, known));
        }
        Ok((animations, facts))
    }

    fn name(&self, scheme: Scheme) -> String {
        match self.options.schemes.as_slice() {
            [_] => self.options.name.clone(),
            _ => format!("{}-{}", self.options.name, scheme.name()),
        }
    }

    fn recipe(&self, scheme: Scheme, facts: &[TrackFacts]) -> String {
        let recipe = Recipe {
            dat2glb: env!("CARGO_PKG_VERSION"),
            scheme: scheme.name(),
            ends: self.options.ends.name(),
            fps: self.options.fps.to_string(),
            key_times: self.options.key_times,
            quat_order: self.keyframes.order.name(),
            inputs: [Input { name: &self.options.input, blake3: &self.keyframes.hash }],
            deviation_degrees: facts.iter().map(|f| f.deviation.map(rounded_up)).collect(),
        };
        serde_json::to_string(&recipe).expect("plain data becomes JSON")
    }

    fn facts(&self, scheme: Scheme, samples: u64, tracks: Vec<TrackFacts>) -> ClipFacts {
        let deviations: Option<Vec<f64>> = tracks.iter().map(|track| track.deviation).collect();
        let largest = |values: Vec<f64>| values.into_iter().fold(0.0, f64::max);
        ClipFacts {
            name: self.name(scheme),
            scheme: scheme.name(),
            samples,
            deviation_degrees: deviations.map(|all| rounded_up(largest(all))),
            largest_step_degrees: largest(tracks.iter().map(|track| track.steps.worst).collect()),
            tracks,
        }
    }
}

fn motion(clip: &Clip, track: usize, scheme: Scheme, ends: Ends) -> Motion<'_> {
    Motion::new(&clip.times, &clip.tracks[track], scheme, ends)
}

fn channel(node: usize, times: Data, last: f32, values: Data) -> Channel {
    Channel { node, property: Property::Rotation, times, span: [0.0, last], values }
}

fn append_times(buffer: &mut impl Buffer, timeline: &Timeline) -> io::Result<Data> {
    let data = Data { offset: buffer.length(), count: timeline.len() as u64 };
    for chunk in 0..timeline.chunks() {
        let times: Vec<[u8; 4]> = timeline.chunk(chunk).1.into_iter().map(f32::to_le_bytes).collect();
        buffer.append(times.as_flattened())?;
    }
    Ok(data)
}

fn little_endian(rotations: &[[f32; 4]]) -> Vec<[u32; 4]> {
    rotations.iter().map(|q| q.map(|x| x.to_bits().to_le())).collect()
}

/// Rounded up to five significant digits: still an upper bound, and readable.
fn rounded_up(x: f64) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return x;
    }
    let unit = 10f64.powi(x.log10().floor() as i32 - 4);
    let units = (x / unit).ceil();
    // Decimal text rounds once more; the nearest number to it may lie below x.
    let rounded = format!("{units}e{}", unit.log10().round() as i32).parse().unwrap_or(x);
    if rounded < x { x } else { rounded }
}

fn too_fine(error: TooFine, clip: &Clip, source_name: &str) -> Error {
    let source_name = source_name.to_owned();
    match error {
        TooFine::Keys { key } => {
            let lines = (clip.lines.of(key), clip.lines.of(key + 1));
            let key_times = clip.duration() as f32 > 0.0;
            Error::KeysTooClose { source_name, lines, seconds: clip.times[key], key_times }
        }
        other => Error::TooFine(source_name, other),
    }
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

impl ClipFacts {
    /// The warning of steps that component-blending viewers show inexactly.
    pub fn warning(&self) -> Option<Warning> {
        let large: usize = self.tracks.iter().map(|track| track.steps.large).sum();
        let steps = self.tracks.iter().map(|track| track.steps).enumerate();
        let (index, Steps { worst, at, .. }) = steps.max_by(|a, b| a.1.worst.total_cmp(&b.1.worst))?;
        let count = if large == 1 { "1 step turns".to_owned() } else { format!("{large} steps turn") };
        (large > 0).then(|| {
            let message = format!(
                "clip {}: {count} by more than {}° from sample to sample, the largest by {worst:.1}° (box {}, \
                 t = {at:.3} s): Blender blends there and errs by about {:.2}°; a higher --fps helps",
                self.name,
                Steps::LARGE,
                index + 1,
                1.2e-6 * worst.powi(3)
            );
            Warning::new("LARGE_STEPS", message)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_up_stays_above() {
        for x in [1.234_567_8e-7, 0.1, 0.000_123_450_001, 9.999_99, 12345.6, 3e-320] {
            let up = rounded_up(x);
            assert!(up >= x && up <= x * (1.0 + 2e-4), "{x} {up}");
        }
        assert_eq!(rounded_up(0.012_345_1), 0.012_346);
        assert_eq!(rounded_up(0.0), 0.0);
    }
}

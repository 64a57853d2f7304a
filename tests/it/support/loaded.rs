//! glTF files as the `gltf` crate reads them: nothing here is the program's own.

use gltf::animation::Interpolation;
use gltf::animation::util::ReadOutputs;
use serde_json::Value;
use std::fs;
use std::path::Path;

pub(crate) struct Loaded {
    pub(crate) document: gltf::Document,
    pub(crate) buffers: Vec<Vec<u8>>,
    pub(crate) clips: Vec<Clip>,
}

pub(crate) struct Clip {
    pub(crate) name: String,
    pub(crate) extras: Value,
    pub(crate) channels: Vec<Channel>,
}

pub(crate) struct Channel {
    pub(crate) node: String,
    pub(crate) interpolation: Interpolation,
    /// Index of the accessor of times, and what it states.
    pub(crate) input: usize,
    pub(crate) min: Value,
    pub(crate) max: Value,
    pub(crate) times: Vec<f32>,
    /// x y z w.
    pub(crate) rotations: Vec<[f32; 4]>,
}

/// Reads a .glb, or a .gltf with its .bin.
pub(crate) fn load(path: &Path) -> Loaded {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let buffers = match gltf.blob {
        Some(blob) => vec![blob],
        None => gltf.document.buffers().map(|buffer| read_beside(path, buffer)).collect(),
    };
    let clips = gltf.document.animations().map(|animation| clip(&animation, &buffers)).collect();
    Loaded { document: gltf.document, buffers, clips }
}

fn read_beside(path: &Path, buffer: gltf::Buffer) -> Vec<u8> {
    let gltf::buffer::Source::Uri(uri) = buffer.source() else { panic!("a buffer without a URI") };
    let bytes = fs::read(path.with_file_name(decoded(uri))).unwrap();
    assert_eq!(bytes.len(), buffer.length());
    bytes
}

/// Percent-decoded, after RFC 3986.
pub(crate) fn decoded(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        let mut digit = || (rest.next().unwrap() as char).to_digit(16).unwrap() as u8;
        bytes.push(if byte == b'%' { 16 * digit() + digit() } else { byte });
    }
    String::from_utf8(bytes).unwrap()
}

fn clip(animation: &gltf::Animation, buffers: &[Vec<u8>]) -> Clip {
    let extras = animation.extras().as_ref();
    Clip {
        name: animation.name().unwrap().to_owned(),
        extras: extras.map_or(Value::Null, |extras| serde_json::from_str(extras.get()).unwrap()),
        channels: animation.channels().map(|each| channel(&each, buffers)).collect(),
    }
}

fn channel(channel: &gltf::animation::Channel, buffers: &[Vec<u8>]) -> Channel {
    let reader = channel.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let Some(ReadOutputs::Rotations(rotations)) = reader.read_outputs() else { panic!("not a rotation") };
    let input = channel.sampler().input();
    let bound = |value: Option<gltf::json::Value>| value.unwrap()[0].clone();
    Channel {
        node: channel.target().node().name().unwrap().to_owned(),
        interpolation: channel.sampler().interpolation(),
        input: input.index(),
        min: bound(input.min()),
        max: bound(input.max()),
        times: reader.read_inputs().unwrap().collect(),
        rotations: rotations.into_f32().collect(),
    }
}

impl Channel {
    /// The rotation at a time as glTF defines it: slerp the shorter way between samples,
    /// held before the first and after the last.
    pub(crate) fn play(&self, time: f64) -> [f64; 4] {
        let after = self.times.partition_point(|&t| f64::from(t) <= time);
        let stored = |i: usize| self.rotations[i].map(f64::from);
        if after == 0 || after == self.times.len() {
            return stored(after.saturating_sub(usize::from(after > 0)));
        }
        let (from, to) = (f64::from(self.times[after - 1]), f64::from(self.times[after]));
        slerp(stored(after - 1), stored(after), (time - from) / (to - from))
    }

    /// How fast the rotation changes around a time, degrees per second: the fastest of
    /// the intervals within two samples of it.
    pub(crate) fn speed(&self, time: f64) -> f64 {
        let near = self.times.partition_point(|&t| f64::from(t) < time);
        let from = near.saturating_sub(2);
        let to = (near + 2).min(self.times.len() - 1);
        let step = |i: usize| {
            let seconds = f64::from(self.times[i + 1]) - f64::from(self.times[i]);
            angle(self.rotations[i].map(f64::from), self.rotations[i + 1].map(f64::from)) / seconds
        };
        (from..to).map(step).fold(0.0, f64::max)
    }
}

fn slerp(a: [f64; 4], b: [f64; 4], u: f64) -> [f64; 4] {
    let dot: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let (dot, sign) = if dot < 0.0 { (-dot, -1.0) } else { (dot, 1.0) };
    let angle = dot.min(1.0).acos();
    let (p, q) = match angle.sin() {
        sine if sine < 1e-9 => (1.0 - u, u),
        sine => (((1.0 - u) * angle).sin() / sine, (u * angle).sin() / sine),
    };
    std::array::from_fn(|i| p * a[i] + q * sign * b[i])
}

/// The angle between two rotations given as x y z w, degrees; accurate when tiny.
pub(crate) fn angle(a: [f64; 4], b: [f64; 4]) -> f64 {
    let length = |q: [f64; 4]| q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let unit = |q: [f64; 4]| q.map(|x| x / length(q));
    let (a, b) = (unit(a), unit(b));
    let between = |sign: f64| length(std::array::from_fn(|i| a[i] - sign * b[i]));
    let chord = between(1.0).min(between(-1.0));
    4.0 * (chord / 2.0).clamp(0.0, 1.0).asin().to_degrees()
}

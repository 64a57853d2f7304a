//! Playing animations exactly as glTF 2.0 says (section 3.11, appendix C).
//!
//! LINEAR blends straight, rotations by slerp the shorter way; STEP holds;
//! CUBICSPLINE is Hermite's cubic, rotations normalised after it. Before the
//! first key and after the last the end keys hold. All in f64, from the
//! float32 numbers in the file.

use std::collections::HashMap;
use std::ops::Range;

use gltf::json::accessor::ComponentType;
pub use gltf::json::animation::{Interpolation, Property};
use gltf::json::validation::Checked;

use super::{Asset, Error, Shape};

/// One of the animations of a file.
#[derive(Clone, Debug)]
pub struct Clip {
    /// Its index in the file's `animations`.
    pub animation: usize,
    /// Its name, where it has one.
    pub name: Option<String>,
    /// The channels that can be played, in the file's order.
    pub channels: Vec<Channel>,
    /// The time of its last key, seconds; 0 without keys.
    pub duration: f64,
}

/// One property of one node over time.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its index in the animation's `channels`.
    pub index: usize,
    /// Index of the node that moves; it exists.
    pub node: usize,
    /// What of the node moves.
    pub property: Property,
    /// How values between keys are found.
    pub interpolation: Interpolation,
    /// Index of its sampler in the animation.
    pub sampler: usize,
    /// Index of the accessor of times.
    pub input: usize,
    /// Index of the accessor of values.
    pub output: usize,
    /// Number of keys; at least one.
    pub keys: usize,
    /// Numbers in a value: 3, 4 for rotations, the number of targets for
    /// morph weights.
    pub width: usize,
    times: Shape,
    values: Shape,
}

impl Channel {
    /// Numbers stored for a key: with CUBICSPLINE two tangents as well.
    pub fn stored_width(&self) -> usize {
        match self.interpolation {
            Interpolation::CubicSpline => 3 * self.width,
            _ => self.width,
        }
    }

    /// The type in which the values are stored.
    pub fn component(&self) -> ComponentType {
        self.values.component
    }

    /// The elements of the output accessor that belong to these keys.
    fn value_range(&self, keys: Range<usize>) -> Range<usize> {
        let elements = self.stored_width() / self.values.components;
        keys.start * elements..keys.end * elements
    }
}

impl Asset {
    /// The clips of the file. Channels that cannot be played (their node or
    /// sampler is missing, their data too short) are left out.
    pub fn clips(&mut self) -> Vec<Clip> {
        (0..self.root.animations.len()).map(|animation| self.clip(animation)).collect()
    }

    fn clip(&mut self, animation: usize) -> Clip {
        let count = self.root.animations[animation].channels.len();
        let channels: Vec<Channel> =
            (0..count).filter_map(|index| self.channel(animation, index).ok()).collect();
        let mut ends = HashMap::new();
        for channel in &channels {
            ends.entry(channel.input).or_insert_with(|| self.time(channel, channel.keys - 1).unwrap_or(0.0));
        }
        Clip {
            animation,
            name: self.root.animations[animation].name.clone(),
            channels,
            duration: ends.into_values().fold(0.0, f64::max),
        }
    }

    /// A channel, once all it refers to is known to exist.
    pub fn channel(&mut self, animation: usize, index: usize) -> Result<Channel, Error> {
        let pointer = format!("/animations/{animation}/channels/{index}");
        let wrong = |problem: &str| Error::data(pointer.clone(), problem);
        let missing = || wrong("there is no such channel");
        let stored = self.root.animations.get(animation).ok_or_else(missing)?;
        let channel = stored.channels.get(index).ok_or_else(missing)?;
        let (node, sampler) = (channel.target.node.value(), channel.sampler.value());
        let Checked::Valid(property) = channel.target.path else {
            return Err(wrong("its target's path is not one of glTF's"));
        };
        let Some(curve) = stored.samplers.get(sampler) else {
            return Err(wrong("its sampler does not exist"));
        };
        let Checked::Valid(interpolation) = curve.interpolation else {
            return Err(wrong("its sampler's interpolation is not one of glTF's"));
        };
        if node >= self.root.nodes.len() {
            return Err(wrong("its target's node does not exist"));
        }
        let (input, output) = (curve.input.value(), curve.output.value());
        let (times, values) = (self.shape(input)?, self.shape(output)?);
        let keys = times.count;
        let elements = match interpolation {
            Interpolation::CubicSpline => keys.checked_mul(3),
            _ => Some(keys),
        };
        let elements = elements.filter(|&n| n > 0 && times.components == 1);
        let elements = elements.ok_or_else(|| wrong("its times must be single numbers"))?;
        let (components, width) = match property {
            Property::MorphTargetWeights => (1, values.count / elements),
            Property::Rotation => (4, 4),
            Property::Translation | Property::Scale => (3, 3),
        };
        // Weights are stored one by one, a key's side by side.
        let per_key = width / components;
        if values.components != components
            || per_key == 0
            || elements.checked_mul(per_key) != Some(values.count)
        {
            return Err(wrong("its output does not hold one value for each key"));
        }
        Ok(Channel {
            index,
            node,
            property,
            interpolation,
            sampler,
            input,
            output,
            keys,
            width,
            times,
            values,
        })
    }

    /// The times of some keys of a channel, and what is stored for each:
    /// [`Channel::stored_width`] numbers.
    pub(crate) fn keys(
        &mut self,
        channel: &Channel,
        keys: Range<usize>,
    ) -> Result<(Vec<f32>, Vec<f32>), Error> {
        let (mut times, mut values) = (Vec::new(), Vec::new());
        self.floats_into(&channel.times, keys.clone(), &mut times)?;
        self.floats_into(&channel.values, channel.value_range(keys), &mut values)?;
        Ok((times, values))
    }

    /// The time of a key, seconds.
    fn time(&mut self, channel: &Channel, key: usize) -> Result<f64, Error> {
        let mut time = Vec::new();
        self.floats_into(&channel.times, key..key + 1, &mut time)?;
        Ok(f64::from(time[0]))
    }

    /// What is stored for some keys: values, or tangent, value, tangent.
    fn stored(&mut self, channel: &Channel, keys: Range<usize>) -> Result<Vec<f64>, Error> {
        let mut numbers = Vec::new();
        let range = channel.value_range(keys);
        self.floats_into(&channel.values, range, &mut numbers)?;
        Ok(numbers.into_iter().map(f64::from).collect())
    }
}

/// Evaluates channels at any time.
///
/// Times that channels share are read once; values only where they are
/// needed, so a long clip costs little.
#[derive(Debug, Default)]
pub struct Player {
    times: HashMap<usize, Vec<f32>>,
    /// The interval found last, and for what accessor and time.
    found: Option<(usize, f64, Interval)>,
}

/// Keys around a time.
#[derive(Clone, Copy, Debug)]
enum Interval {
    /// At a key, or outside of all: that key alone matters.
    Key(usize),
    /// Between a key at `start` and the next, `length` seconds later.
    Between { key: usize, start: f64, length: f64 },
}

/// Times kept in memory; longer accessors are searched in the file.
const TIMES_KEPT: usize = 1 << 22;

impl Player {
    /// A player that has read nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The channel's value at `t` seconds: x y z, x y z w, or the weights.
    pub fn value(&mut self, asset: &mut Asset, channel: &Channel, t: f64) -> Result<Vec<f64>, Error> {
        match self.interval(asset, channel, t)? {
            Interval::Key(key) => {
                let stored = asset.stored(channel, key..key + 1)?;
                Ok(at_key(channel, &stored).to_vec())
            }
            Interval::Between { key, start, length } => {
                let stored = asset.stored(channel, key..key + 2)?;
                let (from, to) = stored.split_at(channel.stored_width());
                Ok(between(channel, from, to, (t - start) / length, length))
            }
        }
    }

    fn interval(&mut self, asset: &mut Asset, channel: &Channel, t: f64) -> Result<Interval, Error> {
        match self.found {
            Some((input, time, interval)) if input == channel.input && time == t => Ok(interval),
            _ => {
                let interval = self.search(asset, channel, t)?;
                self.found = Some((channel.input, t, interval));
                Ok(interval)
            }
        }
    }

    /// Finds the last key at or before `t` by halving.
    fn search(&mut self, asset: &mut Asset, channel: &Channel, t: f64) -> Result<Interval, Error> {
        if channel.keys <= TIMES_KEPT && !self.times.contains_key(&channel.input) {
            let mut times = Vec::new();
            asset.floats_into(&channel.times, 0..channel.keys, &mut times)?;
            self.times.insert(channel.input, times);
        }
        let kept = self.times.get(&channel.input);
        let mut time = |key: usize| match kept {
            Some(times) => Ok(f64::from(times[key])),
            None => asset.time(channel, key),
        };
        let (mut low, mut high) = (0, channel.keys);
        while low < high {
            let middle = low + (high - low) / 2;
            if time(middle)? <= t {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        // `low` keys are at or before t.
        let Some(key) = low.checked_sub(1) else {
            return Ok(Interval::Key(0));
        };
        let start = time(key)?;
        if key + 1 == channel.keys || start == t {
            return Ok(Interval::Key(key));
        }
        let length = time(key + 1)? - start;
        Ok(Interval::Between { key, start, length })
    }
}

/// The value stored at a key, of one key's numbers.
pub fn at_key<'a, T>(channel: &Channel, stored: &'a [T]) -> &'a [T] {
    match channel.interpolation {
        Interpolation::CubicSpline => &stored[channel.width..2 * channel.width],
        _ => stored,
    }
}

/// The value a fraction `u` of the way between two keys `length` seconds
/// apart, of the numbers stored for each.
pub fn between(channel: &Channel, from: &[f64], to: &[f64], u: f64, length: f64) -> Vec<f64> {
    let mut value = Vec::with_capacity(channel.width);
    between_into(channel, (from, to), u, length, &mut value);
    value
}

/// [`between`] into `out`, which is cleared first.
pub(crate) fn between_into(
    channel: &Channel,
    (from, to): (&[f64], &[f64]),
    u: f64,
    length: f64,
    out: &mut Vec<f64>,
) {
    let rotation = channel.property == Property::Rotation;
    out.clear();
    match channel.interpolation {
        Interpolation::Step => out.extend(from),
        Interpolation::Linear if rotation => out.extend(slerp(four(from), four(to), u)),
        Interpolation::Linear => out.extend(from.iter().zip(to).map(|(a, b)| a + u * (b - a))),
        Interpolation::CubicSpline => {
            out.extend(hermite(channel.width, from, to, u, length));
            if rotation {
                let unit = normalized(four(out));
                out.copy_from_slice(&unit);
            }
        }
    }
}

/// The four numbers of a rotation; missing ones are zero.
pub(crate) fn four(q: &[f64]) -> [f64; 4] {
    std::array::from_fn(|i| q.get(i).copied().unwrap_or(0.0))
}

/// Spherical interpolation of unit quaternions, the shorter way round.
pub fn slerp(a: [f64; 4], b: [f64; 4], u: f64) -> [f64; 4] {
    Arc::new(a, b).at(u)
}

/// The shorter way from one rotation to another, made ready for any number of steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    from: [f64; 4],
    to: [f64; 4],
    /// Half the angle of the turn.
    angle: f64,
    sine: f64,
}

impl Arc {
    /// The angle comes from the chord, |a − b| = 2 sin(φ/2), which is accurate
    /// for near and for far quaternions alike; a cosine is not for near ones.
    pub(crate) fn new(a: [f64; 4], b: [f64; 4]) -> Arc {
        let sign = if dot(a, b) < 0.0 { -1.0 } else { 1.0 };
        let b = b.map(|x| sign * x);
        let length = |f: fn(f64, f64) -> f64| {
            let v: [f64; 4] = std::array::from_fn(|i| f(a[i], b[i]));
            dot(v, v).sqrt()
        };
        let angle = 2.0 * libm::atan2(length(|x, y| x - y), length(|x, y| x + y));
        Arc { from: a, to: b, angle, sine: libm::sin(angle) }
    }

    /// The rotation a fraction `u` of the way.
    pub(crate) fn at(&self, u: f64) -> [f64; 4] {
        let Arc { from, to, angle, sine } = *self;
        // Below this, sin(uφ)/sin φ differs from u by less than an f64's last bit.
        let (p, q) = if angle < 1e-8 {
            (1.0 - u, u)
        } else {
            (libm::sin((1.0 - u) * angle) / sine, libm::sin(u * angle) / sine)
        };
        std::array::from_fn(|i| p * from[i] + q * to[i])
    }
}

/// Hermite's cubic between two keys, each stored as tangent in, value,
/// tangent out; tangents are per second.
fn hermite<'a>(
    width: usize,
    from: &'a [f64],
    to: &'a [f64],
    u: f64,
    length: f64,
) -> impl Iterator<Item = f64> + 'a {
    let (u2, u3) = (u * u, u * u * u);
    (0..width).map(move |i| {
        let (value, tangent_out) = (from[width + i], from[2 * width + i]);
        let (tangent_in, next) = (to[i], to[width + i]);
        (2.0 * u3 - 3.0 * u2 + 1.0) * value
            + length * (u3 - 2.0 * u2 + u) * tangent_out
            + (3.0 * u2 - 2.0 * u3) * next
            + length * (u3 - u2) * tangent_in
    })
}

/// The unit quaternion of the same direction; zero stays zero.
fn normalized(q: [f64; 4]) -> [f64; 4] {
    let length = dot(q, q).sqrt();
    if length > 0.0 { q.map(|x| x / length) } else { q }
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Goes through all keys of a channel from first to last, a block at a time.
#[derive(Debug)]
pub struct Keys<'a> {
    channel: &'a Channel,
    /// The keys that `times` and `values` hold.
    range: Range<usize>,
    times: Vec<f32>,
    values: Vec<f32>,
}

/// Some keys in a row.
#[derive(Clone, Copy, Debug)]
pub struct Block<'a> {
    /// The number of the first of them.
    pub first: usize,
    /// Their times, seconds.
    pub times: &'a [f32],
    /// What is stored for each: [`Channel::stored_width`] numbers.
    pub values: &'a [f32],
}

impl<'a> Keys<'a> {
    /// Starts before the first key.
    pub fn new(channel: &'a Channel) -> Self {
        Keys { channel, range: 0..0, times: Vec::new(), values: Vec::new() }
    }

    /// The next keys; `None` after the last.
    pub fn next(&mut self, asset: &mut Asset) -> Result<Option<Block<'_>>, Error> {
        self.read(asset)?;
        Ok(self.block())
    }

    /// Reads the next keys.
    pub(crate) fn read(&mut self, asset: &mut Asset) -> Result<(), Error> {
        const NUMBERS: usize = 1 << 16;
        let (channel, first) = (self.channel, self.range.end);
        let count = (NUMBERS / channel.stored_width()).max(1);
        let range = first..channel.keys.min(first.saturating_add(count));
        asset.floats_into(&channel.times, range.clone(), &mut self.times)?;
        let values = channel.value_range(range.clone());
        asset.floats_into(&channel.values, values, &mut self.values)?;
        self.range = range;
        Ok(())
    }

    /// The keys read last, if any were left.
    pub(crate) fn block(&self) -> Option<Block<'_>> {
        (!self.range.is_empty()).then_some(Block {
            first: self.range.start,
            times: &self.times,
            values: &self.values,
        })
    }
}

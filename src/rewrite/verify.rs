//! How far two files' playback is apart, from what a player shows: a check that knows
//! nothing of how the second was made.

use crate::asset::play::{Channel, Property, at_key, between};
use crate::asset::{Asset, Error};
use crate::math::Quat;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::{Range, RangeInclusive};

/// Distances of playback.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Strayed {
    /// Of rotations, degrees.
    pub degrees: f64,
    /// Of translations, units.
    pub units: f64,
    /// Of scales.
    pub scale: f64,
    /// Of weights of morph targets.
    pub weight: f64,
}

impl Strayed {
    pub(super) fn note(&mut self, property: Property, distance: f64) {
        let worst = match property {
            Property::Rotation => &mut self.degrees,
            Property::Translation => &mut self.units,
            Property::Scale => &mut self.scale,
            Property::MorphTargetWeights => &mut self.weight,
        };
        *worst = worst.max(distance);
    }

    /// The larger of both, each by itself.
    pub fn max(self, other: Strayed) -> Strayed {
        Strayed {
            degrees: self.degrees.max(other.degrees),
            units: self.units.max(other.units),
            scale: self.scale.max(other.scale),
            weight: self.weight.max(other.weight),
        }
    }
}

/// Times looked at between two neighbouring keys of either file.
const BETWEEN: u32 = 3;
/// Intervals of the input that are looked at in one run.
const RUN: usize = 16;
/// Runs that are looked at; of a longer channel these are evenly chosen.
const RUNS: usize = 256;

/// The largest distances between the playback of a file and of the same with fewer keys,
/// clip by clip and channel by channel; looked for at the keys of both and between them,
/// of very many in stretches that are evenly chosen.
pub fn strayed(before: &mut Asset, after: &mut Asset) -> Result<Strayed, Error> {
    let (old, new) = (before.clips(), after.clips());
    let mut worst = Strayed::default();
    if old.len() != new.len() {
        return Err(Error::data("/animations", format!("has {} clips instead of {}", new.len(), old.len())));
    }
    for (old, new) in old.iter().zip(&new) {
        let pointer = format!("/animations/{}", old.animation);
        if old.channels.len() != new.channels.len() || old.duration != new.duration {
            return Err(Error::data(
                pointer,
                "has other channels, or lasts for another time, than the input's",
            ));
        }
        for (a, b) in old.channels.iter().zip(&new.channels) {
            let distance = channels((before, a), (after, b))?;
            worst.note(a.property, distance);
        }
    }
    Ok(worst)
}

fn channels((before, a): (&mut Asset, &Channel), (after, b): (&mut Asset, &Channel)) -> Result<f64, Error> {
    let old = before.floats(a.input, 0..a.keys)?;
    let new = after.floats(b.input, 0..b.keys)?;
    // What is left as it is may not even be in order.
    let same = old.iter().map(|t| t.to_bits()).eq(new.iter().map(|t| t.to_bits()));
    let count = (a.keys - 1).div_ceil(RUN).max(1);
    let every = count.div_ceil(RUNS);
    let mut runs = Vec::with_capacity(count.min(RUNS) + 1);
    for run in (0..count).filter(|&run| run % every == 0 || run + 1 == count) {
        let keys = run * RUN..a.keys.min((run + 1) * RUN + 1);
        // The first and the last take all that the other file has before and after.
        let first = if run == 0 { f32::NEG_INFINITY } else { old[keys.start] };
        let last = if run + 1 == count { f32::INFINITY } else { old[keys.end - 1] };
        let from = new.partition_point(|&time| time <= first).saturating_sub(1);
        let to = (new.partition_point(|&time| time < last) + 1).min(b.keys);
        let others = if same { keys.clone() } else { from.min(to - 1)..to };
        runs.push((first..=last, Keys::read(before, a, keys)?, Keys::read(after, b, others)?));
    }
    Ok(runs.par_iter().map(|(span, old, new)| apart(span, old, new)).reduce(|| 0.0, f64::max))
}

/// The largest distance within a span that is found at the keys of both and between them.
fn apart(span: &RangeInclusive<f32>, old: &Keys, new: &Keys) -> f64 {
    let mut times = [&old.times[..], &new.times].concat();
    times.retain(|time| span.contains(time));
    times.sort_by(f32::total_cmp);
    times.dedup();
    let at = |t: f64| distance(old.channel.property, &old.value(t), &new.value(t));
    let mut worst = times.last().map_or(0.0, |&last| at(f64::from(last)));
    for pair in times.windows(2) {
        let (from, to) = (f64::from(pair[0]), f64::from(pair[1]));
        for i in 0..=BETWEEN {
            worst = f64::max(worst, at(from + (to - from) * f64::from(i) / f64::from(BETWEEN + 1)));
        }
    }
    worst
}

/// Some keys of a channel in a row.
struct Keys<'a> {
    channel: &'a Channel,
    times: Vec<f32>,
    stored: Vec<f32>,
}

impl<'a> Keys<'a> {
    fn read(asset: &mut Asset, channel: &'a Channel, keys: Range<usize>) -> Result<Keys<'a>, Error> {
        let (times, stored) = asset.keys(channel, keys)?;
        Ok(Keys { channel, times, stored })
    }

    /// What is stored for a key.
    fn key(&self, key: usize) -> Vec<f64> {
        let width = self.channel.stored_width();
        self.stored[key * width..(key + 1) * width].iter().copied().map(f64::from).collect()
    }

    /// What a player shows; before all keys and after them the first and the last.
    fn value(&self, t: f64) -> Vec<f64> {
        let after = self.times.partition_point(|&time| f64::from(time) <= t);
        let key = after.saturating_sub(1);
        let from = f64::from(self.times[key]);
        if after == 0 || after == self.times.len() || from == t {
            return at_key(self.channel, &self.key(key)).to_vec();
        }
        let length = f64::from(self.times[after]) - from;
        between(self.channel, &self.key(key), &self.key(after), (t - from) / length, length)
    }
}

fn distance(property: Property, a: &[f64], b: &[f64]) -> f64 {
    let off = || a.iter().zip(b).map(|(a, b)| (a - b).abs());
    match property {
        Property::Rotation => {
            let quat = |q: &[f64]| Quat::from_xyzw(std::array::from_fn(|i| q.get(i).copied().unwrap_or(0.0)));
            let unit = |q: Quat| {
                let scale = 1.0 / q.norm();
                Quat { w: q.w * scale, v: q.v * scale }
            };
            unit(quat(a)).angle_to(unit(quat(b))).to_degrees()
        }
        Property::MorphTargetWeights => off().fold(0.0, f64::max),
        _ => off().map(|d| d * d).sum::<f64>().sqrt(),
    }
}

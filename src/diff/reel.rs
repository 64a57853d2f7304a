//! A channel's keys, a window of time in memory at once.

use crate::asset::play::{Arc, Channel, Interpolation, Property, at_key, between_into, four};
use crate::asset::{Asset, Error};

/// The keys around a stretch of time.
#[derive(Debug)]
pub(super) struct Reel {
    pub(super) channel: Channel,
    /// JSON pointer to the channel, for messages.
    pointer: String,
    /// Number of the first key in memory.
    first: usize,
    times: Vec<f64>,
    /// What is stored for each of them.
    stored: Vec<f64>,
}

/// What a channel does from one key of any channel to the next.
#[derive(Clone, Copy, Debug)]
pub(super) enum Span<'a> {
    /// It stays at a value.
    Held(&'a [f64]),
    /// It turns from one of its keys to the next at an even speed.
    Turning { arc: Arc, start: f64, length: f64 },
    /// It is on any other way between two of its keys.
    Moving { stored: (&'a [f64], &'a [f64]), start: f64, length: f64 },
}

impl Reel {
    pub(super) fn new(animation: usize, channel: Channel) -> Reel {
        let pointer = format!("/animations/{animation}/channels/{}", channel.index);
        Reel { channel, pointer, first: 0, times: Vec::new(), stored: Vec::new() }
    }

    /// The times in memory.
    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Until when the keys in memory tell the value; None where that is for ever.
    pub(super) fn known_until(&self) -> Option<f64> {
        let all = self.first + self.times.len() == self.channel.keys;
        if all { None } else { Some(self.times.last().copied().unwrap_or(f64::NEG_INFINITY)) }
    }

    /// Forgets the keys that play no part from `time` on, and reads on until there are
    /// at least `count` keys after it, or no more in the file.
    pub(super) fn wind(&mut self, asset: &mut Asset, time: f64, count: usize) -> Result<(), Error> {
        let width = self.channel.stored_width();
        let past = self.times.partition_point(|&t| t <= time).saturating_sub(1);
        self.times.drain(..past);
        self.stored.drain(..past * width);
        self.first += past;
        if self.times.len() <= count {
            self.read(asset, count)?;
        }
        Ok(())
    }

    fn read(&mut self, asset: &mut Asset, count: usize) -> Result<(), Error> {
        let from = self.first + self.times.len();
        let to = self.channel.keys.min(from.saturating_add(count));
        let (times, values) = asset.keys(&self.channel, from..to)?;
        let wrong = |problem: String| Error::data(self.pointer.clone(), problem);
        for (key, &time) in (from..).zip(&times) {
            let time = f64::from(time);
            let rises = self.times.last().is_none_or(|&last| last < time);
            if !(time.is_finite() && rises) {
                return Err(wrong(format!(
                    "its times must rise from key to key, and that of key {key} is {time} s"
                )));
            }
            self.times.push(time);
        }
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            let key = from + at / self.channel.stored_width();
            return Err(wrong(format!("expected finite numbers, found {} in key {key}", values[at])));
        }
        self.stored.extend(values.into_iter().map(f64::from));
        Ok(())
    }

    /// What it does from `time` on until its next key; at a key that is what follows.
    pub(super) fn span(&self, time: f64) -> Span<'_> {
        let after = self.times.partition_point(|&t| t <= time);
        let width = self.channel.stored_width();
        let stored = |key: usize| &self.stored[key * width..(key + 1) * width];
        let Some(key) = after.checked_sub(1) else {
            return Span::Held(at_key(&self.channel, stored(0)));
        };
        if after == self.times.len() {
            return Span::Held(at_key(&self.channel, stored(key)));
        }
        let start = self.times[key];
        let (length, stored) = (self.times[after] - start, (stored(key), stored(after)));
        match (self.channel.interpolation, self.channel.property) {
            (Interpolation::Step, _) => Span::Held(stored.0),
            (Interpolation::Linear, Property::Rotation) => {
                Span::Turning { arc: Arc::new(four(stored.0), four(stored.1)), start, length }
            }
            _ => Span::Moving { stored, start, length },
        }
    }

    /// The value at a time within a span; at the span's end what comes up to there.
    pub(super) fn value(&self, span: Span, time: f64, out: &mut Vec<f64>) {
        match span {
            Span::Held(value) => {
                out.clear();
                out.extend(value);
            }
            Span::Turning { arc, start, length } => {
                out.clear();
                out.extend(arc.at((time - start) / length));
            }
            Span::Moving { stored, start, length } => {
                between_into(&self.channel, stored, (time - start) / length, length, out);
            }
        }
    }
}

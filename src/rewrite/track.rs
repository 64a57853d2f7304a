//! The keys of one sampler, as the file plays them.

use crate::asset::play::{Channel, Interpolation, Keys, Property};
use crate::asset::{Asset, Error as AssetError};
use gltf::json::accessor::ComponentType;

/// A sampler, and how much it holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampler {
    pub(super) animation: usize,
    pub(super) sampler: usize,
    /// What its channels move; the same for all of them.
    pub(super) property: Property,
    pub(super) input: usize,
    pub(super) output: usize,
    pub(super) keys: usize,
    /// The time of its last key.
    pub(super) last: f32,
    /// Bytes of its values.
    pub(super) bytes: usize,
}

/// A sampler's keys in memory.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) sampler: Sampler,
    pub(super) property: Property,
    pub(super) interpolation: Interpolation,
    pub(super) times: Vec<f32>,
    /// Values, or tangent, value, tangent, of each key; normalised integers as fractions.
    pub(super) values: Vec<f32>,
    /// Numbers in a value.
    pub(super) width: usize,
    pub(super) stored: Stored,
}

/// How a file holds numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stored {
    pub(super) component: ComponentType,
    pub(super) normalized: bool,
}

impl Stored {
    pub(super) const FLOATS: Stored = Stored { component: ComponentType::F32, normalized: false };

    /// The numbers as bytes: what these are read from again, for numbers that were read
    /// from such bytes.
    pub(super) fn bytes(self, numbers: &[f32]) -> Vec<u8> {
        let top = match (self.component, self.normalized) {
            (_, false) | (ComponentType::F32, _) => 1.0,
            (ComponentType::I8, true) => 127.0,
            (ComponentType::U8, true) => 255.0,
            (ComponentType::I16, true) => 32767.0,
            (ComponentType::U16, true) => 65535.0,
            (ComponentType::U32, true) => f64::from(u32::MAX),
        };
        if self.component == ComponentType::F32 {
            let mut bytes = vec![0; 4 * numbers.len()];
            for (place, x) in bytes.as_chunks_mut().0.iter_mut().zip(numbers) {
                *place = x.to_le_bytes();
            }
            return bytes;
        }
        let mut bytes = Vec::with_capacity(numbers.len() * self.component.size());
        for &x in numbers {
            // Casts round towards what fits.
            let whole = (f64::from(x) * top).round();
            match self.component {
                ComponentType::F32 => bytes.extend(x.to_le_bytes()),
                ComponentType::I8 => bytes.extend((whole as i8).to_le_bytes()),
                ComponentType::U8 => bytes.extend((whole as u8).to_le_bytes()),
                ComponentType::I16 => bytes.extend((whole as i16).to_le_bytes()),
                ComponentType::U16 => bytes.extend((whole as u16).to_le_bytes()),
                ComponentType::U32 => bytes.extend((whole as u32).to_le_bytes()),
            }
        }
        bytes
    }
}

impl Track {
    /// Reads a sampler that only channels which can be played use, all for the same
    /// property; none if there is nothing to reduce or its keys cannot be told in order.
    pub(super) fn read(
        asset: &mut Asset,
        animation: usize,
        sampler: usize,
    ) -> Result<Option<Track>, AssetError> {
        let channels = &asset.root().animations[animation].channels;
        let users: Vec<usize> =
            (0..channels.len()).filter(|&c| channels[c].sampler.value() == sampler).collect();
        let mut found: Option<Channel> = None;
        for index in users {
            let Ok(channel) = asset.channel(animation, index) else { return Ok(None) };
            if found.as_ref().is_some_and(|other| other.property != channel.property) {
                return Ok(None);
            }
            found = Some(channel);
        }
        let Some(channel) = found else { return Ok(None) };
        let normalized = asset.root().accessors.get(channel.output).is_some_and(|a| a.normalized);
        let (property, input, output) = (channel.property, channel.input, channel.output);
        let numbers = channel.keys * channel.stored_width();
        let bytes = numbers * channel.component().size();
        let sampler =
            Sampler { animation, sampler, property, input, output, keys: channel.keys, last: 0.0, bytes };
        let mut track = Track {
            sampler,
            property,
            interpolation: channel.interpolation,
            times: Vec::with_capacity(channel.keys),
            values: Vec::with_capacity(numbers),
            width: channel.width,
            stored: Stored { component: channel.component(), normalized },
        };
        let mut keys = Keys::new(&channel);
        while let Some(block) = keys.next(asset)? {
            track.times.extend_from_slice(block.times);
            track.values.extend_from_slice(block.values);
        }
        track.sampler.last = track.times.last().copied().unwrap_or(0.0);
        Ok(track.is_sound().then_some(track))
    }

    fn is_sound(&self) -> bool {
        let ordered = self.times.windows(2).all(|t| t[0] < t[1]) && self.times.len() > 1;
        let finite = self.times.iter().chain(&self.values).all(|x| x.is_finite());
        // Whatever a player makes of these, it is no rotation.
        let turns = self.property != Property::Rotation
            || (0..self.times.len()).all(|k| self.quat(k).iter().map(|x| x * x).sum::<f64>() > 0.25);
        ordered && finite && turns
    }

    /// Bytes of times and values.
    pub(super) fn bytes(&self) -> usize {
        4 * self.times.len() + self.sampler.bytes
    }

    /// Numbers stored for a key.
    pub(super) fn stored_width(&self) -> usize {
        self.values.len() / self.times.len()
    }

    pub(super) fn is_cubic(&self) -> bool {
        self.interpolation == Interpolation::CubicSpline
    }

    pub(super) fn time(&self, key: usize) -> f64 {
        f64::from(self.times[key])
    }

    /// All that is stored for a key.
    pub(super) fn key(&self, key: usize) -> &[f32] {
        let width = self.stored_width();
        &self.values[key * width..(key + 1) * width]
    }

    /// The value of a key.
    pub(super) fn value(&self, key: usize) -> &[f32] {
        let from = if self.is_cubic() { self.width } else { 0 };
        &self.key(key)[from..from + self.width]
    }

    /// One number of a key's value.
    pub(super) fn number(&self, key: usize, number: usize) -> f64 {
        f64::from(self.value(key)[number])
    }

    /// The rotation of a key, x y z w.
    pub(super) fn quat(&self, key: usize) -> [f64; 4] {
        std::array::from_fn(|i| self.value(key).get(i).map_or(0.0, |&x| f64::from(x)))
    }

    /// Of one number: the tangent out of a key and the one into the next, per second;
    /// none where the way is straight.
    pub(super) fn tangents(&self, key: usize, number: usize) -> Option<(f64, f64)> {
        let out = |key: usize| f64::from(self.key(key)[2 * self.width + number]);
        let into = |key: usize| f64::from(self.key(key)[number]);
        self.is_cubic().then(|| (out(key), into(key + 1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_found_again() {
        for (component, top) in [(ComponentType::I8, 127), (ComponentType::I16, 32767)] {
            let stored = Stored { component, normalized: true };
            for code in [-top, -top + 1, -3, 0, 1, 77, top] {
                let number = code as f32 / top as f32;
                let bytes = stored.bytes(&[number]);
                let read = match component {
                    ComponentType::I8 => i32::from(i8::from_le_bytes([bytes[0]])),
                    _ => i32::from(i16::from_le_bytes([bytes[0], bytes[1]])),
                };
                assert_eq!(read, code);
            }
        }
        let stored = Stored { component: ComponentType::U16, normalized: true };
        let all: Vec<f32> = (0..=u16::MAX).map(|code| f32::from(code) / 65535.0).collect();
        let codes: Vec<u8> = (0..=u16::MAX).flat_map(u16::to_le_bytes).collect();
        assert_eq!(stored.bytes(&all), codes);
    }
}

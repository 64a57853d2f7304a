//! Files taken apart, changed and put together again.

use serde_json::Value;
use std::fs;
use std::path::Path;

/// A .glb taken apart.
pub(crate) struct Glb {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl Glb {
    pub(crate) fn read(path: &Path) -> Glb {
        let bytes = fs::read(path).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let json = word(12);
        Glb {
            json: serde_json::from_slice(&bytes[20..20 + json]).unwrap(),
            bin: bytes[28 + json..][..word(20 + json)].to_vec(),
        }
    }

    pub(crate) fn write(&self, path: &Path) {
        let mut json = serde_json::to_vec(&self.json).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let word = |n: usize| (n as u32).to_le_bytes();
        let total = 28 + json.len() + self.bin.len();
        let head = [*b"glTF", word(2), word(total), word(json.len()), *b"JSON"].concat();
        let middle = [word(self.bin.len()), *b"BIN\0"].concat();
        fs::write(path, [head, json, middle, self.bin.clone()].concat()).unwrap();
    }

    /// Where the numbers of an accessor begin in the binary chunk.
    fn offset(&self, accessor: usize) -> usize {
        let accessor = &self.json["accessors"][accessor];
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let at = |value: &Value| value["byteOffset"].as_u64().unwrap_or(0) as usize;
        at(accessor) + at(view)
    }

    /// Sample `index` of a channel's rotations.
    pub(crate) fn rotation(&mut self, channel: usize, index: usize) -> &mut [u8] {
        let animation = &self.json["animations"][0];
        let sampler = animation["channels"][channel]["sampler"].as_u64().unwrap() as usize;
        let output = animation["samplers"][sampler]["output"].as_u64().unwrap() as usize;
        let start = self.offset(output) + 16 * index;
        &mut self.bin[start..start + 16]
    }
}

/// Turns a rotation (x y z w) by some degrees about x, in place.
pub(crate) fn turn(stored: &mut [u8], degrees: f64) {
    let [x, y, z, w]: [f64; 4] =
        std::array::from_fn(|i| f64::from(f32::from_le_bytes(stored[4 * i..4 * i + 4].try_into().unwrap())));
    let (s, c) = (degrees.to_radians() / 2.0).sin_cos();
    let turned = [x * c + w * s, y * c + z * s, z * c - y * s, w * c - x * s];
    for (place, number) in stored.chunks_exact_mut(4).zip(turned) {
        place.copy_from_slice(&(number as f32).to_le_bytes());
    }
}

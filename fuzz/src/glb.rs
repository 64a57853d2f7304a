//! Mutations of a `.glb` that leave its container sound.

use super::dice::Dice;
use super::json;

/// A `.glb` taken apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// The JSON's text.
    pub json: Vec<u8>,
    /// The binary chunk, if there is one.
    pub bin: Option<Vec<u8>>,
}

/// Changes the file in `data[..size]` in place and returns its new size, at most that of
/// `data`. Now and then the container itself is changed. `bytes` mutates bytes in place as
/// this function does.
pub fn mutate(
    data: &mut [u8],
    size: usize,
    seed: u32,
    mut bytes: impl FnMut(&mut [u8], usize) -> usize,
) -> usize {
    let mut dice = Dice::new(u64::from(seed));
    let limit = data.len();
    let parts = Parts::of(&data[..size]).filter(|_| !dice.one_in(16));
    let Some(mut parts) = parts else { return bytes(data, size) };
    match (dice.below(8), &mut parts.bin) {
        (0, _) => resized(&mut parts.json, limit, &mut bytes),
        (1 | 2, Some(bin)) => resized(bin, limit, &mut bytes),
        (3, bin @ None) => *bin = Some(vec![0; 4 * dice.below(64)]),
        _ => json::mutate(&mut parts.json, &mut dice),
    }
    let whole = parts.whole();
    match data.get_mut(..whole.len()) {
        Some(room) => {
            room.copy_from_slice(&whole);
            whole.len()
        }
        None => bytes(data, size),
    }
}

/// Mutates bytes that may grow to about `limit`.
fn resized(part: &mut Vec<u8>, limit: usize, bytes: &mut impl FnMut(&mut [u8], usize) -> usize) {
    let size = part.len();
    part.resize((size + size / 4 + 64).min(limit.max(size)), 0);
    let size = bytes(part, size);
    part.truncate(size);
}

impl Parts {
    /// The parts of a file whose first chunk is JSON, or of plain JSON.
    pub fn of(file: &[u8]) -> Option<Parts> {
        if file.first() == Some(&b'{') {
            return Some(Parts { json: file.to_vec(), bin: None });
        }
        let rest = file.strip_prefix(b"glTF")?.get(8..)?;
        let (kind, json, rest) = chunk(rest)?;
        let bin = chunk(rest).filter(|(kind, ..)| kind == b"BIN\0").map(|(_, bin, _)| bin.to_vec());
        (kind == b"JSON").then(|| Parts { json: json.trim_ascii_end().to_vec(), bin })
    }

    /// The file with lengths and padding as they must be.
    pub fn whole(&self) -> Vec<u8> {
        let mut file = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        append(&mut file, b"JSON", &self.json, b' ');
        if let Some(bin) = &self.bin {
            append(&mut file, b"BIN\0", bin, 0);
        }
        let length = (file.len() as u32).to_le_bytes();
        file[8..12].copy_from_slice(&length);
        file
    }
}

/// A chunk's type, its data as far as there is any, and what follows.
fn chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let (kind, rest) = rest.split_at_checked(4)?;
    let (data, rest) = rest.split_at((u32::from_le_bytes(*length) as usize).min(rest.len()));
    Some((kind, data, rest))
}

fn append(file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8], padding: u8) {
    let length = data.len().next_multiple_of(4);
    file.extend((length as u32).to_le_bytes());
    file.extend(kind);
    file.extend(data);
    file.resize(file.len() + length - data.len(), padding);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_become_whole_again() {
        for bin in [None, Some(vec![1, 2, 3, 4])] {
            let parts = Parts { json: b"{\"a\":1}".to_vec(), bin };
            let whole = parts.whole();
            assert_eq!(whole.len() % 4, 0);
            assert_eq!(whole[8..12], (whole.len() as u32).to_le_bytes());
            assert_eq!(Parts::of(&whole), Some(parts));
        }
    }

    #[test]
    fn most_mutations_keep_the_container() {
        let whole =
            Parts { json: b"{\"nodes\":[{\"mesh\":0}],\"n\":3}".to_vec(), bin: Some(vec![0; 8]) }.whole();
        let mut kept = 0;
        for seed in 0..256 {
            let mut data = [0; 4096];
            data[..whole.len()].copy_from_slice(&whole);
            let size = mutate(&mut data, whole.len(), seed, |_, size| size / 2);
            let file = &data[..size];
            kept += usize::from(file.get(8..12) == Some(&(size as u32).to_le_bytes()));
        }
        assert!(kept > 192, "{kept}");
    }
}

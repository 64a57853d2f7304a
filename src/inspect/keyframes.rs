//! What a keyframe file holds: keys, span, rate, gaps, turns.

use crate::clip::{Body, Clip, Warning};
use crate::read::Keyframes;
use serde::Serialize;
use std::fmt;

/// What a keyframe file holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct KeyframesSummary {
    /// Always `keyframes`.
    pub kind: &'static str,
    /// Number of boxes; 1 for a free body.
    pub boxes: usize,
    /// Length of a box; none for a free body.
    pub length: Option<f64>,
    /// The order in which quaternions' parts were read.
    pub quat_order: &'static str,
    /// Number of keys.
    pub keys: usize,
    /// Time of the first key as the file gives it, seconds.
    pub start: f64,
    /// Time from the first key to the last, seconds.
    pub seconds: f64,
    /// Keys per second where they are even: one by the median interval.
    pub keys_per_second: f64,
    /// The shortest time between neighbouring keys.
    pub shortest_gap: Place,
    /// The longest time between neighbouring keys.
    pub longest_gap: Place,
    /// The largest turn between neighbouring keys, degrees.
    pub largest_turn: Place,
    /// How far from 1 the length of the worst quaternion is.
    pub largest_norm_error: f64,
    /// Bytes of the file.
    pub bytes: u64,
    /// BLAKE3 hash of the file.
    pub blake3: String,
    /// What is odd about it.
    pub warnings: Vec<Warning>,
}

/// A largest or smallest value, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Place {
    /// Seconds, or degrees.
    pub value: f64,
    /// The line of the key after it.
    pub line: usize,
    /// The box, from 1; 0 where it concerns all.
    #[serde(rename = "box")]
    pub index: usize,
}

/// Says what a keyframe file holds.
pub fn keyframes(keyframes: &Keyframes) -> KeyframesSummary {
    let clip = &keyframes.clip;
    let mut gaps: Vec<f64> = clip.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let place = |i: usize| Place { value: gaps[i], line: clip.lines.of(i + 1), index: 0 };
    let by_length = |&a: &usize, &b: &usize| gaps[a].total_cmp(&gaps[b]);
    let shortest_gap = (0..gaps.len()).min_by(by_length).map(place).unwrap_or_default();
    let longest_gap = (0..gaps.len()).max_by(by_length).map(place).unwrap_or_default();
    gaps.sort_by(f64::total_cmp);
    KeyframesSummary {
        kind: "keyframes",
        boxes: clip.tracks.len(),
        length: match clip.body {
            Body::Chain { length } => Some(length),
            Body::Free => None,
        },
        quat_order: keyframes.order.name(),
        keys: clip.times.len(),
        start: clip.start,
        seconds: clip.duration(),
        keys_per_second: 1.0 / gaps[gaps.len() / 2],
        shortest_gap,
        longest_gap,
        largest_turn: largest_turn(clip),
        largest_norm_error: keyframes.largest_norm_error,
        bytes: keyframes.bytes,
        blake3: keyframes.hash.clone(),
        warnings: keyframes.warnings.clone(),
    }
}

fn largest_turn(clip: &Clip) -> Place {
    let mut largest = Place { value: -1.0, ..Place::default() };
    for (index, keys) in clip.tracks.iter().enumerate() {
        for (i, pair) in keys.windows(2).enumerate() {
            let value = pair[0].angle_to(pair[1]).to_degrees();
            if value > largest.value {
                largest = Place { value, line: clip.lines.of(i + 1), index: index + 1 };
            }
        }
    }
    largest
}

impl fmt::Display for KeyframesSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let KeyframesSummary { boxes, keys, bytes, quat_order, .. } = self;
        match self.length {
            Some(length) => {
                writeln!(f, "keyframes of a chain, {bytes} bytes\nboxes: {boxes}, each {length} long")?
            }
            None => writeln!(f, "keyframes of a free body, {bytes} bytes")?,
        }
        writeln!(f, "component order: {quat_order}")?;
        writeln!(f, "keys: {keys}, from {} s, {} s long", self.start, digits(self.seconds))?;
        writeln!(f, "rate: about {} keys per second", digits(self.keys_per_second))?;
        for (name, gap) in [("shortest", self.shortest_gap), ("longest", self.longest_gap)] {
            writeln!(f, "{name} gap: {} s (before line {})", digits(gap.value), gap.line)?;
        }
        let Place { value, line, index } = self.largest_turn;
        writeln!(f, "largest turn: {}° (box {index}, to line {line})", digits(value))?;
        writeln!(f, "largest norm error: {:.1e}", self.largest_norm_error)?;
        writeln!(f, "BLAKE3: {}", self.blake3)?;
        for Warning { code, message } in &self.warnings {
            writeln!(f, "warning: {message} [{code}]")?;
        }
        Ok(())
    }
}

/// A number to six significant digits, without the zeros at its end.
fn digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_what_is_there() {
        let text = "# 2 1.5\n3 1 0 0 0 1 0 0 0\n\n3.5 1 0 0 0 0 1 0 0\n4.75 1 0 0 0 0 1.01 0 0\n";
        let read = crate::read::keyframes("x.dat", text.as_bytes(), None).unwrap();
        let summary = keyframes(&read);
        assert_eq!((summary.boxes, summary.length, summary.keys), (2, Some(1.5), 3));
        assert_eq!((summary.start, summary.seconds), (3.0, 1.75));
        assert_eq!(summary.shortest_gap, Place { value: 0.5, line: 4, index: 0 });
        assert_eq!(summary.longest_gap, Place { value: 1.25, line: 5, index: 0 });
        assert!((summary.largest_turn.value - 180.0).abs() < 1e-9);
        assert_eq!((summary.largest_turn.line, summary.largest_turn.index), (4, 2));
        assert!((summary.largest_norm_error - 0.01).abs() < 1e-12);
        assert!(summary.to_string().contains("largest turn: 180° (box 2, to line 4)"));
    }
}

//! What stands in for the neighbours that the first and the last segment lack.
//!
//! Source of each rule: docs/math/ends.md.

use crate::clip::Clip;
use crate::math::Quat;

/// What the motion does at its two ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// Starts and stops without acceleration.
    #[default]
    Natural,
    /// Starts and stops at rest.
    Clamped,
    /// The end key counts twice.
    Repeat,
    /// The last key runs into the first.
    Closed,
    /// Each end segment rests at the value of its own first key.
    Hold,
    /// Starts and stops at the mean velocity of the first and the last step.
    Chord,
}

/// A clip whose ends do not meet, though they were said to.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "box {}: the last key must equal the first for closed ends, but lies {degrees:.4} degrees off \
     (at most {limit} are closed); repeat the first key at the end, or choose other ends",
    .track + 1, limit = Ends::LARGEST_GAP
)]
pub struct NotClosed {
    /// The track, counted from 0.
    pub track: usize,
    /// How far apart the two keys are.
    pub degrees: f64,
}

impl Ends {
    /// Every kind of end, in the order of the documentation.
    pub const ALL: [Ends; 6] =
        [Ends::Natural, Ends::Clamped, Ends::Repeat, Ends::Closed, Ends::Hold, Ends::Chord];

    /// The largest gap between first and last key that `closed` closes, degrees.
    pub const LARGEST_GAP: f64 = 0.2;

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Ends::Natural => "natural",
            Ends::Clamped => "clamped",
            Ends::Repeat => "repeat",
            Ends::Closed => "closed",
            Ends::Hold => "hold",
            Ends::Chord => "chord",
        }
    }

    /// The ends of a name, if there are any; `periodic` is another word for `closed`.
    pub fn from_name(name: &str) -> Option<Ends> {
        let name = if name == "periodic" { "closed" } else { name };
        Ends::ALL.into_iter().find(|ends| ends.name() == name)
    }

    /// Refuses a clip whose first and last keys are too far apart for closed ends.
    pub fn accept(self, clip: &Clip) -> Result<(), NotClosed> {
        let gaps = clip.tracks.iter().map(|keys| gap(keys).to_degrees()).enumerate();
        match gaps.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((track, degrees)) if self == Ends::Closed && degrees > Ends::LARGEST_GAP => {
                Err(NotClosed { track, degrees })
            }
            _ => Ok(()),
        }
    }
}

/// Angle between the first and the last key, radians.
fn gap(keys: &[Quat]) -> f64 {
    keys[0].angle_to(keys[keys.len() - 1])
}

/// Where the jump that `hold` makes at its second key begins, seconds.
///
/// A glTF channel cannot jump; a ramp stands in, which ends at the key: 1 ms long, or
/// two float32 steps where that is longer (later than four hours), or half the segment
/// where that is shorter.
pub fn ramp_start(from: f64, to: f64) -> f64 {
    let step = f64::from((to as f32).next_up()) - f64::from(to as f32);
    to - (2.0 * step).max(1e-3).min((to - from) / 2.0)
}

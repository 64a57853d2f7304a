//! How far two files' playback is apart, from what a player shows: a check that knows
//! nothing of how the second was made.

use crate::asset::play::{Channel, Player, Property};
use crate::asset::{Asset, Error};
use crate::math::Quat;
use serde::Serialize;

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

/// The largest distances between the playback of a file and of the same with fewer keys,
/// clip by clip and channel by channel; looked for at the keys of both and between them.
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
    let mut times = before.floats(a.input, 0..a.keys)?;
    times.extend(after.floats(b.input, 0..b.keys)?);
    times.sort_by(f32::total_cmp);
    times.dedup();
    let mut players = (Player::new(), Player::new());
    let mut worst: f64 = 0.0;
    let mut look = |t: f64| -> Result<(), Error> {
        let old = players.0.value(before, a, t)?;
        let new = players.1.value(after, b, t)?;
        worst = worst.max(distance(a.property, &old, &new));
        Ok(())
    };
    for pair in times.windows(2) {
        let (from, to) = (f64::from(pair[0]), f64::from(pair[1]));
        for i in 0..=BETWEEN {
            look(from + (to - from) * f64::from(i) / f64::from(BETWEEN + 1))?;
        }
    }
    look(times.last().map_or(0.0, |&last| f64::from(last)))?;
    Ok(worst)
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

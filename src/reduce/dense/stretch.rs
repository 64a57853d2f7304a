//! Keys in a row, and what every interval between those that stay must keep.

use super::near::Near;
use super::{Asked, Ends, Fewer};

/// The part of the tolerance that is aimed at: ends between keys are found as if the way
/// were straight.
const AIM: f64 = 0.998;
/// What f64 may add to a distance.
pub(super) const ROUNDING: f64 = 1e-11;

/// Neighbouring keys, and what holds for all of them.
pub(super) struct Stretch<'a, V: Near> {
    pub(super) times: &'a [f32],
    pub(super) stored: &'a [V::Stored],
    pub(super) values: Vec<V>,
    /// Ways from key to key that no interval may be longer than, or that bend too much
    /// beside another to be compared with it: they stay. Numbers of their first keys.
    pub(super) far: Vec<usize>,
    /// No other way is longer.
    pub(super) longest: f64,
    /// Numbers stored for a rotation differ from length 1 by at most this.
    pub(super) uneven: f64,
}

impl<'a, V: Near> Stretch<'a, V> {
    pub(super) fn new(times: &'a [f32], stored: &'a [V::Stored], asked: Asked) -> Stretch<'a, V> {
        let mut uneven = 0.0f64;
        let read = |&stored: &V::Stored| {
            let (value, off) = V::near_read(stored);
            uneven = uneven.max(off);
            value
        };
        let values: Vec<V> = stored.iter().map(read).collect();
        // A key that is off the curve is further away.
        let near = V::FAR.min((asked.step - 2.0 * asked.tolerance).max(0.0));
        let (mut far, mut longest) = (Vec::new(), 0.0f64);
        for (i, pair) in values.windows(2).enumerate() {
            let square = pair[0].apart_squared(pair[1]);
            if square <= near * near { longest = longest.max(square) } else { far.push(i) }
        }
        Stretch { times, stored, values, far, longest: longest.sqrt(), uneven }
    }

    pub(super) fn time(&self, key: usize) -> f64 {
        f64::from(self.times[key])
    }

    /// The curve at a time between a key and the next.
    pub(super) fn at(&self, key: usize, t: f64) -> V {
        let (from, to) = (self.time(key), self.time(key + 1));
        self.share(key, (t - from) / (to - from))
    }

    /// The curve at a share of the way from a key to the next.
    pub(super) fn share(&self, key: usize, u: f64) -> V {
        let (a, b) = (self.values[key], self.values[key + 1]);
        a.near_moved(a.near_step_to(b) * u)
    }
}

impl<V: Near<Stored = [f32; N]>, const N: usize> Stretch<'_, V> {
    pub(super) fn as_it_is(&self) -> Fewer<N> {
        Fewer { times: self.times.to_vec(), values: self.stored.to_vec(), deviation: 0.0 }
    }
}

/// What every interval of a stretch must keep, in the units of [`Value::distance`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) tolerance: f64,
    pub(super) step: f64,
    pub(super) ends: Ends,
    /// How many times as far as at its ends playback may be between two keys.
    pub(super) bulge: f64,
    /// What uneven lengths of the numbers there were add.
    pub(super) uneven: f64,
    /// How many times as much as those of rounded numbers do written lengths differ.
    pub(super) lengths: f64,
    /// The distance at keys that is aimed at.
    pub(super) aim: f64,
}

impl Limits {
    /// None where the tolerance leaves nothing to aim at.
    pub(super) fn new<V: Near>(stretch: &Stretch<V>, asked: Asked) -> Option<Limits> {
        let Asked { step, ends, .. } = asked;
        let tolerance = asked.tolerance.min(V::WIDEST);
        let uneven = stretch.uneven.min(0.5);
        // A way of playback beside one of these is no longer than it and both distances.
        let way = (stretch.longest + 2.0 * tolerance) * (1.0 + uneven) / (1.0 - uneven);
        let bulge = V::bulge(way);
        let lengths = if uneven <= V::EVEN { (uneven / V::ROUNDED).max(1.0) } else { V::EVEN / V::ROUNDED };
        let both = if ends == Ends::Own { 2.0 } else { 1.0 };
        let uneven = both * V::bent(uneven, way) * bulge + ROUNDING;
        let written = match ends {
            Ends::Own => 0.0,
            _ => stretch.values.iter().map(|value| value.rounding()).fold(0.0, f64::max),
        };
        let aim = AIM * (tolerance - uneven) / bulge - 2.0 * written;
        (aim > 0.25 * tolerance).then_some(Limits { tolerance, step, ends, bulge, uneven, lengths, aim })
    }
}

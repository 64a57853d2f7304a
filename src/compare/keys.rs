//! How many keys LINEAR playback needs: about, from how a motion turns; or counted, by finding them.

use crate::curve::Motion;
use crate::reduce::{self, Turning};
use serde::Serialize;

/// How exactly playback is to follow the curve where keys are counted, degrees.
pub const TOLERANCES: [f64; 3] = [0.1, 0.01, 0.001];

/// The largest turn between two keys, degrees: what keeps viewers that blend quaternions and
/// normalise near those that turn at constant speed.
pub const MAX_STEP: f64 = 18.0;

/// About how many keys are counted at most, over all that is compared: a second's work.
/// A scheme can need any number: keys close in time make some turn thousands of times
/// before a far next one.
pub const MOST_KEYS: usize = 20_000;

/// A time and a rotation in float32.
const BYTES_PER_KEY: u64 = 4 + 16;

/// What rounding may add to a number of steps, relative to it.
const SLACK: f64 = 2e-5;

/// What LINEAR playback needs to stay near a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct KeysNeeded {
    /// How near, degrees.
    pub tolerance: f64,
    /// Keys, at most [`MAX_STEP`] apart; none where float32 cannot keep the tolerance.
    pub keys: Option<usize>,
    /// Their times and rotations in a file.
    pub bytes: Option<u64>,
    /// Whether they were found and counted; otherwise this is an estimate, which does not
    /// know what float32 can keep.
    pub counted: bool,
}

impl KeysNeeded {
    fn new(tolerance: f64, keys: Option<usize>, counted: bool) -> KeysNeeded {
        KeysNeeded { tolerance, keys, bytes: keys.map(|keys| BYTES_PER_KEY * keys as u64), counted }
    }
}

/// An estimate that grows along a motion.
#[derive(Default)]
pub(super) struct Estimate {
    /// Keys up to the last stop, and what was added since, for each tolerance.
    stopped: [f64; TOLERANCES.len()],
    since: [f64; TOLERANCES.len()],
}

impl Estimate {
    /// Adds what a stretch takes, from the integral over it of a function of speed and
    /// acceleration, degrees and seconds.
    ///
    /// An interval of h seconds turns by v h and bends by a h²/8, which may be twice the
    /// tolerance.
    pub(super) fn add(&mut self, integral: impl Fn(&dyn Fn(f64, f64) -> f64) -> f64) {
        for (since, tolerance) in self.since.iter_mut().zip(TOLERANCES) {
            let bend = 1.0 / (16.0 * tolerance);
            *since += integral(&|speed, acceleration| (speed / MAX_STEP).max((acceleration * bend).sqrt()));
        }
    }

    /// Where there must be a key.
    pub(super) fn stop(&mut self) {
        for (stopped, since) in self.stopped.iter_mut().zip(&mut self.since) {
            *stopped += (std::mem::take(since) * (1.0 - SLACK)).ceil();
        }
    }

    /// What is needed up to here; for what is no number none is known.
    pub(super) fn needed(mut self) -> [KeysNeeded; TOLERANCES.len()] {
        self.stop();
        std::array::from_fn(|i| {
            let keys = (self.stopped[i] + 1.0).is_finite().then_some(self.stopped[i] as usize + 1);
            KeysNeeded::new(TOLERANCES[i], keys, false)
        })
    }
}

/// For which tolerances keys are counted: for as many as leave no more than [`MOST_KEYS`] in
/// all, apart from those that would take so many alone.
pub(super) fn affordable<'a>(
    needed: impl IntoIterator<Item = &'a [KeysNeeded; TOLERANCES.len()]>,
) -> [bool; TOLERANCES.len()] {
    let mut sums = [0; TOLERANCES.len()];
    for needed in needed {
        for (sum, keys) in sums.iter_mut().zip(needed) {
            *sum += few(keys).unwrap_or(0);
        }
    }
    let mut all = 0;
    sums.map(|sum| {
        all += sum;
        all <= MOST_KEYS
    })
}

/// Keys that may be counted.
fn few(needed: &KeysNeeded) -> Option<usize> {
    needed.keys.filter(|&keys| keys <= MOST_KEYS)
}

/// Counts what is affordable of what a motion needs.
pub(super) fn count<'a>(
    needed: &mut [KeysNeeded; TOLERANCES.len()],
    affordable: [bool; TOLERANCES.len()],
    motion: impl FnOnce() -> Motion<'a>,
) {
    let chosen: Vec<&mut KeysNeeded> = needed
        .iter_mut()
        .zip(affordable)
        .filter_map(|(needed, affordable)| (affordable && few(needed).is_some()).then_some(needed))
        .collect();
    if chosen.is_empty() {
        return;
    }
    let curve = Turning::new(motion());
    for needed in chosen {
        let tolerance = needed.tolerance;
        let options = reduce::Options { max_step: Some(MAX_STEP), ..reduce::Options::new(tolerance) };
        let keys = reduce::rotation(&curve, &options).ok().map(|keys| keys.times.len());
        *needed = KeysNeeded::new(tolerance, keys, true);
    }
}

//! Key times and values so that playback keeps a tolerance with as few keys as can be.
//!
//! LINEAR playback of the float32 numbers that come out stays within a tolerance of a
//! [`Curve`] at all times. A key may lie off the curve, by the tolerance at most: an
//! interval then serves a stretch that bends by twice the tolerance, and about 1/√2 of
//! the keys do. The first and the last key, and all corners of the curve, are kept. The
//! search and why it is near the best there is: docs/math/fewest-keys.md.

mod cubic;
mod curve;
mod dense;
mod pace;
mod proof;
mod reach;
mod search;
mod value;

#[cfg(test)]
mod tests;

pub(crate) use cubic::Hermite;
pub use cubic::{CubicKeys, Flat, cubic_numbers, cubic_rotation};
pub(crate) use curve::is_corner;
pub use curve::{Attitude, Curve, Travelling, Turning};
pub(crate) use dense::{Asked, Ends, Near, fewer};
pub use value::{Numbers, OtherBlend, Step, Value};

use crate::math::Quat;
use curve::on_ramp;
use proof::Proven;
use reach::{Key, Limits};
use search::Stuck;

/// What is asked of the keys. Angles are degrees, distances units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How far playback may be from the curve.
    pub tolerance: f64,
    /// The part of it that is left for what is done to the keys afterwards.
    pub reserve: f64,
    /// How far neighbouring keys may be apart; the ramp of a jump does not count.
    pub max_step: Option<f64>,
    /// Keys stay on the curve.
    pub on_curve: bool,
    /// How many keys are chosen with care: that takes four times as long, and saves one key in
    /// two hundred where the curve bends smoothly.
    pub careful: usize,
}

impl Options {
    /// The number of keys that are chosen with care, where not much else is to be found.
    pub const CAREFUL: usize = 2048;

    /// The smallest tolerance for rotations, degrees: float32 alone costs up to 6e-6°.
    pub const LEAST_DEGREES: f64 = 2e-5;

    /// A tolerance and nothing else.
    pub fn new(tolerance: f64) -> Options {
        Options { tolerance, reserve: 0.0, max_step: None, on_curve: false, careful: Self::CAREFUL }
    }
}

/// Why there are no such keys.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The tolerance is too near to what float32 costs.
    #[error("a tolerance of {tolerance:e} is too small: float32 numbers need at least {least:.1e}")]
    Tolerance {
        /// What was asked for, less what is reserved.
        tolerance: f64,
        /// What is possible.
        least: f64,
    },
    /// Float32 times are too coarse for how fast the curve turns a corner.
    #[error(
        "float32 times cannot follow the curve at {time} s to within {tolerance:e}: choose a larger tolerance"
    )]
    Times {
        /// About when, seconds.
        time: f64,
        /// What was asked for, less what is reserved.
        tolerance: f64,
    },
    /// The curve spins between its keys.
    #[error(
        "the curve spins, most of all after {time} s: keyframes can follow {turns:.0} revolutions in total, not more"
    )]
    Spins {
        /// Where it does so most, seconds.
        time: f64,
        /// How many turns would be all right.
        turns: f64,
    },
    /// The curve swings round or jumps.
    #[error("the curve swings round or jumps after {time} s, which no keys follow")]
    Swings {
        /// About when, seconds.
        time: f64,
    },
}

/// What is known of the keys. Angles are degrees, distances units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    /// An upper bound of the distance between the curve and LINEAR playback.
    pub deviation: f64,
    /// The same for players that blend quaternions and normalise; for other values the
    /// same number.
    pub nlerp: f64,
    /// Whether these two are proven. Of a plain function they are only measured.
    pub proven: bool,
    /// The largest step from key to key but for the ramps of jumps.
    pub largest_step: f64,
    /// How far playback is from the curve at the curve's own keys, at most.
    pub keys_moved: f64,
}

/// The keys of a channel: float32 numbers as a file holds them, N to a key.
#[derive(Clone, Debug, PartialEq)]
pub struct Keys<const N: usize> {
    /// Seconds, increasing; one alone for a channel that is still.
    pub times: Vec<f32>,
    /// Rotations as x y z w with continuous signs.
    pub values: Vec<[f32; N]>,
    /// What is known of them.
    pub facts: Facts,
}

/// Degrees to the unit of distances between rotations, half radians.
const HALF_DEGREE: f64 = std::f64::consts::PI / 360.0;

/// The fewest keys for a rotation. Tolerance and step in degrees.
pub fn rotation(curve: &impl Curve<Value = Quat>, options: &Options) -> Result<Keys<4>, Error> {
    check(options, Options::LEAST_DEGREES)?;
    reduce(curve, options, HALF_DEGREE)
}

/// The fewest keys for numbers side by side: places, scales, weights. The distance of
/// two values is the length of their difference.
pub fn numbers<const N: usize>(
    curve: &impl Curve<Value = Numbers<N>>,
    options: &Options,
) -> Result<Keys<N>, Error> {
    check(options, 4.0 * largest_rounding(curve))?;
    reduce(curve, options, 1.0)
}

/// What float32 costs at the curve's knots, at most.
fn largest_rounding(curve: &impl Curve) -> f64 {
    curve.knots().iter().map(|&t| curve.at(t).rounding()).fold(0.0, f64::max)
}

/// Refuses what float32 cannot keep. Written so that what is no number is refused.
fn check(options: &Options, least: f64) -> Result<(), Error> {
    let tolerance = options.tolerance - options.reserve;
    let usable = tolerance >= least && tolerance > 0.0 && options.reserve >= 0.0;
    if usable { Ok(()) } else { Err(Error::Tolerance { tolerance, least }) }
}

/// What rounding may add to a step, relative to it: below anyone's notice.
const STEP_SLACK: f64 = 2e-5;
/// Below so many keys both searches are run.
const FEW: usize = 100;
/// Distances below this part of the tolerance need no close bound.
const NEGLIGIBLE: f64 = 1e-3;

/// `unit` is what one of the options' units is in those of [`Value::distance`].
fn reduce<C: Curve<Value: Value<Stored = [f32; N]>>, const N: usize>(
    curve: &C,
    options: &Options,
    unit: f64,
) -> Result<Keys<N>, Error> {
    let asked = options.tolerance - options.reserve;
    let tolerance = asked * unit;
    let step = options.max_step.map_or(f64::INFINITY, |step| step * unit).min(C::Value::LONGEST);
    let on_curve = options.on_curve;
    let limits = Limits { tolerance, step, step_slack: STEP_SLACK * step, on_curve, several: true };
    let stops = stops(curve);
    if let Some(keys) = still(curve, &stops, tolerance) {
        return Ok(written(curve, &keys, unit));
    }
    let stuck = |Stuck(time)| Error::Times { time, tolerance: asked };
    steady(curve)?;
    pace::check(curve, tolerance).map_err(stuck)?;
    pace::unwound(curve)?;
    let found = |limits: Limits| {
        let keys = search::fewest(curve, &stops, limits, options.careful)?;
        proof::prove(curve, &keys, tolerance, NEGLIGIBLE * tolerance)
    };
    let keys = written(curve, &found(limits).map_err(stuck)?, unit);
    // Off the curve the search is not exact: few keys, and those that a step limits, may
    // be fewer on it.
    let stepped = keys.facts.largest_step * unit > 0.95 * step;
    let doubtful = keys.times.len() < if stepped { options.careful } else { options.careful.min(FEW) };
    if limits.on_curve || !doubtful {
        return Ok(keys);
    }
    let on_curve = found(Limits { on_curve: true, ..limits }).map(|proven| written(curve, &proven, unit));
    Ok(on_curve.ok().filter(|other| other.times.len() < keys.times.len()).unwrap_or(keys))
}

impl From<pace::Spin> for Error {
    fn from(pace::Spin { time, turns }: pace::Spin) -> Error {
        Error::Spins { time, turns }
    }
}

/// Refuses a curve that jumps.
fn steady(curve: &impl Curve) -> Result<(), Error> {
    curve.first_spin().map_or(Ok(()), |time| Err(Error::Swings { time }))
}

/// Times that must be keys, as float32: the first, corners, the last.
fn stops<C: Curve>(curve: &C) -> Vec<f32> {
    let (knots, corners) = (curve.knots(), curve.corners());
    let (first, last) = (knots[0] as f32, knots[knots.len() - 1] as f32);
    let mut stops = vec![first];
    stops.extend(corners.iter().map(|&t| t as f32).filter(|&t| first < t && t < last));
    stops.push(last);
    stops.dedup();
    stops
}

/// One key, if the curve ends where it starts and never leaves it.
fn still<C: Curve>(curve: &C, stops: &[f32], tolerance: f64) -> Option<Proven<C::Value>> {
    let (first, last) = (stops[0], stops[stops.len() - 1]);
    let at = |time: f32| Key::new(time, curve.at(f64::from(time)));
    let (key, end) = (at(first), at(last));
    if stops.len() > 2 || key.value.distance(end.value) > 2.0 * key.value.rounding() {
        return None;
    }
    let held = proof::held(curve, key, last, tolerance)?.max(pace::beyond(curve, last, key.value));
    (held <= tolerance).then(|| Proven { keys: vec![key], deviation: held, other: held, moved: held })
}

fn written<C: Curve<Value: Value<Stored = [f32; N]>>, const N: usize>(
    curve: &C,
    proven: &Proven<C::Value>,
    unit: f64,
) -> Keys<N> {
    let keys = &proven.keys;
    let mut values: Vec<[f32; N]> = Vec::with_capacity(keys.len());
    for key in keys {
        let value = values.last().map_or(key.stored, |&before| C::Value::continuous(key.stored, before));
        values.push(value);
    }
    let steps = keys.windows(2).filter(|pair| !on_ramp(curve, pair[0].time));
    let largest = steps.map(|pair| pair[0].value.distance(pair[1].value)).fold(0.0, f64::max);
    let other = if C::Value::other_blend().is_some() { proven.other } else { proven.deviation };
    let known = curve.rates(f64::from(keys[0].time), curve.knots()[1]).is_some();
    let facts = Facts {
        deviation: proven.deviation / unit,
        nlerp: other / unit,
        proven: known,
        largest_step: largest / unit,
        keys_moved: proven.moved / unit,
    };
    Keys { times: keys.iter().map(|key| key.time).collect(), values, facts }
}

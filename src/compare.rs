//! Numbers by which to choose a scheme: how fast, how smooth, how far astray, how large.
//!
//! Derivatives come from running the curve's own formula on [`Jet`]s, never from
//! differences of samples. What each figure means and how exact it is:
//! docs/math/compare.md.

mod chord;
mod peaks;
mod quadrature;

#[cfg(test)]
mod tests;

use crate::clip::{Clip, Through};
use crate::curve::{Arc, Ends, Motion, NotClosed, Piece, Scheme};
use crate::math::{Jet, Quat, Vec3};
use crate::reduce::{self, Turning};
use chord::Chord;
use rayon::prelude::*;
use serde::Serialize;

/// How exactly playback is to follow the curve where keys are counted, degrees.
pub const TOLERANCES: [f64; 3] = [0.1, 0.01, 0.001];

/// The largest turn between two keys that are counted, degrees: what keeps viewers that
/// blend quaternions and normalise near those that turn at constant speed.
pub const MAX_STEP: f64 = 18.0;

/// About how many keys are counted at most, in all or for each of the motion's own. A
/// scheme can need any number: keys close in time make some turn thousands of times before
/// a far next one.
const MOST_KEYS: [usize; 2] = [100_000, 64];

/// A time and a rotation in float32.
const BYTES_PER_KEY: u64 = 4 + 16;

/// What is known of one motion. Degrees and seconds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Figures {
    /// Angular speed, degrees a second.
    pub speed: Spread,
    /// Length of the angular acceleration, degrees a second squared.
    pub acceleration: Spread,
    /// What jumps at keys.
    pub jumps: Jumps,
    /// How much further from one key of its segment the motion gets than the other key
    /// is, degrees.
    pub overshoot: Peak,
    /// How far the motion gets from the arc between the two keys of its segment, degrees.
    pub stray: Peak,
    /// Keys that LINEAR playback needs, one for each of [`TOLERANCES`].
    pub keys: [KeysNeeded; TOLERANCES.len()],
}

/// How large something is over a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Where it is largest.
    pub largest: Peak,
    /// Root of the mean square over time.
    pub rms: f64,
}

/// A largest value and its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// How large.
    pub value: f64,
    /// When, seconds since the first key.
    pub time: f64,
}

/// The largest jumps at keys: at those with a segment on either side, and where a loop
/// closes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Jumps {
    /// Of the rotation itself, degrees.
    pub rotation: Peak,
    /// Of the angular velocity, degrees a second.
    pub velocity: Peak,
    /// Of the angular acceleration, degrees a second squared.
    pub acceleration: Peak,
}

/// What LINEAR playback needs to stay near a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct KeysNeeded {
    /// How near, degrees.
    pub tolerance: f64,
    /// Keys, at most [`MAX_STEP`] apart; none where float32 cannot keep the tolerance, or
    /// where it would take more than about a hundred thousand, and 64 for each key there is.
    pub keys: Option<usize>,
    /// Their times and rotations in a file.
    pub bytes: Option<u64>,
}

/// What is known of one box, by scheme.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoxFigures {
    /// The box, from 1; 1 for a body.
    #[serde(rename = "box")]
    pub index: usize,
    /// In the order of the schemes.
    pub methods: Vec<Method>,
}

/// What is known of one box by one scheme.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Method {
    /// The scheme's name; none for control rotations, which have none.
    pub scheme: Option<&'static str>,
    /// What is known of it.
    #[serde(flatten)]
    pub figures: Figures,
}

/// The figures of a clip's boxes, of `only` one (from 0) or of all, by some schemes.
/// Control rotations need neither schemes nor ends.
///
/// Fails where other schemes than slerp are to close ends that do not meet.
pub fn clip(
    clip: &Clip,
    schemes: &[Scheme],
    ends: Ends,
    only: Option<usize>,
) -> Result<Vec<BoxFigures>, NotClosed> {
    let controls = clip.through == Through::Controls;
    if !controls && schemes.iter().any(|&scheme| scheme != Scheme::Slerp) {
        ends.accept(clip)?;
    }
    let methods: Vec<Option<Scheme>> =
        if controls { vec![None] } else { schemes.iter().copied().map(Some).collect() };
    let tracks: Vec<usize> = (0..clip.tracks.len()).filter(|i| only.is_none_or(|only| only == *i)).collect();
    let of_track = |&track: &usize| {
        let method = |&scheme: &Option<Scheme>| Method {
            scheme: scheme.map(Scheme::name),
            figures: track_figures(clip, track, scheme, ends),
        };
        BoxFigures { index: track + 1, methods: methods.par_iter().map(method).collect() }
    };
    Ok(tracks.par_iter().map(of_track).collect())
}

/// One track by one scheme, or along its control rotations.
fn track_figures(clip: &Clip, track: usize, scheme: Option<Scheme>, ends: Ends) -> Figures {
    let (times, rotations) = (&clip.times, &clip.tracks[track]);
    let Some(scheme) = scheme else {
        let keys: Vec<Quat> = rotations.iter().copied().step_by(3).collect();
        return motion(Motion::through_controls(times, rotations), &keys, false);
    };
    motion(Motion::new(times, rotations, scheme, ends), rotations, ends == Ends::Closed)
}

/// In how many parts each piece is integrated: some schemes swing round within a fraction
/// of a segment.
const PARTS: u32 = 8;

/// The figures of a motion. `keys` are the rotations at its times, with continuous signs;
/// a motion that `loops` also meets itself where its end runs into its start.
pub fn motion(motion: Motion, keys: &[Quat], loops: bool) -> Figures {
    let pieces = pieces(&motion);
    let times = motion.times();
    // Closed ends move the last key.
    let end = if loops { motion.at(times[times.len() - 1]) } else { keys[keys.len() - 1] };
    let key = |i: usize| if i + 1 == keys.len() { end } else { keys[i] };
    let mut peaks = [Peak { value: 0.0, time: times[0] }; 4];
    // Integrals of the squares of speed and acceleration, of speed, and of the
    // acceleration's root.
    let (mut integrals, mut duration) = ([0.0; 4], 0.0);
    let nodes = quadrature::nodes();
    for piece in &pieces {
        let after = times.partition_point(|&t| t <= piece.start).clamp(1, times.len() - 1);
        let chord = Chord::new(key(after - 1), key(after), piece.at(0.0));
        peaks::raise(&mut peaks, piece, |u| measures(piece, &chord, u));
        for (part, (u, weight)) in (0..PARTS).flat_map(|part| nodes.map(|node| (f64::from(part), node))) {
            let [speed, acceleration, ..] = measures(piece, &chord, (part + u) / f64::from(PARTS));
            let values = [speed * speed, acceleration * acceleration, speed, acceleration.sqrt()];
            for (integral, value) in integrals.iter_mut().zip(values) {
                *integral += weight * piece.duration() * value / f64::from(PARTS);
            }
        }
        duration += piece.duration();
    }
    let [speed, acceleration, overshoot, stray] = peaks;
    let [square_speed, square_acceleration, turned, bent] = integrals;
    let rms = |square: f64| (square / duration).sqrt();
    Figures {
        speed: Spread { largest: speed, rms: rms(square_speed) },
        acceleration: Spread { largest: acceleration, rms: rms(square_acceleration) },
        jumps: jumps(&pieces, loops),
        overshoot,
        stray,
        keys: keys_needed(motion, |tolerance| expected_keys(tolerance, turned, bent)),
    }
}

/// The pieces of a motion but for the ramp that stands for a jump: a jump has no speed.
fn pieces(motion: &Motion) -> Vec<Piece> {
    let times = motion.times();
    let (mut t, last) = (times[0], times[times.len() - 1]);
    let mut pieces: Vec<Piece> = Vec::with_capacity(times.len());
    while t < last {
        let piece = motion.piece_at(t);
        t = piece.end;
        if motion.ramp() != Some(piece.start) {
            pieces.push(piece);
        }
    }
    pieces
}

/// A motion at a time: radians and seconds, in the body's frame.
struct State {
    rotation: Quat,
    velocity: Vec3,
    acceleration: Vec3,
}

fn state(piece: &Piece, u: f64) -> State {
    let (jet, rate) = (piece.at(Jet::<f64>::variable(u)), 1.0 / piece.duration());
    // The jet's are half of the angular ones, by u.
    State {
        rotation: jet.value(),
        velocity: jet.half_velocity() * (2.0 * rate),
        acceleration: jet.half_acceleration() * (2.0 * rate * rate),
    }
}

/// Speed, acceleration, overshoot and stray, degrees and seconds.
fn measures(piece: &Piece, chord: &Chord, u: f64) -> [f64; 4] {
    let State { rotation, velocity, acceleration } = state(piece, u);
    let [overshoot, stray] = chord.measure(rotation);
    [velocity.length(), acceleration.length(), overshoot, stray].map(f64::to_degrees)
}

fn jumps(pieces: &[Piece], loops: bool) -> Jumps {
    let (first, last) = (&pieces[0], &pieces[pieces.len() - 1]);
    let inner = pieces.windows(2).map(|pair| (&pair[0], &pair[1], pair[1].start));
    let seam = loops.then_some((last, first, last.end));
    let mut largest = [Peak { value: 0.0, time: first.start }; 3];
    for (before, after, time) in inner.chain(seam) {
        let (a, b) = (state(before, 1.0), state(after, 0.0));
        let rotation = a.rotation.angle_to(b.rotation);
        let (velocity, acceleration) = (b.velocity - a.velocity, b.acceleration - a.acceleration);
        let found = [rotation, velocity.length(), acceleration.length()];
        for (largest, found) in largest.iter_mut().zip(found) {
            largest.rise(found.to_degrees(), time);
        }
    }
    let [rotation, velocity, acceleration] = largest;
    Jumps { rotation, velocity, acceleration }
}

fn keys_needed(motion: Motion, expected: impl Fn(f64) -> f64) -> [KeysNeeded; TOLERANCES.len()] {
    let most = MOST_KEYS[0].max(MOST_KEYS[1] * motion.times().len()) as f64;
    let curve = Turning::new(motion);
    let count = |tolerance: f64| {
        let options = reduce::Options { max_step: Some(MAX_STEP), ..reduce::Options::new(tolerance) };
        let keys = reduce::rotation(&curve, &options).ok()?;
        Some(keys.times.len())
    };
    TOLERANCES.map(|tolerance| {
        let keys = if expected(tolerance) <= most { count(tolerance) } else { None };
        KeysNeeded { tolerance, keys, bytes: keys.map(|keys| BYTES_PER_KEY * keys as u64) }
    })
}

/// About how many keys a tolerance takes, from the degrees turned in all and the integral
/// of the acceleration's root. With accelerations of a, an interval of h seconds bends by
/// a h²/8, which may be twice the tolerance. For what is no number, no end of keys.
fn expected_keys(tolerance: f64, turned: f64, bent: f64) -> f64 {
    let keys = (turned / MAX_STEP).max(bent / (16.0 * tolerance).sqrt());
    if turned.is_finite() && bent.is_finite() { keys } else { f64::INFINITY }
}

impl Peak {
    /// Takes a value that is larger.
    fn rise(&mut self, value: f64, time: f64) {
        if value > self.value {
            *self = Peak { value, time };
        }
    }
}

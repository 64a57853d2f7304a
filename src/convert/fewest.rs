//! Each move by as few keys as a tolerance allows.

use super::facts::Seen;
use crate::curve::Motion;
use crate::moves::{Ground, Move, Mover, Turn};
use crate::reduce::{self, Attitude, Facts, Travelling, Turning};
use crate::sample::{self, Encoding, Steps, Timeline, TrackFacts, Writing, code};
use crate::write::Interpolation;
use rayon::prelude::*;
use std::convert::Infallible;

/// What is asked for instead of a rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fewest {
    /// How far playback may turn from the curve, degrees.
    pub tolerance: f64,
    /// How far it may be from the path, and a corner of a chain from where it should be,
    /// units; without it what the tolerance makes at the path's extent.
    pub distance: Option<f64>,
    /// How far a node may turn from key to key, degrees.
    pub max_step: f64,
    /// Keys lie on the curve.
    pub on_curve: bool,
}

impl Fewest {
    /// The step that keeps component-blending viewers within 0.01°.
    pub const MAX_STEP: f64 = Steps::LARGE;
}

/// A tolerance that cannot be kept, as [`super::Error::Fewest`] tells it.
pub(super) struct Unkept {
    pub(super) error: reduce::Error,
    pub(super) unit: &'static str,
    pub(super) reserve: f64,
    pub(super) shared: bool,
}

/// The keys of one move.
#[derive(Clone, Debug)]
pub(super) struct Chosen {
    pub(super) times: Vec<f32>,
    pub(super) values: Values,
    pub(super) facts: TrackFacts,
    /// How far playback is from the input's keys, where they were moved.
    pub(super) keys_moved: Option<f64>,
    pub(super) interpolation: Interpolation,
}

#[derive(Clone, Debug)]
pub(super) enum Values {
    Rotations(Vec<[f32; 4]>),
    Places(Vec<[f32; 3]>),
}

/// What is known of chosen keys, as samplers say it.
fn known(facts: &Facts) -> TrackFacts {
    let Facts { deviation, nlerp, proven, largest_step, .. } = *facts;
    TrackFacts {
        deviation: proven.then_some(deviation),
        nlerp: proven.then_some(nlerp),
        measured: (!proven).then_some(deviation),
        steps: Steps { large: 0, worst: largest_step, at: 0.0 },
    }
}

impl Chosen {
    /// Keys for LINEAR playback, by what the search found out.
    fn new(times: Vec<f32>, values: Values, facts: &Facts) -> Chosen {
        let keys_moved = matches!(values, Values::Rotations(_)).then_some(facts.keys_moved);
        Chosen { times, values, facts: known(facts), keys_moved, interpolation: Interpolation::Linear }
    }

    /// Holds the last value until `end`.
    pub(super) fn hold_until(&mut self, end: f32) {
        fn repeat_last<T: Copy>(values: &mut Vec<T>) {
            values.extend(values.last().copied());
        }
        self.times.push(end);
        match &mut self.values {
            Values::Rotations(rotations) => repeat_last(rotations),
            Values::Places(places) => repeat_last(places),
        }
    }

    /// A key at 0 for what starts later: until then it waits.
    fn wait(mut self) -> Chosen {
        if self.times[0] > 0.0 {
            self.times.insert(0, 0.0);
            match &mut self.values {
                Values::Rotations(rotations) => rotations.insert(0, rotations[0]),
                Values::Places(places) => places.insert(0, places[0]),
            }
        }
        self
    }
}

/// The keys of an object's moves. The first of them keeps the clip's last time where no
/// other does.
pub(super) fn object(
    ground: &Ground,
    moves: &[(Mover, Move)],
    fewest: &Fewest,
    encoding: Encoding,
) -> Result<Vec<Chosen>, Unkept> {
    // What turns nothing but itself displaces nothing, and has no part of a distance.
    let displaces =
        |(mover, a_move): &&(Mover, Move)| a_move.travel().is_some() || ground.reach_below(*mover) > 0.0;
    let sharing = moves.iter().filter(displaces).count();
    let allowed =
        moves.iter().map(|&(mover, ref a_move)| (a_move, allowed(ground, mover, a_move, sharing, fewest)));
    let mut keys = all(allowed.collect(), ground.duration(), fewest, encoding)?;
    let end = ground.duration() as f32;
    let last = keys.iter().filter_map(|chosen| chosen.times.last().copied()).fold(0.0, f32::max);
    if let Some(first) = keys.first_mut().filter(|_| last < end) {
        first.hold_until(end);
    }
    Ok(keys)
}

/// The keys of what moves cameras.
pub(super) fn cameras(
    ground: &Ground,
    moves: &[(usize, Move)],
    fewest: &Fewest,
    encoding: Encoding,
) -> Result<Vec<Chosen>, Unkept> {
    let allowed = |a_move: &Move| match a_move {
        Move::Travel(_) => distance(ground, fewest),
        Move::Keys(_) | Move::Attitude(_) => fewest.tolerance,
    };
    let moves = moves.iter().map(|(_, a_move)| (a_move, allowed(a_move))).collect();
    all(moves, ground.duration(), fewest, encoding)
}

fn all(
    moves: Vec<(&Move, f64)>,
    end: f64,
    fewest: &Fewest,
    encoding: Encoding,
) -> Result<Vec<Chosen>, Unkept> {
    moves.into_par_iter().map(|(a_move, allowed)| chosen(a_move, end, allowed, fewest, encoding)).collect()
}

/// What is known of moves that have keys of their own.
pub(super) fn seen(all: &[Chosen]) -> Seen {
    let mut seen = Seen::default();
    for chosen in all {
        match chosen.values {
            Values::Rotations(_) => {
                seen.tracks.push(chosen.facts);
                seen.keys_moved = seen.keys_moved.into_iter().chain(chosen.keys_moved).reduce(f64::max);
            }
            Values::Places(_) => seen.distances.extend(chosen.facts.deviation),
        }
    }
    seen
}

/// How far places may be off: what the angle makes of the path's extent, but no less than
/// float32 needs far from the origin.
fn distance(ground: &Ground, fewest: &Fewest) -> f64 {
    let by_angle = fewest.tolerance.to_radians() * ground.extent();
    fewest.distance.unwrap_or(by_angle.max(FINEST * ground.reach()).max(f64::MIN_POSITIVE))
}

/// Of the distance from the origin, what float32 can keep: it rounds three coordinates by
/// 2⁻²⁵ of themselves each, and the search needs four times that.
const FINEST: f64 = 1e-6;

/// How far a move of an object may be off, degrees or units. Where a distance is asked
/// for, so many moves share it: each may displace what it moves by an equal part.
fn allowed(ground: &Ground, mover: Mover, a_move: &Move, sharing: usize, fewest: &Fewest) -> f64 {
    let share = fewest.distance.map(|distance| distance / sharing as f64);
    match (a_move, share) {
        (Move::Travel(_), None) => distance(ground, fewest),
        (Move::Travel(_), Some(share)) => share,
        (_, None) => fewest.tolerance,
        (_, Some(share)) => {
            let reach = ground.reach_below(mover);
            let turn = if reach > 0.0 { (share / reach).to_degrees() } else { f64::INFINITY };
            fewest.tolerance.min(turn)
        }
    }
}

/// The fewest keys of a move from 0 to `end`. `allowed`: how far it may be off, degrees or
/// units.
fn chosen(
    a_move: &Move,
    end: f64,
    allowed: f64,
    fewest: &Fewest,
    encoding: Encoding,
) -> Result<Chosen, Unkept> {
    let coded = encoding == Encoding::Normalized16;
    let reserve = if coded { reserve(encoding, fewest.max_step) } else { 0.0 };
    let options = reduce::Options {
        tolerance: allowed,
        reserve: if matches!(a_move, Move::Travel(_)) { 0.0 } else { reserve },
        max_step: (!matches!(a_move, Move::Travel(_))).then_some(fewest.max_step),
        on_curve: fewest.on_curve,
    };
    let rotations = |keys: reduce::Keys<4>| {
        let keys = if coded { recoded(keys, encoding, reserve) } else { keys };
        Chosen::new(keys.times, Values::Rotations(keys.values), &keys.facts)
    };
    let chosen = match a_move {
        Move::Keys(motion) if motion.is_step() => return Ok(held(motion, encoding)),
        Move::Keys(motion) => reduce::rotation(&Turning::new(motion.clone()), &options).map(rotations),
        Move::Attitude(Turn { at, knots, ramps }) => {
            reduce::rotation(&Attitude::new(at, (0.0, end), knots, ramps), &options).map(rotations)
        }
        Move::Travel(travel) => {
            let curve = Travelling::new(travel.as_ref(), (0.0, end), travel.jumps());
            reduce::numbers(&curve, &options)
                .map(|keys| Chosen::new(keys.times, Values::Places(keys.values), &keys.facts))
        }
    };
    let travels = matches!(a_move, Move::Travel(_));
    chosen.map(Chosen::wait).map_err(|error| Unkept {
        error,
        unit: if travels { " units" } else { "°" },
        reserve: options.reserve,
        shared: fewest
            .distance
            .is_some_and(|distance| if travels { allowed < distance } else { allowed < fewest.tolerance }),
    })
}

/// The moves of an object of which some are held from key to key: those by their keys, the
/// others by the samples of a timeline.
pub(super) fn held_and_sampled<M>(moves: &[(M, Move)], timeline: &Timeline, writing: Writing) -> Vec<Chosen> {
    let times: Vec<f32> = (0..timeline.chunks()).flat_map(|chunk| timeline.chunk(chunk).1).collect();
    let one = |(_, a_move): &(M, Move)| match a_move {
        Move::Keys(motion) if motion.is_step() => held(motion, writing.encoding),
        other => sampled(other, timeline, &times, writing),
    };
    moves.iter().map(one).collect()
}

/// A motion that is held: its keys as they are.
fn held(motion: &Motion, encoding: Encoding) -> Chosen {
    let mut written: Vec<[f32; 4]> = Vec::with_capacity(motion.times().len());
    let mut off: f64 = 0.0;
    for &t in motion.times() {
        let key = motion.at(t);
        let numbers = encoding.numbers(key);
        off = off.max(sample::written(numbers).angle_to(key).to_degrees());
        written.push(numbers);
    }
    let facts = TrackFacts { deviation: Some(off), nlerp: Some(off), ..TrackFacts::default() };
    let times = motion.times().iter().map(|&t| t as f32).collect();
    let (values, interpolation) = (Values::Rotations(written), Interpolation::Step);
    Chosen { times, values, facts, keys_moved: None, interpolation }.wait()
}

/// The samples of a timeline, in memory.
fn sampled(a_move: &Move, timeline: &Timeline, times: &[f32], writing: Writing) -> Chosen {
    let (mut turns, mut places) = (Vec::new(), Vec::new());
    let mut facts = TrackFacts::default();
    if let Some(rotation) = a_move.rotation() {
        let all = sample::rotations(&[rotation], timeline, writing, |chunk| {
            turns.extend_from_slice(chunk);
            Ok::<(), Infallible>(())
        });
        facts = all.map_or(facts, |all| all[0]);
    }
    if let Some(travel) = a_move.travel() {
        let distance = sample::translations(travel, timeline, |chunk| {
            places.extend_from_slice(chunk);
            Ok::<(), Infallible>(())
        });
        facts.deviation = distance.ok().filter(|_| writing.bound);
    }
    let values = if turns.is_empty() { Values::Places(places) } else { Values::Rotations(turns) };
    let times = times.to_vec();
    Chosen { times, values, facts, keys_moved: None, interpolation: Interpolation::Linear }
}

/// What coding adds to a playback's error: between two keys, each off by at most the
/// largest error e, the arc between them is off by at most e / cos(step / 4), the step
/// being the angle of the rotation from key to key (the norm of a Jacobi field of the unit
/// sphere at the middle of the arc, where it is largest).
fn reserve(encoding: Encoding, step: f64) -> f64 {
    encoding.largest_error() / (step.to_radians() / 4.0).cos()
}

/// Keys as a file with fewer digits holds them.
fn recoded(mut keys: reduce::Keys<4>, encoding: Encoding, reserve: f64) -> reduce::Keys<4> {
    for value in &mut keys.values {
        *value = encoding.numbers(crate::math::Quat::from_xyzw(value.map(f64::from)));
    }
    keys.facts.deviation += reserve;
    keys.facts.nlerp += reserve;
    keys.facts.keys_moved += reserve;
    keys
}

/// The bytes of rotations by an encoding.
pub(super) fn bytes(rotations: &[[f32; 4]], encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Float => super::layout::little_endian(rotations),
        Encoding::Normalized16 => {
            rotations.as_flattened().iter().flat_map(|&number| code(number).to_le_bytes()).collect()
        }
    }
}

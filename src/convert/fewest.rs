//! Each move by as few keys as a tolerance allows.

use super::chosen::{Chosen, Values, held};
use super::facts::Seen;
use super::together::{InTurn, Refused};
use crate::math::Quat;
use crate::moves::{Ground, Move, Mover, Turn};
use crate::reduce::{self, Attitude, CubicKeys, Curve, Numbers, Travelling, Turning};
use crate::sample::blend;
use crate::sample::{Encoding, Steps};
use crate::write::Interpolation;
use rayon::prelude::*;

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
    /// Keys for CUBICSPLINE playback, which lie on the curve too; else for LINEAR.
    pub cubic: bool,
}

impl Fewest {
    /// The step that keeps component-blending viewers within 0.01°.
    pub const MAX_STEP: f64 = Steps::LARGE;
    /// For cubics, which such viewers do not show: far enough from half a turn.
    pub const MAX_CUBIC_STEP: f64 = 90.0;
    /// The tolerance for cubics where none is asked for, degrees.
    pub const CUBIC_TOLERANCE: f64 = 0.01;
}

/// A tolerance that cannot be kept, as [`super::Error::Fewest`] tells it.
pub(super) struct Unkept {
    pub(super) error: reduce::Error,
    pub(super) unit: &'static str,
    pub(super) reserve: f64,
    pub(super) shared: bool,
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

/// How many keys of a file are chosen with care.
const CAREFUL: usize = 2 * reduce::Options::CAREFUL;

fn all(
    moves: Vec<(&Move, f64)>,
    end: f64,
    fewest: &Fewest,
    encoding: Encoding,
) -> Result<Vec<Chosen>, Unkept> {
    // All share in the care, so that a file does not take the longer the more moves it has.
    let careful = (CAREFUL / moves.len().max(1)).min(reduce::Options::CAREFUL);
    // Rotations first: it is them that float32's times cannot keep, if anything.
    let count = moves.len();
    let turn = |i: usize, a_move: &Move| if matches!(a_move, Move::Travel(_)) { count + i } else { i };
    let refused = Refused::none();
    let chosen = |(i, (a_move, allowed))| {
        let turn = turn(i, a_move);
        let chosen = chosen(a_move, end, allowed, careful, fewest, encoding, (turn, &refused));
        chosen.map_err(|unkept| {
            refused.note(turn);
            (turn, unkept)
        })
    };
    let (mut all, mut unkept) = (Vec::with_capacity(count), Vec::new());
    let found: Vec<Result<Chosen, (usize, Unkept)>> = moves.into_par_iter().enumerate().map(chosen).collect();
    for found in found {
        match found {
            Ok(chosen) => all.push(chosen),
            Err(error) => unkept.push(error),
        }
    }
    unkept.into_iter().min_by_key(|(turn, _)| *turn).map_or(Ok(all), |(_, first)| Err(first))
}

/// What is known of moves that have keys of their own.
pub(super) fn seen(all: &[Chosen]) -> Seen {
    let mut seen = Seen::default();
    for chosen in all {
        if chosen.values.are_rotations() {
            seen.tracks.push(chosen.facts);
            seen.keys_moved = seen.keys_moved.into_iter().chain(chosen.keys_moved).reduce(f64::max);
        } else {
            seen.distances.extend(chosen.facts.deviation);
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
/// units; `careful`: how many are chosen with care; `turn`: whose turn it is, and who was refused.
fn chosen(
    a_move: &Move,
    end: f64,
    allowed: f64,
    careful: usize,
    fewest: &Fewest,
    encoding: Encoding,
    (turn, refused): (usize, &Refused),
) -> Result<Chosen, Unkept> {
    let coded = encoding == Encoding::Normalized16;
    let reserve = if coded { reserve(encoding, widest(a_move, fewest)) } else { 0.0 };
    let options = reduce::Options {
        tolerance: allowed,
        reserve: if matches!(a_move, Move::Travel(_)) { 0.0 } else { reserve },
        max_step: (!matches!(a_move, Move::Travel(_))).then_some(fewest.max_step),
        on_curve: fewest.on_curve,
        careful,
    };
    let coding = coded.then_some((encoding, reserve));
    let cubic = fewest.cubic;
    let chosen = match a_move {
        Move::Keys(motion) if motion.is_step() => return Ok(held(motion, encoding)),
        Move::Keys(motion) => {
            let curve = Turning::new(motion.clone());
            rotation(&InTurn { curve, turn, refused }, &options, cubic, coding)
        }
        Move::Attitude(Turn { at, knots, ramps }) => {
            let curve = Attitude::new(at, (0.0, end), knots, ramps);
            rotation(&InTurn { curve, turn, refused }, &options, cubic, coding)
        }
        Move::Travel(travel) => {
            let curve = Travelling::new(travel.as_ref(), (0.0, end), travel.jumps());
            place(&InTurn { curve, turn, refused }, &options, cubic)
        }
    };
    let travels = matches!(a_move, Move::Travel(_));
    chosen.map(|chosen| chosen.wait().span(end as f32)).map_err(|error| Unkept {
        error,
        unit: if travels { " units" } else { "°" },
        reserve: options.reserve,
        shared: fewest
            .distance
            .is_some_and(|distance| if travels { allowed < distance } else { allowed < fewest.tolerance }),
    })
}

/// The keys of a rotation; `coding` says by what numbers, and what these cost.
fn rotation(
    curve: &impl Curve<Value = Quat>,
    options: &reduce::Options,
    cubic: bool,
    coding: Option<(Encoding, f64)>,
) -> Result<Chosen, reduce::Error> {
    if cubic {
        return Ok(cubic_keys(
            reduce::cubic_rotation(curve, options)?,
            Values::Rotations,
            Values::CubicRotations,
        ));
    }
    let keys = reduce::rotation(curve, options)?;
    let keys = match coding {
        Some((encoding, reserve)) => recoded(keys, encoding, reserve),
        None => keys,
    };
    Ok(Chosen::new(keys.times, Values::Rotations(keys.values), &keys.facts, Interpolation::Linear))
}

/// The keys of a way.
fn place(
    curve: &impl Curve<Value = Numbers<3>>,
    options: &reduce::Options,
    cubic: bool,
) -> Result<Chosen, reduce::Error> {
    if cubic {
        return Ok(cubic_keys(reduce::cubic_numbers(curve, options)?, Values::Places, Values::CubicPlaces));
    }
    let keys = reduce::numbers(curve, options)?;
    Ok(Chosen::new(keys.times, Values::Places(keys.values), &keys.facts, Interpolation::Linear))
}

/// Keys for CUBICSPLINE playback; what is still has one for LINEAR playback, as a spline
/// of one key is none.
fn cubic_keys<const N: usize>(
    keys: CubicKeys<N>,
    plain: fn(Vec<[f32; N]>) -> Values,
    cubic: fn(Vec<[[f32; N]; 3]>) -> Values,
) -> Chosen {
    let CubicKeys { times, values, facts } = keys;
    match values[..] {
        [[_, value, _]] => Chosen::new(times, plain(vec![value]), &facts, Interpolation::Linear),
        _ => Chosen::new(times, cubic(values), &facts, Interpolation::CubicSpline),
    }
}

/// What coding adds to a playback's error: between two keys, each off by at most the
/// largest error e, the arc between them is off by at most e / cos(step / 4), the step
/// being the angle of the rotation from key to key (the norm of a Jacobi field of the unit
/// sphere at the middle of the arc, where it is largest). Lengths that are less even pull the
/// blend about besides.
fn reserve(encoding: Encoding, step: f64) -> f64 {
    let half = step.to_radians() / 2.0;
    let pulled = 2.0 * blend::uneven_lengths(half, encoding.lengths());
    encoding.largest_error() / libm::cos(half / 2.0) + pulled.to_degrees()
}

/// The largest turn from key to key, degrees: over the ramp of a jump it may be any.
fn widest(a_move: &Move, fewest: &Fewest) -> f64 {
    let jumps = match a_move {
        Move::Keys(motion) => motion.ramp().is_some(),
        Move::Attitude(Turn { ramps, .. }) => !ramps.is_empty(),
        Move::Travel(_) => false,
    };
    if jumps { 180.0 } else { fewest.max_step }
}

/// Keys as a file with fewer digits holds them.
fn recoded(mut keys: reduce::Keys<4>, encoding: Encoding, reserve: f64) -> reduce::Keys<4> {
    for value in &mut keys.values {
        *value = encoding.numbers(Quat::from_xyzw(value.map(f64::from)));
    }
    keys.facts.deviation += reserve;
    keys.facts.nlerp += reserve;
    keys.facts.keys_moved += reserve;
    keys
}

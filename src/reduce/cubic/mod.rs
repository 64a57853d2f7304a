//! The fewest keys for CUBICSPLINE playback.
//!
//! Between two keys a player runs Hermite's cubic through their values and tangents, and
//! normalises rotations after it. Keys lie on the curve; the tangents are those with which
//! the cubic meets it at two inner places. How, and what is proven: docs/math/cubicspline.md.

mod hermite;
mod proof;
mod search;

#[cfg(test)]
mod tests;

pub use hermite::Flat;
pub(crate) use hermite::Hermite;

use super::curve::on_ramp;
use super::search::Stuck;
use super::value::{Numbers, Value};
use super::{
    Curve, Error, Facts, HALF_DEGREE, NEGLIGIBLE, Options, STEP_SLACK, check, pace, steady, still, stops,
};
use crate::math::Quat;
use search::{Limits, Piece};

/// The keys of a channel as a file holds them, N numbers each: tangent in, value, tangent
/// out, tangents by second.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicKeys<const N: usize> {
    /// Seconds, increasing; one alone for a channel that is still.
    pub times: Vec<f32>,
    /// Rotations as x y z w with continuous signs. The first tangent in and the last
    /// tangent out are zero.
    pub values: Vec<[[f32; N]; 3]>,
    /// What is known of them.
    pub facts: Facts,
}

/// The fewest keys for a rotation. Tolerance and step in degrees.
pub fn cubic_rotation(curve: &impl Curve<Value = Quat>, options: &Options) -> Result<CubicKeys<4>, Error> {
    check(options, Options::LEAST_DEGREES)?;
    reduce(curve, options, HALF_DEGREE, NEGLIGIBLE * options.tolerance * HALF_DEGREE)
}

/// The fewest keys for numbers side by side.
pub fn cubic_numbers<const N: usize>(
    curve: &impl Curve<Value = Numbers<N>>,
    options: &Options,
) -> Result<CubicKeys<N>, Error> {
    check(options, 4.0 * super::largest_rounding(curve))?;
    reduce(curve, options, 1.0, NEGLIGIBLE * options.tolerance)
}

fn reduce<C: Curve<Value: Flat<N>>, const N: usize>(
    curve: &C,
    options: &Options,
    unit: f64,
    negligible: f64,
) -> Result<CubicKeys<N>, Error> {
    let tolerance = options.tolerance * unit;
    let step = options.max_step.map_or(f64::INFINITY, |step| step * unit).min(C::Value::LONGEST);
    let limits = Limits { tolerance, step, step_slack: STEP_SLACK * step };
    let stops = exact_stops(curve);
    if let Some(proven) = still(curve, &stops, tolerance) {
        let key = proven.keys[0];
        let facts = facts(curve, (proven.deviation, proven.moved, 0.0), unit);
        let zero = [0.0; N];
        return Ok(CubicKeys { times: vec![key.time], values: vec![[zero, key.stored, zero]], facts });
    }
    let stuck = |Stuck(time)| Error::Times { time, tolerance: options.tolerance };
    steady(curve)?;
    pace::check(curve, tolerance).map_err(stuck)?;
    pace::unwound(curve)?;
    let pieces = search::fewest(curve, &stops, limits).map_err(stuck)?;
    let proven = proof::prove(curve, pieces, limits, negligible).map_err(stuck)?;
    let longest =
        proven.pieces.iter().filter(|piece| !on_ramp(curve, piece.from.time)).map(way::<C::Value, N>);
    let facts = facts(curve, (proven.deviation, proven.moved, longest.fold(0.0, f64::max)), unit);
    let (times, values) = written(&proven.pieces);
    Ok(CubicKeys { times, values, facts })
}

/// The times that must be keys, and those at which one cubic that the curve is meets the
/// next: between them it is represented exactly.
fn exact_stops(curve: &impl Curve) -> Vec<f32> {
    let mut stops = stops(curve);
    let knots = curve.knots();
    let mut from = knots[0];
    for pair in knots[1..].windows(2) {
        let is_cubic = |to: f64| curve.cubic(from, to).is_some();
        let ends = is_cubic(pair[0]) && !is_cubic(pair[1]);
        if ends {
            stops.push(pair[0] as f32);
        }
        if ends || !is_cubic(pair[0]) {
            from = pair[0];
        }
    }
    stops.sort_by(f32::total_cmp);
    stops.dedup();
    stops
}

/// The way from key to key.
fn way<V: Flat<N>, const N: usize>(piece: &Piece<N>) -> f64 {
    let value = |stored: [f32; N]| V::read(stored);
    value(piece.from.value).distance(value(piece.to.value))
}

/// Players that blend rotations otherwise do not know tangents: of them nothing is said.
fn facts<C: Curve>(curve: &C, (deviation, moved, longest): (f64, f64, f64), unit: f64) -> Facts {
    let knots = curve.knots();
    Facts {
        deviation: deviation / unit,
        nlerp: f64::INFINITY,
        proven: curve.rates(knots[0], knots[1]).is_some(),
        largest_step: longest / unit,
        keys_moved: moved / unit,
    }
}

fn written<const N: usize>(pieces: &[Piece<N>]) -> (Vec<f32>, Vec<[[f32; N]; 3]>) {
    let mut times = vec![pieces[0].from.time];
    let mut values = vec![[[0.0; N], pieces[0].from.value, pieces[0].tangents[0]]];
    for (i, piece) in pieces.iter().enumerate() {
        let out = pieces.get(i + 1).map_or([0.0; N], |next| next.tangents[0]);
        times.push(piece.to.time);
        values.push([piece.tangents[1], piece.to.value, out]);
    }
    (times, values)
}

//! How far one cubic reaches from a key, and the cubics one after another.
//!
//! Keys lie on the curve. Tangents before and after a key are free of each other, so that
//! intervals are too: the furthest reach from key to key is the fewest there can be.

use super::hermite::{Flat, Hermite};
use crate::reduce::curve::{Curve, on_ramp};
use crate::reduce::search::Stuck;
use crate::reduce::value::{Numbers, Value};

/// Where an interval is looked at.
const LOOKS: u32 = 24;
/// The part of the tolerance that is aimed at: crests between looks are not met exactly.
const AIM: f64 = 0.985;
/// How closely the furthest reach is found, as a share of it.
const CLOSE: f64 = 1.01;

/// What holds for every interval, in the units of the values' distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) tolerance: f64,
    /// The longest way from key to key.
    pub(super) step: f64,
    /// What rounding may add to it.
    pub(super) step_slack: f64,
}

/// The end of an interval as a file holds it, with the tangents on either side, by second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key<const N: usize> {
    pub(super) time: f32,
    pub(super) value: [f32; N],
}

/// An interval with the tangents after its first key and before its last.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<const N: usize> {
    pub(super) from: Key<N>,
    pub(super) to: Key<N>,
    pub(super) tangents: [[f32; N]; 2],
}

impl<const N: usize> Piece<N> {
    pub(super) fn times(&self) -> (f64, f64) {
        (f64::from(self.from.time), f64::from(self.to.time))
    }

    /// The cubic that a player makes of it.
    pub(super) fn played(&self) -> Hermite<N> {
        let (from, to) = self.times();
        let exact = |stored: [f32; N]| Numbers(stored.map(f64::from));
        Hermite {
            ends: [exact(self.from.value), exact(self.to.value)],
            slopes: self.tangents.map(|tangent| exact(tangent) * (to - from)),
        }
    }
}

fn float<const N: usize>(numbers: Numbers<N>) -> [f32; N] {
    numbers.0.map(|x| x as f32)
}

/// The key at a time, in numbers as the curve has them.
pub(super) fn key<C: Curve<Value: Flat<N>>, const N: usize>(curve: &C, time: f32) -> Key<N> {
    Key { time, value: float(curve.at(f64::from(time)).flat(None)) }
}

/// The cubic from a key to a later time, whatever it is worth.
pub(super) fn fit<C: Curve<Value: Flat<N>>, const N: usize>(
    curve: &C,
    from: Key<N>,
    time: f32,
) -> (Piece<N>, Looks<C::Value, N>) {
    let (start, h) = (f64::from(from.time), f64::from(time) - f64::from(from.time));
    let exact = Numbers(from.value.map(f64::from));
    let looks = Looks::new(curve, exact, start, h);
    let to = Key { time, value: float(looks.end) };
    let ends = [exact, Numbers(to.value.map(f64::from))];
    // Between two looks, whose signs follow on.
    let inner = |u: f64| curve.at(start + u * h).flat(Some(looks.near(u)));
    let fitted = Hermite::through(ends, inner);
    (Piece { from, to, tangents: fitted.slopes.map(|slope| float(slope * (1.0 / h))) }, looks)
}

/// The curve at even moments of an interval.
pub(super) struct Looks<V, const N: usize> {
    values: Vec<V>,
    numbers: Vec<Numbers<N>>,
    end: Numbers<N>,
}

impl<V: Flat<N>, const N: usize> Looks<V, N> {
    fn new<C: Curve<Value = V>>(curve: &C, before: Numbers<N>, start: f64, h: f64) -> Looks<V, N> {
        let values: Vec<V> =
            (1..=LOOKS).map(|i| curve.at(start + h * f64::from(i) / f64::from(LOOKS))).collect();
        let follow = |before: &mut Numbers<N>, value: &V| {
            *before = value.flat(Some(*before));
            Some(*before)
        };
        let numbers: Vec<Numbers<N>> = values.iter().scan(before, follow).collect();
        let end = numbers[numbers.len() - 1];
        Looks { values, numbers, end }
    }

    fn near(&self, u: f64) -> Numbers<N> {
        let look = (u * f64::from(LOOKS)).round().max(1.0) as usize - 1;
        self.numbers[look.min(self.numbers.len() - 1)]
    }

    /// The largest distance of a cubic from the curve that the looks tell, crests between
    /// them included.
    fn worst(&self, played: &Hermite<N>) -> f64 {
        let off =
            |(i, value): (usize, &V)| V::shown(played.at((i + 1) as f64 / f64::from(LOOKS))).distance(*value);
        let mut before = [0.0, 0.0];
        let mut worst: f64 = 0.0;
        for now in self.values.iter().enumerate().map(off) {
            let [a, b] = before;
            let fall = 2.0 * b - a - now;
            let top = b >= a && b >= now && fall > 0.0;
            let crest = if top { b + (now - a) * (now - a) / (8.0 * fall) } else { now };
            worst = worst.max(crest.max(now));
            before = [b, now];
        }
        worst
    }
}

/// The cubic from a key to a time with the way between both, and whether it serves.
fn tried<C: Curve<Value: Flat<N>>, const N: usize>(
    curve: &C,
    limits: Limits,
    from: Key<N>,
    time: f32,
) -> (Piece<N>, f64, bool) {
    let (piece, looks) = fit(curve, from, time);
    let way = C::Value::read(from.value).distance(C::Value::read(piece.to.value));
    let short = way <= limits.step + limits.step_slack;
    (piece, way, short && looks.worst(&piece.played()) <= AIM * limits.tolerance)
}

/// The furthest interval from a key, up to `stop` at most; `guess` is about how long it is.
fn furthest<C: Curve<Value: Flat<N>>, const N: usize>(
    curve: &C,
    limits: Limits,
    from: Key<N>,
    stop: f32,
    guess: f64,
) -> Result<Piece<N>, Stuck> {
    let start = f64::from(from.time);
    let whole = f64::from(stop) - start;
    let mut best: Option<Piece<N>> = None;
    let (mut good, mut bad, mut h) = (0.0, f64::INFINITY, whole);
    let mut may_step = true;
    // Reaches change little from key to key; where they do change, they do by much.
    let mut growth: f64 = 1.1;
    loop {
        let next = best.map_or(from.time, |piece| piece.to.time).next_up();
        let time = ((start + h) as f32).clamp(next, stop);
        h = f64::from(time) - start;
        let (piece, way, serves) = tried(curve, limits, from, time);
        // What turns steadily is a step away at:
        let stepped = h * limits.step / way;
        if serves {
            (best, good) = (Some(piece), h);
            if time == stop || way >= limits.step || bad <= CLOSE * good {
                return Ok(piece);
            }
            h = (growth * good).min(0.5 * (good + bad));
            growth = (growth * growth).min(4.0);
        } else {
            if time == from.time.next_up() {
                return Err(Stuck(start));
            }
            bad = h;
            // Not twice in a row: where it rests, the way says nothing of the time.
            let step = may_step && good < stepped && stepped < h;
            may_step = !step;
            h = match good {
                _ if step => stepped,
                0.0 => (0.5 * h).min(guess),
                _ => 0.5 * (good + bad),
            };
        }
        let no_float_between = |piece: &Piece<N>| start + bad <= f64::from(piece.to.time.next_up());
        if let Some(piece) = best.filter(|piece| bad <= CLOSE * good || no_float_between(piece)) {
            return Ok(piece);
        }
    }
}

/// Intervals from the first stop to the last, each stop among their ends.
pub(super) fn fewest<C: Curve<Value: Flat<N>>, const N: usize>(
    curve: &C,
    stops: &[f32],
    limits: Limits,
) -> Result<Vec<Piece<N>>, Stuck> {
    let mut pieces: Vec<Piece<N>> = Vec::new();
    let mut from = key(curve, stops[0]);
    let mut guess = f64::INFINITY;
    for &stop in &stops[1..] {
        let limits =
            if on_ramp(curve, from.time) { Limits { step: f64::INFINITY, ..limits } } else { limits };
        while from.time < stop {
            let piece = furthest(curve, limits, from, stop, guess)?;
            guess = f64::from(piece.to.time) - f64::from(from.time);
            from = piece.to;
            pieces.push(piece);
        }
    }
    Ok(pieces)
}

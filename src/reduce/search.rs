//! The search for the fewest keys: a beam.
//!
//! All states of one round have the same number of keys. Each is carried on by one key
//! in several ways; of all that come out those stay that can reach furthest with the
//! key after. Which way served best is known at the end: every key knows its
//! predecessor.

use super::curve::{Curve, on_ramp};
use super::reach::{Ahead, Key, Limits, Remembered};
use super::value::Value;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// States that stay in each round.
const BEAM: usize = 3;
/// Ends that are looked ahead of in each round.
const LOOKS: usize = 8;
/// A key and the number of the key before it.
struct Node<V: Value> {
    key: Key<V>,
    before: usize,
}

/// Where no interval, however short, keeps the tolerance: seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stuck(pub(super) f64);

/// Keys from the first time to the last, at all `stops` (increasing; the first and the
/// last among them).
///
/// After so many `careful` rounds only the furthest ends are looked at, of which there are
/// several at a stop, and parts of what is left are searched side by side, for a few keys more
/// and a fraction of the time.
pub(super) fn fewest<C: Curve>(
    curve: &C,
    stops: &[f32],
    limits: Limits,
    careful: usize,
) -> Result<Vec<Key<C::Value>>, Stuck> {
    let exact = |time: f32| Key::new(time, curve.at(f64::from(time)));
    let careful = search(curve, stops, limits, exact(stops[0]), careful, || curve.is_given_up())?;
    let Found::Some(mut keys) = careful else { return Ok(careful.keys()) };
    let start = keys.pop().unwrap_or(exact(stops[0]));
    let swift = Limits { several: false, ..limits };
    // From the end, where float32 times are furthest apart: once a part is stuck, those whose turn
    // comes later need not be searched.
    let stuck = AtomicUsize::new(usize::MAX);
    let part = |(turn, stops): (usize, &Vec<f32>)| {
        let first = if stops[0] == start.time { start } else { exact(stops[0]) };
        let in_vain = || stuck.load(Ordering::Relaxed) < turn || curve.is_given_up();
        let found = search(curve, stops, swift, first, usize::MAX, in_vain).map(Found::keys);
        found.inspect_err(|_| {
            stuck.fetch_min(turn, Ordering::Relaxed);
        })
    };
    let parts = parts(curve.knots(), stops, start.time);
    let found: Vec<Result<_, Stuck>> = parts.par_iter().rev().enumerate().map(part).collect();
    let found: Vec<Vec<_>> = found.into_iter().collect::<Result<_, _>>()?;
    for part in found.into_iter().rev() {
        // Each but the first begins with the key that ends the one before.
        keys.extend(&part[usize::from(keys.last().is_some_and(|last| last.time == part[0].time))..]);
    }
    Ok(keys)
}

/// How many parts are searched side by side at most, however many threads there are, and how many
/// knots each has at least, since it may cost a key.
const PARTS: usize = 32;
const KNOTS: usize = 64;

/// The stops of the parts of what is left from a time on, cut at knots, an equal number to each.
fn parts(knots: &[f64], stops: &[f32], from: f32) -> Vec<Vec<f32>> {
    let last = stops[stops.len() - 1];
    let inner = |t: &f32| from < *t && *t < last;
    let knots: Vec<f32> = knots.iter().map(|&knot| knot as f32).filter(inner).collect();
    let parts = (knots.len() / KNOTS).clamp(1, PARTS);
    let mut cuts: Vec<f32> = (1..parts).map(|i| knots[i * knots.len() / parts]).collect();
    cuts.push(last);
    cuts.dedup();
    let mut before = from;
    let part = |cut: f32| {
        let between =
            stops.partition_point(|&stop| stop <= before)..stops.partition_point(|&stop| stop < cut);
        let part = [&[before], &stops[between], &[cut]].concat();
        before = cut;
        part
    };
    cuts.into_iter().map(part).collect()
}

/// What so many rounds of a search lead to.
enum Found<V: Value> {
    /// Keys up to the last stop.
    All(Vec<Key<V>>),
    /// Keys up to the one from which the next reaches furthest.
    Some(Vec<Key<V>>),
}

impl<V: Value> Found<V> {
    fn keys(self) -> Vec<Key<V>> {
        let (Found::All(keys) | Found::Some(keys)) = self;
        keys
    }
}

/// Keys from the first on to the last stop, or to where so many rounds lead, unless it turns out
/// to be `in_vain`.
fn search<C: Curve>(
    curve: &C,
    stops: &[f32],
    limits: Limits,
    first: Key<C::Value>,
    rounds: usize,
    in_vain: impl Fn() -> bool,
) -> Result<Found<C::Value>, Stuck> {
    let curve = &Remembered::new(curve);
    let last = stops[stops.len() - 1];
    let mut nodes = vec![Node { key: first, before: 0 }];
    let mut beam = vec![(0, look(curve, stops, limits, first, f64::from(last - first.time)))];
    for _ in 0..rounds {
        let mut ends: Vec<Node<C::Value>> = Vec::new();
        for (before, ahead) in &beam {
            ends.extend(ahead.ends().into_iter().map(|key| Node { key, before: *before }));
        }
        if let Some(end) = ends.iter().find(|end| end.key.time == last) {
            return Ok(Found::All(path(&nodes, end)));
        }
        if ends.is_empty() || in_vain() {
            return Err(Stuck(f64::from(beam[0].1.key().time)));
        }
        spread(&mut ends, &nodes, stops);
        thin_out(&mut ends, limits.tolerance);
        if !limits.several {
            let latest = ends[0].key.time;
            ends.retain(|end| end.key.time == latest);
        }
        let mut looks: Vec<(Node<C::Value>, Ahead<C>)> = Vec::with_capacity(ends.len());
        for end in ends {
            let before = nodes[end.before].key.time;
            // How long a jump's ramp lasts says nothing of what follows.
            let ramp = on_ramp(curve.curve, before);
            let guess = if ramp { f64::INFINITY } else { f64::from(end.key.time) - f64::from(before) };
            let ahead = look(curve, stops, limits, end.key, guess);
            looks.push((end, ahead));
        }
        looks.sort_by(|a, b| b.1.reach().total_cmp(&a.1.reach()));
        looks.truncate(if limits.several { BEAM } else { 1 });
        beam.clear();
        for (node, ahead) in looks {
            beam.push((nodes.len(), ahead));
            nodes.push(node);
        }
    }
    Ok(Found::Some(path(&nodes, &nodes[beam[0].0])))
}

fn look<'a, C: Curve>(
    curve: &'a Remembered<'a, C>,
    stops: &[f32],
    limits: Limits,
    key: Key<C::Value>,
    guess: f64,
) -> Ahead<'a, C> {
    let next = stops.partition_point(|&stop| stop <= key.time).min(stops.len() - 1);
    let limits =
        if on_ramp(curve.curve, key.time) { Limits { step: f64::INFINITY, ..limits } } else { limits };
    Ahead::new(curve, limits, key, (stops[next], next + 1 == stops.len()), guess)
}

/// Some players merge keys that are closer, seconds.
const APART: f64 = 1e-3;

/// Leaves out ends shortly before the next stop, where there are others.
fn spread<V: Value>(ends: &mut Vec<Node<V>>, nodes: &[Node<V>], stops: &[f32]) {
    let crowded = |end: &Node<V>| {
        let next = stops[stops.partition_point(|&stop| stop <= end.key.time).min(stops.len() - 1)];
        let (left, way) = (next - end.key.time, next - nodes[end.before].key.time);
        left > 0.0 && f64::from(left) < APART && f64::from(way) > 2.0 * APART
    };
    if ends.iter().any(|end| !crowded(end)) {
        ends.retain(|end| !crowded(end));
    }
}

/// Leaves the latest ends, and of those that are nearly the same one.
fn thin_out<V: Value>(ends: &mut Vec<Node<V>>, tolerance: f64) {
    ends.sort_by(|a, b| b.key.time.total_cmp(&a.key.time));
    let mut kept: Vec<Node<V>> = Vec::with_capacity(LOOKS);
    for end in ends.drain(..) {
        let same = |other: &Node<V>| {
            other.key.time == end.key.time && other.key.value.distance(end.key.value) < 0.05 * tolerance
        };
        if kept.len() < LOOKS && !kept.iter().any(same) {
            kept.push(end);
        }
    }
    *ends = kept;
}

fn path<V: Value>(nodes: &[Node<V>], end: &Node<V>) -> Vec<Key<V>> {
    let mut keys = vec![end.key];
    let mut at = end.before;
    while at > 0 {
        keys.push(nodes[at].key);
        at = nodes[at].before;
    }
    keys.push(nodes[0].key);
    keys.reverse();
    keys
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Ends, Motion, Rates, Scheme};
    use crate::math::{Quat, Vec3};
    use crate::reduce::Turning;

    #[test]
    fn parts_follow_each_other_and_hold_every_stop() {
        let knots: Vec<f64> = (0..3000).map(|i| 0.5 * f64::from(i)).collect();
        for (stops, from) in
            [(vec![0.0, 1499.5], 0.3), (vec![0.0, 7.0, 7.5, 100.0, 1499.5], 7.0), (vec![0.0, 1499.5], 1499.2)]
        {
            let parts = parts(&knots, &stops, from);
            assert!(parts.len() == PARTS || from > 1400.0);
            assert_eq!((parts[0][0], parts[parts.len() - 1].last()), (from, stops.last()));
            assert!(parts.windows(2).all(|pair| pair[0].last() == pair[1].first()));
            assert!(parts.iter().all(|part| part.windows(2).all(|pair| pair[0] < pair[1])));
            let held = |stop: &f32| parts.iter().any(|part| part.contains(stop));
            assert!(stops.iter().filter(|stop| **stop > from).all(held));
        }
    }

    #[test]
    fn side_by_side_costs_a_key_a_part() {
        let turns =
            (0..800).map(f64::from).map(|i| Vec3::new(i.sin(), (1.7 * i).cos(), (2.3 * i).sin()) * 0.2);
        let keys: Vec<Quat> = turns
            .scan(Quat::IDENTITY, |q, turn| {
                *q = *q * Quat::exp(turn);
                Some(*q)
            })
            .collect();
        let times: Vec<f64> = (0..800).map(|i| 0.1 * f64::from(i)).collect();
        let curve = Turning::new(Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural));
        let stops = [0.0, times[799] as f32];
        let tolerance = 0.05f64.to_radians() / 2.0;
        let limits = Limits { tolerance, step: 0.15, step_slack: 0.0, on_curve: false, several: true };
        let keys = fewest(&curve, &stops, limits, 300).unwrap();
        let swift = Limits { several: false, ..limits };
        let one = search(&curve, &stops, swift, keys[0], usize::MAX, || false).unwrap().keys();
        assert!(keys.len() > 600 && keys.len() <= one.len() + 800 / KNOTS, "{} {}", keys.len(), one.len());
        assert!(keys.windows(2).all(|pair| pair[0].time < pair[1].time));
        assert_eq!(keys[keys.len() - 1].time, stops[1]);
    }

    /// Counts how often a curve is asked for its value.
    struct Counted(Turning, AtomicUsize);

    impl Curve for Counted {
        type Value = Quat;
        fn at(&self, t: f64) -> Quat {
            self.1.fetch_add(1, Ordering::Relaxed);
            self.0.at(t)
        }
        fn knots(&self) -> &[f64] {
            self.0.knots()
        }
        fn corners(&self) -> &[f64] {
            self.0.corners()
        }
        fn rates(&self, from: f64, to: f64) -> Option<Rates> {
            self.0.rates(from, to)
        }
    }

    /// Through 3,000 keys that sway, the last of them in a whirl: an hour and a half from the
    /// start, where float32 times are half a millisecond apart.
    fn swaying(whirls: bool) -> Counted {
        let keys: Vec<Quat> =
            (0..3000).map(|i| Quat::exp(Vec3::new((0.9 * f64::from(i)).sin(), 0.0, 0.0))).collect();
        let whirl = |i: u32| if whirls && i == 2999 { -1.998 } else { 0.0 };
        let times: Vec<f64> = (0..3000).map(|i| 2.0 * f64::from(i) + whirl(i)).collect();
        let motion = Motion::new(&times, &keys, Scheme::CatmullRom, Ends::Natural);
        Counted(Turning::new(motion), AtomicUsize::new(0))
    }

    #[test]
    fn what_cannot_be_kept_late_is_seen_before_what_comes_early() {
        let tolerance = 0.05f64.to_radians();
        let limits = Limits { tolerance, step: 0.5, step_slack: 0.0, on_curve: false, several: true };
        let [calm, whirling] = [false, true].map(swaying);
        let end = |curve: &Counted| *curve.knots().last().unwrap() as f32;
        assert!(fewest(&calm, &[0.0, end(&calm)], limits, 100).is_ok());
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let stuck = alone.install(|| fewest(&whirling, &[0.0, end(&whirling)], limits, 100));
        assert!(matches!(stuck, Err(Stuck(time)) if time > 5990.0));
        let [all, some] = [calm, whirling].map(|curve| curve.1.into_inner());
        // The careful rounds, one part of 32, and a look into each of the others.
        assert!(some < all / 4, "{some} of {all}");
    }
}

//! The search for the fewest keys: a beam.
//!
//! All states of one round have the same number of keys. Each is carried on by one key
//! in several ways; of all that come out those stay that can reach furthest with the
//! key after. Which way served best is known at the end: every key knows its
//! predecessor.

use super::curve::Curve;
use super::reach::{Ahead, Key, Limits, Remembered};
use super::value::Value;

/// States that stay in each round.
const BEAM: usize = 3;
/// Ends that are looked ahead of in each round.
const LOOKS: usize = 8;
/// So many rounds; after them only the furthest ends are looked at, of which there are several
/// at a stop, for a few keys more and a fraction of the time.
pub(super) const CAREFUL: usize = 2048;

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
pub(super) fn fewest<C: Curve>(
    curve: &C,
    stops: &[f32],
    limits: Limits,
) -> Result<Vec<Key<C::Value>>, Stuck> {
    let curve = &Remembered::new(curve);
    let last = stops[stops.len() - 1];
    let first = Key::new(stops[0], curve.at(f64::from(stops[0])));
    let mut nodes = vec![Node { key: first, before: 0 }];
    let mut beam = vec![(0, look(curve, stops, limits, first, f64::from(last - stops[0])))];
    let mut round = 0;
    loop {
        let careful = round < CAREFUL;
        let limits = Limits { several: careful, ..limits };
        round += 1;
        let mut ends: Vec<Node<C::Value>> = Vec::new();
        for (before, ahead) in &beam {
            ends.extend(ahead.ends().into_iter().map(|key| Node { key, before: *before }));
        }
        if let Some(end) = ends.iter().find(|end| end.key.time == last) {
            return Ok(path(&nodes, end));
        }
        if ends.is_empty() {
            return Err(Stuck(f64::from(beam[0].1.key().time)));
        }
        spread(&mut ends, &nodes, stops);
        thin_out(&mut ends, limits.tolerance);
        if !careful {
            let latest = ends[0].key.time;
            ends.retain(|end| end.key.time == latest);
        }
        let mut looks: Vec<(Node<C::Value>, Ahead<C>)> = Vec::with_capacity(ends.len());
        for end in ends {
            let way = f64::from(end.key.time) - f64::from(nodes[end.before].key.time);
            let ahead = look(curve, stops, limits, end.key, way);
            looks.push((end, ahead));
        }
        looks.sort_by(|a, b| b.1.reach().total_cmp(&a.1.reach()));
        looks.truncate(if careful { BEAM } else { 1 });
        beam.clear();
        for (node, ahead) in looks {
            beam.push((nodes.len(), ahead));
            nodes.push(node);
        }
    }
}

fn look<'a, C: Curve>(
    curve: &'a Remembered<'a, C>,
    stops: &[f32],
    limits: Limits,
    key: Key<C::Value>,
    guess: f64,
) -> Ahead<'a, C> {
    let next = stops.partition_point(|&stop| stop <= key.time).min(stops.len() - 1);
    let ramps = curve.curve.ramps().iter().any(|&(from, to)| from as f32 <= key.time && key.time < to as f32);
    let limits = if ramps { Limits { step: f64::INFINITY, ..limits } } else { limits };
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

//! The times at which a course runs near the vertical.

use super::Tangent;
use super::facing::{Facing, tilt};
use rayon::prelude::*;

/// A stretch of time during which forward is within some angle of the vertical.
pub(super) struct Passage {
    pub(super) start: f64,
    pub(super) end: f64,
    /// The facing as it begins: none where the course starts with it.
    pub(super) before: Option<Facing>,
    /// The facing as it ends: none where the course ends with it.
    pub(super) after: Option<Facing>,
}

/// All passages nearer to the vertical than `limit`, radians, in order. On a closed
/// course one that runs across the seam has its ends on both sides of it.
pub(super) fn passages(tangent: &Tangent, limit: f64) -> Vec<Passage> {
    let mut found: Vec<Passage> = Vec::new();
    let open = |start, before| Passage { start, end: f64::INFINITY, before, after: None };
    let (start, facing) = tangent.node(0);
    if tilt(facing.forward) < limit {
        found.push(open(start, None));
    }
    let steps = (1..tangent.nodes()).into_par_iter();
    let crossings: Vec<Crossing> = steps.flat_map_iter(|i| crossings(tangent, limit, i)).collect();
    for Crossing { inwards, t, facing } in crossings {
        if inwards {
            found.push(open(t, Some(facing)));
        } else if let Some(passage) = found.last_mut() {
            (passage.end, passage.after) = (t, Some(facing));
        }
    }
    if tangent.course().is_closed() {
        join_at_seam(&mut found);
    }
    found
}

/// Where the limit is crossed, and the facing there, on the outside.
struct Crossing {
    inwards: bool,
    t: f64,
    facing: Facing,
}

/// The crossings in the step that ends at a node, in order.
fn crossings(tangent: &Tangent, limit: f64, node: usize) -> impl Iterator<Item = Crossing> {
    let [a, b] = [node - 1, node].map(|i| tangent.node(i));
    let [near_a, near_b] = [a, b].map(|(_, facing)| tilt(facing.forward) < limit);
    let inside = match (near_a, near_b) {
        (true, true) => None,
        (true, false) => Some(a.0),
        (false, true) => Some(b.0),
        (false, false) => dip(tangent, limit, a, b),
    };
    let crossing = move |outside, inwards| {
        inside.map(|inside| {
            let (t, facing) = last_outside(tangent, limit, outside, inside);
            Crossing { inwards, t, facing }
        })
    };
    let inwards = if near_a { None } else { crossing(a, true) };
    let outwards = if near_b { None } else { crossing(b, false) };
    inwards.into_iter().chain(outwards)
}

fn join_at_seam(found: &mut [Passage]) {
    let [first, .., last] = found else { return };
    if first.before.is_none() && last.after.is_none() {
        (first.before, last.after) = (last.before, first.after);
    }
}

/// The time between one outside and one inside at which the limit is crossed, by
/// bisection to the last bit, and the facing there.
fn last_outside(tangent: &Tangent, limit: f64, outside: (f64, Facing), inside: f64) -> (f64, Facing) {
    let (mut last, mut inside) = (outside.0, inside);
    for _ in 0..60 {
        let middle = 0.5 * (last + inside);
        if middle == last || middle == inside {
            break;
        }
        if tilt(tangent.forward(middle).1) < limit { inside = middle } else { last = middle }
    }
    // At a corner a time has two facings, of which this is the one.
    if last == outside.0 { outside } else { (last, tangent.facing(last).1) }
}

/// The time of least tilt between two nodes that are outside, if that is inside: a
/// search by thirds, since over so short a step forward runs along an arc.
fn dip(tangent: &Tangent, limit: f64, a: (f64, Facing), b: (f64, Facing)) -> Option<f64> {
    let turn = (a.1.forward - b.1.forward).length();
    // Tilt changes no faster than forward turns; an arc is at most 1.05 of its chord
    // up to one radian.
    if a.0 == b.0 || tilt(a.1.forward) + tilt(b.1.forward) > 2.0 * limit + 1.05 * turn {
        return None;
    }
    let tilted = |t: f64| tilt(tangent.forward(t).1);
    let (mut from, mut to) = (a.0, b.0);
    for _ in 0..60 {
        let (low, high) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if tilted(low) < tilted(high) { to = high } else { from = low }
    }
    let lowest = 0.5 * (from + to);
    (tilted(lowest) < limit).then_some(lowest)
}

//! The times at which a course runs near the vertical.

use super::Tangent;
use super::facing::{Facing, tilt};

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
    let near = |facing: Facing| tilt(facing.forward) < limit;
    let (mut t, mut facing) = tangent.node(0);
    let open = |start, before| Passage { start, end: f64::INFINITY, before, after: None };
    if near(facing) {
        found.push(open(t, None));
    }
    for i in 1..tangent.nodes() {
        let (next_t, next) = tangent.node(i);
        match (near(facing), near(next)) {
            (false, true) => {
                let (start, before) = crossing(tangent, limit, (t, facing), (next_t, next));
                found.push(open(start, Some(before)));
            }
            (true, false) => close(&mut found, crossing(tangent, limit, (next_t, next), (t, facing))),
            (false, false) => {
                if let Some(inside) = dip(tangent, limit, (t, facing), (next_t, next)) {
                    let (start, before) = crossing(tangent, limit, (t, facing), inside);
                    found.push(open(start, Some(before)));
                    close(&mut found, crossing(tangent, limit, (next_t, next), inside));
                }
            }
            (true, true) => {}
        }
        (t, facing) = (next_t, next);
    }
    if tangent.course().is_closed() {
        join_at_seam(&mut found);
    }
    found
}

fn close(found: &mut [Passage], (end, after): (f64, Facing)) {
    if let Some(passage) = found.last_mut() {
        (passage.end, passage.after) = (end, Some(after));
    }
}

fn join_at_seam(found: &mut [Passage]) {
    let [first, .., last] = found else { return };
    if first.before.is_none() && last.after.is_none() {
        (first.before, last.after) = (last.before, first.after);
    }
}

/// The time between one outside and one inside at which the limit is crossed, by
/// bisection to the last bit, and the facing there, on the outside.
fn crossing(tangent: &Tangent, limit: f64, outside: (f64, Facing), inside: (f64, Facing)) -> (f64, Facing) {
    let (mut outside, mut inside) = (outside, inside.0);
    for _ in 0..60 {
        let middle = 0.5 * (outside.0 + inside);
        if middle == outside.0 || middle == inside {
            break;
        }
        let (_, facing) = tangent.facing(middle);
        if tilt(facing.forward) < limit {
            inside = middle;
        } else {
            outside = (middle, facing);
        }
    }
    outside
}

/// The time of least tilt between two nodes that are outside, if that is inside: a
/// search by thirds, since over so short a step forward runs along an arc.
fn dip(tangent: &Tangent, limit: f64, a: (f64, Facing), b: (f64, Facing)) -> Option<(f64, Facing)> {
    let turn = (a.1.forward - b.1.forward).length();
    // Tilt changes no faster than forward turns; an arc is at most 1.05 of its chord
    // up to one radian.
    if a.0 == b.0 || tilt(a.1.forward) + tilt(b.1.forward) > 2.0 * limit + 1.05 * turn {
        return None;
    }
    let at = |t: f64| (t, tangent.facing(t).1);
    let (mut from, mut to) = (a.0, b.0);
    for _ in 0..60 {
        let (low, high) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if tilt(at(low).1.forward) < tilt(at(high).1.forward) { to = high } else { from = low }
    }
    Some(at(0.5 * (from + to))).filter(|(_, facing)| tilt(facing.forward) < limit)
}

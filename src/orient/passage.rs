//! The places at which a course runs near the vertical.

use super::facing::tilt;
use super::steps::{Spot, Steps};
use glam::DVec3;
use rayon::prelude::*;

/// A stretch of a course on which forward is within some angle of the vertical.
#[derive(Clone, Copy)]
pub(super) struct Passage {
    pub(super) start: f64,
    pub(super) end: f64,
    /// The last place before it: none where the course starts with it.
    pub(super) before: Option<Spot>,
    /// The first place after it: none where the course ends with it.
    pub(super) after: Option<Spot>,
}

/// All passages nearer to the vertical than `limit`, radians, in order. On a closed
/// course the first and the last may be one, across the seam: see [`meet_at_seam`].
pub(super) fn passages(steps: &Steps, limit: f64) -> Vec<Passage> {
    let cone = Cone { angle: limit, sine: libm::sin(limit) };
    let mut found: Vec<Passage> = Vec::new();
    let end = f64::INFINITY;
    let start = steps.start(0);
    if cone.holds(start.forward) {
        found.push(Passage { start: start.x, end, before: None, after: None });
    }
    let segments = (0..steps.segments()).into_par_iter();
    let crossings: Vec<Crossing> = segments.flat_map_iter(|i| in_segment(steps, cone, i)).collect();
    for Crossing { inwards, at } in crossings {
        if inwards {
            found.push(Passage { start: at.place.x, end, before: Some(at), after: None });
        } else if let Some(passage) = found.last_mut() {
            (passage.end, passage.after) = (at.place.x, Some(at));
        }
    }
    found
}

/// Whether the last of some passages runs on into the first, across the seam of a closed course.
pub(super) fn meet_at_seam(steps: &Steps, passages: &[Passage]) -> bool {
    let meet = matches!(passages, [first, .., last] if first.before.is_none() && last.after.is_none());
    meet && steps.course.is_closed()
}

/// Directions within an angle of the vertical, less than a right one.
#[derive(Clone, Copy)]
struct Cone {
    angle: f64,
    sine: f64,
}

impl Cone {
    fn holds(self, forward: DVec3) -> bool {
        sine(forward) < self.sine
    }
}

/// The sine of a unit vector's tilt.
fn sine(forward: DVec3) -> f64 {
    (forward.x * forward.x + forward.z * forward.z).sqrt()
}

/// Where the limit is crossed.
struct Crossing {
    inwards: bool,
    /// On the outside.
    at: Spot,
}

/// The crossings in a segment and where it meets the next, in order.
fn in_segment(steps: &Steps, cone: Cone, segment: usize) -> Vec<Crossing> {
    let mut spots: Vec<Spot> = steps.spots(segment).collect();
    let next = segment + 1;
    if next < steps.segments() {
        spots.push(Spot { segment: next, step: 0, place: steps.start(next) });
    }
    spots.windows(2).flat_map(|pair| in_step(steps, cone, pair[0], pair[1])).collect()
}

/// The crossings between the ends of a step, in order.
fn in_step(steps: &Steps, cone: Cone, a: Spot, b: Spot) -> impl Iterator<Item = Crossing> {
    let [near_a, near_b] = [a, b].map(|spot| cone.holds(spot.place.forward));
    let inside = match (near_a, near_b) {
        (true, true) => None,
        (true, false) => Some(a.place.x),
        (false, true) => Some(b.place.x),
        (false, false) => dip(steps, cone, a, b),
    };
    let crossing = |outside, inwards| {
        inside.map(|inside| Crossing { inwards, at: last_outside(steps, cone, outside, inside) })
    };
    let inwards = if near_a { None } else { crossing(a, true) };
    let outwards = if near_b { None } else { crossing(b, false) };
    inwards.into_iter().chain(outwards)
}

/// The place between one outside and one inside at which the limit is crossed, by
/// bisection to the last bit.
fn last_outside(steps: &Steps, cone: Cone, outside: Spot, inside: f64) -> Spot {
    let (mut last, mut inside) = (outside.place, inside);
    for _ in 0..60 {
        let x = 0.5 * (last.x + inside);
        if x == last.x || x == inside {
            break;
        }
        let middle = steps.place(x, last.forward);
        if cone.holds(middle.forward) { inside = x } else { last = middle }
    }
    // At a corner a place has two directions, of which this is the one.
    if last.x == outside.place.x { outside } else { steps.in_segment(outside.segment, last.x) }
}

/// The place of least tilt between the ends of a step that are outside, if that is inside: a
/// search by thirds, since over so short a step forward runs along an arc.
fn dip(steps: &Steps, cone: Cone, a: Spot, b: Spot) -> Option<f64> {
    let [a, b] = [a.place, b.place];
    let turn = (a.forward - b.forward).length();
    // Tilt changes no faster than forward turns; an arc is at most 1.05 of its chord
    // up to one radian. It is no less than its sine, which is had for less.
    let reach = 2.0 * cone.angle + 1.05 * turn;
    let [sine_a, sine_b] = [a, b].map(|place| sine(place.forward));
    if a.x == b.x || sine_a + sine_b > reach || tilt(a.forward) + tilt(b.forward) > reach {
        return None;
    }
    let tilted = |x: f64| sine(steps.place(x, a.forward).forward);
    let (mut from, mut to) = (a.x, b.x);
    for _ in 0..60 {
        let (low, high) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if tilted(low) < tilted(high) { to = high } else { from = low }
    }
    let lowest = 0.5 * (from + to);
    cone.holds(steps.place(lowest, a.forward).forward).then_some(lowest)
}

//! Up near +Y, also where the course runs near the vertical.

use super::carry::Carry;
use super::facing::{Facing, tilt};
use super::passage::{Passage, passages};
use super::steps::{Spot, Steps};
use super::transport::{Stretch, Transport};
use super::{smoothstep, wrapped};
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Nearer to the vertical than this, radians, up is no longer told by +Y alone.
pub(super) const STEEP: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Up along a course.
pub(super) enum Steep {
    /// All of which is steep: as without twist.
    All(Transport),
    /// Which is steep here and there.
    Some { carry: Carry, passages: Vec<Steeped> },
}

/// A passage, and what is known of up on it.
pub(super) struct Steeped {
    passage: Passage,
    /// Up as it is carried along.
    carried: Stretch,
    /// The roll, relative to that, of the up that the passage keeps.
    kept: f64,
}

impl Steep {
    pub(super) fn new(steps: &Steps) -> Steep {
        let passages = passages(steps, STEEP);
        if let [Passage { before: None, after: None, .. }] = passages[..] {
            return Steep::All(Transport::new(steps));
        }
        let carry = Carry::new(steps, false);
        let carried = carried(steps, &carry, &passages);
        let roll = |i: usize, edge: &Spot| carried[i].facing(&carry, steps, edge).roll_to_upright();
        let (last, is_joined) = (carried.len().saturating_sub(1), joined(&passages));
        let kept = |i: usize| {
            // Across the seam each has one of the edges of both.
            let edges = if is_joined && (i == 0 || i == last) { [last, 0] } else { [i, i] };
            let Passage { before, after, .. } = &passages[i];
            kept(before.map(|edge| roll(edges[0], &edge)), after.map(|edge| roll(edges[1], &edge)))
        };
        let kept: Vec<f64> = (0..passages.len()).into_par_iter().map(kept).collect();
        let all = passages.into_iter().zip(carried).zip(kept);
        let passages = all.map(|((passage, carried), kept)| Steeped { passage, carried, kept }).collect();
        Steep::Some { carry, passages }
    }

    /// Facing at a spot.
    pub(super) fn facing(&self, steps: &Steps, spot: &Spot) -> Facing {
        match self {
            Steep::All(transport) => transport.facing(steps, spot),
            Steep::Some { carry, passages } => {
                let next = passages.partition_point(|steep| steep.passage.end < spot.place.x);
                match passages.get(next) {
                    Some(steep) if steep.holds(spot) => steep.facing(carry, steps, spot),
                    _ => Facing::upright(spot.place.forward),
                }
            }
        }
    }
}

impl Steeped {
    /// Whether a spot is on the passage; not on the other side of a corner at its edge.
    fn holds(&self, spot: &Spot) -> bool {
        let on = self.passage.start <= spot.place.x && spot.place.x <= self.passage.end;
        on && self.carried.segments().contains(&spot.segment)
    }

    fn facing(&self, carry: &Carry, steps: &Steps, spot: &Spot) -> Facing {
        let facing = self.carried.facing(carry, steps, spot);
        // A course that ends steep, or starts so, has no upright to come back to: what
        // is carried to its end cannot be opposed on the way.
        let passes = self.passage.before.is_some() && self.passage.after.is_some();
        let weight = if passes { smoothstep(tilt(spot.place.forward) / STEEP) } else { 0.0 };
        facing.rolled(self.kept + blend(facing.roll_to_upright() - self.kept, weight))
    }
}

/// Up carried along each passage; from the last on to the first where they are one across the
/// seam.
fn carried(steps: &Steps, carry: &Carry, passages: &[Passage]) -> Vec<Stretch> {
    let along = |passage: &Passage| Stretch::new(carry, steps, segments(steps, passage), None);
    let mut carried: Vec<Stretch> = passages.par_iter().map(along).collect();
    if let (true, Some(last)) = (joined(passages), carried.last()) {
        let end = last.end(carry, steps);
        carried[0] = Stretch::new(carry, steps, segments(steps, &passages[0]), Some(end));
    }
    carried
}

/// Whether the last passage is the first one's beginning, across the seam.
fn joined(passages: &[Passage]) -> bool {
    matches!(passages, [first, .., _] if first.before.is_some_and(|edge| edge.place.x != first.start))
}

/// The segments that a passage and its own edges lie in.
fn segments(steps: &Steps, passage: &Passage) -> RangeInclusive<usize> {
    let own = |edge: Option<Spot>, x: f64| {
        let edge = edge.filter(|edge| edge.place.x == x);
        edge.map_or_else(|| steps.segment(x), |edge| edge.segment)
    };
    own(passage.before, passage.start)..=own(passage.after, passage.end)
}

/// The roll that a passage keeps: halfway from that at its start to that at its end, or
/// of the one it has.
fn kept(before: Option<f64>, after: Option<f64>) -> f64 {
    match (before, after) {
        (Some(before), Some(after)) => before + 0.5 * wrapped(after - before),
        (one, other) => one.or(other).unwrap_or(0.0),
    }
}

/// The direction of (1 − w) + w e^{iφ}: from 0 to φ with the weight, by the mean of the
/// two ups rather than of the angles, so that whole turns of φ do not count.
fn blend(angle: f64, weight: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    (weight * sin).atan2(1.0 - weight + weight * cos)
}

//! Up near +Y, also where the course runs near the vertical.

use super::carry::{Carry, Node};
use super::facing::{Facing, tilt};
use super::passage::{Passage, meet_at_seam, passages};
use super::steps::{Spot, Steps};
use super::transport::{Roll, Stretch, Transport};
use super::{smoothstep, wrapped};
use rayon::prelude::*;

/// Nearer to the vertical than this, radians, up is no longer told by +Y alone.
pub(super) const STEEP: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Up along a course.
pub(super) enum Steep {
    /// All of which is steep: as without twist.
    All(Transport),
    /// Which is steep here and there.
    Some { carry: Carry, passages: Vec<Steeped> },
}

/// A passage, and up as it is carried along.
pub(super) struct Steeped {
    passage: Passage,
    carried: Stretch,
    /// The rolls, relative to that, of the up nearest to +Y where the passage begins and ends.
    edges: [Option<f64>; 2],
}

impl Steep {
    pub(super) fn new(steps: &Steps) -> Steep {
        let passages = passages(steps, STEEP);
        if let [Passage { before: None, after: None, .. }] = passages[..] {
            return Steep::All(Transport::new(steps));
        }
        let meet = meet_at_seam(steps, &passages);
        let carry = Carry::new(steps, false);
        let along = |passage| Steeped::new(&carry, steps, passage, None);
        let mut passages: Vec<Steeped> = passages.into_par_iter().map(along).collect();
        if let (true, [first, .., last]) = (meet, &mut passages[..]) {
            first.follow(&carry, steps, last);
        }
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
    /// Carried on from the end of a segment with its roll, or by itself.
    fn new(carry: &Carry, steps: &Steps, passage: Passage, from: Option<(Node, Roll)>) -> Steeped {
        let segment = |edge: Option<Spot>, x: f64| edge.map_or_else(|| steps.segment(x), |edge| edge.segment);
        let segments = segment(passage.before, passage.start)..=segment(passage.after, passage.end);
        let carried = Stretch::new(carry, steps, segments, from);
        let roll = |edge: Spot| carried.facing(carry, steps, &edge).roll_to_upright();
        let edges = [passage.before, passage.after].map(|edge| edge.map(roll));
        Steeped { passage, carried, edges }
    }

    /// Makes it one with the last passage, from which it follows on across the seam.
    fn follow(&mut self, carry: &Carry, steps: &Steps, last: &mut Steeped) {
        let end = last.carried.end(carry, steps);
        *self = Steeped::new(carry, steps, self.passage, Some(end));
        (self.edges[0], last.edges[1]) = (last.edges[0], self.edges[1]);
    }

    /// Whether a spot is on the passage; not on the other side of a corner at its edge.
    fn holds(&self, spot: &Spot) -> bool {
        let on = self.passage.start <= spot.place.x && spot.place.x <= self.passage.end;
        on && self.carried.segments().contains(&spot.segment)
    }

    fn facing(&self, carry: &Carry, steps: &Steps, spot: &Spot) -> Facing {
        let facing = self.carried.facing(carry, steps, spot);
        let kept = self.kept();
        // A course that ends steep, or starts so, has no upright to come back to: what
        // is carried to its end cannot be opposed on the way.
        let passes = self.edges.iter().all(Option::is_some);
        let weight = if passes { smoothstep(tilt(spot.place.forward) / STEEP) } else { 0.0 };
        facing.rolled(kept + blend(facing.roll_to_upright() - kept, weight))
    }

    /// The roll, relative to what is carried, of the up that the passage keeps: halfway from that
    /// at its start to that at its end, or of the one it has.
    fn kept(&self) -> f64 {
        match self.edges {
            [Some(before), Some(after)] => before + 0.5 * wrapped(after - before),
            [one, other] => one.or(other).unwrap_or(0.0),
        }
    }
}

/// The direction of (1 − w) + w e^{iφ}: from 0 to φ with the weight, by the mean of the
/// two ups rather than of the angles, so that whole turns of φ do not count.
fn blend(angle: f64, weight: f64) -> f64 {
    let (sin, cos) = libm::sincos(angle);
    libm::atan2(weight * sin, 1.0 - weight + weight * cos)
}

//! `upright`: forward along the course, head up.

use super::bank::Bank;
use super::facing::{Facing, roll, tilt};
use super::passage::{Passage, passages};
use super::{Attitude, Course, Signs, Tangent, smoothstep, wrapped};
use crate::math::Quat;
use glam::DVec3;

/// Nearer to the vertical than this, radians, up is no longer told by +Y alone.
pub(super) const STEEP: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Forward along the course, up as near to +Y as it can be, leaning into turns.
///
/// Within 15° of the vertical, where "nearest to +Y" turns about in no time, up blends
/// to one that is carried along without twist, halfway between what +Y asks for on the
/// way in and on the way out: a loop rolls smoothly there and does not flip.
pub struct Upright<'a> {
    tangent: Tangent<'a>,
    /// Each with the roll, relative to the tangent's up, of the up that is carried.
    steep: Vec<(Passage, f64)>,
    bank: Option<Bank>,
    signs: Signs,
}

impl<'a> Upright<'a> {
    /// `bank`: the lean in the sharpest turn, degrees; negative leans out of turns.
    pub fn new(course: &'a dyn Course, bank: f64) -> Self {
        let tangent = Tangent::new(course);
        let steep =
            passages(&tangent, STEEP).into_iter().map(|p| (carried(&p), p)).map(|(roll, p)| (p, roll));
        let steep = steep.collect();
        let bank = (bank != 0.0 && course.duration() > 0.0).then(|| Bank::new(course, bank));
        let mut upright = Upright { tangent, steep, bank, signs: Signs::default() };
        upright.signs = Signs::continued(upright.tangent.nodes(), |i| upright.at_node(i));
        upright
    }

    /// The rotation at a node, its sign as it comes; at a corner what follows it.
    fn at_node(&self, i: usize) -> Quat {
        let (t, _) = self.tangent.node(i);
        let last = (i + 1..self.tangent.nodes()).take_while(|&j| self.tangent.node(j).0 == t).last();
        let facing = self.tangent.node(last.unwrap_or(i)).1;
        self.turned(t, facing.forward, || facing)
    }

    /// The rotation along a forward at a time, and what is carried there without twist.
    fn turned(&self, t: f64, forward: DVec3, carried: impl Fn() -> Facing) -> Quat {
        let lean = self.bank.as_ref().map_or(0.0, |bank| bank.at(t));
        let Some((passage, kept)) = self.steep_at(t) else {
            return Facing::upright(forward).rotation() * roll(lean);
        };
        let facing = carried();
        // A course that ends steep, or starts so, has no upright to come back to: what
        // is carried to its end cannot be opposed on the way.
        let passes = passage.before.is_some() && passage.after.is_some();
        let weight = if passes { smoothstep(tilt(forward) / STEEP) } else { 0.0 };
        let blended = kept + blend(facing.roll_to_upright() - kept, weight);
        facing.rotation() * roll(blended + lean)
    }

    /// The steep passage that holds a time, and the roll that is carried through it.
    fn steep_at(&self, t: f64) -> Option<(&Passage, f64)> {
        let next = self.steep.partition_point(|(passage, _)| passage.end < t);
        self.steep.get(next).filter(|(passage, _)| passage.start <= t).map(|(passage, roll)| (passage, *roll))
    }
}

impl Attitude for Upright<'_> {
    fn at(&self, t: f64) -> Quat {
        let (node, forward) = self.tangent.forward(t);
        self.signs.follow(node, self.turned(t, forward, || self.tangent.facing(t).1))
    }

    fn tangent(&self) -> &Tangent<'_> {
        &self.tangent
    }
}

/// The roll that a passage keeps: halfway from that at its start to that at its end, or
/// of the one it has; none where all of the course is steep.
fn carried(passage: &Passage) -> f64 {
    let [before, after] = [passage.before, passage.after].map(|f| f.map(|f| f.roll_to_upright()));
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

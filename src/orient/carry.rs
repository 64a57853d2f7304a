//! Up carried along one segment with the least twist.
//!
//! A step turns by the shortest arc, and rolls by the area that lies on the sphere of
//! directions between that arc and the way that the course takes. A rule of two points
//! sums the area; its error is of the seventh order in the step, and made up for by
//! what two half steps find. Derivation: docs/math/orientation.md.

use super::Course;
use super::facing::{self, Facing};
use super::recent::Recent;
use super::steps::{LARGEST_TURN, Place, Steps, turn};
use crate::math::Quat;
use glam::DVec3;
use std::sync::Arc;

/// The twist that the steps of a whole course may add up to: half of the 1e-6 degrees
/// that are promised, since what judges a step is an estimate.
const TOLERANCE: f64 = 0.5e-6 * std::f64::consts::PI / 180.0;

/// An error in twist that is always good enough for a step, radians. It takes 80 000
/// steps of it to miss the promise, thousands of segments that wind.
const LEAST: f64 = 1e-13;

/// The same on a course of more segments than [`MANY`]: its steps would become so short that
/// they take more time than all else.
const LEAST_OF_MANY: f64 = 1e-10;
const MANY: usize = 2000;

/// Halvings for accuracy: the error of a step falls by 2⁻⁷⁰.
const DEEPEST: u32 = 10;

/// Nodes and weights of Gauss's rule of two points for what begins as the square of 0..=1: as
/// exact for it as three points are elsewhere, up to degree 5. The nodes are 2/3 ± √(2/45),
/// their weights w/x² with w those of Gauss and Jacobi for the weight x².
const GAUSS: [(f64, f64); 2] =
    [(0.455_848_155_988_774_7, 0.485_019_608_222_464_67), (0.877_485_177_344_558_6, 0.302_017_428_814_572_4)];

/// A place on the course whose up is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    x: f64,
    /// As carried from the up nearest to +Y where the segment begins.
    facing: Facing,
    /// The roll that the step from here is short of at its end, radians; none where the
    /// course turns within an instant, and the step is the shortest arc alone.
    short: Option<f64>,
    /// Whether the segment has turned back on itself.
    mirrored: bool,
    /// Whether the rotation takes the other sign to follow on from that of the node before.
    turned: bool,
    /// Arc length from where the segment begins; 0 unless it is measured.
    pub(super) length: f64,
}

impl Node {
    /// What the up becomes that the segment begins with rolled. What carries up does not mind
    /// how it is rolled, but that it looks the other way after a reversal, which is about up.
    pub(super) fn rolled(&self, roll: f64) -> Facing {
        self.facing.rolled(self.own(roll))
    }

    fn own(&self, roll: f64) -> f64 {
        if self.mirrored { -roll } else { roll }
    }

    /// The same as a rotation, its sign continuous along the segment.
    pub(super) fn rotation(&self, roll: f64) -> Quat {
        self.signed() * facing::roll(self.own(roll))
    }

    fn signed(&self) -> Quat {
        let q = self.facing.rotation();
        if self.turned { -q } else { q }
    }

    /// The same, its sign following on from that of a node before.
    pub(super) fn following(self, before: &Node) -> Node {
        let q = self.facing.rotation();
        Node { turned: q.aligned_to(before.signed()) != q, ..self }
    }
}

/// Carries up along segments, each from the up nearest to +Y where it begins.
pub(super) struct Carry {
    /// An error in twist that is good enough for any step, radians.
    least: f64,
    /// Whether arc lengths are summed too.
    measures: bool,
    recent: Recent<Vec<Node>>,
}

impl Carry {
    pub(super) fn new(steps: &Steps, measures: bool) -> Self {
        let segments = steps.segments();
        let least = if segments > MANY { LEAST_OF_MANY } else { LEAST };
        Carry { least, measures, recent: Recent::new(segments) }
    }

    /// The start of a segment.
    pub(super) fn start(&self, steps: &Steps, segment: usize) -> Node {
        let Place { x, forward } = steps.start(segment);
        Node { x, facing: Facing::upright(forward), short: None, mirrored: false, turned: false, length: 0.0 }
    }

    /// The end of a segment.
    pub(super) fn end(&self, steps: &Steps, segment: usize) -> Node {
        let nodes = self.nodes(steps, segment);
        nodes[nodes.len() - 1]
    }

    /// A place in a segment, behind the node that its step begins with.
    pub(super) fn at(&self, steps: &Steps, segment: usize, place: Place) -> [Node; 2] {
        let nodes = self.nodes(steps, segment);
        let i = nodes.partition_point(|node| node.x <= place.x).saturating_sub(1);
        let (node, next) = (&nodes[i], nodes.get(i + 1));
        let mut here = self.turned(steps, node, place);
        if let (Some(short), Some(next)) = (node.short, next) {
            let part = (place.x - node.x) / (next.x - node.x);
            let roll = roll(steps.course, node.facing.forward, node.x, place.x);
            here.facing = here.facing.rolled(roll + short * part.powi(7));
        }
        [*node, here]
    }

    pub(super) fn nodes(&self, steps: &Steps, segment: usize) -> Arc<Vec<Node>> {
        self.recent.get(segment, || self.carried(steps, segment))
    }

    /// The nodes of a partition that resolves a segment, in order.
    fn carried(&self, steps: &Steps, segment: usize) -> Vec<Node> {
        let places = steps.of(segment);
        let mut nodes = Vec::with_capacity(2 * places.len());
        nodes.push(self.start(steps, segment));
        let mut halvings = steps.halvings;
        for pair in places.windows(2) {
            let share = TOLERANCE * steps.share(pair[0].x, pair[1].x);
            let effort = Effort { depth: 0, least: self.least, share, twist: f64::INFINITY };
            self.step(steps, &mut nodes, pair[1], effort, &mut halvings);
        }
        nodes
    }

    /// A step from the last node to a place, halved until one step and two agree on the twist.
    fn step(&self, steps: &Steps, nodes: &mut Vec<Node>, end: Place, effort: Effort, halvings: &mut usize) {
        let last = nodes.len() - 1;
        let start = nodes[last];
        let from = Place { x: start.x, forward: start.facing.forward };
        let middle = steps.middle(from, end).filter(|&middle| turn([from, middle, end]) <= LARGEST_TURN);
        let mut next = self.turned(steps, &start, end);
        if let Some(middle) = middle {
            let [whole, half, rest] = [(from, end), (from, middle), (middle, end)]
                .map(|(from, to)| roll(steps.course, from.forward, from.x, to.x));
            let whole = next.facing.rolled(whole);
            let half = start.facing.turned_to(middle.forward).rolled(half);
            let twist = whole.roll_to(half.turned_to(end.forward).rolled(rest).up);
            if effort.is_asked(turn([from, middle, end]), twist.abs()) && *halvings > 0 {
                *halvings -= 1;
                self.step(steps, nodes, middle, effort.halved(twist.abs()), halvings);
                return self.step(steps, nodes, end, effort.halved(twist.abs()), halvings);
            }
            // Richardson: two steps err by 1/64 of what one does.
            let short = twist * 64.0 / 63.0;
            next.facing = whole.rolled(short);
            nodes[last].short = Some(short);
        }
        nodes.push(next.following(&start));
    }

    /// A place that a node's step leads to, turned to by the shortest arc.
    fn turned(&self, steps: &Steps, node: &Node, place: Place) -> Node {
        let way = if self.measures { length(steps.course, node.x, place.x) } else { 0.0 };
        Node {
            x: place.x,
            facing: node.facing.turned_to(place.forward),
            short: None,
            mirrored: node.mirrored != node.facing.is_against(place.forward),
            turned: false,
            length: node.length + way,
        }
    }
}

/// How far a step has been halved, and for what.
#[derive(Clone, Copy)]
struct Effort {
    depth: u32,
    /// What is good enough in any case, radians.
    least: f64,
    /// The twist it may add, radians.
    share: f64,
    /// What one step and two differed by before it was halved, radians.
    twist: f64,
}

impl Effort {
    fn halved(self, twist: f64) -> Effort {
        Effort { depth: self.depth + 1, share: 0.5 * self.share, twist, ..self }
    }

    /// Whether a step that turns and twists so much is to be halved.
    fn is_asked(self, turn: f64, twist: f64) -> bool {
        // What is left once the difference is made up for is of the seventh order, less by
        // about the square of the turn; not to trust that too far, by 100 at most. What
        // does not shrink with the step is rounding.
        let left = twist * (4.0 * turn * turn).clamp(0.01, 1.0);
        let resolved = left <= self.share.max(self.least);
        let rounding = twist < 1e-8 && twist > self.twist / 8.0;
        !resolved && !rounding && self.depth < DEEPEST
    }
}

/// The roll from the shortest arc, out of a forward, to what is carried without twist
/// between two places of a step.
fn roll(course: &dyn Course, forward: DVec3, from: f64, to: f64) -> f64 {
    let rate = |x: f64| {
        let [velocity, acceleration] = course.rates_at(x);
        let speed = velocity.length();
        let turning = forward.dot(velocity.cross(acceleration));
        let rate = turning / (speed * (speed + forward.dot(velocity)));
        // Where the course stands it does not turn.
        if rate.is_finite() { rate } else { 0.0 }
    };
    let step = to - from;
    step * GAUSS.iter().map(|(x, weight)| weight * rate(from + x * step)).sum::<f64>()
}

/// Arc length between two places of a step, in which the course turns by a fraction of a
/// radian: Gauss's rule of five points.
fn length(course: &dyn Course, from: f64, to: f64) -> f64 {
    const NODES: [(f64, f64); 3] = [
        (0.0, 128.0 / 225.0),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let speed = |x: f64| course.rates_at(middle + half * x)[0].length();
    let sum = |(x, weight): (f64, f64)| weight * if x == 0.0 { speed(x) } else { speed(x) + speed(-x) };
    half * NODES.into_iter().map(sum).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_from_the_second_to_the_fifth_degree() {
        let error = |k: i32| GAUSS.iter().map(|(x, w)| w * x.powi(k)).sum::<f64>() - 1.0 / f64::from(k + 1);
        assert!((2..=5).all(|k| error(k).abs() < 1e-15));
        // Others must fail, or this says nothing.
        assert!([0, 1, 6].iter().all(|&k| error(k).abs() > 1e-4));
    }
}

//! `tangent`: forward along the course, up with the least possible twist.

use super::facing::Facing;
use super::transport::Transport;
use super::{Attitude, Course, Signs, wrapped};
use crate::math::Quat;
use glam::DVec3;
use std::sync::OnceLock;

/// Forward along the course at every time, up carried along without twist.
///
/// It starts with the up nearest to +Y (straight up or down: with what pitching from
/// +Z makes of it), turns at corners by the shortest arc, and is exact to 1e-6 degrees
/// at any time, whatever other times it is asked at; where thousands of segments wind, by
/// measure and not by proof (docs/math/orientation.md). On a closed course the twist that is left over at the
/// end is spread in proportion to arc length.
pub struct Tangent<'a> {
    transport: Transport<'a>,
    spread: Option<Spread>,
    /// Worked out where they are asked for.
    signs: OnceLock<Signs>,
}

/// Twist in proportion to arc length.
struct Spread {
    /// Arc length up to each node.
    lengths: Vec<f64>,
    /// Radians per unit of length.
    rate: f64,
}

impl<'a> Tangent<'a> {
    /// Carries up along the whole course.
    pub fn new(course: &'a dyn Course) -> Self {
        let transport = Transport::new(course);
        let spread = course.is_closed().then(|| Spread::new(&transport)).flatten();
        Tangent { transport, spread, signs: OnceLock::new() }
    }

    /// The rotation at a time, seconds: of unit length, its sign continuous wherever
    /// the rotation is.
    pub fn at(&self, t: f64) -> Quat {
        let (node, facing) = self.facing(t);
        let rotation = |i| self.node(i).1.rotation();
        self.signs.get_or_init(|| Signs::continued(self.nodes(), rotation)).follow(node, facing.rotation())
    }

    pub(super) fn course(&self) -> &'a dyn Course {
        self.transport.course
    }

    /// How many nodes the partition has.
    pub(super) fn nodes(&self) -> usize {
        self.transport.nodes.len()
    }

    /// Time and facing at a node of the partition.
    pub(super) fn node(&self, i: usize) -> (f64, Facing) {
        let node = &self.transport.nodes[i];
        let twist = self.spread.as_ref().map_or(0.0, |s| s.rate * s.lengths[i]);
        (node.t, node.facing.rolled(twist))
    }

    /// The last node at or before a time.
    pub(super) fn index(&self, t: f64) -> usize {
        self.transport.index(t)
    }

    /// Forward at a time, and the last node before it.
    pub(super) fn forward(&self, t: f64) -> (usize, DVec3) {
        self.transport.forward(t)
    }

    /// The facing at a time, and the last node before it.
    pub(super) fn facing(&self, t: f64) -> (usize, Facing) {
        let (i, facing) = self.transport.at(t);
        let Some(spread) = &self.spread else { return (i, facing) };
        let since = length(self.course(), self.transport.nodes[i].t, self.transport.within(t));
        (i, facing.rolled(spread.rate * (spread.lengths[i] + since)))
    }
}

impl Attitude for Tangent<'_> {
    fn at(&self, t: f64) -> Quat {
        Tangent::at(self, t)
    }

    fn tangent(&self) -> &Tangent<'_> {
        self
    }
}

impl Spread {
    /// What closes a course; nothing where it has no length or closes by itself.
    fn new(transport: &Transport) -> Option<Spread> {
        let nodes = &transport.nodes;
        let (first, last) = (nodes[0].facing, nodes[nodes.len() - 1].facing);
        let twist = wrapped(last.turned_to(first.forward).roll_to(first.up));
        let mut lengths = vec![0.0];
        let mut total = 0.0;
        for pair in nodes.windows(2) {
            total += length(transport.course, pair[0].t, pair[1].t);
            lengths.push(total);
        }
        (total > 0.0 && total.is_finite()).then(|| Spread { lengths, rate: twist / total })
    }
}

/// Arc length between two times within a step of the partition, where the course turns
/// by a fraction of a radian: Gauss's rule of five points.
fn length(course: &dyn Course, from: f64, to: f64) -> f64 {
    const NODES: [(f64, f64); 3] = [
        (0.0, 128.0 / 225.0),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let speed = |x: f64| course.velocity(middle + half * x).length();
    let sum = |(x, weight): (f64, f64)| weight * if x == 0.0 { speed(x) } else { speed(x) + speed(-x) };
    half * NODES.into_iter().map(sum).sum::<f64>()
}

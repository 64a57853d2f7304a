//! Up carried along a course with the least twist, from segment to segment.

use super::carry::{Carry, Node};
use super::facing::{self, Facing};
use super::steps::{Spot, Steps};
use super::wrapped;
use crate::math::Quat;
use rayon::prelude::*;
use std::ops::{Range, RangeInclusive};

/// Segments in a row along which up is carried.
///
/// Each is carried by itself, side by side with others, and then rolled to follow the one before.
pub(super) struct Stretch {
    first: usize,
    /// That of each segment.
    rolls: Vec<Roll>,
}

/// How a segment is rolled to follow the one before it.
#[derive(Clone, Copy, Default)]
pub(super) struct Roll {
    /// Radians.
    angle: f64,
    /// Whether its rotations take the other sign.
    turned: bool,
}

impl Stretch {
    /// Carries on from the end of a segment with its roll; without one the up that is nearest to
    /// +Y.
    pub(super) fn new(
        carry: &Carry,
        steps: &Steps,
        segments: RangeInclusive<usize>,
        before: Option<(Node, Roll)>,
    ) -> Self {
        let first = *segments.start();
        Stretch::through(carry, steps, first, &ends(carry, steps, segments), before)
    }

    /// The same where the ends of the segments are known.
    fn through(
        carry: &Carry,
        steps: &Steps,
        first: usize,
        ends: &[Node],
        before: Option<(Node, Roll)>,
    ) -> Self {
        let mut before = before;
        let follow = |(i, end): (usize, &Node)| {
            let start = carry.start(steps, first + i);
            let roll = before.map_or(Roll::default(), |(end, roll)| roll.next(&end, &start));
            before = Some((*end, roll));
            roll
        };
        Stretch { first, rolls: ends.iter().enumerate().map(follow).collect() }
    }

    pub(super) fn segments(&self) -> Range<usize> {
        self.first..self.first + self.rolls.len()
    }

    /// The end of the last segment, and its roll.
    pub(super) fn end(&self, carry: &Carry, steps: &Steps) -> (Node, Roll) {
        let last = self.rolls.len() - 1;
        (carry.end(steps, self.first + last), self.rolls[last])
    }

    /// Facing at a spot in one of the segments.
    pub(super) fn facing(&self, carry: &Carry, steps: &Steps, spot: &Spot) -> Facing {
        let [_, node] = carry.at(steps, spot.segment, spot.place);
        node.rolled(self.rolls[spot.segment - self.first].angle)
    }
}

fn ends(carry: &Carry, steps: &Steps, segments: RangeInclusive<usize>) -> Vec<Node> {
    segments.into_par_iter().map(|i| carry.end(steps, i)).collect()
}

impl Roll {
    /// The roll of the next segment, which follows on from the end of one with this roll.
    fn next(self, end: &Node, start: &Node) -> Roll {
        let (own, before) = (start.rolled(0.0), end.rolled(self.angle));
        let next = Roll { angle: own.roll_to(before.turned_to(own.forward).up), turned: false };
        let rotation = next.of(start);
        Roll { turned: rotation.aligned_to(self.of(end)) != rotation, ..next }
    }

    /// The rotation at a place of a segment so rolled.
    fn of(self, node: &Node) -> Quat {
        let rotation = node.rotation(self.angle);
        if self.turned { -rotation } else { rotation }
    }
}

/// A course along all of which up is carried, from the one that is nearest to +Y where it begins;
/// on a closed course up comes back as it left.
pub(super) struct Transport {
    carry: Carry,
    all: Stretch,
    spread: Option<Spread>,
}

/// Twist in proportion to arc length, which closes a course.
struct Spread {
    /// Arc length up to each segment.
    lengths: Vec<f64>,
    /// Radians per unit of length.
    rate: f64,
}

impl Transport {
    pub(super) fn new(steps: &Steps) -> Self {
        let closed = steps.course.is_closed();
        let carry = Carry::new(steps, closed);
        let ends = ends(&carry, steps, 0..=steps.segments() - 1);
        let all = Stretch::through(&carry, steps, 0, &ends, None);
        let spread = if closed { Spread::new(&carry, steps, &ends, &all) } else { None };
        Transport { carry, all, spread }
    }

    /// Facing at a spot.
    pub(super) fn facing(&self, steps: &Steps, spot: &Spot) -> Facing {
        let [_, node] = self.carry.at(steps, spot.segment, spot.place);
        node.rolled(self.all.rolls[spot.segment].angle).rolled(self.spread(spot, &node))
    }

    /// The same as a rotation, its sign continuous wherever the rotation is.
    pub(super) fn rotation(&self, steps: &Steps, spot: &Spot) -> Quat {
        let [start, node] = self.carry.at(steps, spot.segment, spot.place);
        let rotation = self.all.rolls[spot.segment].of(&node.following(&start));
        rotation * facing::roll(self.spread(spot, &node))
    }

    fn spread(&self, spot: &Spot, node: &Node) -> f64 {
        self.spread.as_ref().map_or(0.0, |spread| spread.rate * (spread.lengths[spot.segment] + node.length))
    }
}

impl Spread {
    /// What closes a course; nothing where it has no length.
    fn new(carry: &Carry, steps: &Steps, ends: &[Node], all: &Stretch) -> Option<Spread> {
        let first = carry.start(steps, 0).rolled(0.0);
        let last = ends[ends.len() - 1].rolled(all.rolls[ends.len() - 1].angle);
        let twist = wrapped(last.turned_to(first.forward).roll_to(first.up));
        let mut total = 0.0;
        let before = |end: &Node| {
            let before = total;
            total += end.length;
            before
        };
        let lengths = ends.iter().map(before).collect();
        (total > 0.0 && total.is_finite()).then(|| Spread { lengths, rate: twist / total })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orient::{Attitude, Course, Level, Levelled, Tangent, Upright};
    use crate::path::{Kind, Options, Path, Timing};
    use glam::DVec3;

    impl Transport {
        /// Without what closes a course.
        pub(in crate::orient) fn open(steps: &Steps) -> Transport {
            Transport { spread: None, ..Transport::new(steps) }
        }
    }

    /// Segments of the courses here.
    const MANY: usize = 2048;

    /// Through points that wind, with a doubling back every so many, if any.
    fn winding(back: Option<usize>, size: f64, timing: Option<Timing>) -> Path {
        let wound = |i: usize| DVec3::new(i as f64, (1.7 * i as f64).sin(), (0.9 * i as f64).cos());
        let straight = |i: usize| DVec3::new(i as f64 + [0.0, 1.5, -1.0][i % 3], 0.0, 0.0);
        let doubles = |i: usize| back.is_some_and(|every| i % every < 6);
        let point = |i: usize| size * if doubles(i) { straight(i) } else { wound(i) };
        let points: Vec<DVec3> = (0..=MANY).map(point).collect();
        Path::new(Kind::CatmullRom, &points, None, &Options { timing, ..Options::default() }).unwrap()
    }

    #[test]
    fn the_size_of_a_course_does_not_matter() {
        let plain = winding(None, 1.0, None);
        let steps = Steps::new(&plain);
        let plain = Transport::new(&steps);
        for size in [2f64.powi(-900), 2f64.powi(480)] {
            let sized = winding(None, size, None);
            let sized_steps = Steps::new(&sized);
            let sized = Transport::new(&sized_steps);
            for i in 0..1000 {
                let t = steps.course.duration() * f64::from(i) / 1000.0;
                let [plain, sized] = [(&plain, &steps), (&sized, &sized_steps)]
                    .map(|(transport, steps)| transport.facing(steps, &steps.spot(t)));
                assert_eq!(plain, sized, "{size:e} at {t}");
            }
        }
    }

    #[test]
    fn segments_follow_each_other_as_arcs_would() {
        // The mean of shortest arcs in many steps, whose error goes with the square of the step:
        // halving it tells the rest. Doublings back turn about up on the way.
        let path = winding(Some(31), 1.0, None);
        let steps = Steps::new(&path);
        let transport = Transport::new(&steps);
        let segments = 130;
        let end = path.time(steps.start(segments).x);
        assert!(path.corners().iter().filter(|&&t| t < end).count() > 3);
        let arcs = |parts: usize| {
            let mut facing = Facing::upright(steps.start(0).forward);
            for i in 0..segments {
                facing = facing.turned_to(steps.start(i).forward);
                let [from, to] = [i, i + 1].map(|i| steps.start(i).x);
                for part in 1..=parts {
                    let x = (from + (to - from) * part as f64 / parts as f64).min(to.next_down());
                    facing = facing.turned_to(steps.place(x, facing.forward).forward);
                }
            }
            facing
        };
        let [coarse, fine] = [400, 800].map(arcs);
        let end = steps.in_segment(segments - 1, steps.start(segments).x.next_down());
        let found = transport.facing(&steps, &end);
        assert!((found.forward - fine.forward).length() < 1e-9);
        let rest = coarse.roll_to(fine.up) / 3.0;
        assert!(rest.abs() > 1e-7 && (fine.rolled(rest).roll_to(found.up)).abs() < 1e-9, "{rest:e}");
    }

    #[test]
    fn how_fast_a_course_is_run_through_does_not_matter() {
        let [keyed, steady] = [None, Some(Timing::ConstantSpeed)].map(|timing| winding(None, 1.0, timing));
        let [by_key, by_length] = [&keyed, &steady].map(|path| Tangent::new(path));
        for i in 0..2000 {
            let t = steady.duration() * f64::from(i) / 2000.0;
            let q = by_key.at(keyed.time(steady.place(t)));
            assert!(by_length.at(t).angle_to(q) < 1e-9, "{t}");
        }
    }

    #[test]
    fn signs_go_on_and_do_not_depend_on_the_order_of_questions() {
        let path = winding(None, 1.0, None);
        let level = Level { start: 700, end: 700 };
        let attitudes: [Box<dyn Attitude>; 3] = [
            Box::new(Tangent::new(&path)),
            Box::new(Upright::new(&path, 20.0)),
            Box::new(Levelled::new(Upright::new(&path, 0.0), level)),
        ];
        for attitude in attitudes {
            let time = |i: usize| path.duration() * (i as f64 / 400_000.0);
            let mut before = attitude.at(0.0);
            for i in 1..=400_000 {
                let here = attitude.at(time(i));
                // No step is as long as a half turn, which would tell nothing.
                assert!(here.dot(before) > 0.2, "{}", time(i));
                before = here;
                if i % 997 == 0 {
                    let elsewhere = attitude.at(time((i * 7919) % 400_000));
                    assert!(elsewhere.norm() > 0.9);
                    assert_eq!(attitude.at(time(i)), here);
                }
            }
        }
    }
}

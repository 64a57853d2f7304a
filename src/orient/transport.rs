//! Up carried along a course with the least twist.
//!
//! A step turns by the shortest arc, and rolls by the area that lies on the sphere of
//! directions between that arc and the way that the course takes. Gauss's rule of three
//! points sums the area; its error is of the seventh order in the step, and made up for by
//! what two half steps find. Derivation: docs/math/orientation.md.

use super::Course;
use super::facing::Facing;
use glam::DVec3;
use rayon::prelude::*;

/// The twist that the steps of a whole course may add up to: half of the 1e-6 degrees
/// that are promised, since what judges a step is an estimate.
const TOLERANCE: f64 = 0.5e-6 * std::f64::consts::PI / 180.0;

/// An error in twist that is always good enough for a step, radians. It takes 80 000
/// steps of it to miss the promise, thousands of segments that wind.
const LEAST: f64 = 1e-13;

/// The same on a course of more segments than [`MANY`]: its steps would become so short that
/// they take more memory than all else.
const LEAST_OF_MANY: f64 = 1e-10;
const MANY: usize = 2000;

/// Half a step turns by less than this, radians, unless the course turns within an
/// instant. So short a step cannot mistake a whole turn for none.
const LARGEST_TURN: f64 = 0.2;

/// Steps to judge first: 16 a segment, since one of a high degree may turn often; on
/// long courses, whose segments are cubics, about this many, and 2 a segment at least.
const FIRST_STEPS: usize = 16_000;

/// Halvings for accuracy: the error of a step falls by 2⁻⁷⁰.
const DEEPEST: u32 = 10;

/// Nodes and weights of Gauss's rule of two points for what begins as the square of 0..=1: as
/// exact for it as three points are elsewhere, up to degree 5. The nodes are 2/3 ± √(2/45),
/// their weights w/x² with w those of Gauss and Jacobi for the weight x².
const GAUSS: [(f64, f64); 2] =
    [(0.455_848_155_988_774_7, 0.485_019_608_222_464_67), (0.877_485_177_344_558_6, 0.302_017_428_814_572_4)];

/// Halvings to find a turn within an instant.
const INSTANT: u32 = 30;

/// Halvings for each segment, and for all of a run besides. A cubic turns by less than two
/// whole turns, which takes some 30; a curve of a high degree takes hundreds. Where
/// directions are rounding, as far behind the decimal point of a course's length, any number
/// would be spent.
const OWN_HALVINGS: usize = 64;
const SHARED_HALVINGS: usize = 16_384;

/// A time on the course and where it leads.
#[derive(Clone, Copy, Debug)]
struct Place {
    t: f64,
    forward: DVec3,
}

/// A time on the course whose up is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) t: f64,
    pub(super) facing: Facing,
    /// The roll that the step from here is short of at its end, radians; none where the
    /// course turns within an instant, and the step is the shortest arc alone.
    short: Option<f64>,
}

/// A course with up known at the nodes of a partition that resolves it.
pub(super) struct Transport<'a> {
    pub(super) course: &'a dyn Course,
    /// In order of time. At a corner two share the time: before it and after it.
    pub(super) nodes: Vec<Node>,
}

impl<'a> Transport<'a> {
    /// Carries the up that is nearest to +Y at the start along the whole course: along long ones
    /// in runs side by side, which are then turned to follow each other.
    pub(super) fn new(course: &'a dyn Course) -> Self {
        let breaks = breaks(course);
        let plan = Plan::new(breaks.len() - 1);
        let run = |breaks: &&[f64]| {
            let mut run = Transport::beginning(course, breaks);
            run.carry(breaks, plan);
            run
        };
        let cut = runs(course, &breaks);
        let mut all = run(&cut[0]);
        // As many as the first run says and an eighth more, else they would take twice the memory.
        let expected = all.nodes.len() * cut.len();
        all.nodes.reserve_exact(expected / 8 + expected - all.nodes.len());
        // A few at a time, since all of them take as much memory again.
        for cut in cut[1..].chunks(AT_ONCE) {
            let runs: Vec<Transport> = cut.par_iter().map(run).collect();
            for (run, breaks) in runs.into_iter().zip(cut) {
                all.follow(run, breaks, plan);
            }
        }
        all
    }

    /// With up nearest to +Y at the first of some breaks.
    fn beginning(course: &'a dyn Course, breaks: &[f64]) -> Self {
        let t = breaks[0];
        let here =
            if t > 0.0 { unit(course.direction(t)) } else { after(course, t, breaks[breaks.len() - 1]) };
        let facing = Facing::upright(here.unwrap_or(DVec3::Z));
        Transport { course, nodes: vec![Node { t, facing, short: None }] }
    }

    /// Goes on from the last node, which is at the first of some breaks, to the last.
    fn carry(&mut self, breaks: &[f64], plan: Plan) {
        let mut node = self.nodes[self.nodes.len() - 1];
        let mut halvings = Halvings { own: 0, shared: SHARED_HALVINGS };
        for pair in breaks.windows(2) {
            halvings.own = OWN_HALVINGS;
            node = self.turn(node, pair[1]);
            node = self.advance(node, pair[1], plan, &mut halvings);
        }
    }

    /// Goes on with the nodes of a run that begins at the last one, and faces the same way there.
    /// What carries up does not mind how it is rolled, but for the half turns of reversals.
    fn follow(&mut self, run: Transport, breaks: &[f64], plan: Plan) {
        let Some(last) = self.nodes.last_mut() else { return };
        if run.reverses() {
            return self.carry(breaks, plan);
        }
        let first = run.nodes[0];
        let roll = first.facing.roll_to(last.facing.up);
        last.short = first.short;
        let rolled = |node: &Node| Node { facing: node.facing.rolled(roll), ..*node };
        self.nodes.extend(run.nodes[1..].iter().map(rolled));
    }

    /// Whether the course turns back on itself somewhere.
    fn reverses(&self) -> bool {
        self.nodes.windows(2).any(|pair| pair[0].facing.is_against(pair[1].facing.forward))
    }

    /// Forward at a time, and the node before it.
    pub(super) fn forward(&self, t: f64) -> (usize, DVec3) {
        let t = self.within(t);
        let i = self.index(t);
        (i, self.place(t, self.nodes[i].facing.forward).forward)
    }

    /// Facing at a time, and the node it is carried from.
    pub(super) fn at(&self, t: f64) -> (usize, Facing) {
        let t = self.within(t);
        let (i, forward) = self.forward(t);
        let Node { t: from, facing, short } = self.nodes[i];
        let turned = facing.turned_to(forward);
        let (Some(short), Some(next)) = (short, self.nodes.get(i + 1)) else { return (i, turned) };
        let part = (t - from) / (next.t - from);
        (i, turned.rolled(self.roll(facing.forward, from, t) + short * part.powi(7)))
    }

    /// The roll from the shortest arc, out of a forward, to what is carried without twist
    /// between two times of a step.
    fn roll(&self, forward: DVec3, from: f64, to: f64) -> f64 {
        let rate = |t: f64| {
            let [velocity, acceleration] = self.course.rates(t);
            // The size of a course may have no square.
            let size = velocity.abs().max_element();
            let (velocity, acceleration) = (velocity / size, acceleration / size);
            let speed = velocity.length();
            let direction = velocity / speed;
            let turning = direction.cross(acceleration / speed);
            let rate = forward.dot(turning) / (1.0 + forward.dot(direction));
            // Where the course stands it does not turn.
            if rate.is_finite() { rate } else { 0.0 }
        };
        let step = to - from;
        step * GAUSS.iter().map(|(x, weight)| weight * rate(from + x * step)).sum::<f64>()
    }

    /// The time of the course that is nearest to a time.
    pub(super) fn within(&self, t: f64) -> f64 {
        t.clamp(0.0, self.nodes[self.nodes.len() - 1].t)
    }

    /// The last node at or before a time.
    pub(super) fn index(&self, t: f64) -> usize {
        self.nodes.partition_point(|node| node.t <= t).saturating_sub(1)
    }

    /// A time on the course; where it has no direction, another's.
    fn place(&self, t: f64, otherwise: DVec3) -> Place {
        Place { t, forward: unit(self.course.direction(t)).unwrap_or(otherwise) }
    }

    /// The node after the corner that `node` may stand at.
    fn turn(&mut self, node: Node, next: f64) -> Node {
        let forward = after(self.course, node.t, next).filter(|_| is_corner(self.course, node.t));
        let Some(forward) = forward.filter(|_| node.t > 0.0) else { return node };
        let turned = Node { facing: node.facing.turned_to(forward), ..node };
        self.nodes.push(turned);
        turned
    }

    /// From a break to the next: to the limit from inside where that is a corner.
    fn advance(&mut self, mut node: Node, end: f64, plan: Plan, halvings: &mut Halvings) -> Node {
        let Plan { parts, least } = plan;
        let start = node.t;
        let share = TOLERANCE * ((end - start) / parts as f64) / self.course.duration();
        for part in 1..=parts {
            let t = if part == parts { end } else { start + (end - start) * (part as f64 / parts as f64) };
            let mut place = self.place(t, node.facing.forward);
            if part == parts && is_corner(self.course, end) {
                place.forward = before(self.course, start, end).unwrap_or(place.forward);
            }
            let effort = Effort { depth: 0, least, share, twist: f64::INFINITY };
            node = self.walk(node, place, effort, halvings);
        }
        node
    }

    /// Steps to a place, halved until one step and two agree on the twist.
    fn walk(&mut self, start: Node, end: Place, effort: Effort, halvings: &mut Halvings) -> Node {
        let middle = self.place(0.5 * (start.t + end.t), start.facing.forward);
        let halves = middle.t > start.t && middle.t < end.t;
        let forward = start.facing.forward;
        let turns = [forward - middle.forward, middle.forward - end.forward];
        let turn = turns[0].length().max(turns[1].length());
        if halves && turn > LARGEST_TURN && effort.depth < INSTANT && halvings.take() {
            return self.halve(start, middle, end, effort.halved(effort.twist), halvings);
        }
        let arc = start.facing.turned_to(end.forward);
        if turn > LARGEST_TURN || !halves {
            return self.step(end.t, arc, None);
        }
        let whole = arc.rolled(self.roll(forward, start.t, end.t));
        let half = start.facing.turned_to(middle.forward).rolled(self.roll(forward, start.t, middle.t));
        let rest = self.roll(middle.forward, middle.t, end.t);
        let twist = whole.roll_to(half.turned_to(end.forward).rolled(rest).up);
        if effort.is_asked(turn, twist.abs()) && halvings.take() {
            return self.halve(start, middle, end, effort.halved(twist.abs()), halvings);
        }
        // Richardson: two steps err by 1/64 of what one does.
        let short = twist * 64.0 / 63.0;
        self.step(end.t, whole.rolled(short), Some(short))
    }

    fn halve(
        &mut self,
        start: Node,
        middle: Place,
        end: Place,
        effort: Effort,
        halvings: &mut Halvings,
    ) -> Node {
        let half = self.walk(start, middle, effort, halvings);
        self.walk(half, end, effort, halvings)
    }

    /// A step from the last node, which is short of so much roll.
    fn step(&mut self, t: f64, facing: Facing, short: Option<f64>) -> Node {
        if let Some(start) = self.nodes.last_mut() {
            start.short = short;
        }
        let end = Node { t, facing, short: None };
        self.nodes.push(end);
        end
    }
}

/// How a course is cut into steps.
#[derive(Clone, Copy)]
struct Plan {
    /// How many steps of a segment are judged first.
    parts: usize,
    /// An error in twist that is good enough for any step, radians.
    least: f64,
}

impl Plan {
    fn new(segments: usize) -> Plan {
        let least = if segments > MANY { LEAST_OF_MANY } else { LEAST };
        Plan { parts: (FIRST_STEPS / (segments + 1)).clamp(2, 16), least }
    }
}

/// How often steps may still be halved: a segment by itself, and all of a run besides.
struct Halvings {
    own: usize,
    shared: usize,
}

impl Halvings {
    /// One of them, if there are any.
    fn take(&mut self) -> bool {
        let purse = if self.own > 0 { &mut self.own } else { &mut self.shared };
        let any = *purse > 0;
        *purse -= usize::from(any);
        any
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

/// How many breaks there are to a run, about, and how many runs are carried at a time.
const RUN: usize = 512;
const AT_ONCE: usize = 16;

/// Breaks in runs, each of which begins where the one before ends: where the course has a
/// direction, and but one.
fn runs<'b>(course: &dyn Course, breaks: &'b [f64]) -> Vec<&'b [f64]> {
    let (mut runs, mut from) = (Vec::new(), 0);
    for (i, &t) in breaks.iter().enumerate() {
        let plain = || unit(course.direction(t)).is_some() && !is_corner(course, t);
        if i >= from + RUN && i + 1 < breaks.len() && plain() {
            runs.push(&breaks[from..=i]);
            from = i;
        }
    }
    runs.push(&breaks[from..]);
    runs
}

/// The times between which a course is smooth: its ends, key times and corners.
fn breaks(course: &dyn Course) -> Vec<f64> {
    let end = course.duration().max(0.0);
    let inner = course.key_times().iter().chain(course.corners()).copied();
    let mut breaks: Vec<f64> = inner.filter(|&t| t > 0.0 && t < end).chain([0.0, end]).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

fn is_corner(course: &dyn Course, t: f64) -> bool {
    course.corners().binary_search_by(|corner| corner.total_cmp(&t)).is_ok()
}

fn unit(v: Option<DVec3>) -> Option<DVec3> {
    v.and_then(DVec3::try_normalize)
}

/// A billionth of the way from a time to another: inside, even where rounding hides
/// which way a course leaves its rest.
const INSIDE: f64 = 1e-9;

/// The direction just after a time, on the way to the next break.
fn after(course: &dyn Course, t: f64, next: f64) -> Option<DVec3> {
    limit(course, [t, t.next_up(), (t + INSIDE * (next - t)).max(t.next_up()).min(next)])
}

/// The direction just before a time, on the way from the break before.
fn before(course: &dyn Course, previous: f64, t: f64) -> Option<DVec3> {
    limit(course, [t, t.next_down(), (t - INSIDE * (t - previous)).min(t.next_down()).max(previous)])
}

/// The direction at the first of some times that agrees with the one further inside: a
/// course turns by less than 1e-6 in a billionth of a segment.
fn limit(course: &dyn Course, times: [f64; 3]) -> Option<DVec3> {
    let [at, beside, inside] = times.map(|t| unit(course.direction(t)));
    let inside = inside?;
    [at, beside].into_iter().flatten().find(|d| d.distance(inside) < 1e-6).or(Some(inside))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::{Ease, Kind, Options, Path, Timing};

    #[test]
    fn the_rule_is_exact_from_the_second_to_the_fifth_degree() {
        let error = |k: i32| GAUSS.iter().map(|(x, w)| w * x.powi(k)).sum::<f64>() - 1.0 / f64::from(k + 1);
        assert!((2..=5).all(|k| error(k).abs() < 1e-15));
        // Others must fail, or this says nothing.
        assert!([0, 1, 6].iter().all(|&k| error(k).abs() > 1e-4));
    }

    /// Through points that wind, with a doubling back every so many, if any.
    fn winding(back: Option<usize>, size: f64) -> Path {
        let wound = |i: usize| DVec3::new(i as f64, (1.7 * i as f64).sin(), (0.9 * i as f64).cos());
        let straight = |i: usize| DVec3::new(i as f64 + [0.0, 1.5, -1.0][i % 3], 0.0, 0.0);
        let doubles = |i: usize| back.is_some_and(|every| i % every < 6);
        let point = |i: usize| size * if doubles(i) { straight(i) } else { wound(i) };
        let points: Vec<DVec3> = (0..4 * RUN).map(point).collect();
        Path::new(Kind::CatmullRom, &points, None, &Options::default()).unwrap()
    }

    #[test]
    fn runs_follow_each_other_as_one_would() {
        for back in [None, Some(700)] {
            let path = winding(back, 1.0);
            let breaks = breaks(&path);
            let cut = runs(&path, &breaks);
            assert!(cut.len() > 3);
            assert!(cut.windows(2).all(|pair| pair[0].last() == pair[1].first()));
            let plan = Plan::new(breaks.len() - 1);
            let mut alone = Transport::beginning(&path, &breaks);
            alone.carry(&breaks, plan);
            assert_eq!(alone.reverses(), back.is_some());
            let found = Transport::new(&path);
            for i in 0..20_000 {
                let t = path.duration() * f64::from(i) / 20_000.0;
                let (found, alone) = (found.at(t).1, alone.at(t).1);
                assert_eq!(found.forward, alone.forward);
                // Rounding may decide whether a step is halved, which then twists by 1e-10 less.
                assert!((found.up - alone.up).length() < 1e-9, "{t}: {:e}", (found.up - alone.up).length());
            }
        }
    }

    #[test]
    fn the_size_of_a_course_does_not_matter() {
        let plain = winding(None, 1.0);
        let plain = Transport::new(&plain);
        for size in [2f64.powi(-900), 2f64.powi(480)] {
            let sized = winding(None, size);
            let sized = Transport::new(&sized);
            for i in 0..1000 {
                let t = plain.course.duration() * f64::from(i) / 1000.0;
                assert_eq!(plain.at(t).1, sized.at(t).1, "{size:e} at {t}");
            }
        }
    }

    #[test]
    fn directions_that_are_rounding_are_not_chased() {
        // Behind a way of 10²¹ what is left of the length has no digits: as time goes on,
        // places jump to and fro.
        let points = [[-10.0, 2.0, 0.0], [-1e21, 2.0, 5.0], [-10.0, 2.0, 0.0], [-10.0, 2.0, 0.0]];
        let rest = [[-4.0, 0.8, 6.0], [4.0, 0.0, 6e5], [10.0, 2.0, 0.0]];
        let points: Vec<DVec3> = points.into_iter().chain(rest).map(DVec3::from_array).collect();
        let (timing, ease) = (Some(Timing::ConstantSpeed), Ease::Out);
        let options = Options { timing, ease, ..Options::default() };
        let path = Path::new(Kind::Bezier, &points, None, &options).unwrap();
        let nodes = Transport::new(&path).nodes.len();
        assert!(nodes > SHARED_HALVINGS && nodes < SHARED_HALVINGS + 1000, "{nodes}");
    }
}

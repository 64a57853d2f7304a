//! A course in steps so short that none turns far.

use super::Course;
use super::recent::Recent;
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// Half a step turns by less than this, radians, unless the course turns within an
/// instant. So short a step cannot mistake a whole turn for none.
pub(super) const LARGEST_TURN: f64 = 0.2;

/// Steps to judge first: 16 a segment, since one of a high degree may turn often; on
/// long courses, whose segments are cubics, about this many, and 2 a segment at least.
const FIRST_STEPS: usize = 16_000;

/// Halvings to find a turn within an instant.
const INSTANT: u32 = 30;

/// Halvings for each segment, and those that all segments share. A cubic turns by less than
/// two whole turns, which takes some 30; a curve of a high degree takes hundreds, and is the
/// only one. Where directions are rounding, any number would be spent.
const OWN_HALVINGS: usize = 64;
const SHARED_HALVINGS: usize = 16_384;

/// A place on a course, and where the course leads from there, a unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// As [`Course::place`] counts.
    pub(super) x: f64,
    pub(super) forward: DVec3,
}

/// A place, and where it is in the steps of a course.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// Of two that meet here, the one that it belongs to.
    pub(super) segment: usize,
    /// The last step of the segment that begins at or before it.
    pub(super) step: usize,
    pub(super) place: Place,
}

/// A course in segments, smooth each, and these in steps.
///
/// Steps are made where they are asked for: a long course has more of them than it has points.
pub struct Steps<'a> {
    pub(super) course: &'a dyn Course,
    /// The places between which the course is smooth, two or more: its ends, key points and
    /// corners.
    breaks: Vec<f64>,
    corners: Vec<f64>,
    /// How many steps of a segment are judged first.
    parts: usize,
    /// How many halvings of a segment's steps there may be.
    pub(super) halvings: usize,
    recent: Recent<Vec<Place>>,
}

impl<'a> Steps<'a> {
    pub(super) fn new(course: &'a dyn Course) -> Self {
        let corners: Vec<f64> = course.corners().iter().map(|&t| course.place(t)).collect();
        let breaks = breaks(course, &corners);
        let segments = breaks.len() - 1;
        let parts = (FIRST_STEPS / (segments + 1)).clamp(2, 16);
        let halvings = OWN_HALVINGS + SHARED_HALVINGS / segments;
        Steps { course, breaks, corners, parts, halvings, recent: Recent::new(segments) }
    }

    /// How many segments there are, one or more.
    pub(super) fn segments(&self) -> usize {
        self.breaks.len() - 1
    }

    /// The share of the whole course that lies between two places.
    pub(super) fn share(&self, from: f64, to: f64) -> f64 {
        (to - from) / (self.breaks[self.segments()] - self.breaks[0])
    }

    /// The segment that holds a place; of two that meet there, the later one.
    pub(super) fn segment(&self, x: f64) -> usize {
        self.breaks.partition_point(|&from| from <= x).clamp(1, self.segments()) - 1
    }

    /// The segments between two places, each of which is where segments meet.
    pub(super) fn between(&self, from: f64, to: f64) -> Range<usize> {
        let first = |x: f64| self.breaks[..self.segments()].partition_point(|&start| start < x);
        first(from)..first(to)
    }

    /// Where the course is at a time.
    pub(super) fn spot(&self, t: f64) -> Spot {
        let x = self.course.place(t).clamp(self.breaks[0], self.breaks[self.segments()]);
        let segment = self.segment(x);
        self.in_segment(segment, x)
    }

    /// A place that is inside of a segment, or where it begins.
    pub(super) fn in_segment(&self, segment: usize, x: f64) -> Spot {
        let places = self.of(segment);
        let step = places.partition_point(|place| place.x <= x).saturating_sub(1);
        Spot { segment, step, place: self.place(x, places[step].forward) }
    }

    /// Where the step of a spot begins.
    pub(super) fn step_start(&self, spot: &Spot) -> Spot {
        Spot { place: self.of(spot.segment)[spot.step], ..*spot }
    }

    /// Where the steps of a segment begin and end, in order.
    pub(super) fn spots(&self, segment: usize) -> impl Iterator<Item = Spot> {
        let places = self.of(segment);
        (0..places.len()).map(move |step| Spot { segment, step, place: places[step] })
    }

    /// The places where the steps of a segment begin and end, in order. At corners they lead where
    /// the course does inside of the segment.
    pub(super) fn of(&self, segment: usize) -> Arc<Vec<Place>> {
        self.recent.get(segment, || self.made(segment))
    }

    fn made(&self, segment: usize) -> Vec<Place> {
        let [start, end] = [self.breaks[segment], self.breaks[segment + 1]];
        let mut places = Vec::with_capacity(2 * self.parts);
        places.push(self.start(segment));
        if start == end {
            return places;
        }
        let mut halvings = self.halvings;
        for part in 1..self.parts {
            let x = start + (end - start) * (part as f64 / self.parts as f64);
            let place = self.place(x, places[places.len() - 1].forward);
            self.step(&mut places, place, 0, &mut halvings);
        }
        let place = self.end(segment, places[places.len() - 1].forward);
        self.step(&mut places, place, 0, &mut halvings);
        places
    }

    /// A step from the last of some places, halved until it turns little.
    fn step(&self, places: &mut Vec<Place>, end: Place, depth: u32, halvings: &mut usize) {
        let start = places[places.len() - 1];
        let middle = self.middle(start, end).filter(|&middle| turn([start, middle, end]) > LARGEST_TURN);
        let Some(middle) = middle.filter(|_| depth < INSTANT && *halvings > 0) else {
            return places.push(end);
        };
        *halvings -= 1;
        self.step(places, middle, depth + 1, halvings);
        self.step(places, end, depth + 1, halvings);
    }

    /// The place halfway between two, if there is one.
    pub(super) fn middle(&self, start: Place, end: Place) -> Option<Place> {
        let x = 0.5 * (start.x + end.x);
        (x > start.x && x < end.x).then(|| self.place(x, start.forward))
    }

    /// A place on the course; where it has no direction, another's.
    pub(super) fn place(&self, x: f64, otherwise: DVec3) -> Place {
        Place { x, forward: self.direction(x).unwrap_or(otherwise) }
    }

    fn direction(&self, x: f64) -> Option<DVec3> {
        self.course.direction_at(x).and_then(DVec3::try_normalize)
    }

    /// Where a segment begins.
    pub(super) fn start(&self, segment: usize) -> Place {
        let [x, end] = [self.breaks[segment], self.breaks[segment + 1]];
        let inside = || self.limit([x, x.next_up(), (x + INSIDE * (end - x)).max(x.next_up()).min(end)]);
        let plain = || self.direction(x).filter(|_| segment > 0 && !self.is_corner(x));
        Place { x, forward: plain().or_else(inside).unwrap_or(DVec3::Z) }
    }

    /// Where a segment ends: the limit from inside where that is a corner.
    fn end(&self, segment: usize, otherwise: DVec3) -> Place {
        let [start, x] = [self.breaks[segment], self.breaks[segment + 1]];
        let inside =
            || self.limit([x, x.next_down(), (x - INSIDE * (x - start)).min(x.next_down()).max(start)]);
        let limit = if self.is_corner(x) { inside() } else { None };
        limit.map_or_else(|| self.place(x, otherwise), |forward| Place { x, forward })
    }

    fn is_corner(&self, x: f64) -> bool {
        self.corners.binary_search_by(|corner| corner.total_cmp(&x)).is_ok()
    }

    /// The direction at the first of some places that agrees with the one further inside: a
    /// course turns by less than 1e-6 in a billionth of a segment.
    fn limit(&self, places: [f64; 3]) -> Option<DVec3> {
        let [at, beside, inside] = places.map(|x| self.direction(x));
        let inside = inside?;
        [at, beside].into_iter().flatten().find(|d| d.distance(inside) < 1e-6).or(Some(inside))
    }
}

/// A billionth of the way from a place to another: inside, even where rounding hides
/// which way a course leaves its rest.
const INSIDE: f64 = 1e-9;

/// How far the course turns in one of the two halves of a step at most, radians.
pub(super) fn turn([start, middle, end]: [Place; 3]) -> f64 {
    (start.forward - middle.forward).length().max((middle.forward - end.forward).length())
}

/// The places between which a course is smooth, in order.
fn breaks(course: &dyn Course, corners: &[f64]) -> Vec<f64> {
    let end = course.place(course.duration().max(0.0));
    let keys = course.key_times().iter().map(|&t| course.place(t));
    let inner = keys.chain(corners.iter().copied()).filter(|&x| x > 0.0 && x < end);
    let mut breaks: Vec<f64> = inner.chain([0.0, end]).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    if let [only] = breaks[..] {
        breaks.push(only);
    }
    breaks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Leads anywhere at any time.
    struct Noise;

    impl Course for Noise {
        fn duration(&self) -> f64 {
            1.0
        }
        fn key_times(&self) -> &[f64] {
            &[0.0, 1.0]
        }
        fn is_closed(&self) -> bool {
            false
        }
        fn position(&self, _: f64) -> DVec3 {
            DVec3::ZERO
        }
        fn velocity(&self, t: f64) -> DVec3 {
            let digits = |by: f64| (t * by * 1e9).sin();
            DVec3::new(digits(1.0), digits(2.3), digits(3.1))
        }
        fn acceleration(&self, t: f64) -> DVec3 {
            self.velocity(t)
        }
        fn direction(&self, t: f64) -> Option<DVec3> {
            self.velocity(t).try_normalize()
        }
        fn corners(&self) -> &[f64] {
            &[]
        }
    }

    #[test]
    fn directions_that_are_rounding_are_not_chased() {
        let steps = Steps::new(&Noise);
        let halvings = OWN_HALVINGS + SHARED_HALVINGS;
        assert_eq!(steps.of(0).len(), 1 + steps.parts + halvings);
    }
}

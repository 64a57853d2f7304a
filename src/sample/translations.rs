//! A path at every sample time, in order and in parallel.

use super::Timeline;
use super::rotations::in_order;
use super::worst::{Gap, Part, Worst, parabola_peak};
use crate::curve::Rates;
use glam::DVec3;

/// A place as a function of time.
pub trait Travel: Sync {
    /// The place at a time, seconds.
    fn at(&self, t: f64) -> DVec3;

    /// An upper bound of the length of the second derivative between two times that no
    /// knot parts.
    fn acceleration_bound(&self, from: f64, to: f64) -> f64;

    /// An upper bound of the speed between two times.
    fn speed_bound(&self, from: f64, to: f64) -> f64;

    /// Times at which derivatives may jump, increasing.
    fn knots(&self) -> &[f64];

    /// The Bézier control points of the way between two times, where it is a cubic there
    /// and known as one.
    fn cubic(&self, _from: f64, _to: f64) -> Option<[DVec3; 4]> {
        None
    }

    /// Times at which the velocity jumps, increasing.
    fn jumps(&self) -> &[f64] {
        self.knots()
    }
}

/// Evaluates a path at every time of the timeline and hands the places, x y z as float32,
/// to `sink`, from first to last; with `hold` each lasts until the next. Returns an upper
/// bound of the distance between the path and the playback of what is written.
pub fn translations<E>(
    travel: &dyn Travel,
    timeline: &Timeline,
    hold: bool,
    mut sink: impl FnMut(&[[f32; 3]]) -> Result<(), E>,
) -> Result<f64, E> {
    let mut deviation: f64 = 0.0;
    let job = |_, chunk| sample(travel, timeline, hold, chunk);
    in_order(1, timeline.chunks(), job, |_, _, (places, bound): (Vec<[f32; 3]>, f64)| {
        deviation = deviation.max(bound);
        sink(&places)
    })?;
    Ok(deviation)
}

fn sample(travel: &dyn Travel, timeline: &Timeline, hold: bool, chunk: usize) -> (Vec<[f32; 3]>, f64) {
    let (before, times) = timeline.chunk(chunk);
    let times: Vec<f64> = before.into_iter().chain(times).map(f64::from).collect();
    let exact: Vec<DVec3> = times.iter().map(|&t| travel.at(t)).collect();
    let mut written: Vec<[f32; 3]> = exact.iter().map(|place| place.as_vec3().to_array()).collect();
    let playback = |i: usize| DVec3::from_array(written[i].map(f64::from));
    let mut worst = Worst::new(NEGLIGIBLE * extent(&exact));
    let ends: Vec<f64> = (0..times.len()).map(|i| playback(i).distance(exact[i])).collect();
    worst.note(ends.iter().copied().fold(0.0, f64::max));
    let line = |i: usize| {
        let ends = [playback(i), playback(if hold { i } else { i + 1 })];
        Line { travel, from: times[i], to: times[i + 1], ends }
    };
    let lines: Vec<Line> = (0..times.len() - 1).map(line).collect();
    lines.iter().for_each(|line| worst.note(line.at(0.5 * (line.from + line.to))));
    for (i, line) in lines.iter().enumerate() {
        let arrives = if hold { line.at(line.to) } else { ends[i + 1] };
        line.search(&mut worst, (ends[i], arrives));
    }
    written.drain(..usize::from(before.is_some()));
    (written, worst.bound())
}

/// What is not worth refining, relative to the largest coordinate: below float32's own
/// rounding.
const NEGLIGIBLE: f64 = 2e-8;

fn extent(places: &[DVec3]) -> f64 {
    places.iter().map(|place| place.abs().max_element()).fold(0.0, f64::max)
}

/// A straight line that is walked at constant speed between two times, beside the path.
struct Line<'a> {
    travel: &'a dyn Travel,
    from: f64,
    to: f64,
    ends: [DVec3; 2],
}

impl Line<'_> {
    /// Bounds the distance between path and line, with the distance at both ends. At knots
    /// it is computed.
    fn search(&self, worst: &mut Worst, ends: (f64, f64)) {
        let knots = self.travel.knots();
        let inside = &knots[knots.partition_point(|&k| k <= self.from)..];
        let inside = inside.iter().copied().take_while(|&k| k < self.to);
        let (mut from, mut at_from) = (self.from, ends.0);
        for (to, at_to) in inside.map(|knot| (knot, self.at(knot))).chain([(self.to, ends.1)]) {
            worst.note(at_to);
            worst.search(self, Part { from, to, at_from, at_to }, self.rates(from, to), 0);
            (from, at_from) = (to, at_to);
        }
    }
}

impl Gap for Line<'_> {
    fn at(&self, t: f64) -> f64 {
        let u = (t - self.from) / (self.to - self.from);
        self.ends[0].lerp(self.ends[1], u).distance(self.travel.at(t))
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        let travel = self.travel;
        Rates { speed: travel.speed_bound(from, to), acceleration: travel.acceleration_bound(from, to) }
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        let speed = self.ends[0].distance(self.ends[1]) / (self.to - self.from);
        straight_bound(rates, part.to - part.from, (part.at_from, part.at_to), speed)
    }
}

/// An upper bound of the distance between a path and a straight line walked at constant
/// speed, on a stretch of h seconds that no knot divides, with the distance at both ends.
///
/// The difference of both has the path's second derivative: it rises above the chord of
/// its ends by at most h²/8 of that. Where no acceleration bounds it: the nearer end is
/// at most h/2 away.
pub(crate) fn straight_bound(rates: Rates, h: f64, ends: (f64, f64), speed: f64) -> f64 {
    let strayed = ends.0.max(ends.1) + 0.5 * h * (rates.speed + speed);
    parabola_peak(ends.0, ends.1, h * h / 8.0 * rates.acceleration).min(strayed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs around a circle, then straight on from t = 2.
    struct CircleThenLine;

    impl Travel for CircleThenLine {
        fn at(&self, t: f64) -> DVec3 {
            let (sin, cos) = t.min(2.0).sin_cos();
            DVec3::new(cos, 0.0, sin) + (t - 2.0).max(0.0) * DVec3::Y
        }

        fn acceleration_bound(&self, from: f64, _to: f64) -> f64 {
            if from < 2.0 { 1.0 } else { 0.0 }
        }

        fn speed_bound(&self, _from: f64, _to: f64) -> f64 {
            1.0
        }

        fn knots(&self) -> &[f64] {
            &[0.0, 2.0, 5.0]
        }
    }

    #[test]
    fn bound_holds_and_is_near() {
        for (fps, key_times) in [("10", true), ("7", false), ("1", false)] {
            let keys = [0.0, 2.0, 5.0];
            let timeline = Timeline::new(&keys, None, fps.parse().unwrap(), key_times).unwrap();
            let mut places = Vec::new();
            let bound = translations(&CircleThenLine, &timeline, false, |chunk| {
                places.extend_from_slice(chunk);
                Ok::<(), ()>(())
            });
            let bound = bound.unwrap();
            let times = timeline.chunk(0).1;
            assert_eq!(places.len(), times.len());
            let mut worst: f64 = 0.0;
            for (t, p) in times.windows(2).zip(places.windows(2)) {
                let [a, b] = [p[0], p[1]].map(|p| DVec3::from_array(p.map(f64::from)));
                for i in 0..=100 {
                    let u = f64::from(i) / 100.0;
                    let time = f64::from(t[0]) + u * f64::from(t[1] - t[0]);
                    worst = worst.max(a.lerp(b, u).distance(CircleThenLine.at(time)));
                }
            }
            assert!(bound >= worst, "{fps}: {bound} {worst}");
            assert!(bound <= 1.06 * worst + 1e-7, "{fps}: {bound} {worst}");
        }
    }
}

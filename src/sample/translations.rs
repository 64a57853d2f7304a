//! A path at every sample time, in order and in parallel.

use super::Timeline;
use super::rotations::in_order;
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

    /// Times at which the velocity jumps, increasing.
    fn jumps(&self) -> &[f64] {
        self.knots()
    }
}

/// Evaluates a path at every time of the timeline and hands the places, x y z as float32,
/// to `sink`, from first to last. Returns an upper bound of the distance between the path
/// and the playback of what is written.
pub fn translations<E>(
    travel: &dyn Travel,
    timeline: &Timeline,
    mut sink: impl FnMut(&[[f32; 3]]) -> Result<(), E>,
) -> Result<f64, E> {
    let mut deviation: f64 = 0.0;
    let job = |_, chunk| sample(travel, timeline, chunk);
    in_order(1, timeline.chunks(), job, |_, _, (places, bound): (Vec<[f32; 3]>, f64)| {
        deviation = deviation.max(bound);
        sink(&places)
    })?;
    Ok(deviation)
}

fn sample(travel: &dyn Travel, timeline: &Timeline, chunk: usize) -> (Vec<[f32; 3]>, f64) {
    let (before, times) = timeline.chunk(chunk);
    let times: Vec<f64> = before.into_iter().chain(times).map(f64::from).collect();
    let exact: Vec<DVec3> = times.iter().map(|&t| travel.at(t)).collect();
    let mut written: Vec<[f32; 3]> = exact.iter().map(|place| place.as_vec3().to_array()).collect();
    let playback = |i: usize| DVec3::from_array(written[i].map(f64::from));
    let ends = |i: usize| playback(i).distance(exact[i]);
    let intervals = (1..times.len()).map(|i| {
        let line = (playback(i - 1), playback(i));
        between(travel, (times[i - 1], times[i]), line, (ends(i - 1), ends(i)))
    });
    let bound = intervals.fold(ends(0), f64::max);
    written.drain(..usize::from(before.is_some()));
    (written, bound)
}

/// A bound of the distance between the path and a straight line walked at constant speed
/// between two times, with the distance at both ends.
///
/// The difference of both has the path's second derivative: between knots it rises above
/// the larger end by at most h²/8 of that. At knots it is computed.
fn between(travel: &dyn Travel, (from, to): (f64, f64), line: (DVec3, DVec3), ends: (f64, f64)) -> f64 {
    let knots = travel.knots();
    let inside = knots[knots.partition_point(|&k| k <= from)..].iter().copied().take_while(|&k| k < to);
    let distance = |t: f64| line.0.lerp(line.1, (t - from) / (to - from)).distance(travel.at(t));
    let (mut worst, mut start, mut at_start) = (0.0f64, from, ends.0);
    for (end, at_end) in inside.map(|knot| (knot, distance(knot))).chain([(to, ends.1)]) {
        let h = end - start;
        let sagitta = h * h / 8.0 * travel.acceleration_bound(start, end);
        // Where no acceleration bounds it: the nearer end is at most h/2 away.
        let playback = line.0.distance(line.1) / (to - from);
        let strayed = 0.5 * h * (travel.speed_bound(start, end) + playback);
        worst = worst.max(at_start.max(at_end) + sagitta.min(strayed));
        (start, at_start) = (end, at_end);
    }
    worst
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
            let bound = translations(&CircleThenLine, &timeline, |chunk| {
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
            assert!(bound <= 1.3 * worst + 1e-7, "{fps}: {bound} {worst}");
        }
    }
}

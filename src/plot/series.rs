//! Motions over time as lines of numbers.

use super::thin::{Line, Thinner};
use crate::curve::{Arc, Motion, Piece};
use crate::math::{Jet3, Quat};
use crate::path::Path;
use glam::DVec3;
use rayon::prelude::*;

/// In how many columns of time lines are kept: more than a picture is wide.
const COLUMNS: usize = 4096;

/// In how many steps the whole is looked at, at least.
const STEPS: f64 = 4096.0;

/// In how many steps each smooth piece is looked at, at least; in fewer of more pieces than
/// make so many steps in all.
const STEPS_A_PIECE: usize = 8;
const MOST_STEPS: usize = 2_000_000;

/// Values that differ by less than this share of the largest do not jump.
const JUMP: f64 = 1e-6;

/// Angular speed, acceleration and jerk at a place of a piece: lengths of the angular
/// velocity, its derivative and that one's as seen from outside, in degrees and seconds.
pub(super) fn rates(piece: &Piece, u: f64) -> [f64; 3] {
    let rates = piece.at(Jet3::variable(u)).angular_rates();
    let rate = 1.0 / piece.duration();
    let [speed, acceleration, jerk] = rates.map(|v| v.length().to_degrees());
    [speed * rate, acceleration * rate * rate, jerk * rate * rate * rate]
}

/// Rates of a motion over time. Where it jumps, and on the ramp that stands for a jump,
/// they have no value.
pub(super) fn motion_rates(motion: &Motion, range: [f64; 2]) -> [Line; 3] {
    let ramp = motion.ramp();
    of_motion(
        motion,
        range,
        |piece, u| {
            if ramp == Some(piece.start) { [f64::NAN; 3] } else { rates(piece, u) }
        },
    )
}

/// The four numbers of a motion's rotations over time.
pub(super) fn components(
    motion: &Motion,
    range: [f64; 2],
    parts: impl Fn(Quat) -> [f64; 4] + Sync,
) -> [Line; 4] {
    let mut lines = of_motion(motion, range, |piece, u| parts(piece.at(u)));
    // What is held jumps to its last key when it ends.
    let end = motion.times()[motion.times().len() - 1];
    let [held, last] = [motion.piece_at(end.next_down()).at(1.0), motion.at(end)].map(&parts);
    for (line, (held, last)) in lines.iter_mut().zip(held.into_iter().zip(last)) {
        if (last - held).abs() > JUMP {
            line.push(vec![[end, last]]);
        }
    }
    lines
}

/// Values over time, of each smooth piece from its own start to its own end: what differs
/// on either side of a key differs here.
fn of_motion<const N: usize>(
    motion: &Motion,
    range: [f64; 2],
    of: impl Fn(&Piece, f64) -> [f64; N] + Sync,
) -> [Line; N] {
    let pieces: Vec<Piece> = pieces(motion).collect();
    let spans = pieces.par_iter().map(|piece| {
        let steps = steps(piece.duration(), range, pieces.len());
        let at = |i: usize| {
            let u = i as f64 / steps as f64;
            (piece.start + u * piece.duration(), of(piece, u))
        };
        (0..=steps).map(at).collect()
    });
    lines(spans.collect(), range)
}

/// The smooth pieces of a motion, in order.
fn pieces<'a>(motion: &'a Motion) -> impl Iterator<Item = Piece> + 'a {
    let times = motion.times();
    let last = times[times.len() - 1];
    let next = move |piece: &Piece| (piece.end < last).then(|| motion.piece_at(piece.end));
    std::iter::successors(Some(motion.piece_at(times[0])), next)
}

fn steps(duration: f64, [start, end]: [f64; 2], pieces: usize) -> usize {
    let least = (MOST_STEPS / pieces).clamp(2, STEPS_A_PIECE);
    ((duration / (end - start) * STEPS).ceil() as usize).max(least)
}

/// Speed (units a second), acceleration (units a second squared) and curvature (one over
/// units) along a path over time, which begins at `start`.
pub(super) fn path_rates(path: &Path, start: f64, range: [f64; 2]) -> [Line; 3] {
    of_path(path, start, range, |_, velocity, acceleration| {
        let (speed, across) = (velocity.length(), velocity.cross(acceleration).length());
        // On a straight line, where rounding leaves an angle between the two, none.
        let straight = across <= 1e-12 * speed * acceleration.length();
        let curvature = if straight && speed > 0.0 { 0.0 } else { across / speed.powi(3) };
        [speed, acceleration.length(), curvature]
    })
}

/// A path's places over time, as three numbers.
pub(super) fn places(
    path: &Path,
    start: f64,
    range: [f64; 2],
    parts: impl Fn(DVec3) -> [f64; 3] + Sync,
) -> [Line; 3] {
    of_path(path, start, range, |place, _, _| parts(place))
}

fn of_path<const N: usize>(
    path: &Path,
    start: f64,
    range: [f64; 2],
    of: impl Fn(DVec3, DVec3, DVec3) -> [f64; N] + Sync,
) -> [Line; N] {
    let knots = knots(path);
    let spans = knots.par_windows(2).map(|pair| {
        let steps = steps(pair[1] - pair[0], range, knots.len());
        let at = |i: usize| {
            let t = pair[0] + (pair[1] - pair[0]) * i as f64 / steps as f64;
            let values = if i == steps {
                of(path.position(pair[1]), path.velocity_before(pair[1]), path.acceleration_before(pair[1]))
            } else {
                of(path.position(t), path.velocity(t), path.acceleration(t))
            };
            (start + t, values)
        };
        (0..=steps).map(at).collect()
    });
    lines(spans.collect(), range)
}

/// Times between which a path is smooth, from its start to its end.
pub(super) fn knots(path: &Path) -> Vec<f64> {
    let inner = path.key_times().iter().chain(path.jumps()).chain(path.corners()).copied();
    let mut knots: Vec<f64> = inner.chain([0.0, path.duration()]).collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

/// A value a span of time, each with its own ends, as one line a number. Spans whose ends
/// meet run on.
fn lines<const N: usize>(spans: Vec<Vec<(f64, [f64; N])>>, range: [f64; 2]) -> [Line; N] {
    std::array::from_fn(|n| {
        let values = spans.iter().flatten().map(|(_, values)| values[n].abs());
        let largest = values.filter(|v| v.is_finite()).fold(0.0, f64::max);
        let (mut thinner, mut before) = (Thinner::new(range, COLUMNS), f64::NAN);
        for span in &spans {
            // Not a number (nothing before) splits too.
            let meets = span.first().is_some_and(|(_, first)| (first[n] - before).abs() <= JUMP * largest);
            let skipped = usize::from(meets);
            if !meets {
                thinner.split();
            }
            span.iter().skip(skipped).for_each(|(t, values)| thinner.push([*t, values[n]]));
            before = span.last().map_or(f64::NAN, |(_, last)| last[n]);
        }
        thinner.finish()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Ends, Scheme};
    use crate::math::Vec3;
    use crate::path::{Kind, Options};

    fn about_x(angles: &[f64]) -> Vec<Quat> {
        angles.iter().map(|a| Quat::exp(Vec3::new(0.5 * a.to_radians(), 0.0, 0.0))).collect()
    }

    fn all(line: &Line) -> impl Iterator<Item = f64> + '_ {
        line.iter().flatten().map(|point| point[1])
    }

    #[test]
    fn a_steady_turn_has_constant_speed_and_no_more() {
        let times = [0.0, 1.0, 3.0, 4.0];
        let keys = about_x(&[0.0, 20.0, 60.0, 80.0]);
        for scheme in [Scheme::Slerp, Scheme::Bessel, Scheme::NaturalC2] {
            let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
            let [speed, acceleration, jerk] = motion_rates(&motion, [0.0, 4.0]);
            assert_eq!(speed.len(), 1, "{scheme:?}");
            let off = |line: &Line, wanted: f64| all(line).map(|v| (v - wanted).abs()).fold(0.0, f64::max);
            assert!(off(&speed, 20.0) < 1e-9, "{scheme:?}");
            assert!(off(&acceleration, 0.0) < 1e-8 && off(&jerk, 0.0) < 1e-6, "{scheme:?}");
        }
    }

    #[test]
    fn speed_of_slerp_is_a_step_from_key_to_key() {
        let (times, keys) = ([0.0, 1.0, 3.0, 3.5], about_x(&[0.0, 60.0, 20.0, 100.0]));
        let motion = Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural);
        let [speed, acceleration, _] = motion_rates(&motion, [0.0, 3.5]);
        assert_eq!(speed.len(), 3);
        for (stretch, (times, wanted)) in
            speed.iter().zip([([0.0, 1.0], 60.0), ([1.0, 3.0], 20.0), ([3.0, 3.5], 160.0)])
        {
            assert_eq!([stretch[0][0], stretch[stretch.len() - 1][0]], times);
            assert!(stretch.iter().all(|point| (point[1] - wanted).abs() < 1e-9));
        }
        assert!(all(&acceleration).all(|a| a < 1e-9));
    }

    #[test]
    fn speed_is_the_integral_of_acceleration_about_one_axis() {
        // Bessel's cubic between keys 0°, 10°, 40°, 90° at 0 … 3 s is 10 t² + …: its second
        // difference is 20° everywhere, and so natural ends aside it accelerates at 20°/s².
        let (times, keys) = ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], about_x(&[0.0, 10.0, 40.0, 90.0, 160.0, 250.0]));
        let motion = Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural);
        let [speed, acceleration, jerk] = motion_rates(&motion, [0.0, 5.0]);
        let inner = |line: &Line| -> Vec<[f64; 2]> {
            line.iter().flatten().copied().filter(|p| p[0] > 2.001 && p[0] < 2.999).collect()
        };
        assert!(inner(&speed).iter().all(|[t, v]| (v - 20.0 * t).abs() < 1e-9));
        assert!(inner(&acceleration).iter().all(|[_, a]| (a - 20.0).abs() < 1e-8));
        assert!(inner(&jerk).iter().all(|[_, j]| j.abs() < 1e-6));
    }

    #[test]
    fn components_pass_through_their_keys() {
        let times = [0.0, 0.7, 1.1, 2.0];
        let keys: Vec<Quat> =
            (0..4).map(|i| Quat::exp(Vec3::new(0.3 * f64::from(i), 0.2, -0.1 * f64::from(i * i)))).collect();
        for &scheme in Scheme::EVERY.iter().filter(|scheme| scheme.passes_keys()) {
            let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
            let lines = components(&motion, [0.0, 2.0], Quat::to_wxyz);
            for (i, (&t, key)) in times.iter().zip(&keys).enumerate() {
                for (line, wanted) in lines.iter().zip(key.to_wxyz()) {
                    let met = |p: &[f64; 2]| p[0] == t && (p[1] - wanted).abs() < 1e-12;
                    assert!(line.iter().flatten().any(met), "{scheme:?} key {i}");
                }
            }
            assert_eq!(lines[1].len(), if scheme.is_step() { 4 } else { 1 }, "{scheme:?}");
        }
    }

    #[test]
    fn a_circle_has_its_curvature_and_its_centripetal_acceleration() {
        // A quarter of a circle of radius 2 as a cubic: at its ends, where it is farthest
        // from a circle's, its curvature is 2 (1 − k) / (3 k²) = 0.9785 of that.
        let k = 2.0 * 0.552_284_749_830_793_4;
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let points = [at(2.0, 0.0), at(2.0, k), at(k, 2.0), at(0.0, 2.0)];
        let options = Options {
            speed: Some(3.0),
            timing: Some(crate::path::Timing::ConstantSpeed),
            ..Options::default()
        };
        let path = Path::new(Kind::Bezier, &points, None, &options).unwrap();
        let [speed, acceleration, curvature] = path_rates(&path, 1.0, [1.0, 1.0 + path.duration()]);
        assert!(all(&speed).all(|v| (v - 3.0).abs() < 1e-9));
        assert!(all(&acceleration).all(|a| (a / 4.5 - 1.0).abs() < 0.0216));
        assert!(all(&curvature).all(|c| (c / 0.5 - 1.0).abs() < 0.0216));
        assert_eq!(speed[0][0][0], 1.0);
    }

    #[test]
    fn a_corner_is_no_curvature_and_speed_jumps_at_it() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 2.0, 0.0)];
        let path = Path::new(Kind::Polyline, &points, Some(&[0.0, 1.0, 2.0]), &Options::default()).unwrap();
        let [speed, _, curvature] = path_rates(&path, 0.0, [0.0, 2.0]);
        assert_eq!(speed.len(), 2);
        assert!(all(&curvature).all(|c| c == 0.0));
        assert_eq!((speed[0].last().unwrap()[1], speed[1][0][1]), (1.0, 2.0));
    }

    #[test]
    fn a_hundred_thousand_keys_leave_few_points_and_the_peak() {
        let times: Vec<f64> = (0..100_000).map(f64::from).collect();
        let angles: Vec<f64> =
            (0..100_000).map(|i| if i == 51_000 { 90.0 } else { f64::from(i % 2) }).collect();
        let keys = about_x(&angles);
        let motion = Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural);
        let [speed, ..] = motion_rates(&motion, [0.0, 99_999.0]);
        assert!(speed.iter().flatten().count() <= 2 * COLUMNS + 2);
        assert!(all(&speed).any(|v| (v - 89.0).abs() < 1e-9));
    }
}

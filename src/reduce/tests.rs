//! Keys against closed forms, against brute force and against the optimum.

use super::*;
use crate::curve::{Ends, Motion, Rates, Scheme};
use crate::math::Vec3;
use crate::sample::Travel;
use glam::{DQuat, DVec3};

/// Key times and keys with steps up to 150°, over 20 s.
pub(super) fn clip(even: bool, count: usize) -> (Vec<f64>, Vec<Quat>) {
    let wave = |i: usize, k: f64| (k * i as f64 + k).sin();
    let intervals: Vec<f64> = (1..count).map(|i| if even { 1.0 } else { 1.0 + 0.7 * wave(i, 2.9) }).collect();
    let whole: f64 = intervals.iter().sum();
    let after = intervals.iter().scan(0.0, |t, h| {
        *t += h * 20.0 / whole;
        Some(*t)
    });
    let times = [0.0].into_iter().chain(after).collect();
    let keys = (0..count).scan(Quat::IDENTITY, |q, i| {
        let axis = Vec3::new(wave(i, 1.3), wave(i, 2.3), wave(i, 4.1));
        let half_turn = 75f64.to_radians() * (0.5 + 0.5 * wave(i, 5.7));
        *q = *q * Quat::exp(axis * (half_turn / axis.length()));
        Some(*q)
    });
    (times, keys.collect())
}

fn glam(q: [f32; 4]) -> DQuat {
    DQuat::from_array(q.map(f64::from)).normalize()
}

/// The largest angle between a motion and glam's slerp of the keys, degrees, by many
/// probes; and the same for a normalised blend.
fn measured(at: impl Fn(f64) -> Quat, keys: &Keys<4>) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    for (t, q) in keys.times.windows(2).zip(keys.values.windows(2)) {
        let (a, b) = (glam(q[0]), glam(q[1]));
        for i in 0..=40 {
            let u = f64::from(i) / 40.0;
            let time = f64::from(t[0]) + u * (f64::from(t[1]) - f64::from(t[0]));
            let played = [a.slerp(b, u), (a * (1.0 - u) + b * u).normalize()];
            for (worst, played) in worst.iter_mut().zip(played) {
                *worst = worst.max(Quat::from(played).angle_to(at(time)).to_degrees());
            }
        }
    }
    worst
}

fn assert_sound(keys: &Keys<4>, motion: &Motion, options: &Options, name: &str) {
    let Keys { times, values, facts } = keys;
    assert!(times.windows(2).all(|t| t[0] < t[1]), "{name}");
    for (end, value) in [(0, values[0]), (times.len() - 1, values[values.len() - 1])] {
        // Exact but for float32, and its sign.
        let off = Quat::from(glam(value)).angle_to(motion.at(f64::from(times[end])));
        assert!(off < 1.1e-7, "{name}: {off:e}");
    }
    let dots = values.windows(2).map(|q| (0..4).map(|i| q[0][i] * q[1][i]).sum::<f32>());
    assert!(dots.fold(1.0, f32::min) > 0.0, "{name}: signs");
    assert!(facts.proven && facts.deviation <= options.tolerance, "{name}: {facts:?}");
    let worst = measured(|t| motion.at(t), keys);
    for (bound, worst) in [facts.deviation, facts.nlerp].into_iter().zip(worst) {
        // Forty probes miss a peak by little.
        assert!(worst <= bound && bound <= 1.06 * worst + 1e-6, "{name}: {worst} {bound}");
    }
    assert!(facts.keys_moved <= facts.deviation, "{name}");
}

#[test]
fn keys_keep_the_tolerance_and_few_do_off_the_curve() {
    for (scheme, even) in [(Scheme::Bessel, true), (Scheme::Bessel, false), (Scheme::CatmullRom, false)] {
        let (times, keys) = clip(even, 25);
        let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
        let curve = Turning::new(motion.clone());
        for tolerance in [0.1, 0.01, 0.001] {
            let name = format!("{} {even} {tolerance}", scheme.name());
            let options = Options::new(tolerance);
            let off_curve = rotation(&curve, &options).unwrap();
            assert_sound(&off_curve, &motion, &options, &name);
            let options = Options { on_curve: true, ..options };
            let on_curve = rotation(&curve, &options).unwrap();
            assert_sound(&on_curve, &motion, &options, &name);
            let share = off_curve.times.len() as f64 / on_curve.times.len() as f64;
            assert!(share <= 0.75, "{name}: {share}");
            for corner in curve.corners() {
                assert!(on_curve.times.contains(&(*corner as f32)), "{name}");
                assert!(off_curve.times.contains(&(*corner as f32)), "{name}");
            }
        }
    }
}

/// The fewest intervals on the curve between two times, at times on a grid of `count`.
fn optimum(motion: &Motion, (from, to): (f64, f64), count: usize, tolerance: f64) -> usize {
    let last = count - 1;
    let at: Vec<DQuat> =
        (0..count).map(|i| motion.at(from + (to - from) * i as f64 / last as f64).into()).collect();
    let near = |a: DQuat, b: DQuat| Quat::from(a).angle_to(b.into()) <= tolerance.to_radians();
    let serves = |i: usize, j: usize| {
        let served = |k: usize| near(at[i].slerp(at[j], (k - i) as f64 / (j - i) as f64), at[k]);
        served((i + j) / 2) && (i + 1..j).all(served)
    };
    let mut fewest = vec![usize::MAX; count];
    fewest[0] = 0;
    for i in 0..last {
        let mut furthest = i + 1;
        for j in i + 1..count {
            if serves(i, j) {
                furthest = j;
                fewest[j] = fewest[j].min(fewest[i] + 1);
            } else if j - i > 10 + 2 * (furthest - i) {
                break; // bends far back before it could be reached again
            }
        }
    }
    fewest[last]
}

#[test]
fn on_the_curve_the_optimum_is_near() {
    for (scheme, even) in [(Scheme::Bessel, true), (Scheme::Squad, false)] {
        let (times, keys) = clip(even, 7);
        let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
        let curve = Turning::new(motion.clone());
        let found = rotation(&curve, &Options { on_curve: true, ..Options::new(0.3) }).unwrap();
        // Corners are kept: each stretch between two has its own optimum.
        let stops: Vec<f64> =
            [0.0].into_iter().chain(curve.corners().iter().copied()).chain([times[6]]).collect();
        let count = 30 * found.times.len() / (stops.len() - 1);
        let best: usize = stops.windows(2).map(|pair| optimum(&motion, (pair[0], pair[1]), count, 0.3)).sum();
        let intervals = found.times.len() - 1;
        assert!(intervals as f64 <= 1.03 * best as f64, "{intervals} {best}");
        assert!(intervals as f64 >= 0.95 * best as f64, "the grid is too coarse: {intervals} {best}");
    }
}

#[test]
fn steady_turns_need_what_the_step_asks() {
    // Two turns about one axis: no key is a corner.
    let times: Vec<f64> = (0..9).map(f64::from).collect();
    let axis = Vec3::new(0.48, 0.6, 0.64);
    let keys: Vec<Quat> = times.iter().map(|t| Quat::exp(axis * (t * 90.0 * HALF_DEGREE))).collect();
    let curve = Turning::new(Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural));
    assert!(curve.corners().is_empty());
    for on_curve in [true, false] {
        for (max_step, intervals) in [(Some(18.0), 40), (Some(45.0), 16), (Some(50.0), 15), (None, 5)] {
            let options = Options { max_step, on_curve, ..Options::new(0.01) };
            let keys = rotation(&curve, &options).unwrap();
            assert_eq!(keys.times.len(), intervals + 1, "{max_step:?} {on_curve}");
            let step = max_step.unwrap_or(171.0);
            assert!(keys.facts.largest_step <= step * (1.0 + 3e-5), "{:?}", keys.facts);
        }
    }
}

#[test]
fn slerp_keeps_its_keys_and_equal_steps_between() {
    let (times, keys) = clip(false, 6);
    let curve = Turning::new(Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural));
    assert_eq!(curve.corners(), &times[1..5]);
    let found = rotation(&curve, &Options::new(0.01)).unwrap();
    assert_eq!(found.times, times.iter().map(|&t| t as f32).collect::<Vec<f32>>());
    let options = Options { max_step: Some(18.0), ..Options::new(0.01) };
    let found = rotation(&curve, &options).unwrap();
    let steps = keys.windows(2).map(|pair| (pair[0].angle_to(pair[1]).to_degrees() / 18.0).ceil() as usize);
    assert_eq!(found.times.len(), 1 + steps.sum::<usize>());
    assert!(found.facts.largest_step <= 18.0 * (1.0 + 3e-5));
}

#[test]
fn stillness_costs_one_key() {
    let (times, _) = clip(true, 5);
    let keys = vec![Quat::exp(Vec3::new(0.3, -0.2, 0.5)); 5];
    let curve = Turning::new(Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural));
    let found = rotation(&curve, &Options::new(0.001)).unwrap();
    assert_eq!(found.times, [0.0]);
    assert!(found.facts.deviation < 1e-5 && found.facts.proven);
}

#[test]
fn a_jump_keeps_its_ramp() {
    let (times, keys) = clip(true, 5);
    let motion = Motion::new(&times, &keys, Scheme::Bessel, Ends::Hold);
    let options = Options { max_step: Some(18.0), ..Options::new(0.05) };
    let found = rotation(&Turning::new(motion.clone()), &options).unwrap();
    assert_sound(&found, &motion, &options, "hold");
    for time in [motion.ramp().unwrap() as f32, times[1] as f32] {
        assert!(found.times.contains(&time));
    }
    assert!(found.facts.largest_step <= 18.0 * (1.0 + 3e-5));
}

#[test]
fn what_float32_cannot_keep_is_refused() {
    let (times, keys) = clip(true, 5);
    let curve = Turning::new(Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural));
    for options in [
        Options::new(1e-5),
        Options::new(f64::NAN),
        Options { reserve: 0.0999999, ..Options::new(0.1) },
        Options { reserve: -1.0, ..Options::new(0.1) },
    ] {
        assert!(matches!(rotation(&curve, &options), Err(Error::Tolerance { .. })), "{options:?}");
    }
    // An hour from now times are 2.4e-4 s apart: 60° a second are 0.01°.
    let later: Vec<f64> = times.iter().map(|t| t + 5000.0001).collect();
    let curve = Turning::new(Motion::new(&later, &keys, Scheme::Slerp, Ends::Natural));
    assert!(matches!(rotation(&curve, &Options::new(1e-4)), Err(Error::Times { .. })));
    assert!(rotation(&curve, &Options::new(0.5)).is_ok());
}

#[test]
fn reserve_leaves_room() {
    let (times, keys) = clip(true, 7);
    let curve = Turning::new(Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural));
    let less = rotation(&curve, &Options { reserve: 0.04, ..Options::new(0.1) }).unwrap();
    assert!(less.facts.deviation <= 0.06);
    assert_eq!(less, rotation(&curve, &Options::new(0.06)).unwrap());
}

/// A parabola up to t = 10, then straight on with a corner, in a place far away.
struct Throw;

const CORNER: f64 = 10.0;
/// Its acceleration.
const FALL: f64 = 2.0;

impl Travel for Throw {
    fn at(&self, t: f64) -> DVec3 {
        let fallen = t.min(CORNER);
        let height = 5.0 * t - 0.5 * FALL * fallen * fallen;
        DVec3::new(3.0 * t, height, 100.0)
    }

    fn acceleration_bound(&self, from: f64, _to: f64) -> f64 {
        if from < CORNER { FALL } else { 0.0 }
    }

    fn speed_bound(&self, _from: f64, _to: f64) -> f64 {
        40.0
    }

    fn knots(&self) -> &[f64] {
        &[0.0, CORNER, 14.0]
    }
}

fn distance(travel: &dyn Travel, keys: &Keys<3>) -> f64 {
    let mut worst: f64 = 0.0;
    for (t, p) in keys.times.windows(2).zip(keys.values.windows(2)) {
        let [a, b] = [p[0], p[1]].map(|p| DVec3::from_array(p.map(f64::from)));
        for i in 0..=40 {
            let u = f64::from(i) / 40.0;
            let time = f64::from(t[0]) + u * (f64::from(t[1]) - f64::from(t[0]));
            worst = worst.max(a.lerp(b, u).distance(travel.at(time)));
        }
    }
    worst
}

#[test]
fn parabola_needs_what_its_acceleration_asks() {
    // One interval serves √(8ε/a) on the curve and √2 times that off it, but from an end
    // that is on the curve only (1 + √2)/2 of it. ε so that the last interval is not
    // nearly full.
    for n in [7, 12, 31] {
        let h = CORNER / (f64::from(n) - 0.4);
        let epsilon = h * h * FALL / 8.0;
        let on_curve = Options { on_curve: true, ..Options::new(epsilon) };
        let curve = Travelling::new(&Throw, (0.0, 14.0), &[CORNER]);
        let keys = numbers(&curve, &on_curve).unwrap();
        assert_eq!(keys.times.len() as i32, n + 2, "{epsilon}");
        assert!(keys.times.contains(&(CORNER as f32)));
        let worst = distance(&Throw, &keys);
        assert!(keys.facts.deviation <= epsilon && keys.facts.deviation >= worst);
        assert!(keys.facts.deviation <= 1.06 * worst);

        // The parabola alone, from its start to its end.
        let curve = Travelling::new(&Throw, (0.0, CORNER), &[]);
        let keys = numbers(&curve, &Options::new(epsilon)).unwrap();
        let first = (1.0 + 2f64.sqrt()) / 2.0 * h;
        let between = (CORNER - 2.0 * first) / (2f64.sqrt() * h);
        let intervals = keys.times.len() - 1;
        // The search aims at 0.4 % less than the tolerance, 0.2 % of an interval.
        let [least, most] = [between, 1.005 * between].map(|between| 2 + between.ceil() as usize);
        assert!((least..=most).contains(&intervals), "{n}: {intervals}, {between}");
        assert!(keys.facts.deviation <= epsilon && keys.facts.deviation >= distance(&Throw, &keys));
    }
}

/// Around a circle once in 2π seconds.
struct Circle;

impl Travel for Circle {
    fn at(&self, t: f64) -> DVec3 {
        DVec3::new(t.cos(), t.sin(), 0.0)
    }

    fn acceleration_bound(&self, _from: f64, _to: f64) -> f64 {
        1.0
    }

    fn speed_bound(&self, _from: f64, _to: f64) -> f64 {
        1.0
    }

    fn knots(&self) -> &[f64] {
        &[0.0, 6.0]
    }
}

#[test]
fn circle_needs_what_its_sagitta_asks() {
    let curve = Travelling::new(&Circle, (0.0, 6.0), &[]);
    for n in [5, 20, 100] {
        let angle = 6.0 / (f64::from(n) - 0.4);
        let epsilon = 1.0 - (0.5 * angle).cos();
        let on_curve = Options { on_curve: true, ..Options::new(epsilon) };
        assert_eq!(numbers(&curve, &on_curve).unwrap().times.len() as i32, n + 1);
        // Keys outside by ε, chords inside by ε: (1 + ε) cos(α/2) = 1 − ε.
        let off_curve = numbers(&curve, &Options::new(epsilon)).unwrap();
        let outside = 2.0 * ((1.0 - epsilon) / (1.0 + epsilon)).acos();
        let least = (6.0 / outside).ceil() as usize;
        let intervals = off_curve.times.len() - 1;
        // Both ends are on the curve, which may cost an interval.
        assert!((least..=least + 1).contains(&intervals), "{intervals} {least}");
        assert!(off_curve.facts.deviation >= distance(&Circle, &off_curve));
    }
}

#[test]
fn many_keys_cost_few_more() {
    let curve = Travelling::new(&Circle, (0.0, 6000.0), &[]);
    let count = 5 * Options::CAREFUL;
    let outside = 6000.0 / count as f64;
    let ratio = (0.5 * outside).cos();
    let keys = numbers(&curve, &Options::new((1.0 - ratio) / (1.0 + ratio))).unwrap();
    // The search aims a little lower, and float32 times round by a hundredth of the tolerance.
    assert!((count..=count + count / 50).contains(&keys.times.len()), "{} {count}", keys.times.len());
}

#[test]
fn what_swings_round_is_refused() {
    // 80° a second, run on over 80 seconds, are 18 turns; over eight they are not too many.
    let keys: Vec<Quat> =
        (0..4).map(|i| Quat::exp(Vec3::new(40f64.to_radians() * f64::from(i), 0.0, 0.0))).collect();
    for (last, refused) in [(81.0, true), (9.0, false), (2.0, false)] {
        let times = [0.0, 1.0, last, last + 1.0];
        let motion = Motion::new(&times, &keys, Scheme::BarryGoldman, Ends::Natural);
        let curve = Turning::new(motion);
        let options = Options::new(0.1);
        let at_once = Error::Swings { time: 1.0 };
        assert_eq!(rotation(&curve, &options).err() == Some(at_once), refused);
        assert_eq!(cubic_rotation(&curve, &options).err() == Some(at_once), refused);
    }
}

#[test]
fn places_below_float32_are_refused() {
    let curve = Travelling::new(&Throw, (0.0, 14.0), &[CORNER]);
    assert!(matches!(numbers(&curve, &Options::new(1e-6)), Err(Error::Tolerance { .. })));
}

#[test]
fn a_plain_function_is_measured() {
    // Sways, and jumps at 2 s.
    let at = |t: f64| {
        let sway = Quat::exp(Vec3::new(0.4 * t.sin(), 0.3 * (1.3 * t).cos(), 0.0));
        if t < 2.0 { sway } else { Quat::exp(Vec3::new(0.0, 0.0, 0.6)) * sway }
    };
    let curve = Attitude::new(&at, (0.0, 4.0), &[0.0, 2.0, 4.0], &[(1.999, 2.0)]);
    let options = Options { max_step: Some(10.0), ..Options::new(0.02) };
    let keys = rotation(&curve, &options).unwrap();
    assert!(!keys.facts.proven && keys.facts.deviation <= 0.02);
    assert!(keys.times.contains(&1.999) && keys.times.contains(&2.0));
    assert!(keys.facts.largest_step < 10.001);
    let [worst, _] = measured(|t| curve.at(t), &keys);
    assert!(worst <= 1.01 * keys.facts.deviation, "{worst} {:?}", keys.facts);
}

/// Many keys with slerp between them: a file's own playback.
struct Dense {
    times: Vec<f64>,
    keys: Vec<Quat>,
}

impl Curve for Dense {
    type Value = Quat;

    fn at(&self, t: f64) -> Quat {
        let i = self.times.partition_point(|&key| key <= t).clamp(1, self.times.len() - 1);
        let u = (t - self.times[i - 1]) / (self.times[i] - self.times[i - 1]);
        self.keys[i - 1].played(self.keys[i], u.clamp(0.0, 1.0))
    }

    fn knots(&self) -> &[f64] {
        &self.times
    }

    fn corners(&self) -> &[f64] {
        &[]
    }

    fn rates(&self, from: f64, _to: f64) -> Option<Rates> {
        let i = self.times.partition_point(|&key| key <= from).clamp(1, self.times.len() - 1);
        let way = self.keys[i - 1].distance(self.keys[i]);
        let speed = way / (self.times[i] - self.times[i - 1]) * (1.0 + 1e-9);
        Some(Rates { speed, acceleration: 0.0 })
    }
}

#[test]
fn keys_of_a_dense_file_are_thinned_out() {
    let (times, keys) = clip(true, 7);
    let motion = Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural);
    let times: Vec<f64> = (0..=1200).map(|i| f64::from((f64::from(i) / 60.0) as f32)).collect();
    let keys = times.iter().map(|&t| motion.at(t)).collect();
    let dense = Dense { times, keys };
    let straight = rotation(&Turning::new(motion.clone()), &Options::new(0.1)).unwrap();
    let options = Options::new(0.1);
    let found = rotation(&dense, &options).unwrap();
    // Near what the curve itself needs: the file is less than 0.02° off it.
    assert!(found.times.len() as f64 <= 1.1 * straight.times.len() as f64);
    let [worst, _] = measured(|t| dense.at(t), &found);
    assert!(worst <= found.facts.deviation && found.facts.deviation <= 0.1);
}

#[test]
fn keys_do_not_depend_on_threads() {
    let (times, keys) = clip(false, 9);
    let curve = Turning::new(Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural));
    let found = || rotation(&curve, &Options::new(0.05)).unwrap();
    let elsewhere = std::thread::scope(|scope| scope.spawn(found).join().unwrap());
    assert_eq!(found(), elsewhere);
}

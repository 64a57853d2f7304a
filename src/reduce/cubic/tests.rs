//! Cubics against closed forms and against another implementation of their playback.

use super::*;
use crate::curve::{Ends, Motion, Rates, Scheme};
use crate::reduce::Turning;
use crate::reduce::tests::clip;
use glam::{DQuat, DVec4};

/// The specification's formula (appendix C), written by its four weights.
fn played<const N: usize>(keys: &CubicKeys<N>, i: usize, u: f64) -> [f64; N] {
    let td = f64::from(keys.times[i + 1]) - f64::from(keys.times[i]);
    let (u2, u3) = (u * u, u * u * u);
    let ([_, v, b], [a, w, _]) = (keys.values[i], keys.values[i + 1]);
    std::array::from_fn(|k| {
        (2.0 * u3 - 3.0 * u2 + 1.0) * f64::from(v[k])
            + td * (u3 - 2.0 * u2 + u) * f64::from(b[k])
            + (-2.0 * u3 + 3.0 * u2) * f64::from(w[k])
            + td * (u3 - u2) * f64::from(a[k])
    })
}

/// The largest angle from a motion, degrees, by many probes.
fn measured(at: impl Fn(f64) -> Quat, keys: &CubicKeys<4>) -> f64 {
    let mut worst: f64 = 0.0;
    for (i, t) in keys.times.windows(2).enumerate() {
        for k in 0..=40 {
            let u = f64::from(k) / 40.0;
            let shown = DQuat::from_vec4(DVec4::from_array(played(keys, i, u)).normalize());
            let time = f64::from(t[0]) + u * (f64::from(t[1]) - f64::from(t[0]));
            worst = worst.max(Quat::from(shown).angle_to(at(time)).to_degrees());
        }
    }
    worst
}

#[test]
fn rotations_keep_the_tolerance_by_few_keys() {
    for (scheme, even) in [(Scheme::Bessel, true), (Scheme::Squad, false), (Scheme::NaturalC2, false)] {
        let (times, rotations) = clip(even, 12);
        let motion = Motion::new(&times, &rotations, scheme, Ends::Natural);
        let curve = Turning::new(motion.clone());
        let mut counts = Vec::new();
        for tolerance in [0.1, 0.01, 0.001] {
            let name = format!("{} {even} {tolerance}", scheme.name());
            let options = Options { max_step: Some(90.0), ..Options::new(tolerance) };
            let keys = cubic_rotation(&curve, &options).unwrap();
            let (bound, worst) = (keys.facts.deviation, measured(|t| motion.at(t), &keys));
            // Forty probes miss a crest by little.
            assert!(worst <= bound && bound <= tolerance && bound <= 1.06 * worst, "{name}: {worst} {bound}");
            assert!(keys.facts.proven && keys.facts.keys_moved <= bound, "{name}");
            assert!(keys.facts.largest_step <= 90.01, "{name}");
            let dots = keys.values.windows(2).map(|v| (0..4).map(|i| v[0][1][i] * v[1][1][i]).sum::<f32>());
            assert!(dots.fold(1.0, f32::min) > 0.0, "{name}: signs");
            counts.push(keys.times.len());
        }
        let linear = crate::reduce::rotation(&curve, &Options::new(0.001)).unwrap().times.len();
        assert!(10 * counts[2] < linear, "{counts:?} {linear}");
        // A quartic error: a tenth takes 10^(1/4) = 1.78 times as many, and the knots, at
        // which the acceleration jumps, something more.
        assert!(counts.windows(2).all(|n| n[1] as f64 <= 2.2 * n[0] as f64), "{counts:?}");
    }
}

#[test]
fn a_steady_turn_costs_as_few_as_the_step_allows() {
    let axis = crate::math::Vec3::new(0.48, 0.6, 0.64);
    let turn = |degrees: f64| Quat::exp(axis * (degrees.to_radians() / 2.0));
    let keys = [turn(0.0), turn(170.0), turn(340.0)];
    let motion = Motion::new(&[0.0, 1.0, 2.0], &keys, Scheme::Bessel, Ends::Natural);
    let curve = Turning::new(motion);
    for (step, expected) in [(90.0, 5), (34.0, 11)] {
        let options = Options { max_step: Some(step), ..Options::new(0.5) };
        assert_eq!(cubic_rotation(&curve, &options).unwrap().times.len(), expected);
    }
}

#[test]
fn stillness_costs_one_key() {
    let keys = vec![Quat::exp(crate::math::Vec3::new(0.1, 0.2, 0.3)); 4];
    let motion = Motion::new(&[0.0, 1.0, 2.0, 4.0], &keys, Scheme::Bessel, Ends::Natural);
    let found = cubic_rotation(&Turning::new(motion), &Options::new(0.01)).unwrap();
    assert_eq!(found.times, [0.0]);
    assert_eq!(found.values[0][0], [0.0; 4]);
}

#[test]
fn corners_stay_corners() {
    let (times, rotations) = clip(false, 8);
    let motion = Motion::new(&times, &rotations, Scheme::Slerp, Ends::Natural);
    let options = Options { max_step: Some(60.0), ..Options::new(0.01) };
    let found = cubic_rotation(&Turning::new(motion.clone()), &options).unwrap();
    assert!(times.iter().all(|&t| found.times.contains(&(t as f32))));
    assert!(measured(|t| motion.at(t), &found) <= found.facts.deviation);
}

/// A curve that runs through x = t³ − t and y = sin 3t over 0..=4; of it all or nothing is known.
struct Wave {
    known: bool,
}

impl Curve for Wave {
    type Value = Numbers<2>;
    fn at(&self, t: f64) -> Numbers<2> {
        Numbers([t * t * t - t, (3.0 * t).sin()])
    }
    fn knots(&self) -> &[f64] {
        &[0.0, 4.0]
    }
    fn corners(&self) -> &[f64] {
        &[]
    }
    fn rates(&self, _: f64, to: f64) -> Option<Rates> {
        let (speed, acceleration) = (3.0 * to * to - 1.0, 6.0 * to);
        self.known.then_some(Rates { speed: speed.hypot(3.0), acceleration: acceleration.hypot(9.0) })
    }
}

#[test]
fn numbers_keep_the_tolerance_whether_or_not_anything_is_known() {
    for known in [true, false] {
        let (curve, tolerance) = (Wave { known }, 1e-3);
        let keys = cubic_numbers(&curve, &Options::new(tolerance)).unwrap();
        let mut worst: f64 = 0.0;
        for (i, t) in keys.times.windows(2).enumerate() {
            for k in 0..=40 {
                let u = f64::from(k) / 40.0;
                let time = f64::from(t[0]) + u * (f64::from(t[1]) - f64::from(t[0]));
                let (got, wanted) = (played(&keys, i, u), curve.at(time).0);
                worst = worst.max((got[0] - wanted[0]).hypot(got[1] - wanted[1]));
            }
        }
        let bound = keys.facts.deviation;
        assert!(worst <= bound * 1.01 && bound <= tolerance && bound <= 1.06 * worst, "{worst} {bound}");
        assert_eq!(keys.facts.proven, known);
        // The cubic part costs nothing. A sine of 81 sin 3t as fourth derivative: intervals of
        // h err by 81 h⁴/24 · 0.0107, so h = 0.41 and ten of them; near the zeros longer.
        assert!((8..=12).contains(&keys.times.len()), "{}", keys.times.len());
    }
}

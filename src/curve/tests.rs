//! What every scheme must do, whatever its formula.

use super::*;
use crate::math::{Interval, Jet, Quat, Vec3};

const UNEVEN: [f64; 7] = [0.0, 0.7, 1.0, 2.2, 2.9, 4.4, 5.0];
const EVEN: [f64; 7] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

/// Keys that turn about changing axes, by up to 140° at a time.
fn keys() -> Vec<Quat> {
    let steps = [[0.0, 0.0, 0.0], [0.4, -0.3, 0.2], [-0.2, 0.9, 0.5], [0.1, 0.1, -1.0], [0.7, 0.9, 0.1]];
    let steps = steps.into_iter().chain([[-0.5, 0.2, 0.1], [0.3, -0.9, -0.6]]);
    let turns = steps.scan(Quat::IDENTITY, |q, [x, y, z]| {
        *q = *q * Quat::exp(Vec3::new(x, y, z));
        Some(*q)
    });
    turns.collect()
}

/// Closed: the last key is the first, with the other sign.
fn closed_keys() -> Vec<Quat> {
    let mut keys = keys();
    let last = keys.len() - 1;
    keys[last] = keys[0].aligned_to(keys[last - 1]);
    keys
}

fn distance(a: Quat, b: Quat) -> f64 {
    let d = [a.w - b.w, a.v.x - b.v.x, a.v.y - b.v.y, a.v.z - b.v.z];
    d.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn each(check: impl Fn(Scheme, Ends)) {
    for &scheme in Scheme::ALL {
        Ends::ALL.into_iter().for_each(|ends| check(scheme, ends));
    }
}

/// Angular velocity (half of it) just before and just after key i.
fn velocities(motion: &Motion, i: usize) -> (Vec3, Vec3) {
    let times = motion.times();
    let at = |piece: Piece, u: f64| piece.at(Jet::variable(u)).half_velocity() * (1.0 / piece.duration());
    let before = motion.piece(i - 1, times[i].next_down());
    (at(before, 1.0), at(motion.piece(i, times[i]), 0.0))
}

#[test]
fn keys_are_passed_through() {
    each(|scheme, ends| {
        let keys = keys();
        let motion = Motion::new(&UNEVEN, &keys, scheme, ends);
        let reached = keys.iter().zip(UNEVEN).enumerate();
        // Hold never reaches its last key; closed ends move it.
        let open = !scheme.has_ends() || !matches!(ends, Ends::Hold | Ends::Closed);
        for (i, (key, t)) in reached.take(if open { 7 } else { 6 }) {
            if !scheme.passes_keys() && (ends == Ends::Closed || (i > 0 && i < 6)) {
                continue;
            }
            let error = motion.at(t).angle_to(*key);
            assert!(error < 1e-14, "{} {}: key {i} missed by {error}", scheme.name(), ends.name());
        }
    });
}

#[test]
fn motion_is_unit_and_continuous_with_its_sign() {
    each(|scheme, ends| {
        let keys = closed_keys();
        let motion = Motion::new(&UNEVEN, &keys, scheme, ends);
        let mut previous = motion.at(0.0);
        for i in 0..=50_000 {
            let q = motion.at(f64::from(i) * 1e-4);
            assert!((q.norm() - 1.0).abs() < 1e-14);
            // At most 12 rad/s but for the ramp, which turns by half a radian in 1 ms.
            let reach = if ends == Ends::Hold { 0.1 } else { 1.2e-3 };
            assert!(distance(q, previous) < reach, "{} {} {i}", scheme.name(), ends.name());
            previous = q;
        }
    });
}

#[test]
fn velocity_is_continuous_where_the_scheme_says_so() {
    each(|scheme, ends| {
        for times in [EVEN, UNEVEN] {
            let keys = closed_keys();
            let motion = Motion::new(&times, &keys, scheme, ends);
            let smooth = match scheme.smoothness() {
                Smoothness::Jumps | Smoothness::Corners => false,
                Smoothness::EvenKeys => times == EVEN,
                Smoothness::Always | Smoothness::Twice => true,
            };
            let inner = if ends == Ends::Hold { 2..5 } else { 1..6 };
            let jumps = inner.map(|i| {
                let (before, after) = velocities(&motion, i);
                (before - after).length()
            });
            let worst = jumps.fold(0.0, f64::max);
            let name = scheme.name();
            assert_eq!(worst < 1e-12, smooth, "{name} {}: jump {worst}", ends.name());
        }
    });
}

/// Angular acceleration (half of it) just before and just after key i.
fn accelerations(motion: &Motion, i: usize) -> (Vec3, Vec3) {
    let at = |piece: Piece, u: f64| {
        piece.at(Jet::variable(u)).half_acceleration() * (1.0 / piece.duration().powi(2))
    };
    let before = motion.piece(i - 1, motion.times()[i].next_down());
    (at(before, 1.0), at(motion.piece(i, motion.times()[i]), 0.0))
}

#[test]
fn acceleration_is_continuous_where_the_scheme_says_so() {
    each(|scheme, ends| {
        for times in [EVEN, UNEVEN] {
            let keys = closed_keys();
            let motion = Motion::new(&times, &keys, scheme, ends);
            let inner = if ends == Ends::Hold { 2..5 } else { 1..6 };
            let jumps = inner.map(|i| {
                let (before, after) = accelerations(&motion, i);
                (before - after).length()
            });
            let worst = jumps.fold(0.0, f64::max);
            let smooth = scheme.smoothness() == Smoothness::Twice;
            // Terms of up to 6/h² = 67 times 3 rad round; slerp has no acceleration at all.
            let name = format!("{} {}: jump {worst}", scheme.name(), ends.name());
            assert!(scheme == Scheme::Slerp || (worst < 1e-11) == smooth, "{name}");
        }
    });
}

/// Schemes that ends shape.
fn with_ends() -> impl Iterator<Item = Scheme> {
    Scheme::ALL.iter().copied().filter(|scheme| scheme.has_ends())
}

#[test]
fn ends_do_what_they_say() {
    let keys = closed_keys();
    for scheme in with_ends() {
        let jet = |ends, i: usize, u| {
            Motion::new(&EVEN, &keys, scheme, ends).piece(i, EVEN[i] + u).at(Jet::variable(u))
        };
        for (i, u) in [(0, 0.0), (5, 1.0)] {
            assert!(jet(Ends::Clamped, i, u).half_velocity().length() < 1e-13, "{}", scheme.name());
            let acceleration = jet(Ends::Natural, i, u).half_acceleration().length();
            // squad's natural end is without acceleration on one axis only.
            assert!(scheme == Scheme::Squad || acceleration < 1e-12, "{} {acceleration}", scheme.name());
            let velocity = (keys[i].conjugate() * keys[i + 1]).log();
            let off = (jet(Ends::Chord, i, u).half_velocity() - velocity).length();
            assert!(off < 1e-13, "{} {off}", scheme.name());
        }
        let (start, end) = (jet(Ends::Closed, 0, 0.0), jet(Ends::Closed, 5, 1.0));
        assert!((start.half_velocity() - end.half_velocity()).length() < 1e-13, "{}", scheme.name());
        let seam = (start.half_acceleration() - end.half_acceleration()).length();
        assert_eq!(seam < 1e-12, scheme.smoothness() == Smoothness::Twice, "{} {seam}", scheme.name());
        let held = Motion::new(&EVEN, &keys, scheme, Ends::Hold);
        assert_eq!(held.at(0.998), keys[0]);
        assert_eq!(held.at(6.0), keys[5]);
        assert!(held.at(0.9995).angle_to(keys[0]) > 0.1);
    }
}

#[test]
fn signs_in_the_file_change_nothing() {
    each(|scheme, ends| {
        let keys = closed_keys();
        let flipped: Vec<Quat> = keys.iter().map(|&q| -q).collect();
        let (a, b) =
            (Motion::new(&UNEVEN, &keys, scheme, ends), Motion::new(&UNEVEN, &flipped, scheme, ends));
        for i in 0..=100 {
            let t = 0.05 * f64::from(i);
            assert_eq!(a.at(t), -b.at(t), "{} {}", scheme.name(), ends.name());
        }
    });
}

#[test]
fn a_turn_of_the_whole_clip_turns_the_motion() {
    each(|scheme, ends| {
        let keys = closed_keys();
        let turn = Quat::exp(Vec3::new(0.9, -1.1, 0.4));
        let turned: Vec<Quat> = keys.iter().map(|&q| turn * q).collect();
        let (a, b) = (Motion::new(&UNEVEN, &keys, scheme, ends), Motion::new(&UNEVEN, &turned, scheme, ends));
        for i in 0..=100 {
            let t = 0.05 * f64::from(i);
            assert!(distance(turn * a.at(t), b.at(t)) < 1e-13, "{} {}", scheme.name(), ends.name());
        }
    });
}

#[test]
fn slower_time_is_the_same_motion_slower() {
    each(|scheme, ends| {
        // A ramp keeps its millisecond.
        if ends == Ends::Hold {
            return;
        }
        let keys = closed_keys();
        let slow = UNEVEN.map(|t| 1024.0 * t);
        let (a, b) = (Motion::new(&UNEVEN, &keys, scheme, ends), Motion::new(&slow, &keys, scheme, ends));
        for i in 0..=100 {
            let t = 0.05 * f64::from(i);
            assert!(distance(a.at(t), b.at(1024.0 * t)) < 1e-13, "{} {}", scheme.name(), ends.name());
        }
    });
}

#[test]
fn even_keys_make_bessel_overhauser_catmull_rom() {
    let keys = keys();
    for ends in [Ends::Natural, Ends::Clamped, Ends::Repeat] {
        let a = Motion::new(&EVEN, &keys, Scheme::CatmullRom, ends);
        let b = Motion::new(&EVEN, &keys, Scheme::BesselOverhauser, ends);
        for i in 0..=600 {
            let t = 0.01 * f64::from(i);
            assert!(distance(a.at(t), b.at(t)) < 1e-13);
        }
    }
}

#[test]
fn two_keys_make_every_scheme_with_ends_slerp() {
    let keys = [Quat::IDENTITY, Quat::exp(Vec3::new(0.3, 0.9, -0.4))];
    let slerp = Motion::new(&[0.0, 2.0], &keys, Scheme::Slerp, Ends::Natural);
    for (scheme, ends) in with_ends().flat_map(|scheme| Ends::ALL.map(|ends| (scheme, ends))) {
        let motion = Motion::new(&[0.0, 2.0], &keys, scheme, ends);
        for i in 0..=20 {
            let t = 0.1 * f64::from(i);
            assert_eq!(motion.at(t), slerp.at(t));
        }
    }
}

/// On one axis rotations add like numbers, and each scheme becomes a scalar spline.
#[test]
fn on_one_axis_schemes_are_scalar_splines() {
    // Small enough for no power of bessel-overhauser to exceed half a turn.
    let angles = [0.0, 0.25, 0.65, 0.55, -0.1, 0.2, 0.45];
    let axis = Vec3::new(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);
    let keys = angles.map(|a| Quat::exp(axis * a));
    for &scheme in Scheme::ALL {
        let motion = Motion::new(&UNEVEN, &keys, scheme, Ends::Natural);
        for i in 0..=500 {
            let t = 0.01 * f64::from(i);
            let expected = Quat::exp(axis * scalar_spline(scheme, &angles, t));
            let off = distance(motion.at(t), expected);
            assert!(off < 1e-13, "{} at {t}: {off}", scheme.name());
        }
    }
}

/// The slopes of the natural cubic spline, by many sweeps over its equations.
fn natural_slopes(x: &[f64; 7]) -> [f64; 7] {
    let h = |i: usize| UNEVEN[i + 1] - UNEVEN[i];
    let chord = |i: usize| (x[i + 1] - x[i]) / h(i);
    let mut slopes = [0.0; 7];
    for _ in 0..200 {
        for i in 0..7 {
            let (before, after) = (i > 0, i < 6);
            let mut sum = 0.0;
            let mut weight = 0.0;
            if before {
                sum += (3.0 * chord(i - 1) - slopes[i - 1]) / h(i - 1);
                weight += 2.0 / h(i - 1);
            }
            if after {
                sum += (3.0 * chord(i) - slopes[i + 1]) / h(i);
                weight += 2.0 / h(i);
            }
            slopes[i] = sum / weight;
        }
    }
    slopes
}

/// The B-spline of some degree whose support begins at knot k.
fn cox_de_boor(knot: &dyn Fn(i64) -> f64, k: i64, degree: i64, t: f64) -> f64 {
    if degree == 0 {
        return if knot(k) <= t && t < knot(k + 1) { 1.0 } else { 0.0 };
    }
    let rising = (t - knot(k)) / (knot(k + degree) - knot(k));
    let falling = (knot(k + degree + 1) - t) / (knot(k + degree + 1) - knot(k + 1));
    rising * cox_de_boor(knot, k, degree - 1, t) + falling * cox_de_boor(knot, k + 1, degree - 1, t)
}

/// Each scheme for numbers instead of rotations, in Hermite or Bernstein form.
fn scalar_spline(scheme: Scheme, x: &[f64; 7], t: f64) -> f64 {
    let i = (0..5).rev().find(|&i| UNEVEN[i] <= t).unwrap_or(0);
    let i = if t >= UNEVEN[5] { 5 } else { i };
    let h = |i: usize| UNEVEN[i + 1] - UNEVEN[i];
    let u = (t - UNEVEN[i]) / h(i);
    let lerp = |a: f64, b: f64, u: f64| a + (b - a) * u;
    let c2_slopes = natural_slopes(x);
    let handle = |i: usize, h_segment: f64| match scheme {
        Scheme::CatmullRom => (x[i + 1] - x[i - 1]) / 6.0,
        Scheme::NaturalC2 => c2_slopes[i] * h_segment / 3.0,
        _ => {
            let (v0, v1) = ((x[i] - x[i - 1]) / h(i - 1), (x[i + 1] - x[i]) / h(i));
            (h(i) * v0 + h(i - 1) * v1) / (h(i - 1) + h(i)) * h_segment / 3.0
        }
    };
    match scheme {
        Scheme::Slerp => lerp(x[i], x[i + 1], u),
        Scheme::Nlerp => {
            let d = x[i + 1] - x[i];
            x[i] + (u * d.sin()).atan2(1.0 - u + u * d.cos())
        }
        Scheme::BSpline => {
            // Mirrored knots, and keys mirrored at the ends.
            let knot = |k: i64| match k {
                k if k < 0 => -UNEVEN[(-k) as usize],
                k if k > 6 => 2.0 * UNEVEN[6] - UNEVEN[(12 - k) as usize],
                k => UNEVEN[k as usize],
            };
            let control = |k: i64| match k {
                -1 => 2.0 * x[0] - x[1],
                7 => 2.0 * x[6] - x[5],
                k => x[k as usize],
            };
            (-1..=7).map(|k| control(k) * cox_de_boor(&knot, k - 2, 3, t.min(UNEVEN[6].next_down()))).sum()
        }
        Scheme::Squad => {
            let control = |i: usize| x[i] - (x[i - 1] + x[i + 1] - 2.0 * x[i]) / 4.0;
            let a0 = if i > 0 { control(i) } else { x[0] + (control(1) - x[1]) / 2.0 };
            let a1 = if i < 5 { control(i + 1) } else { x[6] + (control(5) - x[5]) / 2.0 };
            lerp(lerp(x[i], x[i + 1], u), lerp(a0, a1, u), 2.0 * u * (1.0 - u))
        }
        _ => {
            let (mut b, mut c) = (f64::NAN, f64::NAN);
            if i > 0 {
                b = x[i] + handle(i, h(i));
            }
            if i < 5 {
                c = x[i + 1] - handle(i + 1, h(i));
            }
            if i == 0 {
                b = (x[0] + c) / 2.0;
            }
            if i == 5 {
                c = (b + x[6]) / 2.0;
            }
            let v = 1.0 - u;
            v.powi(3) * x[i] + 3.0 * v * v * u * b + 3.0 * v * u * u * c + u.powi(3) * x[i + 1]
        }
    }
}

#[test]
fn jets_are_the_derivatives() {
    each(|scheme, ends| {
        let keys = closed_keys();
        let motion = Motion::new(&UNEVEN, &keys, scheme, ends);
        for (i, u) in [(0, 0.3), (2, 0.5), (3, 0.001), (5, 0.77)] {
            let piece = motion.piece(i, UNEVEN[i]);
            let h = 1e-5;
            let (before, jet, after) = (piece.at(u - h), piece.at(Jet::variable(u)), piece.at(u + h));
            let numeric = (before.conjugate() * after).log() * (0.5 / h);
            // Truncation h²·|q‴|/6 with third derivatives up to 1e3, rounding eps/h.
            let gap = (jet.half_velocity() - numeric).length();
            assert!(gap < 1e-7, "{} {} {i}: {gap}", scheme.name(), ends.name());
            let velocity = |u: f64| piece.at(Jet::variable(u)).half_velocity();
            let numeric = (velocity(u + h) - velocity(u - h)) * (0.5 / h);
            let gap = (jet.half_acceleration() - numeric).length();
            assert!(gap < 1e-6, "{} {} {i}: {gap}", scheme.name(), ends.name());
        }
    });
}

#[test]
fn long_handles_keep_their_speed() {
    // A second key soon after the first and a third long after: the tangent carries
    // the curve through more than a turn, and C¹ must hold all the same.
    let times = [0.0, 0.01, 3.0, 3.1];
    let keys = [0.0, 0.8, 1.0, 1.5].map(|a| Quat::exp(Vec3::new(0.0, a, 0.1 * a)));
    for scheme in [Scheme::Bessel, Scheme::BesselOverhauser] {
        let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
        for i in 1..3 {
            let (before, after) = velocities(&motion, i);
            assert!((before - after).length() < 1e-12 * before.length().max(1.0));
        }
    }
}

#[test]
fn opposite_neighbours_of_catmull_rom_use_two_logarithms() {
    // q₀⁻¹q₂ = −1 up to rounding: a full turn in two steps about z.
    let keys =
        [0.0, 0.5, 1.0, 1.2].map(|turns: f64| Quat::exp(Vec3::new(0.0, 0.0, turns * std::f64::consts::PI)));
    let motion = Motion::new(&EVEN[..4], &keys, Scheme::CatmullRom, Ends::Natural);
    let (before, after) = velocities(&motion, 1);
    assert!((before - Vec3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2)).length() < 1e-9);
    assert!((before - after).length() < 1e-12);
}

#[test]
fn rates_bound_the_derivatives() {
    let small: Vec<Quat> = keys().iter().map(|q| Quat::exp(q.log() * 0.05)).collect();
    for keys in [keys(), closed_keys(), small] {
        each(|scheme, ends| {
            let motion = Motion::new(&UNEVEN, &keys, scheme, ends);
            for (i, pair) in UNEVEN.windows(2).enumerate() {
                let piece = motion.piece(i, pair[1].next_down());
                let (whole, first_tenth) = (piece.rates(), Rates::within(&piece, Interval::new(0.0, 0.1)));
                for k in 0..=100 {
                    let jet = piece.at(Jet::variable(0.01 * f64::from(k)));
                    let (v, a) = (jet.half_velocity().length(), jet.half_acceleration().length());
                    let name = format!("{} {} segment {i}", scheme.name(), ends.name());
                    // Derivatives by jets round to about 1e-13 of their terms.
                    let holds = |rates: Rates| v <= rates.speed + 1e-12 && a <= rates.acceleration + 1e-12;
                    assert!(holds(whole), "{name}: {v} {a} {whole:?}");
                    assert!(k > 10 || holds(first_tenth), "{name}: {v} {a} {first_tenth:?}");
                }
            }
        });
    }
}

#[test]
fn rates_are_near_the_truth_where_steps_are_small() {
    let keys: Vec<Quat> = keys().iter().map(|q| Quat::exp(q.log() * 0.005)).collect();
    // squad's controls are taken for any two turns.
    for scheme in with_ends().filter(|&scheme| scheme != Scheme::Squad) {
        let motion = Motion::new(&EVEN, &keys, scheme, Ends::Natural);
        for (i, &t) in EVEN[..6].iter().enumerate() {
            let piece = motion.piece(i, t);
            let at = |u: f64| piece.at(Jet::variable(u)).half_acceleration().length();
            let truth = (0..=100).map(|k| at(0.01 * f64::from(k))).fold(0.0, f64::max);
            assert!(piece.rates().acceleration < 1.1 * truth, "{} {i}", scheme.name());
        }
    }
}

#[test]
fn controls_are_the_product_of_exponentials() {
    let controls = keys();
    let motion = Motion::through_controls(&UNEVEN[..3], &controls);
    assert_eq!((motion.ramp(), motion.times()), (None, &UNEVEN[..3]));
    for (i, c) in [&controls[..4], &controls[3..]].into_iter().enumerate() {
        let (start, h) = (UNEVEN[i], UNEVEN[i + 1] - UNEVEN[i]);
        for k in 0..=20 {
            let u = 0.05 * f64::from(k);
            let basis = [1.0 - (1.0 - u).powi(3), 3.0 * u * u - 2.0 * u.powi(3), u.powi(3)];
            let factor = |k: usize| Quat::exp((c[k].conjugate() * c[k + 1]).log() * basis[k]);
            let expected = c[0] * factor(0) * factor(1) * factor(2);
            // A piece's time, and so its u, is rounded; the steps turn by 3 rad in all.
            assert!(distance(motion.at(start + u * h), expected) < 1e-14, "{i} {u}");
        }
    }
}

#[test]
fn controls_are_met_at_the_ends_of_segments_only() {
    let controls = keys();
    let motion = Motion::through_controls(&UNEVEN[..3], &controls);
    for (i, &t) in UNEVEN[..3].iter().enumerate() {
        assert!(distance(motion.at(t), controls[3 * i]) < 1e-15);
    }
    assert_eq!(motion.at(-1.0), controls[0]);
    assert_eq!(motion.at(9.0), controls[6]);
    let nearest =
        |c: Quat| (0..=1000).map(|k| motion.at(1e-3 * f64::from(k)).angle_to(c)).fold(4.0, f64::min);
    assert!([1, 2, 4, 5].into_iter().all(|i| nearest(controls[i]) > 0.02));
}

#[test]
fn controls_say_how_segments_leave_and_arrive() {
    let controls = keys();
    let step = |i: usize| (controls[i].conjugate() * controls[i + 1]).log();
    let motion = Motion::through_controls(&UNEVEN[..3], &controls);
    for i in 0..2 {
        let piece = motion.piece(i, UNEVEN[i]);
        let velocity = |u: f64| piece.at(Jet::variable(u)).half_velocity() * (1.0 / piece.duration());
        let expected = |step: Vec3| step * (3.0 / (UNEVEN[i + 1] - UNEVEN[i]));
        assert!((velocity(0.0) - expected(step(3 * i))).length() < 1e-13);
        assert!((velocity(1.0) - expected(step(3 * i + 2))).length() < 1e-13);
        for k in 0..=100 {
            let (rates, jet) = (piece.rates(), piece.at(Jet::variable(0.01 * f64::from(k))));
            assert!(jet.half_velocity().length() <= rates.speed + 1e-12);
            assert!(jet.half_acceleration().length() <= rates.acceleration + 1e-12);
        }
    }
}

#[test]
fn controls_on_one_axis_are_a_cubic_bezier_of_angles() {
    let angles = [0.0, 0.9, -0.4, 1.1, 1.3, 0.2, 0.5];
    let axis = Vec3::new(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);
    let controls = angles.map(|a| Quat::exp(axis * a));
    let motion = Motion::through_controls(&[1.0, 3.0, 3.5], &controls);
    for (i, start, h) in [(0, 1.0, 2.0), (3, 3.0, 0.5)] {
        for k in 0..=20 {
            let u = 0.05 * f64::from(k);
            let v = 1.0 - u;
            let weights = [v * v * v, 3.0 * v * v * u, 3.0 * v * u * u, u * u * u];
            let angle: f64 = (0..4).map(|k| weights[k] * angles[i + k]).sum();
            assert!(distance(motion.at(start + h * u), Quat::exp(axis * angle)) < 1e-14);
        }
    }
}

#[test]
fn tension_continuity_and_bias_weigh_the_steps() {
    let keys = keys();
    let step = |i: usize| (keys[i].conjugate() * keys[i + 1]).log();
    let at = |tension, continuity, bias| {
        let motion = Motion::new(&EVEN, &keys, Scheme::KochanekBartels, Ends::Natural);
        velocities(&motion.with_tcb(Tcb { tension, continuity, bias }), 3)
    };
    let near = |found: (Vec3, Vec3), arriving: Vec3, leaving: Vec3| {
        (found.0 - arriving).length() < 1e-13 && (found.1 - leaving).length() < 1e-13
    };
    let (before, after, mean) = (step(2), step(3), (step(2) + step(3)) * 0.5);
    assert!(near(at(0.0, 0.0, 0.0), mean, mean));
    assert!(near(at(1.0, 0.3, -0.4), Vec3::ZERO, Vec3::ZERO));
    assert!(near(at(-1.0, 0.0, 0.0), mean * 2.0, mean * 2.0));
    assert!(near(at(0.0, 0.0, 1.0), before, before));
    assert!(near(at(0.0, 0.0, -1.0), after, after));
    assert!(near(at(0.0, -1.0, 0.0), before, after));
    assert!(near(at(0.0, 1.0, 0.0), after, before));
}

#[test]
fn without_tension_continuity_and_bias_it_is_bessel() {
    let keys = closed_keys();
    for ends in Ends::ALL {
        let [a, b] =
            [Scheme::KochanekBartels, Scheme::Bessel].map(|scheme| Motion::new(&UNEVEN, &keys, scheme, ends));
        for i in 0..=100 {
            let t = 0.05 * f64::from(i);
            assert!(distance(a.at(t), b.at(t)) < 1e-14, "{} {t}", ends.name());
        }
    }
}

#[test]
fn barry_goldman_is_the_same_backwards() {
    let keys = keys();
    let back: Vec<Quat> = keys.iter().rev().copied().collect();
    let times: Vec<f64> = UNEVEN.iter().rev().map(|t| 5.0 - t).collect();
    for ends in [Ends::Natural, Ends::Clamped, Ends::Repeat, Ends::Chord] {
        let on = Motion::new(&UNEVEN, &keys, Scheme::BarryGoldman, ends);
        let back = Motion::new(&times, &back, Scheme::BarryGoldman, ends);
        for i in 0..=100 {
            let t = 0.05 * f64::from(i);
            assert!(on.at(t).angle_to(back.at(5.0 - t)) < 1e-12, "{} {t}", ends.name());
        }
    }
}

#[test]
fn held_b_splines_begin_and_end_at_the_keys_that_are_shown() {
    let keys = keys();
    for count in 3..=7 {
        let motion = Motion::new(&UNEVEN[..count], &keys[..count], Scheme::BSpline, Ends::Hold);
        for i in [1, count - 2] {
            assert!(motion.at(UNEVEN[i]).angle_to(keys[i]) < 1e-14, "{i} of {count}");
        }
    }
}

#[test]
fn steps_hold_each_key_until_the_next() {
    assert!(Scheme::Step.is_step() && !Scheme::ALL.iter().any(|scheme| scheme.is_step()));
    let keys = keys();
    for ends in Ends::ALL {
        let motion = Motion::new(&UNEVEN, &keys, Scheme::Step, ends);
        assert_eq!((motion.at(-1.0), motion.at(9.0), motion.ramp()), (keys[0], keys[6], None));
        for (i, &t) in UNEVEN.iter().enumerate() {
            assert_eq!(motion.at(t), keys[i]);
            assert_eq!(motion.at(t.next_down()), keys[i.saturating_sub(1)]);
        }
    }
}

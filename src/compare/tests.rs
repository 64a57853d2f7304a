//! Closed forms, and what must not change when frames and clocks do.

use super::*;
use crate::clip::{Body, Lines};

const UNEVEN: [f64; 6] = [0.0, 0.7, 1.0, 2.2, 2.9, 4.4];
const EVEN: [f64; 6] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5];

/// Those of which more is known than that they are schemes.
const SMOOTH_OR_SLERP: [Scheme; 5] =
    [Scheme::Slerp, Scheme::Squad, Scheme::CatmullRom, Scheme::BesselOverhauser, Scheme::Bessel];

/// A turn about an axis that is none of x, y and z.
fn about(degrees: f64) -> Quat {
    Quat::exp(Vec3::new(0.48, -0.6, 0.64) * (degrees.to_radians() / 2.0))
}

fn turns(degrees: &[f64]) -> Vec<Quat> {
    degrees.iter().map(|&degrees| about(degrees)).collect()
}

/// Keys that turn about changing axes, by up to 140° at a time.
fn keys() -> Vec<Quat> {
    let steps = [[0.0, 0.0, 0.0], [0.4, -0.3, 0.2], [-0.2, 0.9, 0.5], [0.1, 0.1, -1.0], [0.7, 0.9, 0.1]];
    let steps = steps.into_iter().chain([[-0.5, 0.2, 0.1]]);
    let turns = steps.scan(Quat::IDENTITY, |q, [x, y, z]| {
        *q = *q * Quat::exp(Vec3::new(x, y, z));
        Some(*q)
    });
    turns.collect()
}

fn by(scheme: Scheme, times: &[f64], keys: &[Quat]) -> Figures {
    motion(Motion::new(times, keys, scheme, Ends::Natural), keys, false)
}

/// Whether a number is another to so many parts of it.
#[track_caller]
fn assert_near(found: f64, expected: f64, limit: f64) {
    assert!((found - expected).abs() <= limit * expected.abs().max(1.0), "{found} is not {expected}");
}

#[test]
fn a_steady_turn_has_speed_and_nothing_else() {
    for scheme in SMOOTH_OR_SLERP {
        let even_only = scheme.smoothness() == crate::curve::Smoothness::EvenKeys;
        let times = if even_only { EVEN } else { UNEVEN };
        let found = by(scheme, &times, &times.map(|t| about(40.0 * t)));
        // Keys are rounded to 1e-16, which shows as 1e-16 / h in speed and 1e-16 / h² in
        // acceleration, h ≥ 0.3, times the formulas' factors (6, and 57 for degrees).
        assert_near(found.speed.largest.value, 40.0, 1e-12);
        assert_near(found.speed.rms, 40.0, 1e-12);
        let nought = [found.acceleration.largest.value, found.acceleration.rms, found.overshoot.value];
        let jumps = found.jumps;
        let nought = nought.into_iter().chain([found.stray.value, jumps.rotation.value]);
        for x in nought.chain([jumps.velocity.value, jumps.acceleration.value]) {
            assert!(x.abs() < 1e-11, "{}: {found:?}", scheme.name());
        }
        // Steps of 18° at most, or of the tolerance's whole where corners are keys: none.
        let turned = 40.0 * times[times.len() - 1];
        let least = (turned / MAX_STEP).ceil() as usize + 1;
        assert_eq!(found.keys.map(|needed| needed.keys), [Some(least); 3], "{}", scheme.name());
        assert!(found.keys.iter().all(|needed| needed.bytes == Some(20 * least as u64)));
    }
}

#[test]
fn slerp_through_a_zigzag_jumps_by_the_difference_of_its_rates() {
    let (times, keys) = ([0.0, 1.0, 3.0, 3.5], turns(&[0.0, 60.0, 20.0, 100.0]));
    let found = by(Scheme::Slerp, &times, &keys);
    // Rates of 60, −20 and 160 degrees a second.
    assert_near(found.speed.largest.value, 160.0, 1e-12);
    assert!((3.0..=3.5).contains(&found.speed.largest.time));
    let square = 60f64.powi(2) + 2.0 * 20f64.powi(2) + 0.5 * 160f64.powi(2);
    assert_near(found.speed.rms, (square / 3.5).sqrt(), 1e-12);
    assert_near(found.jumps.velocity.value, 180.0, 1e-12);
    assert_eq!(found.jumps.velocity.time, 3.0);
    for x in [found.acceleration.largest.value, found.jumps.acceleration.value, found.overshoot.value] {
        assert!(x.abs() < 1e-11, "{found:?}");
    }
    // Its loop goes on at 60 after 160, but from another rotation.
    let motion_of = Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural);
    let looped = motion(motion_of, &keys, true);
    assert_near(looped.jumps.rotation.value, 100.0, 1e-12);
    assert_eq!((looped.jumps.rotation.time, looped.jumps.velocity.time), (3.5, 3.0));
}

/// A cubic polynomial of an angle over one second, by Bernstein coefficients, degrees.
struct Cubic([f64; 4]);

impl Cubic {
    fn at(&self, u: f64) -> f64 {
        let (v, [a, b, c, d]) = (1.0 - u, self.0);
        a * v * v * v + 3.0 * b * v * v * u + 3.0 * c * v * u * u + d * u * u * u
    }

    /// Coefficients of the derivative, 1, u and u².
    fn derivative(&self) -> [f64; 3] {
        let [a, b, c, d] = self.0;
        [3.0 * (b - a), 6.0 * (a - 2.0 * b + c), 3.0 * (d - 3.0 * c + 3.0 * b - a)]
    }

    /// The derivative's zeros in 0..=1.
    fn turning_points(&self) -> Vec<f64> {
        let [c, b, a] = self.derivative();
        let root = (b * b - 4.0 * a * c).sqrt();
        let zeros = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
        zeros.into_iter().filter(|u| (0.0..=1.0).contains(u)).collect()
    }

    /// Its largest size: at its ends, or where its own derivative is nought.
    fn largest_speed(&self) -> f64 {
        let [c, b, a] = self.derivative();
        let speed = |u: f64| (c + u * (b + u * a)).abs();
        let top = -b / (2.0 * a);
        let inside = if (0.0..=1.0).contains(&top) { speed(top) } else { 0.0 };
        speed(0.0).max(speed(1.0)).max(inside)
    }

    fn mean_square_speed(&self) -> f64 {
        let [c, b, a] = self.derivative();
        c * c + b * c + (b * b + 2.0 * a * c) / 3.0 + a * b / 2.0 + a * a / 5.0
    }

    fn accelerations(&self) -> [f64; 2] {
        let [_, b, a] = self.derivative();
        [b, b + 2.0 * a]
    }
}

#[test]
fn control_rotations_about_one_axis_are_a_cubic_polynomial() {
    for angles in [[0.0, 10.0, 90.0, 40.0], [0.0, -30.0, 60.0, 50.0], [5.0, 95.0, -60.0, 30.0]] {
        let cubic = Cubic(angles);
        let h = 2.0;
        let (times, controls) = ([0.0, h], turns(&angles));
        let keys = [controls[0], controls[3]];
        let found = motion(Motion::through_controls(&times, &controls), &keys, false);
        // Maxima come out to a few units of 1e-16 of the angles' derivatives.
        assert_near(found.speed.largest.value, cubic.largest_speed() / h, 1e-11);
        // Simpson's error of the mean square is step⁴/180 of its fourth derivative, 24 a².
        let [.., a] = cubic.derivative();
        let off = 24.0 * a * a / 64f64.powi(4) / 180.0;
        let square = cubic.mean_square_speed();
        assert_near(found.speed.rms, square.sqrt() / h, 1e-12 + off / square);
        let [first, last] = cubic.accelerations();
        assert_near(found.acceleration.largest.value, first.abs().max(last.abs()) / (h * h), 1e-11);
        // It is linear: the mean of its square is (a² + ab + b²)/3.
        let square = (first * first + first * last + last * last) / 3.0;
        assert_near(found.acceleration.rms, square.sqrt() / (h * h), 1e-11);
        let [low, high] = [angles[0].min(angles[3]), angles[0].max(angles[3])];
        let extremes = cubic.turning_points().into_iter().map(|u| cubic.at(u));
        let beyond = extremes.map(|angle| (low - angle).max(angle - high)).fold(0.0, f64::max);
        assert!(beyond > 1.0, "{angles:?} is no test");
        assert_near(found.overshoot.value, beyond, FOURTH_DIGIT);
        assert_near(found.stray.value, beyond, FOURTH_DIGIT);
        // A parabola's top is off by step² f‴/(6 f″), here less than a twentieth of a step.
        let near = h / 64.0 / 20.0;
        let there = cubic.turning_points().into_iter().any(|u| (h * u - found.overshoot.time).abs() < near);
        assert!(there, "{found:?}");
    }
}

#[test]
fn controls_jump_by_the_difference_of_their_derivatives() {
    let (first, second) = (Cubic([0.0, 20.0, 30.0, 50.0]), Cubic([50.0, 80.0, 60.0, 40.0]));
    let (h, g) = (2.0, 0.5);
    let controls = turns(&[0.0, 20.0, 30.0, 50.0, 80.0, 60.0, 40.0]);
    let times = [0.0, h, h + g];
    let keys = [controls[0], controls[3], controls[6]];
    let jumps = motion(Motion::through_controls(&times, &controls), &keys, false).jumps;
    let [c, b, a] = first.derivative();
    let velocity = second.derivative()[0] / g - (c + b + a) / h;
    let acceleration = second.accelerations()[0] / (g * g) - first.accelerations()[1] / (h * h);
    assert_near(jumps.velocity.value, velocity.abs(), 1e-11);
    assert_near(jumps.acceleration.value, acceleration.abs(), 1e-11);
    assert!(jumps.rotation.value < 1e-12);
    assert_eq!([jumps.velocity.time, jumps.acceleration.time], [h; 2]);
}

#[test]
fn catmull_rom_about_one_axis_jumps_by_its_chord_over_uneven_intervals() {
    let (times, angles) = ([0.0, 1.0, 1.5, 3.5], [0.0, 40.0, 70.0, 150.0]);
    let found = by(Scheme::CatmullRom, &times, &turns(&angles));
    // Half the chord of the neighbours over the interval on either side.
    let jump = |i: usize| {
        let rate = |from: usize| 1.0 / (times[from + 1] - times[from]);
        0.5 * (angles[i + 1] - angles[i - 1]) * (rate(i) - rate(i - 1)).abs()
    };
    assert_near(found.jumps.velocity.value, jump(1).max(jump(2)), 1e-11);
}

#[test]
fn schemes_are_as_smooth_as_they_say() {
    use crate::curve::Smoothness;
    for scheme in SMOOTH_OR_SLERP {
        for (times, even) in [(EVEN, true), (UNEVEN, false)] {
            let found = by(scheme, &times, &keys());
            let smooth = match scheme.smoothness() {
                Smoothness::Corners | Smoothness::Jumps => false,
                Smoothness::EvenKeys => even,
                Smoothness::Always | Smoothness::Twice => true,
            };
            let jump = found.jumps.velocity.value / found.speed.largest.value;
            assert!(if smooth { jump < 1e-12 } else { jump > 0.05 }, "{} {even}: {jump}", scheme.name());
        }
    }
}

/// Half a unit of it.
const FOURTH_DIGIT: f64 = 5e-5;

#[test]
fn figures_agree_with_a_closer_look() {
    for &scheme in Scheme::ALL {
        let keys = keys();
        let curve = Motion::new(&UNEVEN, &keys, scheme, Ends::Natural);
        let found = motion(curve.clone(), &keys, false);
        let mut largest: [f64; 4] = [0.0; 4];
        let mut squares = [0.0; 2];
        for (i, piece) in pieces(&curve).iter().enumerate() {
            let chord = Chord::new(keys[i], keys[i + 1], keys[i]);
            let steps = 4000;
            for step in 0..=steps {
                let values = measures(piece, &chord, f64::from(step) / f64::from(steps));
                for (largest, value) in largest.iter_mut().zip(values) {
                    *largest = largest.max(value);
                }
                // Simpson's rule: weights 1, 4, 2, …, 4, 1 of a third of a step.
                let weight = if step == 0 || step == steps { 1.0 } else { f64::from(2 + 2 * (step % 2)) };
                let weight = weight * piece.duration() / f64::from(3 * steps);
                for (square, value) in squares.iter_mut().zip(values) {
                    *square += weight * value * value;
                }
            }
        }
        let [speed, acceleration, overshoot, stray] = largest;
        let peaks = [found.speed.largest, found.acceleration.largest, found.overshoot, found.stray];
        for (peak, seen) in peaks.iter().zip([speed, acceleration, overshoot, stray]) {
            // What is promised is the fourth digit; above what is seen it is by what 4000 steps
            // miss: the curvature of the top times 1/4000²/8.
            assert!(peak.value >= seen * (1.0 - FOURTH_DIGIT) - 1e-11, "{} {peak:?} {seen}", scheme.name());
            assert!(peak.value <= seen * (1.0 + 1e-5) + 1e-11, "{} {peak:?} {seen}", scheme.name());
        }
        let [speed, acceleration] = squares.map(|square| (square / UNEVEN[5]).sqrt());
        assert_near(found.speed.rms, speed, FOURTH_DIGIT);
        assert_near(found.acceleration.rms, acceleration, FOURTH_DIGIT);
        assert!(found.overshoot.value <= found.stray.value + 1e-12);
    }
}

#[test]
fn counts_are_about_as_estimated() {
    let more: Vec<Quat> = (0..4).flat_map(|_| keys()).collect();
    let long: Vec<f64> = (0..more.len()).map(|i| i as f64 * 0.8 + 0.3 * (i as f64).sin()).collect();
    for &scheme in Scheme::ALL {
        for (times, keys) in [(&UNEVEN[..], &keys()), (&long, &more)] {
            let about = estimated(&Motion::new(times, keys, scheme, Ends::Natural), keys, false).keys;
            let needed = by(scheme, times, keys).keys;
            for (about, needed) in about.iter().zip(needed) {
                assert!(needed.counted && !about.counted && about.tolerance == needed.tolerance);
                // No search finds fewer by more than rounding; how near it gets was measured.
                let ratio = needed.keys.unwrap() as f64 / about.keys.unwrap() as f64;
                assert!((0.99..1.02).contains(&ratio), "{} {needed:?}: {ratio}", scheme.name());
            }
        }
    }
}

#[test]
fn keys_without_end_are_estimated() {
    // Near 10⁸ degrees a second at first, and seconds to slow down in.
    let (times, keys) = ([0.0, 1e-6, 2e-6, 3.0], turns(&[0.0, 100.0, 200.0, 0.0]));
    let found = by(Scheme::Bessel, &times, &keys);
    assert!(found.speed.largest.value > 1e6);
    let many = |needed: &KeysNeeded| !needed.counted && needed.keys.is_some_and(|keys| keys > 1_000_000);
    assert!(found.keys.iter().all(many), "{found:?}");
    assert!(by(Scheme::Slerp, &times, &keys).keys.iter().all(|needed| needed.counted));
}

#[test]
fn keys_are_counted_as_long_as_there_are_few() {
    let row = |counts: [usize; 3]| {
        let keys =
            counts.map(|keys| KeysNeeded { tolerance: 0.1, keys: Some(keys), bytes: None, counted: false });
        [keys[0], keys[1], keys[2]]
    };
    let counted = |rows: &[[KeysNeeded; 3]]| keys::affordable(rows);
    let half = MOST_KEYS / 2;
    assert_eq!(counted(&[row([10, 20, half])]), [true; 3]);
    assert_eq!(counted(&[row([10, half, half])]), [true, true, false]);
    assert_eq!(counted(&[row([10, 20, half]), row([10, 20, half])]), [true, true, false]);
    assert_eq!(counted(&vec![row([1, 1, 1]); MOST_KEYS + 1]), [false; 3]);
    // What takes too many by itself does not keep the others from being counted.
    let (endless, mut unknown) = (row([MOST_KEYS + 1; 3]), row([0; 3]));
    unknown.iter_mut().for_each(|needed| needed.keys = None);
    assert_eq!(counted(&[endless, row([1, 2, 3]), unknown]), [true; 3]);
    let mut rows = [endless, row([1, 2, 3]), unknown];
    let motion_keys = keys();
    for needed in &mut rows {
        keys::count(needed, [true, true, false], || {
            Motion::new(&UNEVEN, &motion_keys, Scheme::Slerp, Ends::Natural)
        });
    }
    let counted = rows.map(|needed| needed.map(|needed| needed.counted));
    assert_eq!(counted, [[false; 3], [true, true, false], [false; 3]]);
}

/// All figures that are not counts, times left out.
fn numbers(figures: &Figures) -> [f64; 9] {
    let Figures { speed, acceleration, jumps, overshoot, stray, .. } = figures;
    [
        speed.largest.value,
        speed.rms,
        jumps.velocity.value,
        acceleration.largest.value,
        acceleration.rms,
        jumps.acceleration.value,
        overshoot.value,
        stray.value,
        jumps.rotation.value,
    ]
}

#[test]
fn frames_do_not_matter() {
    let (left, right) = (Quat::exp(Vec3::new(0.3, -0.8, 0.4)), Quat::exp(Vec3::new(-1.0, 0.2, 0.9)));
    let turned: Vec<Quat> = keys().into_iter().map(|key| left * key * right).collect();
    for &scheme in Scheme::ALL {
        let (found, other) = (by(scheme, &UNEVEN, &keys()), by(scheme, &UNEVEN, &turned));
        for (a, b) in numbers(&found).into_iter().zip(numbers(&other)) {
            // Products of keys are rounded to 1e-16; intervals of 0.3 s and the squad's
            // logarithms make it 1e-12 of an acceleration.
            assert_near(b, a, 1e-11);
        }
    }
}

#[test]
fn speeds_and_accelerations_follow_the_clock() {
    // A power of two, so that float32 times are the same times.
    let slower = UNEVEN.map(|t| 4.0 * t);
    for &scheme in Scheme::ALL {
        let (found, slow) = (by(scheme, &UNEVEN, &keys()), by(scheme, &slower, &keys()));
        let factors = [4.0, 4.0, 4.0, 16.0, 16.0, 16.0, 1.0, 1.0, 1.0];
        for ((a, b), factor) in numbers(&found).into_iter().zip(numbers(&slow)).zip(factors) {
            assert_near(factor * b, a, 1e-11);
        }
        assert_near(slow.speed.largest.time, 4.0 * found.speed.largest.time, 1e-6);
        assert_eq!(slow.keys, found.keys);
    }
}

#[test]
fn a_finer_tolerance_needs_more_keys() {
    for scheme in SMOOTH_OR_SLERP {
        let counts = by(scheme, &UNEVEN, &keys()).keys.map(|needed| needed.keys.unwrap());
        // Errors of a curve's chords fall with the square of the step: √10 times as many
        // keys for a tenth, fewer where the largest step rules; slerp needs no more.
        let most = if scheme == Scheme::Slerp { 1.0 } else { 3.4 };
        for pair in counts.windows(2) {
            let ratio = pair[1] as f64 / pair[0] as f64;
            assert!((1.0..=most).contains(&ratio), "{}: {counts:?}", scheme.name());
        }
    }
}

#[test]
fn a_jump_that_is_held_is_no_speed() {
    let (times, keys) = ([0.0, 1.0, 2.0, 4.0], turns(&[0.0, 50.0, 80.0, 0.0]));
    let found = motion(Motion::new(&times, &keys, Scheme::CatmullRom, Ends::Hold), &keys, false);
    assert_near(found.jumps.rotation.value, 50.0, 1e-12);
    assert_eq!(found.jumps.rotation.time, 1.0);
    // One segment moves: from 50° to 80°, with the chords 80° and −50°.
    assert!(found.speed.largest.value < 100.0 && found.speed.largest.value > 30.0);
    assert!((1.0..=2.0).contains(&found.speed.largest.time));
}

#[test]
fn closed_ends_meet() {
    let mut keys = keys();
    // Off by 0.1°, which closing takes away.
    keys[5] = (about(0.1) * keys[0]).aligned_to(keys[4]);
    for scheme in SMOOTH_OR_SLERP {
        let found = motion(Motion::new(&EVEN, &keys, scheme, Ends::Closed), &keys, true);
        if scheme == Scheme::Slerp {
            assert_near(found.jumps.rotation.value, 0.1, 1e-12);
        } else {
            assert!(found.jumps.rotation.value < 1e-12, "{}", scheme.name());
            assert!(found.jumps.velocity.value < 1e-11 * found.speed.largest.value, "{}", scheme.name());
        }
    }
}

fn chain(tracks: Vec<Vec<Quat>>, through: Through) -> Clip {
    let times = UNEVEN[..through.times(tracks[0].len())].to_vec();
    let mut lines = Lines::default();
    tracks[0].iter().enumerate().for_each(|(i, _)| lines.push(i + 2));
    Clip { body: Body::Chain { length: 1.0 }, start: 3.0, times, tracks, through, lines }
}

#[test]
fn a_clip_is_its_boxes_by_schemes() {
    let other: Vec<Quat> = keys().into_iter().rev().collect();
    let two = chain(vec![keys(), other.clone()], Through::Keys);
    let schemes = [Scheme::Bessel, Scheme::Slerp];
    let all = clip(&two, &schemes, Ends::Natural, None).unwrap();
    assert_eq!(all.iter().map(|figures| figures.index).collect::<Vec<_>>(), [1, 2]);
    let names: Vec<_> = all[0].methods.iter().map(|method| method.scheme).collect();
    assert_eq!(names, [Some("bessel"), Some("slerp")]);
    assert_eq!(all[1].methods[0].figures, by(Scheme::Bessel, &UNEVEN, &other));
    assert_eq!(clip(&two, &schemes, Ends::Natural, Some(1)).unwrap(), all[1..]);
    assert!(clip(&two, &schemes, Ends::Closed, None).is_err());
    assert!(clip(&two, &[Scheme::Slerp], Ends::Closed, None).is_ok());
}

#[test]
fn control_rotations_need_no_scheme() {
    let controls: Vec<Quat> = (0..7).map(|i| about(f64::from(i * i))).collect();
    let curve = chain(vec![controls.clone()], Through::Controls);
    let found = clip(&curve, Scheme::ALL, Ends::Closed, None).unwrap();
    let [Method { scheme: None, figures }] = &found[0].methods[..] else { panic!("{found:?}") };
    // About one axis, from control to control: 3 times the step over the interval.
    let rates = [(0, 0), (1, 2), (2, 3), (3, 5)].map(|(segment, step)| {
        let h = if segment < 2 { UNEVEN[1] } else { UNEVEN[2] - UNEVEN[1] };
        3.0 * f64::from(2 * step + 1) / h
    });
    assert_near(figures.speed.largest.value, rates[3], 1e-11);
    assert_near(figures.jumps.velocity.value, rates[2] - rates[1], 1e-11);
    assert!(figures.overshoot.value < 1e-12);
}

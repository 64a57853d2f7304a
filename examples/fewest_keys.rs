//! Prints how many keys clips need: `cargo run --release --example fewest_keys`.
//!
//! Even and uneven clips of four boxes with 25 keys over 20 s. For each tolerance: the
//! keys on the curve, off it, the share of these two, the proven bound and the largest
//! deviation that many probes find, both over the tolerance; and for the first box how
//! many intervals on the curve are the fewest there are, by dynamic programming over a fine
//! grid of times, beside how many were found. Last the keys of CUBICSPLINE playback, at most 90°
//! apart, with its own bound over the tolerance.

use dat2glb::curve::{Ends, Motion, Scheme};
use dat2glb::math::{Quat, Vec3};
use dat2glb::reduce::{self, Curve, Keys, Options, Turning};
use glam::DQuat;
use std::time::Instant;

/// Key times of a clip, and one box's keys with steps up to 150°.
fn clip(even: bool, seed: u64) -> (Vec<f64>, Vec<Quat>) {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let intervals: Vec<f64> = (1..25).map(|_| if even { 1.0 } else { 0.3 + 1.4 * random() }).collect();
    let whole: f64 = intervals.iter().sum();
    let after = intervals.iter().scan(0.0, |t, h| {
        *t += h * 20.0 / whole;
        Some(*t)
    });
    let times = [0.0].into_iter().chain(after).collect();
    let keys = (0..25).scan(Quat::IDENTITY, |q, _| {
        let axis = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5);
        *q = *q * Quat::exp(axis * (random() * 75f64.to_radians() / axis.length()));
        Some(*q)
    });
    (times, keys.collect())
}

fn glam(q: [f32; 4]) -> DQuat {
    DQuat::from_array(q.map(f64::from)).normalize()
}

/// The largest deviation at many times, degrees.
fn measured(motion: &Motion, keys: &Keys<4>) -> f64 {
    let mut worst: f64 = 0.0;
    for (t, q) in keys.times.windows(2).zip(keys.values.windows(2)) {
        let (a, b) = (glam(q[0]), glam(q[1]));
        for i in 0..=64 {
            let u = f64::from(i) / 64.0;
            let time = f64::from(t[0]) + u * (f64::from(t[1]) - f64::from(t[0]));
            worst = worst.max(Quat::from(a.slerp(b, u)).angle_to(motion.at(time)));
        }
    }
    worst.to_degrees()
}

/// The fewest intervals on the curve between two times, with times on a grid of `count`:
/// the fewest up to each time, from those of all times before it that reach it.
fn optimum(motion: &Motion, (from, to): (f64, f64), count: usize, tolerance: f64) -> usize {
    let at: Vec<DQuat> =
        (0..count).map(|i| motion.at(from + (to - from) * i as f64 / (count - 1) as f64).into()).collect();
    let limit = (tolerance.to_radians() / 4.0).sin().powi(2) * 4.0;
    let serves = |i: usize, j: usize| {
        let middle = (i + j) / 2;
        let near = |k: usize| {
            let played = at[i].slerp(at[j], (k - i) as f64 / (j - i) as f64);
            let other = if played.dot(at[k]) < 0.0 { -at[k] } else { at[k] };
            (played - other).length_squared() <= limit
        };
        near(middle) && (i + 1..j).all(near)
    };
    let mut fewest = vec![usize::MAX; count];
    fewest[0] = 0;
    for i in 0..count - 1 {
        let mut served = i + 1;
        let mut j = i + 1;
        while j < count && j - i <= 8 + 3 * (served - i) / 2 {
            if serves(i, j) {
                served = j;
                fewest[j] = fewest[j].min(fewest[i] + 1);
            }
            j += 1;
        }
    }
    fewest[count - 1]
}

fn main() {
    println!(
        "| Scheme | Keys | Tolerance | On the curve | Off it | Share | Bound | Measured | Optimum | Found | Cubics | Bound |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for (scheme, even) in [("bessel", true), ("bessel", false), ("squad", true), ("catmull-rom", false)] {
        let scheme = Scheme::from_name(scheme).unwrap_or(Scheme::Bessel);
        for tolerance in [0.1, 0.01, 0.001] {
            row(scheme, even, tolerance);
        }
    }
}

fn row(scheme: Scheme, even: bool, tolerance: f64) {
    let (mut on, mut off, mut seconds, mut bound, mut worst) = (0, 0, 0.0, 0.0f64, 0.0f64);
    let (mut cubics, mut cubic_bound) = (0, 0.0f64);
    let mut nearest = String::from(" | ");
    for seed in 1..=4 {
        let (times, keys) = clip(even, seed);
        let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
        let curve = Turning::new(motion.clone());
        let options = Options::new(tolerance);
        let on_curve = reduce::rotation(&curve, &Options { on_curve: true, ..options }).expect("usable");
        let start = Instant::now();
        let off_curve = reduce::rotation(&curve, &options).expect("usable");
        seconds += start.elapsed().as_secs_f64();
        let cubic = Options { max_step: Some(90.0), ..options };
        let cubic = reduce::cubic_rotation(&curve, &cubic).expect("usable");
        cubics += cubic.times.len();
        cubic_bound = cubic_bound.max(cubic.facts.deviation / tolerance);
        on += on_curve.times.len();
        off += off_curve.times.len();
        for keys in [&on_curve, &off_curve] {
            bound = bound.max(keys.facts.deviation / tolerance);
            worst = worst.max(measured(&motion, keys) / tolerance);
        }
        if seed == 1 && tolerance > 0.005 {
            // Corners are kept: each stretch between two has its own optimum.
            let stops: Vec<f64> =
                [0.0].into_iter().chain(curve.corners().iter().copied()).chain([20.0]).collect();
            let grid = 40 * on_curve.times.len() / (stops.len() - 1);
            let best = stops.windows(2).map(|pair| optimum(&motion, (pair[0], pair[1]), grid, tolerance));
            nearest = format!("{} | {}", best.sum::<usize>(), on_curve.times.len() - 1);
        }
    }
    let share = off as f64 / on as f64;
    let even = if even { "even" } else { "uneven" };
    println!(
        "| {} | {even} | {tolerance}° | {on} | {off} | {share:.3} | {bound:.4} | {worst:.4} | {nearest} | {cubics} | {cubic_bound:.4} |",
        scheme.name()
    );
    eprintln!("{seconds:.2} s for those off the curve");
}

//! Playback of what comes out beside playback of what went in, at many times.

use super::*;
use crate::math::{Quat, Vec3};
use crate::reduce::value::{Numbers, Step, Value};
use std::f64::consts::PI;

const HALF_DEGREE: f64 = PI / 360.0;

/// Playback as glTF has it, by another formula than the one under test: the product of
/// one key with a power of the turn to the next.
fn played<V: Near<Stored = [f32; N]>, const N: usize>(times: &[f32], keys: &[[f32; N]], t: f64) -> V {
    let after = times.partition_point(|&time| f64::from(time) <= t).clamp(1, times.len() - 1);
    let (from, to) = (f64::from(times[after - 1]), f64::from(times[after]));
    V::read(keys[after - 1]).played(V::read(keys[after]), (t - from) / (to - from))
}

/// The largest distance at all keys of both, at 30 Hz to 10 kHz and near the ends of
/// intervals.
fn measured<V: Near<Stored = [f32; N]>, const N: usize>(
    (times, keys): (&[f32], &[[f32; N]]),
    fewer: &Fewer<N>,
) -> f64 {
    let mut looks: Vec<f64> = times.iter().chain(&fewer.times).map(|&t| f64::from(t)).collect();
    let (first, last) = (f64::from(times[0]), f64::from(times[times.len() - 1]));
    for rate in [30.0, 59.94, 144.0, 1000.0, 10_000.0] {
        let count = (((last - first) * rate) as usize).min(8_000);
        looks.extend((0..count).map(|i| first + i as f64 / rate));
    }
    for pair in fewer.times.windows(2) {
        let (a, b) = (f64::from(pair[0]), f64::from(pair[1]));
        looks.extend([1e-6, 0.25, 0.5, 0.77, 1.0 - 1e-6].map(|u| a + u * (b - a)));
    }
    let at = |&t: &f64| played::<V, N>(times, keys, t).distance(played(&fewer.times, &fewer.values, t));
    looks.iter().map(at).fold(0.0, f64::max)
}

/// Times at about a rate, from a tenth of a step to nearly two apart.
fn times(count: usize, rate: f64) -> Vec<f32> {
    let uneven = |i: usize| (i as f64 * 0.618_033_988_749_894_9).fract() * 0.9;
    (0..count).map(|i| ((i as f64 + uneven(i)) / rate) as f32).collect()
}

fn keys(times: &[f32], at: impl Fn(f64) -> Quat) -> Vec<[f32; 4]> {
    times.iter().map(|&t| at(f64::from(t)).to_xyzw().map(|x| x as f32)).collect()
}

fn swing(t: f64) -> Quat {
    let part = |rate: f64, phase: f64| (2.0 * PI * (rate * t + phase)).sin();
    Quat::exp(Vec3::new(0.8 * part(0.31, 0.1), 0.5 * part(0.53, 0.2), 0.7 * part(0.23, 0.3)))
}

/// Numbers from −1 to 1 without a pattern.
fn noise(i: usize) -> f64 {
    let hash = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((hash ^ (hash >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Reduces rotations and checks all that holds for any result; the number of keys.
fn checked(name: &str, times: &[f32], keys: &[[f32; 4]], degrees: f64, step: f64, ends: Ends) -> usize {
    let asked = Asked { tolerance: degrees * HALF_DEGREE, step: step * HALF_DEGREE, ends };
    let found = fewer::<Quat, 4>(times, keys, asked).unwrap_or_else(|| panic!("{name}: none"));
    let what = format!("{name} {degrees}° {step}° {ends:?}: {} of {}", found.times.len(), times.len());
    let ends_of = |times: &[f32]| (times[0], times[times.len() - 1]);
    assert!(found.times.is_sorted_by(|a, b| a < b) && ends_of(&found.times) == ends_of(times), "{what}");
    let worst = measured::<Quat, 4>((times, keys), &found);
    assert!(found.deviation <= asked.tolerance, "{what}: bound {}", found.deviation / HALF_DEGREE);
    assert!(
        worst <= found.deviation + 1e-12,
        "{what}: {} {}",
        worst / HALF_DEGREE,
        found.deviation / HALF_DEGREE
    );
    for (value, next) in found.values.iter().zip(&found.values[1..]) {
        let way = Quat::read(*value).distance(Quat::read(*next));
        assert!(ends == Ends::Own || way <= asked.step * 1.0001, "{what}: {}", way / HALF_DEGREE);
    }
    if ends == Ends::Own {
        let own = |(time, value): (&f32, &[f32; 4])| {
            let at = times.partition_point(|t| t < time);
            times[at] == *time && (keys[at] == *value || keys[at].map(|x| -x) == *value)
        };
        assert!(found.times.iter().zip(&found.values).all(own), "{what}");
    }
    if ends == Ends::OnCurve {
        let off = |(&time, &value): (&f32, &[f32; 4])| {
            played::<Quat, 4>(times, keys, f64::from(time)).distance(Quat::read(value))
        };
        let worst = found.times.iter().zip(&found.values).map(off).fold(0.0, f64::max);
        assert!(worst < 1e-7, "{what}: {worst}");
    }
    found.times.len()
}

const ALL: [Ends; 3] = [Ends::Free, Ends::OnCurve, Ends::Own];

#[test]
fn playback_keeps_the_bound_at_all_rates() {
    for rate in [30.0, 60.0, 1000.0, 10_000.0] {
        let times = times(3000, rate);
        let keys = keys(&times, swing);
        for degrees in [0.01, 0.1, 1.0] {
            for ends in ALL {
                checked("swing", &times, &keys, degrees, f64::INFINITY, ends);
                checked("swing", &times, &keys, degrees, 18.0, ends);
            }
        }
        checked("swing", &times, &keys, 1e-4, f64::INFINITY, Ends::Free);
        checked("swing", &times, &keys, 40.0, f64::INFINITY, Ends::Free);
    }
}

#[test]
fn noise_and_rest_keep_the_bound() {
    let times = times(4000, 120.0);
    let shaken = |size: f64| {
        let shake = |t: f64| {
            let i = (t * 120.0) as usize;
            Quat::exp(Vec3::new(noise(i), noise(i + 7777), noise(i + 99_999)) * size)
        };
        keys(&times, |t| swing(0.05 * t) * shake(t))
    };
    for size in [1e-7, 3e-5, 1e-3, 0.1] {
        for ends in ALL {
            checked("noise", &times, &shaken(size), 0.05, f64::INFINITY, ends);
        }
    }
    let still = keys(&times, |_| swing(1.0));
    assert_eq!(checked("rest", &times, &still, 2e-4, f64::INFINITY, Ends::Free), 2);
}

#[test]
fn signs_and_large_steps_stay_what_they_are() {
    let times = times(900, 60.0);
    let mut turned = keys(&times, swing);
    for (i, key) in turned.iter_mut().enumerate() {
        if i % 3 == 0 || i % 7 < 2 {
            *key = key.map(|x| -x);
        }
    }
    // Half turns about several axes, exact ones and those that are nearly, and 100°.
    let axes = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [1e-8, 0.0, 1.0, 0.0]];
    let jumps: Vec<[f32; 4]> = (0..900)
        .map(|i| match i % 9 {
            0..4 => axes[i % 4],
            4 => [0.766_044_4, 0.0, 0.0, 0.642_787_6],
            _ => turned[i],
        })
        .collect();
    for ends in ALL {
        for degrees in [0.01, 0.5] {
            checked("signs", &times, &turned, degrees, f64::INFINITY, ends);
            checked("jumps", &times, &jumps, degrees, f64::INFINITY, ends);
        }
        checked("signs", &times, &turned, 0.1, 5.0, ends);
    }
    for ends in [Ends::Free, Ends::OnCurve] {
        // Half a turn in parts could go either way round.
        let asked = Asked { tolerance: 0.1 * HALF_DEGREE, step: 5.0 * HALF_DEGREE, ends };
        assert!(fewer::<Quat, 4>(&times, &jumps, asked).is_none());
    }
}

#[test]
fn lengths_that_differ_from_one_are_seen() {
    let times = times(2000, 60.0);
    let coded = |top: f32| -> Vec<[f32; 4]> {
        keys(&times, swing).into_iter().map(|key| key.map(|x| (x * top).round() / top)).collect()
    };
    // Playback of uneven lengths is not at constant speed: blended as a player does.
    let blended = |keys: &[[f32; 4]], times: &[f32], t: f64| {
        let after = times.partition_point(|&time| f64::from(time) <= t).clamp(1, times.len() - 1);
        let (from, to) = (f64::from(times[after - 1]), f64::from(times[after]));
        let four = |key: [f32; 4]| key.map(f64::from);
        let blend = crate::asset::play::slerp;
        let q = Quat::from_xyzw(blend(four(keys[after - 1]), four(keys[after]), (t - from) / (to - from)));
        Quat { w: q.w / q.norm(), v: q.v * (1.0 / q.norm()) }
    };
    for (top, degrees) in [(32767.0, 0.1), (2000.0, 0.5)] {
        let keys = coded(top);
        for ends in ALL {
            let asked = Asked { tolerance: degrees * HALF_DEGREE, step: f64::INFINITY, ends };
            let found = fewer::<Quat, 4>(&times, &keys, asked).unwrap();
            assert!(found.times.len() < 1500, "{top} {ends:?}: {}", found.times.len());
            for i in 0..20_000 {
                let t = f64::from(times[1999]) * f64::from(i) / 20_000.0;
                let off = blended(&keys, &times, t).distance(blended(&found.values, &found.times, t));
                assert!(off <= found.deviation + 1e-10, "{top} {ends:?} {t}: {off} {}", found.deviation);
            }
        }
    }
    let coarse = Asked { tolerance: 0.01 * HALF_DEGREE, step: f64::INFINITY, ends: Ends::Free };
    assert!(fewer::<Quat, 4>(&times, &coded(127.0), coarse).is_none());
}

#[test]
fn stretches_join_and_do_not_depend_on_threads() {
    let times = times(3 * STRETCH + 17, 60.0);
    let mut keys = keys(&times, |t| swing(0.2 * t));
    keys.iter_mut().skip(STRETCH - 5).take(STRETCH).for_each(|key| *key = key.map(|x| -x));
    let asked = Asked { tolerance: 0.02 * HALF_DEGREE, step: f64::INFINITY, ends: Ends::Free };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fewer::<Quat, 4>(&times, &keys, asked).unwrap())
    };
    let (one, three) = (on(1), on(3));
    assert_eq!((&one.times, &one.values), (&three.times, &three.values));
    assert!(one.times.len() < times.len() / 2);
    let joint = |pair: &[[f32; 4]]| pair[0].iter().zip(pair[1]).map(|(a, b)| a * b).sum::<f32>();
    assert!(one.values.windows(2).all(|pair| joint(pair) > 0.0));
    assert!(measured::<Quat, 4>((&times, &keys), &one) <= one.deviation + 1e-12);
}

#[test]
fn what_saves_little_stays() {
    let times = times(STRETCH + 1, 60.0);
    let keys = keys(&times, |t| {
        let i = (t * 60.0) as usize;
        Quat::exp(Vec3::new(noise(i), noise(i + 77_777), noise(i + 999_999)) * 0.05)
    });
    let asked = Asked { tolerance: 0.01 * HALF_DEGREE, step: f64::INFINITY, ends: Ends::Free };
    let found = fewer::<Quat, 4>(&times, &keys, asked).unwrap();
    checked("short steps", &times, &keys, 0.01, 3.0, Ends::Free);
    assert_eq!((found.times, found.values, found.deviation), (times, keys, 0.0));
}

#[test]
fn numbers_are_walked_too() {
    let times = times(5000, 240.0);
    let place = |t: f64| [(3.0 * t).sin(), (2.0 * t).cos() + 0.1 * t, 5.0].map(|x| x as f32);
    let keys: Vec<[f32; 3]> = times.iter().map(|&t| place(f64::from(t))).collect();
    for tolerance in [1e-5, 1e-3, 0.1] {
        for ends in ALL {
            let asked = Asked { tolerance, step: f64::INFINITY, ends };
            let found = fewer::<Numbers<3>, 3>(&times, &keys, asked).unwrap();
            let worst = measured::<Numbers<3>, 3>((&times, &keys), &found);
            assert!(worst <= found.deviation + 1e-12 && found.deviation <= tolerance, "{tolerance} {ends:?}");
            // 1e-5 is less than what a key in the middle of two is off their chord.
            assert!(
                found.times.len() < 4000 || tolerance < 2e-5,
                "{tolerance} {ends:?}: {}",
                found.times.len()
            );
        }
    }
}

/// Sides of a polygon outside a parabola and inside of it: 1/√2 of the keys on it.
#[test]
fn a_bend_takes_as_few_keys_as_it_must() {
    let times: Vec<f32> = (0..=16_000).map(|i| i as f32 / 1000.0).collect();
    let keys: Vec<[f32; 1]> = times.iter().map(|&t| [0.5 * t * t]).collect();
    let count = |ends| {
        let asked = Asked { tolerance: 1e-3, step: f64::INFINITY, ends };
        fewer::<Numbers<1>, 1>(&times, &keys, asked).unwrap().times.len() as f64
    };
    let (on, off) = (16.0 / (8e-3f64).sqrt(), 16.0 / (16e-3f64).sqrt());
    assert!(count(Ends::OnCurve) <= 1.01 * on + 2.0, "{} {on}", count(Ends::OnCurve));
    assert!(count(Ends::Free) <= 1.01 * off + 2.0, "{} {off}", count(Ends::Free));
    assert!(count(Ends::Own) <= 1.03 * on + 2.0, "{} {on}", count(Ends::Own));
}

#[test]
fn near_steps_are_steps() {
    for i in 0..4000 {
        let axis = Vec3::new(noise(i), noise(i + 5000), noise(i + 10_000));
        let axis = axis * (1.0 / axis.length());
        let angle = 10f64.powf(-9.0 + 9.19 * (i as f64 / 4000.0));
        let (a, way) = (swing(i as f64), axis * angle.min(1.5));
        let b = a.moved(way);
        for b in [b, -b] {
            assert!((a.near_step_to(b) - way).length() < 1e-11 * way.length() + 1e-15, "{angle}");
        }
        let moved = a.near_moved(way);
        assert!(moved.distance(b) < 1e-14 && (moved.norm() - 1.0).abs() < 1e-13, "{angle}");
        let apart = a.apart_squared(b).sqrt() / way.length();
        assert!((1.0 - 1e-6..1.112).contains(&apart) || angle < 1e-6, "{angle}: {apart}");
    }
}

#[test]
fn balls_that_meet() {
    use super::ball::Ball;
    let ball = |x: f64, y: f64, radius: f64| Ball { centre: Numbers([x, y]), radius };
    for i in 0..2000 {
        let (a, b) = (
            ball(noise(i), noise(i + 3000), 0.8),
            ball(noise(i + 6000), noise(i + 9000), 0.3 + noise(i).abs()),
        );
        let apart = (a.centre - b.centre).length();
        let Some(both) = a.meet(b) else {
            assert!(apart > a.radius + b.radius);
            continue;
        };
        for k in 0..16 {
            let (sin, cos) = (f64::from(k) * PI / 8.0).sin_cos();
            let rim = both.centre + Numbers([cos, sin]) * (both.radius * (1.0 - 1e-9));
            assert!(a.holds(rim) && b.holds(rim));
        }
        let thick = (a.radius + b.radius - apart).min(2.0 * a.radius.min(b.radius));
        assert!((2.0 * both.radius - thick).abs() < 1e-12);
    }
}

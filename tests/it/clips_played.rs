//! Clips made up at random, hostile ones among them, played by glam's slerp: the file is
//! sound, meets the keys, and is no further off than it says.

use crate::support::made::{Asked, Channel, inputs, made};
use dat2glb::check::Severity;
use dat2glb::convert::Sampling;
use dat2glb::curve::{Ends, Motion, Scheme, Tcb};
use dat2glb::math::Quat;
use dat2glb::moves::Shape;
use dat2glb::sample::Writing;
use glam::DQuat;
use gltf::animation::Interpolation;
use proptest::prelude::*;
use std::fmt::Write as _;

/// Time to the next key, seconds, and a quaternion.
type Row = (f64, [f64; 4]);

fn rows() -> impl Strategy<Value = Vec<Row>> {
    let any = prop::array::uniform4(-1.0..1.0f64).prop_filter("too short", |q| norm(*q) > 0.1);
    let axes = prop::sample::select(vec![
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, -1.0],
    ]);
    let near = (-1.0..1.0f64, -12..-2i32).prop_map(|(x, e)| [1.0, x * 10f64.powi(e), 0.0, 1e-9]);
    let quaternion = prop_oneof![4 => any, 2 => axes, 2 => near];
    let gap = prop_oneof![4 => 0.05..1.5f64, 2 => 1e-6..1e-3f64, 2 => Just(0.25), 1 => 5.0..20.0f64];
    prop::collection::vec((gap, quaternion), 2..=10)
}

fn norm(q: [f64; 4]) -> f64 {
    q.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn text(rows: &[Row], loops: bool) -> String {
    let (mut text, mut time) = ("# 1 2\n".to_owned(), 0.0);
    for (i, (gap, q)) in rows.iter().enumerate() {
        let [w, x, y, z] = if loops && i + 1 == rows.len() { rows[0].1 } else { *q };
        writeln!(text, "{time} {w} {x} {y} {z}").unwrap();
        time += gap;
    }
    text
}

fn glams([x, y, z, w]: [f64; 4]) -> DQuat {
    DQuat::from_xyzw(x, y, z, w).normalize()
}

/// Degrees between two rotations: twice the angle between the quaternions, by halves of
/// sum and difference, which is exact for small angles too.
fn degrees(a: DQuat, b: DQuat) -> f64 {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    4.0 * (a - b).length().atan2((a + b).length()).to_degrees()
}

/// Where LINEAR playback is at a time; none where keys are half a turn apart, between which
/// players choose one way or the other by the last digit.
fn played(channel: &Channel, all: &[[f32; 4]], t: f64) -> Option<DQuat> {
    let after = channel.times.partition_point(|&key| f64::from(key) <= t);
    let [a, b] = [after.saturating_sub(1), after.min(all.len() - 1)];
    let [t0, t1] = [a, b].map(|i| f64::from(channel.times[i]));
    let [a, b] = [a, b].map(|i| glams(all[i].map(f64::from)));
    let u = if t1 > t0 { ((t - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
    (a.dot(b).abs() > 1e-5).then(|| a.slerp(b, u))
}

/// Many times of a clip: within every interval of a file, and at keys.
fn moments(channel: &Channel, keys: &[f64]) -> Vec<f64> {
    let end = f64::from(channel.times[channel.times.len() - 1]);
    let within = channel.times.windows(2).flat_map(|pair| {
        let [a, b] = [pair[0], pair[1]].map(f64::from);
        [0.0, 0.21, 0.5, 0.79].map(|u| a + (b - a) * u)
    });
    within.chain(keys.iter().copied()).chain([end]).filter(|&t| t <= end).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn any_clip_is_sound_meets_its_keys_and_keeps_its_bound(
        rows in rows(),
        loops in any::<bool>(),
        scheme in prop::sample::select(Scheme::EVERY.to_vec()),
        ends in prop::sample::select(Ends::ALL.to_vec()),
        tcb in prop::array::uniform3(-1.0..1.0f64),
        fps in prop::sample::select(vec!["60", "24", "7.5", "1", "30000/1001", "120"]),
        key_times in any::<bool>(),
    ) {
        let inputs = inputs(&text(&rows, loops)).unwrap();
        let clip = &inputs.keyframes.as_ref().unwrap().clip;
        let ends = if ends.accept(clip).is_ok() { ends } else { Ends::Natural };
        let [tension, continuity, bias] = tcb;
        let tcb = Tcb { tension, continuity, bias };
        let asked = Asked {
            scheme,
            shape: Shape { ends, tcb, ..Shape::default() },
            sampling: Sampling::Rate { fps: fps.parse().unwrap(), key_times },
            writing: Writing::default(),
        };
        let made = match made(&inputs, asked) {
            Ok(made) => made,
            Err(message) => {
                // Keys a microsecond apart fall together in float32 after some seconds.
                prop_assert!(message.contains("float32"), "{}", message);
                return Ok(());
            }
        };
        let report = made.report();
        prop_assert!(report.worst() < Some(Severity::Error), "{}", report.text("made.glb"));

        let motion = Motion::new(&clip.times, &clip.tracks[0], scheme, ends).with_tcb(tcb);
        let curve = |t: f64| glams(motion.at(t).to_xyzw());
        let channel = &made.channels()[0];
        // Under `hold` the last segment rests at its first key; `closed` ends at the first key
        // of all, which the last one may be near.
        let other_end = matches!(ends, Ends::Hold | Ends::Closed) && scheme.has_ends();
        let met = clip.times.len() - usize::from(other_end);
        if scheme.passes_keys() {
            for (&t, &key) in clip.times.iter().zip(&clip.tracks[0]).take(met) {
                // A rotation half a turn away is 1e-7 degrees off by rounding alone.
                let off = degrees(curve(t), glams(Quat::to_xyzw(key)));
                prop_assert!(off < 1e-6, "the curve is {off} degrees off the key at {t} s");
            }
        }
        if channel.interpolation == Interpolation::Step {
            let held = channel.rotations();
            for (&t, key) in clip.times.iter().zip(&clip.tracks[0]) {
                let stored = channel.times.iter().position(|&at| at == t as f32);
                // What repeats the value before need not be stored.
                let at = stored.unwrap_or(channel.times.partition_point(|&at| at <= t as f32) - 1);
                let off = degrees(glams(held[at].map(f64::from)), glams(Quat::to_xyzw(*key)));
                prop_assert!(off < 3e-5, "held {off} degrees off the key at {t} s");
            }
            return Ok(());
        }
        let bound = made.facts[0].tracks[0].deviation.unwrap();
        let all = channel.rotations();
        for t in moments(channel, &clip.times) {
            if let Some(played) = played(channel, &all, t) {
                let off = degrees(played, curve(t));
                // Float64 loses a few last digits of a turn in each evaluation.
                prop_assert!(off <= bound + 1e-9, "{off} degrees off at {t} s, said {bound}");
            }
        }
        if key_times && scheme.passes_keys() {
            for &t in &clip.times[..met] {
                let at = channel.times.iter().position(|&time| time == t as f32);
                prop_assert!(at.is_some(), "no sample at the key at {t} s");
                let stored = glams(all[at.unwrap()].map(f64::from));
                // The curve where the sample stands, in float32.
                let off = degrees(stored, curve(f64::from(t as f32)));
                prop_assert!(off < 3e-5, "{off} degrees off at the key at {t} s");
            }
        }
    }
}

//! What players do between keys: `--interpolation`, through the real program. Files are read
//! by the `gltf` crate and played by the specification's formulas, written once more here.

use crate::support::loaded::{Channel, load};
use crate::support::tool::run;
use crate::support::{fixtures, keyframes, read_clip};
use dat2glb::curve::{Ends, Motion, Scheme};
use dat2glb::math::Quat;
use gltf::animation::Interpolation;
use gltf::animation::util::ReadOutputs;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn converted(input: &Path, flags: &[&str]) -> (tempfile::TempDir, PathBuf, Value) {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let files = [input.to_str().unwrap(), output.to_str().unwrap(), "--json"];
    let summary = run(files.iter().chain(flags)).exits(0).json();
    (folder, output, summary)
}

fn path_fixture(name: &str) -> PathBuf {
    fixtures().join("paths").join(format!("{name}.dat"))
}

/// Times and translations, in, value, out, of the one channel there is.
fn places(path: &Path) -> (Interpolation, Vec<f32>, Vec<[f32; 3]>) {
    let gltf::Gltf { document, blob } = gltf::Gltf::open(path).unwrap();
    let animation = document.animations().next().unwrap();
    let channel = animation.channels().next().unwrap();
    let reader = channel.reader(|_| blob.as_deref());
    let Some(ReadOutputs::Translations(values)) = reader.read_outputs() else { panic!("no translations") };
    (channel.sampler().interpolation(), reader.read_inputs().unwrap().collect(), values.collect())
}

/// The points of a Bézier fixture: the lines that are no comments.
fn points(path: &Path) -> Vec<[f64; 3]> {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().map(|x| x.parse().unwrap()).collect() };
    let rows = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    rows.map(|line| numbers(line).try_into().unwrap()).collect()
}

#[test]
fn bezier_paths_are_represented_exactly() {
    let input = path_fixture("bezier");
    let (_folder, output, summary) =
        converted(&input, &["--interpolation", "cubicspline", "--orient", "none", "--time-scale", "0.7"]);
    let (interpolation, times, values) = places(&output);
    let points = points(&input);
    let segments = (points.len() - 1) / 3;
    assert_eq!(interpolation, Interpolation::CubicSpline);
    assert_eq!((times.len(), values.len()), (segments + 1, 3 * (segments + 1)));
    let near = |got: [f32; 3], wanted: [f64; 3], what: &str| {
        for (got, wanted) in got.into_iter().zip(wanted) {
            // A value is rounded to 2⁻²⁴ of itself; a tangent comes from values so rounded,
            // times likewise, over an interval of a few seconds, at a speed of a few units.
            assert!((f64::from(got) - wanted).abs() < 4e-7 * wanted.abs().max(5.0), "{what}: {got} {wanted}");
        }
    };
    let h = summary["seconds"].as_f64().unwrap() / segments as f64;
    for (i, &time) in times.iter().enumerate() {
        let at = 3 * i;
        near([time, 0.0, 0.0], [h * i as f64, 0.0, 0.0], "time");
        near(values[at + 1], points[at], "place");
        let slope = |a: usize, b: usize| -> [f64; 3] {
            std::array::from_fn(|k| 3.0 * (points[b][k] - points[a][k]) / h)
        };
        if i > 0 {
            near(values[at], slope(at - 1, at), "tangent in");
        }
        if i < segments {
            near(values[at + 2], slope(at, at + 1), "tangent out");
        }
    }
    // And it is proven so: to float32 of coordinates up to 10.
    assert!(summary["clips"][0]["deviationUnits"].as_f64().unwrap() < 2e-6);
    run(["check", output.to_str().unwrap(), "--against", input.to_str().unwrap(), "--strict"]).exits(0);
}

/// The specification's CUBICSPLINE for a rotation, normalised.
fn spline(channel: &Channel, i: usize, u: f64) -> Quat {
    let td = f64::from(channel.times[i + 1]) - f64::from(channel.times[i]);
    let at = |k: usize| channel.rotations[k].map(f64::from);
    let (v, b, a, w) = (at(3 * i + 1), at(3 * i + 2), at(3 * i + 3), at(3 * i + 4));
    let (u2, u3) = (u * u, u * u * u);
    let blend: [f64; 4] = std::array::from_fn(|k| {
        (2.0 * u3 - 3.0 * u2 + 1.0) * v[k]
            + td * (u3 - 2.0 * u2 + u) * b[k]
            + (3.0 * u2 - 2.0 * u3) * w[k]
            + td * (u3 - u2) * a[k]
    });
    let length = blend.iter().map(|x| x * x).sum::<f64>().sqrt();
    Quat::from_xyzw(blend.map(|x| x / length))
}

#[test]
fn cubics_keep_their_tolerance_span_the_clip_and_are_few() {
    for (name, scheme) in [("chain-even", "squad"), ("chain-uneven", "bessel"), ("large-steps", "natural-c2")]
    {
        let (input, tolerance) = (keyframes(name), 0.02);
        let flags = ["--scheme", scheme, "--tolerance", "0.02"];
        let (_folder, output, summary) =
            converted(&input, &[&flags[..], &["--interpolation", "cubicspline"]].concat());
        let clip = read_clip(&input);
        let loaded = load(&output);
        let mut worst: f64 = 0.0;
        for (channel, keys) in loaded.clips[0].channels.iter().zip(&clip.tracks) {
            assert_eq!(channel.interpolation, Interpolation::CubicSpline, "{name}");
            assert_eq!(channel.times[0], 0.0);
            assert_eq!(*channel.times.last().unwrap(), clip.duration() as f32);
            let motion = Motion::new(&clip.times, keys, Scheme::from_name(scheme).unwrap(), Ends::Natural);
            for i in 0..channel.times.len() - 1 {
                for k in 0..=32 {
                    let u = f64::from(k) / 32.0;
                    let (from, to) = (f64::from(channel.times[i]), f64::from(channel.times[i + 1]));
                    let at = from + u * (to - from);
                    worst = worst.max(spline(channel, i, u).angle_to(motion.at(at)).to_degrees());
                }
            }
        }
        let clip = &summary["clips"][0];
        let bound = clip["deviationDegrees"].as_f64().unwrap();
        assert!(worst <= bound && bound <= tolerance && bound <= 1.06 * worst, "{name}: {worst} {bound}");
        assert_eq!(loaded.clips[0].extras["interpolation"], "CUBICSPLINE");
        assert!(clip["nlerpDegrees"].is_null(), "nothing is known of players without tangents");
        let (_folder, _, linear) = converted(&input, &flags);
        let count = |summary: &Value| summary["clips"][0]["samplesInAll"].as_u64().unwrap();
        assert!(3 * count(&summary) < count(&linear), "{name}");
        run(["check", output.to_str().unwrap(), "--against", input.to_str().unwrap(), "--strict"]).exits(0);
    }
}

#[test]
fn a_path_that_ends_early_is_held_by_its_cubic() {
    let flags = ["--path", path_fixture("bezier-times").to_str().unwrap(), "--interpolation", "cubicspline"]
        .map(str::to_owned);
    let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
    let (_folder, output, _) = converted(&keyframes("chain-even"), &flags);
    let file = gltf::Gltf::open(&output).unwrap();
    let samplers = file.animations().next().unwrap().samplers().collect::<Vec<_>>();
    let ends: Vec<f64> = samplers.iter().map(|s| s.input().max().unwrap()[0].as_f64().unwrap()).collect();
    assert!(samplers.iter().all(|s| s.interpolation() == Interpolation::CubicSpline));
    assert!(ends.len() == 5 && ends.iter().all(|&end| end == ends[0]), "{ends:?}");
}

#[test]
fn steps_hold_each_sample() {
    let input = keyframes("chain-uneven");
    let (_folder, output, summary) = converted(&input, &["--interpolation", "step", "--fps", "12"]);
    let clip = read_clip(&input);
    let loaded = load(&output);
    let mut worst: f64 = 0.0;
    for (channel, keys) in loaded.clips[0].channels.iter().zip(&clip.tracks) {
        assert_eq!(channel.interpolation, Interpolation::Step);
        let motion = Motion::new(&clip.times, keys, Scheme::Bessel, Ends::Natural);
        for (t, q) in channel.times.windows(2).zip(&channel.rotations) {
            let held = Quat::from_xyzw(q.map(f64::from));
            for k in 0..=32 {
                let at = f64::from(t[0]) + f64::from(k) / 32.0 * f64::from(t[1] - t[0]);
                worst = worst.max(held.angle_to(motion.at(at)).to_degrees());
            }
        }
    }
    let bound = summary["clips"][0]["deviationDegrees"].as_f64().unwrap();
    assert!(worst <= bound && bound <= 1.06 * worst, "{worst} {bound}");
    assert_eq!(loaded.clips[0].extras["interpolation"], "STEP");
    run(["check", output.to_str().unwrap(), "--against", input.to_str().unwrap(), "--strict"]).exits(0);
}

#[test]
fn steps_hold_places_and_attitudes_too() {
    let input = path_fixture("flight");
    for more in [&[][..], &["--repeat", "3", "--no-wrap"]] {
        let flags = [&["--interpolation", "step", "--fps", "12"][..], more].concat();
        let (_folder, output, _) = converted(&input, &flags);
        run(["check", output.to_str().unwrap(), "--against", input.to_str().unwrap()]).exits(0);
    }
}

#[test]
fn what_does_not_go_together_is_said() {
    let cubic = |flags: &[&str], words: &str| {
        let all = [&["-", "-o", "-", "--interpolation"][..], flags].concat();
        run(&all).exits(2).says(&[words]);
    };
    cubic(&["cubicspline", "--fps", "60"], "cubicspline cannot be used with --fps");
    cubic(&["cubicspline", "--no-key-times"], "cannot be used with --no-key-times");
    cubic(&["cubicspline", "--no-bound"], "cannot be used with --no-bound");
    cubic(&["cubicspline", "--repeat", "2"], "cannot be used with --repeat");
    cubic(&["cubicspline", "--quantize"], "costs up to 0.0033°");
    cubic(&["step", "--tolerance", "1"], "step cannot be used with --tolerance");
    cubic(&["step", "--repeat", "2"], "add --no-wrap");
    cubic(&["linear", "--max-step", "9"], "--max-step needs --tolerance");
    cubic(&["linear", "--tolerance-distance", "9"], "--tolerance-distance needs --tolerance");
    cubic(&["bezier"], "cubicspline");
}

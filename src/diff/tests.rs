//! Two files with known motions.

use super::*;
use crate::asset::tests::{glb, open};
use crate::check::Code;
use crate::check::against::degrees;
use serde_json::{Value, json};

/// A channel to be written: node, path, interpolation, times, values.
type Sketch<'a> = (usize, &'a str, &'a str, &'a [f32], Vec<f32>);

/// A file with these nodes and one clip of these channels.
fn file(nodes: Value, channels: &[Sketch]) -> Asset {
    let (mut bin, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
    let mut add = |numbers: &[f32], kind: &str, width: usize| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        views.push(json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len()}));
        let count = numbers.len() / width;
        accessors.push(
            json!({"bufferView": accessors.len(), "componentType": 5126, "type": kind, "count": count}),
        );
        bin.extend(bytes);
    };
    let (mut samplers, mut targets) = (Vec::new(), Vec::new());
    for (i, (node, path, interpolation, times, values)) in channels.iter().enumerate() {
        let (kind, width) = match *path {
            "rotation" => ("VEC4", 4),
            "weights" => ("SCALAR", 1),
            _ => ("VEC3", 3),
        };
        add(times, "SCALAR", 1);
        add(values, kind, width);
        samplers.push(json!({"input": 2 * i, "output": 2 * i + 1, "interpolation": interpolation}));
        targets.push(json!({"sampler": i, "target": {"node": node, "path": path}}));
    }
    let mut json = json!({
        "asset": {"version": "2.0"}, "nodes": nodes, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": bin.len()}],
    });
    if !channels.is_empty() {
        json["animations"] = json!([{"name": "clip", "channels": targets, "samplers": samplers}]);
    }
    open(glb(&json, &bin)).unwrap()
}

/// A file of one node `n` with one channel.
fn single(path: &str, interpolation: &str, times: &[f32], values: Vec<f32>) -> Asset {
    file(json!([{"name": "n"}]), &[(0, path, interpolation, times, values)])
}

/// A rotation by some degrees about an axis of unit length.
fn turn(axis: [f64; 3], degrees: f64) -> [f32; 4] {
    let (s, c) = (degrees.to_radians() / 2.0).sin_cos();
    [s * axis[0], s * axis[1], s * axis[2], c].map(|x| x as f32)
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];

/// What is found of the only clip, by node and measure.
fn found(mut a: Asset, mut b: Asset) -> Diff {
    files(&mut a, &mut b, &[]).unwrap()
}

fn of(diff: &Diff, node: usize, measure: Measure) -> Option<Difference> {
    diff.clips[0].nodes[node].differences.iter().copied().find(|d| d.measure == measure)
}

#[track_caller]
fn near(found: Option<Difference>, off: f64, time: f64, tolerance: f64) {
    let found = found.unwrap();
    assert!((found.off - off).abs() < tolerance, "{found:?}, expected {off}");
    // A peak is found to the square root of rounding.
    assert!((found.time - time).abs() < 1e-5, "{found:?}, expected {time} s");
}

/// float32 holds a rotation to a few 1e-8 of its half angle: 1e-5 degrees.
const FLOAT: f64 = 1e-5;

#[test]
fn the_same_file_does_not_differ() {
    let values: Vec<f32> = [0.0, 50.0, 20.0].iter().flat_map(|&d| turn(X, d)).collect();
    let make = || single("rotation", "LINEAR", &[0.0, 1.0, 1.5], values.clone());
    let diff = found(make(), make());
    assert!(diff.clips[0].nodes[0].differences.is_empty(), "{diff:?}");
    // Nor does one in which the signs of quaternions flip.
    let mut flipped = values.clone();
    flipped[4..8].iter_mut().for_each(|x| *x = -*x);
    let diff = found(make(), single("rotation", "LINEAR", &[0.0, 1.0, 1.5], flipped));
    assert!(of(&diff, 0, Measure::LocalRotation).is_none_or(|d| d.off < 1e-12), "{diff:?}");
}

#[test]
fn a_step_differs_most_just_before_it_is_taken() {
    let values: Vec<f32> = [turn(X, 0.0), turn(X, 60.0)].concat();
    let linear = single("rotation", "LINEAR", &[0.0, 1.0], values.clone());
    let step = single("rotation", "STEP", &[0.0, 1.0], values);
    let diff = found(linear, step);
    let largest = of(&diff, 0, Measure::LocalRotation).unwrap();
    assert!((largest.off - 60.0).abs() < FLOAT, "{largest:?}");
    // At the step itself they agree.
    assert!(largest.time < 1.0 && largest.time > 0.999_999, "{largest:?}");
}

#[test]
fn a_last_step_counts_though_nothing_follows() {
    let still = single("scale", "STEP", &[0.0, 2.0], vec![1.0; 6]);
    let step = single("scale", "STEP", &[0.0, 2.0], [[1.0; 3], [4.0; 3]].concat());
    assert_eq!(of(&found(still, step), 0, Measure::LocalScale).map(|d| (d.off, d.time)), Some((3.0, 2.0)));
}

/// x = t³ on 0..2 against the straight line to it: 4t − t³ is largest at t = 2/√3.
#[test]
fn a_cubic_and_its_chord() {
    let cubic = [[0.0; 3], [0.0; 3], [0.0; 3], [12.0, 0.0, 0.0], [8.0, 0.0, 0.0], [12.0, 0.0, 0.0]].concat();
    let chord = single("translation", "LINEAR", &[0.0, 2.0], vec![0.0, 0.0, 0.0, 8.0, 0.0, 0.0]);
    let diff = found(single("translation", "CUBICSPLINE", &[0.0, 2.0], cubic), chord);
    let (off, time) = (16.0 / (3.0 * 3f64.sqrt()), 2.0 / 3f64.sqrt());
    near(of(&diff, 0, Measure::LocalTranslation), off, time, 1e-12);
    near(of(&diff, 0, Measure::WorldTranslation), off, time, 1e-12);
    assert_eq!(of(&diff, 0, Measure::LocalRotation), None);
}

/// Chords of a curve stray by h²/8 times its second derivative, 6t, which in the last
/// interval lies between 12 − 6h and 12.
#[test]
fn a_cubic_and_its_dense_samples() {
    let cubic = [[0.0; 3], [0.0; 3], [0.0; 3], [12.0, 0.0, 0.0], [8.0, 0.0, 0.0], [12.0, 0.0, 0.0]].concat();
    let times: Vec<f32> = (0..=64).map(|i| i as f32 / 32.0).collect();
    let samples = times.iter().flat_map(|t| [t * t * t, 0.0, 0.0]).collect();
    let curve = single("translation", "CUBICSPLINE", &[0.0, 2.0], cubic);
    let diff = found(curve, single("translation", "LINEAR", &times, samples));
    let largest = of(&diff, 0, Measure::LocalTranslation).unwrap();
    let h = 1.0 / 32.0;
    // The samples are float32: off by less than 8 · 2⁻²⁴.
    let (least, most) = (h * h / 8.0 * (12.0 - 6.0 * h) - 5e-7, h * h / 8.0 * 12.0 + 5e-7);
    assert!(least < largest.off && largest.off < most, "{largest:?} {least} {most}");
    assert!(largest.time > 2.0 - h, "{largest:?}");
}

/// Turns by θ about x and about y are 2 acos(cos²(θ/2)) apart.
#[test]
fn turns_about_two_axes() {
    let about =
        |axis| single("rotation", "LINEAR", &[0.0, 3.0], [turn(axis, 0.0), turn(axis, 90.0)].concat());
    near(of(&found(about(X), about(Y)), 0, Measure::LocalRotation), 120.0, 3.0, FLOAT);
}

/// From −60° to 40°, half a turn away at 0°: there the angle has a corner.
#[test]
fn a_sharp_peak_within_an_interval() {
    let moving = single("rotation", "LINEAR", &[0.0, 1.0], [turn(X, -60.0), turn(X, 40.0)].concat());
    let resting = file(json!([{"name": "n", "rotation": turn(X, 180.0)}]), &[]);
    let mut diff = found(moving, resting);
    // Only one file has a clip, so the rest poses were compared.
    assert_eq!(diff.only_in_a.clips, ["clip"]);
    assert_eq!(of(&diff, 0, Measure::LocalRotation).map(|d| d.off.round()), Some(180.0));
    let moving = single("rotation", "LINEAR", &[0.0, 1.0], [turn(X, -60.0), turn(X, 40.0)].concat());
    let held = single("rotation", "LINEAR", &[0.0], turn(X, 180.0).to_vec());
    diff = found(moving, held);
    let largest = of(&diff, 0, Measure::LocalRotation).unwrap();
    assert!((largest.off - 180.0).abs() < 2e-4 && (largest.time - 0.6).abs() < 1e-5, "{largest:?}");
}

/// Any two slerps, against two thousand times: of turns by up to half a turn in a single
/// interval, nothing above a thousandth is missed.
#[test]
fn no_time_between_keys_differs_more_than_is_found() {
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    let mut rotation = || -> [f32; 4] {
        let q: [f64; 4] = std::array::from_fn(|_| random());
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.map(|x| (x / length) as f32)
    };
    for _ in 0..300 {
        let keys: [[f32; 4]; 4] = std::array::from_fn(|_| rotation());
        let clip = |i: usize| single("rotation", "LINEAR", &[0.0, 1.0], keys[i..i + 2].concat());
        let largest = of(&found(clip(0), clip(2)), 0, Measure::LocalRotation).unwrap();
        let at = |i: usize, u: f64| {
            crate::asset::play::slerp(keys[i].map(f64::from), keys[i + 1].map(f64::from), u)
        };
        let off = |u: f64| degrees(at(0, u), at(2, u));
        let densest = (0..=2000).map(|i| off(f64::from(i) / 2000.0)).fold(0.0, f64::max);
        let looks = [0.0, 0.25, 0.5, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0].map(off);
        assert!(largest.off >= densest * 0.999, "{largest:?} {densest} {looks:?}");
        // At half a turn rounding counts by its root.
        let rounding = if largest.off < 179.0 { 1e-9 } else { 5e-6 };
        assert!((off(largest.time) - largest.off).abs() < rounding, "{largest:?}");
    }
}

/// A child two units below its parent, which turns by θ more in one file: 2 r sin(θ/2).
#[test]
fn a_turn_of_the_parent_moves_the_child() {
    let nodes = json!([{"name": "top", "children": [1]}, {"name": "tip", "translation": [0, -2, 0]}]);
    let make = |angle: f64| {
        let values = [turn(X, 0.0), turn(X, angle)].concat();
        file(nodes.clone(), &[(0, "rotation", "LINEAR", &[0.0, 4.0], values)])
    };
    let diff = found(make(50.0), make(80.0));
    near(of(&diff, 0, Measure::LocalRotation), 30.0, 4.0, FLOAT);
    assert_eq!(of(&diff, 0, Measure::WorldTranslation), None);
    assert_eq!(of(&diff, 1, Measure::LocalRotation), None);
    near(of(&diff, 1, Measure::WorldRotation), 30.0, 4.0, FLOAT);
    let displaced = 2.0 * 2.0 * 15f64.to_radians().sin();
    // Two units at float32's accuracy of an angle.
    near(of(&diff, 1, Measure::WorldTranslation), displaced, 4.0, 1e-6);
}

#[test]
fn the_shorter_clip_holds_its_end() {
    let make = |end: f32| single("translation", "LINEAR", &[0.0, end], vec![0.0, 0.0, 0.0, end, 0.0, 0.0]);
    let diff = found(make(1.0), make(3.0));
    near(of(&diff, 0, Measure::LocalTranslation), 2.0, 3.0, 1e-12);
    assert_eq!(diff.clips[0].seconds, Both { a: 1.0, b: 3.0 });
    let report = diff.report(&Limits::default());
    assert_eq!(report.findings().iter().map(|f| f.code).collect::<Vec<_>>(), [Code::LengthDiffers]);
}

/// Normalised 16-bit integers are off by up to 2⁻¹⁶ in each of the four numbers, and an
/// angle by twice their length: 3.5e-3 degrees.
#[test]
fn quantised_rotations() {
    let angles = [0.0, 35.0, 70.0, 11.0];
    let axis = [0.48, -0.6, 0.64];
    let values: Vec<f32> = angles.iter().flat_map(|&angle| turn(axis, angle)).collect();
    let times = [0.0f32, 1.0, 2.0, 3.0];
    let codes = values.iter().flat_map(|x| ((x * 32767.0).round() as i16).to_le_bytes());
    let bin: Vec<u8> = times.iter().flat_map(|t| t.to_le_bytes()).chain(codes).collect();
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": bin.len()}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 16}, {"buffer": 0, "byteOffset": 16, "byteLength": 32},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 4},
            {"bufferView": 1, "componentType": 5122, "normalized": true, "type": "VEC4", "count": 4},
        ],
        "nodes": [{"name": "n"}],
        "animations": [{
            "name": "clip",
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
            "samplers": [{"input": 0, "output": 1}],
        }],
    });
    let diff = found(single("rotation", "LINEAR", &times, values), open(glb(&json, &bin)).unwrap());
    let off = of(&diff, 0, Measure::LocalRotation).unwrap().off;
    assert!(off > 1e-5 && off < 3.5e-3, "{off}");
}

#[test]
fn weights_are_compared_and_missing_ones_are_zero() {
    let nodes = |weights: Value| json!([{"name": "n", "weights": weights}]);
    let moving =
        file(nodes(json!([0, 0])), &[(0, "weights", "LINEAR", &[0.0, 1.0], vec![0.0, 0.0, 1.0, 0.5])]);
    let resting = file(nodes(json!([0.25])), &[(0, "scale", "STEP", &[0.0], vec![1.0; 3])]);
    let diff = found(moving, resting);
    near(of(&diff, 0, Measure::Weights), 0.75, 1.0, 1e-7);
    let channel = |property| AloneChannel { clip: "clip".into(), node: "n".into(), property };
    assert_eq!(diff.only_in_a.channels, [channel("weights")]);
    assert_eq!(diff.only_in_b.channels, [channel("scale")]);
}

/// More keys than are in memory at once: the windows join without a gap.
#[test]
fn one_changed_key_among_many_is_found() {
    let times: Vec<f32> = (0..150_000).map(|i| i as f32 / 16.0).collect();
    let make = |changed: Option<usize>| {
        let mut values = vec![0.0f32; 3 * times.len()];
        if let Some(key) = changed {
            values[3 * key + 1] = 0.5;
        }
        single("translation", "LINEAR", &times, values)
    };
    for key in [0, 65_535, 65_536, 131_072, 149_999] {
        let diff = found(make(None), make(Some(key)));
        let largest = of(&diff, 0, Measure::WorldTranslation).unwrap();
        assert_eq!(largest.off, 0.5);
        assert!((largest.time - f64::from(times[key])).abs() < 1e-9, "{key}: {largest:?}");
    }
    // Against keys at quite other times.
    let few = single("translation", "LINEAR", &[0.0, 9000.0], vec![0.0; 6]);
    let largest = of(&found(few, make(Some(77_777))), 0, Measure::LocalTranslation).unwrap();
    assert!((largest.time - f64::from(times[77_777])).abs() < 1e-9, "{largest:?}");
}

#[test]
fn sheared_and_mirrored_nodes_are_compared_as_they_stand() {
    let matrix = [1.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 3.0, 0.0, 0.0, 1.0];
    let nodes = |x: f64| {
        let mut matrix = matrix;
        matrix[12] = x;
        json!([{"name": "n", "matrix": matrix, "children": [1]}, {"name": "m", "translation": [0, 1, 0]}])
    };
    let diff = found(file(nodes(3.0), &[]), file(nodes(4.0), &[]));
    near(of(&diff, 1, Measure::WorldTranslation), 1.0, 0.0, 1e-12);
    assert_eq!(of(&diff, 1, Measure::WorldRotation), None);
}

#[test]
fn limits_make_findings() {
    let nodes = json!([{"name": "top", "children": [1]}, {"name": "tip", "translation": [0, -2, 0]}]);
    let make = |angle: f64| {
        let values = [turn(X, 0.0), turn(X, angle)].concat();
        file(nodes.clone(), &[(0, "rotation", "LINEAR", &[0.0, 4.0], values)])
    };
    let diff = found(make(50.0), make(80.0));
    assert!(diff.report(&Limits::default()).findings().is_empty());
    assert!(diff.report(&Limits { degrees: Some(31.0), ..Limits::default() }).findings().is_empty());
    let tight = diff.report(&Limits { degrees: Some(0.1), units: Some(0.5), ..Limits::default() });
    let messages: Vec<&str> = tight.findings().iter().map(|f| f.message.as_str()).collect();
    assert_eq!(messages.len(), 3, "{messages:?}");
    assert!(
        messages[0].starts_with("clip clip: local rotation of node top differs by 30.0000"),
        "{messages:?}"
    );
    assert!(messages[1].contains("at most 0.1° is allowed; 1 more node exceeds it"), "{messages:?}");
    assert!(messages[2].contains("world position of node tip differs by 1.03527"), "{messages:?}");
    let limits = Limits { units: Some(0.5), degrees: Some(29.0), ..Limits::default() };
    assert_eq!(diff.most_telling(&limits).unwrap().difference.measure, Measure::WorldTranslation);
    assert_eq!(diff.most_telling(&Limits::default()).unwrap().difference.measure, Measure::WorldRotation);
}

#[test]
fn what_has_nothing_in_common_is_an_error() {
    let other = |name: &str, clip: &str| {
        let mut json: Value = json!({"asset": {"version": "2.0"}, "nodes": [{"name": name}]});
        json["animations"] = json!([{"name": clip, "channels": [], "samplers": []}, {"name": "more", "channels": [], "samplers": []}]);
        json["animations"][1]["name"] = format!("{clip} more").into();
        open(glb(&json, &[])).unwrap()
    };
    let diff = found(other("a", "walk"), other("b", "run"));
    let report = diff.report(&Limits::default());
    assert_eq!(report.count_of(Code::NothingInCommon), 2);
    assert_eq!(report.count_of(Code::OnlyInOne), 6);
    let map = [("a", "b"), ("walk", "run")].map(|(old, new)| (old.to_owned(), new.to_owned()));
    let diff = files(&mut other("a", "walk"), &mut other("b", "run"), &map).unwrap();
    assert_eq!(diff.report(&Limits::default()).count_of(Code::NothingInCommon), 0);
    let wrong = [("a".to_owned(), "c".to_owned())];
    let error = files(&mut other("a", "walk"), &mut other("b", "run"), &wrong).unwrap_err();
    assert!(matches!(error, Error::Name { which: Which::B, ref name } if name == "c"), "{error}");
}

#[test]
fn what_cannot_be_played_is_refused() {
    let good = || single("translation", "LINEAR", &[0.0, 1.0], vec![0.0; 6]);
    for (bad, reason) in [
        (single("translation", "LINEAR", &[0.0, 0.0], vec![0.0; 6]), "must rise"),
        (single("translation", "LINEAR", &[0.0, f32::NAN], vec![0.0; 6]), "must rise"),
        (single("translation", "LINEAR", &[0.0, 1.0], vec![f32::INFINITY; 6]), "finite"),
        (single("translation", "LINEAR", &[0.0, 1.0], vec![0.0; 9]), "one value for each key"),
    ] {
        let (mut a, mut b) = (good(), bad);
        let error = files(&mut a, &mut b, &[]).unwrap_err();
        assert!(matches!(error, Error::Asset { which: Which::B, .. }), "{error:?}");
        assert!(error.to_string().contains(reason), "{error}");
    }
    let mut far = file(json!([{"name": "n", "translation": [0, 1e39, 0]}]), &[]);
    let error = files(&mut far, &mut good(), &[]).unwrap_err();
    assert!(error.to_string().contains("/nodes/0: expected finite numbers"), "{error}");
}

#[test]
fn channels_of_extensions_are_noted() {
    let json = json!({
        "asset": {"version": "2.0"},
        "nodes": [{"name": "n"}],
        "animations": [{
            "name": "clip",
            "channels": [{"sampler": 0, "target": {"path": "pointer"}}],
            "samplers": [],
        }],
    });
    let make = || open(glb(&json, &[])).unwrap();
    let diff = found(make(), make());
    assert_eq!(diff.not_compared.len(), 2);
    assert_eq!(diff.report(&Limits::default()).count_of(Code::NotCompared), 2);
}

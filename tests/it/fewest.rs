//! As few keys as a tolerance allows, through the real program.

use crate::support::tool::run;
use crate::support::{fixtures, keyframes};
use dat2glb::asset::play::Player;
use dat2glb::asset::{Asset, NoFiles};
use dat2glb::curve::{Ends, Motion, Scheme};
use dat2glb::math::Quat;
use serde_json::Value;
use std::fs::File;
use std::path::{Path, PathBuf};

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn output() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    (folder, output)
}

fn convert(input: &Path, output: &Path, flags: &[&str]) -> Value {
    run(["convert", text(input), "-o", text(output), "--json"].iter().chain(flags)).exits(0).json()
}

fn open(path: &Path) -> Asset {
    Asset::open(Box::new(File::open(path).unwrap()), Box::new(NoFiles)).unwrap()
}

/// The largest angle between the file as a player turns it and the motion, degrees: found
/// at many times, and not by the program's own search.
fn measured(output: &Path, input: &Path, scheme: Scheme) -> f64 {
    let clip = crate::support::read_clip(input);
    let mut asset = open(output);
    let channels = asset.clips().remove(0).channels;
    let mut worst: f64 = 0.0;
    for (channel, keys) in channels.iter().zip(&clip.tracks) {
        let motion = Motion::new(&clip.times, keys, scheme, Ends::Natural);
        let mut player = Player::new();
        for i in 0..=20_000 {
            let t = clip.duration() * f64::from(i) / 20_000.0;
            let played = player.value(&mut asset, channel, t).unwrap();
            let played = Quat::from_xyzw(played.try_into().unwrap());
            let played = Quat::from_xyzw(played.to_xyzw().map(|x| x / played.norm()));
            worst = worst.max(played.angle_to(motion.at(t)).to_degrees());
        }
    }
    worst
}

#[test]
fn the_file_keeps_its_tolerance_with_fewer_keys_the_larger_it_is() {
    let (_folder, output) = output();
    for (name, scheme) in
        [("chain-uneven", Scheme::Bessel), ("chain-even", Scheme::Squad), ("single-even", Scheme::CatmullRom)]
    {
        let input = keyframes(name);
        let mut before = u64::MAX;
        for tolerance in ["0.001", "0.01", "0.1"] {
            let flags = ["--scheme", scheme.name(), "--tolerance", tolerance];
            let summary = convert(&input, &output, &flags);
            let limit: f64 = tolerance.parse().unwrap();
            let stated = summary["clips"][0]["deviationDegrees"].as_f64().unwrap();
            let worst = measured(&output, &input, scheme);
            assert!(worst <= stated && stated <= limit * (1.0 + 1e-4), "{name}: {worst} {stated} {limit}");
            assert!(stated <= 1.05 * worst + 1e-6, "{name}: {worst} {stated}");
            let keys = summary["samples"].as_u64().unwrap();
            assert!(keys <= before, "{name}: {keys} keys for {tolerance}, {before} for less");
            before = keys;
            let against = ["--against", text(&input), "--max-error", tolerance];
            run(["check", text(&output)].iter().chain(&against)).exits(0);
        }
    }
}

#[test]
fn keys_off_the_curve_are_fewer() {
    let (_folder, output) = output();
    let input = keyframes("chain-uneven");
    let keys = |flags: &[&str]| convert(&input, &output, flags)["samples"].as_u64().unwrap() as f64;
    let on = keys(&["--tolerance", "0.001", "--on-curve"]);
    let off = keys(&["--tolerance", "0.001"]);
    assert!(off < 0.75 * on, "{off} {on}");
}

#[test]
fn paths_cameras_and_what_has_no_bound_keep_theirs_too() {
    let (_folder, output) = output();
    let flight = fixtures().join("paths/flight.dat");
    let camera = format!("{},look-at=root", text(&fixtures().join("paths/camera.dat")));
    let flags = ["--tolerance", "0.05", "--tolerance-distance", "0.02", "--camera", &camera];
    let summary = convert(&flight, &output, &flags);
    let clip = &summary["clips"][0];
    assert!(clip["deviationUnits"].as_f64().unwrap() <= 0.02 * (1.0 + 1e-4), "{clip}");
    assert!(clip["measuredDegrees"].as_f64().unwrap() <= 0.05 * (1.0 + 1e-4), "{clip}");
    assert!(summary["samples"].as_u64().unwrap() < 2401 / 2, "{clip}");
    let limits = ["--against", text(&flight), "--max-error", "0.0525", "--max-distance", "0.02"];
    run(["check", text(&output)].iter().chain(&limits)).exits(0);
}

#[test]
fn what_rests_has_one_key_and_the_clip_keeps_its_length() {
    let (folder, output) = output();
    let input = folder.path().join("in.dat");
    std::fs::write(&input, "# 2 1.0\n0 1 0 0 0 1 0 0 0\n7.5 1 0 0 0 1 0 0 0\n9 1 0 0 0 1 0 0 0\n").unwrap();
    assert_eq!(convert(&input, &output, &["--tolerance", "0.1"])["samples"], 3);
    let clip = open(&output).clips().remove(0);
    assert_eq!(clip.duration, 9.0);
    let keys: Vec<usize> = clip.channels.iter().map(|channel| channel.keys).collect();
    assert_eq!(keys, [2, 1]);
}

#[test]
fn a_constant_turn_has_as_few_keys_as_the_largest_step_allows() {
    let (folder, output) = output();
    let input = folder.path().join("in.dat");
    // 90° in one segment of slerp: six steps of at most 18° are five.
    std::fs::write(&input, "# 1 1.0\n0 1 0 0 0\n3 0.70710678118654752 0.70710678118654752 0 0\n").unwrap();
    for (step, keys) in [("18", 6), ("30", 4), ("100", 2)] {
        let summary = convert(&input, &output, &["--tolerance", "0.01", "--max-step", step]);
        assert_eq!(summary["samples"], keys, "{step}");
    }
}

#[test]
fn a_distance_holds_for_every_corner_of_a_chain() {
    let (_folder, output) = output();
    let input = keyframes("chain-even");
    let flags = ["--tolerance", "1", "--tolerance-distance", "0.01"];
    let summary = convert(&input, &output, &flags);
    let stated = summary["clips"][0]["displacementUnits"].as_f64().unwrap();
    assert!(stated <= 0.01 * (1.0 + 1e-4), "{stated}");
}

/// The largest distance between a corner of a box in the file and where it should be.
#[cfg(feature = "render")]
fn corners_off(output: &Path, input: &Path, scheme: Scheme) -> f64 {
    use glam::{DMat4, DQuat, DVec3};
    let clip = crate::support::read_clip(input);
    let dat2glb::clip::Body::Chain { length } = clip.body else { panic!("no chain") };
    let motion = |keys| Motion::new(&clip.times, keys, scheme, Ends::Natural);
    let motions: Vec<Motion> = clip.tracks.iter().map(|keys| motion(keys)).collect();
    let mut stage = crate::support::stage::Stage::open(output);
    let mut worst: f64 = 0.0;
    for i in 0..=4_000 {
        let t = clip.duration() * f64::from(i) / 4_000.0;
        let mut world = DMat4::IDENTITY;
        for (k, motion) in motions.iter().enumerate() {
            world *= DMat4::from_quat(DQuat::from(motion.at(t)));
            let played = stage.world(&format!("box{}", k + 1), t);
            for corner in 0..8 {
                let side = |bit: i32| if corner & bit == 0 { 0.5 } else { -0.5 };
                let down = if corner & 4 == 0 { 0.0 } else { -length };
                let point = DVec3::new(side(1), down, side(2));
                worst = worst.max(world.transform_point3(point).distance(played.transform_point3(point)));
            }
            world *= DMat4::from_translation(DVec3::NEG_Y * length);
        }
    }
    worst
}

#[cfg(feature = "render")]
#[test]
fn corners_are_as_far_off_as_is_said() {
    let (_folder, output) = output();
    for (name, flags) in [
        ("chain-even", &["--fps", "24"][..]),
        ("chain-uneven", &["--fps", "10", "--no-key-times"]),
        ("chain-uneven", &["--tolerance", "0.05"]),
        ("chain-even", &["--tolerance", "0.5", "--quantize"]),
    ] {
        let input = keyframes(name);
        let summary = convert(&input, &output, flags);
        let stated = summary["clips"][0]["displacementUnits"].as_f64().unwrap();
        let worst = corners_off(&output, &input, Scheme::Bessel);
        assert!(worst <= stated, "{name} {flags:?}: {worst} {stated}");
        // Seven moments or so of an interval miss the crest by up to a fiftieth.
        assert!(stated <= 1.07 * worst, "{name} {flags:?}: {worst} {stated}");
    }
}

#[test]
fn sixteen_bits_stay_within_the_tolerance_or_are_refused() {
    let (_folder, output) = output();
    let input = keyframes("chain-uneven");
    convert(&input, &output, &["--tolerance", "0.02", "--quantize"]);
    let worst = measured(&output, &input, Scheme::Bessel);
    assert!(worst <= 0.02, "{worst}");
    let accessors = &open(&output).root().accessors.clone();
    let coded = accessors.iter().filter(|accessor| accessor.normalized).count();
    assert_eq!(coded, 4);
    let arguments = ["convert", text(&input), "-o", text(&output), "--tolerance", "0.002", "--quantize"];
    run(arguments).exits(1).says(&["--quantize", "too small"]);
    // At a rate the error of coding is part of what is stated.
    let summary = convert(&input, &output, &["--quantize"]);
    let stated = summary["clips"][0]["deviationDegrees"].as_f64().unwrap();
    assert!(measured(&output, &input, Scheme::Bessel) <= stated);
    run(["check", text(&output), "--against", text(&input)]).exits(0);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let input = keyframes("chain-even");
    let refused = |flags: &[&str], code, words: &[&str]| {
        run(["convert", text(&input), "-o", "/tmp/never.glb"].iter().chain(flags)).exits(code).says(words);
    };
    refused(&["--tolerance", "1e-5"], 1, &["too small", "float32"]);
    refused(&["--tolerance", "0.1", "--fps", "30"], 2, &["--fps"]);
    refused(&["--tolerance", "0.1", "--no-key-times"], 2, &["--no-key-times"]);
    refused(&["--tolerance", "0"], 2, &["above 0"]);
    refused(&["--on-curve"], 2, &["--tolerance"]);
    refused(&["--tolerance", "0.1", "--max-step", "180"], 2, &["below 180"]);
}

#[test]
fn keys_that_float32_cannot_tell_apart_are_refused() {
    let (folder, output) = output();
    let input = folder.path().join("late.dat");
    // From 8,047,188,000 s on float32 numbers are 512 s apart.
    std::fs::write(&input, "# 1 2\n0 1 0 0 0\n8047188000 0.6 0.8 0 0\n8047188000.25 0 1 0 0\n").unwrap();
    let refused = |flags: &[&str], words: &[&str]| {
        let said = run(["convert", text(&input), "-o", text(&output)].iter().chain(flags)).exits(1);
        assert!(!said.says(words).stderr.contains("--no-key-times"));
        assert!(!output.exists());
    };
    let held = ["--scheme", "step"];
    refused(&[&held[..], &["--tolerance", "1"]].concat(), &["lines 3 and 4", "leave one of them out"]);
    refused(&[&held[..], &["--fps", "1/1000", "--no-key-times"]].concat(), &["leave one of them out"]);
    refused(&[&held[..], &["--fps", "1/1000"]].concat(), &["leave one of them out"]);
    refused(&["--tolerance", "1"], &["float32 times cannot follow the curve"]);
    std::fs::write(&input, "# 1 2\n0 1 0 0 0\n1 0.6 0.8 0 0\n2e50 0 1 0 0\n").unwrap();
    for scheme in ["step", "natural-c2", "barry-goldman"] {
        refused(&["--scheme", scheme, "--tolerance", "1"], &["longer than 1e18 s"]);
    }
}

#[test]
fn without_a_bound_nothing_is_stated() {
    let (_folder, output) = output();
    let input = keyframes("chain-even");
    let summary = convert(&input, &output, &["--no-bound"]);
    assert!(summary["clips"][0]["deviationDegrees"].is_null());
    let checked = run(["check", text(&output), "--against", text(&input)]).exits(0);
    assert!(!checked.out().contains("allowed"), "{}", checked.out());
}

#[test]
fn held_poses_are_steps_with_a_key_each() {
    let (_folder, output) = output();
    let (input, flight) = (keyframes("chain-uneven"), fixtures().join("paths/flight.dat"));
    for (flags, interpolations) in [
        (&["--scheme", "step"][..], vec!["STEP"; 4]),
        (&["--scheme", "step", "--tolerance", "0.1", "--quantize"], vec!["STEP"; 4]),
        (&["--scheme", "step", "--path", text(&flight)], vec!["STEP", "STEP", "STEP", "STEP", "LINEAR"]),
    ] {
        convert(&input, &output, flags);
        let mut asset = open(&output);
        let channels = asset.clips().remove(0).channels;
        let found: Vec<String> =
            channels.iter().map(|channel| format!("{:?}", channel.interpolation).to_uppercase()).collect();
        assert_eq!(found, interpolations);
        assert!(channels[..4].iter().all(|channel| channel.keys == 24), "{flags:?}");
        let worst = measured(&output, &input, Scheme::Step);
        assert!(worst < 0.004, "{flags:?}: {worst}");
        let mut check = vec!["check", text(&output), "--strict", "--against", text(&input)];
        if flags.contains(&"--path") {
            check.extend(["--against", text(&flight)]);
        }
        run(check).exits(0);
    }
    let copies = ["--scheme", "step", "--path", text(&flight), "--repeat", "3"];
    run(["convert", text(&input), "-o", text(&output)].iter().chain(&copies)).exits(1).says(&["--repeat"]);
}

/// Between two neighbouring float32 times the first is still held.
#[test]
fn held_poses_may_be_as_near_as_float32_times() {
    let (folder, output) = output();
    let input = folder.path().join("in.dat");
    std::fs::write(&input, "# 1 2\n0 1 0 0 0\n44.875103 0 1 0 0\n44.875106 0 0.6 0.8 0\n45 1 0 0 0\n")
        .unwrap();
    convert(&input, &output, &["--scheme", "step"]);
    run(["check", text(&output), "--against", text(&input)]).exits(0);
}

#[test]
fn places_are_as_exact_as_the_path_is_wide_wherever_it_lies() {
    let (folder, output) = output();
    let input = folder.path().join("in.dat");
    let stated = |x: f64| {
        let rows = format!("# catmull-rom 4\n{x} 0 0\n{} 3 0\n{} 0 5\n{} 1 9\n", x + 2.0, x + 5.0, x + 10.0);
        std::fs::write(&input, rows).unwrap();
        convert(&input, &output, &["--tolerance", "0.1"])["clips"][0]["deviationUnits"].as_f64().unwrap()
    };
    // The path is 10 wide: an angle of 0.1° makes 0.01745 of it.
    let allowed = 0.1f64.to_radians() * 10.0;
    assert!((0.5 * allowed..=allowed * 1.001).contains(&stated(0.0)), "{}", stated(0.0));
    assert!(stated(1e4) <= allowed * 1.001, "{}", stated(1e4));
    // Here float32 coordinates are 0.06 apart, and no less than it needs is asked for.
    assert!(stated(1e6) <= 1.0, "{}", stated(1e6));
    for place in ["0 0 0", "7 7 7"] {
        std::fs::write(&input, format!("# polyline 4\n{place}\n{place}\n")).unwrap();
        convert(&input, &output, &["--tolerance", "0.1"]);
    }
}

#[test]
fn a_tolerance_that_cannot_be_kept_is_told_with_its_unit_and_its_origin() {
    let (chain, flight) = (keyframes("chain-even"), fixtures().join("paths/flight.dat"));
    for (input, unit) in [(&chain, "°"), (&flight, " units")] {
        let flags = ["--tolerance", "0.1", "--tolerance-distance", "1e-10", "-o", "/tmp/never.glb"];
        let said = run(["convert", text(input)].iter().chain(&flags)).exits(1);
        let words = [&*format!("{}: a tolerance of", input.display()), unit, "is too small"];
        said.says(&words);
    }
}

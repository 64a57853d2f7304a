//! `dat2glb convert`: what it says, what it takes, what it stores beside the motion.

use crate::support::loaded::load;
use crate::support::tool::{finish, names, program, run, run_in};
use crate::support::{good, keyframes};
use serde_json::{Value, json};
use std::fs;

const SINGLE: &str = "fixtures/keyframes/single-even.dat";

#[test]
fn a_clip_says_how_it_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let output = output.to_str().unwrap();
    let options = ["--scheme", "squad,bessel", "--ends", "clamped", "--fps", "30000/1001"];
    run(["convert", "fixtures/keyframes/xyzw.dat", "-o", output].iter().chain(&options)).exits(0);
    let loaded = load(output.as_ref());
    let hash = blake3::hash(&fs::read(keyframes("xyzw")).unwrap()).to_hex().to_string();
    for (clip, scheme) in loaded.clips.iter().zip(["squad", "bessel"]) {
        let mut extras = clip.extras.clone();
        let deviation: Vec<f64> = serde_json::from_value(extras["deviationDegrees"].take()).unwrap();
        assert!(deviation.len() == 1 && deviation[0] > 0.0 && deviation[0] < 1.0, "{deviation:?}");
        let nlerp: Vec<f64> = serde_json::from_value(extras["nlerpDegrees"].take()).unwrap();
        assert!(nlerp.len() == 1 && nlerp[0] >= deviation[0], "{nlerp:?}");
        // One box, 1 unit long and square: its far corners are √1.5 from the hinge.
        let displacement = extras["displacementUnits"].take().as_f64().unwrap();
        let most = deviation[0].to_radians() * 1.5f64.sqrt();
        // Whatever the axis, a corner is √½ from it; each figure is up to 5 % above the truth.
        assert!(displacement <= 1.05 * most, "{displacement} {most}");
        assert!(displacement >= 0.95 * most * (0.5 / 1.5f64).sqrt(), "{displacement} {most}");
        let expected = json!({
            "dat2glb": env!("CARGO_PKG_VERSION"),
            "scheme": scheme,
            "ends": "clamped",
            "fps": "30000/1001",
            "keyTimes": true,
            "inputs": [{ "name": "xyzw.dat", "blake3": hash }],
            "deviationDegrees": null,
            "nlerpDegrees": null,
            "displacementUnits": null,
        });
        assert_eq!(extras, expected);
    }
    let root: Value = serde_json::to_value(loaded.document.as_json()).unwrap();
    assert_eq!(root["asset"]["generator"], concat!("dat2glb ", env!("CARGO_PKG_VERSION")));
    assert_eq!(root["asset"]["version"], "2.0");
}

#[test]
fn the_same_input_and_options_make_the_same_bytes() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    for name in ["sixteen", "half-turn"] {
        for options in [&["--scheme", "all"][..], &["--ends", "hold", "--no-key-times"]] {
            let mut made = Vec::new();
            for (folder, threads) in folders.iter().flat_map(|folder| [(folder, "1"), (folder, "7")]) {
                fs::copy(keyframes(name), folder.path().join("in.dat")).unwrap();
                let mut command = program();
                command.current_dir(folder).env("RAYON_NUM_THREADS", threads);
                finish(command.args(["in.dat", "out.glb"]).args(options), b"").exits(0);
                made.push(fs::read(folder.path().join("out.glb")).unwrap());
            }
            assert!(made.iter().all(|bytes| *bytes == made[0]), "{name} {options:?}");
        }
    }
}

#[test]
fn the_summary_says_what_was_made_and_what_to_type_in_blender() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let ran = run(["fixtures/keyframes/chain-even.dat".as_ref(), output.as_os_str()]).exits(0);
    assert!(ran.stdout.is_empty());
    let bytes = format!("{:.1} kB", fs::metadata(&output).unwrap().len() as f64 / 1e3);
    ran.says(&[
        "out.glb: 26 keys, 4 boxes, 10 s, 601 samples each",
        &bytes,
        "Blender: set the scene's end to frame 241 at 24 fps\n",
    ]);
}

#[test]
fn the_summary_as_json() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let output = output.to_str().unwrap();
    let ran = run([SINGLE, output, "--json", "--ends", "hold", "--scheme", "bessel,slerp"]).exits(0);
    assert_eq!(ran.stderr, "");
    let summary = ran.json();
    let length = fs::metadata(output).unwrap().len();
    let expected = json!({
        "schema": 1, "input": SINGLE, "output": output, "keys": 17, "boxes": 1, "seconds": 8.0,
        "bytes": length, "blenderEndFrame": 193,
    });
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(summary[name], *value, "{name}");
    }
    let clips = load(output.as_ref()).clips;
    let samples: usize = clips.iter().map(|clip| clip.channels[0].times.len()).sum();
    assert_eq!(summary["samples"], samples);
    let scheme = |i: usize| {
        (summary["clips"][i]["name"].as_str().unwrap(), summary["clips"][i]["scheme"].as_str().unwrap())
    };
    assert_eq!((scheme(0), scheme(1)), (("single-even-bessel", "bessel"), ("single-even-slerp", "slerp")));
    let codes: Vec<&Value> = summary["warnings"].as_array().unwrap().iter().map(|w| &w["code"]).collect();
    assert_eq!(codes, ["ENDS_HELD"]);
}

#[test]
fn quiet_is_silent_even_about_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let output = output.to_str().unwrap();
    let loud = run([SINGLE, output, "--ends", "hold"]).exits(0);
    assert!(loud.stderr.contains("warning: ") && loud.stderr.contains("[ENDS_HELD]"), "{}", loud.stderr);
    let quiet = run([SINGLE, output, "--ends", "hold", "-q"]).exits(0);
    assert_eq!((quiet.out(), quiet.stderr), (String::new(), String::new()));
}

/// Warnings name what concerns the very keys.
#[test]
fn warnings() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let check = |fixture: &str, options: &[&str], expected: &[&str]| {
        let input = format!("fixtures/keyframes/{fixture}.dat");
        let arguments = [&input, output.to_str().unwrap(), "--json"];
        let summary = run(arguments.iter().copied().chain(options.iter().copied())).exits(0).json();
        let warnings = summary["warnings"].as_array().unwrap().clone();
        let codes: Vec<&str> = warnings.iter().map(|w| w["code"].as_str().unwrap()).collect();
        assert_eq!(codes, expected, "{fixture} {options:?}");
        warnings.iter().map(|w| w["message"].as_str().unwrap()).collect::<Vec<_>>().join("\n")
    };
    check("chain-even", &[], &[]);
    check("chain-uneven", &[], &[]);
    let uneven = check("chain-uneven", &["--scheme", "squad"], &["UNEVEN_KEYS"]);
    assert!(uneven.contains("bessel"), "{uneven}");
    check("chain-uneven", &["--scheme", "catmull-rom"], &["UNEVEN_KEYS"]);
    let wraps = check("very-uneven", &["--scheme", "bessel-overhauser"], &["POWER_WRAPS", "LARGE_STEPS"]);
    assert!(wraps.contains("bessel") && wraps.contains("line"), "{wraps}");
    let steps = check("large-steps", &["--fps", "5"], &["LARGE_STEPS"]);
    assert!(steps.contains("--fps"), "{steps}");
    let order = check("scipy", &["--quat-order", "wxyz"], &["QUAT_ORDER"]);
    assert!(order.contains("--quat-order xyzw"), "{order}");
}

#[test]
fn standard_input_and_output() {
    let input = fs::read(keyframes("single-even")).unwrap();
    let piped = finish(program().args(["convert", "-", "-o", "-", "--json"]), &input).exits(0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("piped.glb");
    fs::write(&path, &piped.stdout).unwrap();
    let loaded = load(&path);
    assert_eq!(loaded.clips[0].name, "stdin");
    assert_eq!(loaded.clips[0].extras["inputs"][0]["name"], "stdin");
    // The .glb has standard output: the summary goes the other way.
    let summary: Value = serde_json::from_str(&piped.stderr).unwrap();
    assert_eq!((&summary["input"], &summary["bytes"]), (&json!("<stdin>"), &json!(piped.stdout.len())));
    run([SINGLE, path.to_str().unwrap()]).exits(0);
    assert!(load(&path).buffers == loaded.buffers);
    // The short form, and what is wrong with an input that has no name.
    let short = finish(program().args(["-", "-"]), &input).exits(0);
    assert_eq!(short.stdout, piped.stdout);
    finish(program().args(["-", "-"]), b"# 1\n0 1 0 0 0\n").exits(1).says(&["<stdin>:2:"]);
    finish(program().args(["convert", "-"]), &input).exits(2).says(&["-o OUT.glb"]);
}

#[test]
fn a_refused_input_writes_nothing_to_standard_output() {
    let ran = finish(program().args(["-", "-"]), b"# 1\n0 1 0 0 0\n0 1 0 0 0\n").exits(1);
    assert!(ran.stdout.is_empty());
}

#[test]
fn convert_may_be_left_out_and_the_output_too() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("swing.dat");
    fs::copy(keyframes("single-even"), &input).unwrap();
    run_in(folder.path(), ["swing.dat"]).exits(0);
    assert_eq!(names(folder.path()), ["swing.dat", "swing.glb"]);
    run_in(folder.path(), ["swing.dat", "other.glb"]).exits(0);
    run_in(folder.path(), ["convert", "swing.dat", "-o", "third.glb"]).exits(0);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("swing.glb") == bytes("other.glb") && bytes("swing.glb") == bytes("third.glb"));
}

#[test]
fn several_inputs_go_into_a_folder_and_a_bad_one_stops_none() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = [SINGLE, "fixtures/refused/nan.dat", "fixtures/keyframes/two-keys.dat"];
    let out = folder.path().join("new/folder");
    let arguments = [&["convert"], &inputs[..], &["-o", out.to_str().unwrap()]].concat();
    let ran = run(&arguments).exits(1).says(&["fixtures/refused/nan.dat:3:5: ", "two-keys.glb: 2 keys"]);
    assert!(ran.stdout.is_empty());
    assert_eq!(names(&out), ["single-even.glb", "two-keys.glb"]);
    assert_eq!(load(&out.join("two-keys.glb")).clips[0].name, "two-keys");
    let lines = run([&arguments[..], &["--json"]].concat()).exits(1).json_lines();
    assert_eq!(lines.iter().map(|line| &line["schema"]).collect::<Vec<_>>(), [1, 1, 1]);
    assert_eq!(lines.iter().map(|line| &line["input"]).collect::<Vec<_>>(), inputs);
    assert_eq!(lines[1]["exitCode"], 1);
    assert!(lines[1]["error"].as_str().unwrap().contains("expected a finite number"));
}

#[test]
fn several_inputs_without_a_folder_go_next_to_themselves() {
    let folder = tempfile::tempdir().unwrap();
    for (name, place) in [("two-keys", "a"), ("single-even", "b")] {
        fs::create_dir(folder.path().join(place)).unwrap();
        fs::copy(keyframes(name), folder.path().join(place).join("in.dat")).unwrap();
    }
    run_in(folder.path(), ["convert", "a/in.dat", "b/in.dat"]).exits(0);
    assert_eq!(names(&folder.path().join("a")), ["in.dat", "in.glb"]);
    assert_eq!(names(&folder.path().join("b")), ["in.dat", "in.glb"]);
    // Into one folder they would overwrite each other: nothing is done.
    let both = ["convert", "a/in.dat", "b/in.dat", "-o", "out"];
    run_in(folder.path(), both).exits(2).says(&["a/in.dat", "b/in.dat", "in.glb"]);
    assert!(!folder.path().join("out/in.glb").exists());
}

#[test]
fn the_worst_exit_code_counts() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let refused = "fixtures/refused/nan.dat";
    for inputs in [[refused, SINGLE], [SINGLE, refused]] {
        run(["convert", inputs[0], inputs[1], "-o", out]).exits(1);
    }
}

#[test]
fn command_lines_that_make_no_sense() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.glb");
    let out = out.to_str().unwrap();
    let check = |arguments: &[&str], words: &[&str]| {
        let ran = run(arguments).exits(2).says(words);
        assert!(ran.stdout.is_empty());
    };
    check(&["convert"], &["<IN>"]);
    check(&["convert", SINGLE, "-o", "x.obj"], &["x.obj", ".glb or .gltf"]);
    check(&["convert", SINGLE, SINGLE, "-o", "-"], &["-o FOLDER"]);
    check(&["convert", SINGLE, "-o", out, "--scheme", "spline"], &["spline", "bessel-overhauser"]);
    check(&["convert", SINGLE, "-o", out, "--ends", "open"], &["natural"]);
    check(&["convert", SINGLE, "-o", out, "--fps", "0"], &["frames per second"]);
    check(&["convert", SINGLE, "-o", out, "--quat-order", "zyxw"], &["wxyz", "xyzw"]);
    check(&["convert", SINGLE, "-o", out, "--bogus"], &["--bogus"]);
    check(&["chek", "x.glb"], &["chek"]);
    assert!(names(folder.path()).is_empty());
}

#[test]
fn without_arguments_four_commands_are_shown() {
    let ran = run::<&str>([]).exits(2);
    assert!(ran.stdout.is_empty());
    let commands =
        ran.stderr.lines().filter(|line| line.trim_start().starts_with("dat2glb ") && line.starts_with("  "));
    assert_eq!(commands.count(), 4, "{}", ran.stderr);
}

#[test]
fn inputs_that_are_not_there() {
    let folder = tempfile::tempdir().unwrap();
    run_in(folder.path(), ["nothing.dat"]).exits(1).says(&["nothing.dat: expected a file, found none"]);
    fs::create_dir(folder.path().join("sub")).unwrap();
    run_in(folder.path(), ["convert", "sub"]).exits(1).says(&["sub: expected a file, found a directory"]);
    assert_eq!(names(folder.path()), ["sub"]);
}

#[test]
fn every_good_fixture_passes_the_strictest_check() {
    let folder = tempfile::tempdir().unwrap();
    for name in good() {
        let (input, output) = (keyframes(&name), folder.path().join(format!("{name}.glb")));
        let (input, output) = (input.to_str().unwrap(), output.to_str().unwrap());
        // At 240 frames a second the wildest of them have steps of more than 18 degrees.
        run([input, output, "--scheme", "all", "--fps", "480", "-q"]).exits(0);
        let ran = run(["check", "--strict", output, "--against", input]).exits(0);
        let last = ran.out().lines().last().unwrap().to_owned();
        assert!(last.ends_with(": 0 errors, 0 warnings, 0 infos"), "{}", ran.out());
    }
}

#[test]
fn tension_continuity_and_bias_are_kept_for_later_checks() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let output = output.to_str().unwrap();
    let (scheme, tension) = (["--scheme", "kochanek-bartels"], ["--tension", "-0.5", "--bias", "1"]);
    let options = [&scheme[..], &tension, &["-q"]].concat();
    run([&[SINGLE, output], &options[..]].concat()).exits(0);
    run(["check", output, "--against", SINGLE]).exits(0);
    // Another curve: neither plain nor by default.
    run([&[SINGLE, output][..], &scheme, &["-q"]].concat()).exits(0);
    let plain = std::fs::read(output).unwrap();
    run([&[SINGLE, output], &options[..]].concat()).exits(0);
    assert_ne!(std::fs::read(output).unwrap(), plain);
    run([&[SINGLE, output][..], &tension].concat()).exits(2).says(&["--scheme kochanek-bartels"]);
    run([SINGLE, output, "--tension", "2"]).exits(2).says(&["from -1 to 1"]);
}

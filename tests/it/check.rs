//! `dat2glb check`: what it finds in our own files, in altered and in others' files.

use crate::support::altered::{Glb, turn};
use crate::support::tool::{Ran, run, run_in};
use crate::support::{keyframes, read_clip};
use serde_json::json;
use std::fs;
use std::path::PathBuf;

/// A folder with in.dat, and out.glb made of it.
struct Made {
    folder: tempfile::TempDir,
}

impl Made {
    fn new(fixture: &str, options: &[&str]) -> Made {
        let made = Made { folder: tempfile::tempdir().unwrap() };
        fs::copy(keyframes(fixture), made.path("in.dat")).unwrap();
        made.run(&[&["in.dat", "out.glb", "-q"], options].concat()).exits(0);
        made
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Ran {
        run_in(self.folder.path(), arguments)
    }

    fn glb(&self) -> Glb {
        Glb::read(&self.path("out.glb"))
    }

    /// Writes out.glb again after a change.
    fn alter(&self, change: impl FnOnce(&mut Glb)) {
        let mut glb = self.glb();
        change(&mut glb);
        glb.write(&self.path("out.glb"));
    }

    /// The codes that a check of out.glb finds.
    #[track_caller]
    fn codes(&self, options: &[&str], exit: i32) -> Vec<String> {
        let report = self.run(&[&["check", "out.glb", "--json"], options].concat()).exits(exit).json();
        assert_eq!((&report["schema"], &report["file"]), (&json!(1), &json!("out.glb")));
        let findings = report["findings"].as_array().unwrap();
        findings.iter().map(|finding| finding["code"].as_str().unwrap().to_owned()).collect()
    }
}

const AGAINST: [&str; 2] = ["--against", "in.dat"];

#[test]
fn our_own_files_are_clean() {
    let made = Made::new("chain-even", &["--scheme", "all"]);
    for options in [&[][..], &["--strict"], &["--strict", "--against", "in.dat"]] {
        let ran = made.run(&[&["check", "out.glb"], options].concat()).exits(0);
        assert!(ran.out().ends_with("out.glb: 0 errors, 0 warnings, 0 infos\n"), "{}", ran.out());
        assert_eq!(ran.stderr, "");
    }
    let quiet = made.run(&["check", "-q", "out.glb"]).exits(0);
    assert_eq!((quiet.out(), quiet.stderr), (String::new(), String::new()));
}

/// What this file does to a .glb in order to alter it changes nothing by itself.
#[test]
fn taking_a_file_apart_and_together_keeps_it_clean() {
    let made = Made::new("single-even", &[]);
    made.alter(|_| ());
    assert!(made.codes(&["--strict", "--against", "in.dat"], 0).is_empty());
}

#[test]
fn every_box_of_every_clip_is_compared_at_keys_samples_and_between() {
    let made = Made::new("chain-uneven", &["--scheme", "slerp,bessel", "--ends", "clamped"]);
    let report = made.run(&["check", "out.glb", "--json", "--against", "in.dat"]).exits(0).json();
    let keys = read_clip(&keyframes("chain-uneven")).times.len();
    let clips = report["motion"].as_array().unwrap();
    assert_eq!(clips.len(), 2);
    for (clip, scheme) in clips.iter().zip(["slerp", "bessel"]) {
        assert_eq!((&clip["scheme"], &clip["ends"]), (&json!(scheme), &json!("clamped")));
        let boxes = clip["boxes"].as_array().unwrap();
        assert_eq!(boxes.len(), 4);
        for (i, found) in boxes.iter().enumerate() {
            assert_eq!(found["node"], format!("box{}", i + 1));
            assert_eq!(found["keys"]["compared"], keys);
            let limit = found["limit"].as_f64().unwrap();
            for kind in ["keys", "samples", "between"] {
                let degrees = found[kind]["off"].as_f64().unwrap();
                assert!(degrees > 0.0 && degrees < limit, "{kind} {degrees} {limit}");
                assert!(found[kind]["time"].as_f64().unwrap() >= 0.0);
            }
            assert!(found["samples"]["off"].as_f64().unwrap() < 3e-5);
        }
    }
    // For people the same, a line a box.
    let text = made.run(&["check", "out.glb", "--against", "in.dat"]).exits(0).out();
    assert_eq!(text.lines().filter(|line| line.contains("between ")).count(), 8, "{text}");
}

/// Half a degree in one sample of one box is found, and named.
#[test]
fn an_altered_motion_fails_the_comparison_and_nothing_else() {
    let made = Made::new("chain-even", &[]);
    made.alter(|glb| turn(glb.rotation(2, 300), 0.5));
    assert!(made.codes(&[], 0).is_empty());
    assert_eq!(made.codes(&AGAINST, 3), ["MOTION_DIFFERS"]);
    let text = made.run(&["check", "out.glb", "--against", "in.dat"]).exits(3).out();
    assert!(text.contains("error MOTION_DIFFERS at /animations/0") && text.contains("node box3"), "{text}");
    assert!(text.contains("up to 0.499999° off the curve, at 5.000000 s"), "{text}");
    // A limit of one's own counts instead of the stored one.
    assert!(made.codes(&["--against", "in.dat", "--max-error", "0.6"], 0).is_empty());
}

#[test]
fn a_single_changed_number_is_found() {
    let made = Made::new("chain-even", &[]);
    made.alter(|glb| glb.rotation(0, 123)[..4].copy_from_slice(&0.9f32.to_le_bytes()));
    let codes = made.codes(&AGAINST, 3);
    assert!(
        codes.contains(&"MOTION_DIFFERS".into()) && codes.contains(&"ROTATION_NOT_UNIT".into()),
        "{codes:?}"
    );
}

#[test]
fn a_limit_may_be_set_and_needs_something_to_compare_with() {
    let made = Made::new("chain-even", &[]);
    assert!(made.codes(&["--against", "in.dat", "--max-error", "0.05"], 0).is_empty());
    let tight = made.codes(&["--against", "in.dat", "--max-error", "0.000001"], 3);
    assert_eq!(tight, ["MOTION_DIFFERS"; 4]);
    made.run(&["check", "out.glb", "--max-error", "1"]).exits(2).says(&["--against"]);
    made.run(&["check", "out.glb", "--against", "in.dat", "--max-error", "nan"]).exits(2).says(&["degrees"]);
}

#[test]
fn an_input_that_was_changed_is_a_warning_and_compared_all_the_same() {
    let made = Made::new("two-keys", &[]);
    let text = fs::read_to_string(made.path("in.dat")).unwrap();
    fs::write(made.path("in.dat"), format!("{text}# a comment more\n")).unwrap();
    assert_eq!(made.codes(&AGAINST, 0), ["INPUT_CHANGED"]);
    made.codes(&["--against", "in.dat", "--strict"], 3);
    // A key that moved fails the comparison.
    assert!(text.contains("\n2.000000 "), "{text}");
    fs::write(made.path("in.dat"), text.replace("\n2.000000 ", "\n2.100000 ")).unwrap();
    let codes = made.codes(&AGAINST, 3);
    assert_eq!(codes, ["INPUT_CHANGED", "MOTION_DIFFERS", "MOTION_DIFFERS"]);
}

/// As files are that Blender or gltfpack wrote again.
#[test]
fn a_file_without_extras_needs_to_be_told_its_scheme() {
    let made = Made::new("chain-even", &["--scheme", "squad", "--ends", "clamped"]);
    made.alter(|glb| {
        glb.json["animations"][0].as_object_mut().unwrap().remove("extras").unwrap();
    });
    let ran = made.run(&["check", "out.glb", "--against", "in.dat"]).exits(2);
    ran.says(&["--scheme", "--ends", "by name"]);
    let told = ["--against", "in.dat", "--scheme", "squad", "--ends", "clamped"];
    // Without a limit the comparison only reports.
    assert!(made.codes(&told, 0).is_empty());
    assert!(made.codes(&[&told[..], &["--max-error", "0.05"]].concat(), 0).is_empty());
    let wrong = ["--against", "in.dat", "--scheme", "slerp", "--max-error", "0.05"];
    assert_eq!(made.codes(&wrong, 3), ["MOTION_DIFFERS"; 4]);
    // Nodes are found by name.
    made.alter(|glb| glb.json["nodes"][2]["name"] = "Cube.001".into());
    let ran = made.run(&[&["check", "out.glb"], &told[..]].concat()).exits(3);
    assert!(ran.out().contains("expected a node named box2"), "{}", ran.out());
}

#[test]
fn the_order_of_the_parts_is_remembered() {
    let made = Made::new("mixed-signs", &["--quat-order", "xyzw"]);
    assert!(made.codes(&AGAINST, 0).is_empty());
    assert!(
        made.codes(&["--against", "in.dat", "--quat-order", "wxyz"], 3).contains(&"MOTION_DIFFERS".into())
    );
}

/// Every finding of a broken file is printed, not the first alone.
#[test]
fn all_findings_are_printed_with_their_places() {
    let made = Made::new("two-keys", &[]);
    made.alter(|glb| {
        turn(glb.rotation(0, 7), 360.0);
        glb.rotation(0, 3)[12..].copy_from_slice(&f32::NAN.to_le_bytes());
        glb.json["animations"][0]["channels"][1]["target"]["node"] = 99.into();
        let sampler = glb.json["animations"][0]["samplers"][0]["input"].as_u64().unwrap() as usize;
        glb.json["accessors"][sampler]["max"][0] = 7.5.into();
    });
    let report = made.run(&["check", "out.glb", "--json"]).exits(3).json();
    let findings = report["findings"].as_array().unwrap();
    let of = |code: &str| {
        findings.iter().find(|f| f["code"] == code).unwrap_or_else(|| panic!("{code}: {report}"))
    };
    assert_eq!(of("INDEX_OUT_OF_RANGE")["pointer"], "/animations/0/channels/1/target/node");
    assert!(of("MIN_MAX_WRONG")["pointer"].as_str().unwrap().starts_with("/accessors/"));
    assert_eq!(of("NOT_FINITE")["severity"], "error");
    assert_eq!(of("ROTATION_SIGN_FLIP")["severity"], "warning");
    assert!(findings.iter().all(|f| !f["message"].as_str().unwrap().is_empty()));
    assert_eq!(report["errors"], findings.iter().filter(|f| f["severity"] == "error").count());
    let text = made.run(&["check", "out.glb"]).exits(3).out();
    assert_eq!(text.lines().count(), findings.len() + 1, "{text}");
}

#[test]
fn warnings_fail_where_the_check_is_strict() {
    let made = Made::new("large-steps", &["--fps", "4"]);
    assert_eq!(made.codes(&[], 0), ["ROTATION_LARGE_STEP"; 2]);
    assert_eq!(made.codes(&["--strict"], 3), ["ROTATION_LARGE_STEP"; 2]);
}

#[test]
fn what_is_no_gltf_cannot_be_read() {
    let made = Made::new("two-keys", &[]);
    made.run(&["check", "in.dat"]).exits(1).says(&["error: in.dat: "]);
    made.run(&["check", "none.glb"]).exits(1).says(&["error: none.glb: expected a file"]);
    made.run(&["check", "out.glb", "--against", "none.dat"]).exits(1).says(&["none.dat"]);
    let bytes = fs::read(made.path("out.glb")).unwrap();
    fs::write(made.path("cut.glb"), &bytes[..bytes.len() - 100]).unwrap();
    let cut = made.run(&["check", "cut.glb"]).exits(3);
    assert!(cut.out().contains("GLB_TRUNCATED"), "{}", cut.out());
}

#[test]
fn of_several_files_the_worst_counts_and_all_are_told() {
    let made = Made::new("two-keys", &[]);
    fs::copy(made.path("out.glb"), made.path("good.glb")).unwrap();
    made.alter(|glb| glb.rotation(0, 1).fill(0));
    for (files, exit) in [
        (&["good.glb", "good.glb"][..], 0),
        (&["good.glb", "in.dat"], 1),
        (&["in.dat", "out.glb", "good.glb"], 3),
        (&["out.glb", "good.glb", "in.dat"], 3),
    ] {
        let lines = made.run(&[&["check", "--json"], files].concat()).exits(exit).json_lines();
        let told: Vec<&str> =
            lines.iter().map(|line| line["file"].as_str().or(line["input"].as_str()).unwrap()).collect();
        assert_eq!(told, files);
        assert!(lines.iter().all(|line| line["schema"] == 1));
    }
}

/// As it is told of `check FILE --render`: is anything there, and does it move?
#[cfg(feature = "render")]
#[test]
fn a_look_finds_what_is_invisible_and_what_stands_still() {
    let look = ["--render", "--renderer", "cpu"];
    let made = Made::new("chain-even", &[]);
    assert!(made.codes(&look, 0).is_empty());
    let flat = made.glb();
    made.alter(|glb| glb.json["nodes"][0]["scale"] = json!([0, 0, 0]));
    let codes = made.codes(&look, 3);
    assert!(codes.contains(&"NOTHING_VISIBLE".into()), "{codes:?}");
    flat.write(&made.path("out.glb"));
    // Nothing hangs on what moves.
    made.alter(|glb| {
        for node in glb.json["nodes"].as_array_mut().unwrap().iter_mut().skip(1) {
            node.as_object_mut().unwrap().remove("mesh");
        }
        glb.json["nodes"][0]["mesh"] = 0.into();
    });
    assert_eq!(made.codes(&look, 0), ["NOTHING_MOVES"]);
    made.codes(&[&look[..], &["--strict"]].concat(), 3);
}

#[test]
fn the_help_names_every_flag_of_the_comparison() {
    let help = run(["check", "--help"]).exits(0).out();
    for flag in ["--against", "--max-error", "--scheme", "--ends", "--quat-order", "--strict", "--json"] {
        assert!(help.contains(flag), "{flag}");
    }
}

#[cfg(unix)]
#[test]
fn a_reader_who_leaves_takes_nothing_from_the_exit_code() {
    use crate::support::tool::program;
    let folder = tempfile::tempdir().unwrap();
    let (bad, input) = (folder.path().join("bad.glb"), keyframes("single-even"));
    run(["convert", input.to_str().unwrap(), "-o", bad.to_str().unwrap()]).exits(0);
    let mut glb = Glb::read(&bad);
    glb.json["animations"][0]["channels"][0]["target"]["node"] = json!(99);
    glb.write(&bad);
    let closed = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        writer
    };
    for (arguments, code) in
        [(&["check", bad.to_str().unwrap()][..], 3), (&["convert"], 2), (&["--help"], 0), (&[], 2)]
    {
        let status = program().args(arguments).stdout(closed()).stderr(closed()).status().unwrap();
        assert_eq!(status.code(), Some(code), "{arguments:?}");
    }
}

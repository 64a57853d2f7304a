//! `dat2glb diff`: two files, whatever made them.

use crate::support::altered::{Glb, turn};
use crate::support::keyframes;
use crate::support::tool::{Ran, run_in};
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;

/// A folder with a.glb, made of a fixture, and b.glb, the same after a change.
struct Two {
    folder: tempfile::TempDir,
}

impl Two {
    fn new(change: impl FnOnce(&mut Glb)) -> Two {
        let two = Two { folder: tempfile::tempdir().unwrap() };
        let input = keyframes("chain-even");
        two.run(&["convert", input.to_str().unwrap(), "-o", "a.glb", "-q"]).exits(0);
        let mut glb = Glb::read(&two.path("a.glb"));
        change(&mut glb);
        glb.write(&two.path("b.glb"));
        two
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Ran {
        run_in(self.folder.path(), arguments)
    }

    fn diff(&self, options: &[&str]) -> Ran {
        self.run(&[&["diff", "a.glb", "b.glb"], options].concat())
    }

    fn json(&self, options: &[&str], exit: i32) -> Value {
        self.diff(&[&["--json"], options].concat()).exits(exit).json()
    }
}

/// The codes of a report's findings.
fn codes(report: &Value) -> Vec<&str> {
    report["findings"].as_array().unwrap().iter().map(|finding| finding["code"].as_str().unwrap()).collect()
}

/// What is largest by a measure.
#[track_caller]
fn largest<'a>(report: &'a Value, measure: &str) -> &'a Value {
    let found = report["largest"].as_array().unwrap().iter().find(|found| found["measure"] == measure);
    found.unwrap_or_else(|| panic!("no {measure} in {report}"))
}

#[test]
fn a_file_does_not_differ_from_itself() {
    let two = Two::new(|_| ());
    let report = two.json(&["--max-error", "0", "--max-distance", "0", "--strict"], 0);
    assert_eq!(report["largest"], json!([]));
    assert_eq!((&report["file"], &report["against"]), (&json!("b.glb"), &json!("a.glb")));
    let text = two.diff(&[]).exits(0).out();
    assert!(text.contains("clip chain-even (10 s): 5 nodes compared, 0 differ\n"), "{text}");
    assert_eq!(two.diff(&["-q"]).exits(0).out(), "");
}

/// Half a degree in one key of one box: that much locally, and what hangs on it moves.
#[test]
fn one_turned_key_is_found_with_its_node_and_time() {
    let two = Two::new(|glb| turn(glb.rotation(2, 300), 0.5));
    let report = two.json(&[], 0);
    let local = largest(&report, "localRotation");
    // float32 holds a turn to 1e-5 degrees.
    assert!((local["off"].as_f64().unwrap() - 0.5).abs() < 1e-5, "{local}");
    assert_eq!(local["node"], json!({"a": "box3", "b": "box3"}));
    assert_eq!(local["clip"], json!({"a": "chain-even", "b": "chain-even"}));
    assert!((local["time"].as_f64().unwrap() - 5.0).abs() < 1e-6, "{local}");
    // box4 hangs three units below and moves by 2 r sin(θ/2).
    let world = largest(&report, "worldTranslation");
    assert_eq!(world["node"]["a"], "box4");
    let lever = 2.0 * 3.0 * 0.25f64.to_radians().sin();
    assert!((world["off"].as_f64().unwrap() - lever).abs() < 1e-6, "{world} {lever}");

    let limited = two.json(&["--max-error", "0.1"], 3);
    assert_eq!(codes(&limited), ["DIFFERENCE_LIMIT"; 2]);
    assert!(two.json(&["--max-error", "0.51", "--max-distance", "0.03"], 0)["findings"] == json!([]));
    assert_eq!(codes(&two.json(&["--max-distance", "0.02"], 3)), ["DIFFERENCE_LIMIT"]);
    let text = two.diff(&["--max-error", "0.1"]).exits(3).out();
    assert!(
        text.contains(
            "error DIFFERENCE_LIMIT at /animations/0: clip chain-even: local rotation of node box3"
        )
    );
    assert!(text.contains("at 5.000000 s; at most 0.1° is allowed"), "{text}");
}

#[test]
fn a_coarser_file_strays_within_its_own_bound() {
    let two = Two::new(|_| ());
    let input = keyframes("chain-even");
    let made =
        two.run(&["convert", input.to_str().unwrap(), "-o", "b.glb", "--fps", "24", "--json"]).exits(0);
    let bound = made.json()["clips"][0]["deviationDegrees"].as_f64().unwrap();
    let off = largest(&two.json(&[], 0), "localRotation")["off"].as_f64().unwrap();
    // Both stray from one curve: the finer one by its own, smaller bound.
    assert!(off < 1.25 * bound && off > 0.75 * bound, "{off} {bound}");
}

#[test]
fn renamed_nodes_and_clips_need_a_map() {
    let two = Two::new(|glb| {
        glb.json["nodes"][2]["name"] = "Cube".into();
        glb.json["animations"][0]["name"] = "Take 001".into();
    });
    let report = two.json(&[], 0);
    assert_eq!(report["onlyInA"]["nodes"], json!(["box2"]));
    assert_eq!(report["onlyInB"]["nodes"], json!(["Cube"]));
    // The only clip of each file is the same clip, whatever its name.
    assert_eq!(codes(&report), ["ONLY_IN_ONE", "ONLY_IN_ONE", "MATCHED_OTHERWISE"]);
    assert_eq!(report["matchedOtherwise"][0]["by"], "alone");
    two.diff(&["--strict"]).exits(3);
    let mapped = ["--map", "box2=Cube", "--map", "chain-even=Take 001"];
    let report = two.json(&[&mapped[..], &["--strict", "--max-error", "0"]].concat(), 0);
    assert_eq!((codes(&report), &report["clips"][0]["nodes"][2]["node"]["b"]), (vec![], &json!("Cube")));
    two.diff(&["--map", "box2=Cubes"]).exits(2).says(&["--map", "b.glb", "`Cubes`"]);
    two.diff(&["--map", "box9=Cube"]).exits(2).says(&["a.glb", "`box9`"]);
    two.diff(&["--map", "box2"]).exits(2).says(&["two names"]);
}

#[test]
fn nodes_without_names_are_matched_by_their_path() {
    let two = Two::new(|glb| {
        for node in glb.json["nodes"].as_array_mut().unwrap() {
            node.as_object_mut().unwrap().remove("name");
        }
    });
    fs::copy(two.path("b.glb"), two.path("a.glb")).unwrap();
    let report = two.json(&["--strict", "--max-error", "0"], 0);
    assert_eq!(codes(&report), ["MATCHED_OTHERWISE"; 5]);
    assert_eq!(report["clips"][0]["nodes"][4]["node"]["a"], "node 4");
}

#[test]
fn a_longer_clip_is_compared_to_its_end() {
    let two = Two::new(|_| ());
    let input = keyframes("chain-even");
    two.run(&["convert", input.to_str().unwrap(), "-o", "b.glb", "--time-scale", "0.5", "-q"]).exits(0);
    let report = two.json(&[], 0);
    assert_eq!(report["clips"][0]["seconds"], json!({"a": 10.0, "b": 20.0}));
    assert_eq!(codes(&report), ["LENGTH_DIFFERS"]);
    assert!(largest(&report, "localRotation")["off"].as_f64().unwrap() > 10.0);
}

#[test]
fn files_without_common_clips_are_compared_at_rest() {
    let two = Two::new(|glb| {
        glb.json.as_object_mut().unwrap().remove("animations");
        glb.json["nodes"][0]["translation"] = json!([0, 0, 0.25]);
        glb.json["nodes"][1]["scale"] = json!([1, 2, 1]);
    });
    let report = two.json(&["--max-scale", "0.5"], 3);
    assert_eq!(codes(&report), ["DIFFERENCE_LIMIT", "ONLY_IN_ONE"]);
    assert_eq!(report["clips"][0]["animation"], Value::Null);
    assert_eq!(largest(&report, "localScale")["off"], 1.0);
    assert_eq!(report["onlyInA"]["clips"], json!(["chain-even"]));
    // Other clips on both sides are nothing in common, which is never what was meant.
    let two = Two::new(|glb| {
        let mut more = glb.json["animations"][0].clone();
        (glb.json["animations"][0]["name"], more["name"]) = ("walk".into(), "run".into());
        glb.json["animations"].as_array_mut().unwrap().push(more);
    });
    assert_eq!(codes(&two.json(&[], 3))[0], "NOTHING_IN_COMMON");
}

#[test]
fn what_cannot_be_played_is_refused() {
    let two = Two::new(|glb| glb.json["animations"][0]["channels"][1]["target"]["node"] = 99.into());
    two.diff(&[]).exits(1).says(&[
        "b.glb",
        "/animations/0/channels/1",
        "node does not exist",
        "dat2glb check",
    ]);
    let line = two.diff(&["--json"]).exits(1).json();
    assert_eq!((&line["input"], &line["exitCode"]), (&json!("b.glb"), &json!(1)));
    two.run(&["diff", "a.glb", "none.glb"]).exits(1).says(&["none.glb: expected a file"]);
    fs::write(two.path("text.glb"), "no glTF").unwrap();
    let ran =
        two.run(&["diff", "text.glb", "a.glb", "--json"]).exits(1).says(&["text.glb", "not a glTF 2.0 file"]);
    assert_eq!(ran.json()["input"], "text.glb");
    let two = Two::new(|glb| glb.rotation(0, 9)[4..8].copy_from_slice(&f32::NAN.to_le_bytes()));
    two.diff(&[]).exits(1).says(&["b.glb", "expected finite numbers"]);
}

#[test]
fn options_must_make_sense() {
    let two = Two::new(|_| ());
    two.diff(&["--max-error", "-1"]).exits(2);
    two.diff(&["--json", "--report", "text"]).exits(2);
    two.run(&["diff", "a.glb"]).exits(2);
    let help = two.run(&["diff", "--help"]).exits(0).out();
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in
        ["--map", "--max-error", "--max-distance", "--strict", "exit code is 0; above a limit it is 3"]
    {
        assert!(help.contains(words), "{words}");
    }
}

#[cfg(feature = "render")]
mod picture {
    use super::*;
    use image::{GenericImageView, Rgba, RgbaImage};

    const SMALL: [&str; 6] = ["--picture", "out.png", "--size", "96x64", "--renderer", "cpu"];

    /// The two halves of out.png.
    fn halves(two: &Two) -> (RgbaImage, RgbaImage) {
        let picture = image::open(two.path("out.png")).unwrap().to_rgba8();
        assert_eq!(picture.dimensions(), (2 * 96 + 2, 64));
        (picture.view(0, 0, 96, 64).to_image(), picture.view(98, 0, 96, 64).to_image())
    }

    /// Pixels that are coloured, as boxes are and the background is not.
    fn coloured(picture: &RgbaImage) -> usize {
        let grey = |&Rgba([r, g, b, _]): &Rgba<u8>| r.abs_diff(g) < 8 && g.abs_diff(b) < 8;
        picture.pixels().filter(|pixel| !grey(pixel)).count()
    }

    #[test]
    fn the_same_pose_is_drawn_twice_the_same() {
        let two = Two::new(|_| ());
        two.diff(&SMALL).exits(0);
        let (left, right) = halves(&two);
        assert_eq!(left, right);
        assert!(coloured(&left) > 300, "{}", coloured(&left));
    }

    #[test]
    fn one_camera_sees_both_poses() {
        // From 5 s on, the whole chain of the second file hangs elsewhere.
        let two = Two::new(|glb| (300..601).for_each(|key| turn(glb.rotation(0, key), 90.0)));
        two.diff(&[&SMALL[..], &["--max-error", "1"]].concat()).exits(3);
        let (left, right) = halves(&two);
        let differing = left.pixels().zip(right.pixels()).filter(|(a, b)| a != b).count();
        assert!(differing > 300, "{differing}");
        // Each half is as wide as both poses together: neither is cut or fills it alone.
        for half in [&left, &right] {
            assert!(coloured(half) > 100, "{}", coloured(half));
            let edge = (0..64).all(|y| coloured(&half.view(0, y, 1, 1).to_image()) == 0);
            assert!(edge, "the pose reaches the picture's edge");
        }
    }

    #[test]
    fn a_picture_is_a_file_of_its_own() {
        let two = Two::new(|_| ());
        two.diff(&["--picture", "a.glb"]).exits(2).says(&["a.glb", "no input"]);
        two.diff(&["--picture", "-"]).exits(2).says(&["--picture"]);
        two.diff(&["--size", "9x9"]).exits(2).says(&["--picture"]);
    }
}

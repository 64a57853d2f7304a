//! `dat2glb reduce`: the program over our own files; what other files go through is
//! tested beside the code.

use crate::support::loaded::{Clip, angle, load};
use crate::support::tool::{Ran, names, run_in};
use crate::support::{fixtures, keyframes};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder with in.glb, a clip for each scheme.
struct Made {
    folder: tempfile::TempDir,
}

impl Made {
    fn new(fixture: &str, output: &str, options: &[&str]) -> Made {
        let made = Made { folder: tempfile::tempdir().unwrap() };
        let input = keyframes(fixture);
        made.run(&[&[input.to_str().unwrap(), output, "-q"], options].concat()).exits(0);
        made
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Ran {
        run_in(self.folder.path(), arguments)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }
}

/// The largest angle between two clips, degrees, played by another crate's numbers at
/// times that are hardly any key's.
fn apart(a: &Clip, b: &Clip) -> f64 {
    let mut worst: f64 = 0.0;
    for (a, b) in a.channels.iter().zip(&b.channels) {
        assert_eq!(a.node, b.node);
        assert_eq!(a.times.last(), b.times.last());
        let end = f64::from(a.times[a.times.len() - 1]);
        for i in 0..=4000 {
            let t = end * f64::from(i) / 3999.5;
            worst = worst.max(angle(a.play(t), b.play(t)));
        }
    }
    worst
}

fn largest(before: &Path, after: &Path) -> f64 {
    let (before, after) = (load(before), load(after));
    assert_eq!(before.clips.len(), after.clips.len());
    before.clips.iter().zip(&after.clips).map(|(a, b)| apart(a, b)).fold(0.0, f64::max)
}

#[test]
fn few_keys_play_within_the_tolerance() {
    let made = Made::new("chain-even", "in.glb", &["--scheme", "slerp,bessel"]);
    for (tolerance, on_curve) in [(0.1, false), (0.01, false), (0.1, true)] {
        let text = tolerance.to_string();
        let more: &[&str] = if on_curve { &["--on-curve"] } else { &[] };
        let line = [&["reduce", "in.glb", "-o", "out.glb", "--json", "--tolerance", &text], more].concat();
        let summary = made.run(&line).exits(0).json();
        assert_eq!(
            (&summary["schema"], &summary["clips"][1]["name"]),
            (&1.into(), &"chain-even-bessel".into())
        );
        let stated = summary["deviation"]["degrees"].as_f64().unwrap();
        let measured = largest(&made.path("in.glb"), &made.path("out.glb"));
        // The angles are measured to about 1e-7°; the bound is at most 5 % above.
        assert!(measured <= stated + 1e-6 && stated <= tolerance, "{measured} {stated}");
        assert!(stated <= 1.06 * measured, "{measured} {stated}");
        let keys = |place: &str| summary["clips"][1][place].as_u64().unwrap();
        let share = keys("keysAfter") as f64 / keys("keysBefore") as f64;
        assert!(share < if tolerance < 0.1 { 0.7 } else { 0.3 }, "{share}");
        for (place, file) in [("bytesBefore", "in.glb"), ("bytesAfter", "out.glb")] {
            assert_eq!(summary[place], made.read(file).len());
        }
        made.run(&["check", "out.glb"]).exits(0);
    }
}

#[test]
fn many_keys_are_walked_through_once() {
    // 50,001 keys a box; fewer than 16,385 are searched otherwise.
    let made = Made::new("chain-even", "in.glb", &["--scheme", "bessel", "--fps", "5000"]);
    for tolerance in ["0.05", "0.0005"] {
        for more in [&[][..], &["--on-curve"], &["--max-step", "3"]] {
            let line = ["reduce", "in.glb", "-o", "out.glb", "--json", "--tolerance", tolerance];
            let summary = made.run(&[&line[..], more].concat()).exits(0).json();
            let keys = |place: &str| summary["clips"][0][place].as_u64().unwrap();
            assert!(keys("keysBefore") > 4 * 16_384, "{summary}");
            assert!(keys("keysAfter") < keys("keysBefore") / 15, "{summary}");
            let stated = summary["deviation"]["degrees"].as_f64().unwrap();
            let measured = largest(&made.path("in.glb"), &made.path("out.glb"));
            assert!(measured <= stated + 1e-6 && stated <= tolerance.parse().unwrap(), "{measured} {stated}");
            assert!(stated <= 1.1 * measured, "{measured} {stated}");
            made.run(&["check", "out.glb"]).exits(0);
        }
    }
}

#[test]
fn twice_is_once_and_little_says_so() {
    let made = Made::new("chain-even", "in.glb", &[]);
    let said = made.run(&["reduce", "in.glb", "-o", "out.glb", "--tolerance", "0.1"]).exits(0);
    said.says(&["chain-even: 2404 → ", " keys, max error 0.0", "out.glb: "]);
    let again = made.run(&["reduce", "out.glb", "-o", "again.glb", "--tolerance", "0.1"]).exits(0);
    again.says(&["nothing could be saved"]);
    assert!(made.read("out.glb") == made.read("again.glb"));
    let piped = made.run(&["reduce", "in.glb", "-o", "-", "--tolerance", "0.1", "-q"]).exits(0);
    assert!(piped.stdout == made.read("out.glb"));
}

#[test]
fn paths_keep_their_places_but_for_what_is_allowed() {
    let made = Made { folder: tempfile::tempdir().unwrap() };
    let flight = fixtures().join("paths/flight.dat");
    made.run(&[flight.to_str().unwrap(), "in.gltf", "-q"]).exits(0);
    let line = ["reduce", "in.gltf", "-o", "out.gltf", "--tolerance", "0.1", "--json"];
    let exact = made.run(&line).exits(0).json();
    assert!(exact["deviation"]["units"].as_f64().unwrap() < 1e-5);
    let loose = made.run(&[&line[..], &["--tolerance-distance", "0.01"]].concat()).exits(0).json();
    let units = loose["deviation"]["units"].as_f64().unwrap();
    assert!(units <= 0.01 && units > 0.001, "{units}");
    let bytes = |summary: &serde_json::Value| summary["bytesAfter"].as_u64().unwrap();
    assert!(bytes(&loose) < bytes(&exact));
    // Of several runs one .bin is left, and the input keeps its own.
    let left = names(made.folder.path());
    let of = |stem: &str| left.iter().filter(|name| name.starts_with(stem) && name.ends_with(".bin")).count();
    assert_eq!((of("out."), of("in.")), (1, 1), "{left:?}");
    made.run(&["check", "out.gltf"]).exits(0);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let made = Made::new("chain-even", "in.gltf", &[]);
    let reduce = |more: &[&str]| made.run(&[&["reduce", "in.gltf"], more].concat());
    reduce(&["-o", "out.gltf"]).exits(2).says(&["--tolerance"]);
    reduce(&["-o", "out.gltf", "--tolerance", "0.00001"]).exits(2).says(&["expected", "2e-5", "found"]);
    reduce(&["-o", "out.gltf", "--tolerance", "-1"]).exits(2);
    reduce(&["-o", "out.gltf", "--tolerance", "nan"]).exits(2);
    reduce(&["-o", "out.glb", "--tolerance", "1"]).exits(2).says(&["out.glb", "ends in .gltf"]);
    reduce(&["-o", "in.gltf", "--tolerance", "1"]).exits(2).says(&["input"]);
    reduce(&["-o", "-", "--tolerance", "1"]).exits(2).says(&["use -o"]);
    // A picture that the output would not find.
    let text = String::from_utf8(made.read("in.gltf")).unwrap();
    let pictured = text.replacen('{', "{\"images\":[{\"uri\":\"a%20picture.png\"}],", 1);
    fs::write(made.path("pictured.gltf"), pictured).unwrap();
    fs::write(made.path("a picture.png"), b"png").unwrap();
    fs::create_dir(made.path("other")).unwrap();
    let said = made.run(&["reduce", "pictured.gltf", "-o", "other/out.gltf", "--tolerance", "1"]);
    said.exits(2).says(&["a picture.png", "copy"]);
    assert!(names(&made.path("other")).is_empty());
    made.run(&["reduce", "pictured.gltf", "-o", "out.gltf", "--tolerance", "1"]).exits(0);
    made.run(&["reduce", "gone.glb", "-o", "out.glb", "--tolerance", "1"]).exits(1).says(&["gone.glb"]);
}

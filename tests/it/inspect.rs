//! `dat2glb inspect`: what a file holds, for people and for programs.

use crate::support::tool::{finish, program, run, run_in};
use crate::support::{fixtures, keyframes};
use serde_json::{Value, json};
use std::fs;

/// Some members of an object.
fn check(found: &Value, expected: Value) {
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(found[name], *value, "{name} of {found}");
    }
}

#[test]
fn keyframes_as_json() {
    let found = run(["inspect", "fixtures/keyframes/very-uneven.dat", "--json"]).exits(0).json();
    let bytes = fs::read(keyframes("very-uneven")).unwrap();
    let expected = json!({
        "schema": 1, "file": "fixtures/keyframes/very-uneven.dat", "kind": "keyframes", "boxes": 2, "length": 2.0,
        "quatOrder": "wxyz", "keys": 10, "start": 0.0, "bytes": bytes.len(), "warnings": [],
        "blake3": blake3::hash(&bytes).to_hex().to_string(),
    });
    check(&found, expected);
    let near =
        |value: &Value, expected: f64| assert!((value.as_f64().unwrap() - expected).abs() < 1e-9, "{value}");
    near(&found["seconds"], 6.8);
    near(&found["shortestGap"]["value"], 0.15);
    assert_eq!(found["shortestGap"]["line"], 7);
    near(&found["longestGap"]["value"], 1.5);
    assert_eq!(found["longestGap"]["line"], 8);
    let turn = found["largestTurn"]["value"].as_f64().unwrap();
    assert!((100.0..160.0).contains(&turn), "{turn}");
    assert!(found["largestNormError"].as_f64().unwrap() < 1e-5);
}

#[test]
fn keyframes_in_words() {
    let text = run(["inspect", "fixtures/keyframes/late-start.dat"]).exits(0).out();
    for words in
        ["chain", "boxes: 2, each 2 long", "keys: 10, from 12.5 s, 6.3 s long", "wxyz", "largest turn: "]
    {
        assert!(text.contains(words), "{words} not in:\n{text}");
    }
    let free = run(["inspect", "fixtures/keyframes/body-free.dat"]).exits(0).out();
    assert!(free.contains("keyframes of a free body"), "{free}");
}

#[test]
fn standard_input_holds_keyframes() {
    let text = fs::read(keyframes("xyzw")).unwrap();
    let piped = finish(program().args(["inspect", "-", "--json"]), &text).exits(0).json();
    check(&piped, json!({ "file": "-", "boxes": 1, "keys": 13, "quatOrder": "xyzw" }));
    let other =
        finish(program().args(["inspect", "-", "--json", "--quat-order", "wxyz"]), &text).exits(0).json();
    check(&other, json!({ "quatOrder": "wxyz" }));
}

#[test]
fn gltf_of_both_kinds_as_json() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["glb", "gltf"] {
        let file = format!("out.{kind}");
        let input = keyframes("chain-even");
        let scheme = "--scheme=bessel,slerp";
        run_in(folder.path(), [input.to_str().unwrap(), &file, scheme]).exits(0);
        let found = run_in(folder.path(), ["inspect", &file, "--json"]).exits(0).json();
        let generator = concat!("dat2glb ", env!("CARGO_PKG_VERSION"));
        check(
            &found,
            json!({ "schema": 1, "file": file, "kind": kind, "version": "2.0", "generator": generator }),
        );
        let tree: Vec<(&str, u64)> = found["tree"]
            .as_array()
            .unwrap()
            .iter()
            .map(|node| (node["name"].as_str().unwrap(), node["depth"].as_u64().unwrap()))
            .collect();
        assert_eq!(tree, [("root", 0), ("box1", 1), ("box2", 2), ("box3", 3), ("box4", 4)]);
        let clips = found["clips"].as_array().unwrap();
        for (clip, name) in clips.iter().zip(["chain-even-bessel", "chain-even-slerp"]) {
            let interpolations = json!({ "LINEAR": 4 });
            check(
                clip,
                json!({ "name": name, "channels": 4, "keys": 601, "duration": 10.0, "interpolations": interpolations }),
            );
        }
        let files = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap());
        let ours = files.filter(|entry| {
            let name = entry.file_name().into_string().unwrap();
            name == file || (kind == "gltf" && name.ends_with(".bin"))
        });
        let total: u64 = ours.map(|entry| entry.metadata().unwrap().len()).sum();
        let bytes = &found["bytes"];
        assert_eq!(bytes["total"], total);
        let parts = bytes.as_object().unwrap().iter().filter(|(name, _)| *name != "total");
        assert_eq!(parts.map(|(_, bytes)| bytes.as_u64().unwrap()).sum::<u64>(), total);
    }
}

#[test]
fn gltf_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let input = keyframes("chain-even");
    run_in(folder.path(), [input.to_str().unwrap(), "out.glb"]).exits(0);
    let text = run_in(folder.path(), ["inspect", "out.glb"]).exits(0).out();
    for words in
        ["glTF 2.0 (.glb)", "\n        box3 [mesh]\n", "chain-even: 4 channels, 601 keys, 10 s, 4 LINEAR"]
    {
        assert!(text.contains(words), "{words:?} not in:\n{text}");
    }
}

#[test]
fn what_cannot_be_read_is_refused_as_elsewhere() {
    let expected = fs::read_to_string(fixtures().join("refused/nan.expect")).unwrap();
    assert_eq!(run(["inspect", "fixtures/refused/nan.dat"]).exits(1).stderr, expected);
    run(["inspect", "none.dat"]).exits(1).says(&["none.dat: expected a file, found none"]);
    run(["inspect", "fixtures/refused/gzip.dat"]).exits(1).says(&["fixtures/refused/gzip.dat:1:2: "]);
}

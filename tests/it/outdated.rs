//! `convert --check`: is an output what its inputs and options give?

use crate::support::keyframes;
use crate::support::tool::run;
use std::fs;
use std::path::{Path, PathBuf};

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A folder with an input and what it becomes by some options.
fn made(options: &[&str], output: &str) -> (tempfile::TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let (input, output) = (folder.path().join("in.dat"), folder.path().join(output));
    fs::copy(keyframes("chain-uneven"), &input).unwrap();
    run(["convert", text(&input), "-o", text(&output)].iter().chain(options)).exits(0);
    (folder, input, output)
}

fn check(input: &Path, output: &Path, options: &[&str]) -> crate::support::tool::Ran {
    run(["convert", text(input), "-o", text(output), "--check"].iter().chain(options))
}

#[test]
fn what_was_just_made_is_up_to_date() {
    for options in
        [&[][..], &["--scheme", "all"], &["--tolerance", "0.05"], &["--quantize", "--ends", "hold"]]
    {
        for name in ["out.glb", "out.gltf"] {
            let (_folder, input, output) = made(options, name);
            let before = fs::read(&output).unwrap();
            let said = check(&input, &output, options).exits(0);
            assert!(said.out().contains("up to date"), "{}", said.out());
            assert_eq!(fs::read(&output).unwrap(), before);
        }
    }
}

#[test]
fn other_options_another_input_or_no_output_are_found() {
    let (_folder, input, output) = made(&[], "out.glb");
    let said = check(&input, &output, &["--scheme", "squad"]).exits(3);
    assert!(said.out().contains("OUTDATED") && said.out().contains("/extras/"), "{}", said.out());
    let rows = fs::read_to_string(&input).unwrap();
    fs::write(&input, format!("{rows}# a comment more\n")).unwrap();
    // The file keeps the hash of its input, and says which.
    assert!(check(&input, &output, &[]).exits(3).out().contains("blake3"));
    fs::write(&input, rows).unwrap();
    check(&input, &output, &[]).exits(0);
    fs::remove_file(&output).unwrap();
    assert!(check(&input, &output, &[]).exits(3).out().contains("no such file"));
    assert!(!output.exists(), "nothing is written");
}

/// Alters the last float32 number of the binary chunk by some steps.
fn alter(output: &Path, steps: u32) {
    let mut bytes = fs::read(output).unwrap();
    let at = bytes.len() - 4;
    let bits = u32::from_le_bytes(bytes[at..].try_into().unwrap());
    bytes[at..].copy_from_slice(&(bits + steps).to_le_bytes());
    fs::write(output, bytes).unwrap();
}

#[test]
fn a_step_of_float32_is_forgiven_and_more_is_not() {
    let (_folder, input, output) = made(&[], "out.glb");
    alter(&output, 1);
    check(&input, &output, &[]).exits(0);
    alter(&output, 1);
    let said = check(&input, &output, &["--report", "github"]).exits(3);
    assert!(said.out().starts_with("::error file="), "{}", said.out());
    assert!(said.out().contains("would be"), "{}", said.out());
}

#[test]
fn reports_come_in_every_form() {
    let (_folder, input, output) = made(&[], "out.glb");
    for (format, sign) in [("json", "\"findings\""), ("junit", "<testsuites"), ("sarif", "\"2.1.0\"")] {
        let said = check(&input, &output, &["--report", format]).exits(0);
        assert!(said.out().contains(sign), "{format}: {}", said.out());
    }
    run(["convert", text(&input), "-o", text(&output), "--report", "json"]).exits(2).says(&["--check"]);
}

//! Inputs that change or vanish while they are read. The program waits for a second input,
//! a pipe, once it has read or opened the first: then the first is changed.

use crate::support::tool::{Ran, names, program};
use crate::support::writers::workshop;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

/// Linux's O_NONBLOCK: a pipe that no one reads is not waited for.
const NONBLOCK: i32 = 0o4000;

/// Runs the program, does something to the folder once it waits at the pipe `waiting.dat`,
/// and lets it go on with what `rest` holds.
fn while_it_waits(folder: &Path, words: &str, rest: &str, change: impl FnOnce(&Path)) -> Ran {
    let pipe = folder.join("waiting.dat");
    let _ = fs::remove_file(&pipe);
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut command = program();
    command.current_dir(folder).args(words.split(' '));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // Opens once the program has opened it, which is when it has read what comes before.
    let mut writer = loop {
        match OpenOptions::new().write(true).custom_flags(NONBLOCK).open(&pipe) {
            Ok(writer) => break writer,
            Err(_) if child.try_wait().unwrap().is_none() => thread::sleep(Duration::from_millis(2)),
            Err(error) => panic!("{words} ended before it waited: {error}"),
        }
    };
    change(folder);
    writer.write_all(rest.as_bytes()).unwrap();
    drop(writer);
    let output = child.wait_with_output().unwrap();
    fs::remove_file(&pipe).unwrap();
    let (code, stderr) = (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap());
    Ran { code, stdout: output.stdout, stderr }
}

fn path() -> String {
    fs::read_to_string("fixtures/paths/flight.dat").unwrap()
}

fn keys() -> String {
    fs::read_to_string("fixtures/keyframes/single-even.dat").unwrap()
}

type Change = Box<dyn Fn(&Path)>;

/// Ways to change a file in place.
fn changes(file: &'static str) -> [(&'static str, Change); 3] {
    let write = move |folder: &Path| OpenOptions::new().write(true).open(folder.join(file)).unwrap();
    [
        ("cut short", Box::new(move |folder| write(folder).set_len(100).unwrap())),
        (
            "grown",
            Box::new(move |folder| {
                let mut file = OpenOptions::new().append(true).open(folder.join(file)).unwrap();
                file.write_all(b"# and more\n").unwrap();
            }),
        ),
        (
            "overwritten",
            Box::new(move |folder| {
                // Beyond the clock that files are stamped with.
                thread::sleep(Duration::from_millis(30));
                write(folder).write_all(b"# ").unwrap();
            }),
        ),
    ]
}

const CHANGED: &str = "expected a file that stays as it is while it is read, found it changed";

/// Commands that read keys and then a path, and write OUT.
const READERS: &[&str] = &[
    "convert keys.dat --path waiting.dat -q -o old.glb",
    "convert keys.dat --path waiting.dat -q -o old.gltf",
    "sample keys.dat --path waiting.dat -o old.csv",
    "plot keys.dat --path waiting.dat --show path -o old.svg",
];

#[test]
fn an_input_that_changes_is_refused_and_no_output_touched() {
    for words in READERS {
        for (how, change) in changes("keys.dat") {
            let folder = workshop();
            let old = folder.path().join(words.rsplit(' ').next().unwrap());
            fs::write(&old, "what was here before").unwrap();
            let mut before = names(folder.path());
            let ran = while_it_waits(folder.path(), words, &path(), change).exits(1);
            ran.says(&["keys.dat", CHANGED]);
            assert_eq!(fs::read(&old).unwrap(), b"what was here before", "{words}, {how}");
            before.retain(|name| name != "waiting.dat");
            assert_eq!(names(folder.path()), before, "{words}, {how}");
        }
    }
}

#[test]
fn a_gltf_that_changes_while_it_is_checked_is_refused() {
    for (file, words) in [
        ("keys.glb", "check keys.glb --against waiting.dat"),
        ("keys.glb", "plot --show error keys.glb --against waiting.dat -o out.svg"),
    ] {
        for (how, change) in changes(file) {
            let folder = workshop();
            let ran = while_it_waits(folder.path(), words, &keys(), change).exits(1);
            assert!(!folder.path().join("out.svg").exists(), "{words}, {how}");
            if how != "cut short" {
                ran.says(&[file, CHANGED]);
            }
        }
    }
}

/// The .bin of a .gltf is an input as well.
#[test]
fn a_buffer_that_changes_is_refused() {
    let folder = workshop();
    let bin =
        names(folder.path()).into_iter().find(|name| name.starts_with("keys.") && name.ends_with(".bin"));
    let bin = bin.unwrap();
    let ran = while_it_waits(folder.path(), "check keys.gltf --against waiting.dat", &keys(), |folder| {
        OpenOptions::new().append(true).open(folder.join(&bin)).unwrap().write_all(b"more").unwrap();
    });
    ran.exits(1).says(&[&bin, CHANGED]);
}

/// What is removed, or replaced by another file of its name as careful programs do, is read
/// to its end as it was.
#[test]
fn an_input_that_vanishes_or_is_replaced_is_read_whole() {
    let words = "convert keys.dat --path waiting.dat -q -o out.glb";
    let folder = workshop();
    while_it_waits(folder.path(), words, &path(), |_| {}).exits(0);
    let whole = fs::read(folder.path().join("out.glb")).unwrap();
    let vanish = |folder: &Path| fs::remove_file(folder.join("keys.dat")).unwrap();
    let replace = |folder: &Path| fs::rename(folder.join("other.dat"), folder.join("keys.dat")).unwrap();
    for change in [&vanish as &dyn Fn(&Path), &replace] {
        let folder = workshop();
        while_it_waits(folder.path(), words, &path(), change).exits(0);
        assert!(fs::read(folder.path().join("out.glb")).unwrap() == whole);
        let check = "check keys.glb --against waiting.dat";
        while_it_waits(folder.path(), check, &keys(), |folder| {
            fs::remove_file(folder.join("keys.glb")).unwrap();
        })
        .exits(0);
    }
}

/// A pipe whose writer stops in the middle ends; what came is judged as it is.
#[test]
fn a_pipe_that_ends_in_the_middle_is_judged_by_what_came() {
    let folder = workshop();
    let keys = keys();
    let cut = &keys[..keys.len() - 20];
    let ran = while_it_waits(folder.path(), "convert waiting.dat -q -o out.glb", cut, |_| {}).exits(1);
    ran.says(&["waiting.dat"]);
    assert!(!folder.path().join("out.glb").exists());
    let nothing = while_it_waits(folder.path(), "convert waiting.dat -q -o out.glb", "", |_| {});
    nothing.exits(1).says(&["waiting.dat"]);
}

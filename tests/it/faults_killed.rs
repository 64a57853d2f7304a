//! Processes that are killed, and processes that write the same output at once: an output is
//! whole at any moment, the old one or a new one, and nothing is left beside it.

use crate::support::tool::{names, program, run_in};
use crate::support::writers::{WRITERS, Writer, added, workshop};
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// As on systems without files that have no name.
const NAMED: (&str, &str) = ("DAT2GLB_NAMED_TEMPORARIES", "1");

/// Numbers from 0 to 1 that look random (the golden ratio's multiples cover them evenly).
fn moments(count: usize) -> impl Iterator<Item = f64> {
    (1..=count).map(|i| (i as f64 * 0.618_033_988_749_894_9).fract())
}

fn started(folder: &Path, words: &[String], named: bool) -> Child {
    let mut command: Command = program();
    command.current_dir(folder).args(words).stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    if named {
        command.env(NAMED.0, NAMED.1);
    }
    command.spawn().unwrap()
}

/// The bytes of an output and, of a .gltf, those of its buffer, which must be there.
fn content(folder: &Path, out: &str) -> Vec<u8> {
    let main = fs::read(folder.join(out)).unwrap();
    if !out.ends_with(".gltf") {
        return main;
    }
    let json: Value = serde_json::from_slice(&main).unwrap_or_else(|error| panic!("{out}: {error}"));
    let uri = json["buffers"][0]["uri"].as_str().unwrap();
    let bin = fs::read(folder.join(uri)).unwrap_or_else(|error| panic!("{uri}: {error}"));
    [main, bin].concat()
}

/// What a writer makes of the first inputs or of the others, and how long that takes.
fn made(folder: &Path, writer: &Writer, out: &str, others: bool) -> (Vec<u8>, Duration) {
    let began = Instant::now();
    run_in(folder, writer.words(out, others)).exits(0);
    (content(folder, out), began.elapsed())
}

/// Kills a writer while it replaces another output, at so many moments; says how often
/// something was left beside the output, and what is left after one more run to its end.
fn killed(writer: &Writer, times: usize, named: bool) -> (usize, Vec<String>) {
    let folder = workshop();
    let path = folder.path();
    let out = format!("out.{}", writer.ending);
    let (new, duration) = made(path, writer, &out, true);
    let (old, _) = made(path, writer, &out, false);
    let before = names(path);
    let mut littered = 0;
    for moment in moments(times) {
        let mut child = started(path, &writer.words(&out, true), named);
        thread::sleep(duration.mul_f64(1.1 * moment));
        let _ = child.kill();
        child.wait().unwrap();
        let found = content(path, &out);
        assert!(found == old || found == new, "{writer:?}: {} bytes, neither old nor new", found.len());
        littered += usize::from(added(path, &before).iter().any(|name| name.ends_with(".tmp")));
        if found == new {
            run_in(path, writer.words(&out, false)).exits(0);
        }
    }
    let mut last = started(path, &writer.words(&out, false), named);
    assert!(last.wait().unwrap().success());
    let left = added(path, &before);
    assert!(content(path, &out) == old);
    (littered, left)
}

#[test]
fn killed_at_a_hundred_moments_it_leaves_the_old_file_or_the_new() {
    let (mut littered, mut kills) = (0, 0);
    for (index, writer) in WRITERS.iter().enumerate() {
        let times = if index < 2 { 100 } else { 15 };
        let (found, left) = killed(writer, times, false);
        assert_eq!(left, [""; 0], "{writer:?}");
        littered += found;
        kills += times;
    }
    // What replaces a file has a name from one call of the system to the next. A call waits for
    // the disk's journal, which others keep busy: some hundred microseconds of some milliseconds.
    assert!(10 * littered <= kills, "something was left {littered} times of {kills}");
}

/// Whether a process has a file without a name open, of a folder.
#[cfg(target_os = "linux")]
fn has_unnamed(process: u32, folder: &Path) -> bool {
    let opened = fs::read_dir(format!("/proc/{process}/fd")).unwrap().flatten();
    let files = opened.filter_map(|entry| fs::read_link(entry.path()).ok());
    let mut names = files.filter(|file| file.parent() == Some(folder));
    names.any(|file| file.to_string_lossy().contains("/#") && file.to_string_lossy().ends_with(" (deleted)"))
}

/// The folder's names while a process writes into it, and once it was killed there.
#[cfg(target_os = "linux")]
#[test]
fn what_is_being_written_has_no_name() {
    let folder = workshop();
    let path = fs::canonicalize(folder.path()).unwrap();
    fs::write(path.join("out.glb"), "old").unwrap();
    let before = names(&path);
    let words = "convert keys.dat -q -o out.glb --fps 1000000 --no-key-times --no-bound".split(' ');
    let mut child = started(&path, &words.map(str::to_owned).collect::<Vec<_>>(), false);
    while !has_unnamed(child.id(), &path) {
        assert!(child.try_wait().unwrap().is_none(), "it ended, and was never seen to write");
    }
    assert_eq!(added(&path, &before), [""; 0]);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(added(&path, &before), [""; 0]);
    assert_eq!(fs::read(path.join("out.glb")).unwrap(), b"old");
}

#[test]
fn where_files_have_names_the_next_run_removes_what_a_killed_one_left() {
    let mut littered = 0;
    for writer in &WRITERS[..6] {
        let (times, left) = killed(writer, 30, true);
        littered += times;
        assert_eq!(left, [""; 0], "{writer:?}");
    }
    assert!(littered > 0, "no kill left anything: files have no names, or the moments are wrong");
}

/// What a live process writes is no leftover, and neither is a file of another name.
#[test]
fn only_what_dead_runs_left_is_removed() {
    let folder = workshop();
    let path = folder.path();
    let (dead, live, other) = (".dat2glb-1-0.tmp", ".dat2glb-aBcDeF.tmp", ".dat2glb-notes.txt");
    for name in [dead, live, other] {
        fs::write(path.join(name), "part of a file").unwrap();
    }
    let held = fs::File::open(path.join(live)).unwrap();
    held.lock().unwrap();
    run_in(path, ["convert", "keys.dat", "-q", "-o", "out.glb"]).exits(0);
    assert!(!path.join(dead).exists() && path.join(live).exists() && path.join(other).exists());
    drop(held);
    run_in(path, ["convert", "keys.dat", "-q", "-o", "out.glb"]).exits(0);
    assert!(!path.join(live).exists() && path.join(other).exists());
}

/// Several processes at once, half of them with other inputs, over and over.
fn raced(writer: &Writer, rounds: usize, named: bool) {
    let folder = workshop();
    let path = folder.path();
    let out = format!("out.{}", writer.ending);
    let whole: HashMap<Vec<u8>, bool> =
        [true, false].map(|others| (made(path, writer, &out, others).0, others)).into();
    let before: Vec<String> = names(path).into_iter().filter(|name| !name.ends_with(".bin")).collect();
    for _ in 0..rounds {
        let children: Vec<Child> =
            (0..4).map(|i| started(path, &writer.words(&out, i % 2 == 1), named)).collect();
        for child in children {
            let output = child.wait_with_output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{writer:?}: {said}");
        }
        assert!(whole.contains_key(&content(path, &out)), "{writer:?}: neither the one nor the other");
        let bins =
            names(path).iter().filter(|name| name.starts_with("out.") && name.ends_with(".bin")).count();
        assert_eq!(bins, usize::from(writer.ending == "gltf"), "{writer:?}");
        let left: Vec<String> =
            added(path, &before).into_iter().filter(|name| !name.ends_with(".bin")).collect();
        assert_eq!(left, [""; 0], "{writer:?}");
    }
}

#[test]
fn of_processes_that_write_the_same_output_one_wins_whole() {
    for writer in WRITERS {
        raced(writer, if writer.ending == "gltf" { 20 } else { 4 }, false);
    }
}

#[test]
fn so_does_one_where_files_have_names() {
    for writer in &WRITERS[..5] {
        raced(writer, if writer.ending == "gltf" { 20 } else { 4 }, true);
    }
}

/// Two names cannot be given at once: while one process gives them, any other waits, or it
/// would remove the .bin that has its name while the .gltf has not.
#[test]
fn a_gltf_and_its_bin_take_their_names_in_turn() {
    for (named, lock) in [(false, "."), (true, ".dat2glb-turn.tmp")] {
        let folder = workshop();
        let path = folder.path();
        let (old, duration) = made(path, &WRITERS[1], "out.gltf", false);
        if named {
            fs::write(path.join(lock), "").unwrap();
        }
        let turn = fs::File::open(path.join(lock)).unwrap();
        turn.lock().unwrap();
        let mut waiting = started(path, &WRITERS[1].words("out.gltf", true), named);
        thread::sleep(20 * duration);
        assert!(waiting.try_wait().unwrap().is_none(), "it did not wait for its turn");
        let bins =
            || names(path).into_iter().filter(|name| name.starts_with("out.") && name.ends_with(".bin"));
        assert!(content(path, "out.gltf") == old && bins().count() == 1);
        drop(turn);
        assert!(waiting.wait().unwrap().success());
        assert!(content(path, "out.gltf") != old && bins().count() == 1);
    }
}

//! Faults around the program: full disks, folders and files that may not be written,
//! directories in place of files, readers that go away. What was there before stays.

use crate::support::tool::{Ran, finish, names, program, program_path, run_in};
use crate::support::writers::{WRITERS, added, workshop};
use std::fs::{self, File};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};

const BEFORE: &[u8] = b"what was here before";

/// Runs the program by a shell script, which finds it and its arguments as `"$@"`.
fn by_shell(folder: &Path, script: &str, words: &[String]) -> Ran {
    let mut command = Command::new("sh");
    finish(command.current_dir(folder).args(["-c", script, "sh"]).arg(program_path()).args(words), b"")
}

/// A limit on the size of files is a disk that is full in the middle of a file.
#[test]
fn a_full_disk_leaves_what_was_there() {
    let folder = workshop();
    let path = folder.path();
    for writer in WRITERS {
        let (new, old) = (format!("new.{}", writer.ending), format!("old.{}", writer.ending));
        fs::write(path.join(&old), BEFORE).unwrap();
        let before = names(path);
        for out in [&new, &old] {
            let ran = by_shell(path, "trap '' XFSZ; ulimit -f 1; exec \"$@\"", &writer.words(out, false));
            ran.exits(4).says(&["cannot be written"]);
            assert_eq!(names(path), before, "{writer:?}");
        }
        assert_eq!(fs::read(path.join(&old)).unwrap(), BEFORE, "{writer:?}");
        fs::remove_file(path.join(&old)).unwrap();
    }
}

#[test]
fn a_device_that_is_full_is_said() {
    let folder = workshop();
    for writer in WRITERS.iter().filter(|writer| writer.ending != "gltf") {
        let out = format!("full.{}", writer.ending);
        let _ = symlink("/dev/full", folder.path().join(&out));
        let ran = run_in(folder.path(), writer.words(&out, false));
        ran.exits(4).says(&[&out, "cannot be written", "No space left"]);
    }
}

/// Without the right to write where the mode says no, which root has otherwise.
const AS_ANYONE: &str = "if [ $(id -u) = 0 ]; then \
    exec setpriv --bounding-set -dac_override,-dac_read_search \"$@\"; else exec \"$@\"; fi";

#[test]
fn a_folder_that_may_not_be_written_is_the_environment_s_fault() {
    let folder = workshop();
    let path = folder.path();
    let locked = path.join("locked");
    fs::create_dir(&locked).unwrap();
    let mode = |mode| fs::set_permissions(&locked, fs::Permissions::from_mode(mode)).unwrap();
    for writer in WRITERS {
        let (new, old) = (format!("locked/new.{}", writer.ending), format!("locked/old.{}", writer.ending));
        mode(0o755);
        fs::write(path.join(&old), BEFORE).unwrap();
        mode(0o555);
        let before = (names(path), names(&locked));
        for out in [&new, &old] {
            let ran = by_shell(path, AS_ANYONE, &writer.words(out, false)).exits(4);
            ran.says(&["cannot be written", "Permission denied"]);
            assert_eq!((names(path), names(&locked)), before, "{writer:?}");
        }
        assert_eq!(fs::read(path.join(&old)).unwrap(), BEFORE, "{writer:?}");
    }
    mode(0o755);
}

#[test]
fn a_file_that_may_not_be_written_is_not_replaced() {
    let folder = workshop();
    let path = folder.path();
    for writer in WRITERS {
        let out = format!("kept.{}", writer.ending);
        fs::write(path.join(&out), BEFORE).unwrap();
        fs::set_permissions(path.join(&out), fs::Permissions::from_mode(0o444)).unwrap();
        let before = names(path);
        by_shell(path, AS_ANYONE, &writer.words(&out, false)).exits(4).says(&[&out, "Permission denied"]);
        assert_eq!(fs::read(path.join(&out)).unwrap(), BEFORE, "{writer:?}");
        assert_eq!(names(path), before, "{writer:?}");
        fs::remove_file(path.join(&out)).unwrap();
    }
}

#[test]
fn what_is_no_folder_holds_no_file() {
    let folder = workshop();
    for writer in WRITERS {
        let before = names(folder.path());
        for (parent, why) in [("keys.dat", "Not a directory"), ("nowhere", "No such file or directory")] {
            let out = format!("{parent}/out.{}", writer.ending);
            run_in(folder.path(), writer.words(&out, false)).exits(4).says(&[why]);
        }
        assert_eq!(names(folder.path()), before, "{writer:?}");
    }
}

#[test]
fn a_directory_is_no_file_to_write() {
    let folder = workshop();
    let path = folder.path();
    for writer in WRITERS {
        let out = format!("folder.{}", writer.ending);
        let _ = fs::create_dir(path.join(&out));
        let before = names(path);
        let words = writer.words(&out, false);
        if words[0] == "convert" {
            // For convert a folder is where its output goes, by the input's name.
            run_in(path, &words).exits(0);
            assert_eq!(names(path), before, "{writer:?}");
            fs::remove_dir_all(path.join(&out)).unwrap();
            continue;
        }
        let ran = run_in(path, &words).exits(2);
        ran.says(&[&out, "expected a file to write, found a directory"]);
        assert_eq!((names(path), names(&path.join(&out)).len()), (before, 0), "{writer:?}");
        fs::remove_dir(path.join(&out)).unwrap();
    }
}

/// Commands that print on standard output, and their exit codes.
const PRINTERS: &[(&str, i32)] = &[
    ("check keys.glb", 0),
    ("check keys.glb --json", 0),
    ("check keys.glb --report sarif", 0),
    ("check broken.glb", 3),
    ("inspect keys.glb", 0),
    ("inspect keys.dat --json", 0),
    ("diff keys.glb other.glb", 0),
    ("diff keys.glb other.glb --max-error 0.001", 3),
    ("compare keys.dat --json", 0),
    ("sample keys.dat", 0),
    ("plot keys.dat -o -", 0),
    ("thumbnail keys.glb -o - --renderer cpu --size 48x48", 0),
    ("convert keys.dat -o -", 0),
    ("convert keys.dat -o ready.glb --json", 0),
    ("convert keys.dat -o keys.glb --check", 0),
    ("reduce keys.glb -o - --tolerance 1", 0),
    ("reduce keys.glb -o ready.glb --tolerance 1 --json", 0),
    ("example chain", 0),
    ("completions bash", 0),
    ("man", 0),
    ("--help", 0),
    ("--version", 0),
];

fn printing(folder: &Path, words: &str, stdout: impl Into<Stdio>) -> (Option<i32>, String) {
    let mut command = program();
    command.current_dir(folder).args(words.split(' ')).stdin(Stdio::null()).stderr(Stdio::piped());
    let output = command.stdout(stdout).spawn().unwrap().wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_reader_that_went_away_changes_no_exit_code() {
    let folder = workshop();
    fs::copy("fixtures/hostile/nan-everywhere.glb", folder.path().join("broken.glb")).unwrap();
    for (words, code) in PRINTERS {
        let (reader, writer) = std::io::pipe().unwrap();
        // As `| head` that has seen enough before the first byte.
        drop(reader);
        let (found, stderr) = printing(folder.path(), words, writer);
        assert_eq!(found, Some(*code), "{words}: {stderr}");
        assert!(!stderr.contains("error:") && !stderr.contains("panicked"), "{words}: {stderr}");
    }
}

#[test]
fn standard_output_on_a_full_disk_is_said() {
    let folder = workshop();
    fs::copy("fixtures/hostile/nan-everywhere.glb", folder.path().join("broken.glb")).unwrap();
    for (words, _) in PRINTERS {
        let (found, stderr) = printing(folder.path(), words, File::create("/dev/full").unwrap());
        assert_eq!(found, Some(4), "{words}: {stderr}");
        assert!(stderr.contains("standard output") && stderr.contains("No space left"), "{words}: {stderr}");
    }
}

/// Closed from the start, by `>&-` or a careless parent: no output must take its place.
#[test]
fn closed_streams_harm_nothing() {
    let folder = workshop();
    let path = folder.path();
    let before = names(path);
    for writer in WRITERS {
        let out = format!("out.{}", writer.ending);
        by_shell(path, "exec \"$@\" <&- >&- 2>&-", &writer.words(&out, false)).exits(0);
        run_in(path, writer.words(&format!("again.{}", writer.ending), false)).exits(0);
        if writer.ending != "gltf" {
            let read = |name: &str| fs::read(path.join(format!("{name}.{}", writer.ending))).unwrap();
            assert!(read("out") == read("again"), "{writer:?}");
        }
        added(path, &before).iter().for_each(|name| fs::remove_file(path.join(name)).unwrap());
    }
}

//! `dat2glb example`: what it prints goes all the way.

use crate::support::loaded::load;
use crate::support::tool::run_in;
use dat2glb::clip::Body;
use std::fs;

#[test]
fn every_example_converts_checks_and_draws() {
    for kind in ["chain", "body"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let printed = run_in(path, ["example", kind]).exits(0);
        assert_eq!(printed.stderr, "");
        fs::write(path.join("my.dat"), &printed.stdout).unwrap();
        let converted = run_in(path, ["convert", "my.dat", "-o", "my.glb", "--scheme", "all"]).exits(0);
        // One scheme does not meet its keys, and says so.
        let mut lines = converted.stderr.lines();
        let quiet = lines.all(|line| !line.contains("warning") || line.contains("KEYS_SMOOTHED"));
        assert!(quiet, "{kind}: {}", converted.stderr);
        let checked = run_in(path, ["check", "my.glb", "--strict", "--against", "my.dat"]).exits(0);
        assert!(checked.out().ends_with("my.glb: 0 errors, 0 warnings, 0 infos\n"), "{}", checked.out());
        if cfg!(feature = "render") {
            let look = ["check", "my.glb", "--strict", "--render", "--renderer", "cpu"];
            run_in(path, look).exits(0);
            run_in(path, ["thumbnail", "my.glb", "--renderer", "cpu"]).exits(0);
            assert!(fs::read(path.join("my.png")).unwrap().starts_with(b"\x89PNG"));
        }
        let body = crate::support::read_clip(&path.join("my.dat")).body;
        assert_eq!(matches!(body, Body::Free), kind == "body");
        assert_eq!(load(&path.join("my.glb")).clips.len(), dat2glb::curve::Scheme::ALL.len());
    }
}

#[test]
fn an_example_that_does_not_exist_names_those_that_do() {
    run_in(std::env::temp_dir().as_path(), ["example", "arm"]).exits(2).says(&["arm", "chain", "body"]);
}

/// What the program shows to whoever types nothing works as it stands there.
#[cfg(unix)]
#[test]
fn the_first_steps_work_when_typed() {
    use crate::support::tool::{finish, program, program_path};
    let shown = finish(&mut program(), b"").exits(2).stderr;
    let folder = tempfile::tempdir().unwrap();
    let mut typed = 0;
    for line in shown.lines().filter_map(|line| line.strip_prefix("  dat2glb ")) {
        let command = line.split("   ").next().unwrap();
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(&folder).arg("-c").arg(format!("\"$0\" {command}")).arg(program_path());
        finish(&mut shell, b"").exits(0);
        typed += 1;
    }
    assert_eq!(typed, 4);
    assert!(folder.path().join("chain.glb").exists());
}

/// The commands that the README shows, and the pages of docs that go on from it, work as
/// they stand there, but for the one that watches.
#[cfg(all(unix, feature = "render"))]
#[test]
fn the_readmes_commands_work_when_typed() {
    use crate::support::tool::{finish, program_path};
    let page = |name: &str| fs::read_to_string(crate::support::repository().join(name)).unwrap();
    let pages = ["README.md", "docs/paths.md", "docs/schemes.md", "docs/pictures.md"].map(page).join("\n");
    let folder = tempfile::tempdir().unwrap();
    let commands = pages.lines().filter_map(|line| line.strip_prefix("dat2glb "));
    let typed: Vec<&str> = commands
        .map(|command| command.split("  ").next().unwrap())
        .filter(|command| !["--watch"].iter().any(|word| command.contains(word)))
        .collect();
    assert!(typed.len() >= 32, "{typed:?}");
    for command in typed {
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(&folder).arg("-c").arg(format!("\"$0\" {command}")).arg(program_path());
        finish(&mut shell, b"").exits(0);
    }
}

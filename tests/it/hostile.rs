//! Hostile glTF: every file of fixtures/hostile through every command, with a second of
//! processor time and little memory, and what each then says, word for word.

use crate::support::confined::{Limits, confined};
use crate::support::tool::{Ran, finish, names, program_path, run_in};
use crate::support::{ACCEPT, accept, fixtures, repository};
use rayon::prelude::*;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines of a message that are kept.
const LINES: usize = 12;
/// Characters of a line that are kept.
const LETTERS: usize = 300;

/// Every command that reads glTF, in short; FILE, FOLDER and ENDING are filled in.
const COMMANDS: &[&str] = &[
    "check FILE",
    "check --render --renderer cpu -q FILE",
    "check -q --against fixtures/keyframes/single-even.dat --scheme slerp FILE",
    "thumbnail FILE -o FOLDER/picture.png --size 48x48 --renderer cpu",
    "thumbnail FILE -o FOLDER/moving.gif --size 32x32 --renderer cpu",
    "inspect FILE",
    "diff -q fixtures/hostile/whole.glb FILE",
    "diff -q FILE FILE",
    "reduce FILE -o FOLDER/reduced.ENDING --tolerance 0.1 -q",
    "plot --show error FILE -o FOLDER/plot.svg --against fixtures/keyframes/single-even.dat --scheme slerp",
];

/// Runs a command on a file; what it leaves in FOLDER, it must leave whole.
fn run(command: &str, file: &str, kind: &str, out: &Path, limits: Limits) -> Result<Ran, String> {
    let words = command.split(' ').map(|word| {
        word.replace("FILE", file).replace("FOLDER", out.to_str().unwrap()).replace("ENDING", kind)
    });
    let ran = confined(words, limits).map_err(|how| format!("{command}: {how}"))?;
    let left = names(out);
    if ran.stderr.contains("panicked") || !(0..=3).contains(&ran.code) {
        return Err(format!("{command}: exit code {}, {}", ran.code, ran.stderr));
    }
    if !left.is_empty() && ran.code != 0 {
        return Err(format!("{command}: exit code {}, left {left:?}", ran.code));
    }
    for name in left {
        fs::remove_file(out.join(name)).unwrap();
    }
    Ok(ran)
}

/// What a command said, without what differs from run to run.
fn told(command: &str, ran: &Ran, out: &Path) -> String {
    let mut text = if command == "check FILE" { ran.out() + &ran.stderr } else { ran.stderr.clone() };
    text = text.replace(out.to_str().unwrap(), "FOLDER");
    let lines: Vec<&str> = text.lines().collect();
    let mut told = format!("{command}: {}\n", ran.code);
    for line in lines.iter().take(LINES) {
        let shortened: String = line.chars().take(LETTERS).collect();
        told += &format!("  {shortened}\n");
    }
    if lines.len() > LINES {
        told += &format!("  and {} more lines\n", lines.len() - LINES);
    }
    told
}

/// What every command says of a file, which a path from the repository's root leads to.
fn all_told(file: &str) -> Result<String, String> {
    let out = tempfile::tempdir().unwrap();
    let size = fs::metadata(repository().join(file)).unwrap().len();
    let kind = file.rsplit('.').next().unwrap();
    let mut all = String::new();
    for command in COMMANDS {
        let limits = Limits::of(size * command.matches("FILE").count() as u64);
        all += &told(command, &run(command, file, kind, out.path(), limits)?, out.path());
    }
    Ok(all)
}

/// Rows of the README: a file's name and its finding.
fn listed() -> Vec<(String, String)> {
    let readme = fs::read_to_string(fixtures().join("hostile/README.md")).unwrap();
    let rows = readme.lines().filter_map(|line| line.strip_prefix("| `")?.strip_suffix(" |"));
    let pair = |row: &str| Some((row.split_once('`')?.0.to_owned(), row.rsplit_once(" | ")?.1.to_owned()));
    rows.filter_map(pair).collect()
}

#[test]
fn every_file_is_listed_with_its_finding() {
    let files = names(&fixtures().join("hostile"));
    let is_gltf = |name: &&String| name.ends_with(".glb") || name.ends_with(".gltf");
    let mut there: Vec<&String> = files.iter().filter(is_gltf).collect();
    let listed = listed();
    let mut in_readme: Vec<&String> = listed.iter().map(|(name, _)| name).collect();
    there.sort();
    in_readme.sort();
    assert_eq!(in_readme, there);
    assert!(there.len() >= 250, "only {} files", there.len());
    for expect in files.iter().filter_map(|name| name.strip_suffix(".expect")) {
        assert!(there.iter().any(|name| *name == expect), "{expect}.expect has no {expect}");
    }
}

#[test]
fn every_command_says_what_is_wrong_and_stays_small() {
    let wrong: Vec<String> = listed()
        .par_iter()
        .filter_map(|(name, finding)| {
            let told = match all_told(&format!("fixtures/hostile/{name}")) {
                Ok(told) => told,
                Err(how) => return Some(format!("{name}: {how}")),
            };
            let check = told.split("check --render").next().unwrap();
            if !check.contains(finding.as_str()) {
                return Some(format!("{name}: expected the finding {finding}, found\n{told}"));
            }
            let file = fixtures().join(format!("hostile/{name}.expect"));
            if accept() {
                fs::write(&file, &told).unwrap();
            }
            let expected = fs::read_to_string(&file).unwrap_or_default();
            (told != expected).then(|| format!("{name}: expected\n{expected}found\n{told}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}\nIf these are better, {ACCEPT}=1 writes them down.", wrong.join("\n"));
}

/// Files too large to keep, of 100,000 levels or of very many parts: what they hold beside
/// their version, and what `check` must find.
fn large() -> Vec<(&'static str, String, &'static str)> {
    let chain = |last: &str| {
        let nodes = (1..100_000).map(|child| format!("{{\"children\":[{child}]}},"));
        format!("\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{}{last}]", nodes.collect::<String>())
    };
    let nested = |open: &str, close: &str| format!("{}0{}", open.repeat(100_000), close.repeat(100_000));
    let many = |one: &str| format!("[{}{one}]", format!("{one},").repeat(99_999));
    vec![
        ("nodes-100000-deep", chain("{}"), "0 errors"),
        ("ring-of-100000-nodes", chain("{\"children\":[0]}"), "NODE_CYCLE"),
        ("arrays-100000-deep", format!("\"extras\":{}", nested("[", "]")), "JSON_PARTLY_UNREAD"),
        ("objects-100000-deep", format!("\"extras\":{}", nested("{\"a\":", "}")), "JSON_PARTLY_UNREAD"),
        ("nodes-in-arrays-100000-deep", format!("\"nodes\":{}", nested("[", "]")), "SCHEMA"),
        ("children-100000", format!("\"nodes\":[{{\"children\":{}}},{{}}]", many("1")), "NODE_TWO_PARENTS"),
        ("meshes-100000", format!("\"meshes\":{}", many("{\"primitives\":[]}")), "INVALID_VALUE"),
        ("accessors-100000", format!("\"accessors\":{}", many(ONE_ZERO)), "UNUSED_OBJECT"),
    ]
}

/// An accessor that stores nothing.
const ONE_ZERO: &str = "{\"componentType\":5126,\"type\":\"SCALAR\",\"count\":1}";

#[test]
fn a_hundred_thousand_levels_are_no_harder_than_one() {
    let folder = tempfile::tempdir().unwrap();
    let wrong = large().into_iter().filter_map(|(name, rest, finding)| {
        let path = folder.path().join(format!("{name}.gltf"));
        fs::write(&path, format!("{{\"asset\":{{\"version\":\"2.0\"}},{rest}}}")).unwrap();
        match all_told(path.to_str().unwrap()) {
            Ok(told) if told.split("check --render").next().unwrap().contains(finding) => None,
            Ok(told) => Some(format!("{name}: expected the finding {finding}, found\n{told}")),
            Err(how) => Some(format!("{name}: {how}")),
        }
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A folder with a .gltf that names `data.bin`, and a buffer for it elsewhere.
fn with_buffer_elsewhere() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().canonicalize().unwrap();
    let hostile = fixtures().join("hostile");
    fs::create_dir(path.join("in")).unwrap();
    fs::create_dir(path.join("in/below")).unwrap();
    fs::create_dir(path.join("out")).unwrap();
    fs::copy(hostile.join("uri-beside.gltf"), path.join("in/file.gltf")).unwrap();
    fs::copy(hostile.join("data.bin"), path.join("out/data.bin")).unwrap();
    fs::copy(hostile.join("data.bin"), path.join("in/below/data.bin")).unwrap();
    (folder, path)
}

#[test]
fn links_are_followed_within_the_folder_only() {
    let (_folder, path) = with_buffer_elsewhere();
    let check = |file: &str| run_in(&path, ["check", file]);
    let link = |to: &str| {
        let _ = fs::remove_file(path.join("in/data.bin"));
        symlink(to, path.join("in/data.bin")).unwrap();
    };
    link("../out/data.bin");
    let ran = check("in/file.gltf").exits(3);
    let leads = format!("`data.bin` cannot be read: a link leads to {}/out/data.bin", path.display());
    assert!(ran.out().contains(&leads), "{}", ran.out());
    link("below/data.bin");
    check("in/file.gltf").exits(0);
    // Where the .gltf is itself a link, what lies beside what it leads to is meant too.
    fs::rename(path.join("in/file.gltf"), path.join("out/file.gltf")).unwrap();
    symlink("../out/file.gltf", path.join("in/file.gltf")).unwrap();
    link("../out/data.bin");
    check("in/file.gltf").exits(0);
    link("/etc/hostname");
    check("in/file.gltf").exits(3);
    // A folder that leads out is no way round.
    symlink("..", path.join("in/up")).unwrap();
    let through =
        fs::read_to_string(path.join("out/file.gltf")).unwrap().replace("data.bin", "up/out/data.bin");
    fs::write(path.join("in/through.gltf"), through).unwrap();
    let ran = check("in/through.gltf").exits(3);
    assert!(ran.out().contains("`up/out/data.bin` cannot be read: a link leads to"), "{}", ran.out());
}

#[test]
fn pipes_and_devices_are_not_read_as_buffers() {
    let (_folder, path) = with_buffer_elsewhere();
    for (make, what) in [
        ("mkfifo in/data.bin", "it is a pipe or a device"),
        ("mkdir in/data.bin", "it is a directory"),
        ("ln -s /dev/zero in/data.bin", "a link leads to /dev/zero"),
    ] {
        let _ = fs::remove_file(path.join("in/data.bin"));
        let _ = fs::remove_dir(path.join("in/data.bin"));
        let script =
            format!("{make} && ulimit -t 1 && ulimit -d 65536 && timeout 30 \"$0\" check in/file.gltf");
        let mut shell = Command::new("sh");
        let ran = finish(shell.current_dir(&path).args(["-c", &script]).arg(program_path()), b"").exits(3);
        assert!(ran.out().contains(what), "{make}: {}", ran.out());
        let script = script
            .replace("check in/file.gltf", "reduce in/file.gltf -o in/new.gltf --tolerance 1")
            .replace(&format!("{make} &&"), "");
        let mut shell = Command::new("sh");
        finish(shell.current_dir(&path).args(["-c", &script]).arg(program_path()), b"").exits(0);
    }
}

//! The bytes of some sixty runs, held by their hashes: what a change is not meant to change
//! stays the same to the last bit, on every platform.
//!
//! `fixtures/golden.txt` is a table of runs: a hash and the words of a command. The runs of a
//! paragraph share a folder, `OUT`, in their order; paragraphs run side by side. A row's hash
//! is that of standard output and of all files that its run made or changed.

use crate::support::tool::run;
use crate::support::{ACCEPT, accept, fixtures};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::thread;

/// Commands that write; each stands in the table.
const WRITING: [&str; 6] = ["convert", "reduce", "sample", "plot", "compare", "thumbnail"];

#[test]
fn outputs_keep_their_bytes() {
    let table = fixtures().join("golden.txt");
    let before = fs::read_to_string(&table).unwrap();
    for command in WRITING {
        assert!(before.lines().any(|line| words(line).nth(1) == Some(command)), "no run of {command}");
    }
    let paragraphs: Vec<&str> = before.trim_end().split("\n\n").collect();
    let now: Vec<String> = thread::scope(|scope| {
        let runs: Vec<_> = paragraphs.iter().map(|paragraph| scope.spawn(|| hashed(paragraph))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    let now = now.join("\n\n") + "\n";
    if accept() {
        fs::write(&table, now).unwrap();
        return;
    }
    let changed: Vec<&str> =
        now.lines().zip(before.lines()).filter(|(now, before)| now != before).map(|(now, _)| now).collect();
    assert!(
        changed.is_empty(),
        "other bytes than in fixtures/golden.txt:\n{}\nCompare old and new with `dat2glb diff`; if the change \
         is meant, {ACCEPT}=1 writes the table anew.",
        changed.join("\n")
    );
}

/// The rows of a paragraph with the hashes that its runs have now.
fn hashed(paragraph: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut known = BTreeMap::new();
    let rows = paragraph.lines().map(|row| {
        if row.starts_with('#') {
            return row.to_owned();
        }
        let command: Vec<&str> = words(row).skip(1).collect();
        let out = folder.path().to_str().unwrap();
        let ran = run(command.iter().map(|word| word.replace("OUT", out))).exits(0);
        let files = contents(folder.path());
        let mut hasher = blake3::Hasher::new();
        hasher.update(&ran.stdout);
        let new = files.iter().filter(|(name, hash)| known.get(*name) != Some(*hash));
        new.for_each(|(_, hash)| _ = hasher.update(hash.as_bytes()));
        assert!(hasher.count() > 0, "`{}` wrote nothing", command.join(" "));
        known = files;
        format!("{} {}", &hasher.finalize().to_hex()[..16], command.join(" "))
    });
    rows.collect::<Vec<String>>().join("\n")
}

fn words(row: &str) -> impl Iterator<Item = &str> {
    row.split(' ').filter(|word| !word.is_empty())
}

/// The hashes of all files below a folder, by name.
fn contents(folder: &Path) -> BTreeMap<String, blake3::Hash> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.insert(path.to_str().unwrap().to_owned(), blake3::hash(&fs::read(&path).unwrap()));
            }
        }
    }
    files
}

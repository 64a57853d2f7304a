//! No `unsafe` in crates of this repository: the compiler is told to refuse it.

use crate::support::repository;
use std::fs;
use std::path::{Path, PathBuf};

/// The files below a folder, without what is built or installed there.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            files(&path, found);
        } else if path.is_file() {
            found.push(path);
        }
    }
}

/// Whether a manifest's own lints, or those of its workspace, forbid it.
fn forbids(manifest: &str) -> bool {
    let lines: Vec<&str> = manifest.lines().map(str::trim).collect();
    let lints = lines.iter().position(|&line| line == "[lints.rust]" || line == "[workspace.lints.rust]");
    let lints = lints.map(|at| lines[at + 1..].iter().take_while(|line| !line.starts_with('[')));
    lints.is_some_and(|mut lints| lints.any(|&line| line == "unsafe_code = \"forbid\""))
}

#[test]
fn every_crate_forbids_it() {
    let mut all = Vec::new();
    files(repository(), &mut all);
    let manifests: Vec<&PathBuf> = all.iter().filter(|path| path.ends_with("Cargo.toml")).collect();
    assert!(manifests.contains(&&repository().join("Cargo.toml")));
    for path in manifests {
        let manifest = fs::read_to_string(path).unwrap();
        // The entry point that libfuzzer-sys writes for a fuzz target has a name for C.
        if manifest.contains("libfuzzer-sys") {
            let sources = all.iter().filter(|file| file.starts_with(path.parent().unwrap()));
            for source in sources.filter(|file| file.extension().is_some_and(|ending| ending == "rs")) {
                let text = fs::read_to_string(source).unwrap();
                assert!(!text.contains("unsafe"), "{}", source.display());
            }
        } else {
            assert!(forbids(&manifest), "{}: expected unsafe_code = \"forbid\"", path.display());
        }
    }
}

#[test]
fn a_manifest_that_allows_it_is_seen() {
    assert!(forbids("[lints.rust]\nunsafe_code = \"forbid\"\n"));
    assert!(!forbids("[lints.rust]\nunsafe_code = \"deny\"\n"));
    assert!(!forbids("[lints.clippy]\nunsafe_code = \"forbid\"\n"));
    assert!(!forbids("[package]\nname = \"a\"\n"));
}

//! What several subjects need: paths, the program, files read by another crate.

#[cfg(feature = "cli")]
pub(crate) mod altered;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png", target_os = "linux"))]
pub(crate) mod confined;
#[cfg(all(feature = "cli", feature = "plot-png"))]
pub(crate) mod drawn;
#[cfg(feature = "cli")]
pub(crate) mod loaded;
pub(crate) mod made;
#[cfg(feature = "cli")]
pub(crate) mod schema;
#[cfg(all(feature = "cli", feature = "render"))]
pub(crate) mod stage;
#[cfg(feature = "cli")]
pub(crate) mod tool;
#[cfg(all(feature = "cli", feature = "render", feature = "plot-png", target_os = "linux"))]
pub(crate) mod writers;

use dat2glb::clip::Clip;
use dat2glb::read;
use std::fs;
use std::path::{Path, PathBuf};

/// Set to 1, tests write down what they find instead of holding it against what was.
#[cfg(feature = "cli")]
pub(crate) const ACCEPT: &str = "DAT2GLB_ACCEPT";

#[cfg(feature = "cli")]
pub(crate) fn accept() -> bool {
    std::env::var_os(ACCEPT).is_some_and(|value| value == "1")
}

pub(crate) fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub(crate) fn fixtures() -> PathBuf {
    repository().join("fixtures")
}

/// The file of a good fixture.
pub(crate) fn keyframes(name: &str) -> PathBuf {
    fixtures().join("keyframes").join(format!("{name}.dat"))
}

/// The names of all good fixtures, sorted.
#[cfg(feature = "cli")]
pub(crate) fn good() -> Vec<String> {
    let entries = fs::read_dir(fixtures().join("keyframes")).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path()).filter(|path| path.extension().unwrap() == "dat");
    let mut names: Vec<String> =
        paths.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    assert!(names.len() >= 15, "only {} fixtures", names.len());
    names
}

pub(crate) fn read_clip(path: &Path) -> Clip {
    let file = fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    read::keyframes(&path.display().to_string(), file, None).unwrap().clip
}

//! Every command that writes a file, and inputs for them.

use super::keyframes;
use super::tool::{names, run_in};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A command that writes `OUT` with this ending; `KEYS`, `GLB` and `GLTF` are inputs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Writer {
    pub(crate) ending: &'static str,
    command: &'static str,
}

pub(crate) const WRITERS: &[Writer] = &[
    Writer { ending: "glb", command: "convert KEYS -q -o OUT" },
    Writer { ending: "gltf", command: "convert KEYS -q -o OUT" },
    Writer { ending: "png", command: "convert KEYS -q -o ready.glb --thumbnail OUT" },
    Writer { ending: "glb", command: "reduce GLB -q -o OUT --tolerance 0.01" },
    Writer { ending: "gltf", command: "reduce GLTF -q -o OUT --tolerance 0.01" },
    Writer { ending: "png", command: "thumbnail GLB -q -o OUT --renderer cpu --size 96x96" },
    Writer { ending: "gif", command: "thumbnail GLB -q -o OUT --renderer cpu --size 48x48 --fps 5" },
    Writer { ending: "apng", command: "thumbnail GLB -q -o OUT --renderer cpu --size 48x48 --fps 5" },
    Writer { ending: "webp", command: "thumbnail GLB -q -o OUT --renderer cpu --size 48x48 --fps 5" },
    Writer { ending: "svg", command: "plot KEYS -o OUT" },
    Writer { ending: "png", command: "plot KEYS -o OUT" },
    Writer { ending: "csv", command: "sample KEYS -o OUT" },
    Writer { ending: "png", command: "diff GLB other.glb -q --picture OUT --renderer cpu --size 96x96" },
];

impl Writer {
    /// Its words with an output's name in place, and the first inputs or others.
    pub(crate) fn words(&self, out: &str, others: bool) -> Vec<String> {
        let name = if others { "other" } else { "keys" };
        let put = |word: &str| match word {
            "KEYS" => format!("{name}.dat"),
            "GLB" => format!("{name}.glb"),
            "GLTF" => format!("{name}.gltf"),
            "OUT" => out.to_owned(),
            word => word.to_owned(),
        };
        self.command.split(' ').map(put).collect()
    }
}

/// A folder with all inputs, none of which is the output of a test.
pub(crate) fn workshop() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, fixture) in [("keys", "single-even"), ("other", "xyzw")] {
        fs::copy(keyframes(fixture), folder.path().join(format!("{name}.dat"))).unwrap();
        for ending in ["glb", "gltf"] {
            run_in(
                folder.path(),
                ["convert", &format!("{name}.dat"), "-q", "-o", &format!("{name}.{ending}")],
            )
            .exits(0);
        }
    }
    run_in(folder.path(), ["convert", "keys.dat", "-q", "-o", "ready.glb"]).exits(0);
    folder
}

/// What is in a folder and was not there before.
pub(crate) fn added(folder: &Path, before: &[String]) -> Vec<String> {
    names(folder).into_iter().filter(|name| !before.contains(name)).collect()
}

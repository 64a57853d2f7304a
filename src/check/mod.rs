//! Judges a glTF file as its users' viewers would see it.
//!
//! [`file()`] looks at any `.glb` or `.gltf`, layer by layer: the container,
//! the JSON's structure, buffers and accessors, nodes, meshes, animations,
//! and then, in one pass over the binary data, the numbers themselves. It
//! gathers all findings; each has a stable [`Code`] that says how serious it
//! is. Nothing here knows how [`crate::write`](mod@crate::write) makes files.

pub mod against;
mod animations;
mod buffers;
mod code;
mod container;
mod data;
mod meshes;
pub mod motion;
mod nodes;
mod proof;
mod report;
mod rotations;
mod structure;
mod tally;
#[cfg(test)]
mod tests;
mod times;
mod unused;
mod uses;
mod values;

pub use code::{Code, Severity};
pub use report::{Finding, Place, Report};

use crate::asset::{Asset, Error, Resolve, Source};
use data::Shared;

/// Checks a file.
///
/// Fails only where the file cannot be read as glTF at all; a file whose JSON
/// is JSON but does not follow the schema gets a report that says so.
pub fn file(main: Box<dyn Source>, resolve: Box<dyn Resolve>) -> Result<Report, Error> {
    match Asset::open(main, resolve) {
        Ok(mut opened) => Ok(asset(&mut opened)),
        Err(Error::Schema(problem)) => {
            let mut report = Report::default();
            report.add(Code::Schema, "", problem);
            Ok(report)
        }
        Err(other) => Err(other),
    }
}

/// Checks a file that is open already.
pub fn asset(asset: &mut Asset) -> Report {
    let mut report = Report::default();
    container::check(asset, &mut report);
    structure::check(asset.root(), asset.json(), &mut report);
    buffers::check(asset, &mut report);
    uses::check(asset.root(), &mut report);
    nodes::check(asset.root(), &mut report);
    meshes::check(asset, &mut report);
    animations::check(asset.root(), &mut report);
    data::check(asset, &mut report);
    unused::check(asset.root(), &mut report);
    report
}

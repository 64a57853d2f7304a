//! `dat2glb inspect`: what a file holds.

use super::args::Inspect;
use super::exit::{Exit, Failure, shown};
use super::files;
use dat2glb::inspect;
use dat2glb::read::Input;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, Read, Write};
use std::path::Path;

pub(super) fn run(options: &Inspect) -> Result<Exit, Failure> {
    let file = &options.file;
    if !files::is_standard(file) && is_gltf(file)? {
        return print(&inspect::gltf(&mut files::asset(file)?), options);
    }
    match files::input(file, options.order.order)? {
        Input::Keyframes(keyframes) => print(&inspect::keyframes(&keyframes), options),
        Input::Path(path) => print(&inspect::path(&path), options),
        Input::Rotations(rotations) => print(&inspect::rotations(&rotations), options),
        _ => Err(Failure::refused(format!("{}: a kind of input that is not known here", file.display()))),
    }
}

/// Whether a file looks like a .glb, or like the JSON of a .gltf.
fn is_gltf(file: &Path) -> Result<bool, Failure> {
    let mut start = Vec::new();
    let read = files::open(file)?.take(64).read_to_end(&mut start);
    read.map_err(|error| Failure::refused(format!("{}: {error}", file.display())))?;
    Ok(start.starts_with(b"glTF") || start.trim_ascii_start().starts_with(b"{"))
}

fn print(summary: &(impl Serialize + Display), options: &Inspect) -> Result<Exit, Failure> {
    files::unchanged()?;
    let text = if options.json {
        let mut value = serde_json::to_value(summary).expect("plain data becomes JSON");
        value["schema"] = 1.into();
        value["file"] = options.file.display().to_string().into();
        format!("{value:#}\n")
    } else {
        format!("{}\n{summary}", options.file.display())
    };
    shown(io::stdout().write_all(text.as_bytes()))?;
    Ok(Exit::Done)
}

//! `dat2glb thumbnail`: a picture of a file.

use super::args::Thumbnail;
use super::exit::{Exit, Failure, say};
use super::files::{self, is_standard};
use super::output::Output;
use dat2glb::asset::Asset;
use dat2glb::render::{self, Options, Picture};
use std::io::Write;
use std::path::Path;

pub(super) fn run(arguments: &Thumbnail) -> Result<Exit, Failure> {
    let file = &arguments.file;
    let mut asset = files::asset(file)?;
    let path = arguments.output.clone().unwrap_or_else(|| file.with_extension("png"));
    let output = match is_standard(&path) {
        true => Output::standard_output()?,
        false => Output::create(&path, std::slice::from_ref(file))?,
    };
    let options = Options {
        size: arguments.size,
        time: arguments.time,
        clip: arguments.clip.clone(),
        renderer: arguments.renderer.renderer,
        ..Options::default()
    };
    let picture = draw(&mut asset, &options, file)?;
    if !arguments.quiet {
        picture.notes.iter().for_each(|note| say(&format!("{}: {note}", file.display())));
    }
    let png = picture.png();
    let failed = |error| Failure::environment(format!("{}: cannot be written: {error}", path.display()));
    output.file().write_all(&png).map_err(failed)?;
    output.commit()?;
    Ok(Exit::Done)
}

/// Draws a picture; what goes wrong is said of `file`.
pub(super) fn draw(asset: &mut Asset, options: &Options, file: &Path) -> Result<Picture, Failure> {
    render::thumbnail(asset, options).map_err(|error| failure(&error, file))
}

/// What a failed drawing means for the exit code.
pub(super) fn failure(error: &render::Error, file: &Path) -> Failure {
    let exit = match error {
        render::Error::NoAdapter { .. } | render::Error::Adapter { .. } => Exit::Environment,
        render::Error::Size(..) | render::Error::NoClip { .. } => Exit::Usage,
        _ => Exit::Refused,
    };
    Failure::new(exit, format!("{}: {error}", file.display()))
}

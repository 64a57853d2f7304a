//! `dat2glb thumbnail`: pictures of a file, still and moving.

use super::args::Thumbnail;
use super::exit::{Exit, Failure, say};
use super::files::{self, is_standard};
use super::output::Output;
use super::progress::Progress;
use dat2glb::asset::Asset;
use dat2glb::render::encode::{self, Format};
use dat2glb::render::{self, MOST_PIXELS, Options, Picture, Session, Style, Time, Which};
use dat2glb::sample::Fps;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Pixels of the longer side, unless they are said.
const SIDE: u32 = 512;
/// GIF's times are hundredths of a second, and viewers take one of them for ten.
const MOST_OF_GIF: f64 = 50.0;

pub(super) fn run(arguments: &Thumbnail) -> Result<Exit, Failure> {
    let file = &arguments.file;
    let path = arguments.output.clone().unwrap_or_else(|| file.with_extension("png"));
    let mut asset = files::asset(file)?;
    let output = match is_standard(&path) {
        true => Output::standard_output()?,
        false => Output::create(&path, std::slice::from_ref(file))?,
    };
    let format = format(arguments, &path)?;
    let mut session = Session::new(&mut asset, arguments.renderer.renderer).map_err(|e| failure(&e, file))?;
    let of_file = |error| match error {
        render::Error::Write(error) => cannot_write(&path, &error),
        error => failure(&error, file),
    };
    let notes = match format {
        None => {
            let picture = still(&mut session, &mut asset, arguments).map_err(of_file)?;
            output.file().write_all(&picture.png()).map_err(|error| cannot_write(&path, &error))?;
            picture.notes
        }
        Some(format) => {
            moving(&mut session, &mut asset, arguments, format, &output).map_err(of_file)?;
            session.notes().to_vec()
        }
    };
    if !arguments.quiet {
        notes.iter().for_each(|note| say(&format!("{}: {note}", file.display())));
    }
    output.commit()?;
    Ok(Exit::Done)
}

/// The format of moving pictures, or none for a still one; refuses options that belong to
/// the other kind.
fn format(arguments: &Thumbnail, path: &Path) -> Result<Option<Format>, Failure> {
    let shown = path.display();
    let ending = path.extension().map(|ending| ending.to_string_lossy().into_owned());
    let format = ending.as_deref().and_then(Format::of_ending);
    let is_png = ending.as_deref().is_none_or(|ending| ending.eq_ignore_ascii_case("png"));
    if format.is_none() && !is_png && !is_device(path) {
        let kinds = ".png for an image, .gif, .apng or .webp for an animation";
        return Err(Failure::usage(format!("{shown}: expected a name that ends in {kinds}")));
    }
    let still = [
        ("--time", arguments.time.is_some()),
        ("--sheet", arguments.sheet.is_some()),
        ("--ghost", arguments.ghost.is_some()),
    ];
    let moving = [
        ("--fps", arguments.fps.is_some()),
        ("--turntable", arguments.turntable),
        ("--loop", arguments.repeat),
    ];
    let (wrong, kind, right) = match format {
        Some(_) => (still, "images", ".png"),
        None => (moving, "animations", ".gif, .apng or .webp"),
    };
    if let Some((option, _)) = wrong.into_iter().find(|(_, given)| *given) {
        return Err(Failure::usage(format!("{option} is for {kind}, {right}; found {shown}")));
    }
    if format == Some(Format::Gif) && 1.0 / rate(arguments).interval() > MOST_OF_GIF {
        let advice = ".apng and .webp can have more";
        return Err(Failure::usage(format!("{shown}: GIF plays at most 50 frames per second: {advice}")));
    }
    Ok(format)
}

/// Whether a path leads to something that is there and no file, such as a pipe.
fn is_device(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|found| !found.is_file())
}

fn rate(arguments: &Thumbnail) -> Fps {
    arguments.fps.unwrap_or_else(|| "25".parse().expect("a frame rate"))
}

fn still(session: &mut Session, asset: &mut Asset, arguments: &Thumbnail) -> Result<Picture, render::Error> {
    let (clips, style) = (clips(session, arguments)?, style(session, arguments)?);
    let time = |usual| arguments.time.unwrap_or(Time::Fraction(usual));
    if let Some(grid) = arguments.sheet {
        return session.sheet(asset, &clips, grid, &style);
    }
    if let Some(poses) = arguments.ghost {
        return session.ghost(asset, &clips, poses, time(1.0), &style);
    }
    match clips[..] {
        [clip] if !arguments.side_by_side => session.picture(asset, clip, time(0.5), &style),
        _ => session.abreast(asset, &clips, time(0.5), &style),
    }
}

fn moving(
    session: &mut Session,
    asset: &mut Asset,
    arguments: &Thumbnail,
    format: Format,
    output: &Output,
) -> Result<(), render::Error> {
    let (clips, style) = (clips(session, arguments)?, style(session, arguments)?);
    let film = session.film(asset, &clips, &style, rate(arguments), arguments.turntable)?;
    let mut progress = Progress::new(film.frames() as u64, arguments.quiet);
    let repeats = arguments.repeat || film.closed();
    let out = BufWriter::new(output.file());
    encode::film((session, asset), &film, (format, repeats), out, || progress.advance(1))
}

/// The clip asked for, or all of them.
fn clips(session: &Session, arguments: &Thumbnail) -> Result<Vec<Which>, render::Error> {
    match arguments.side_by_side && !session.clips().is_empty() {
        true => Ok((0..session.clips().len()).map(Some).collect()),
        false => Ok(vec![session.clip(arguments.clip.as_deref())?]),
    }
}

fn style(session: &Session, arguments: &Thumbnail) -> Result<Style, render::Error> {
    let aspect = arguments.camera.as_deref().map(|camera| session.aspect(camera)).transpose()?.flatten();
    let shorter = |share: f64| (f64::from(SIDE) * share).round().clamp(1.0, f64::from(MOST_PIXELS)) as u32;
    let usual = match aspect {
        Some(aspect) if aspect > 1.0 => (SIDE, shorter(1.0 / aspect)),
        Some(aspect) => (shorter(aspect), SIDE),
        None => (SIDE, SIDE),
    };
    Ok(Style {
        size: arguments.size.unwrap_or(usual),
        background: arguments.background,
        camera: arguments.camera.clone(),
        floor: arguments.floor,
    })
}

/// Draws a picture; what goes wrong is said of `file`.
pub(super) fn draw(asset: &mut Asset, options: &Options, file: &Path) -> Result<Picture, Failure> {
    render::thumbnail(asset, options).map_err(|error| failure(&error, file))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::environment(format!("{}: cannot be written: {error}", path.display()))
}

/// What a failed drawing means for the exit code.
pub(super) fn failure(error: &render::Error, file: &Path) -> Failure {
    use render::Error::{Adapter, Cells, Frames, NoAdapter, NoCamera, NoClip, NothingMoves, Rate, Size};
    let exit = match error {
        NoAdapter { .. } | Adapter { .. } => Exit::Environment,
        Size(..) | Cells { .. } | NoClip { .. } | NoCamera { .. } | Frames(_) | Rate(_) => Exit::Usage,
        NothingMoves => Exit::Usage,
        _ => Exit::Refused,
    };
    Failure::new(exit, format!("{}: {error}", file.display()))
}

//! `dat2glb diff`: how differently two files move.

use super::args::Diff as Arguments;
use super::check::{judged, print_document, print_findings};
use super::exit::{Exit, Failure, shown};
use super::files;
use dat2glb::asset::Asset;
use dat2glb::check::{Report, Severity};
use dat2glb::diff::{self, Diff, Difference, Limits, Measure, Which};
use dat2glb::report::{Format, Run, Subject};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::Path;

pub(super) fn run(options: &Arguments) -> Result<Exit, Failure> {
    let compared = compare(options);
    let (exit, file, outcome) = match &compared {
        Ok((_, diff)) => {
            let report = diff.report(&limits(options));
            if !options.report.quiet {
                shown(print(diff, &report, options))?;
            }
            (judged(&report, fails_from(options)), options.b.as_path(), Ok(report))
        }
        Err((file, failure)) => {
            failure.print();
            if options.report.format() == Format::Json {
                super::summary::print_failure(file, failure)?;
            }
            (failure.exit, *file, Err(failure.message.clone()))
        }
    };
    if !options.report.quiet {
        let subjects = vec![Subject { file: name(file), outcome }];
        let run = Run { command: "diff", subjects, fails_from: fails_from(options), exit: exit as u8 };
        print_document(&run, options.report.format())?;
    }
    if let Ok((mut assets, diff)) = compared {
        draw(&mut assets, &diff, options)?;
    }
    Ok(exit)
}

fn name(path: &Path) -> String {
    path.display().to_string()
}

fn fails_from(options: &Arguments) -> Severity {
    if options.strict { Severity::Warning } else { Severity::Error }
}

fn limits(options: &Arguments) -> Limits {
    Limits {
        degrees: options.max_error,
        units: options.max_distance,
        scale: options.max_scale,
        weight: options.max_weight,
    }
}

type Assets = (Asset, Asset);

/// Compares the files, or says which of them is to blame and for what.
fn compare(options: &Arguments) -> Result<(Assets, Diff), (&Path, Failure)> {
    fn open(path: &Path) -> Result<Asset, (&Path, Failure)> {
        files::asset(path).map_err(|failure| (path, failure))
    }
    let (mut a, mut b) = (open(&options.a)?, open(&options.b)?);
    let diff = diff::files(&mut a, &mut b, &options.map).map_err(|error| failure(error, options))?;
    files::unchanged().map_err(|failure| (options.b.as_path(), failure))?;
    Ok(((a, b), diff))
}

fn failure(error: diff::Error, options: &Arguments) -> (&Path, Failure) {
    let file = |which: Which| match which {
        Which::A => options.a.as_path(),
        Which::B => options.b.as_path(),
    };
    match &error {
        diff::Error::Asset { which, error } => {
            let file = file(*which);
            let message = format!("{}: {error}\nrun `dat2glb check` on it for all errors", name(file));
            (file, Failure::refused(message))
        }
        diff::Error::Name { which, .. } => {
            let file = file(*which);
            (file, Failure::usage(format!("--map: {}: {error}", name(file))))
        }
        _ => (options.b.as_path(), Failure::refused(error.to_string())),
    }
}

fn print(diff: &Diff, report: &Report, options: &Arguments) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match options.report.format() {
        Format::Json => writeln!(out, "{}", as_json(diff, report, options)),
        Format::Text => {
            writeln!(out, "{} against {}", name(&options.b), name(&options.a))?;
            write!(out, "{}", diff.text())?;
            print_findings(&mut out, &name(&options.b), report)
        }
        _ => Ok(()),
    }
}

/// The report of findings, and all that was measured.
fn as_json(diff: &Diff, report: &Report, options: &Arguments) -> Value {
    let mut value = report.to_json();
    value["file"] = name(&options.b).into();
    value["against"] = name(&options.a).into();
    value["largest"] = Measure::ALL
        .iter()
        .filter_map(|&measure| diff.largest(measure))
        .map(|found| {
            let Difference { measure, off, time } = found.difference;
            let (clip, node) = (&found.clip.clip, &found.node.node);
            json!({"measure": measure, "off": off, "time": time, "clip": clip, "node": node})
        })
        .collect();
    let measured = serde_json::to_value(diff).expect("plain data becomes JSON");
    if let (Value::Object(value), Value::Object(measured)) = (&mut value, measured) {
        value.extend(measured);
    }
    value
}

/// Draws both poses where they differ most; half way through the first clip where they
/// do not.
#[cfg(feature = "render")]
fn draw(assets: &mut Assets, diff: &Diff, options: &Arguments) -> Result<(), Failure> {
    use super::exit::say;
    use super::output::Output;
    use dat2glb::render::{Background, Moment, side_by_side};
    let Some(path) = &options.picture else { return Ok(()) };
    let output = match files::is_standard(path) {
        true => return Err(Failure::usage("--picture: expected a file: the report goes to standard output")),
        false => Output::create(path, &[options.a.clone(), options.b.clone()])?,
    };
    let found = diff.most_telling(&limits(options));
    let Some(clip) = found.map(|found| found.clip).or(diff.clips.first()) else { return Ok(()) };
    let time = found.map_or(clip.seconds.a / 2.0, |found| found.difference.time);
    let moment = |clip: Option<usize>| Moment { clip, time };
    let left = (&mut assets.0, moment(clip.animation.map(|animation| animation.a)));
    let right = (&mut assets.1, moment(clip.animation.map(|animation| animation.b)));
    let renderer = options.renderer.renderer;
    let picture = side_by_side(left, right, options.size, renderer, Background::default())
        .map_err(|error| super::thumbnail::failure(&error, path))?;
    if !options.report.quiet {
        picture.notes.iter().for_each(|note| say(&format!("{}: {note}", path.display())));
    }
    let failed = |error| Failure::environment(format!("{}: cannot be written: {error}", path.display()));
    output.file().write_all(&picture.png()).map_err(failed)?;
    output.commit()
}

#[cfg(not(feature = "render"))]
fn draw(_: &mut Assets, _: &Diff, _: &Arguments) -> Result<(), Failure> {
    Ok(())
}

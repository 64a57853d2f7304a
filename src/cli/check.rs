//! `dat2glb check`: files against the specification, their input, and the eye.

use super::args::Check;
use super::exit::{Exit, Failure, shown};
use super::files;
use dat2glb::asset::{self, Asset};
use dat2glb::check::motion::{self, ClipMotion, Given};
use dat2glb::check::{self, Code, Report, Severity};
use dat2glb::report::{Format, Run, Subject};
use std::io::{self, Write};
use std::path::Path;

pub(super) fn run(options: &Check) -> Result<Exit, Failure> {
    let mut worst = Exit::Done;
    let mut subjects = Vec::new();
    for file in &options.files {
        let outcome = match one(file, options) {
            Ok(report) => {
                worst = worst.max(judged(&report, limit(options)));
                Ok(report)
            }
            Err(failure) => {
                failure.print();
                if options.report.format() == Format::Json {
                    super::summary::print_failure(file, &failure)?;
                }
                worst = worst.max(failure.exit);
                Err(failure.message)
            }
        };
        subjects.push(Subject { file: file.display().to_string(), outcome });
    }
    if !options.report.quiet {
        let run = Run { command: "check", subjects, fails_from: limit(options), exit: worst as u8 };
        print_document(&run, options.report.format())?;
    }
    Ok(worst)
}

/// What counts as failed.
fn limit(options: &Check) -> Severity {
    if options.strict { Severity::Warning } else { Severity::Error }
}

/// The exit code of a report, of which findings from a severity on fail.
pub(super) fn judged(report: &Report, fails_from: Severity) -> Exit {
    if report.worst() >= Some(fails_from) { Exit::Failed } else { Exit::Done }
}

/// Prints a run in a format that takes all of it together.
pub(super) fn print_document(run: &Run, format: Format) -> Result<(), Failure> {
    match run.document(format) {
        Some(document) => shown(io::stdout().write_all(document.as_bytes())),
        None => Ok(()),
    }
}

fn one(file: &Path, options: &Check) -> Result<Report, Failure> {
    files::forget();
    let (report, motions) = match files::asset_or_schema(file)? {
        Ok(mut asset) => {
            let mut report = check::asset(&mut asset);
            let motions = compare(&mut asset, file, options, &mut report)?;
            look(&mut asset, file, options, &mut report)?;
            (report, motions)
        }
        Err(asset::Error::Schema(problem)) => {
            let mut report = Report::default();
            report.add(Code::Schema, "", problem);
            (report, Vec::new())
        }
        Err(error) => return Err(files::cannot_read(file, &error)),
    };
    files::unchanged()?;
    if !options.report.quiet {
        shown(print(file, options, &report, &motions))?;
    }
    Ok(report)
}

fn compare(
    asset: &mut Asset,
    file: &Path,
    options: &Check,
    report: &mut Report,
) -> Result<Vec<ClipMotion>, Failure> {
    if options.against.is_empty() {
        return Ok(Vec::new());
    }
    let order = options.order.order.or(motion::quat_order(asset));
    let paths: Vec<&Path> = options.against.iter().map(|path| path.as_path()).collect();
    let inputs = files::gather(&paths, order, motion::frame(asset))?.inputs;
    let Check { scheme, ends, max_error, max_distance, .. } = *options;
    motion::compare(asset, &inputs, Given { scheme, ends, max_error, max_distance }, report).map_err(
        |error| {
            let message = format!("{}: {error}", file.display());
            match error {
                motion::Error::NoRecipe => Failure::usage(message),
                _ => Failure::refused(message),
            }
        },
    )
}

#[cfg(feature = "render")]
fn look(asset: &mut Asset, file: &Path, options: &Check, report: &mut Report) -> Result<(), Failure> {
    use super::exit::say;
    if !options.render {
        return Ok(());
    }
    let look = dat2glb::render::look(asset, (256, 256), options.renderer.renderer)
        .map_err(|error| super::thumbnail::failure(&error, file))?;
    if !options.report.quiet {
        look.notes.iter().for_each(|note| say(&format!("{}: {note}", file.display())));
    }
    if !look.visible() {
        let message =
            format!("{:.3} % of a picture's pixels are drawn, less than 0.1 %", 100.0 * look.covered);
        report.add(Code::NothingVisible, "", message);
    }
    for clip in look.clips.iter().filter(|clip| clip.moves == Some(false)) {
        let name = clip.name.as_deref().unwrap_or("without a name");
        let message =
            format!("clip {name}: the pictures at 0, 25, 50 and 75 % are the same, though channels change");
        report.add(Code::NothingMoves, format!("/animations/{}", clip.animation), message);
    }
    Ok(())
}

#[cfg(not(feature = "render"))]
fn look(_: &mut Asset, _: &Path, _: &Check, _: &mut Report) -> Result<(), Failure> {
    Ok(())
}

fn print(file: &Path, options: &Check, report: &Report, motions: &[ClipMotion]) -> io::Result<()> {
    let name = file.display().to_string();
    let mut out = io::stdout().lock();
    if !matches!(options.report.format(), Format::Text | Format::Json) {
        return Ok(());
    }
    if options.report.format() == Format::Json {
        let mut value = report.to_json();
        value["file"] = name.into();
        if !options.against.is_empty() {
            value["motion"] = serde_json::to_value(motions).expect("plain data becomes JSON");
        }
        return writeln!(out, "{value}");
    }
    for clip in motions {
        writeln!(out, "{name}: clip {} against {} with {} ends:", clip.clip, clip.scheme, clip.ends)?;
        for motion in &clip.boxes {
            let unit = if motion.property == "rotation" { "°" } else { " units" };
            let proven = if motion.proven { ", proven" } else { "" };
            let limit = motion
                .limit
                .map_or(String::new(), |limit| format!(" (at most {limit:.6}{unit} allowed{proven})"));
            let kinds = [
                ("keys", motion.difference.keys),
                ("samples", motion.difference.samples),
                ("between", motion.difference.between),
            ];
            let offs: Vec<String> = kinds
                .map(|(kind, largest)| {
                    format!("{kind} {} at {:.3} s", amount(largest.off, unit), largest.time)
                })
                .into();
            writeln!(out, "{name}:   {}{}: {}{limit}", motion.node, what(motion.property), offs.join(", "))?;
        }
    }
    print_findings(&mut out, &name, report)
}

/// The findings of a file for people, and how many there are.
pub(super) fn print_findings(out: &mut impl Write, name: &str, report: &Report) -> io::Result<()> {
    write!(out, "{}", report.text(name))?;
    let count = |severity, one: &str| match report.count(severity) {
        1 => format!("1 {one}"),
        n => format!("{n} {one}s"),
    };
    let (errors, warnings) = (count(Severity::Error, "error"), count(Severity::Warning, "warning"));
    writeln!(out, "{name}: {errors}, {warnings}, {}", count(Severity::Info, "info"))
}

/// An angle or a distance for people: tiny ones by their order.
fn amount(off: f64, unit: &str) -> String {
    if off < 1e-3 { format!("{off:.1e}{unit}") } else { format!("{off:.4}{unit}") }
}

/// Which property, where it is not the usual one.
fn what(property: &str) -> String {
    if property == "rotation" { String::new() } else { format!(" {property}") }
}

//! `dat2glb reduce`: a file's animations with fewer keys, all else as it was.

use super::args::Reduce;
use super::aside::Turn;
use super::bins::{bin_file_name, percent_encoded, remove_old_bins};
use super::exit::{Exit, Failure, say, shown};
use super::files::{self, Beside, display_name, is_standard};
use super::output::Output;
use super::summary::size;
use dat2glb::asset::{Asset, Container, Resolve, Source};
use dat2glb::check::{self, Report, Severity};
use dat2glb::rewrite::{self, ClipFacts, Facts, Reduced, Strayed};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Cursor, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::Instant;

pub(super) fn run(options: &Reduce) -> Result<Exit, Failure> {
    let started = Instant::now();
    let (input, output) = (&options.input, &options.output);
    let (main, mut asset) = opened(input)?;
    let beside = referred_to(&asset);
    check_ending(output, &asset)?;
    let wanted = rewrite::Options {
        rotation: options.tolerance,
        distance: options.tolerance_distance,
        scale: options.tolerance_scale,
        weight: options.tolerance_weight,
        max_step: options.max_step,
        on_curve: options.on_curve,
    };
    let uri = |hash: &str| percent_encoded(&bin_file_name(output, hash));
    let reduced = rewrite::reduce(&mut asset, &wanted, uri).map_err(|error| match error {
        rewrite::Error::Tolerance { .. } => Failure::usage(format!("--tolerance: {error}")),
        other => Failure::refused(format!("{}: {other}", display_name(input))),
    })?;
    check_neighbours(options, &beside, &reduced)?;
    let read: Vec<PathBuf> = std::iter::once(input.clone())
        .chain(beside.iter().map(|(_, uri)| input.with_file_name(uri)))
        .collect();
    let outputs = begun(output, &read, &main, &reduced)?;
    if reduced.main.is_some() {
        // The disk takes its time.
        thread::scope(|scope| {
            let on_disk = scope.spawn(|| outputs.iter().try_for_each(|output| output.file().sync_data()));
            checked(output, outputs.last(), &mut asset, &reduced)?;
            let on_disk = on_disk.join().unwrap_or_else(|_| Err(io::ErrorKind::Other.into()));
            on_disk.map_err(|error| unwritten(output, &error))
        })?;
    }
    files::unchanged()?;
    let turn = (!reduced.files.is_empty()).then(|| Turn::at(output));
    Output::commit_all(outputs)?;
    if !reduced.files.is_empty() {
        let new = reduced.files.iter().map(|file| bin_file_name(output, &file.hash));
        remove_old_bins(output, &new.chain(beside.into_iter().map(|(_, uri)| uri)).collect::<Vec<_>>());
    }
    drop(turn);
    print(options, &reduced.facts, started)?;
    Ok(Exit::Done)
}

/// Where the input is read from again.
enum Main {
    File(File),
    /// What can be read only once.
    Memory(Shared),
}

/// Bytes in memory once.
#[derive(Clone)]
struct Shared(Arc<Vec<u8>>);

impl AsRef<[u8]> for Shared {
    fn as_ref(&self) -> &[u8] {
        &self.0
    }
}

impl Main {
    fn open(input: &Path) -> Result<Main, Failure> {
        let mut bytes = Vec::new();
        let read = if is_standard(input) {
            io::stdin().read_to_end(&mut bytes)
        } else {
            let mut file = files::open(input)?;
            if file.metadata().is_ok_and(|metadata| metadata.is_file()) {
                return Ok(Main::File(file));
            }
            file.read_to_end(&mut bytes)
        };
        read.map_err(|error| unread(input, &error))?;
        Ok(Main::Memory(Shared(Arc::new(bytes))))
    }

    fn source(&self) -> io::Result<Box<dyn Source>> {
        Ok(match self {
            Main::File(file) => Box::new(file.try_clone()?),
            Main::Memory(bytes) => Box::new(Cursor::new(bytes.clone())),
        })
    }

    fn copy(&self, mut to: &File) -> io::Result<()> {
        match self {
            Main::File(file) => {
                let mut file = file.try_clone()?;
                file.rewind()?;
                io::copy(&mut file, &mut to).map(drop)
            }
            Main::Memory(bytes) => to.write_all(bytes.as_ref()),
        }
    }
}

fn unread(input: &Path, error: &io::Error) -> Failure {
    Failure::refused(format!("{}: cannot be read: {error}", display_name(input)))
}

fn unwritten(output: &Path, error: &io::Error) -> Failure {
    Failure::environment(format!("{}: cannot be written: {error}", output.display()))
}

fn opened(input: &Path) -> Result<(Main, Asset), Failure> {
    let main = Main::open(input)?;
    let source = main.source().map_err(|error| unread(input, &error))?;
    let asset = Asset::open(source, Box::new(Beside::the(input)));
    Ok((main, asset.map_err(|error| files::cannot_read(input, &error))?))
}

/// Other files that the file names, with the index of the buffer or none for an image.
fn referred_to(asset: &Asset) -> Vec<(Option<usize>, String)> {
    let root = asset.root();
    let buffers = root.buffers.iter().enumerate().map(|(i, buffer)| (Some(i), buffer.uri.as_ref()));
    let images = root.images.iter().map(|image| (None, image.uri.as_ref()));
    let named = buffers.chain(images).filter_map(|(index, uri)| Some((index, uri?)));
    named.filter(|(_, uri)| !uri.starts_with("data:")).map(|(index, uri)| (index, decoded(uri))).collect()
}

/// A relative URI as a path; what is no escape stays as it is.
fn decoded(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, tail)) = rest.split_first() {
        let code = tail.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let code = code.and_then(|two| u8::from_str_radix(two, 16).ok()).filter(|_| byte == b'%');
        bytes.push(code.unwrap_or(byte));
        rest = if code.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A file stays what it is, .glb or .gltf.
fn check_ending(output: &Path, asset: &Asset) -> Result<(), Failure> {
    let kind = match asset.container() {
        Container::Glb(_) => "glb",
        Container::Text { .. } => "gltf",
    };
    let same = output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(kind));
    let device = fs::metadata(output).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir());
    if same || device || is_standard(output) {
        return Ok(());
    }
    let output = output.display();
    Err(Failure::usage(format!("{output}: expected an output that ends in .{kind}, as the input is one")))
}

/// What the output will refer to and is not written must be where it is looked for.
fn check_neighbours(
    options: &Reduce,
    beside: &[(Option<usize>, String)],
    reduced: &Reduced,
) -> Result<(), Failure> {
    let (input, output) = (&options.input, &options.output);
    let shown = output.display();
    if is_standard(output) {
        return match reduced.files.is_empty() {
            true => Ok(()),
            false => {
                Err(Failure::usage("a .gltf and its .bin do not fit into standard output: use -o OUT.gltf"))
            }
        };
    }
    let written = |index: &Option<usize>| reduced.files.iter().any(|file| Some(file.buffer) == *index);
    for (_, uri) in beside.iter().filter(|(index, _)| !written(index)) {
        let (Ok(from), Ok(to)) = (Beside::the(input).place(uri), Beside::the(output).place(uri)) else {
            continue; // nothing that is opened here
        };
        let there = content(&to);
        if there.is_none() && content(&from).is_none() {
            continue; // missing before, missing after
        }
        if from != to && there != content(&from) {
            return Err(Failure::usage(format!(
                "{shown}: expected a folder that has {uri}, which the input refers to: write into the \
                 input's folder, or copy that file first"
            )));
        }
    }
    Ok(())
}

/// The bytes of a file; none of a pipe or a device, which may have no end.
fn content(path: &Path) -> Option<Vec<u8>> {
    fs::metadata(path).ok().filter(|found| found.is_file()).and_then(|_| fs::read(path).ok())
}

/// Everything written, with names yet to come; what is referred to comes first.
fn begun(output: &Path, read: &[PathBuf], input: &Main, reduced: &Reduced) -> Result<Vec<Output>, Failure> {
    let failed = |error: io::Error| unwritten(output, &error);
    let mut outputs = Vec::new();
    for file in &reduced.files {
        let bin = Output::create(&output.with_file_name(bin_file_name(output, &file.hash)), read)?;
        bin.file().write_all(&file.bytes).map_err(failed)?;
        outputs.push(bin);
    }
    let main = if is_standard(output) { Output::standard_output()? } else { Output::create(output, read)? };
    match &reduced.main {
        Some(bytes) => main.file().write_all(bytes),
        None => input.copy(main.file()),
    }
    .map_err(failed)?;
    outputs.push(main);
    Ok(outputs)
}

/// Gives out the .bin files that have no names yet, and what lies beside the output.
struct Written {
    files: BTreeMap<String, Vec<u8>>,
    beside: Beside,
}

impl Resolve for Written {
    fn open(&self, uri: &str) -> io::Result<Box<dyn Source>> {
        match self.files.get(uri) {
            Some(bytes) => Ok(Box::new(Cursor::new(bytes.clone()))),
            None => self.beside.open(uri),
        }
    }
}

/// Loads back what will be written and refuses it if it has errors that the input had
/// not, or plays otherwise than it should.
fn checked(
    output: &Path,
    written: Option<&Output>,
    input: &mut Asset,
    reduced: &Reduced,
) -> Result<(), Failure> {
    let broken = |reason: String| {
        let message = format!("{}: the output failed its check and was not kept\n{reason}", output.display());
        Failure::new(Exit::Failed, message)
    };
    let files = reduced.files.iter().map(|file| (bin_file_name(output, &file.hash), file.bytes.clone()));
    let resolve = Written { files: files.collect(), beside: Beside::the(output) };
    let file = written.map(|output| output.file().try_clone()).transpose();
    let file = file.map_err(|error| broken(error.to_string()))?.ok_or_else(|| broken(String::new()))?;
    let opened = Asset::open(Box::new(file), Box::new(resolve));
    let mut asset = opened.map_err(|error| broken(error.to_string()))?;
    let after = check::asset(&mut asset);
    let errors = |report: &Report| -> Vec<check::Code> {
        let errors = report.findings().iter().filter(|finding| finding.severity == Severity::Error);
        errors.map(|finding| finding.code).collect()
    };
    // The input's are needed only where there are some.
    let before = if errors(&after).is_empty() { Report::default() } else { check::asset(input) };
    if errors(&after).into_iter().any(|code| after.count_of(code) > before.count_of(code)) {
        return Err(broken(after.text(&output.display().to_string())));
    }
    let played = rewrite::strayed(input, &mut asset).map_err(|error| broken(error.to_string()))?;
    let stated = worst(&reduced.facts);
    if !within(played, stated) {
        return Err(broken(format!("its playback error is {played:?}, expected {stated:?} at most")));
    }
    Ok(())
}

/// What f64 may add to a distance.
const ROUNDING: f64 = 1e-9;

fn within(played: Strayed, stated: Strayed) -> bool {
    let pairs = [
        (played.degrees, stated.degrees),
        (played.units, stated.units),
        (played.scale, stated.scale),
        (played.weight, stated.weight),
    ];
    pairs.iter().all(|(played, stated)| *played <= stated * (1.0 + ROUNDING) + ROUNDING)
}

fn worst(facts: &Facts) -> Strayed {
    facts.clips.iter().map(|clip| clip.deviation).fold(Strayed::default(), Strayed::max)
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Summary<'a> {
    schema: u32,
    input: String,
    output: String,
    #[serde(flatten)]
    facts: &'a Facts,
    deviation: Strayed,
    elapsed_seconds: f64,
}

fn print(options: &Reduce, facts: &Facts, started: Instant) -> Result<(), Failure> {
    let elapsed = started.elapsed().as_secs_f64();
    if options.json {
        let summary = Summary {
            schema: 1,
            input: display_name(&options.input),
            output: options.output.display().to_string(),
            facts,
            deviation: worst(facts),
            elapsed_seconds: elapsed,
        };
        let line = serde_json::to_string(&summary).expect("plain data becomes JSON");
        if is_standard(&options.output) {
            say(&line);
        } else {
            shown(writeln!(io::stdout(), "{line}"))?;
        }
    } else if !options.quiet {
        for (i, clip) in facts.clips.iter().enumerate() {
            say(&clip_line(i, clip));
        }
        let (before, after) = (size(facts.bytes_before), size(facts.bytes_after));
        let saved = if facts.bytes_after < facts.bytes_before { "" } else { ", nothing could be saved" };
        say(&format!("{}: {before} → {after}{saved}, {elapsed:.3} s", options.output.display()));
    }
    Ok(())
}

fn clip_line(index: usize, clip: &ClipFacts) -> String {
    let name = clip.name.clone().unwrap_or_else(|| format!("animation {index}"));
    let Strayed { degrees, units, scale, weight } = clip.deviation;
    let parts = [(degrees, "°"), (units, " units"), (scale, " of scale"), (weight, " of weights")];
    let parts = parts.iter().filter(|(distance, _)| *distance > 0.0);
    let parts: Vec<String> = parts.map(|(distance, unit)| format!("{}{unit}", rounded(*distance))).collect();
    let within = if parts.is_empty() { String::new() } else { format!(", max error {}", parts.join(", ")) };
    format!("{name}: {} → {} keys{within}", clip.keys_before, clip.keys_after)
}

/// Four digits, rounded up: a bound stays one.
fn rounded(x: f64) -> f64 {
    let unit = libm::pow(10f64, libm::log10(x).floor() - 3.0);
    let up = (x / unit).ceil() * unit;
    format!("{up:.3e}").parse().unwrap_or(up)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_rounded_up() {
        for (x, text) in [(0.0123456, "0.01235"), (0.1, "0.1"), (1.00001, "1.001"), (3e-8, "0.00000003")] {
            assert_eq!(rounded(x).to_string(), text);
        }
    }

    #[test]
    fn uris_become_paths() {
        assert_eq!(decoded("a%20b%C3%A4.bin"), "a bä.bin");
        assert_eq!(decoded("100%.bin"), "100%.bin");
    }
}

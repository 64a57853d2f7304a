//! `dat2glb convert`: every input through all stages, one after another.

use super::args::Convert;
use super::exit::{Exit, Failure};
use super::files::{self, Beside, display_name, is_standard};
use super::output::Output;
use super::progress::Progress;
use super::summary::Summary;
use dat2glb::asset::{Asset, Resolve, Source};
use dat2glb::check::{self, Report, Severity};
use dat2glb::convert::{ClipFacts, Options, Plan};
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What the samples are collected in before they are written.
const WRITE_BUFFER: usize = 1 << 20;

pub(super) fn run(options: &Convert) -> Result<Exit, Failure> {
    let jobs = jobs(options)?;
    let mut worst = Exit::Done;
    for job in &jobs {
        match convert(job, options) {
            Ok(()) => {}
            Err(failure) => {
                failure.print();
                if options.json {
                    super::summary::print_failure(&job.input, &failure)?;
                }
                worst = worst.max(failure.exit);
            }
        }
    }
    Ok(worst)
}

/// One input and where its outputs go.
struct Job {
    input: PathBuf,
    output: PathBuf,
    thumbnail: Option<PathBuf>,
}

/// Works out every output before anything is read.
fn jobs(options: &Convert) -> Result<Vec<Job>, Failure> {
    let several = options.inputs.len() > 1;
    let mut jobs: Vec<Job> = Vec::new();
    for input in &options.inputs {
        let output = match &options.output {
            Some(folder) if several || is_folder(folder) => in_folder(folder, input, "glb", several)?,
            Some(output) => output.clone(),
            None if is_standard(input) => {
                return Err(Failure::usage(
                    "standard input has no name for the output to take: say -o OUT.glb",
                ));
            }
            None => input.with_extension("glb"),
        };
        let thumbnail = match thumbnail_path(options) {
            Some(folder) if several || is_folder(folder) => Some(in_folder(folder, input, "png", several)?),
            other => other.cloned(),
        };
        check_ending(&output)?;
        if thumbnail.as_ref() == Some(&output) {
            let output = output.display();
            return Err(Failure::usage(format!("{output}: expected a name of its own for the thumbnail")));
        }
        if let Some(twin) = jobs.iter().find(|job| job.output == output) {
            let (a, b, output) = (twin.input.display(), input.display(), output.display());
            return Err(Failure::usage(format!("{a} and {b} would both become {output}")));
        }
        jobs.push(Job { input: input.clone(), output, thumbnail });
    }
    Ok(jobs)
}

fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.as_os_str().as_encoded_bytes().ends_with(b"/")
}

fn in_folder(folder: &Path, input: &Path, ending: &str, make: bool) -> Result<PathBuf, Failure> {
    if is_standard(folder) {
        return Err(Failure::usage("several inputs do not fit into standard output: say -o FOLDER"));
    }
    if (make || is_folder(folder)) && !folder.exists() {
        fs::create_dir_all(folder).map_err(|error| {
            Failure::environment(format!("{}: cannot be made: {error}", folder.display()))
        })?;
    }
    if !folder.is_dir() {
        return Err(Failure::usage(format!(
            "{}: expected a folder for several inputs, found a file",
            folder.display()
        )));
    }
    Ok(folder.join(format!("{}.{ending}", stem(input))))
}

/// A name without folders and ending: of the animations, and of outputs.
fn stem(input: &Path) -> String {
    match input.file_stem() {
        Some(stem) if !is_standard(input) => stem.to_string_lossy().into_owned(),
        _ => "stdin".to_owned(),
    }
}

fn is_gltf(output: &Path) -> bool {
    output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gltf"))
}

fn check_ending(output: &Path) -> Result<(), Failure> {
    let glb = output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb"));
    let device = fs::metadata(output).is_ok_and(|metadata| !metadata.is_file());
    if glb || device || is_gltf(output) || is_standard(output) {
        return Ok(());
    }
    Err(Failure::usage(format!("{}: expected an output that ends in .glb or .gltf", output.display())))
}

fn convert(job: &Job, options: &Convert) -> Result<(), Failure> {
    let started = Instant::now();
    let name = display_name(&job.input);
    let paths: Vec<&Path> = std::iter::once(&job.input).chain(&options.path).map(PathBuf::as_path).collect();
    let gathered = files::gather(&paths, options.order.order, options.frame)?;
    let recipe = Options {
        name: stem(&job.input),
        inputs: gathered.names.clone(),
        schemes: options.schemes(),
        fps: options.fps,
        key_times: !options.no_key_times,
    };
    let shape = options.along.shape(options.ends, options.tangents.tcb(), options.time_scale, options.frame);
    let ground = gathered.ground(&name, &options.along, shape, &recipe.schemes)?;
    let plan = Plan::new(&ground, &name, &recipe).map_err(|error| Failure::refused(error.to_string()))?;
    let mut written =
        if is_gltf(&job.output) { gltf(job, &plan, options)? } else { glb(job, &plan, options)? };
    let thumbnail = draw(job, options, &mut written)?;
    let Written { outputs, facts, bytes, bin_name, .. } = written;
    let mut warnings = plan.warnings().to_vec();
    warnings.extend(facts.iter().filter_map(ClipFacts::warning));
    for output in outputs.into_iter().chain(thumbnail) {
        output.commit()?;
    }
    if is_gltf(&job.output) {
        remove_old_bins(&job.output, &bin_name);
    }
    let summary = Summary::new(&name, &job.output, &ground, &facts, bytes, &warnings, started.elapsed());
    summary.print(options.json, options.quiet)
}

/// What was written, and checked, but has no name yet.
struct Written {
    /// In the order in which they take their names: what is referred to comes first.
    outputs: Vec<Output>,
    facts: Vec<ClipFacts>,
    bytes: u64,
    asset: Asset,
    bin_name: String,
}

fn begin(job: &Job) -> Result<Output, Failure> {
    if is_standard(&job.output) {
        Output::standard_output()
    } else {
        Output::create(&job.output, std::slice::from_ref(&job.input))
    }
}

fn glb(job: &Job, plan: &Plan, options: &Convert) -> Result<Written, Failure> {
    plan.fits_glb().map_err(|error| Failure::refused(error.to_string()))?;
    let output = begin(job)?;
    let failed = |error| writing(job, error);
    let mut progress = Progress::new(plan.samples(), options.quiet);
    let buffered = BufWriter::with_capacity(WRITE_BUFFER, output.file());
    let (_, facts) = plan.write_glb(buffered, |n| progress.advance(n)).map_err(failed)?;
    let file = output.file().try_clone().map_err(failed)?;
    let bytes = file.metadata().map_err(failed)?.len();
    let asset = checked(job, Box::new(file), Box::new(Beside::the(&job.output)))?;
    Ok(Written { outputs: vec![output], facts, bytes, asset, bin_name: String::new() })
}

fn gltf(job: &Job, plan: &Plan, options: &Convert) -> Result<Written, Failure> {
    let failed = |error| writing(job, error);
    // The .bin's name is known once its content is; until then any name in the folder
    // will do, for it is written aside.
    let inputs = std::slice::from_ref(&job.input);
    let mut bin = Output::create(&job.output.with_extension("bin"), inputs)?;
    let main = begin(job)?;
    let mut progress = Progress::new(plan.samples(), options.quiet);
    let buffered = BufWriter::with_capacity(WRITE_BUFFER, bin.file());
    let mut bin_name = String::new();
    let name = |hash: &str| {
        bin_name = bin_file_name(&job.output, hash);
        percent_encoded(&bin_name)
    };
    let (_, json, facts) = plan.write_gltf(buffered, name, |n| progress.advance(n)).map_err(failed)?;
    main.file().write_all(&json).map_err(failed)?;
    bin.rename(&job.output.with_file_name(&bin_name));
    let bin_file = bin.file().try_clone().map_err(failed)?;
    let bytes = json.len() as u64 + bin_file.metadata().map_err(failed)?.len();
    let resolve = JustWritten { name: bin_name.clone(), file: bin_file };
    let asset = checked(job, Box::new(Cursor::new(json)), Box::new(resolve))?;
    Ok(Written { outputs: vec![bin, main], facts, bytes, asset, bin_name })
}

/// Gives out the .bin that has no name yet.
struct JustWritten {
    name: String,
    file: File,
}

impl Resolve for JustWritten {
    fn open(&self, uri: &str) -> io::Result<Box<dyn Source>> {
        if uri != self.name {
            return Err(io::Error::new(io::ErrorKind::NotFound, format!("`{uri}` was not written")));
        }
        let mut file = self.file.try_clone()?;
        file.rewind()?;
        Ok(Box::new(file))
    }
}

fn writing(job: &Job, error: io::Error) -> Failure {
    Failure::environment(format!("{}: cannot be written: {error}", job.output.display()))
}

/// Loads back what was written and refuses it if it is not sound.
fn checked(job: &Job, main: Box<dyn Source>, resolve: Box<dyn Resolve>) -> Result<Asset, Failure> {
    let output = job.output.display().to_string();
    let broken = |report: String| {
        Failure::new(
            Exit::Failed,
            format!("{output}: the output failed its check and was not kept\n{report}"),
        )
    };
    let mut asset = Asset::open(main, resolve).map_err(|error| broken(error.to_string()))?;
    let report: Report = check::asset(&mut asset);
    match report.worst() {
        Some(Severity::Error) => Err(broken(report.text(&output))),
        _ => Ok(asset),
    }
}

#[cfg(feature = "render")]
fn thumbnail_path(options: &Convert) -> Option<&PathBuf> {
    options.thumbnail.as_ref()
}

#[cfg(not(feature = "render"))]
fn thumbnail_path(_: &Convert) -> Option<&PathBuf> {
    None
}

/// Draws the thumbnail that was asked for, from what was loaded back.
fn draw(job: &Job, options: &Convert, written: &mut Written) -> Result<Option<Output>, Failure> {
    let Some(path) = &job.thumbnail else { return Ok(None) };
    let output = Output::create(path, std::slice::from_ref(&job.input))?;
    let png = picture(&mut written.asset, &job.output, options.quiet)?;
    output.file().write_all(&png).map_err(|error| writing(job, error))?;
    Ok(Some(output))
}

#[cfg(feature = "render")]
fn picture(asset: &mut Asset, name: &Path, quiet: bool) -> Result<Vec<u8>, Failure> {
    use super::exit::say;
    use dat2glb::render::LEAST_VISIBLE;
    let picture = super::thumbnail::draw(asset, &Default::default(), name)?;
    // What is small in a wide motion may still be seen from nearby.
    if picture.covered < LEAST_VISIBLE
        && !dat2glb::render::look(asset, (256, 256), Default::default())
            .map_err(|error| super::thumbnail::failure(&error, name))?
            .visible()
    {
        let message = format!("{}: NOTHING_VISIBLE in its picture; the output was not kept", name.display());
        return Err(Failure::new(Exit::Failed, message));
    }
    if !quiet {
        picture.notes.iter().for_each(|note| say(&format!("{}: {note}", name.display())));
    }
    Ok(picture.png())
}

#[cfg(not(feature = "render"))]
fn picture(_: &mut Asset, name: &Path, _quiet: bool) -> Result<Vec<u8>, Failure> {
    Err(Failure::usage(format!("{}: this build has no renderer", name.display())))
}

/// `clip.0123456789abcdef.bin` for `clip.gltf`.
fn bin_file_name(gltf: &Path, hash: &str) -> String {
    format!("{}.{hash}.bin", gltf.file_stem().unwrap_or(OsStr::new("clip")).to_string_lossy())
}

/// Removes the .bin files of earlier conversions to the same .gltf: no file refers to
/// them any more. That one cannot be removed is no reason to fail.
fn remove_old_bins(gltf: &Path, current: &str) {
    let stem = gltf.file_stem().unwrap_or(OsStr::new("clip")).to_string_lossy();
    let folder = gltf.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let rest = name.strip_prefix(&*stem).and_then(|rest| rest.strip_prefix('.'));
        let hash = rest.and_then(|rest| rest.strip_suffix(".bin"));
        let ours = hash.is_some_and(|hash| hash.len() == 16 && hash.bytes().all(|b| b.is_ascii_hexdigit()));
        if ours && name != current {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// A file name as a relative URI (RFC 3986): all but unreserved characters escaped.
fn percent_encoded(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-._~".contains(&b);
    let escaped = |b: u8| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") };
    name.bytes().map(escaped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_escaped() {
        assert_eq!(percent_encoded("clip 1%ä.bin"), "clip%201%25%C3%A4.bin");
    }

    #[test]
    fn bins_are_named_by_content() {
        assert_eq!(bin_file_name(Path::new("a/b.c.gltf"), "00"), "b.c.00.bin");
    }
}

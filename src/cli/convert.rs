//! `dat2glb convert`: every input through all stages, one after another.

use super::args::Convert;
use super::aside::Turn;
use super::bins::{bin_file_name, percent_encoded, remove_old_bins};
use super::camera::CameraSpec;
use super::check::{judged, print_document};
use super::exit::{Exit, Failure, shown};
use super::files::{self, Beside, display_name, is_standard};
use super::output::Output;
use super::progress::Progress;
use super::summary::Summary;
use dat2glb::asset::{Asset, Resolve, Source};
use dat2glb::check::{self, Code, Report, Severity};
use dat2glb::convert::{ClipFacts, Options, Plan};
use dat2glb::diff::{self, Stale};
use dat2glb::moves::{Ground, Shape};
use dat2glb::report::{Format, Run, Subject};
use std::fs::{self, File};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What the samples are collected in before they are written.
const WRITE_BUFFER: usize = 1 << 20;

pub(super) fn run(options: &Convert) -> Result<Exit, Failure> {
    if let Some(conflict) = options.keys.conflict(options.scenery.copies()) {
        return Err(Failure::usage(conflict));
    }
    let jobs = jobs(options)?;
    if options.check {
        return check_outputs(&jobs, options);
    }
    if options.watch {
        return watch(&jobs, options);
    }
    let mut worst = Exit::Done;
    for job in &jobs {
        worst = worst.max(tell(job, options)?);
    }
    Ok(worst)
}

/// Says of every output whether it is what its inputs and options give; writes none.
fn check_outputs(jobs: &[Job], options: &Convert) -> Result<Exit, Failure> {
    let (mut worst, mut subjects) = (Exit::Done, Vec::new());
    let format = options.format();
    for job in jobs {
        let file = job.output.display().to_string();
        let outcome = match planned(job, options, |_, _, plan| outdated(job, plan)) {
            Ok(report) => {
                worst = worst.max(judged(&report, Severity::Error));
                if !options.quiet {
                    shown(say_report(&file, &report, format))?;
                }
                Ok(report)
            }
            Err(failure) => {
                failure.print();
                if format == Format::Json {
                    super::summary::print_failure(&job.input, &failure)?;
                }
                worst = worst.max(failure.exit);
                Err(failure.message)
            }
        };
        subjects.push(Subject { file, outcome });
    }
    if !options.quiet {
        let run = Run { command: "convert", subjects, fails_from: Severity::Error, exit: worst as u8 };
        print_document(&run, format)?;
    }
    Ok(worst)
}

/// Makes the output once more, aside, and compares.
fn outdated(job: &Job, plan: &Plan) -> Result<Report, Failure> {
    let mut report = Report::default();
    if !job.output.exists() {
        let message =
            format!("expected what {} becomes, found no such file; convert it", job.input.display());
        report.add(Code::Outdated, "", message);
        return Ok(report);
    }
    let mut old = files::asset(&job.output)?;
    plan.fits_glb().map_err(|error| Failure::refused(error.to_string()))?;
    let aside = tempfile::tempfile().map_err(|error| writing(job, error))?;
    let buffered = BufWriter::with_capacity(WRITE_BUFFER, &aside);
    plan.write_glb(buffered, |_| {}).map_err(|error| writing(job, error))?;
    let fresh = aside.try_clone().map_err(|error| writing(job, error))?;
    let compared = Asset::open(Box::new(fresh), Box::new(Beside::the(&job.output)))
        .and_then(|mut new| diff::stale(&mut old, &mut new));
    if let Some(Stale { pointer, message }) =
        compared.map_err(|error| files::cannot_read(&job.output, &error))?
    {
        let advice = format!("{message}; convert {} again", job.input.display());
        report.add(Code::Outdated, pointer, advice);
    }
    files::unchanged()?;
    Ok(report)
}

fn say_report(file: &str, report: &Report, format: Format) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match format {
        Format::Text if report.worst().is_none() => writeln!(out, "{file}: up to date"),
        Format::Text => write!(out, "{}", report.text(file)),
        Format::Json => {
            let mut value = report.to_json();
            value["file"] = file.into();
            writeln!(out, "{value}")
        }
        _ => Ok(()),
    }
}

/// Converts, and says so if that fails.
fn tell(job: &Job, options: &Convert) -> Result<Exit, Failure> {
    let Err(failure) = convert(job, options) else { return Ok(Exit::Done) };
    failure.print();
    if options.json {
        super::summary::print_failure(&job.input, &failure)?;
    }
    Ok(failure.exit)
}

/// Converts, and again whatever has changed, until interrupted.
fn watch(jobs: &[Job], options: &Convert) -> Result<Exit, Failure> {
    let mut files: Vec<PathBuf> = jobs.iter().flat_map(|job| job.read.clone()).collect();
    files.sort();
    files.dedup();
    if files.iter().chain(jobs.iter().map(|job| &job.output)).any(|file| is_standard(file)) {
        return Err(Failure::usage(
            "expected files to watch and to write, found '-', standard input or output",
        ));
    }
    super::watch::watch(&files, |changed| {
        for job in jobs.iter().filter(|job| job.read.iter().any(|file| changed.contains(file))) {
            // A reader of standard output who left has no need to be told.
            let _ = tell(job, options);
        }
    })?;
    Ok(Exit::Done)
}

/// One input and where its outputs go.
struct Job {
    input: PathBuf,
    /// All files that are read, the input included.
    read: Vec<PathBuf>,
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
                return Err(Failure::usage("standard input gives the output no name: use -o OUT.glb"));
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
        let read = files_read(input, options);
        jobs.push(Job { input: input.clone(), read, output, thumbnail });
    }
    Ok(jobs)
}

fn files_read(input: &Path, options: &Convert) -> Vec<PathBuf> {
    let cameras = options.scenery.cameras.iter().flat_map(CameraSpec::files);
    let all = std::iter::once(input).chain(options.path.as_deref()).chain(cameras);
    all.map(Path::to_owned).collect()
}

fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.as_os_str().as_encoded_bytes().ends_with(b"/")
}

fn in_folder(folder: &Path, input: &Path, ending: &str, make: bool) -> Result<PathBuf, Failure> {
    if is_standard(folder) {
        return Err(Failure::usage("cannot write several outputs to standard output: use -o FOLDER"));
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
    planned(job, options, |name, ground, plan| write(job, options, started, name, ground, plan))
}

/// Reads the inputs and plans the output.
fn planned<T>(
    job: &Job,
    options: &Convert,
    work: impl FnOnce(&str, &Ground, &Plan) -> Result<T, Failure>,
) -> Result<T, Failure> {
    files::forget();
    let name = display_name(&job.input);
    let paths: Vec<&Path> = std::iter::once(&job.input).chain(&options.path).map(PathBuf::as_path).collect();
    let mut gathered = files::gather(&paths, options.order.order, options.frame)?;
    for camera in &options.scenery.cameras {
        gathered.add(camera, options.frame)?;
    }
    let recipe = Options {
        name: stem(&job.input),
        inputs: gathered.names.clone(),
        quat_order: options.order.order,
        cameras: options.scenery.cameras.iter().map(|camera| camera.said.clone()).collect(),
        path_colour: options.scenery.path_colour(),
        schemes: options.schemes(),
        sampling: options.keys.sampling(),
        writing: options.keys.writing(),
    };
    let shape = Shape {
        copies: options.scenery.copies(),
        ..options.along.shape(options.ends, options.tangents.tcb(), options.time_scale, options.frame)
    };
    let along = options.along.is_asked() || options.scenery.needs_path();
    let ground = gathered.ground(&name, along, shape, &recipe.schemes)?;
    let plan = Plan::new(&ground, &name, &recipe).map_err(|error| Failure::refused(error.to_string()))?;
    work(&name, &ground, &plan)
}

fn write(
    job: &Job,
    options: &Convert,
    started: Instant,
    name: &str,
    ground: &Ground,
    plan: &Plan,
) -> Result<(), Failure> {
    let mut written = if is_gltf(&job.output) { gltf(job, plan, options)? } else { glb(job, plan, options)? };
    let thumbnail = draw(job, options, &mut written)?;
    let Written { outputs, facts, bytes, bin_name, .. } = written;
    let mut warnings = plan.warnings().to_vec();
    warnings.extend(facts.iter().filter_map(ClipFacts::warning));
    files::unchanged()?;
    let turn = is_gltf(&job.output).then(|| Turn::at(&job.output));
    Output::commit_all(outputs.into_iter().chain(thumbnail).collect())?;
    if is_gltf(&job.output) {
        remove_old_bins(&job.output, std::slice::from_ref(&bin_name));
    }
    drop(turn);
    let summary = Summary::new(name, &job.output, ground, &facts, bytes, &warnings, started.elapsed());
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
    if is_standard(&job.output) { Output::standard_output() } else { Output::create(&job.output, &job.read) }
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
    // The disk works while the file is checked.
    let check = || checked(job, Box::new(file), Box::new(Beside::the(&job.output)));
    let (settled, asset) = std::thread::scope(|scope| {
        let settled = scope.spawn(|| output.settle());
        let asset = check();
        (settled.join(), asset)
    });
    settled.expect("waiting for the disk does not panic")?;
    let asset = asset?;
    Ok(Written { outputs: vec![output], facts, bytes, asset, bin_name: String::new() })
}

fn gltf(job: &Job, plan: &Plan, options: &Convert) -> Result<Written, Failure> {
    let failed = |error| writing(job, error);
    // The .bin's name is known once its content is; until then any name in the folder
    // will do, for it is written aside.
    let mut bin = Output::create(&job.output.with_extension("bin"), &job.read)?;
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
    let output = Output::create(path, &job.read)?;
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

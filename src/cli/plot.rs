//! `dat2glb plot`: curves as diagrams.

use super::args::Plot;
use super::exit::{Exit, Failure};
use super::files::{self, Gathered, display_name, is_standard};
use super::output::Output;
use dat2glb::check::motion::{self, Given};
use dat2glb::curve::Scheme;
use dat2glb::moves::{Ground, Inputs, Mover, Shape};
use dat2glb::orient::Frame;
use dat2glb::plot::{self, Asked, AskedOfFile, Figure, Show, Subject};
use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The schemes of all figures, where none are asked for.
const COURSE: [Scheme; 3] = [Scheme::Slerp, Scheme::CatmullRom, Scheme::BesselOverhauser];

pub(super) fn run(options: &Plot) -> Result<Exit, Failure> {
    let target = Target::new(options)?;
    let figure = match options {
        Plot { all_figures: true, .. } => all_figures(options)?,
        Plot { show: Show::Error, .. } => deviations(options)?,
        _ => one(options)?,
    };
    let name = display_name(&options.inputs[0]);
    let failed = |error: plot::Error| failure(&name, &error);
    let svg = plot::svg(&figure, options.theme, options.size).map_err(failed)?;
    let bytes = if target.png { plot::png(&svg).map_err(failed)? } else { svg.into_bytes() };
    target.write(&bytes, options)?;
    Ok(Exit::Done)
}

/// Where the picture goes, and as what.
struct Target {
    /// None for standard output.
    path: Option<PathBuf>,
    png: bool,
}

impl Target {
    fn new(options: &Plot) -> Result<Target, Failure> {
        let path = match &options.output {
            Some(path) => path.clone(),
            None if is_standard(&options.inputs[0]) => return Ok(Target { path: None, png: false }),
            None => options.inputs[0].with_extension("svg"),
        };
        if is_standard(&path) {
            return Ok(Target { path: None, png: false });
        }
        let ending = path.extension().map(OsStr::to_ascii_lowercase);
        let png = match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("svg") => false,
            Some("png") => true,
            _ => {
                let shown = path.display();
                let problem = format!("{shown}: expected a name that ends in .svg or .png");
                return Err(Failure::usage(problem));
            }
        };
        Ok(Target { path: Some(path), png })
    }

    fn write(&self, bytes: &[u8], options: &Plot) -> Result<(), Failure> {
        let (output, shown) = match &self.path {
            Some(path) => {
                let inputs = options.inputs.iter().chain(&options.against).chain(&options.path);
                let inputs: Vec<PathBuf> = inputs.cloned().collect();
                (Output::create(path, &inputs)?, path.display().to_string())
            }
            None => (Output::standard_output()?, "standard output".to_owned()),
        };
        let failed = |error| Failure::environment(format!("{shown}: cannot be written: {error}"));
        output.file().write_all(bytes).map_err(failed)?;
        output.commit()
    }
}

/// What is asked of one input.
fn one(options: &Plot) -> Result<Figure, Failure> {
    let path = single(options)?;
    let name = display_name(path);
    if !options.against.is_empty() {
        let problem = "--against goes with --show error, which looks at a .glb or .gltf";
        return Err(Failure::usage(format!("{name}: {problem}")));
    }
    let schemes = or(options.schemes(), &[Scheme::Bessel]);
    let gathered = gathered(options, path)?;
    let ground = ground(options, &gathered, &name, &schemes)?;
    let asked = Asked {
        show: options.show,
        components: options.components(),
        only: options.only(),
        clock: options.clock(),
    };
    let shown = gathered.names.join(" and ");
    plot::figure(&subject(&gathered, &ground, &shown, &schemes), &asked)
        .map_err(|error| failure(&name, &error))
}

fn all_figures(options: &Plot) -> Result<Figure, Failure> {
    let schemes = or(options.schemes(), &COURSE);
    let gathered: Vec<(String, Gathered)> = options
        .inputs
        .iter()
        .map(|path| Ok((display_name(path), gathered(options, path)?)))
        .collect::<Result<_, Failure>>()?;
    let grounds: Vec<Ground> = gathered
        .iter()
        .map(|(name, gathered)| ground(options, gathered, name, &schemes))
        .collect::<Result<_, Failure>>()?;
    let subjects = gathered.iter().zip(&grounds);
    let subjects: Vec<Subject> = subjects
        .map(|((_, gathered), ground)| subject(gathered, ground, &gathered.names[0], &schemes))
        .collect();
    let name = display_name(&options.inputs[0]);
    plot::all_figures(&subjects, &options.components(), options.clock())
        .map_err(|error| failure(&name, &error))
}

fn single(options: &Plot) -> Result<&Path, Failure> {
    match options.inputs.as_slice() {
        [path] => Ok(path),
        inputs => {
            let problem = format!("expected one input, found {}; --all-figures takes several", inputs.len());
            Err(Failure::usage(problem))
        }
    }
}

fn or(schemes: Vec<Scheme>, usual: &[Scheme]) -> Vec<Scheme> {
    if schemes.is_empty() { usual.to_vec() } else { schemes }
}

fn gathered(options: &Plot, path: &Path) -> Result<Gathered, Failure> {
    let ending = path.extension().map(OsStr::to_ascii_lowercase);
    if ending.is_some_and(|ending| ending == "glb" || ending == "gltf") {
        let problem = "expected keyframes or a path; for a .glb or .gltf use --show error --against IN.dat";
        return Err(Failure::usage(format!("{}: {problem}", path.display())));
    }
    let paths: Vec<&Path> = std::iter::once(path).chain(options.path.as_deref()).collect();
    files::gather(&paths, options.order.order, options.frame)
}

fn ground<'a>(
    options: &Plot,
    gathered: &'a Gathered,
    name: &str,
    schemes: &[Scheme],
) -> Result<Ground<'a>, Failure> {
    let ends = options.ends.unwrap_or_default();
    let shape = options.along.shape(ends, options.tangents.tcb(), options.time_scale, options.frame);
    gathered.ground(name, options.along.is_asked(), shape, schemes)
}

fn subject<'a>(
    gathered: &'a Gathered,
    ground: &'a Ground<'a>,
    name: &'a str,
    schemes: &'a [Scheme],
) -> Subject<'a> {
    let order = gathered.inputs.keyframes.as_ref().map(|keyframes| keyframes.order).unwrap_or_default();
    let frame = gathered.frame.unwrap_or(Frame::Gltf);
    Subject { name, ground, schemes, order, rows: gathered.rows.unwrap_or(frame), frame }
}

/// How far a file's playback is off its curve.
fn deviations(options: &Plot) -> Result<Figure, Failure> {
    let path = single(options)?;
    let name = display_name(path);
    if options.against.is_empty() {
        return Err(failure(&name, &plot::Error::NoFile));
    }
    refuse_shape(options, &name)?;
    let mut asset = files::asset(path)?;
    let order = options.order.order.or(motion::quat_order(&asset));
    let against: Vec<&Path> = options.against.iter().map(PathBuf::as_path).collect();
    let inputs = files::gather(&against, order, motion::frame(&asset))?.inputs;
    let schemes = options.schemes();
    let shown = path.file_name().map_or(name.clone(), |file| file.to_string_lossy().into_owned());
    let scheme = schemes.first().copied().filter(|_| schemes.len() == 1 && !motion::says(&asset));
    let wanted = AskedOfFile {
        name: &shown,
        given: Given { scheme, ends: options.ends, ..Given::default() },
        only: options.only().map(|number| chosen(number, &inputs, &name)).transpose()?,
        schemes: &schemes,
        tolerance: options.tolerance,
        clock: options.clock(),
    };
    let figure = plot::deviations(&mut asset, &inputs, &wanted).map_err(|error| {
        let message = format!("{name}: {error}");
        match error {
            motion::Error::NoRecipe => Failure::usage(message),
            _ => Failure::refused(message),
        }
    })?;
    if figure.panels.is_empty() {
        let problem = "no clip was made by these schemes: leave --scheme out to see all";
        return Err(Failure::usage(format!("{name}: {problem}")));
    }
    Ok(figure)
}

/// A file says itself how it was made.
fn refuse_shape(options: &Plot, name: &str) -> Result<(), Failure> {
    let plain = Shape::default();
    let shape = options.along.shape(plain.ends, options.tangents.tcb(), options.time_scale, None);
    if shape == plain && options.path.is_none() && options.frame.is_none() && options.components().is_empty()
    {
        return Ok(());
    }
    let problem = "the file says itself how it was made: with --show error leave out what shapes the motion, \
                   and --component";
    Err(Failure::usage(format!("{name}: {problem}")))
}

/// The box of a number, from 1.
fn chosen(number: usize, inputs: &Inputs, name: &str) -> Result<Mover, Failure> {
    let last = inputs.keyframes.as_ref().map_or(0, |keyframes| keyframes.clip.tracks.len());
    if (1..=last).contains(&number) {
        return Ok(Mover::Track(number - 1));
    }
    Err(failure(name, &plot::Error::Box { last, found: number }))
}

/// What a figure that cannot be means for the exit code.
fn failure(name: &str, error: &plot::Error) -> Failure {
    let exit = match error {
        plot::Error::Png(_) => Exit::Environment,
        plot::Error::NoRotations(..) | plot::Error::NoPath(_) => Exit::Refused,
        _ => Exit::Usage,
    };
    Failure::new(exit, format!("{name}: {error}"))
}

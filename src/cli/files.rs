//! Opening what the command line names.

use super::aside::folder;
use super::camera::CameraSpec;
use super::exit::Failure;
use dat2glb::asset::{self, Asset, Resolve, Source};
use dat2glb::curve::{Scheme, Tcb};
use dat2glb::moves::{self, Ground, Inputs, Shape, rotation_keys};
use dat2glb::orient::Frame;
use dat2glb::path;
use dat2glb::read::{self, Input, Order};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// An input's name in messages.
pub(super) fn display_name(path: &Path) -> String {
    if is_standard(path) { "<stdin>".to_owned() } else { path.display().to_string() }
}

/// Whether `-` stands for standard input or output.
pub(super) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Reads any kind of input, or standard input.
pub(super) fn input(path: &Path, order: Option<Order>) -> Result<Input, Failure> {
    let input: Box<dyn Read + Send> =
        if is_standard(path) { Box::new(io::stdin()) } else { Box::new(open(path)?) };
    read::input(&display_name(path), input, order).map_err(|error| Failure::refused(error.to_string()))
}

/// What some inputs come to together.
pub(super) struct Gathered {
    pub(super) inputs: Inputs,
    /// In whose axes they are given, where one of them says so or is so by its kind.
    pub(super) frame: Option<Frame>,
    /// In whose axes rows of rotations are, where they are not as their path's.
    #[cfg_attr(not(feature = "plot-png"), expect(dead_code))]
    pub(super) rows: Option<Frame>,
    /// Their file names without folders: rotations, then path.
    pub(super) names: Vec<String>,
}

/// Puts together what some inputs hold: rotations and a path, each at most once.
pub(super) fn gather(
    paths: &[&Path],
    order: Option<Order>,
    frame: Option<Frame>,
) -> Result<Gathered, Failure> {
    let mut inputs = Inputs { keyframes: None, path: None, cameras: Vec::new() };
    let (mut given, mut rows, mut names) = (frame, None, Vec::new());
    for path in paths {
        let name = display_name(path);
        let twice = |what: &str| Failure::usage(format!("{name}: expected {what} only once"));
        match input(path, order)? {
            Input::Path(_) if inputs.path.is_some() => return Err(twice("a path")),
            Input::Path(file) => {
                given = given.or(file.frame);
                inputs.path = Some(file);
                names.push(short_name(path));
                continue;
            }
            _ if inputs.keyframes.is_some() => return Err(twice("rotations")),
            Input::Keyframes(keyframes) => {
                // These are never turned into other axes.
                rows = Some(Frame::Gltf);
                inputs.keyframes = Some(keyframes);
            }
            Input::Rotations(file) => {
                let own = frame.or(file.frame).unwrap_or(file.rotations.usual_frame());
                (given, rows) = (given.or(Some(own)), Some(own));
                inputs.keyframes = Some(rotation_keys(file, frame));
            }
            _ => return Err(Failure::refused(format!("{name}: this kind of input cannot be converted"))),
        }
        names.insert(0, short_name(path));
    }
    Ok(Gathered { inputs, frame: given, rows, names })
}

impl Gathered {
    /// Adds a camera, and the names of its files.
    pub(super) fn add(&mut self, camera: &CameraSpec, frame: Option<Frame>) -> Result<(), Failure> {
        self.inputs.cameras.push(camera.read(frame)?);
        self.names.extend(camera.files().into_iter().map(short_name));
        Ok(())
    }

    /// The inputs on one clock, shaped by the options; `name` is what messages are about,
    /// `along` whether something is asked for that only a path can have.
    pub(super) fn ground(
        &self,
        name: &str,
        along: bool,
        shape: Shape,
        schemes: &[Scheme],
    ) -> Result<Ground<'_>, Failure> {
        if self.inputs.path.is_none() && along {
            let problem = "path options are given, but no path: use --path PATH.dat";
            return Err(Failure::usage(format!("{name}: {problem}")));
        }
        if shape.tcb != Tcb::default() && !schemes.iter().any(|scheme| scheme.has_tcb()) {
            let problem = "--tension, --continuity and --bias shape --scheme kochanek-bartels only";
            return Err(Failure::usage(format!("{name}: {problem}")));
        }
        Ground::new(&self.inputs, shape, schemes).map_err(|error| {
            let message = format!("{name}: {error}");
            match error {
                // Wrong whatever the input.
                moves::Error::Model(_)
                | moves::Error::NoKeyPoints
                | moves::Error::Path(path::Error::Ease) => Failure::usage(message),
                _ => Failure::refused(message),
            }
        })
    }
}

/// A file's name as outputs keep it.
fn short_name(path: &Path) -> String {
    match path.file_name() {
        Some(file) if !is_standard(path) => file.to_string_lossy().into_owned(),
        _ => "stdin".to_owned(),
    }
}

/// An input file as it was when it was opened.
struct Opened {
    name: String,
    file: File,
    was: State,
}

/// Length, and when it was written last.
type State = (u64, Option<SystemTime>);

/// All inputs of what is being done now: any part of them may be read until it is done.
static OPENED: Mutex<Vec<Opened>> = Mutex::new(Vec::new());

fn opened() -> MutexGuard<'static, Vec<Opened>> {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn state(file: &File) -> Option<State> {
    let found = file.metadata().ok().filter(|found| found.is_file())?;
    Some((found.len(), found.modified().ok()))
}

/// Keeps in mind how a file is now.
fn remember(path: &Path, file: &File) {
    if let (Some(was), Ok(file)) = (state(file), file.try_clone()) {
        opened().push(Opened { name: path.display().to_string(), file, was });
    }
}

/// Begins anew: inputs that were read before are done with.
pub(super) fn forget() {
    opened().clear();
}

/// Refuses inputs that were written to since they were opened: what was read of them may
/// be half of one and half of another. One that was removed or replaced is still whole.
pub(super) fn unchanged() -> Result<(), Failure> {
    let opened = opened();
    match opened.iter().find(|opened| state(&opened.file) != Some(opened.was)) {
        None => Ok(()),
        Some(Opened { name, .. }) => Err(Failure::refused(format!(
            "{name}: expected a file that stays as it is while it is read, found it changed; run this again"
        ))),
    }
}

/// Opens an input file.
pub(super) fn open(path: &Path) -> Result<File, Failure> {
    let refuse = |reason: String| Failure::refused(format!("{}: {reason}", path.display()));
    let file = File::open(path).map_err(|error| {
        refuse(match error.kind() {
            io::ErrorKind::NotFound => "expected a file, found none of this name".to_owned(),
            _ => format!("cannot be opened: {error}"),
        })
    })?;
    match file.metadata() {
        Ok(metadata) if metadata.is_dir() => Err(refuse("expected a file, found a directory".to_owned())),
        _ => {
            remember(path, &file);
            Ok(file)
        }
    }
}

/// Opens a glTF file.
pub(super) fn asset(path: &Path) -> Result<Asset, Failure> {
    asset_or_schema(path)?.map_err(|error| cannot_read(path, &error))
}

/// Opens a glTF file; JSON that breaks the schema is left to the caller.
pub(super) fn asset_or_schema(path: &Path) -> Result<Result<Asset, asset::Error>, Failure> {
    let opened = Asset::open(Box::new(open(path)?), Box::new(Beside::the(path)));
    match opened {
        Ok(_) | Err(asset::Error::Schema(_)) => Ok(opened),
        Err(error) => Err(cannot_read(path, &error)),
    }
}

pub(super) fn cannot_read(path: &Path, error: &asset::Error) -> Failure {
    Failure::refused(format!("{}: {error}", path.display()))
}

/// Opens files beside or below a .gltf, and no others: a file from elsewhere must not
/// make this program read what its author never saw. A symbolic link counts as where it
/// leads to; it may lead to what lies beside or below the file that the .gltf itself is a
/// link to.
pub(super) struct Beside {
    gltf: PathBuf,
}

impl Beside {
    pub(super) fn the(gltf: &Path) -> Beside {
        Beside { gltf: gltf.to_owned() }
    }

    /// Where a file lies that the .gltf may name; there or not.
    pub(super) fn place(&self, uri: &str) -> io::Result<PathBuf> {
        let path = Path::new(uri);
        let below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !below {
            return Err(io::Error::new(
                io::ErrorKind::PermissionDenied,
                "it is not beside or below the file",
            ));
        }
        let place = self.gltf.with_file_name(path);
        let Ok(meant) = place.canonicalize() else { return Ok(place) };
        let mut folders = [
            folder(&self.gltf).canonicalize(),
            self.gltf.canonicalize().map(|gltf| folder(&gltf).to_owned()),
        ]
        .into_iter()
        .flatten();
        match folders.any(|folder| meant.starts_with(folder)) {
            true => Ok(place),
            false => {
                let reason = format!("a link leads to {}, out of the file's folder", meant.display());
                Err(io::Error::new(io::ErrorKind::PermissionDenied, reason))
            }
        }
    }
}

impl Resolve for Beside {
    fn open(&self, uri: &str) -> io::Result<Box<dyn Source>> {
        let place = self.place(uri)?;
        // Looked at before it is opened: to open a pipe waits for whoever writes to it.
        let kind = std::fs::metadata(&place)?;
        if !kind.is_file() {
            let what = if kind.is_dir() { "a directory" } else { "a pipe or a device" };
            return Err(io::Error::new(io::ErrorKind::InvalidInput, format!("it is {what}")));
        }
        let file = File::open(&place)?;
        remember(&place, &file);
        Ok(Box::new(file))
    }
}

//! Files that appear whole or not at all.
//!
//! What is written goes to a file aside and takes its name at the last moment. A full disk
//! or a killed process leaves what was there before. Devices and pipes are written straight,
//! from a temporary file, once everything is known to be good. Nothing is given a name if
//! an input has changed since it was read.

use super::aside::{Aside, folder};
use super::exit::{self, Failure};
use super::files;
use std::fs::{self, File, Metadata};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

/// A file on its way.
pub(super) struct Output {
    file: Aside,
    target: Target,
    shown: String,
}

enum Target {
    /// A file that will be there, with its folder.
    Path(PathBuf),
    /// A device or a pipe that is there already.
    Straight(PathBuf),
    StandardOutput,
}

impl Output {
    /// Begins a file at `path`, which must be none of the inputs.
    pub(super) fn create(path: &Path, inputs: &[PathBuf]) -> Result<Output, Failure> {
        let shown = path.display().to_string();
        let fail = |error: io::Error| cannot_be_written(&shown, &error);
        let existing = fs::metadata(path).ok();
        // What /dev/stdout leads to has no path of its own when it is a pipe.
        let path = match &existing {
            Some(existing) if !existing.is_file() => path.to_owned(),
            _ => follow(path).map_err(fail)?,
        };
        if let Some(existing) = &existing {
            refuse_inputs(&shown, existing, &path, inputs)?;
            if existing.is_dir() {
                return Err(Failure::usage(format!("{shown}: expected a file to write, found a directory")));
            }
            if !existing.is_file() {
                let file = Aside::Spool(tempfile::tempfile().map_err(fail)?);
                return Ok(Output { file, target: Target::Straight(path), shown });
            }
            // A file that must not be written is not replaced either.
            match fs::OpenOptions::new().write(true).open(&path) {
                // Another process has removed it since.
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(fail(error)),
                _ => {}
            }
        }
        let file = Aside::beside(&path).map_err(fail)?;
        if let Some(existing) = existing {
            file.get().set_permissions(existing.permissions()).map_err(fail)?;
        }
        Ok(Output { file, target: Target::Path(path), shown })
    }

    /// Begins what goes to standard output.
    pub(super) fn standard_output() -> Result<Output, Failure> {
        let shown = "standard output".to_owned();
        let spool = tempfile::tempfile()
            .map_err(|error| Failure::environment(format!("no temporary file can be made: {error}")))?;
        Ok(Output { file: Aside::Spool(spool), target: Target::StandardOutput, shown })
    }

    /// The file to write to and to read back from.
    pub(super) fn file(&self) -> &File {
        self.file.get()
    }

    /// Waits until the disk has all that was written so far.
    pub(super) fn settle(&self) -> Result<(), Failure> {
        let synced = match (&self.file, &self.target) {
            (Aside::Spool(_), _) => Ok(()),
            (file, _) => file.get().sync_data(),
        };
        synced.map_err(|error| Failure::environment(format!("{}: cannot be written: {error}", self.shown)))
    }

    /// Changes the name that the file will take, within the same folder.
    pub(super) fn rename(&mut self, path: &Path) {
        self.shown = path.display().to_string();
        self.target = Target::Path(path.to_owned());
    }

    /// [`Output::commit`] of several, the first of which are referred to by the last: they
    /// take their names close together.
    pub(super) fn commit_all(outputs: Vec<Output>) -> Result<(), Failure> {
        for output in &outputs {
            output.file.sync().map_err(|error| cannot_be_written(&output.shown, &error))?;
        }
        outputs.into_iter().try_for_each(Output::commit)
    }

    /// Gives the file its name, or sends it where it goes.
    pub(super) fn commit(self) -> Result<(), Failure> {
        files::unchanged()?;
        let shown = self.shown;
        let done = match (self.file, self.target) {
            (Aside::Spool(file), Target::StandardOutput) => {
                return exit::shown(copy(file, &mut io::stdout().lock()));
            }
            (Aside::Spool(file), Target::Straight(path)) => {
                File::options().write(true).open(path).and_then(|mut out| copy(file, &mut out))
            }
            (file, Target::Path(path)) => file.take_name(&path),
            (file, Target::Straight(_) | Target::StandardOutput) => copy(file.into_file(), &mut io::sink()),
        };
        done.map_err(|error| cannot_be_written(&shown, &error))
    }
}

fn cannot_be_written(shown: &str, error: &io::Error) -> Failure {
    Failure::environment(format!("{shown}: cannot be written: {error}"))
}

/// The file that a symbolic link leads to, there or not.
fn follow(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(target) => path = folder(&path).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

fn refuse_inputs(shown: &str, existing: &Metadata, path: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    let same =
        |input: &&PathBuf| fs::metadata(input).is_ok_and(|other| is_same(existing, path, &other, input));
    match inputs.iter().find(same) {
        Some(input) => {
            let input = input.display();
            Err(Failure::usage(format!(
                "{shown}: expected an output that is no input, found the input {input}"
            )))
        }
        None => Ok(()),
    }
}

#[cfg(unix)]
fn is_same(a: &Metadata, _: &Path, b: &Metadata, _: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    a.is_file() && (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same(_: &Metadata, a: &Path, _: &Metadata, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

fn copy(mut from: File, to: &mut impl Write) -> io::Result<()> {
    from.rewind()?;
    io::copy(&mut from, to)?;
    to.flush()
}

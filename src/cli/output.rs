//! Files that appear whole or not at all.
//!
//! What is written goes to an unnamed file in the target's folder (on Linux) or to a
//! file with a name of its own, and takes its name at the last moment. A full disk or a
//! killed process leaves what was there before. Devices and pipes are written straight,
//! from a temporary file, once everything is known to be good.

use super::exit::{self, Failure};
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

enum Aside {
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(tempfile::NamedTempFile),
    /// In the system's folder for temporary files; never gets a name.
    Spool(File),
}

impl Output {
    /// Begins a file at `path`, which must be none of the inputs.
    pub(super) fn create(path: &Path, inputs: &[PathBuf]) -> Result<Output, Failure> {
        let shown = path.display().to_string();
        let fail = |error: io::Error| Failure::environment(format!("{shown}: cannot be written: {error}"));
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
            fs::OpenOptions::new().write(true).open(&path).map_err(fail)?;
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

    /// Gives the file its name, or sends it where it goes.
    pub(super) fn commit(self) -> Result<(), Failure> {
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
        done.map_err(|error| Failure::environment(format!("{shown}: cannot be written: {error}")))
    }
}

impl Aside {
    fn beside(path: &Path) -> io::Result<Aside> {
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed(folder(path))? {
            return Ok(Aside::Unnamed(file));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".dat2glb-").suffix(".tmp");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file's: the process's mask decides.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        builder.tempfile_in(folder(path)).map(Aside::Named)
    }

    fn get(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Aside::Unnamed(file) => file,
            Aside::Named(file) => file.as_file(),
            Aside::Spool(file) => file,
        }
    }

    fn into_file(self) -> File {
        match self {
            #[cfg(target_os = "linux")]
            Aside::Unnamed(file) => file,
            Aside::Named(file) => file.into_file(),
            Aside::Spool(file) => file,
        }
    }

    /// Becomes the file at `path`, replacing what is there.
    fn take_name(self, path: &Path) -> io::Result<()> {
        self.get().sync_data()?;
        match self {
            #[cfg(target_os = "linux")]
            Aside::Unnamed(file) => name(&file, path),
            Aside::Named(file) => file.persist(path).map(drop).map_err(|error| error.error),
            Aside::Spool(_) => Err(io::Error::other("a spooled file has no name to take")),
        }
    }
}

/// A file without a name in a folder; none where the file system knows no such thing.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> io::Result<Option<File>> {
    use rustix::fs::{Mode, OFlags};
    use rustix::io::Errno;
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match rustix::fs::open(folder, flags, Mode::from_bits_truncate(0o666)) {
        Ok(file) => Ok(Some(file.into())),
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::INVAL) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Names an unnamed file. A name that is taken cannot be linked to: the file then gets
/// one of its own first, and is renamed.
#[cfg(target_os = "linux")]
fn name(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use rustix::io::Errno;
    use std::os::fd::AsRawFd;
    let here = format!("/proc/self/fd/{}", file.as_raw_fd());
    let link = |name: &Path| linkat(CWD, here.as_str(), CWD, name, AtFlags::SYMLINK_FOLLOW);
    match link(path) {
        Ok(()) => return Ok(()),
        Err(Errno::EXIST) => {}
        Err(error) => return Err(error.into()),
    }
    for attempt in 0..1000u32 {
        let own = folder(path).join(format!(".dat2glb-{}-{attempt}.tmp", std::process::id()));
        match link(&own) {
            Ok(()) => return fs::rename(&own, path).inspect_err(|_| drop(fs::remove_file(&own))),
            Err(Errno::EXIST) => continue,
            Err(error) => return Err(error.into()),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "no free name for a temporary file"))
}

/// The folder that a file is in.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
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

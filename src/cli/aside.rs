//! Files that are written aside, in the folder in which they will be.
//!
//! On Linux such a file has no name until it takes its last one, so that a process that is
//! killed leaves nothing. Where there is no such thing, and for the moment between the two
//! steps in which an existing file is replaced, it has a name of its own and is locked. What
//! has such a name and is locked by no one belonged to a process that was killed: the next
//! one that writes into the folder removes it.

use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Set to 1, no file is without a name: as on systems that know no such files.
const NAMED: &str = "DAT2GLB_NAMED_TEMPORARIES";

const PREFIX: &str = ".dat2glb-";
const SUFFIX: &str = ".tmp";

/// A file on its way.
pub(super) enum Aside {
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(tempfile::NamedTempFile),
    /// In the system's folder for temporary files; never gets a name.
    Spool(File),
}

impl Aside {
    /// A new file in the folder that `path` is in.
    pub(super) fn beside(path: &Path) -> io::Result<Aside> {
        remove_leftovers_once(folder(path));
        #[cfg(target_os = "linux")]
        if !only_named()
            && let Some(file) = unnamed(folder(path))?
        {
            // Locked before anyone can see it.
            let _ = file.try_lock();
            return Ok(Aside::Unnamed(file));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file's: the process's mask decides.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        for _ in 0..100 {
            let file = builder.tempfile_in(folder(path))?;
            // Another process may have taken it for a leftover before it was locked.
            let taken = matches!(file.as_file().try_lock(), Err(TryLockError::WouldBlock));
            if !taken && is_at(file.as_file(), file.path()) {
                return Ok(Aside::Named(file));
            }
        }
        Err(io::Error::new(io::ErrorKind::AlreadyExists, "other processes remove temporary files here"))
    }

    pub(super) fn get(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Aside::Unnamed(file) => file,
            Aside::Named(file) => file.as_file(),
            Aside::Spool(file) => file,
        }
    }

    pub(super) fn into_file(self) -> File {
        match self {
            #[cfg(target_os = "linux")]
            Aside::Unnamed(file) => file,
            Aside::Named(file) => file.into_file(),
            Aside::Spool(file) => file,
        }
    }

    /// Waits until the disk has what was written; nothing for what gets no name.
    pub(super) fn sync(&self) -> io::Result<()> {
        if let Aside::Spool(_) = self { Ok(()) } else { self.get().sync_data() }
    }

    /// Becomes the file at `path`, replacing what is there.
    pub(super) fn take_name(self, path: &Path) -> io::Result<()> {
        self.sync()?;
        match self {
            #[cfg(target_os = "linux")]
            Aside::Unnamed(file) => name(&file, path),
            Aside::Named(file) => file.persist(path).map(drop).map_err(|error| error.error),
            Aside::Spool(_) => Err(io::Error::other("a spooled file has no name to take")),
        }
    }
}

fn only_named() -> bool {
    std::env::var_os(NAMED).is_some_and(|value| value == "1")
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
        let own = folder(path).join(format!("{PREFIX}{}-{attempt}{SUFFIX}", std::process::id()));
        match link(&own) {
            Ok(()) => return fs::rename(&own, path).inspect_err(|_| drop(fs::remove_file(&own))),
            Err(Errno::EXIST) => continue,
            Err(error) => return Err(error.into()),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "no free name for a temporary file"))
}

/// [`remove_leftovers`] for the first of many outputs in a folder.
fn remove_leftovers_once(folder: &Path) {
    static LOOKED_AT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if LOOKED_AT.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
        remove_leftovers(folder);
    }
}

/// Removes what killed processes left in a folder. That one cannot be removed is no reason
/// to fail.
fn remove_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let ours = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        if !ours || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        // The lock is held until the file is gone: a process that has just made it sees that.
        if let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The only process that gives names to files of several parts in a folder, while it lasts:
/// a .gltf of one must not meet the .bin of another, nor remove it.
pub(super) struct Turn {
    _lock: Option<File>,
    /// What is locked, where that is no folder.
    path: Option<PathBuf>,
}

impl Turn {
    /// Waits for other processes to be done. Where nothing can be locked there is nothing to
    /// wait for.
    pub(super) fn at(path: &Path) -> Turn {
        if cfg!(unix) && !only_named() {
            let lock = File::open(folder(path)).ok().filter(|folder| folder.lock().is_ok());
            return Turn { _lock: lock, path: None };
        }
        let path = folder(path).join(format!("{PREFIX}turn{SUFFIX}"));
        loop {
            let made = File::options().create(true).truncate(false).write(true).open(&path);
            let Some(lock) = made.ok().filter(|file| file.lock().is_ok()) else {
                return Turn { _lock: None, path: None };
            };
            // The one before has removed what this one has waited for.
            if is_at(&lock, &path) {
                return Turn { _lock: Some(lock), path: Some(path) };
            }
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether an open file is still the one of this name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |found: &fs::Metadata| (found.dev(), found.ino());
    matches!((file.metadata(), fs::metadata(path)), (Ok(a), Ok(b)) if id(&a) == id(&b))
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

/// The folder that a file is in.
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

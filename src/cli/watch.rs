//! `--watch`: work is done again whenever a file changes that it reads.

use super::exit::{Failure, say};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// An editor may write a file in several steps: the work waits until this long nothing
/// has changed,
const QUIET: Duration = Duration::from_millis(60);
/// but no longer than this.
const PATIENCE: Duration = Duration::from_millis(500);

/// Calls `changed` with all files, then with those that changed, as they are named in
/// `files`, each time some did; ends only if watching fails. Files may be removed and come
/// back.
pub(super) fn watch(files: &[PathBuf], mut changed: impl FnMut(&BTreeSet<PathBuf>)) -> Result<(), Failure> {
    let failed = |error: notify::Error| Failure::environment(format!("files cannot be watched: {error}"));
    let (sender, events) = channel();
    let mut watcher: RecommendedWatcher = notify::recommended_watcher(sender).map_err(failed)?;
    // A file that is replaced is another file: folders are watched, and names compared.
    let mut known: Vec<(PathBuf, &PathBuf)> = Vec::new();
    for file in files {
        known.extend(places(file).into_iter().map(|place| (place, file)));
    }
    let folders: BTreeSet<&Path> = known.iter().filter_map(|(place, _)| place.parent()).collect();
    for folder in folders {
        watcher.watch(folder, RecursiveMode::NonRecursive).map_err(failed)?;
    }
    changed(&files.iter().cloned().collect());
    say(&format!("watching {} file{}; Ctrl-C ends", files.len(), if files.len() == 1 { "" } else { "s" }));
    loop {
        let some = next(&events, &known);
        if some.is_empty() {
            return Err(Failure::environment("files are no longer watched"));
        }
        changed(&some);
    }
}

/// Waits for changes of known files, and until they are over; empty if none can come.
fn next(events: &Receiver<notify::Result<Event>>, known: &[(PathBuf, &PathBuf)]) -> BTreeSet<PathBuf> {
    let mut some = BTreeSet::new();
    while some.is_empty() {
        let Ok(event) = events.recv() else { return some };
        some.extend(touched(event, known));
    }
    let first = Instant::now();
    while first.elapsed() < PATIENCE {
        match events.recv_timeout(QUIET) {
            Ok(event) => some.extend(touched(event, known)),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => break,
        }
    }
    some
}

/// The known files that an event is about; reading one is none.
fn touched(event: notify::Result<Event>, known: &[(PathBuf, &PathBuf)]) -> Vec<PathBuf> {
    let Ok(event) = event else { return Vec::new() };
    if matches!(event.kind, EventKind::Access(_)) {
        return Vec::new();
    }
    // What was missed may have been any of them.
    let all = event.need_rescan();
    let about = |full: &PathBuf| all || event.paths.iter().any(|path| path == full);
    known.iter().filter(|(full, _)| about(full)).map(|(_, file)| (*file).clone()).collect()
}

fn folder(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.canonicalize().unwrap_or(folder.to_owned()),
        _ => PathBuf::from(".").canonicalize().unwrap_or_default(),
    }
}

/// A file's path as events name it, and that of the file it leads to.
fn places(file: &Path) -> Vec<PathBuf> {
    let named = folder(file).join(file.file_name().unwrap_or_default());
    let meant = named.canonicalize().ok().filter(|meant| *meant != named);
    std::iter::once(named).chain(meant).collect()
}

//! Runs the real program with limits on its time and its memory.

use super::repository;
use super::tool::{Ran, program_path};
use std::ffi::OsStr;
use std::io::Read;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// What a run may take.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Seconds of a processor.
    pub(crate) seconds: u64,
    /// Bytes of memory that the program asks for.
    pub(crate) memory: u64,
}

impl Limits {
    /// A second for each MB or part of one, two in a build for development, and 64 MB + 64
    /// times the input.
    pub(crate) fn of(input: u64) -> Limits {
        let each = if cfg!(debug_assertions) { 2 } else { 1 };
        Limits { seconds: each * input.div_ceil(1_000_000).max(1), memory: 64_000_000 + 64 * input }
    }
}

/// How long a run may take in all before it is taken for one that waits for ever: the
/// machine may be busy.
const PATIENCE: Duration = Duration::from_secs(120);

/// Runs the program in the repository's root; the error says how a limit ended it.
pub(crate) fn confined<S: AsRef<OsStr>>(
    arguments: impl IntoIterator<Item = S>,
    limits: Limits,
) -> Result<Ran, String> {
    let script = format!("ulimit -t {}; ulimit -d {}; exec \"$@\"", limits.seconds, limits.memory / 1024);
    let mut command = Command::new("sh");
    command.current_dir(repository()).args(["-c", &script, "sh"]).arg(program_path()).args(arguments);
    command.env("RAYON_NUM_THREADS", "2");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let (out, err) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
    let read = |mut from: Box<dyn Read + Send>| {
        thread::spawn(move || {
            let mut bytes = Vec::new();
            from.read_to_end(&mut bytes).map(|_| bytes)
        })
    };
    let (out, err) = (read(Box::new(out)), read(Box::new(err)));
    let started = Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            Some(status) => break status,
            None if started.elapsed() > PATIENCE => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("did not end within {PATIENCE:?}"));
            }
            None => thread::sleep(Duration::from_millis(2)),
        }
    };
    let (stdout, stderr) = (out.join().unwrap().unwrap(), err.join().unwrap().unwrap());
    let stderr = String::from_utf8(stderr).unwrap();
    match status.code() {
        Some(code) => Ok(Ran { code, stdout, stderr }),
        None => Err(format!("was ended within {limits:?}: {status}\n{stderr}")),
    }
}

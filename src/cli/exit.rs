//! Exit codes, and what is said when something fails.

use std::io;

/// How a run ends; the worst of several inputs counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Exit {
    /// Everything asked for is done.
    Done = 0,
    /// An input was refused.
    Refused = 1,
    /// The command line makes no sense.
    Usage = 2,
    /// An output failed its check.
    Failed = 3,
    /// The environment: a full disk, a missing permission, no graphics adapter.
    Environment = 4,
}

/// Why a run, or one input of it, ends early.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) exit: Exit,
    /// For standard error.
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn new(exit: Exit, message: impl Into<String>) -> Failure {
        Failure { exit, message: message.into() }
    }

    pub(crate) fn refused(message: impl Into<String>) -> Failure {
        Failure::new(Exit::Refused, message)
    }

    pub(crate) fn usage(message: impl Into<String>) -> Failure {
        Failure::new(Exit::Usage, message)
    }

    pub(crate) fn environment(message: impl Into<String>) -> Failure {
        Failure::new(Exit::Environment, message)
    }

    pub(crate) fn print(&self) {
        say(&format!("error: {}", self.message));
    }
}

/// Writing to standard output failed.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        Failure::environment(format!("standard output: {error}"))
    }
}

/// What became of showing something. A reader who has seen enough (`| head`) is no
/// failure, and takes nothing from what the exit code says.
pub(crate) fn shown(written: io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(Failure::from),
    }
}

/// Prints a line on standard error; a closed one is not worth failing for.
pub(crate) fn say(line: &str) {
    use io::Write;
    let _ = writeln!(io::stderr(), "{line}");
}

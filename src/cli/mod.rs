//! What the command line adds to the library: arguments, files, messages, exit codes.

mod args;
mod aside;
mod bins;
mod camera;
mod check;
mod compare;
mod convert;
mod diff;
mod example;
mod exit;
mod files;
mod inspect;
mod output;
#[cfg(feature = "plot-png")]
mod plot;
mod progress;
mod reduce;
mod sample;
mod summary;
#[cfg(feature = "render")]
mod thumbnail;
mod watch;

use args::{Cli, Command};
use clap::{CommandFactory, Parser};
use exit::{Exit, Failure, shown};
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

/// Four commands to begin with, for whoever types none.
const FIRST_STEPS: &str = "\
dat2glb converts quaternion keyframes to glTF animations. To get started:

  dat2glb example chain > chain.dat              a small sample input
  dat2glb convert chain.dat -o chain.glb         convert it to an animated .glb
  dat2glb check chain.glb --against chain.dat    check that it plays correctly
  dat2glb --help                                 everything else
";

/// Runs the tool with the arguments of a command line, program name included.
pub(crate) fn run(arguments: Vec<OsString>) -> ExitCode {
    if arguments.len() < 2 {
        return finish(say_first_steps());
    }
    let cli = match Cli::try_parse_from(args::with_convert_spelled_out(arguments)) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are written to standard output and are no failure.
            let code = if error.use_stderr() { Exit::Usage } else { Exit::Done };
            return finish(shown(error.print()).map(|()| code));
        }
    };
    finish(match cli.command {
        Command::Convert(options) => convert::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Diff(options) => diff::run(&options),
        #[cfg(feature = "render")]
        Command::Thumbnail(options) => thumbnail::run(&options),
        Command::Inspect(options) => inspect::run(&options),
        Command::Reduce(options) => reduce::run(&options),
        Command::Sample(options) => sample::run(&options),
        Command::Compare(options) => compare::run(&options),
        #[cfg(feature = "plot-png")]
        Command::Plot(options) => plot::run(&options),
        Command::Example(options) => example::run(&options),
        Command::Completions { shell } => completions(shell),
        Command::Man => man(),
    })
}

fn say_first_steps() -> Result<Exit, Failure> {
    shown(io::stderr().write_all(FIRST_STEPS.as_bytes()))?;
    Ok(Exit::Usage)
}

/// Prints what failed and turns the outcome into the exit code.
fn finish(outcome: Result<Exit, Failure>) -> ExitCode {
    let exit = outcome.unwrap_or_else(|failure| {
        failure.print();
        failure.exit
    });
    ExitCode::from(exit as u8)
}

fn completions(shell: clap_complete::Shell) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "dat2glb", &mut script);
    shown(io::stdout().write_all(&script))?;
    Ok(Exit::Done)
}

/// One page: the tool, then each command as a section of its own.
fn man() -> Result<Exit, Failure> {
    let mut command = Cli::command();
    command.build();
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page)?;
    // The crate refers to pages of their own, which there are none of.
    let page = String::from_utf8_lossy(&page).replace("dat2glb\\-", "dat2glb ").replace("(1)\n", "\n");
    let mut page = page.into_bytes();
    for subcommand in command.get_subcommands().filter(|c| c.get_name() != "help") {
        let man = clap_mangen::Man::new(subcommand.clone());
        let mut section = Vec::new();
        man.render_synopsis_section(&mut section)?;
        man.render_description_section(&mut section)?;
        if subcommand.get_arguments().any(|argument| !argument.is_hide_set()) {
            man.render_options_section(&mut section)?;
        }
        let section = String::from_utf8_lossy(&section).replace("\n.SH ", "\n.SS ");
        write!(page, ".SH \"DAT2GLB {}\"\n{section}", subcommand.get_name().to_uppercase())?;
    }
    shown(io::stdout().write_all(&page))?;
    Ok(Exit::Done)
}

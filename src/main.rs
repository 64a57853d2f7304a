//! The command-line tool: opens files, prints, exits; the rest is the library's.

// Outputs are the same bytes everywhere: clippy.toml names what would change that.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod cli;

fn main() -> std::process::ExitCode {
    cli::run(std::env::args_os().collect())
}

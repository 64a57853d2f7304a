//! The command-line tool: opens files, prints, exits; the rest is the library's.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run(std::env::args_os().collect())
}

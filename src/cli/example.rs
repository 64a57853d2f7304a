//! Small inputs to start from.

use super::args::Example;
use super::exit::{Exit, Failure};
use std::io::Write;

/// A kind of input.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum Kind {
    /// A chain of three boxes that swing
    Chain,
    /// One free body that tumbles, in the order x y z w
    Body,
}

pub(super) fn run(options: &Example) -> Result<Exit, Failure> {
    let text = match options.kind {
        Kind::Chain => include_str!("examples/chain.dat"),
        Kind::Body => include_str!("examples/body.dat"),
    };
    std::io::stdout().write_all(text.as_bytes())?;
    Ok(Exit::Done)
}

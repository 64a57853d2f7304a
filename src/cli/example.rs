//! Small inputs to start from.

use super::args::{Example, Kind};
use super::exit::{Exit, Failure, shown};
use std::io::Write;

pub(super) fn run(options: &Example) -> Result<Exit, Failure> {
    let text = match options.kind {
        Kind::Chain => include_str!("examples/chain.dat"),
        Kind::Body => include_str!("examples/body.dat"),
        Kind::Flight => include_str!("examples/flight.dat"),
        Kind::Bezier => include_str!("examples/bezier.dat"),
        Kind::Camera => include_str!("examples/camera.dat"),
        Kind::Euler => include_str!("examples/euler.dat"),
    };
    shown(std::io::stdout().write_all(text.as_bytes()))?;
    Ok(Exit::Done)
}

//! Any input, told by its header.

use super::blocks::Blocks;
use super::keyframes::{Start, start};
use super::kind::Kind;
use super::{Error, Keyframes, Order, PathFile, RotationsFile, path, rotations};
use std::io::Read;

/// What an input holds.
#[derive(Debug)]
#[non_exhaustive]
pub enum Input {
    /// Rotations of boxes at key times.
    Keyframes(Keyframes),
    /// Points of a path.
    Path(PathFile),
    /// Rotations of one object, given otherwise than by keyframes.
    Rotations(RotationsFile),
}

/// Reads any kind of `.dat` file, once from its first byte to its last; `source_name`
/// stands in messages, `order` overrides the header's order of quaternions' parts. The
/// first line that is a header of any kind decides. The format: docs/format.md.
pub fn input(source_name: &str, input: impl Read + Send, order: Option<Order>) -> Result<Input, Error> {
    let mut blocks = Blocks::new(input);
    let opening = match start(source_name, &mut blocks, order)? {
        Start::Keyframes(keyframes) => return Ok(Input::Keyframes(keyframes)),
        Start::Other(opening) => *opening,
    };
    match opening.header.kind {
        Kind::Path(kind) => path::read(source_name, opening, kind, &mut blocks, order).map(Input::Path),
        _ => rotations::read(source_name, opening, &mut blocks, order).map(Input::Rotations),
    }
}

#[cfg(test)]
mod tests;

//! What stands for the renderer on a graphics adapter in a build without one.

use super::error::Error;
use super::layer::Layer;
use super::scene::{Part, Scene, Texture};
use std::convert::Infallible;

/// An adapter, of which there is none.
#[derive(Debug)]
pub(crate) struct Gpu {
    pub(crate) name: String,
    none: Infallible,
}

impl Gpu {
    /// Says that there is no adapter.
    pub(crate) fn new(_: &[Part], _: &[Texture]) -> Result<Self, Error> {
        Err(Error::NoAdapter { reason: "this build draws in software alone".to_owned() })
    }

    /// Draws nothing, ever.
    pub(crate) fn draw(&mut self, _: &Scene) -> Result<Layer, Error> {
        match self.none {}
    }
}

//! Motion along a path: points in, position over time out.
//!
//! A [`Kind`] says how points make a curve, [`PathEnds`] what it does at its two ends,
//! [`Timing`] and [`Ease`] how fast it is run through; a [`Path`] is the curve with its
//! timing. What orientation needs of a path is the trait [`Course`].
//!
//! Every kind becomes Bézier pieces, each without a point of rest inside, so that
//! derivatives, directions, lengths and bounds are computed in one way for all.
//! Formulas and sources: docs/math/paths.md.

mod arc_length;
mod bezier;
mod bounds;
mod course;
mod cusps;
mod error;
mod knots;
mod motion;
mod options;
mod piece;
mod pieces;
mod segments;

pub use course::Course;
pub use error::Error;
pub use motion::Path;
pub use options::{Ease, Kind, Options, PathEnds, Timing};

#[cfg(test)]
mod tests;

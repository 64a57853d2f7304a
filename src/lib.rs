//! Rotations over time in, glTF animations out.
//!
//! The modules stand in the order in which data flows through them:
//! [`read`] turns the text of a `.dat` file into a [`clip`] or into points,
//! [`curve`] runs a smooth motion through its keys, [`path`] through points,
//! and [`orient`] turns an object on its way; [`moves`] puts them on one
//! clock, [`sample`] evaluates them at the times a viewer will play, [`reduce`]
//! finds as few times as a tolerance allows, [`mod@write`] makes a glTF file of
//! the samples, [`asset`] loads any glTF file back, [`check`] judges it, [`rewrite`]
//! takes keys out of it and `render` draws it. [`convert`] is these stages in a row.
//! [`compare`] puts the schemes side by side, [`diff`] two files, `plot` draws curves as
//! diagrams, and [`report`] writes findings for other programs.
//!
//! # Conventions
//!
//! * Quaternions are Hamilton's; `a * b` applies `b` first. Files hold
//!   w x y z, glTF and glam x y z w; the two meet in one place only.
//! * Each box's rotation is local to the box above it.
//! * Times are seconds, angles radians unless a name says degrees.
//! * `t` is seconds, `u` runs from 0 to 1 within a segment, `h` is an interval.

// Outputs are the same bytes everywhere: clippy.toml names what would change that.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod asset;
pub mod check;
pub mod clip;
pub mod compare;
pub mod convert;
pub mod curve;
pub mod diff;
pub mod inspect;
pub mod math;
pub mod moves;
pub mod orient;
pub mod path;
#[cfg(feature = "plot")]
pub mod plot;
pub mod read;
pub mod reduce;
#[cfg(feature = "software")]
pub mod render;
pub mod report;
pub mod rewrite;
pub mod sample;
pub mod table;
pub mod write;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

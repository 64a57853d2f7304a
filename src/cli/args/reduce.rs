//! `dat2glb reduce`.

use super::words::tolerance;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Reduce {
    /// The file: .glb, .gltf; `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// The file to write, of the same kind; `-` writes a .glb to standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// How far rotations may be off the input's playback, degrees
    #[arg(long, value_name = "DEG", value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// How far translations may be off, units; without it they lose nothing but rounding
    #[arg(long, value_name = "UNITS", value_parser = tolerance)]
    pub(crate) tolerance_distance: Option<f64>,
    /// How far scales may be off; without it they lose nothing but rounding
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub(crate) tolerance_scale: Option<f64>,
    /// How far weights of morph targets may be off; without it they lose nothing but
    /// rounding
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub(crate) tolerance_weight: Option<f64>,
    /// The largest turn from key to key, degrees: 18 for viewers that blend the four
    /// numbers
    #[arg(long, value_name = "DEG", value_parser = tolerance)]
    pub(crate) max_step: Option<f64>,
    /// Keep keys on the input's curve, which takes more of them
    #[arg(long)]
    pub(crate) on_curve: bool,
    /// Print the summary as JSON on standard output (on standard error where the .glb
    /// goes to standard output)
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

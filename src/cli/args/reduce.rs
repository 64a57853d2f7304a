//! `dat2glb reduce`.

use super::words::tolerance;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Reduce {
    /// File to reduce: .glb, .gltf; `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// File to write, same format as IN; `-` writes a .glb to standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// Max rotation error against playback of the input, degrees
    #[arg(long, value_name = "DEG", value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// Max position error, units [default: lossless up to rounding]
    #[arg(long, value_name = "UNITS", value_parser = tolerance)]
    pub(crate) tolerance_distance: Option<f64>,
    /// Max scale error [default: lossless up to rounding]
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub(crate) tolerance_scale: Option<f64>,
    /// Max morph weight error [default: lossless up to rounding]
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub(crate) tolerance_weight: Option<f64>,
    /// Max angle between neighboring keys, degrees: 18 for viewers that use nlerp (Blender)
    #[arg(long, value_name = "DEG", value_parser = tolerance)]
    pub(crate) max_step: Option<f64>,
    /// Keep keyframes on the input's curve (takes more keys)
    #[arg(long)]
    pub(crate) on_curve: bool,
    /// Print the summary as JSON on standard output (on standard error if the .glb
    /// goes to standard output)
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

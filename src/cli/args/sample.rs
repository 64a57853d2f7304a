//! `dat2glb sample`.

use super::flags::{OrderFlag, Tangents};
use super::path::Along;
use super::words::{ends, frame, named, positive, scheme};
use clap::{Args, ValueHint};
use dat2glb::curve::{Ends, Scheme};
use dat2glb::orient::Frame;
use dat2glb::sample::Fps;
use dat2glb::table::Notation;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Sample {
    /// Keyframes or a path (.dat); `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// CSV file to write [default: standard output, also for `-`]
    #[arg(short, long, value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// Interpolation scheme between keyframes
    #[arg(long, value_name = "NAME", default_value = "bessel", value_parser = scheme())]
    pub(crate) scheme: Scheme,
    /// End condition of the rotation curve
    #[arg(long, default_value = "natural", value_parser = ends())]
    pub(crate) ends: Ends,
    #[command(flatten)]
    pub(crate) tangents: Tangents,
    /// Rows per second; the end of the motion always has a row
    #[arg(long, default_value = "25")]
    pub(crate) fps: Fps,
    /// Write N + 1 evenly spaced rows (instead of --fps)
    #[arg(long, value_name = "N", conflicts_with = "fps", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) count: Option<u64>,
    /// Rotation format; angles in degrees
    #[arg(long = "as", value_name = "NOTATION", default_value = "quaternion", value_parser = named(Notation::from_name, vec![
        ("quaternion", "w x y z"),
        ("axis-angle", "angle, then axis"),
        ("euler", "roll, pitch, yaw; applied as yaw, then pitch, then roll"),
        ("matrix", "3×3, row-major"),
    ]))]
    pub(crate) notation: Notation,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Move the rotating object along this path
    #[arg(long, value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    /// Play F times faster
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Coordinate frame of the input and of the table (overrides the header)
    #[arg(long, value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    #[command(flatten, next_help_heading = "Path")]
    pub(crate) along: Along,
}

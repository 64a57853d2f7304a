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
    /// The table to write; without it, and for `-`, standard output
    #[arg(short, long, value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// How rotations run from key to key
    #[arg(long, value_name = "NAME", default_value = "bessel", value_parser = scheme())]
    pub(crate) scheme: Scheme,
    /// What rotations do at their ends
    #[arg(long, default_value = "natural", value_parser = ends())]
    pub(crate) ends: Ends,
    #[command(flatten)]
    pub(crate) tangents: Tangents,
    /// Rows per second; the last time has one too
    #[arg(long, default_value = "25")]
    pub(crate) fps: Fps,
    /// Instead of a rate, N + 1 rows at equal steps of time
    #[arg(long, value_name = "N", conflicts_with = "fps", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) count: Option<u64>,
    /// How rotations are written; angles in degrees
    #[arg(long = "as", value_name = "NOTATION", default_value = "quaternion", value_parser = named(Notation::from_name, vec![
        ("quaternion", "w x y z"),
        ("axis-angle", "angle and axis"),
        ("euler", "roll, pitch, yaw: yaw first, then pitch, then roll"),
        ("matrix", "nine numbers, row by row"),
    ]))]
    pub(crate) notation: Notation,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Send what the input turns along this path
    #[arg(long, value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    /// Everything so many times as fast
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Whose x, y and z the numbers are, of the input and of the table
    #[arg(long, value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    #[command(flatten, next_help_heading = "Paths")]
    pub(crate) along: Along,
}

//! `dat2glb check`.

#[cfg(feature = "render")]
use super::flags::RendererFlag;
use super::flags::{OrderFlag, ReportFlag};
use super::words::{degrees, ends, scheme};
use clap::{Args, ValueHint};
use dat2glb::curve::{Ends, Scheme};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Check {
    /// Files to check: .glb, .gltf
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Warnings fail too
    #[arg(long)]
    pub(crate) strict: bool,
    /// Compare the motion with the curve through the keys of this input; said twice where
    /// the file was made of keyframes and a path
    #[arg(long, value_name = "IN.dat", value_hint = ValueHint::FilePath)]
    pub(crate) against: Vec<PathBuf>,
    /// The largest angle, degrees, that playback may be off the curve; without it, what
    /// convert stored in the file
    #[arg(long, value_name = "DEG", requires = "against", value_parser = degrees)]
    pub(crate) max_error: Option<f64>,
    /// The largest distance, units, that playback may be off the path
    #[arg(long, value_name = "UNITS", requires = "against", value_parser = degrees)]
    pub(crate) max_distance: Option<f64>,
    /// The scheme of a file that does not say it itself
    #[arg(long, value_name = "NAME", requires = "against", value_parser = scheme())]
    pub(crate) scheme: Option<Scheme>,
    /// The ends of a file that does not say them itself
    #[arg(long, requires = "against", value_parser = ends())]
    pub(crate) ends: Option<Ends>,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Look at pictures too: is anything to be seen, does it move?
    #[cfg(feature = "render")]
    #[arg(long)]
    pub(crate) render: bool,
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) renderer: RendererFlag,
    #[command(flatten)]
    pub(crate) report: ReportFlag,
}

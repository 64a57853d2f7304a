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
    /// Treat warnings as errors
    #[arg(long)]
    pub(crate) strict: bool,
    /// Compare playback with the curve through this input's keyframes; repeat for keyframes
    /// and a path
    #[arg(long, value_name = "IN.dat", value_hint = ValueHint::FilePath)]
    pub(crate) against: Vec<PathBuf>,
    /// Max rotation error of playback, degrees [default: the bound stored in the file]
    #[arg(long, value_name = "DEG", requires = "against", value_parser = degrees)]
    pub(crate) max_error: Option<f64>,
    /// Max position error of playback, units
    #[arg(long, value_name = "UNITS", requires = "against", value_parser = degrees)]
    pub(crate) max_distance: Option<f64>,
    /// Scheme, for files that do not store it
    #[arg(long, value_name = "NAME", requires = "against", value_parser = scheme())]
    pub(crate) scheme: Option<Scheme>,
    /// End condition, for files that do not store it
    #[arg(long, requires = "against", value_parser = ends())]
    pub(crate) ends: Option<Ends>,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Render frames too: check that something is visible and moves
    #[cfg(feature = "render")]
    #[arg(long)]
    pub(crate) render: bool,
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) renderer: RendererFlag,
    #[command(flatten)]
    pub(crate) report: ReportFlag,
}

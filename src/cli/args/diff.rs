//! `dat2glb diff`.

#[cfg(feature = "render")]
use super::flags::RendererFlag;
use super::flags::ReportFlag;
#[cfg(feature = "render")]
use super::pixels::size;
use super::words::degrees;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Diff {
    /// Reference file: .glb, .gltf
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub(crate) a: PathBuf,
    /// File to compare with it: .glb, .gltf
    #[arg(value_name = "B", value_hint = ValueHint::FilePath)]
    pub(crate) b: PathBuf,
    /// Match clip or node OLD of A with NEW of B (repeatable)
    #[arg(long, value_name = "OLD=NEW", value_parser = mapping)]
    pub(crate) map: Vec<(String, String)>,
    /// Max rotation difference of a node, degrees, local and world
    #[arg(long, value_name = "DEG", value_parser = degrees)]
    pub(crate) max_error: Option<f64>,
    /// Max position difference of a node, units, local and world
    #[arg(long, value_name = "UNITS", value_parser = degrees)]
    pub(crate) max_distance: Option<f64>,
    /// Max scale difference
    #[arg(long, value_name = "X", value_parser = degrees)]
    pub(crate) max_scale: Option<f64>,
    /// Max morph weight difference
    #[arg(long, value_name = "X", value_parser = degrees)]
    pub(crate) max_weight: Option<f64>,
    /// Treat warnings as errors: clips, nodes and channels present in only one file
    #[arg(long)]
    pub(crate) strict: bool,
    /// Render both poses where they differ most, A on the left
    #[cfg(feature = "render")]
    #[arg(long, value_name = "OUT.png", value_hint = ValueHint::FilePath)]
    pub(crate) picture: Option<PathBuf>,
    /// Width and height of each half of the image in pixels
    #[cfg(feature = "render")]
    #[arg(long, value_name = "WxH", default_value = "512x512", requires = "picture", value_parser = size)]
    pub(crate) size: (u32, u32),
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) renderer: RendererFlag,
    #[command(flatten)]
    pub(crate) report: ReportFlag,
}

fn mapping(text: &str) -> Result<(String, String), String> {
    let names = text.split_once('=').filter(|(old, new)| !old.is_empty() && !new.is_empty());
    let (old, new) = names.ok_or_else(|| "expected two names, such as Hips=pelvis".to_owned())?;
    Ok((old.to_owned(), new.to_owned()))
}

//! `dat2glb inspect`.

use super::flags::OrderFlag;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Inspect {
    /// Keyframes or a path (.dat), .glb or .gltf; `-` reads standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

//! `dat2glb compare`.

use super::flags::OrderFlag;
use super::words::{Schemes, each_once, ends, schemes};
use clap::{Args, ValueHint};
use dat2glb::curve::{Ends, Scheme};
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Compare {
    /// Rotations (.dat); `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// Schemes to compare, comma-separated; `all` for all but step
    #[arg(long, value_name = "NAME[,NAME…]", default_value = "all", value_delimiter = ',', value_parser = schemes())]
    scheme: Vec<Schemes>,
    /// End condition of the rotation curve
    #[arg(long, default_value = "natural", value_parser = ends())]
    pub(crate) ends: Ends,
    /// Compare only this box, counted from 1
    #[arg(long = "box", value_name = "B", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) only: Option<u64>,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl Compare {
    /// The schemes asked for, each once, in the order given.
    pub(crate) fn schemes(&self) -> Vec<Scheme> {
        each_once(&self.scheme)
    }
}

//! `dat2glb convert`.

use super::flags::{OrderFlag, Tangents};
use super::keys::Keys;
use super::path::{Along, Scenery};
use super::words::{Schemes, each_once, ends, formats, frame, positive, schemes};
use clap::{Args, ValueHint};
use dat2glb::curve::{Ends, Scheme};
use dat2glb::orient::Frame;
use dat2glb::report::Format;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Convert {
    /// Keyframes or paths (.dat); `-` reads standard input
    #[arg(required = true, value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten, next_help_heading = "Input")]
    pub(crate) order: OrderFlag,
    /// Coordinate frame of the input: paths and Euler angles (overrides the header)
    #[arg(long, help_heading = "Input", value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    /// Interpolation scheme between keyframes; several, comma-separated, become one clip
    /// each; `all` for all but step
    #[arg(long, help_heading = "Curve", value_name = "NAME[,NAME…]", default_value = "bessel", value_delimiter = ',', value_parser = schemes())]
    scheme: Vec<Schemes>,
    /// End condition of the rotation curve
    #[arg(long, help_heading = "Curve", default_value = "natural", value_parser = ends(), hide_possible_values = false)]
    pub(crate) ends: Ends,
    #[command(flatten, next_help_heading = "Curve")]
    pub(crate) tangents: Tangents,
    /// Play F times faster
    #[arg(long, help_heading = "Curve", value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Move the rotating object along this path
    #[arg(long, help_heading = "Path", value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Path")]
    pub(crate) along: Along,
    #[command(flatten, next_help_heading = "Sampling")]
    pub(crate) keys: Keys,
    #[command(flatten)]
    pub(crate) scenery: Scenery,
    /// File to write, .glb or .gltf (with a .bin beside it); `-` writes a .glb to standard
    /// output. A folder for several inputs [default: IN.glb next to the input]
    #[arg(short, long, help_heading = "Output", value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub(crate) output: Option<PathBuf>,
    /// Render an image of the result too; a folder for several inputs
    #[cfg(feature = "render")]
    #[arg(long, help_heading = "Output", value_name = "OUT.png", value_hint = ValueHint::FilePath)]
    pub(crate) thumbnail: Option<PathBuf>,
    /// Convert again whenever an input changes, until interrupted
    #[arg(long, help_heading = "Output")]
    pub(crate) watch: bool,
    /// Print the summary as JSON on standard output (on standard error if the .glb goes to
    /// standard output)
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(short, long, help_heading = "Output")]
    pub(crate) quiet: bool,
    /// Write nothing: exit with code 3 if an output is out of date with its inputs and
    /// options; values may differ by one float32 step
    #[arg(long, help_heading = "Checks", conflicts_with = "watch")]
    pub(crate) check: bool,
    /// With --check: format of the report on standard output
    #[arg(long, help_heading = "Checks", value_name = "FORMAT", requires = "check", conflicts_with = "json", value_parser = formats())]
    report: Option<Format>,
}

impl Convert {
    /// How a report is written.
    pub(crate) fn format(&self) -> Format {
        if self.json { Format::Json } else { self.report.unwrap_or_default() }
    }

    /// The schemes asked for, each once, in the order given.
    pub(crate) fn schemes(&self) -> Vec<Scheme> {
        each_once(&self.scheme)
    }
}

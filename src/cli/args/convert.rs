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
    /// The file to write, .glb or .gltf (with a .bin beside it); `-` writes a .glb to
    /// standard output. For several inputs a folder. Without it: next to the input, .glb
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub(crate) output: Option<PathBuf>,
    /// How rotations run from key to key; several, separated by commas, become one clip
    /// each; `all` for every scheme
    #[arg(long, value_name = "NAME[,NAME…]", default_value = "bessel", value_delimiter = ',', value_parser = schemes())]
    scheme: Vec<Schemes>,
    /// What the motion does at its ends
    #[arg(long, default_value = "natural", value_parser = ends(), hide_possible_values = false)]
    pub(crate) ends: Ends,
    #[command(flatten)]
    pub(crate) tangents: Tangents,
    /// Everything so many times as fast
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Whose x, y and z the numbers of a path or of Euler angles are; overrides the header
    #[arg(long, value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    /// Convert again whenever an input changes, until interrupted
    #[arg(long)]
    pub(crate) watch: bool,
    /// Write nothing: fail with exit code 3 where an output is not what its inputs and
    /// options give now, numbers to one float32 step
    #[arg(long, conflicts_with = "watch")]
    pub(crate) check: bool,
    /// With --check: how the report is written on standard output
    #[arg(long, value_name = "FORMAT", requires = "check", conflicts_with = "json", value_parser = formats())]
    report: Option<Format>,
    #[command(flatten)]
    pub(crate) keys: Keys,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Send what the inputs turn along this path
    #[arg(long, value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    /// Draw a picture of the result too; for several inputs a folder
    #[cfg(feature = "render")]
    #[arg(long, value_name = "OUT.png", value_hint = ValueHint::FilePath)]
    pub(crate) thumbnail: Option<PathBuf>,
    /// Print the summary as JSON on standard output (on standard error where the .glb
    /// goes to standard output)
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
    #[command(flatten, next_help_heading = "Paths")]
    pub(crate) along: Along,
    #[command(flatten, next_help_heading = "Cameras, copies, and the path itself")]
    pub(crate) scenery: Scenery,
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

//! `dat2glb plot`.

use super::flags::{OrderFlag, Tangents};
use super::path::Along;
use super::pixels::size;
use super::words::{Schemes, each_once, ends, frame, named, positive, schemes, tolerance};
use clap::{Args, ValueHint};
use dat2glb::curve::{Ends, Scheme};
use dat2glb::orient::Frame;
use dat2glb::plot::{Clock, Show, Theme};
use dat2glb::sample::Fps;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct Plot {
    /// Keyframes or a path (.dat); `-` reads standard input. With --show error a .glb or
    /// .gltf; with --all-figures several inputs
    #[arg(required = true, value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) inputs: Vec<PathBuf>,
    /// Image to write, .svg or .png; `-` writes SVG to standard output [default: IN.svg]
    #[arg(short, long, value_name = "OUT.svg|.png", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// Schemes to plot, comma-separated, one line each; `all` for all but step [default:
    /// bessel; with --all-figures slerp, catmull-rom and bessel-overhauser]
    #[arg(long, value_name = "NAME[,NAME…]", value_delimiter = ',', value_parser = schemes())]
    scheme: Vec<Schemes>,
    /// Quantity to plot
    #[arg(long, value_name = "WHAT", default_value = "components", value_parser = shows())]
    pub(crate) show: Show,
    /// Input columns to plot, counted from 1 after the time: box 1 is 1 to 4, box 4 is
    /// 13 to 16 [default: all of one box, or x, y and z of a path]
    #[arg(long, value_name = "K[,K…]", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    component: Vec<u32>,
    /// Box to plot, counted from 1 [default: the first; all with --show error and sphere]
    #[arg(long = "box", value_name = "B", value_parser = clap::value_parser!(u32).range(1..))]
    only: Option<u32>,
    /// One page of figures for several inputs: each component with each scheme, and with
    /// all schemes overlaid [--component defaults to 2,16]
    #[arg(long, conflicts_with_all = ["show", "only", "against", "path"])]
    pub(crate) all_figures: bool,
    /// Frames per second, for --x frames
    #[arg(long, default_value = "25")]
    fps: Fps,
    /// Unit of the time axis
    #[arg(long, value_name = "UNIT", default_value = "seconds", value_parser = ["seconds", "frames"])]
    x: String,
    /// Color theme
    #[arg(long, default_value = "light", value_parser = named(Theme::from_name, vec![("light", "dark on white"), ("dark", "light on dark gray")]))]
    pub(crate) theme: Theme,
    /// Width and height in pixels [default: fits the plots]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<(u32, u32)>,
    /// With --show error: input the file was converted from; repeat for keyframes and a path
    #[arg(long, value_name = "IN.dat", value_hint = ValueHint::FilePath)]
    pub(crate) against: Vec<PathBuf>,
    /// With --show error: limit line, degrees or units [default: the tolerance or error bound
    /// stored in the file]
    #[arg(long, value_name = "DEG", requires = "against", allow_negative_numbers = true, value_parser = tolerance)]
    pub(crate) tolerance: Option<f64>,
    /// End condition of the rotation curve [default: the file's, else natural]
    #[arg(long, value_parser = ends())]
    pub(crate) ends: Option<Ends>,
    #[command(flatten)]
    pub(crate) tangents: Tangents,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Move the rotating object along this path
    #[arg(long, value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    /// Play F times faster
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Coordinate frame of the input: paths and Euler angles (overrides the header)
    #[arg(long, value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    #[command(flatten, next_help_heading = "Path")]
    pub(crate) along: Along,
}

impl Plot {
    /// The schemes asked for, each once, in the order given; empty where none was.
    pub(crate) fn schemes(&self) -> Vec<Scheme> {
        each_once(&self.scheme)
    }

    /// What the time axis counts.
    pub(crate) fn clock(&self) -> Clock {
        if self.x == "frames" { Clock::Frames(1.0 / self.fps.interval()) } else { Clock::Seconds }
    }

    /// The numbers asked for, in the order given.
    pub(crate) fn components(&self) -> Vec<usize> {
        self.component.iter().map(|&number| number as usize).collect()
    }

    /// The box asked for, from 1.
    pub(crate) fn only(&self) -> Option<usize> {
        self.only.map(|number| number as usize)
    }
}

fn shows() -> clap::builder::ValueParser {
    named(Show::from_name, Show::ALL.iter().map(|show| (show.name(), show.summary())).collect())
}

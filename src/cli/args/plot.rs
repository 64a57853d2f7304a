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
    /// The picture to write, .svg or .png; without it IN.svg. `-` writes an SVG to standard
    /// output
    #[arg(short, long, value_name = "OUT.svg|.png", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// Which schemes, separated by commas, each as a line; `all` for every one but step;
    /// without it bessel, and for --all-figures slerp, catmull-rom and bessel-overhauser
    #[arg(long, value_name = "NAME[,NAME…]", value_delimiter = ',', value_parser = schemes())]
    scheme: Vec<Schemes>,
    /// What is shown
    #[arg(long, value_name = "WHAT", default_value = "components", value_parser = shows())]
    pub(crate) show: Show,
    /// Which numbers of a row, counted from 1 after its time: box 1 has 1 to 4, box 4 has
    /// 13 to 16; without it all of one box, or x, y and z of a path
    #[arg(long, value_name = "K[,K…]", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    component: Vec<u32>,
    /// Which box, counted from 1; without it the first, with --show error and sphere all
    #[arg(long = "box", value_name = "B", value_parser = clap::value_parser!(u32).range(1..))]
    only: Option<u32>,
    /// A page of single figures for several inputs: each component by each scheme, and by
    /// all of them together; without --component the 2nd and the 16th
    #[arg(long, conflicts_with_all = ["show", "only", "against", "path"])]
    pub(crate) all_figures: bool,
    /// Frames per second, for --x frames
    #[arg(long, default_value = "25")]
    fps: Fps,
    /// What the time axis counts
    #[arg(long, value_name = "UNIT", default_value = "seconds", value_parser = ["seconds", "frames"])]
    x: String,
    /// Dark on white, or light on dark grey
    #[arg(long, default_value = "light", value_parser = named(Theme::from_name, vec![("light", ""), ("dark", "")]))]
    pub(crate) theme: Theme,
    /// Width and height in pixels; without it as large as its diagrams like to be
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<(u32, u32)>,
    /// With --show error: the input that the file was made of; said twice where it was made
    /// of keyframes and a path
    #[arg(long, value_name = "IN.dat", value_hint = ValueHint::FilePath)]
    pub(crate) against: Vec<PathBuf>,
    /// With --show error: draw this as the limit, degrees or units; without it the tolerance
    /// or the bound that the file keeps
    #[arg(long, value_name = "DEG", requires = "against", allow_negative_numbers = true, value_parser = tolerance)]
    pub(crate) tolerance: Option<f64>,
    /// What rotations do at their ends; without it natural, or what the file says
    #[arg(long, value_parser = ends())]
    pub(crate) ends: Option<Ends>,
    #[command(flatten)]
    pub(crate) tangents: Tangents,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Send what the input turns along this path
    #[arg(long, value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    /// Everything so many times as fast
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Whose x, y and z the numbers of a path or of Euler angles are; overrides the header
    #[arg(long, value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    #[command(flatten, next_help_heading = "Paths")]
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

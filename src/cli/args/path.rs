//! How to go along a path, and what there is beside the object.

use super::super::camera::CameraSpec;
use super::words::{axis, finite, named, positive};
use clap::Args;
use dat2glb::curve::{Ends, Tcb};
use dat2glb::moves::{Copies, Orient, Shape};
use dat2glb::orient::{Axis, Frame, Level};
use dat2glb::path::{Ease, PathEnds, Timing};
use dat2glb::write::Colour;

/// How to go along a path, and how to look on the way.
#[derive(Args, Debug)]
pub(crate) struct Along {
    /// Timing along the path [default: the file's, or that of the kind of path]
    #[arg(long, value_parser = named(Timing::from_name, vec![
        ("uniform", "equal time per segment"),
        ("chord", "segment time proportional to its chord length"),
        ("constant-speed", "constant speed along the arc length"),
        ("times", "times given in the file"),
    ]))]
    timing: Option<Timing>,
    /// Ease in and out at the path's ends, with constant-speed timing
    #[arg(long, default_value = "none", value_parser = named(Ease::from_name, vec![
        ("none", ""), ("in", "at the start"), ("out", "at the end"), ("in-out", "at both"),
    ]))]
    ease: Ease,
    /// Mean speed, units per second: duration = length / speed (overrides the header)
    #[arg(long, value_name = "V", allow_negative_numbers = true, value_parser = positive)]
    speed: Option<f64>,
    /// End condition of the path
    #[arg(long, default_value = "natural", value_parser = named(PathEnds::from_name, vec![
        ("natural", "zero acceleration at both ends"),
        ("clamped", "zero velocity at both ends"),
        ("repeat", "the end point is repeated"),
        ("closed", "loop: the end connects to the start"),
        ("periodic", "alias of closed"),
    ]))]
    path_ends: PathEnds,
    /// Orientation along the path [default: upright for a path alone, none with rotation
    /// keyframes, keyed if the path has orientations]
    #[arg(long, value_parser = named(Orient::from_name, vec![
        ("none", "no rotation"),
        ("keyed", "orientation keys at the key points, interpolated by the scheme"),
        ("tangent", "tangent forward, minimal twist"),
        ("upright", "tangent forward, +Y up"),
    ]))]
    orient: Option<Orient>,
    /// Max bank angle, in the sharpest turn (upright only)
    #[arg(
        long,
        value_name = "DEG",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = finite
    )]
    bank: f64,
    /// Zero pitch and roll at the last N orientation keys (landing)
    #[arg(
        long,
        value_name = "N",
        default_value = "0",
        hide_default_value = true,
        allow_negative_numbers = true
    )]
    level_end: usize,
    /// Zero pitch and roll at the first N orientation keys (takeoff)
    #[arg(
        long,
        value_name = "N",
        default_value = "0",
        hide_default_value = true,
        allow_negative_numbers = true
    )]
    level_start: usize,
    /// Forward axis of the model
    #[arg(long, value_name = "AXIS", default_value = "Z", allow_hyphen_values = true, value_parser = axis())]
    model_forward: Axis,
    /// Up axis of the model
    #[arg(long, value_name = "AXIS", default_value = "Y", allow_hyphen_values = true, value_parser = axis())]
    model_up: Axis,
}

impl Along {
    /// All that shapes the motion.
    pub(crate) fn shape(&self, ends: Ends, tcb: Tcb, time_scale: f64, frame: Option<Frame>) -> Shape {
        Shape {
            ends,
            tcb,
            path_ends: self.path_ends,
            timing: self.timing,
            ease: self.ease,
            speed: self.speed,
            time_scale,
            frame,
            orient: self.orient,
            bank: self.bank,
            level: Level { start: self.level_start, end: self.level_end },
            model_forward: self.model_forward,
            model_up: self.model_up,
            copies: Copies::default(),
        }
    }

    /// Whether anything is asked for that only a path can have.
    pub(crate) fn is_asked(&self) -> bool {
        let plain = Shape::default();
        self.shape(plain.ends, plain.tcb, plain.time_scale, plain.frame) != plain
    }
}

/// What there is beside the object.
#[derive(Args, Debug)]
pub(crate) struct Scenery {
    /// Add a camera (repeatable).
    /// `PATH.dat[,look-at=root|X:Y:Z][,rotation=FILE]`: on its own path,
    /// looking ahead, at the object, at a point, or with its own rotation keyframes.
    /// `follow[,offset=X:Y:Z]`: behind and above the object. `keys`: a static camera
    /// beside each key point
    #[arg(long = "camera", help_heading = "Cameras", value_name = "SPEC", value_parser = clap::value_parser!(CameraSpec), verbatim_doc_comment)]
    pub(crate) cameras: Vec<CameraSpec>,
    /// Number of copies following the path
    #[arg(long, help_heading = "Copies", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    repeat: Option<u32>,
    /// Seconds between copies [default: evenly spread over the path]
    #[arg(long, help_heading = "Copies", value_name = "SECONDS", requires = "repeat", allow_negative_numbers = true, value_parser = positive)]
    delay: Option<f64>,
    /// Hide each copy until it starts instead of looping them all; makes the clip longer
    #[arg(long, help_heading = "Copies", requires = "repeat")]
    no_wrap: bool,
    /// Export the path as a line, with its control points and control polygon
    #[arg(long, help_heading = "Output")]
    export_path: bool,
    /// Color of the exported path
    #[arg(long, help_heading = "Output", default_value = "time", requires = "export_path", value_parser = named(Colour::from_name, vec![
        ("time", "by time: dark early, light late"),
        ("depth", "by depth along Z: dark behind, light in front"),
    ]))]
    color: Colour,
}

impl Scenery {
    pub(crate) fn copies(&self) -> Copies {
        Copies { count: self.repeat.map_or(1, |n| n as usize), delay: self.delay, wrap: !self.no_wrap }
    }

    /// How the path is drawn, if it is.
    pub(crate) fn path_colour(&self) -> Option<Colour> {
        self.export_path.then_some(self.color)
    }

    /// Whether anything is asked for that only a path can have.
    pub(crate) fn needs_path(&self) -> bool {
        self.repeat.is_some() || self.export_path
    }
}

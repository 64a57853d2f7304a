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
    /// How time is shared out along the path; without it the kind's own, or the file's
    #[arg(long, value_parser = named(Timing::from_name, vec![
        ("uniform", "every segment takes equally long"),
        ("chord", "a segment's time is proportional to the distance between its ends"),
        ("constant-speed", "equal distances in equal times"),
        ("times", "from the file"),
    ]))]
    timing: Option<Timing>,
    /// Rest at the path's ends, under constant speed
    #[arg(long, default_value = "none", value_parser = named(Ease::from_name, vec![
        ("none", ""), ("in", "at the start"), ("out", "at the end"), ("in-out", "at both"),
    ]))]
    ease: Ease,
    /// Mean speed, units a second: the duration is the length divided by it, whatever the
    /// file's header says
    #[arg(long, value_name = "V", allow_negative_numbers = true, value_parser = positive)]
    speed: Option<f64>,
    /// What the path does at its ends
    #[arg(long, default_value = "natural", value_parser = named(PathEnds::from_name, vec![
        ("natural", "starts and stops without acceleration"),
        ("clamped", "starts and stops at rest"),
        ("repeat", "the end point counts twice"),
        ("closed", "the end runs into the start"),
        ("periodic", "another word for closed"),
    ]))]
    path_ends: PathEnds,
    /// How the object looks on its way; without it upright where the path alone moves it,
    /// none where rotation keys turn it, keyed where the path gives orientations
    #[arg(long, value_parser = named(Orient::from_name, vec![
        ("none", "as it stands"),
        ("keyed", "turned from chord to chord at key points; the scheme runs between"),
        ("tangent", "along the way, with the least twist"),
        ("upright", "along the way, with its head up"),
    ]))]
    orient: Option<Orient>,
    /// How far it leans into the sharpest turn; upright only
    #[arg(
        long,
        value_name = "DEG",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = finite
    )]
    bank: f64,
    /// The last N orientation keys have no pitch and no roll: a landing
    #[arg(
        long,
        value_name = "N",
        default_value = "0",
        hide_default_value = true,
        allow_negative_numbers = true
    )]
    level_end: usize,
    /// The first N orientation keys have no pitch and no roll
    #[arg(
        long,
        value_name = "N",
        default_value = "0",
        hide_default_value = true,
        allow_negative_numbers = true
    )]
    level_start: usize,
    /// Where the model's nose points
    #[arg(long, value_name = "AXIS", default_value = "Z", allow_hyphen_values = true, value_parser = axis())]
    model_forward: Axis,
    /// Where the model's top points
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
    /// Add a camera; may be said several times.
    /// `PATH.dat[,look-at=root|X:Y:Z][,rotation=FILE]`: on a path of its own, looking ahead, at
    /// the object, at a point, or by rotations of its own. `follow[,offset=X:Y:Z]`: behind and
    /// above the object. `keys`: a still one beside each key point
    #[arg(long = "camera", value_name = "SPEC", value_parser = clap::value_parser!(CameraSpec), verbatim_doc_comment)]
    pub(crate) cameras: Vec<CameraSpec>,
    /// Send so many objects along the path, one after another
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    repeat: Option<u32>,
    /// Seconds from one object to the next; without it evenly over the path
    #[arg(long, value_name = "SECONDS", requires = "repeat", allow_negative_numbers = true, value_parser = positive)]
    delay: Option<f64>,
    /// Hide each object until it starts, instead of wrapping all into one loop; the clip
    /// gets longer
    #[arg(long, requires = "repeat")]
    no_wrap: bool,
    /// Show the path too: as a line, with its control points and their polygon
    #[arg(long)]
    export_path: bool,
    /// What the colours of the line tell
    #[arg(long, default_value = "time", requires = "export_path", value_parser = named(Colour::from_name, vec![
        ("time", "when the path passes: dark early, light late"),
        ("depth", "how far along Z: dark behind, light in front"),
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

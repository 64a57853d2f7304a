//! The command line: commands, options, help.

mod keys;
#[cfg(any(feature = "render", feature = "plot"))]
mod pixels;
#[cfg(feature = "plot")]
mod plot;
#[cfg(feature = "render")]
mod thumbnail;

use super::camera::CameraSpec;
use clap::builder::{PossibleValue, TypedValueParser, ValueParser};
use clap::{Args, Parser, Subcommand, ValueHint};
use dat2glb::curve::{Ends, Scheme, Tcb};
use dat2glb::moves::{Copies, Orient, Shape};
use dat2glb::orient::{Axis, Frame, Level};
use dat2glb::path::{Ease, PathEnds, Timing};
use dat2glb::read::Order;
use dat2glb::report::Format;
use dat2glb::sample::Fps;
use dat2glb::table::Notation;
use dat2glb::write::Colour;
use keys::Keys;
#[cfg(feature = "render")]
use pixels::size;
#[cfg(feature = "plot")]
pub(crate) use plot::Plot;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
#[cfg(feature = "render")]
pub(crate) use thumbnail::Thumbnail;

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 input refused, 2 usage, 3 output failed its check, 4 environment \
(a full disk, a missing permission, no graphics adapter).";

/// Turns quaternion keyframes into glTF animations that play right everywhere.
#[derive(Debug, Parser)]
#[command(name = "dat2glb", version, arg_required_else_help = true, after_help = EXIT_CODES)]
#[command(
    override_usage = "dat2glb <COMMAND> …\n       dat2glb <IN.dat> [OUT.glb] [OPTIONS]    short for convert"
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Convert keyframes to an animated .glb or .gltf, and check it by loading it back
    ///
    /// `dat2glb IN.dat [OUT.glb]` is short for `dat2glb convert IN.dat [-o OUT.glb]`.
    Convert(Convert),
    /// Check any .glb or .gltf, and compare its motion with its input
    Check(Check),
    /// Find the largest differences between the motions of two .glb or .gltf files
    ///
    /// Clips and nodes are matched by name; those whose names are missing or double by
    /// their path in the tree, then by their order. Both files are played as the glTF
    /// specification says, whatever their interpolation; a shorter clip holds its last
    /// pose. Local motion is a node's relative to its parent, world motion that of its
    /// axes and its origin. Without limits the differences are told and the exit code is
    /// 0; above a limit it is 3. What only one file has fails under --strict.
    Diff(Diff),
    /// Draw a .glb or .gltf: at a time, as a contact sheet, as ghosts, or moving
    #[cfg(feature = "render")]
    Thumbnail(Thumbnail),
    /// Say what a file holds: keyframes, .glb or .gltf
    Inspect(Inspect),
    /// Write a .glb or .gltf again with fewer keys, all else in it as it was
    Reduce(Reduce),
    /// Write the motion as a table: CSV, a row a time
    Sample(Sample),
    /// Compare schemes: speed, smoothness, overshoot, keys needed
    ///
    /// A row a scheme: the largest and the root-mean-square angular speed and acceleration;
    /// by how much angular velocity and acceleration jump at a key at most; how far the
    /// motion goes beyond its keys (overshoot) and off the arc between them (stray), degrees;
    /// how many keys playback needs to stay within so many degrees of it, and their bytes.
    Compare(Compare),
    /// Draw curves as diagrams: SVG or PNG
    ///
    /// Quaternions' parts over time, speeds, a path from its sides, where axes point, or how
    /// far a file's playback is off its curve; several schemes in one frame.
    #[cfg(feature = "plot")]
    Plot(Plot),
    /// Print a small input to start from
    Example(Example),
    /// Print a completion script for a shell
    Completions {
        /// Which shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page
    Man,
}

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

#[derive(Args, Debug)]
pub(crate) struct Check {
    /// Files to check: .glb, .gltf
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Warnings fail too
    #[arg(long)]
    pub(crate) strict: bool,
    /// Compare the motion with the curve through the keys of this input; said twice where
    /// the file was made of keyframes and a path
    #[arg(long, value_name = "IN.dat", value_hint = ValueHint::FilePath)]
    pub(crate) against: Vec<PathBuf>,
    /// The largest angle, degrees, that playback may be off the curve; without it, what
    /// convert stored in the file
    #[arg(long, value_name = "DEG", requires = "against", value_parser = degrees)]
    pub(crate) max_error: Option<f64>,
    /// The largest distance, units, that playback may be off the path
    #[arg(long, value_name = "UNITS", requires = "against", value_parser = degrees)]
    pub(crate) max_distance: Option<f64>,
    /// The scheme of a file that does not say it itself
    #[arg(long, value_name = "NAME", requires = "against", value_parser = scheme())]
    pub(crate) scheme: Option<Scheme>,
    /// The ends of a file that does not say them itself
    #[arg(long, requires = "against", value_parser = ends())]
    pub(crate) ends: Option<Ends>,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Look at pictures too: is anything to be seen, does it move?
    #[cfg(feature = "render")]
    #[arg(long)]
    pub(crate) render: bool,
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) renderer: RendererFlag,
    #[command(flatten)]
    pub(crate) report: ReportFlag,
    /// Print nothing but what cannot be read; the exit code tells
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Diff {
    /// The first file, as it was: .glb, .gltf
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub(crate) a: PathBuf,
    /// The second file, as it is: .glb, .gltf
    #[arg(value_name = "B", value_hint = ValueHint::FilePath)]
    pub(crate) b: PathBuf,
    /// A clip or node OLD of the first file is NEW in the second; may be said several
    /// times
    #[arg(long, value_name = "OLD=NEW", value_parser = mapping)]
    pub(crate) map: Vec<(String, String)>,
    /// The largest angle, degrees, by which a node may be turned differently, locally and
    /// in the world
    #[arg(long, value_name = "DEG", value_parser = degrees)]
    pub(crate) max_error: Option<f64>,
    /// The largest distance, units, between the places of a node, locally and in the world
    #[arg(long, value_name = "UNITS", value_parser = degrees)]
    pub(crate) max_distance: Option<f64>,
    /// The largest difference of a scale
    #[arg(long, value_name = "X", value_parser = degrees)]
    pub(crate) max_scale: Option<f64>,
    /// The largest difference of a morph weight
    #[arg(long, value_name = "X", value_parser = degrees)]
    pub(crate) max_weight: Option<f64>,
    /// Warnings fail too: clips, nodes and channels that only one file has
    #[arg(long)]
    pub(crate) strict: bool,
    /// Draw both poses where they differ most, the first file on the left
    #[cfg(feature = "render")]
    #[arg(long, value_name = "OUT.png", value_hint = ValueHint::FilePath)]
    pub(crate) picture: Option<PathBuf>,
    /// Width and height of each half of the picture in pixels
    #[cfg(feature = "render")]
    #[arg(long, value_name = "WxH", default_value = "512x512", requires = "picture", value_parser = size)]
    pub(crate) size: (u32, u32),
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) renderer: RendererFlag,
    #[command(flatten)]
    pub(crate) report: ReportFlag,
    /// Print nothing but what cannot be read; the exit code tells
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// How findings are told.
#[derive(Args, Debug)]
pub(crate) struct ReportFlag {
    /// How the report is written on standard output
    #[arg(long, value_name = "FORMAT", default_value = "text", value_parser = formats())]
    report: Format,
    /// Short for --report json
    #[arg(long, conflicts_with = "report")]
    json: bool,
}

impl ReportFlag {
    pub(crate) fn format(&self) -> Format {
        if self.json { Format::Json } else { self.report }
    }
}

#[derive(Args, Debug)]
pub(crate) struct Inspect {
    /// The file: keyframes, a path, .glb, .gltf; `-` reads standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Print it as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Reduce {
    /// The file: .glb, .gltf; `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// The file to write, of the same kind; `-` writes a .glb to standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// How far rotations may be off the input's playback, degrees
    #[arg(long, value_name = "DEG", value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// How far translations may be off, units; without it they lose nothing but rounding
    #[arg(long, value_name = "UNITS", value_parser = tolerance)]
    pub(crate) tolerance_distance: Option<f64>,
    /// How far scales may be off; without it they lose nothing but rounding
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub(crate) tolerance_scale: Option<f64>,
    /// How far weights of morph targets may be off; without it they lose nothing but
    /// rounding
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub(crate) tolerance_weight: Option<f64>,
    /// The largest turn from key to key, degrees: 18 for viewers that blend the four
    /// numbers
    #[arg(long, value_name = "DEG", value_parser = tolerance)]
    pub(crate) max_step: Option<f64>,
    /// Keep keys on the input's curve, which takes more of them
    #[arg(long)]
    pub(crate) on_curve: bool,
    /// Print the summary as JSON on standard output (on standard error where the .glb
    /// goes to standard output)
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Sample {
    /// Keyframes or a path (.dat); `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// The table to write; without it, and for `-`, standard output
    #[arg(short, long, value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// How rotations run from key to key
    #[arg(long, value_name = "NAME", default_value = "bessel", value_parser = scheme())]
    pub(crate) scheme: Scheme,
    /// What rotations do at their ends
    #[arg(long, default_value = "natural", value_parser = ends())]
    pub(crate) ends: Ends,
    #[command(flatten)]
    pub(crate) tangents: Tangents,
    /// Rows per second; the last time has one too
    #[arg(long, default_value = "25")]
    pub(crate) fps: Fps,
    /// Instead of a rate, N + 1 rows at equal steps of time
    #[arg(long, value_name = "N", conflicts_with = "fps", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) count: Option<u64>,
    /// How rotations are written; angles in degrees
    #[arg(long = "as", value_name = "NOTATION", default_value = "quaternion", value_parser = named(Notation::from_name, vec![
        ("quaternion", "w x y z"),
        ("axis-angle", "angle and axis"),
        ("euler", "roll, pitch, yaw: yaw first, then pitch, then roll"),
        ("matrix", "nine numbers, row by row"),
    ]))]
    pub(crate) notation: Notation,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Send what the input turns along this path
    #[arg(long, value_name = "PATH.dat", value_hint = ValueHint::FilePath)]
    pub(crate) path: Option<PathBuf>,
    /// Everything so many times as fast
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) time_scale: f64,
    /// Whose x, y and z the numbers are, of the input and of the table
    #[arg(long, value_parser = frame())]
    pub(crate) frame: Option<Frame>,
    #[command(flatten, next_help_heading = "Paths")]
    pub(crate) along: Along,
}

#[derive(Args, Debug)]
pub(crate) struct Compare {
    /// Rotations (.dat); `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,
    /// Which schemes, separated by commas; `all` for every one
    #[arg(long, value_name = "NAME[,NAME…]", default_value = "all", value_delimiter = ',', value_parser = schemes())]
    scheme: Vec<Schemes>,
    /// What the motion does at its ends
    #[arg(long, default_value = "natural", value_parser = ends())]
    pub(crate) ends: Ends,
    /// One box alone, counted from 1
    #[arg(long = "box", value_name = "B", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) only: Option<u64>,
    #[command(flatten)]
    pub(crate) order: OrderFlag,
    /// Print it as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl Compare {
    /// The schemes asked for, each once, in the order given.
    pub(crate) fn schemes(&self) -> Vec<Scheme> {
        each_once(&self.scheme)
    }
}

#[derive(Args, Debug)]
pub(crate) struct Example {
    /// Which kind of input
    #[arg(value_enum)]
    pub(crate) kind: Kind,
}

/// A kind of input.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum Kind {
    /// A chain of three boxes that swing
    Chain,
    /// One free body that tumbles, in the order x y z w
    Body,
    /// Key points of a flight that lands
    Flight,
    /// Control points of a Bézier path
    Bezier,
    /// A Bézier path for a camera that watches the flight
    Camera,
    /// Roll, pitch and yaw in degrees
    Euler,
}

/// What shapes the tangents of `kochanek-bartels`.
#[derive(Args, Debug)]
pub(crate) struct Tangents {
    /// kochanek-bartels: 1 stops at every key, -1 runs through it twice as fast
    #[arg(
        long,
        value_name = "T",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = one_at_most
    )]
    tension: f64,
    /// kochanek-bartels: a corner at every key, below 0 as straight lines make it, above 0
    /// the other way
    #[arg(
        long,
        value_name = "C",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = one_at_most
    )]
    continuity: f64,
    /// kochanek-bartels: 1 leaves a key as it came, -1 comes as it will leave
    #[arg(
        long,
        value_name = "B",
        default_value = "0",
        allow_negative_numbers = true,
        hide_default_value = true,
        value_parser = one_at_most
    )]
    bias: f64,
}

impl Tangents {
    pub(crate) fn tcb(&self) -> Tcb {
        Tcb { tension: self.tension, continuity: self.continuity, bias: self.bias }
    }
}

#[derive(Args, Debug)]
pub(crate) struct OrderFlag {
    /// The order of a quaternion's parts in the input; overrides its header
    #[arg(long = "quat-order", value_name = "ORDER", value_parser = named(Order::from_name, vec![("wxyz", ""), ("xyzw", "")]))]
    pub(crate) order: Option<Order>,
}

#[cfg(feature = "render")]
#[derive(Args, Debug)]
pub(crate) struct RendererFlag {
    /// What to draw with
    #[arg(long, default_value = "auto", value_parser = named(renderer_named, vec![
        ("auto", "wgpu where it finds an adapter, else in software"),
        ("wgpu", "a graphics adapter, hardware or software"),
        ("cpu", "the built-in software renderer, the same on every machine"),
    ]))]
    pub(crate) renderer: dat2glb::render::Renderer,
}

#[cfg(feature = "render")]
fn renderer_named(name: &str) -> Option<dat2glb::render::Renderer> {
    use dat2glb::render::Renderer;
    match name {
        "auto" => Some(Renderer::Auto),
        "wgpu" => Some(Renderer::Wgpu),
        "cpu" => Some(Renderer::Cpu),
        _ => None,
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

fn axis() -> ValueParser {
    named(Axis::from_name, Axis::ALL.iter().map(|axis| (axis.name(), "")).collect())
}

fn frame() -> ValueParser {
    named(
        Frame::from_name,
        vec![
            ("gltf", "x left, y up, z forward"),
            ("frd", "aerospace: x forward, y right, z down"),
            ("flu", "ROS: x forward, y left, z up"),
        ],
    )
}

fn finite(text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    value.filter(|value| value.is_finite()).ok_or_else(|| "expected a number".to_owned())
}

fn one_at_most(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value.abs() <= 1.0 { Ok(value) } else { Err("expected a number from -1 to 1".to_owned()) }
}

fn positive(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value > 0.0 { Ok(value) } else { Err("expected a number above 0".to_owned()) }
}

fn step(text: &str) -> Result<f64, String> {
    let value = positive(text)?;
    if value < 180.0 { Ok(value) } else { Err("expected degrees below 180".to_owned()) }
}

/// One word of `--scheme`: a scheme, or all of them.
#[derive(Clone, Debug)]
struct Schemes(&'static [Scheme]);

/// The schemes of several words, each once, in the order given.
fn each_once(asked: &[Schemes]) -> Vec<Scheme> {
    let mut schemes = Vec::new();
    for scheme in asked.iter().flat_map(|asked| asked.0.iter().copied()) {
        if !schemes.contains(&scheme) {
            schemes.push(scheme);
        }
    }
    schemes
}

/// A parser of names that the help text lists.
fn named<T: Clone + Send + Sync + 'static>(
    from_name: fn(&str) -> Option<T>,
    names: Vec<(&'static str, &'static str)>,
) -> ValueParser {
    let value = |(name, help): (&'static str, &'static str)| match help {
        "" => PossibleValue::new(name),
        help => PossibleValue::new(name).help(help),
    };
    let values = clap::builder::PossibleValuesParser::new(names.into_iter().map(value));
    ValueParser::new(values.map(move |name| from_name(&name).expect("only listed names get here")))
}

fn scheme_names() -> Vec<(&'static str, &'static str)> {
    Scheme::EVERY.iter().map(|scheme| (scheme.name(), scheme.summary())).collect()
}

fn scheme() -> ValueParser {
    named(Scheme::from_name, scheme_names())
}

fn schemes() -> ValueParser {
    let from_name = |name: &str| match name {
        "all" => Some(Schemes(Scheme::ALL)),
        name => Scheme::EVERY.iter().position(|s| s.name() == name).map(|i| Schemes(&Scheme::EVERY[i..=i])),
    };
    named(from_name, scheme_names().into_iter().chain([("all", "every one of these but step")]).collect())
}

fn ends() -> ValueParser {
    let values = [
        ("natural", "starts and stops without acceleration"),
        ("clamped", "starts and stops at rest"),
        ("repeat", "the end key counts twice"),
        ("closed", "the last key runs into the first"),
        ("periodic", "another word for closed"),
        ("hold", "each end segment rests at its first key, then jumps"),
        ("chord", "starts and stops at the mean velocity of its first and last step"),
    ];
    named(Ends::from_name, values.to_vec())
}

fn formats() -> ValueParser {
    let names = Format::ALL.iter().map(|format| (format.name(), format.summary()));
    named(Format::from_name, names.collect())
}

fn mapping(text: &str) -> Result<(String, String), String> {
    let names = text.split_once('=').filter(|(old, new)| !old.is_empty() && !new.is_empty());
    let (old, new) = names.ok_or_else(|| "expected two names, such as Hips=pelvis".to_owned())?;
    Ok((old.to_owned(), new.to_owned()))
}

fn degrees(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "expected degrees or units, a number".to_owned())?;
    if value >= 0.0 { Ok(value) } else { Err("expected degrees or units, 0 or more".to_owned()) }
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
    value.ok_or_else(|| "expected a number above 0, such as 0.01".to_owned())
}

/// `dat2glb IN.dat [OUT.glb] …` as `dat2glb convert IN.dat [-o OUT.glb] …`.
///
/// A first word that is no command counts as a file where it looks like one; anything
/// else is left for the parser to wonder about.
pub(crate) fn with_convert_spelled_out(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let is_command = |word: &OsStr| {
        let commands = [
            "convert",
            "check",
            "diff",
            "thumbnail",
            "inspect",
            "reduce",
            "sample",
            "compare",
            "plot",
            "example",
            "completions",
            "man",
            "help",
        ];
        commands.iter().any(|command| word == *command)
    };
    let looks_like_a_file = |word: &OsStr| {
        let path = Path::new(word);
        word == "-" || (path.extension().is_some() || path.components().count() > 1 || path.exists())
    };
    let first = &arguments[1];
    let is_flag = |word: &OsStr| word != "-" && word.as_encoded_bytes().starts_with(b"-");
    if is_command(first) || is_flag(first) || !looks_like_a_file(first) {
        return arguments;
    }
    let is_output = |word: &OsStr| {
        let ending = Path::new(word).extension().map(OsStr::to_ascii_lowercase);
        word == "-" || ending.is_some_and(|ending| ending == "glb" || ending == "gltf")
    };
    if arguments.get(2).is_some_and(|word| is_output(word)) {
        arguments.insert(2, "-o".into());
    }
    arguments.insert(1, "convert".into());
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn parsed(line: &str) -> Result<Cli, clap::Error> {
        Cli::try_parse_from(with_convert_spelled_out(line.split(' ').map(OsString::from).collect()))
    }

    fn convert(line: &str) -> Convert {
        match parsed(line).unwrap().command {
            Command::Convert(convert) => convert,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn definitions_are_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn convert_may_be_left_out() {
        let short = convert("dat2glb in.dat out.glb --fps 30");
        assert_eq!((short.inputs, short.output), (vec!["in.dat".into()], Some("out.glb".into())));
        assert_eq!(convert("dat2glb a.dat b.dat").inputs.len(), 2);
        assert_eq!(convert("dat2glb - -").output, Some("-".into()));
        assert!(parsed("dat2glb chek").is_err());
    }

    #[test]
    fn schemes_are_lists() {
        let schemes = |list: &str| convert(&format!("dat2glb a.dat --scheme {list}")).schemes();
        assert_eq!(schemes("squad,slerp,squad"), [Scheme::Squad, Scheme::Slerp]);
        assert_eq!(schemes("all"), Scheme::ALL);
        assert_eq!(schemes("bessel,all")[0], Scheme::Bessel);
        assert_eq!(convert("dat2glb a.dat --ends periodic").ends, Ends::Closed);
        let tcb = convert("dat2glb a.dat --tension -1 --bias 0.5").tangents.tcb();
        assert_eq!(tcb, Tcb { tension: -1.0, continuity: 0.0, bias: 0.5 });
        assert!(parsed("dat2glb a.dat --continuity 1.1").is_err());
        assert!(parsed("dat2glb a.dat --scheme spline").is_err());
    }
}

//! Which keys an output gets, and what numbers and players make of them.

use super::words::{named, positive, step};
use clap::Args;
use clap::builder::ValueParser;
use dat2glb::convert::{Fewest, Sampling};
use dat2glb::moves::Copies;
use dat2glb::sample::{Encoding, Fps, Writing};
use dat2glb::write::Interpolation;

#[derive(Args, Debug)]
pub(crate) struct Keys {
    /// Samples per second: 60, 23.976, 30000/1001 [default: 60]
    #[arg(long)]
    fps: Option<Fps>,
    /// Sample on an even grid only, which may miss the input's keyframes
    #[arg(long)]
    no_key_times: bool,
    /// Use the fewest keys that keep playback within DEG of the curve (instead of --fps)
    #[arg(long, value_name = "DEG", conflicts_with_all = ["fps", "no_key_times", "repeat"], allow_negative_numbers = true, value_parser = positive)]
    tolerance: Option<f64>,
    /// With --tolerance: max position error, units, along a path and at the corners of a
    /// chain [default: tolerance × extent of the path]
    #[arg(long, value_name = "UNITS", allow_negative_numbers = true, value_parser = positive)]
    tolerance_distance: Option<f64>,
    /// With --tolerance: max angle between neighboring keys; up to 18 adds at most 0.01° in
    /// viewers that use nlerp (Blender) [default: 18; for cubicspline 90]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = step)]
    max_step: Option<f64>,
    /// With --tolerance: keep keyframes on the curve (takes about 1.4 times as many)
    #[arg(long, requires = "tolerance")]
    on_curve: bool,
    /// glTF interpolation of the animation samplers
    ///
    /// LINEAR is the safe default: every viewer plays it correctly. `cubicspline` takes far
    /// fewer keys, chosen by --tolerance (0.01 without it), but Blender's importer ignores
    /// the tangents and fits its own curves. `step` holds each sample until the next.
    #[arg(long, value_name = "NAME", default_value = "linear", value_parser = interpolations())]
    interpolation: Interpolation,
    /// Store rotations as normalized 16-bit integers: half the size, error up to 0.004°
    #[arg(long)]
    quantize: bool,
    /// Skip computing the playback error bound
    #[arg(long, conflicts_with = "tolerance")]
    no_bound: bool,
}

impl Keys {
    /// When samples are taken.
    pub(crate) fn sampling(&self) -> Sampling {
        let rate = Sampling::Rate { fps: self.fps.unwrap_or_default(), key_times: !self.no_key_times };
        self.fewest().map_or(rate, Sampling::Fewest)
    }

    fn fewest(&self) -> Option<Fewest> {
        let cubic = self.interpolation == Interpolation::CubicSpline;
        let tolerance = self.tolerance.or(cubic.then_some(Fewest::CUBIC_TOLERANCE))?;
        let usual = if cubic { Fewest::MAX_CUBIC_STEP } else { Fewest::MAX_STEP };
        let (distance, max_step) = (self.tolerance_distance, self.max_step.unwrap_or(usual));
        Some(Fewest { tolerance, distance, max_step, on_curve: self.on_curve || cubic, cubic })
    }

    /// How rotations become numbers.
    pub(crate) fn writing(&self) -> Writing {
        let encoding = if self.quantize { Encoding::Normalized16 } else { Encoding::Float };
        Writing { encoding, bound: !self.no_bound, hold: self.interpolation == Interpolation::Step }
    }

    /// Why options do not go together that each alone are fine; `copies`: of the object.
    pub(crate) fn conflict(&self, copies: Copies) -> Option<String> {
        let by_need = "--tolerance decides where its keys go";
        let excluded: &[(&str, bool, &str)] = match self.interpolation {
            Interpolation::CubicSpline => &[
                ("--fps", self.fps.is_some(), by_need),
                ("--no-key-times", self.no_key_times, by_need),
                ("--no-bound", self.no_bound, "its keys are chosen by the bound"),
                ("--repeat", copies.count > 1, "copies need samples at a fixed rate"),
                (
                    "--quantize",
                    self.quantize,
                    "tangents exceed the 16-bit range of -1 to 1, and rounding costs up to 0.0033°",
                ),
            ],
            Interpolation::Step => &[
                (
                    "--tolerance",
                    self.tolerance.is_some(),
                    "a held value is off by all motion up to the next sample; use --fps",
                ),
                (
                    "--repeat",
                    copies.wrap && copies.count > 1,
                    "looping copies move back to their start, which is not a held pose; add --no-wrap",
                ),
            ],
            Interpolation::Linear => &[],
        };
        let said = |(flag, _, why): &(&str, bool, &str)| {
            format!("--interpolation {} cannot be used with {flag}: {why}", name(self.interpolation))
        };
        let missing = || {
            let given = [
                ("--tolerance-distance", self.tolerance_distance.is_some()),
                ("--max-step", self.max_step.is_some()),
            ];
            let (flag, _) = given.into_iter().find(|(_, given)| *given && self.fewest().is_none())?;
            Some(format!("{flag} needs --tolerance, the max rotation error"))
        };
        excluded.iter().find(|(_, given, _)| *given).map(said).or_else(missing)
    }
}

const ALL: [Interpolation; 3] = [Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Step];

fn name(interpolation: Interpolation) -> &'static str {
    match interpolation {
        Interpolation::Linear => "linear",
        Interpolation::Step => "step",
        Interpolation::CubicSpline => "cubicspline",
    }
}

fn interpolations() -> ValueParser {
    named(
        |word| ALL.into_iter().find(|&interpolation| name(interpolation) == word),
        vec![
            ("linear", "slerp: shortest arc, constant speed"),
            ("cubicspline", "cubic Hermite spline with tangents"),
            ("step", "holds each key until the next"),
        ],
    )
}

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
    /// Leave the key times out: an even grid of samples, which may miss the keys
    #[arg(long)]
    no_key_times: bool,
    /// Instead of a rate, as few keys as keep playback within so many degrees of the curve
    #[arg(long, value_name = "DEG", conflicts_with_all = ["fps", "no_key_times", "repeat"], allow_negative_numbers = true, value_parser = positive)]
    tolerance: Option<f64>,
    /// With --tolerance: how far, units, playback may be from the path, and a corner of a
    /// chain from where it should be; without it what the angle makes of the path's extent
    #[arg(long, value_name = "UNITS", allow_negative_numbers = true, value_parser = positive)]
    tolerance_distance: Option<f64>,
    /// With --tolerance: the largest turn from key to key; up to 18 keeps viewers that blend
    /// the four numbers within 0.01° [default: 18; for cubicspline 90]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = step)]
    max_step: Option<f64>,
    /// With --tolerance: keys lie on the curve, which takes about 1.4 times as many
    #[arg(long, requires = "tolerance")]
    on_curve: bool,
    /// What players do between keys, in glTF's words
    ///
    /// LINEAR is the safe default: every viewer plays it right. `cubicspline` takes far
    /// fewer keys, chosen by --tolerance (0.01 without it), but Blender's importer ignores
    /// the tangents and draws curves of its own. `step` holds each sample until the next.
    #[arg(long, value_name = "NAME", default_value = "linear", value_parser = interpolations())]
    interpolation: Interpolation,
    /// Write rotations as whole numbers of 16 bits: half the bytes, and up to 0.004° off
    #[arg(long)]
    quantize: bool,
    /// Do not work out how far playback is from the curve
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
        let by_need = "its keys are where --tolerance needs them";
        let excluded: &[(&str, bool, &str)] = match self.interpolation {
            Interpolation::CubicSpline => &[
                ("--fps", self.fps.is_some(), by_need),
                ("--no-key-times", self.no_key_times, by_need),
                ("--no-bound", self.no_bound, "its keys are chosen by the bound"),
                ("--repeat", copies.count > 1, "copies share samples that are taken at a rate"),
                (
                    "--quantize",
                    self.quantize,
                    "16-bit numbers reach from -1 to 1, where tangents do not fit, and cost up to 0.0033°",
                ),
            ],
            Interpolation::Step => &[
                (
                    "--tolerance",
                    self.tolerance.is_some(),
                    "what is held is off by all that moves until the next sample; say --fps",
                ),
                (
                    "--repeat",
                    copies.wrap && copies.count > 1,
                    "copies that wrap run back to their start, which is no held pose; add --no-wrap",
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
            Some(format!("{flag} needs --tolerance, the angle that playback may be off"))
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
            ("linear", "the shortest way, at constant speed"),
            ("cubicspline", "Hermite's cubic, with tangents"),
            ("step", "each lasts until the next"),
        ],
    )
}

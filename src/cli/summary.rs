//! What is said of a conversion when it is done.

use super::exit::{Failure, say, shown};
use super::files::is_standard;
use dat2glb::clip::Warning;
use dat2glb::convert::ClipFacts;
use dat2glb::moves::Ground;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;
use std::time::Duration;

/// Blender plays at this rate unless told otherwise, from frame 1.
const BLENDER_FPS: f64 = 24.0;

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Summary<'a> {
    schema: u32,
    input: &'a str,
    output: String,
    keys: usize,
    boxes: usize,
    /// Points of the path.
    points: usize,
    seconds: f64,
    /// How long the chain is, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    chain_length: Option<f64>,
    #[serde(skip)]
    movers: usize,
    /// Rotations and places in all clips together, copies included.
    samples: u64,
    bytes: u64,
    elapsed_seconds: f64,
    blender_end_frame: u64,
    clips: &'a [ClipFacts],
    /// What ends before the clip does, and holds its last value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    holds: Vec<Held>,
    warnings: &'a [Warning],
}

#[derive(Serialize)]
struct Held {
    what: &'static str,
    seconds: f64,
}

impl<'a> Summary<'a> {
    pub(super) fn new(
        input: &'a str,
        output: &Path,
        ground: &Ground,
        clips: &'a [ClipFacts],
        bytes: u64,
        warnings: &'a [Warning],
        elapsed: Duration,
    ) -> Summary<'a> {
        let inputs = ground.inputs();
        let keyframes = inputs.keyframes.as_ref().map(|keyframes| &keyframes.clip);
        let points = inputs.path.as_ref().map_or(0, |path| path.points.len());
        let boxes = keyframes.map_or(0, |clip| clip.tracks.len());
        let movers = clips.first().map_or(0, |clip| clip.movers);
        Summary {
            schema: 1,
            input,
            output: output.display().to_string(),
            keys: keyframes.map_or(0, |clip| clip.times.len()),
            boxes,
            points,
            seconds: ground.duration(),
            chain_length: ground.chain_length(),
            movers,
            samples: clips.iter().map(|clip| clip.samples_in_all).sum::<u64>() * ground.stream().count as u64,
            bytes,
            elapsed_seconds: elapsed.as_secs_f64(),
            blender_end_frame: (ground.duration() * BLENDER_FPS).ceil() as u64 + 1,
            clips,
            holds: ground.holds().into_iter().map(|(what, seconds)| Held { what, seconds }).collect(),
            warnings,
        }
    }

    /// Prints warnings and summary; `--json` prints JSON instead, on standard output
    /// unless the .glb goes there.
    pub(super) fn print(&self, json: bool, quiet: bool) -> Result<(), Failure> {
        if json {
            let line = serde_json::to_string(self).expect("plain data becomes JSON");
            if is_standard(Path::new(&self.output)) {
                say(&line);
            } else {
                shown(writeln!(io::stdout(), "{line}"))?;
            }
        } else if !quiet {
            for Warning { code, message } in self.warnings {
                say(&format!("warning: {}: {message} [{code}]", self.input));
            }
            say(&self.line());
            for Held { what, seconds } in &self.holds {
                say(&format!("{what} end at {} s and hold their last value", rounded(*seconds)));
            }
        }
        Ok(())
    }

    fn line(&self) -> String {
        let count = |n: usize, one: &str, many: &str| format!("{n} {}", if n == 1 { one } else { many });
        let uneven = self.clips.iter().any(|clip| clip.samples_in_all != clip.samples * self.movers as u64);
        let clips = match self.clips {
            [clip] if uneven => format!("{} samples in total", clip.samples_in_all),
            [clip] => format!("{} samples each", clip.samples),
            clips => format!("{} clips, {} samples in total", clips.len(), self.samples),
        };
        let worst = |figure: fn(&ClipFacts) -> Option<f64>| -> Option<f64> {
            let all: Option<Vec<f64>> = self.clips.iter().map(figure).collect();
            all.map(|all| all.into_iter().fold(0.0, f64::max))
        };
        let say = |figure: Option<f64>, what: fn(f64) -> String| figure.map_or(String::new(), what);
        let deviation =
            say(worst(|clip| clip.deviation_degrees), |x| format!(", max rotation error {}°", bound(x)));
        let measured =
            say(worst(|clip| clip.measured_degrees), |x| format!(", measured rotation error {}°", bound(x)));
        let distance =
            say(worst(|clip| clip.deviation_units), |x| format!(", max path error {} units", bound(x)));
        let moved =
            say(worst(|clip| clip.keys_moved_degrees), |x| format!(", keys moved by up to {}°", bound(x)));
        let displacement =
            say(worst(|clip| clip.displacement_units), |x| format!(", max position error {}", bound(x)));
        let displacement = match self.chain_length {
            Some(length) if !displacement.is_empty() => {
                let share = worst(|clip| clip.displacement_units).unwrap_or_default() / length;
                format!("{displacement} ({} % of the chain)", bound(100.0 * share))
            }
            _ => displacement,
        };
        let mut parts = Vec::new();
        if self.boxes > 0 {
            parts.extend([count(self.keys, "key", "keys"), count(self.boxes, "box", "boxes")]);
        }
        if self.points > 0 {
            parts.push(count(self.points, "point", "points"));
        }
        format!(
            "{}: {}, {} s, {clips}, {}{deviation}{measured}{distance}{moved}{displacement}, {:.3} s\n\
             Blender: set the scene's end to frame {} at {BLENDER_FPS} fps",
            self.output,
            parts.join(", "),
            rounded(self.seconds),
            size(self.bytes),
            self.elapsed_seconds,
            self.blender_end_frame
        )
    }
}

/// Seconds for people.
fn rounded(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}

/// A bound for people: two digits, rounded up, so that it stays one.
fn bound(x: f64) -> String {
    if !x.is_finite() || x <= 0.0 {
        return x.to_string();
    }
    let scale = libm::pow(10.0, 1.0 - libm::log10(x).floor());
    // What has two digits already may be a little more once it is scaled.
    let units = (x * scale - 1e-9).ceil();
    let texts = [units, units + 1.0].map(|units| two_digits(units / scale));
    texts.into_iter().find(|text| text.parse().is_ok_and(|said: f64| said >= x)).unwrap_or(x.to_string())
}

/// A number of two digits, in the shorter notation.
fn two_digits(x: f64) -> String {
    match 1 - libm::log10(x).floor() as i32 {
        decimals @ 0..=5 => format!("{x:.*}", decimals as usize),
        -4..0 => x.to_string(),
        _ => format!("{x:.1e}"),
    }
}

/// Bytes for people.
pub(super) fn size(bytes: u64) -> String {
    match bytes as f64 {
        b if b < 1e3 => format!("{bytes} B"),
        b if b < 1e6 => format!("{:.1} kB", b / 1e3),
        b if b < 1e9 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.2} GB", b / 1e9),
    }
}

/// A failed input among others, for those who read JSON.
pub(super) fn print_failure(input: &Path, failure: &Failure) -> Result<(), Failure> {
    let line = serde_json::json!({
        "schema": 1,
        "input": input.display().to_string(),
        "error": failure.message,
        "exitCode": failure.exit as u8,
    });
    shown(writeln!(io::stdout(), "{line}"))
}

#[cfg(test)]
mod tests {
    use super::bound;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_bound_that_is_said_is_no_smaller(digits in 1.0..10.0f64, exponent in -12..9i32, nudge in -2..3i64) {
            let exact = (digits * 10.0).round() / 10.0 * 10f64.powi(exponent);
            for x in [digits * 10f64.powi(exponent), f64::from_bits((exact.to_bits() as i64 + nudge) as u64)] {
                let said: f64 = bound(x).parse().unwrap();
                prop_assert!(x <= said && said <= x * 1.1001, "{x:e} is said to be {said:e}");
            }
        }
    }

    #[test]
    fn bounds_are_two_digits_and_rounded_up() {
        let cases = [
            (0.0, "0"),
            (0.0089645, "0.0090"),
            (0.0016775, "0.0017"),
            (0.0999, "0.10"),
            (0.1, "0.10"),
            (1.01, "1.1"),
            (12.3, "13"),
            (180.0, "180"),
            (4.21e-6, "4.3e-6"),
            (1.23e-9, "1.3e-9"),
        ];
        for (x, text) in cases {
            assert_eq!(bound(x), text);
        }
    }
}

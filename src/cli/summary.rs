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
    /// Poses in all clips together: of each box, and of what goes along the path, copies
    /// included.
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
        let moving = (boxes + usize::from(points > 0)) * ground.stream().count;
        Summary {
            schema: 1,
            input,
            output: output.display().to_string(),
            keys: keyframes.map_or(0, |clip| clip.times.len()),
            boxes,
            points,
            seconds: ground.duration(),
            samples: clips.iter().map(|c| c.samples).sum::<u64>() * moving as u64,
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
        let clips = match self.clips {
            [clip] => format!("{} samples each", clip.samples),
            clips => format!("{} clips, {} samples in all", clips.len(), self.samples),
        };
        let deviations: Option<Vec<f64>> = self.clips.iter().map(|clip| clip.deviation_degrees).collect();
        let deviation = deviations.map_or(String::new(), |all| {
            format!(", within {}° of the curve", all.into_iter().fold(0.0, f64::max))
        });
        let strayed: Option<Vec<f64>> = self.clips.iter().map(|clip| clip.deviation_units).collect();
        let distance = strayed.map_or(String::new(), |all| {
            format!(", within {} units of the path", all.into_iter().fold(0.0, f64::max))
        });
        let mut parts = Vec::new();
        if self.boxes > 0 {
            parts.extend([count(self.keys, "key", "keys"), count(self.boxes, "box", "boxes")]);
        }
        if self.points > 0 {
            parts.push(count(self.points, "point", "points"));
        }
        format!(
            "{}: {}, {} s, {clips}, {}{deviation}{distance}, {:.3} s\n\
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

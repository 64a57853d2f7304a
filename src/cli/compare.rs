//! `dat2glb compare`: schemes side by side.

use super::args::Compare;
use super::exit::{Exit, Failure, say, shown};
use super::files::{self, display_name};
use dat2glb::clip::{Body, Clip, Warning};
use dat2glb::compare::{self, BoxFigures, Figures, KeysNeeded, MAX_STEP, Method, TOLERANCES};
use dat2glb::moves::rotation_keys;
use dat2glb::read::{Input, Keyframes};
use std::fmt::Write as _;
use std::io::{self, Write};

pub(super) fn run(options: &Compare) -> Result<Exit, Failure> {
    let name = display_name(&options.input);
    let Keyframes { clip, warnings, .. } = keyframes(options, &name)?;
    let only = options.only.map(|index| chosen(index, &clip, &name)).transpose()?;
    let boxes = compare::clip(&clip, &options.schemes(), options.ends, only)
        .map_err(|error| Failure::refused(format!("{name}: {error}")))?;
    let file = options.input.display().to_string();
    let report =
        Report { name, file, ends: options.ends.name(), clip: &clip, boxes: &boxes, warnings: &warnings };
    files::unchanged()?;
    shown(io::stdout().write_all(if options.json { report.json() } else { report.text() }.as_bytes()))?;
    if !options.json {
        let said = |Warning { code, message }: &Warning| {
            say(&format!("warning: {}: {message} [{code}]", report.name));
        };
        warnings.iter().for_each(said);
    }
    Ok(Exit::Done)
}

/// The box of a number, from 0.
fn chosen(index: u64, clip: &Clip, name: &str) -> Result<usize, Failure> {
    let last = clip.tracks.len();
    match usize::try_from(index) {
        Ok(index) if index <= last => Ok(index - 1),
        _ => Err(Failure::usage(format!("{name}: expected a box from 1 to {last}, found {index}"))),
    }
}

/// The rotations of an input of any kind that has some.
fn keyframes(options: &Compare, name: &str) -> Result<Keyframes, Failure> {
    match files::input(&options.input, options.order.order)? {
        Input::Keyframes(keyframes) => Ok(keyframes),
        Input::Rotations(file) => Ok(rotation_keys(file, None)),
        _ => Err(Failure::refused(format!("{name}: expected rotations to compare schemes by, found a path"))),
    }
}

struct Report<'a> {
    /// In messages.
    name: String,
    /// As it was given.
    file: String,
    ends: &'static str,
    clip: &'a Clip,
    boxes: &'a [BoxFigures],
    warnings: &'a [Warning],
}

impl Report<'_> {
    fn json(&self) -> String {
        let value = serde_json::json!({
            "schema": 1,
            "file": self.file,
            "ends": self.ends,
            "keys": self.clip.times.len(),
            "seconds": self.clip.duration(),
            "maxStep": MAX_STEP,
            "boxes": self.boxes,
            "warnings": self.warnings,
        });
        format!("{value:#}\n")
    }

    fn text(&self) -> String {
        let (keys, seconds) = (self.clip.times.len(), short(self.clip.duration()));
        let mut text = format!("{}: {keys} keys, {seconds} s, ends {}\n", self.name, self.ends);
        for figures in self.boxes {
            let title = match self.clip.body {
                Body::Chain { .. } => format!("box{}", figures.index),
                Body::Free => "body".to_owned(),
            };
            text.push('\n');
            text.push_str(&block(&title, &figures.methods));
            for method in &figures.methods {
                text.push_str(&jump_note(method));
            }
        }
        text
    }
}

/// Columns under one heading, a line of headings below it, and a line a scheme.
struct Group {
    heading: &'static str,
    columns: Vec<Vec<String>>,
}

/// The table of one box.
fn block(title: &str, methods: &[Method]) -> String {
    let numbers: Vec<Figures> = methods.iter().map(|method| rounded(&method.figures)).collect();
    let column = |name: &str, of: &dyn Fn(&Figures) -> f64| {
        std::iter::once(name.to_owned()).chain(numbers.iter().map(|figures| short(of(figures)))).collect()
    };
    let counted = |i: usize, of: &dyn Fn(&KeysNeeded) -> Option<u64>| {
        let cell = |figures: &Figures| count(of(&figures.keys[i]), figures.keys[i].counted);
        std::iter::once(format!("{}°", TOLERANCES[i])).chain(numbers.iter().map(cell)).collect()
    };
    let group = |heading, columns| Group { heading, columns };
    let keys = |i: usize| counted(i, &|needed| needed.keys.map(|n| n as u64));
    let groups = [
        group("speed °/s", vec![column("max", &|f| f.speed.largest.value), column("rms", &|f| f.speed.rms)]),
        group(
            "accel. °/s²",
            vec![column("max", &|f| f.acceleration.largest.value), column("rms", &|f| f.acceleration.rms)],
        ),
        group(
            "jump at key",
            vec![column("°/s", &|f| f.jumps.velocity.value), column("°/s²", &|f| f.jumps.acceleration.value)],
        ),
        group("over-", vec![column("shoot°", &|f| f.overshoot.value)]),
        group("stray", vec![column("°", &|f| f.stray.value)]),
        group("keys for", (0..TOLERANCES.len()).map(keys).collect()),
        group("bytes", vec![counted(1, &|needed| needed.bytes)]),
    ];
    let names = methods.iter().map(|method| method.scheme.unwrap_or("control rotations"));
    let names: Vec<&str> = std::iter::once("scheme").chain(names).collect();
    laid_out(title, &names, &groups)
}

/// Lines of equal columns: names to the left, numbers to the right.
fn laid_out(title: &str, names: &[&str], groups: &[Group]) -> String {
    let length = |text: &str| text.chars().count();
    let first = names.iter().copied().chain([title]).map(length).max().unwrap_or(0);
    let mut lines: Vec<String> = [title].iter().chain(names).map(|name| format!("{name:<first$}")).collect();
    for Group { heading, columns } in groups {
        let mut widths: Vec<usize> =
            columns.iter().map(|cells| cells.iter().map(|cell| length(cell)).max().unwrap_or(0)).collect();
        let spaces = columns.len() - 1;
        let missing = length(heading).saturating_sub(widths.iter().sum::<usize>() + spaces);
        widths[0] += missing;
        let whole = widths.iter().sum::<usize>() + spaces;
        let _ = write!(lines[0], "  {heading:>whole$}");
        for (row, line) in lines[1..].iter_mut().enumerate() {
            line.push(' ');
            for (cells, width) in columns.iter().zip(&widths) {
                let _ = write!(line, " {:>width$}", cells[row]);
            }
        }
    }
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// A count, or about how many, to three digits.
fn count(count: Option<u64>, counted: bool) -> String {
    match count {
        None => "–".to_owned(),
        Some(count) if counted => count.to_string(),
        Some(count) if count >= 10_000_000 => format!("~{:.1e}", count as f64),
        Some(count) => {
            let unit = 10u64.pow(count.max(1).ilog10().saturating_sub(2));
            format!("~{}", (count + unit / 2) / unit * unit)
        }
    }
}

/// What rounding leaves, relative to what it was left of.
const ROUNDING: f64 = 1e-9;

/// The figures with nought for what only rounding has left.
fn rounded(figures: &Figures) -> Figures {
    let mut figures = figures.clone();
    let speed = figures.speed.largest.value;
    // A steady turn has accelerations too, which cancel.
    let acceleration = figures.acceleration.largest.value + speed * speed.to_radians();
    let clear = |value: &mut f64, of: f64| {
        if *value < ROUNDING * of {
            *value = 0.0;
        }
    };
    clear(&mut figures.speed.rms, speed);
    clear(&mut figures.jumps.velocity.value, speed);
    clear(&mut figures.acceleration.largest.value, acceleration);
    clear(&mut figures.acceleration.rms, acceleration);
    clear(&mut figures.jumps.acceleration.value, acceleration);
    clear(&mut figures.overshoot.value, 1.0);
    clear(&mut figures.stray.value, 1.0);
    figures
}

/// A number to two digits or three, in five or six characters where it can be.
fn short(x: f64) -> String {
    match x {
        x if !x.is_finite() => "–".to_owned(),
        0.0 => "0".to_owned(),
        x if x >= 99999.5 => format!("{x:.1e}"),
        x if x >= 99.95 => format!("{x:.0}"),
        x if x >= 9.995 => format!("{x:.1}"),
        x if x >= 0.9995 => format!("{x:.2}"),
        x if x >= 0.0095 => format!("{x:.3}"),
        x => format!("{x:.1e}"),
    }
}

/// Jumps of the rotation itself below this are rounding, degrees.
const NO_JUMP: f64 = 1e-6;

/// A line about a rotation that jumps, for there is nothing in the table about it.
fn jump_note(Method { scheme, figures }: &Method) -> String {
    let jump = figures.jumps.rotation;
    if jump.value < NO_JUMP {
        return String::new();
    }
    let (name, by, at) = (scheme.unwrap_or("control rotations"), short(jump.value), short(jump.time));
    format!("{name} jumps by {by}° at {at} s, which no other figure counts\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_near() {
        for exponent in -40..40 {
            for digits in [1.0, 1.5, 3.333333, 9.949999, 9.96, 9.996] {
                let x = digits * 10f64.powi(exponent);
                let text = short(x);
                let most = if x >= 0.0095 { 5 } else { 6 };
                assert!(text.len() <= most + usize::from(exponent.abs() > 8), "{x}: {text}");
                let back: f64 = text.parse().unwrap();
                // Below 0.0095 and from 99999.5 on one and two digits are left.
                let limit = if x < 0.0095 {
                    0.5
                } else if x < 99999.5 {
                    0.053
                } else {
                    0.05
                };
                assert!((back - x).abs() <= limit * x, "{x}: {text}");
            }
        }
        assert_eq!([0.0, f64::NAN, 12.34, 1234.5, 0.1234].map(short), ["0", "–", "12.3", "1234", "0.123"]);
    }
}

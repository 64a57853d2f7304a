//! A file of rotations of one object: Euler angles, or control rotations.

use super::blocks::Blocks;
use super::kind::Kind;
use super::table::{self, Form, Keys, Opening, Quaternion, Table};
use super::{Error, Order};
use crate::clip::{Lines, Warning};
use crate::math::Quat;
use crate::orient::Frame;
use std::io::Read;

/// What a file of rotations holds, as it stands there: in the file's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationsFile {
    /// The rotations, and what they are.
    pub rotations: Rotations,
    /// How long they last, seconds, if the header says so. Never together with `times`.
    pub duration: Option<f64>,
    /// Times of the keys, of control rotations only where segments begin and end; seconds
    /// since the first, strictly increasing; if the rows carry times.
    pub times: Option<Vec<f64>>,
    /// Time of the first row as the file gives it, seconds; 0 without times.
    pub start: f64,
    /// Whose x, y and z the numbers are, if the header says so; see [`Rotations::usual_frame`].
    pub frame: Option<Frame>,
    /// Where the rotations stand in the file.
    pub lines: Lines,
    /// What a user should know.
    pub warnings: Vec<Warning>,
    /// How far from 1 the length of the worst quaternion was.
    pub largest_norm_error: f64,
    /// BLAKE3 hash of the file's bytes, in hexadecimal.
    pub hash: String,
    /// Bytes read.
    pub bytes: u64,
}

/// Rotations of one object.
#[derive(Clone, Debug, PartialEq)]
pub enum Rotations {
    /// Keys to pass through, two or more: roll, pitch and yaw in degrees.
    Euler(Vec<[f64; 3]>),
    /// Control rotations of cubic segments, 3n + 1 of them: roll, pitch and yaw in degrees.
    EulerBezier(Vec<[f64; 3]>),
    /// Control rotations of cubic segments, 3n + 1 of them: unit quaternions, signs as in
    /// the file.
    QuatBezier(Vec<Quat>),
}

impl Rotations {
    /// As headers spell it.
    pub fn name(&self) -> &'static str {
        match self {
            Rotations::Euler(_) => Kind::Euler.name(),
            Rotations::EulerBezier(_) => Kind::EulerBezier.name(),
            Rotations::QuatBezier(_) => Kind::QuatBezier.name(),
        }
    }

    /// Number of rotations.
    #[expect(clippy::len_without_is_empty, reason = "there are always two or more")]
    pub fn len(&self) -> usize {
        match self {
            Rotations::Euler(angles) | Rotations::EulerBezier(angles) => angles.len(),
            Rotations::QuatBezier(rotations) => rotations.len(),
        }
    }

    /// The frame of a file that names none: aerospace's for angles, glTF's for quaternions.
    pub fn usual_frame(&self) -> Frame {
        match self {
            Rotations::Euler(_) | Rotations::EulerBezier(_) => Frame::Frd,
            Rotations::QuatBezier(_) => Frame::Gltf,
        }
    }
}

/// What rows of a kind look like.
fn form(kind: Kind, order: Order) -> Form {
    let quaternions = kind == Kind::QuatBezier;
    let keys = kind == Kind::Euler;
    Form {
        columns: if quaternions { "" } else { "roll pitch yaw" },
        limit: f64::MAX,
        quaternion: if quaternions { Quaternion::Always } else { Quaternion::Never },
        order,
        keys: if keys { Keys::Every } else { Keys::Cubic },
        nouns: if keys { ["key", "keys"] } else { ["control rotation", "control rotations"] },
    }
}

/// Reads the rotations after the header.
pub(super) fn read<R: Read>(
    source_name: &str,
    opening: Opening,
    blocks: &mut Blocks<R>,
    order: Option<Order>,
) -> Result<RotationsFile, Error> {
    let kind = opening.header.kind;
    let order = order.or(opening.header.order).unwrap_or_default();
    let Table { header, values, quaternions, start, times, lines, oddities, .. } =
        table::read(source_name, opening, blocks, form(kind, order))?;
    let mut warnings = oddities.warnings(order);
    warnings.extend(angle_jumps(&values, &lines));
    let rotations = match kind {
        Kind::Euler => Rotations::Euler(values),
        Kind::EulerBezier => Rotations::EulerBezier(values),
        _ => Rotations::QuatBezier(quaternions.into_iter().flatten().collect()),
    };
    Ok(RotationsFile {
        rotations,
        duration: header.duration.map(|(_, seconds)| seconds),
        times,
        start,
        frame: header.frame,
        lines,
        warnings,
        largest_norm_error: oddities.largest_norm_error(),
        hash: blocks.hasher.finalize().to_hex().to_string(),
        bytes: blocks.bytes,
    })
}

/// A warning where an angle changes by more than half a turn from row to row.
fn angle_jumps(angles: &[[f64; 3]], lines: &Lines) -> Option<Warning> {
    let jump = |row: usize, column: usize| (angles[row][column] - angles[row - 1][column]).abs();
    let places = (1..angles.len()).flat_map(|row| (0..3).map(move |column| (row, column)));
    let mut jumps = places.filter(|&(row, column)| jump(row, column) > 180.0);
    let (row, column) = jumps.next()?;
    let (count, first) = match jumps.count() {
        0 => ("an angle jumps".to_owned(), ""),
        more => (format!("{} angles jump", more + 1), "the first: "),
    };
    let name = ["roll", "pitch", "yaw"][column];
    let (line, from, to) = (lines.of(row), shown(angles[row - 1][column]), shown(angles[row][column]));
    Some(Warning::new(
        "ANGLE_JUMP",
        format!(
            "{count} by more than 180° from row to row ({first}{name} in line {line}: from {from} to {to}); the \
             rotation turns the shorter way, for a longer one add rows between"
        ),
    ))
}

/// An angle as one would write it.
fn shown(angle: f64) -> String {
    if angle.abs() < 1e9 { format!("{angle}") } else { format!("{angle:e}") }
}

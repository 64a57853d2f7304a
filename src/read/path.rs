//! A file of points: a curve through space.

use super::blocks::Blocks;
use super::table::{self, Form, Keys, Opening, Quaternion, Table};
use super::{Error, Order};
use crate::clip::{Lines, Warning};
use crate::math::Quat;
use crate::orient::Frame;
use crate::path::Kind as PathKind;
use std::io::Read;

/// What a path file holds, as it stands there: in the file's frame, not yet a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct PathFile {
    /// What the points are.
    pub kind: PathKind,
    /// How long the path lasts, seconds, if the header says so. Never together with `times`.
    pub duration: Option<f64>,
    /// Every point, in order; as many as `kind` needs.
    pub points: Vec<[f64; 3]>,
    /// Times of the key points (see [`PathFile::keys`]), seconds since the first,
    /// strictly increasing; if the rows carry times.
    pub times: Option<Vec<f64>>,
    /// Time of the first point as the file gives it, seconds; 0 without times.
    pub start: f64,
    /// For each key point its orientation, if the file gives one: of unit length, the sign
    /// as in the file.
    pub orientations: Vec<Option<Quat>>,
    /// Whose x, y and z the numbers are, if the header says so.
    pub frame: Option<Frame>,
    /// Where the points stand in the file.
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

/// Which points the curve passes through as its keys: every one, but of a Bézier curve
/// only those where segments begin and end.
fn keys(kind: PathKind) -> Keys {
    match kind {
        PathKind::Bezier => Keys::Cubic,
        PathKind::BezierDegree(n) => Keys::Degree(n),
        _ => Keys::Every,
    }
}

impl PathFile {
    /// Which of the points are key points, by index; two at least.
    pub fn keys(&self) -> impl Iterator<Item = usize> {
        let kind = self.kind;
        (0..self.points.len()).filter(move |&i| keys(kind).contains(i))
    }
}

/// How far from the origin a point may be along an axis. glTF holds float32, which ends
/// at 3.4e38, and squares and cubes must be finite on the way there.
const FARTHEST: f64 = 1e30;

/// Reads the points after the header.
pub(super) fn read<R: Read>(
    source_name: &str,
    opening: Opening,
    kind: PathKind,
    blocks: &mut Blocks<R>,
    order: Option<Order>,
) -> Result<PathFile, Error> {
    let nouns = match kind {
        PathKind::Bezier | PathKind::BezierDegree(_) => ["control point", "control points"],
        _ => ["point", "points"],
    };
    let form = Form {
        columns: "x y z",
        limit: FARTHEST,
        quaternion: Quaternion::Maybe,
        order: order.or(opening.header.order).unwrap_or_default(),
        keys: keys(kind),
        nouns,
    };
    let Table { header, values, quaternions, start, times, lines, oddities, .. } =
        table::read(source_name, opening, blocks, form)?;
    Ok(PathFile {
        kind,
        duration: header.duration.map(|(_, seconds)| seconds),
        points: values,
        times,
        start,
        orientations: quaternions,
        frame: header.frame,
        lines,
        warnings: oddities.warnings(form.order),
        largest_norm_error: oddities.largest_norm_error(),
        hash: blocks.hasher.finalize().to_hex().to_string(),
        bytes: blocks.bytes,
    })
}

//! What a path file, or one of other rotations, holds.

use crate::clip::Warning;
use crate::read::{PathFile, RotationsFile};
use serde::Serialize;
use std::fmt;

/// What a file of points or of angles holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PathSummary {
    /// As its header spells it.
    pub kind: &'static str,
    /// Number of points, or of rotations.
    pub points: usize,
    /// Number of points with an orientation of their own.
    pub orientations: usize,
    /// Time of the first row as the file gives it, seconds.
    pub start: f64,
    /// How long it lasts, seconds, where the file says so.
    pub seconds: Option<f64>,
    /// The least of each coordinate of the points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low: Option<[f64; 3]>,
    /// The greatest of each coordinate of the points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high: Option<[f64; 3]>,
    /// Whose x, y and z the numbers are, where the file says so.
    pub frame: Option<&'static str>,
    /// Bytes of the file.
    pub bytes: u64,
    /// BLAKE3 hash of the file.
    pub blake3: String,
    /// What is odd about it.
    pub warnings: Vec<Warning>,
}

/// Says what a path file holds.
pub fn path(file: &PathFile) -> PathSummary {
    let range = |pick: fn(f64, f64) -> f64| {
        let of = |axis: usize| file.points.iter().map(|p| p[axis]).reduce(pick).unwrap_or(0.0);
        Some([of(0), of(1), of(2)])
    };
    PathSummary {
        kind: file.kind.name(),
        points: file.points.len(),
        orientations: file.orientations.iter().flatten().count(),
        start: file.start,
        seconds: file.duration.or(file.times.as_ref().and_then(|times| times.last().copied())),
        low: range(f64::min),
        high: range(f64::max),
        frame: file.frame.map(|frame| frame.name()),
        bytes: file.bytes,
        blake3: file.hash.clone(),
        warnings: file.warnings.clone(),
    }
}

/// Says what a file of angles or control rotations holds.
pub fn rotations(file: &RotationsFile) -> PathSummary {
    PathSummary {
        kind: file.rotations.name(),
        points: file.rotations.len(),
        orientations: 0,
        start: file.start,
        seconds: file.duration.or(file.times.as_ref().and_then(|times| times.last().copied())),
        low: None,
        high: None,
        frame: Some(file.frame.unwrap_or(file.rotations.usual_frame()).name()),
        bytes: file.bytes,
        blake3: file.hash.clone(),
        warnings: file.warnings.clone(),
    }
}

impl fmt::Display for PathSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let PathSummary { kind, points, bytes, .. } = self;
        writeln!(f, "{kind}, {bytes} bytes\nrows: {points}")?;
        if self.orientations > 0 {
            writeln!(f, "with an orientation: {}", self.orientations)?;
        }
        match self.seconds {
            Some(seconds) => writeln!(f, "from {} s, {seconds} s long", self.start)?,
            None => writeln!(f, "no times, no duration")?,
        }
        if let (Some([x, y, z]), Some([to_x, to_y, to_z])) = (self.low, self.high) {
            writeln!(f, "x {x} to {to_x}, y {y} to {to_y}, z {z} to {to_z}")?;
        }
        if let Some(frame) = self.frame {
            writeln!(f, "frame: {frame}")?;
        }
        writeln!(f, "BLAKE3: {}", self.blake3)?;
        for Warning { code, message } in &self.warnings {
            writeln!(f, "warning: {message} [{code}]")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::{Input, input};

    #[test]
    fn says_what_is_there() {
        let Ok(Input::Path(file)) = input("p.dat", b"# polyline 4\n0 1 2\n3 -1 2\n".as_slice(), None) else {
            panic!("a path");
        };
        let summary = path(&file);
        assert_eq!((summary.kind, summary.points, summary.seconds), ("polyline", 2, Some(4.0)));
        assert_eq!((summary.low, summary.high), (Some([0.0, -1.0, 2.0]), Some([3.0, 1.0, 2.0])));
        assert!(summary.to_string().contains("x 0 to 3, y -1 to 1, z 2 to 2"));
    }
}

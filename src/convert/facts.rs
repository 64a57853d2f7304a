//! What became of a clip, and what to say of it.

use crate::clip::Warning;
use crate::sample::{Steps, TrackFacts};
use serde::Serialize;

/// What became of one clip.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipFacts {
    /// Name of the animation.
    pub name: String,
    /// Its scheme.
    pub scheme: &'static str,
    /// Samples of each node.
    pub samples: u64,
    /// An upper bound of the angle between playback (slerp) and the curve, degrees: the
    /// largest of all rotations. None where one of them has none, or nothing turns.
    pub deviation_degrees: Option<f64>,
    /// An upper bound of the distance between playback and the path, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation_units: Option<f64>,
    /// The largest turn from sample to sample, degrees.
    pub largest_step_degrees: f64,
    /// The same by rotation: boxes, then the root.
    #[serde(skip)]
    pub tracks: Vec<TrackFacts>,
}

impl ClipFacts {
    pub(super) fn new(
        name: String,
        scheme: &'static str,
        samples: u64,
        tracks: Vec<TrackFacts>,
        distance: Option<f64>,
    ) -> ClipFacts {
        let deviations: Option<Vec<f64>> = tracks.iter().map(|track| track.deviation).collect();
        let largest = |values: Vec<f64>| values.into_iter().fold(0.0, f64::max);
        let turns = deviations.filter(|all| !all.is_empty());
        ClipFacts {
            name,
            scheme,
            samples,
            deviation_degrees: turns.map(|all| rounded_up(largest(all))),
            deviation_units: distance.map(rounded_up),
            largest_step_degrees: largest(tracks.iter().map(|track| track.steps.worst).collect()),
            tracks,
        }
    }

    /// The warning of steps that component-blending viewers show inexactly.
    pub fn warning(&self) -> Option<Warning> {
        let large: usize = self.tracks.iter().map(|track| track.steps.large).sum();
        let steps = self.tracks.iter().map(|track| track.steps).enumerate();
        let (index, Steps { worst, at, .. }) = steps.max_by(|a, b| a.1.worst.total_cmp(&b.1.worst))?;
        let count = if large == 1 { "1 step turns".to_owned() } else { format!("{large} steps turn") };
        (large > 0).then(|| {
            let message = format!(
                "clip {}: {count} by more than {}° from sample to sample, the largest by {worst:.1}° (box {}, \
                 t = {at:.3} s): Blender blends there and errs by about {:.2}°; a higher --fps helps",
                self.name,
                Steps::LARGE,
                index + 1,
                1.2e-6 * worst.powi(3)
            );
            Warning::new("LARGE_STEPS", message)
        })
    }
}

/// Rounded up to five significant digits: still an upper bound, and readable.
pub(super) fn rounded_up(x: f64) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return x;
    }
    let unit = 10f64.powi(x.log10().floor() as i32 - 4);
    let units = (x / unit).ceil();
    // Decimal text rounds once more; the nearest number to it may lie below x.
    let rounded = format!("{units}e{}", unit.log10().round() as i32).parse().unwrap_or(x);
    if rounded < x { x } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_up_stays_above() {
        for x in [1.234_567_8e-7, 0.1, 0.000_123_450_001, 9.999_99, 12345.6, 3e-320] {
            let up = rounded_up(x);
            assert!(up >= x && up <= x * (1.0 + 2e-4), "{x} {up}");
        }
        assert_eq!(rounded_up(0.012_345_1), 0.012_346);
        assert_eq!(rounded_up(0.0), 0.0);
    }
}

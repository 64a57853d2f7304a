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
    /// Samples of the node that has the most.
    pub samples: u64,
    /// Samples of all rotations and places together.
    pub samples_in_all: u64,
    /// How many rotations and places.
    #[serde(skip)]
    pub movers: usize,
    /// An upper bound of the angle between playback (slerp) and the curve, degrees: the
    /// largest of all rotations. None where one of them has none, or nothing turns.
    pub deviation_degrees: Option<f64>,
    /// The same for players that blend the four numbers and normalise, as Blender does.
    pub nlerp_degrees: Option<f64>,
    /// Where a rotation has no such bound, the largest angle that was found at samples and
    /// between them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_degrees: Option<f64>,
    /// How far playback is from the input's keys at most, degrees, where keys were chosen
    /// by a tolerance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keys_moved_degrees: Option<f64>,
    /// An upper bound of how far a corner of the chain can be from where it should be,
    /// units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement_units: Option<f64>,
    /// An upper bound of the distance between playback and the path, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation_units: Option<f64>,
    /// The largest turn from sample to sample, degrees.
    pub largest_step_degrees: f64,
    /// Of each camera that moves.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<CameraFacts>,
    /// The same by rotation: boxes, then the root.
    #[serde(skip)]
    pub tracks: Vec<TrackFacts>,
}

/// How well a camera follows its curves.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct CameraFacts {
    /// Name of its node.
    pub name: String,
    /// An upper bound of the angle between playback and curve, degrees; null where
    /// nothing is known between samples.
    pub deviation_degrees: Option<f64>,
    /// An upper bound of the distance between playback and path.
    pub deviation_units: f64,
}

/// What sampling a clip found out.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    pub(super) object: Seen,
    pub(super) cameras: Seen,
    /// An upper bound of how far a corner of the chain is from where it should be, copies
    /// aside, where it was worked out.
    pub(super) corners: Option<f64>,
}

/// What sampling some moves found out, in their order.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    pub(super) tracks: Vec<TrackFacts>,
    /// Upper bounds of the distance between playback and path.
    pub(super) distances: Vec<f64>,
    /// How far playback is from keys, degrees, where it does not run through them.
    pub(super) keys_moved: Option<f64>,
}

/// What copies add, whose times are rounded once more: by rotation, and along the path.
#[derive(Clone, Debug, Default)]
pub(super) struct Late {
    pub(super) degrees: Vec<Option<f64>>,
    pub(super) units: f64,
}

impl Found {
    /// Figures of the most digits.
    pub(super) fn widest(tracks: usize, paths: usize, cameras: usize) -> Found {
        let widest = TrackFacts { deviation: Some(-f64::MIN_POSITIVE), ..TrackFacts::default() };
        let seen = |tracks, paths| Seen {
            tracks: vec![widest; tracks],
            distances: vec![-f64::MIN_POSITIVE; paths],
            keys_moved: None,
        };
        Found { object: seen(tracks, paths), cameras: seen(cameras, cameras), corners: None }
    }

    pub(super) fn of(&mut self, cameras: bool) -> &mut Seen {
        if cameras { &mut self.cameras } else { &mut self.object }
    }

    /// With what copies add.
    pub(super) fn late(mut self, late: &Late) -> Found {
        for (track, degrees) in self.object.tracks.iter_mut().zip(&late.degrees) {
            for figure in [&mut track.deviation, &mut track.nlerp] {
                *figure = figure.zip(*degrees).map(|(deviation, late)| deviation + late);
            }
        }
        self.object.distances.iter_mut().for_each(|distance| *distance += late.units);
        self
    }
}

impl ClipFacts {
    /// `cameras`: the names of those that move.
    pub(super) fn new(
        name: String,
        scheme: &'static str,
        (samples_in_all, samples): (u64, u64),
        found: Found,
        cameras: Vec<String>,
    ) -> ClipFacts {
        let Found { object: Seen { tracks, distances, keys_moved: object_moved }, cameras: watched, .. } =
            found;
        let largest = |values: Vec<f64>| values.into_iter().fold(0.0, f64::max);
        let of_all = |figure: fn(&TrackFacts) -> Option<f64>| {
            let all: Option<Vec<f64>> = tracks.iter().map(figure).collect();
            all.filter(|all| !all.is_empty()).map(|all| rounded_up(largest(all)))
        };
        let measured = tracks.iter().filter_map(|track| track.measured).reduce(f64::max);
        let cameras = cameras.into_iter().zip(watched.tracks.iter().zip(watched.distances));
        let camera = |(name, (track, distance)): (String, (&TrackFacts, f64))| CameraFacts {
            name,
            deviation_degrees: track.deviation.map(rounded_up),
            deviation_units: rounded_up(distance),
        };
        ClipFacts {
            name,
            scheme,
            samples,
            samples_in_all,
            movers: tracks.len() + distances.len(),
            deviation_degrees: of_all(|track| track.deviation),
            nlerp_degrees: of_all(|track| track.nlerp),
            measured_degrees: measured.map(rounded_up),
            keys_moved_degrees: object_moved.map(rounded_up),
            displacement_units: None,
            deviation_units: distances.first().copied().map(rounded_up),
            largest_step_degrees: largest(tracks.iter().map(|track| track.steps.worst).collect()),
            cameras: cameras.map(camera).collect(),
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

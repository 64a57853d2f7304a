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
    /// All figures that there can be.
    pub(super) fn every(tracks: usize, paths: usize, cameras: usize) -> Found {
        let figure = Some(WIDEST);
        let every =
            TrackFacts { deviation: figure, nlerp: figure, measured: figure, ..TrackFacts::default() };
        let seen = |tracks, paths| Seen {
            tracks: vec![every; tracks],
            distances: vec![WIDEST; paths],
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

    /// The same with figures of the most digits wherever a file has one.
    pub(super) fn widest(mut self) -> ClipFacts {
        for track in &mut self.tracks {
            for figure in [&mut track.deviation, &mut track.nlerp, &mut track.measured] {
                *figure = Some(WIDEST);
            }
        }
        for figure in [&mut self.deviation_units, &mut self.displacement_units] {
            *figure = figure.map(|_| WIDEST);
        }
        self
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

/// What is not told from zero.
const SMALLEST: f64 = 1e-300;
/// What takes the most digits, as JSON has them, of all that [`rounded_up`] returns.
const WIDEST: f64 = 1.2346e15;

/// Rounded up to five significant digits: still an upper bound, and readable.
pub(super) fn rounded_up(x: f64) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return x;
    }
    let x = x.max(SMALLEST);
    let exponent = libm::log10(x).floor() as i32 - 4;
    let units = (x / 10f64.powi(exponent)).ceil();
    // Decimal text rounds once more; the nearest number to it may lie below x.
    let decimals = [units, units + 1.0].map(|units| format!("{units}e{exponent}").parse());
    decimals.into_iter().flatten().find(|&decimal: &f64| decimal >= x).unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_up_stays_above() {
        for x in [1.234_567_8e-7, 0.1, 0.000_123_450_001, 9.999_99, 12345.6] {
            let up = rounded_up(x);
            assert!(up >= x && up <= x * (1.0 + 2e-4), "{x} {up}");
        }
        assert_eq!(rounded_up(0.012_345_1), 0.012_346);
        assert_eq!(rounded_up(0.0), 0.0);
    }

    #[test]
    fn widest_is_so_in_whatever_copies_add() {
        let late = Late { degrees: vec![Some(1.0), Some(0.0)], units: 1.0 };
        let found = Found::every(2, 1, 0).late(&late);
        let facts = ClipFacts::new("swing".into(), "slerp", (2, 2), found, Vec::new()).widest();
        let figures = facts.tracks.iter().flat_map(|track| [track.deviation, track.nlerp, track.measured]);
        assert!(figures.chain([facts.deviation_units]).all(|figure| figure == Some(WIDEST)));
    }

    #[test]
    fn none_has_more_digits_than_the_widest() {
        let length = |x: f64| serde_json::to_string(&x).unwrap().len();
        for exponent in -330..309 {
            for units in [1.0, 1.234_5, 1.234_500_1, 2.2, 9.999_91, 9.999_99, 1.0 + f64::EPSILON] {
                let x = format!("{units}e{exponent}").parse().unwrap();
                assert!(length(rounded_up(x)) <= length(WIDEST), "{x:e}");
            }
        }
    }
}

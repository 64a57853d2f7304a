//! How far apart in time the key points stand, as far as kind and timing say.

use super::{Error, Kind, Options, Timing};
use glam::DVec3;

/// What the step from one key point to the next is proportional to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spacing {
    Even,
    RootChord,
    Chord,
    Times,
}

/// How key points are spaced, which fixes the shape of a Catmull–Rom curve, and whether
/// constant speed replaces the times that follow from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    pub(super) spacing: Spacing,
    pub(super) constant_speed: bool,
}

/// Distances up to this count as none, where the largest coordinate is about 1: a few
/// units in the last place.
pub(super) const COINCIDENT: f64 = 1e-15;

/// Times of neighbouring key points are at least this far apart, seconds.
pub(super) const SHORTEST: f64 = 1e-9;

/// The plan that the options ask of a kind; `timed`: times came with the points.
pub(super) fn plan(kind: Kind, timed: bool, options: &Options) -> Result<Plan, Error> {
    let timing = options.timing.or(timed.then_some(Timing::Times));
    if options.ease != super::Ease::None && timing != Some(Timing::ConstantSpeed) {
        return Err(Error::Ease);
    }
    let own = match kind {
        Kind::CatmullRomCentripetal => Spacing::RootChord,
        Kind::CatmullRomChordal | Kind::Polyline => Spacing::Chord,
        Kind::Bezier | Kind::BezierDegree(_) | Kind::CatmullRom => Spacing::Even,
    };
    let asked = match timing {
        None | Some(Timing::ConstantSpeed) => own,
        Some(Timing::Uniform) => Spacing::Even,
        Some(Timing::Chord) => Spacing::Chord,
        Some(Timing::Times) if timed => Spacing::Times,
        Some(Timing::Times) => return Err(Error::NoTimes),
    };
    let fixed = matches!(kind, Kind::CatmullRomCentripetal | Kind::CatmullRomChordal);
    match timing {
        Some(timing) if fixed && asked != own => Err(Error::FixedKnots { kind, timing }),
        _ => Ok(Plan { spacing: asked, constant_speed: timing == Some(Timing::ConstantSpeed) }),
    }
}

/// The steps from key to key, in any unit; a step of 0 for points that coincide under a
/// spacing by chords, but even steps where all would be 0. `times`: of the keys.
pub(super) fn steps(spacing: Spacing, keys: &[DVec3], times: Option<&[f64]>) -> Vec<f64> {
    let chords =
        || keys.windows(2).map(|p| p[0].distance(p[1])).map(|d| if d > COINCIDENT { d } else { 0.0 });
    let steps: Vec<f64> = match spacing {
        Spacing::Even => vec![1.0; keys.len() - 1],
        Spacing::Chord => chords().collect(),
        Spacing::RootChord => chords().map(f64::sqrt).collect(),
        Spacing::Times => times.unwrap_or_default().windows(2).map(|t| t[1] - t[0]).collect(),
    };
    if steps.iter().any(|&h| h > 0.0) { steps } else { vec![1.0; keys.len() - 1] }
}

/// Refuses times that are not one for each of `keys` key points, or do not increase.
pub(super) fn check_times(times: &[f64], keys: usize) -> Result<(), Error> {
    if times.len() != keys {
        return Err(Error::TimeCount { expected: keys, found: times.len() });
    }
    let late_enough = |i: &usize| times[*i].is_finite() && times[*i] - times[*i - 1] >= SHORTEST;
    if !times[0].is_finite() {
        return Err(Error::Order { key: 0 });
    }
    (1..keys).find(|i| !late_enough(i)).map_or(Ok(()), |key| Err(Error::Order { key }))
}

//! Fewer keys for a track of many that are played LINEAR, in one pass over them.

use super::found::{Allowed, Found};
use super::track::{Stored, Track};
use crate::asset::play::{Interpolation, Property};
use crate::math::Quat;
use crate::reduce::{Asked, Ends, Near, Numbers, fewer};
use std::f64::consts::PI;

/// With no more keys the search for the fewest takes little time.
const MANY: usize = 1 << 14;

/// Whether one pass is what such a track gets.
pub(super) fn applies(track: &Track, allowed: &Allowed) -> bool {
    track.interpolation == Interpolation::Linear
        && track.times.len() > MANY
        && track.width <= 16
        && allowed.tolerance.is_some()
}

/// New keys, to be played LINEAR; none where they cannot be bounded.
pub(super) fn new_keys(track: &Track, allowed: &Allowed) -> Option<Found> {
    let ends = if allowed.on_curve { Ends::OnCurve } else { Ends::Free };
    Some(Found { stored: Stored::FLOATS, ..walked(track, allowed, ends)? })
}

/// Some of the track's own keys, as they are stored; none where they cannot be bounded.
pub(super) fn own_keys(track: &Track, allowed: &Allowed) -> Option<Found> {
    walked(track, allowed, Ends::Own)
}

fn walked(track: &Track, allowed: &Allowed, ends: Ends) -> Option<Found> {
    macro_rules! by_width {
        ($($n:literal)*) => {
            match (track.property, track.width) {
                (Property::Rotation, 4) => through::<Quat, 4>(track, allowed, ends, PI / 360.0),
                $((_, $n) => through::<Numbers<$n>, $n>(track, allowed, ends, 1.0),)*
                _ => None,
            }
        };
    }
    by_width!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16)
}

/// `unit` is what one of the tolerance's units is in those of distances between values.
fn through<V: Near<Stored = [f32; N]>, const N: usize>(
    track: &Track,
    allowed: &Allowed,
    ends: Ends,
    unit: f64,
) -> Option<Found> {
    let step = allowed.max_step.map_or(f64::INFINITY, |step| step * unit);
    let asked = Asked { tolerance: allowed.tolerance? * unit, step, ends };
    let keys = fewer::<V, N>(&track.times, track.values.as_chunks().0, asked)?;
    Some(Found {
        times: keys.times,
        values: keys.values.into_flattened(),
        stored: track.stored,
        interpolation: Interpolation::Linear,
        deviation: keys.deviation / unit,
    })
}

//! Fewer keys for one track: some of its own, or new ones; whichever takes fewer bytes.

use super::Options;
use super::curves::{Cubics, Normalised, Slerps};
use super::found::{Allowed, Found};
use super::track::{Stored, Track};
use super::{many, subset};
use crate::asset::play::{Interpolation, Property};
use crate::reduce;

/// The keys in the fewest bytes; none where no fewer keys were found.
pub(super) fn fewest(track: &Track, options: &Options) -> Option<Found> {
    let allowed = Allowed::new(track.property, options);
    let best = best(track, &allowed);
    if is_worth_it(track, &best) {
        return Some(best);
    }
    let exact = Allowed { tolerance: exact(track.property), ..allowed };
    let best = own_keys(track, &exact);
    (best.times.len() < track.times.len()).then_some(best)
}

/// Whether so much is saved that it is worth a deviation: a fifth of the bytes, or a
/// twentieth and more than one key. Without such a limit every run over its own output
/// would find a key more to leave out, and stray further each time.
fn is_worth_it(track: &Track, found: &Found) -> bool {
    let share = found.bytes() as f64 / track.bytes() as f64;
    let keys = track.times.len().saturating_sub(found.times.len());
    keys > 0 && share <= 0.8 || keys > 1 && share <= 0.95
}

/// A tolerance that is no more than rounding.
fn exact(property: Property) -> Option<f64> {
    (property == Property::Rotation).then_some(subset::ROTATION_ROUNDING)
}

fn best(track: &Track, allowed: &Allowed) -> Found {
    // Of many keys that are float32 as they are, some of them are more than new ones.
    if many::applies(track, allowed) && track.stored == Stored::FLOATS {
        let found = subset::resting(track, allowed).or_else(|| many::new_keys(track, allowed));
        if let Some(found) = found {
            return found;
        }
    }
    let own = own_keys(track, allowed);
    let new = (own.times.len() > 2).then(|| new_keys(track, allowed)).flatten();
    match new {
        Some(new) if new.bytes() < own.bytes() && new.times.len() < track.times.len() => new,
        _ => own,
    }
}

/// Some of a track's own keys.
fn own_keys(track: &Track, allowed: &Allowed) -> Found {
    let many = many::applies(track, allowed);
    let walked = || if many { many::own_keys(track, allowed) } else { None };
    let found = subset::resting(track, allowed).or_else(walked);
    found.unwrap_or_else(|| subset::own_keys(track, allowed))
}

/// New keys to be played LINEAR.
fn new_keys(track: &Track, allowed: &Allowed) -> Option<Found> {
    if track.interpolation == Interpolation::Step {
        return None;
    }
    if many::applies(track, allowed)
        && let Some(found) = many::new_keys(track, allowed)
    {
        return Some(found);
    }
    let options = reduce::Options {
        tolerance: allowed.tolerance?,
        reserve: 0.0,
        max_step: allowed.max_step,
        on_curve: allowed.on_curve,
        careful: reduce::Options::CAREFUL,
    };
    match (track.property, track.is_cubic()) {
        (Property::Rotation, true) => found(reduce::rotation(&Normalised(Cubics::new(track)), &options)),
        (Property::Rotation, false) => found(reduce::rotation(&Slerps::new(track), &options)),
        _ => numbers(track, &options),
    }
}

/// Vectors of so many numbers; those of more keep some of their own keys.
fn numbers(track: &Track, options: &reduce::Options) -> Option<Found> {
    macro_rules! by_width {
        ($($n:literal)*) => {
            match track.width {
                $($n => found(reduce::numbers(&Cubics::<$n>::new(track), options)),)*
                _ => None,
            }
        };
    }
    by_width!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16)
}

/// None where float32 is too coarse.
fn found<const N: usize>(keys: Result<reduce::Keys<N>, reduce::Error>) -> Option<Found> {
    let keys = keys.ok()?;
    Some(Found {
        times: keys.times,
        values: keys.values.into_iter().flatten().collect(),
        stored: Stored::FLOATS,
        interpolation: Interpolation::Linear,
        deviation: keys.facts.deviation,
    })
}

//! Some of a track's own keys, as they are stored: the longest reach from key to key.
//!
//! Between two neighbouring keys of the track both its playback and that of fewer keys
//! are smooth, so that their distance there follows from what is known at these keys.

use super::curves::{cubic, hermite, least_length, slerp_rates, unit};
use super::found::{Allowed, Found};
use super::track::Track;
use crate::asset::play::{Interpolation, Property, slerp};

/// Keys whose playback keeps what is allowed; all of them where none can go.
pub(super) fn own_keys(track: &Track, allowed: &Allowed) -> Found {
    if let Some(found) = resting(track, allowed) {
        return found;
    }
    let (kept, deviation) = match track.interpolation {
        Interpolation::Step => steps(track, allowed),
        _ => longest_reach(track.times.len(), |from, to| strayed(track, allowed, from, to)),
    };
    picked(track, &kept, deviation)
}

/// One key, where that is enough.
pub(super) fn resting(track: &Track, allowed: &Allowed) -> Option<Found> {
    Some(picked(track, &[0], still(track, allowed)?))
}

fn picked(track: &Track, kept: &[usize], deviation: f64) -> Found {
    // One key has no tangents to be played by.
    let alone = kept.len() == 1 && track.is_cubic();
    let key = |&k: &usize| if alone { track.value(k) } else { track.key(k) };
    Found {
        times: kept.iter().map(|&k| track.times[k]).collect(),
        values: kept.iter().flat_map(key).copied().collect(),
        stored: track.stored,
        interpolation: if alone { Interpolation::Linear } else { track.interpolation },
        deviation,
    }
}

/// Float32 numbers of one straight line may each be off it by half a step: together by
/// one, at most 2⁻²³ of the largest.
const ROUNDING: f64 = 1.0 / (1 << 23) as f64;

/// The same of rotations, degrees: four numbers, each within 2⁻²⁵.
pub(super) const ROTATION_ROUNDING: f64 = 1.2e-5;

/// The distance between a key's value and another, degrees or units.
fn distance(track: &Track, key: usize, value: &[f64]) -> f64 {
    match track.property {
        Property::Rotation => {
            let value = std::array::from_fn(|i| value.get(i).copied().unwrap_or(0.0));
            unit(track.quat(key)).angle_to(unit(value)).to_degrees()
        }
        Property::MorphTargetWeights => off(track, key, value).fold(0.0, f64::max),
        _ => off(track, key, value).map(|d| d * d).sum::<f64>().sqrt(),
    }
}

fn off(track: &Track, key: usize, value: &[f64]) -> impl Iterator<Item = f64> {
    track.value(key).iter().zip(value).map(|(&a, b)| (f64::from(a) - b).abs())
}

fn value(track: &Track, key: usize) -> Vec<f64> {
    track.value(key).iter().map(|&x| f64::from(x)).collect()
}

/// How far playback leaves the first value, if it ends there and stays near it.
fn still(track: &Track, allowed: &Allowed) -> Option<f64> {
    let last = track.times.len() - 1;
    let first = value(track, 0);
    if track.interpolation == Interpolation::Step {
        return None; // found in any case
    }
    let rounding = match track.property {
        Property::Rotation => ROTATION_ROUNDING,
        _ => 2.0 * ROUNDING * length_of(&first),
    };
    if distance(track, last, &first) > rounding {
        return None;
    }
    if track.property == Property::Rotation && track.is_cubic() {
        // Four numbers that change their sign on the way make a turn of it.
        let alike = |k: usize| track.quat(k).iter().zip(&first).map(|(a, b)| a * b).sum::<f64>() > 0.0;
        if !(0..=last).all(alike) {
            return None;
        }
    }
    let mut worst = 0.0f64;
    for key in 0..=last {
        worst = worst.max(distance(track, key, &first) + if key < last { bulge(track, key) } else { 0.0 });
        if worst > allowed.tolerance.unwrap_or(ROUNDING * length_of(&first)) {
            return None;
        }
    }
    Some(worst)
}

/// How far playback after a key can be from both this key and the next, degrees or units.
fn bulge(track: &Track, key: usize) -> f64 {
    let h = track.time(key + 1) - track.time(key);
    let tangents = (0..track.width).filter_map(|c| track.tangents(key, c));
    let reach = tangents.map(|(out, into)| h / 3.0 * (out.abs() + into.abs())).map(|d| d * d).sum::<f64>();
    match track.property {
        Property::Rotation => (2.0 * libm::asin((1.2 * reach.sqrt()).min(1.0))).to_degrees(),
        _ => reach.sqrt(),
    }
}

fn length_of(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Keys of a held value, each until one is further from it than allowed.
fn steps(track: &Track, allowed: &Allowed) -> (Vec<usize>, f64) {
    let (mut kept, mut worst) = (vec![0], 0.0f64);
    for key in 1..track.times.len() {
        let held = kept[kept.len() - 1];
        let off = match track.value(key) == track.value(held) {
            true => 0.0,
            false => distance(track, key, &value(track, held)),
        };
        if off > allowed.tolerance.unwrap_or(0.0) {
            kept.push(key);
        } else {
            worst = worst.max(off);
        }
    }
    (kept, worst)
}

/// From key to key as far as `strayed` says that an interval serves; it says how far
/// playback then strays.
fn longest_reach(count: usize, strayed: impl Fn(usize, usize) -> Option<f64>) -> (Vec<usize>, f64) {
    let (mut kept, mut worst, mut from) = (vec![0], 0.0f64, 0);
    while from + 1 < count {
        let (mut good, mut deviation, mut step) = (from + 1, 0.0, 1);
        let mut bad = count;
        // Ever longer steps, then ever shorter ones.
        while good + 1 < bad {
            let to = (good + step).min(bad - 1);
            match strayed(from, to) {
                Some(off) => (good, deviation, step) = (to, off, 2 * step),
                None => bad = to,
            }
            if bad < count {
                step = ((bad - good) / 2).max(1);
            }
        }
        worst = worst.max(deviation);
        kept.push(good);
        from = good;
    }
    (kept, worst)
}

/// How far playback from one key straight to another is from the track, degrees or
/// units; none if further than allowed.
fn strayed(track: &Track, allowed: &Allowed, from: usize, to: usize) -> Option<f64> {
    match (track.property, track.is_cubic()) {
        (Property::Rotation, false) => turned(track, allowed, from, to),
        (_, false) => straight(track, allowed, from, to),
        (_, true) => curved(track, allowed, from, to),
    }
}

/// The way within `from..to` at a key.
fn along(track: &Track, from: usize, to: usize, key: usize) -> f64 {
    (track.time(key) - track.time(from)) / (track.time(to) - track.time(from))
}

/// Both ways are straight between keys: the largest distance is at one.
fn straight(track: &Track, allowed: &Allowed, from: usize, to: usize) -> Option<f64> {
    let (a, b) = (value(track, from), value(track, to));
    let mut worst = 0.0f64;
    for key in from + 1..to {
        let u = along(track, from, to, key);
        let there: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + u * (b - a)).collect();
        let fits = match allowed.tolerance {
            Some(tolerance) => distance(track, key, &there) <= tolerance,
            None => {
                let steps = a.iter().zip(&b).map(|(a, b)| ROUNDING * a.abs().max(b.abs()));
                off(track, key, &there).zip(steps).all(|(off, step)| off <= step)
            }
        };
        if !fits {
            return None;
        }
        worst = worst.max(distance(track, key, &there));
    }
    Some(worst)
}

/// Both ways are arcs between keys. With f half the angle between them, v the larger of
/// their speeds and A the sum of their accelerations, which uneven lengths of quaternions
/// cause, f″ ≥ −A − 2v² tan(f/2): as docs/math/deviation.md has it, f exceeds its ends by
/// at most h²/8 · (A + 1.1 v² F) for a peak F up to 1.
fn turned(track: &Track, allowed: &Allowed, from: usize, to: usize) -> Option<f64> {
    let tolerance = allowed.tolerance?;
    let (a, b) = (track.quat(from), track.quat(to));
    let whole = unit(a).angle_to(unit(b)).to_degrees();
    if allowed.max_step.is_some_and(|step| whole > step) {
        return None;
    }
    let own = slerp_rates(a, b);
    let (mut worst, mut at_start) = (0.0f64, 0.0);
    for key in from..to {
        let u = along(track, from, to, key + 1);
        let at_end = match key + 1 < to {
            true => distance(track, key + 1, &slerp(a, b, u)).to_radians() / 2.0,
            false => 0.0,
        };
        let rates = slerp_rates(track.quat(key), track.quat(key + 1));
        let share = u - along(track, from, to, key);
        let speed = rates.speed.max(own.speed * share);
        let acceleration = rates.acceleration + own.acceleration * share * share;
        let room = 1.0 - 1.1 / 8.0 * speed * speed;
        let peak = (at_end.max(at_start) + acceleration / 8.0) / room;
        if room <= 0.0 || peak > 1.0 {
            return None;
        }
        worst = worst.max((2.0 * peak).to_degrees());
        if worst > tolerance {
            return None;
        }
        at_start = at_end;
    }
    Some(worst)
}

/// Both ways are cubics between keys, and so is their difference: it is at most as large
/// as at either end and 4/27 h of its slopes there. Of rotations the difference of the
/// four numbers is seen from the least length on the way.
fn curved(track: &Track, allowed: &Allowed, from: usize, to: usize) -> Option<f64> {
    let whole = track.time(to) - track.time(from);
    if track.property == Property::Rotation
        && allowed
            .max_step
            .is_some_and(|step| unit(track.quat(from)).angle_to(unit(track.quat(to))).to_degrees() > step)
    {
        return None;
    }
    let mut worst = 0.0f64;
    for key in from..to {
        let h = track.time(key + 1) - track.time(key);
        let (mut square, mut fits) = (0.0, true);
        for c in 0..track.width {
            let difference = difference(track, (from, to), key, c)?;
            square += difference * difference;
            let largest = track.number(from, c).abs().max(track.number(to, c).abs());
            let slopes = track.tangents(from, c)?.0.abs().max(into(track, to, c).abs());
            fits &= difference <= ROUNDING * largest.max(whole * slopes).max(h * slopes);
        }
        let off = match track.property {
            Property::Rotation => angle(track, key, square.sqrt())?,
            _ => square.sqrt(),
        };
        worst = worst.max(off);
        if !allowed.tolerance.map_or(fits, |tolerance| worst <= tolerance) {
            return None;
        }
    }
    Some(worst)
}

/// The tangent into a key.
fn into(track: &Track, key: usize, c: usize) -> f64 {
    f64::from(track.key(key)[c])
}

/// A bound of the difference of one number after a key.
fn difference(track: &Track, (from, to): (usize, usize), key: usize, c: usize) -> Option<f64> {
    let whole = track.time(to) - track.time(from);
    let out = track.tangents(from, c)?.0;
    let at = |k: usize| {
        let u = along(track, from, to, k);
        hermite(track.number(from, c), out, into(track, to, c), track.number(to, c), u, whole)
    };
    let ((a, slope_a), (b, slope_b)) = (at(key), at(key + 1));
    let (tangent_a, tangent_b) = track.tangents(key, c)?;
    let ends = (a - track.number(key, c)).abs().max((b - track.number(key + 1, c)).abs());
    let h = track.time(key + 1) - track.time(key);
    Some(ends + 4.0 / 27.0 * h * ((slope_a - tangent_a).abs() + (slope_b - tangent_b).abs()))
}

/// The angle, degrees, that a difference of the four numbers after a key can make.
fn angle(track: &Track, key: usize, difference: f64) -> Option<f64> {
    let least = least_length(&cubic(track, key));
    let sine = difference / least;
    (least > 0.0 && sine < 1.0).then(|| (2.0 * libm::asin(sine)).to_degrees())
}

#[cfg(test)]
mod tests {
    use super::super::track::{Sampler, Stored};
    use super::*;

    /// A track of 33 keys, a 32nd of a second apart.
    fn track(property: Property, interpolation: Interpolation, value: impl Fn(f64) -> Vec<f64>) -> Track {
        let times: Vec<f32> = (0..33).map(|i| i as f32 / 32.0).collect();
        let values: Vec<f32> = times.iter().flat_map(|&t| value(f64::from(t))).map(|x| x as f32).collect();
        let cubic = interpolation == Interpolation::CubicSpline;
        let width = values.len() / times.len() / if cubic { 3 } else { 1 };
        Track {
            sampler: Sampler {
                animation: 0,
                sampler: 0,
                property,
                input: 0,
                output: 1,
                keys: times.len(),
                last: 1.0,
                bytes: 4 * values.len(),
            },
            property,
            interpolation,
            times,
            values,
            width,
            stored: Stored::FLOATS,
        }
    }

    fn allowed(tolerance: Option<f64>) -> Allowed {
        Allowed { tolerance, max_step: None, on_curve: false }
    }

    #[test]
    fn longest_reach_is_the_longest() {
        for reach in 1..12 {
            let (kept, worst) = longest_reach(40, |a, b| (b - a <= reach).then_some((b - a) as f64));
            assert!(kept.windows(2).all(|pair| pair[1] - pair[0] == reach || pair[1] == 39), "{kept:?}");
            assert_eq!((kept[0], kept[kept.len() - 1]), (0, 39));
            assert_eq!(worst, if reach == 1 { 0.0 } else { reach as f64 });
        }
    }

    #[test]
    fn one_cubic_in_many_pieces_is_one_again() {
        // x = t³ − t, exact to the tangents.
        let piece = |t: f64| vec![3.0 * t * t - 1.0, t.powi(3) - t, 3.0 * t * t - 1.0];
        let track = track(Property::MorphTargetWeights, Interpolation::CubicSpline, piece);
        assert_eq!(own_keys(&track, &allowed(None)).times, [0.0, 1.0]);
        // Its last value is its first, but it does not rest there.
        assert!(still(&track, &allowed(Some(0.1))).is_none());
        assert!(still(&track, &allowed(Some(0.5))).is_some());
    }

    #[test]
    fn cubic_rotations_are_bounded_by_more_than_their_keys() {
        let turn = |t: f64| {
            let (sin, cos) = (0.8 * t).sin_cos();
            let (fast, slow) = (0.8 * cos, -0.8 * sin);
            [[fast, 0.0, 0.0, slow], [sin, 0.0, 0.0, cos], [fast, 0.0, 0.0, slow]].concat()
        };
        let track = track(Property::Rotation, Interpolation::CubicSpline, turn);
        let found = own_keys(&track, &allowed(Some(0.01)));
        assert!((3..12).contains(&found.times.len()), "{:?}", found.times);
        assert!(found.deviation <= 0.01);
        // Hermite's error on an arc of φ half radians is about φ⁴/384, twice that in angle.
        let arc = f64::from(found.times[1]) * 0.8;
        assert!(found.deviation > (arc.powi(4) / 384.0 * 2.0).to_degrees() * 0.5);
    }

    #[test]
    fn held_values_keep_their_keys() {
        let track = track(Property::Scale, Interpolation::Step, |t| vec![(4.0 * t).floor(); 3]);
        let found = own_keys(&track, &allowed(None));
        assert_eq!((found.times, found.deviation), (vec![0.0, 0.25, 0.5, 0.75, 1.0], 0.0));
        let found = own_keys(&track, &allowed(Some(1.8)));
        assert_eq!((found.times, found.deviation), (vec![0.0, 0.5, 1.0], 3f64.sqrt()));
    }

    #[test]
    fn uneven_lengths_of_quaternions_are_seen() {
        // As 8-bit codes: lengths differ by a part in a hundred.
        let turn = |t: f64| {
            let (sin, cos) = (0.4 * t).sin_cos();
            [sin, 0.0, 0.0, cos].map(|x| (x * 127.0).round() / 127.0).to_vec()
        };
        let track = track(Property::Rotation, Interpolation::Linear, turn);
        let found = own_keys(&track, &allowed(Some(0.6)));
        assert!(found.times.len() < 33 && found.deviation <= 0.6);
        let keys: Vec<[f64; 4]> =
            found.values.chunks(4).map(|q| std::array::from_fn(|i| f64::from(q[i]))).collect();
        for i in 0..640 {
            let t = f64::from(i) / 640.0;
            let at = |times: &[f32], quat: &dyn Fn(usize) -> [f64; 4]| {
                let k = times.partition_point(|&time| f64::from(time) <= t).min(times.len() - 1) - 1;
                let (a, b) = (f64::from(times[k]), f64::from(times[k + 1]));
                unit(slerp(quat(k), quat(k + 1), (t - a) / (b - a)))
            };
            let off = at(&track.times, &|k| track.quat(k)).angle_to(at(&found.times, &|k| keys[k]));
            assert!(off.to_degrees() <= found.deviation + 1e-9, "{t}: {off} {}", found.deviation);
        }
    }
}

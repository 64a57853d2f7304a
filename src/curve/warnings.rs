//! What a user should know about a scheme's way with these very keys.

use super::bessel_overhauser::{largest_power, may_wrap};
use super::{Ends, Motion, Scheme, Smoothness};
use crate::clip::Warning;
use crate::math::Quat;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Neighbouring intervals that differ by more than this are uneven.
const UNEVEN: f64 = 1.05;

/// Keys in time, and how a message names the place of one.
struct Keys<'a, T> {
    times: &'a [f64],
    tracks: &'a [T],
    place: &'a dyn Fn(usize) -> String,
}

/// Everything about `tracks`, which have their keys at `times`, that the scheme and the
/// ends do not do well. `place` says where key i stands, such as `t = 2.12 s (line 7)`.
pub fn warnings(
    times: &[f64],
    tracks: &[impl AsRef<[Quat]> + Sync],
    place: &dyn Fn(usize) -> String,
    scheme: Scheme,
    ends: Ends,
) -> Vec<Warning> {
    if times.len() == 2 || !scheme.has_ends() {
        return Vec::new(); // neighbours and ends change nothing
    }
    let keys = Keys { times, tracks, place };
    let found = [
        uneven(&keys, scheme, ends),
        wrapping(&keys, scheme),
        swinging(&keys, scheme, ends),
        jumping(&keys, scheme, ends),
        smoothed(&keys, scheme, ends),
        held(&keys, ends),
    ];
    found.into_iter().flatten().collect()
}

fn uneven<T>(keys: &Keys<T>, scheme: Scheme, ends: Ends) -> Option<Warning> {
    if scheme.smoothness() != Smoothness::EvenKeys {
        return None;
    }
    let times = keys.times;
    let ratio = |a: f64, b: f64| (a / b).max(b / a);
    let inner = (1..times.len() - 1).map(|i| (i, ratio(times[i] - times[i - 1], times[i + 1] - times[i])));
    let n = times.len();
    let seam =
        (ends == Ends::Closed).then(|| (n - 1, ratio(times[n - 1] - times[n - 2], times[1] - times[0])));
    let (key, worst) = inner.chain(seam).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (worst > UNEVEN).then(|| {
        let message = format!(
            "{} jumps in speed where keys are unevenly spaced, by up to {worst:.2} times at {}; \
             --scheme bessel does not",
            scheme.name(),
            (keys.place)(key)
        );
        Warning::new("UNEVEN_KEYS", message)
    })
}

/// Keys at which a power of `bessel-overhauser` turns by more than 180°.
fn wrapping<T: AsRef<[Quat]> + Sync>(keys: &Keys<T>, scheme: Scheme) -> Option<Warning> {
    if scheme != Scheme::BesselOverhauser {
        return None;
    }
    let times = keys.times;
    let wraps = |track: &T, i: usize| {
        let (track, h0, h1) = (track.as_ref(), times[i] - times[i - 1], times[i + 1] - times[i]);
        let [before, key, after] = [track[i - 1], track[i], track[i + 1]];
        may_wrap(before, key, after, h0, h1) && largest_power(before, key, after, h0, h1) > PI
    };
    let inner = (1..times.len() - 1).into_par_iter();
    let wrapping: Vec<usize> = inner.filter(|&i| keys.tracks.iter().any(|track| wraps(track, i))).collect();
    (!wrapping.is_empty()).then(|| {
        let message = format!(
            "bessel-overhauser may swing the wrong way at {}: steps this large between keys this unevenly spaced \
             exceed half a turn; --scheme bessel does not",
            places(keys, &wrapping)
        );
        Warning::new("POWER_WRAPS", message)
    })
}

/// Segments in which slerps that `barry-goldman` blends come nearly 360° apart.
fn swinging<T: AsRef<[Quat]>>(keys: &Keys<T>, scheme: Scheme, ends: Ends) -> Option<Warning> {
    if scheme != Scheme::BarryGoldman {
        return None;
    }
    let motions: Vec<Motion> =
        keys.tracks.iter().map(|track| Motion::new(keys.times, track.as_ref(), scheme, ends)).collect();
    let segments = (0..keys.times.len() - 1).into_par_iter();
    let swinging: Vec<usize> = segments.filter(|&i| motions.iter().any(|motion| motion.swings(i))).collect();
    (!swinging.is_empty()).then(|| {
        let message = format!(
            "barry-goldman swings round or jumps after {}: for steps this large between keys this unevenly spaced \
             what it blends comes a full turn apart; --scheme bessel does not",
            places(keys, &swinging)
        );
        Warning::new("POWER_WRAPS", message)
    })
}

/// The places of the first three keys.
fn places<T>(keys: &Keys<T>, found: &[usize]) -> String {
    let named: Vec<String> = found.iter().take(3).map(|&i| (keys.place)(i)).collect();
    let more = if found.len() > 3 { format!(" and {} more", found.len() - 3) } else { String::new() };
    named.join(", ") + &more
}

/// How far from its keys a curve passes that smooths.
fn smoothed<T: AsRef<[Quat]>>(keys: &Keys<T>, scheme: Scheme, ends: Ends) -> Option<Warning> {
    if scheme.passes_keys() {
        return None;
    }
    let off = |track: &T| {
        let motion = Motion::new(keys.times, track.as_ref(), scheme, ends);
        let inner = 1..keys.times.len() - 1;
        let off = inner.map(|i| (i, motion.at(keys.times[i]).angle_to(track.as_ref()[i])));
        off.max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (key, worst) = keys.tracks.iter().filter_map(off).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (worst > 1e-9).then(|| {
        let message = format!(
            "{} smooths and passes inner keys at up to {:.2}°, at {}; --scheme natural-c2 meets them",
            scheme.name(),
            worst.to_degrees(),
            (keys.place)(key)
        );
        Warning::new("KEYS_SMOOTHED", message)
    })
}

/// Tracks for which no motion without jumps in acceleration was found.
fn jumping<T: AsRef<[Quat]> + Sync>(keys: &Keys<T>, scheme: Scheme, ends: Ends) -> Option<Warning> {
    let solved = |track: &&T| Motion::new(keys.times, track.as_ref(), scheme, ends).is_solved();
    let left = keys.tracks.par_iter().filter(|track| !solved(track)).count();
    (left > 0).then(|| {
        let message = format!(
            "{} found no motion without jumps in acceleration for {left} of {} boxes: steps near half a turn \
             and uneven intervals; its speed does not jump; more keys help",
            scheme.name(),
            keys.tracks.len()
        );
        Warning::new("ACCELERATION_JUMPS", message)
    })
}

fn held<T>(keys: &Keys<T>, ends: Ends) -> Option<Warning> {
    (ends == Ends::Hold).then(|| {
        let message = format!(
            "--ends hold rests at the first key, jumps at {} and never reaches the last key at {}",
            (keys.place)(1),
            (keys.place)(keys.times.len() - 1)
        );
        Warning::new("ENDS_HELD", message)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::{Body, Clip, Lines};
    use crate::math::Vec3;

    /// A clip that turns about z by `degrees` at each key.
    fn clip(times: &[f64], degrees: f64) -> Clip {
        let turn = |i: usize| Quat::exp(Vec3::new(0.0, 0.0, (i as f64 * degrees / 2.0).to_radians()));
        let mut lines = Lines::default();
        (0..times.len()).for_each(|i| lines.push(i + 2));
        let track = (0..times.len()).map(turn).collect();
        Clip {
            body: Body::Free,
            start: 0.0,
            times: times.to_vec(),
            tracks: vec![track],
            through: Default::default(),
            lines,
        }
    }

    fn found(clip: &Clip, scheme: Scheme, ends: Ends) -> Vec<Warning> {
        warnings(&clip.times, &clip.tracks, &|key| clip.place(key), scheme, ends)
    }

    fn codes(clip: &Clip, scheme: Scheme, ends: Ends) -> Vec<&'static str> {
        found(clip, scheme, ends).into_iter().map(|w| w.code).collect()
    }

    #[test]
    fn uneven_keys_concern_catmull_rom_and_squad() {
        let clip = clip(&[0.0, 1.0, 3.0, 4.0], 20.0);
        for scheme in [Scheme::CatmullRom, Scheme::Squad] {
            assert_eq!(codes(&clip, scheme, Ends::Natural), ["UNEVEN_KEYS"]);
            let text = &found(&clip, scheme, Ends::Natural)[0].message;
            assert!(text.contains("2.00 times") && text.contains("bessel"), "{text}");
        }
        for scheme in [Scheme::Slerp, Scheme::Bessel, Scheme::BesselOverhauser] {
            assert!(codes(&clip, scheme, Ends::Natural).is_empty());
        }
    }

    #[test]
    fn five_percent_is_even_enough() {
        assert!(codes(&clip(&[0.0, 1.0, 2.04, 3.04], 20.0), Scheme::Squad, Ends::Natural).is_empty());
        // The seam of closed ends counts.
        let seam = clip(&[0.0, 1.0, 2.04, 3.1], 20.0);
        assert_eq!(codes(&seam, Scheme::Squad, Ends::Closed), ["UNEVEN_KEYS"]);
    }

    #[test]
    fn powers_beyond_half_a_turn_are_named() {
        let clip = clip(&[0.0, 1.0, 4.0, 7.0], 80.0);
        let found = found(&clip, Scheme::BesselOverhauser, Ends::Natural);
        assert_eq!(found.len(), 1);
        assert!(found[0].message.contains("t = 1 s (line 3):"), "{}", found[0].message);
    }

    #[test]
    fn keys_that_are_not_met_are_named() {
        let mut clip = clip(&[0.0, 1.0, 2.0, 3.0, 4.0], 20.0);
        // A steady turn is met; one key off by 6° is missed by a third of that.
        assert!(codes(&clip, Scheme::BSpline, Ends::Natural).is_empty());
        clip.tracks[0][2] = clip.tracks[0][2] * Quat::exp(Vec3::new(0.0, 0.0, 3f64.to_radians()));
        let found = found(&clip, Scheme::BSpline, Ends::Natural);
        assert_eq!(found[0].code, "KEYS_SMOOTHED");
        assert!(found[0].message.contains("2.00°, at t = 2 s (line 4)"), "{}", found[0].message);
    }

    #[test]
    fn slerps_a_turn_apart_are_named() {
        // On through the second interval the first step would make 640°, the second makes 80°.
        let uneven = clip(&[0.0, 1.0, 9.0, 17.0], 80.0);
        assert_eq!(codes(&uneven, Scheme::BarryGoldman, Ends::Natural), ["POWER_WRAPS"]);
        assert!(codes(&clip(&[0.0, 1.0, 4.0, 7.0], 80.0), Scheme::BarryGoldman, Ends::Natural).is_empty());
    }

    #[test]
    fn jumps_in_acceleration_are_said() {
        let mut clip = clip(&[0.0, 1.0, 2.0, 3.0], 60.0);
        assert!(codes(&clip, Scheme::NaturalC2, Ends::Natural).is_empty());
        // 170° at a time about axes that turn back and forth.
        let axes = [[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 0.0, -1.0]];
        let steps = axes.map(|[x, y, z]| Vec3::new(x, y, z));
        let turns = steps.iter().scan(Quat::IDENTITY, |q, &axis| {
            *q = *q * Quat::exp(axis * (85f64.to_radians() / axis.length()));
            Some(*q)
        });
        clip.tracks = vec![std::iter::once(Quat::IDENTITY).chain(turns).collect()];
        clip.times = vec![0.0, 1.0, 2.0, 5.0];
        assert_eq!(codes(&clip, Scheme::NaturalC2, Ends::Natural), ["ACCELERATION_JUMPS"]);
    }

    #[test]
    fn held_ends_are_said() {
        assert_eq!(codes(&clip(&[0.0, 1.0, 2.0], 20.0), Scheme::Bessel, Ends::Hold), ["ENDS_HELD"]);
        assert!(codes(&clip(&[0.0, 1.0], 20.0), Scheme::Bessel, Ends::Hold).is_empty());
    }
}

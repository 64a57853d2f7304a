//! What a user should know about a scheme's way with these very keys.

use super::bessel_overhauser::largest_power;
use super::{Ends, Scheme, Smoothness};
use crate::clip::{Clip, Warning};
use crate::math::Quat;
use std::f64::consts::PI;

/// Neighbouring intervals that differ by more than this are uneven.
const UNEVEN: f64 = 1.05;

/// Everything about `clip` that the scheme and the ends do not do well.
pub fn warnings(clip: &Clip, scheme: Scheme, ends: Ends) -> Vec<Warning> {
    if clip.times.len() == 2 || scheme == Scheme::Slerp {
        return Vec::new(); // slerp, whatever was asked for
    }
    [uneven(clip, scheme, ends), wrapping(clip, scheme), held(clip, ends)].into_iter().flatten().collect()
}

fn uneven(clip: &Clip, scheme: Scheme, ends: Ends) -> Option<Warning> {
    if scheme.smoothness() != Smoothness::EvenKeys {
        return None;
    }
    let times = &clip.times;
    let ratio = |a: f64, b: f64| (a / b).max(b / a);
    let inner = (1..times.len() - 1).map(|i| (i, ratio(times[i] - times[i - 1], times[i + 1] - times[i])));
    let n = times.len();
    let seam = (ends == Ends::Closed).then(|| (n - 1, ratio(times[n - 1] - times[n - 2], times[1])));
    let (key, worst) = inner.chain(seam).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (worst > UNEVEN).then(|| {
        let message = format!(
            "{} jumps in speed where keys are unevenly spaced, by up to {worst:.2} times at {}; \
             --scheme bessel does not",
            scheme.name(),
            clip.place(key)
        );
        Warning::new("UNEVEN_KEYS", message)
    })
}

/// Keys at which a power of `bessel-overhauser` turns by more than 180°.
fn wrapping(clip: &Clip, scheme: Scheme) -> Option<Warning> {
    if scheme != Scheme::BesselOverhauser {
        return None;
    }
    let wraps = |keys: &[Quat], i: usize| {
        let (h0, h1) = (clip.times[i] - clip.times[i - 1], clip.times[i + 1] - clip.times[i]);
        largest_power(keys[i - 1], keys[i], keys[i + 1], h0, h1) > PI
    };
    let inner = 1..clip.times.len() - 1;
    let keys: Vec<usize> = inner.filter(|&i| clip.tracks.iter().any(|keys| wraps(keys, i))).collect();
    let named: Vec<String> = keys.iter().take(3).map(|&i| clip.place(i)).collect();
    let more = if keys.len() > 3 { format!(" and {} more", keys.len() - 3) } else { String::new() };
    (!keys.is_empty()).then(|| {
        let message = format!(
            "bessel-overhauser may swing the wrong way at {}{more}: steps this large between keys this \
             unevenly spaced exceed half a turn; --scheme bessel does not",
            named.join(", ")
        );
        Warning::new("POWER_WRAPS", message)
    })
}

fn held(clip: &Clip, ends: Ends) -> Option<Warning> {
    (ends == Ends::Hold).then(|| {
        let last = clip.times.len() - 1;
        let message = format!(
            "--ends hold rests at the first key, jumps at {} and never reaches the last key at {}",
            clip.place(1),
            clip.place(last)
        );
        Warning::new("ENDS_HELD", message)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::{Body, Lines};
    use crate::math::Vec3;

    /// A clip that turns about z by `degrees` at each key.
    fn clip(times: &[f64], degrees: f64) -> Clip {
        let turn = |i: usize| Quat::exp(Vec3::new(0.0, 0.0, (i as f64 * degrees / 2.0).to_radians()));
        let mut lines = Lines::default();
        (0..times.len()).for_each(|i| lines.push(i + 2));
        let track = (0..times.len()).map(turn).collect();
        Clip { body: Body::Free, start: 0.0, times: times.to_vec(), tracks: vec![track], lines }
    }

    fn codes(clip: &Clip, scheme: Scheme, ends: Ends) -> Vec<&'static str> {
        warnings(clip, scheme, ends).into_iter().map(|w| w.code).collect()
    }

    #[test]
    fn uneven_keys_concern_catmull_rom_and_squad() {
        let clip = clip(&[0.0, 1.0, 3.0, 4.0], 20.0);
        for scheme in [Scheme::CatmullRom, Scheme::Squad] {
            assert_eq!(codes(&clip, scheme, Ends::Natural), ["UNEVEN_KEYS"]);
            let text = &warnings(&clip, scheme, Ends::Natural)[0].message;
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
        let found = warnings(&clip, Scheme::BesselOverhauser, Ends::Natural);
        assert_eq!(found.len(), 1);
        assert!(found[0].message.contains("t = 1 s (line 3):"), "{}", found[0].message);
    }

    #[test]
    fn held_ends_are_said() {
        assert_eq!(codes(&clip(&[0.0, 1.0, 2.0], 20.0), Scheme::Bessel, Ends::Hold), ["ENDS_HELD"]);
        assert!(codes(&clip(&[0.0, 1.0], 20.0), Scheme::Bessel, Ends::Hold).is_empty());
    }
}

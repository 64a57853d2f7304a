//! Whether float32's times are fine enough for a curve.
//!
//! Playback takes the short way from key to key. Where a curve goes further than the longest
//! such way between one float32 number and the next, no keys can follow it, however many; a
//! search would find out only after all the keys before that.

use super::curve::Curve;
use super::search::Stuck;
use super::value::Value;

/// Where a stretch between knots is looked at. Speeds of cubics are quadratics.
const PROBES: [f64; 5] = [0.02, 0.25, 0.5, 0.75, 0.98];

/// How often the time between two float32 numbers is halved: as far as float64, with which
/// times are told apart to about 2⁻²⁹ of it, shows differences.
const HALVINGS: i32 = 20;

/// So many float32 numbers.
const MANY: f64 = 100.0;

/// What the speed found at a place may be off, relative to it, and more.
const SURE: f64 = 1.1;

/// Refuses a curve that turns too fast somewhere between knots that are many float32 numbers
/// apart. The ramps of jumps may be as short as they like.
pub(super) fn check<C: Curve>(curve: &C) -> Result<(), Stuck> {
    let between = |pair: &&[f64]| {
        let ramp = curve.ramps().iter().any(|&(from, to)| from <= pair[0] && pair[1] <= to);
        !ramp && pair[1] - pair[0] > MANY * spacing(pair[1])
    };
    for pair in curve.knots().windows(2).filter(between) {
        let known = curve.rates(pair[0], pair[1]);
        if known.is_none_or(|rates| !is_too_fast::<C>(pair[1], rates.speed)) {
            continue;
        }
        let times = PROBES.map(|u| pair[0] + u * (pair[1] - pair[0]));
        if let Some(t) = times.into_iter().find(|&t| is_too_fast::<C>(t, speed(curve, t) / SURE)) {
            return Err(Stuck(t));
        }
    }
    Ok(())
}

/// An upper bound of how far the curve gets from the last key's value after that key: float32
/// may put it a little before the curve's end.
pub(super) fn beyond<C: Curve>(curve: &C, last: f32, shown: C::Value) -> f64 {
    let knots = curve.knots();
    let (mut from, mut way) = (f64::from(last), 0.0);
    let off = shown.distance(curve.at(from));
    for &to in &knots[knots.partition_point(|&knot| knot <= from)..] {
        way += match curve.rates(from, to) {
            Some(rates) => rates.speed * (to - from),
            None => curve.at(from).distance(curve.at(to)),
        };
        from = to;
    }
    off + way
}

/// Whether so fast a curve goes too far between the float32 numbers at a time.
fn is_too_fast<C: Curve>(t: f64, speed: f64) -> bool {
    speed * spacing(t) > C::Value::LONGEST
}

/// About the speed at a time. Over longer times a curve that spins seems slower than it is.
fn speed(curve: &impl Curve, t: f64) -> f64 {
    let here = curve.at(t);
    let over = |halvings: i32| {
        let later = t + spacing(t) * 0.5f64.powi(halvings);
        here.distance(curve.at(later)) / (later - t)
    };
    (0..=HALVINGS).map(over).fold(0.0, f64::max)
}

/// From a float32 number to the next.
fn spacing(t: f64) -> f64 {
    let t = t as f32;
    f64::from(t.next_up()) - f64::from(t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Arc, Ends, Motion, Scheme};
    use crate::math::{Jet, Quat, Vec3};
    use crate::reduce::{self, Error, Options, Turning};

    fn checked(times: &[f64], scheme: Scheme, angle: f64) -> Result<(), Stuck> {
        let keys: Vec<Quat> =
            (0..times.len()).map(|i| Quat::exp(Vec3::new(0.5 * angle * i as f64, 0.0, 0.0))).collect();
        check(&Turning::new(Motion::new(times, &keys, scheme, Ends::Natural)))
    }

    #[test]
    fn speed_is_found_through_many_turns_a_float() {
        let keys: Vec<Quat> = (0..5).map(|i| Quat::exp(Vec3::new(0.15 * f64::from(i), 0.0, 0.0))).collect();
        let motion = Motion::new(&[0.0, 1e-6, 1e4, 1e4 + 1.0, 2e4], &keys, Scheme::Bessel, Ends::Natural);
        for t in [2500.0, 5000.0] {
            let piece = motion.piece_at(t);
            let exact =
                piece.at(Jet::variable(piece.parameter(t))).half_velocity().length() / piece.duration();
            assert!(exact * spacing(t) > 10.0, "{exact}");
            let found = speed(&Turning::new(motion.clone()), t);
            assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
        }
    }

    #[test]
    fn a_swing_that_floats_cannot_follow_is_refused() {
        // A velocity from 0.3 radians in a microsecond goes on for a year.
        let year = 31_557_600.0;
        let refused = checked(&[0.0, 1e-6, year, year + 64.0, 2.0 * year], Scheme::Bessel, 0.3);
        assert!(matches!(refused, Err(Stuck(t)) if t > 1e-6 && t < year), "{refused:?}");
    }

    #[test]
    fn what_follows_the_last_float_counts() {
        let year = 31_557_600.0;
        let keys: Vec<Quat> = (0..3).map(|i| Quat::exp(Vec3::new(0.4 * f64::from(i), 0.0, 0.0))).collect();
        let times = [0.0, year, year + 0.25];
        let curve = Turning::new(Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural));
        let last = times[2] as f32;
        assert_eq!(f64::from(last), year);
        assert!((beyond(&curve, last, keys[1]) - 0.4).abs() < 1e-12);
        let degree = Options { tolerance: 1.0, reserve: 0.0, max_step: None, on_curve: false };
        assert!(matches!(reduce::rotation(&curve, &degree), Err(Error::Times { time, .. }) if time == year));
        assert!(matches!(reduce::cubic_rotation(&curve, &degree), Err(Error::Times { .. })));
        assert!(beyond(&curve, 1e9, keys[2]) < 1e-15);
    }

    #[test]
    fn what_floats_can_follow_is_not() {
        let year = 31_557_600.0;
        assert_eq!(checked(&[0.0, 1e-6, year, year + 64.0, 2.0 * year], Scheme::Slerp, 0.3), Ok(()));
        assert_eq!(checked(&[0.0, 1e-6, 2e-6, 3e-6], Scheme::Bessel, 1.5), Ok(()));
        assert_eq!(checked(&[0.0, 1.0, 1.5, 2.0, 3.0], Scheme::Bessel, 3.0), Ok(()));
        // Keys that float32 does not tell apart are not for this to judge.
        assert_eq!(checked(&[3_600.0, 3_600.000_001, 3_600.000_002], Scheme::Slerp, 0.3), Ok(()));
    }
}

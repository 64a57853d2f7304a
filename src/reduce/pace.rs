//! Whether float32's times are fine enough for a curve.
//!
//! Playback takes the short way from key to key. Where a curve goes further than the longest
//! such way between one float32 number and the next, no keys can follow it, however many; a
//! search would find out only after all the keys before that.

use super::curve::Curve;
use super::search::Stuck;
use super::value::{Step, Value};

/// Where a stretch between knots is looked at. Speeds of cubics are quadratics.
const PROBES: [f64; 5] = [0.02, 0.25, 0.5, 0.75, 0.98];

/// How often the time between two float32 numbers is halved: as far as float64, with which
/// times are told apart to about 2⁻²⁹ of it, shows differences.
const HALVINGS: i32 = 20;

/// So many float32 numbers.
const MANY: f64 = 100.0;

/// What the speed found at a place may be off, relative to it, and more.
const SURE: f64 = 1.1;

/// What the middle of a turn is off whose ends are off by 1, at most: 1 / cos(π/4), and more.
const MIDDLE: f64 = 1.5;

/// Turns that may be followed, and for each stretch between knots so many besides. Between keys
/// of a motion, half a turn apart at most, there is no reason for more; where they are most
/// uneven in time, some schemes spin on from one to the next.
const TURNS: f64 = 2500.0;
const TURNS_EACH: f64 = 2.5;

/// A curve that spins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spin {
    /// Where the stretch begins that has most of the turns, seconds.
    pub(super) time: f64,
    /// How many would be all right.
    pub(super) turns: f64,
}

/// Refuses a curve that turns so often that to follow it takes a multitude of keys.
pub(super) fn unwound<C: Curve>(curve: &C) -> Result<(), Spin> {
    let (mut all, mut most) = (0.0, (0.0, 0.0));
    for pair in curve.knots().windows(2) {
        let (from, to) = (pair[0], pair[1]);
        // The longest step is just below half a turn.
        let turns = |speed: f64| speed * (to - from) / (2.0 * C::Value::LONGEST);
        // A bound first, which few exceed.
        if curve.rates(from, to).is_none_or(|rates| turns(rates.speed) <= TURNS_EACH) {
            continue;
        }
        let speeds = PROBES.map(|u| speed(curve, from + u * (to - from)));
        let turns = turns(speeds.iter().sum::<f64>() / PROBES.len() as f64);
        all += turns;
        if turns > most.0 {
            most = (turns, from);
        }
    }
    let turns = TURNS + TURNS_EACH * curve.knots().len() as f64;
    if all > turns { Err(Spin { time: most.1, turns }) } else { Ok(()) }
}

/// Refuses a curve that turns too fast somewhere for a tolerance. The ramps of jumps may be as
/// short as they like.
pub(super) fn check<C: Curve>(curve: &C, tolerance: f64) -> Result<(), Stuck> {
    let on_ramp = |pair: &[f64]| {
        let next = curve.ramps().partition_point(|&(_, to)| to < pair[1]);
        curve.ramps().get(next).is_some_and(|&(from, _)| from <= pair[0])
    };
    for pair in curve.knots().windows(2).filter(|pair| !on_ramp(pair)) {
        let (from, to, spacing) = (pair[0], pair[1], spacing(pair[1]));
        let Some(rates) = curve.rates(from, to) else { continue };
        let stuck = if to - from > MANY * spacing {
            let times = PROBES.map(|u| from + u * (to - from));
            let too_fast = |t: &f64| is_too_fast::<C>(*t, speed(curve, *t) / SURE);
            times.into_iter().filter(|_| is_too_fast::<C>(to, rates.speed)).find(too_fast)
        } else {
            let bends = rates.acceleration * spacing * spacing / 8.0 > tolerance;
            floats(from, to).filter(|_| bends).find(|&t| !is_followed(curve, t, tolerance)).map(f64::from)
        };
        if let Some(t) = stuck {
            return Err(Stuck(t));
        }
    }
    let last = curve.knots()[curve.knots().len() - 1] as f32;
    let shown = curve.at(f64::from(last));
    let follows = beyond(curve, last, shown) <= tolerance;
    if follows { Ok(()) } else { Err(Stuck(f64::from(last))) }
}

/// The float32 numbers of a stretch that the next of is on it too.
fn floats(from: f64, to: f64) -> impl Iterator<Item = f32> {
    let first = if f64::from(from as f32) < from { (from as f32).next_up() } else { from as f32 };
    std::iter::successors(Some(first), |t| Some(t.next_up()))
        .take_while(move |t| f64::from(t.next_up()) <= to)
}

/// Whether playback could keep a tolerance from one float32 number to the next, where it has no
/// key in between: at both, and half way.
fn is_followed<C: Curve>(curve: &C, t: f32, tolerance: f64) -> bool {
    let (from, to) = (f64::from(t), f64::from(t.next_up()));
    let start = curve.at(from);
    let step = start.step_to(curve.at(to));
    let off = start.moved(step * 0.5).distance(curve.at(0.5 * (from + to)));
    step.length() <= C::Value::LONGEST && off <= tolerance * (1.0 + MIDDLE)
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

    const DEGREE: f64 = std::f64::consts::PI / 360.0;

    fn checked(times: &[f64], scheme: Scheme, angle: f64) -> Result<(), Stuck> {
        let keys: Vec<Quat> =
            (0..times.len()).map(|i| Quat::exp(Vec3::new(0.5 * angle * i as f64, 0.0, 0.0))).collect();
        check(&Turning::new(Motion::new(times, &keys, scheme, Ends::Natural)), DEGREE)
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
    fn a_swing_of_few_floats_is_refused_before_the_search() {
        // Spins for 40 s, to turn by 2 radians and back within seven float32 numbers.
        let keys = [0.0, 0.0, 1.0, 0.0, 0.0].map(|half| Quat::exp(Vec3::new(half, 0.0, 0.0)));
        let times = [0.0, 40.271, 40.271_013, 40.271_026, 41.0];
        let curve = |scheme| Turning::new(Motion::new(&times, &keys, scheme, Ends::Natural));
        let refused = check(&curve(Scheme::Bessel), DEGREE);
        assert!(matches!(refused, Err(Stuck(t)) if (40.271..40.271_026).contains(&t)), "{refused:?}");
        assert_eq!(check(&curve(Scheme::Bessel), 40.0 * DEGREE), Ok(()));
        // The corner between two float32 numbers is off by less.
        assert_eq!(check(&curve(Scheme::Slerp), 10.0 * DEGREE), Ok(()));
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
        let degree = Options::new(1.0);
        assert!(matches!(reduce::rotation(&curve, &degree), Err(Error::Times { time, .. }) if time == year));
        assert!(matches!(reduce::cubic_rotation(&curve, &degree), Err(Error::Times { .. })));
        assert!(beyond(&curve, 1e9, keys[2]) < 1e-15);
        // What is still up to there is not one key.
        let keys = [keys[0], keys[0], keys[1]];
        let curve = Turning::new(Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural));
        assert!(matches!(reduce::rotation(&curve, &degree), Err(Error::Times { .. })));
        assert!(matches!(reduce::cubic_rotation(&curve, &degree), Err(Error::Times { .. })));
    }

    #[test]
    fn a_curve_that_spins_is_refused() {
        // 300 radians a second, and after half an hour the same again.
        let keys: Vec<Quat> = (0..4).map(|i| Quat::exp(Vec3::new(0.15 * f64::from(i), 0.0, 0.0))).collect();
        let spins = |minutes: f64| {
            let times = [0.0, 1e-3, 60.0 * minutes, 60.0 * minutes + 1e-3];
            let curve = Turning::new(Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural));
            reduce::rotation(&curve, &Options { max_step: Some(18.0), ..Options::new(1.0) })
        };
        let turns = TURNS + 4.0 * TURNS_EACH;
        assert_eq!(spins(30.0).unwrap_err(), Error::Spins { time: 1e-3, turns });
        assert!(spins(0.1).unwrap().times.len() > 500);
    }

    #[test]
    fn what_floats_can_follow_is_not() {
        let year = 31_557_600.0;
        assert_eq!(checked(&[0.0, 1e-6, year, year + 64.0, 2.0 * year], Scheme::Slerp, 0.3), Ok(()));
        assert_eq!(checked(&[0.0, 1e-6, 2e-6, 3e-6], Scheme::Bessel, 1.5), Ok(()));
        assert_eq!(checked(&[0.0, 1.0, 1.5, 2.0, 3.0], Scheme::Bessel, 3.0), Ok(()));
        // At most half a float32 after the last one, a thousandth of a step may follow.
        assert_eq!(checked(&[0.0, 1.0, 3_600.000_1], Scheme::Slerp, 0.3), Ok(()));
    }
}

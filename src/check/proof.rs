//! Whether a channel stays within a limit of a curve at all times: proven, not looked at.
//!
//! Between two keys of the file branch and bound (docs/math/deviation.md) shows that the
//! distance keeps the limit, or finds a time at which it does not.

use crate::asset::play::{Channel, Clip, Interpolation, Keys, Property, at_key};
use crate::asset::{Asset, Error};
use crate::curve::{Motion, Rates};
use crate::math::Quat;
use crate::reduce::{Curve, Flat, Hermite, Numbers, Step, Travelling, Value};
use crate::sample::Travel;
use crate::sample::interlude::{on_stretch, whole};
use crate::sample::worst::{Gap, Part, Worst};
use std::borrow::Cow;

/// What came of the attempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// It stays within the limit.
    Within,
    /// It is so far off at about a time, degrees or units.
    Beyond { off: f64, time: f64 },
    /// Neither could be shown: it may be so far off at about a time.
    Open { bound: f64, time: f64 },
}

/// Whether the rotation of a node stays within `limit` degrees of a motion. None where no
/// channel turns it.
pub(super) fn rotation(
    asset: &mut Asset,
    clip: &Clip,
    node: usize,
    motion: &Motion,
    limit: f64,
) -> Result<Option<Outcome>, Error> {
    let Some(channel) = channel(clip, node, Property::Rotation) else { return Ok(None) };
    let curve = Followed::new(motion);
    // Distances are half angles.
    let half = std::f64::consts::PI / 360.0;
    outcome::<_, 4>(asset, channel, &curve, limit * half, half).map(Some)
}

/// Whether the place of a node stays within `limit` of a way up to `end` seconds.
pub(super) fn translation(
    asset: &mut Asset,
    clip: &Clip,
    node: usize,
    (travel, end): (&dyn Travel, f64),
    limit: f64,
) -> Result<Option<Outcome>, Error> {
    let Some(channel) = channel(clip, node, Property::Translation) else { return Ok(None) };
    let curve = Travelling::new(travel, (0.0, end), travel.jumps());
    outcome::<_, 3>(asset, channel, &curve, limit, 1.0).map(Some)
}

/// A motion whose pieces are worked out when they are asked for: memory does not grow with
/// its keys.
struct Followed<'a> {
    motion: &'a Motion<'a>,
    knots: Cow<'a, [f64]>,
}

impl<'a> Followed<'a> {
    fn new(motion: &'a Motion<'a>) -> Followed<'a> {
        let knots = match motion.ramp() {
            None => Cow::Borrowed(motion.times()),
            Some(ramp) => {
                let mut knots = motion.times().to_vec();
                knots.insert(1, ramp);
                Cow::Owned(knots)
            }
        };
        Followed { motion, knots }
    }
}

impl Curve for Followed<'_> {
    type Value = Quat;

    fn at(&self, t: f64) -> Quat {
        self.motion.at(t)
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn corners(&self) -> &[f64] {
        &[]
    }

    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        let piece = self.motion.piece_at(0.5 * (from + to));
        Some(whole(&piece).and(on_stretch(&piece, from, to)))
    }
}

fn channel(clip: &Clip, node: usize, property: Property) -> Option<&Channel> {
    clip.channels.iter().find(|channel| channel.node == node && channel.property == property)
}

/// Goes through all keys of a channel; `unit` is one of the limit's in the values' distance.
fn outcome<C: Curve<Value: Flat<N>>, const N: usize>(
    asset: &mut Asset,
    channel: &Channel,
    curve: &C,
    limit: f64,
    unit: f64,
) -> Result<Outcome, Error> {
    let knots = curve.knots();
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let mut open = Outcome::Within;
    let mut before: Option<(f64, Vec<f64>)> = None;
    let mut see = |played: Played<C::Value, N>, from: f64, to: f64| {
        let beside = Beside { curve, played, from, to };
        let worst = beside.search(from.max(first), to.min(last), limit);
        if worst.found > limit {
            return Some(Outcome::Beyond { off: worst.found / unit, time: from });
        }
        if worst.bound() > limit {
            open = Outcome::Open { bound: worst.bound() / unit, time: from };
        }
        None
    };
    let mut keys = Keys::new(channel);
    while let Some(block) = keys.next(asset)? {
        for (&time, stored) in block.times.iter().zip(block.values.chunks_exact(channel.stored_width())) {
            let (time, stored) = (f64::from(time), stored.iter().copied().map(f64::from).collect::<Vec<_>>());
            let (played, from) = match &before {
                Some((from, previous)) => (Played::between(channel, previous, &stored, time - from), *from),
                None => (Played::held(channel, &stored), first.min(time)),
            };
            if let Some(beyond) = see(played, from, time) {
                return Ok(beyond);
            }
            before = Some((time, stored));
        }
    }
    if let Some((time, stored)) = before
        && time < last
        && let Some(beyond) = see(Played::held(channel, &stored), time, last)
    {
        return Ok(beyond);
    }
    Ok(open)
}

/// What a player shows from key to key.
enum Played<V: Value, const N: usize> {
    Straight { from: V, way: V::Step },
    Cubic(Hermite<N>),
}

/// N numbers from a place on.
fn numbers<const N: usize>(stored: &[f64], from: usize) -> Numbers<N> {
    Numbers(std::array::from_fn(|i| stored.get(from + i).copied().unwrap_or(f64::NAN)))
}

impl<V: Flat<N>, const N: usize> Played<V, N> {
    fn held(channel: &Channel, stored: &[f64]) -> Self {
        let from = V::shown(numbers(at_key(channel, stored), 0));
        Played::Straight { from, way: V::Step::ZERO }
    }

    fn between(channel: &Channel, from: &[f64], to: &[f64], h: f64) -> Self {
        match channel.interpolation {
            Interpolation::Step => Self::held(channel, from),
            Interpolation::Linear => {
                let (from, to) = (V::shown(numbers(from, 0)), V::shown(numbers(to, 0)));
                Played::Straight { from, way: from.step_to(to) }
            }
            Interpolation::CubicSpline => Played::Cubic(Hermite {
                ends: [numbers(from, N), numbers(to, N)],
                slopes: [numbers::<N>(from, 2 * N) * h, numbers::<N>(to, 0) * h],
            }),
        }
    }
}

/// Playback from key to key beside the curve.
struct Beside<'a, C: Curve, const N: usize> {
    curve: &'a C,
    played: Played<C::Value, N>,
    from: f64,
    to: f64,
}

impl<C: Curve<Value: Flat<N>>, const N: usize> Beside<'_, C, N> {
    /// Proves the limit between two times, each part between knots by itself.
    fn search(&self, from: f64, to: f64, limit: f64) -> Worst {
        let mut worst = Worst::proving(limit);
        if from >= to {
            return worst;
        }
        let knots = self.curve.knots();
        let inside = &knots[knots.partition_point(|&knot| knot <= from)..];
        let ends = inside.iter().copied().take_while(|&knot| knot < to).chain([to]);
        let (mut from, mut at_from) = (from, self.at(from));
        for to in ends {
            let at_to = self.at(to);
            worst.note(at_from.max(at_to));
            let part = Part { from, to, at_from, at_to };
            worst.search(self, part, Gap::rates(self, from, to), 0);
            (from, at_from) = (to, at_to);
        }
        worst
    }

    fn place(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }
}

impl<C: Curve<Value: Flat<N>>, const N: usize> Gap for Beside<'_, C, N> {
    fn at(&self, t: f64) -> f64 {
        let shown = match &self.played {
            Played::Straight { from, way } => from.moved(*way * self.place(t)),
            Played::Cubic(cubic) => C::Value::shown(cubic.at(self.place(t))),
        };
        let off = shown.distance(self.curve.at(t));
        // What is no number is as far as can be.
        if off.is_nan() { f64::INFINITY } else { off }
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        let unknown = Rates { speed: f64::INFINITY, acceleration: f64::INFINITY };
        self.curve.rates(from, to).unwrap_or(unknown)
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        let by_place = match &self.played {
            Played::Straight { way, .. } => Rates { speed: way.length(), acceleration: 0.0 },
            Played::Cubic(cubic) => cubic.rates::<C::Value>(self.place(part.from), self.place(part.to)),
        };
        let own = by_place.per_second(self.to - self.from);
        let sum = Rates { acceleration: rates.acceleration + own.acceleration, ..rates };
        C::Value::bound(sum, part.to - part.from, (part.at_from, part.at_to), own.speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::tests::animated;
    use crate::curve::{Ends, Scheme};
    use crate::math::Vec3;

    fn proven(interpolation: &str, values: &[f32], motion: &Motion, limit: f64) -> Outcome {
        let times: Vec<f32> = motion.times().iter().map(|&t| t as f32).collect();
        let mut asset = animated("rotation", interpolation, &times, values);
        let clip = asset.clips().remove(0);
        rotation(&mut asset, &clip, 0, motion, limit).unwrap().unwrap()
    }

    #[test]
    fn a_crest_between_the_places_that_are_looked_at_is_found() {
        // About x by twice the arc tangent of k u(u − ½)(u − 1), beside a motion that rests:
        // a crest at u = ½ − √3/6 is 2.6 % above what shows at a quarter.
        let k = 0.02f32;
        let key = |out: f32| [[out, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [out, 0.0, 0.0, 0.0]].concat();
        let values = [key(0.5 * k), key(0.5 * k)].concat();
        let motion = Motion::new(&[0.0, 1.0], &[Quat::IDENTITY; 2], Scheme::Slerp, Ends::Natural);
        let crest = 2.0 * (f64::from(k) * 3f64.sqrt() / 36.0).atan().to_degrees();
        assert_eq!(proven("CUBICSPLINE", &values, &motion, 1.0001 * crest), Outcome::Within);
        let Outcome::Beyond { off, .. } = proven("CUBICSPLINE", &values, &motion, 0.98 * crest) else {
            panic!("within")
        };
        assert!(off > 0.98 * crest && off <= crest * (1.0 + 1e-9), "{off} {crest}");
    }

    #[test]
    fn straight_turns_and_held_poses_are_proven_and_refuted() {
        let turn = |x: f64, y: f64| Quat::exp(Vec3::new(x, y, 0.0));
        let (times, keys) = ([0.0, 1.0, 2.5], [turn(0.0, 0.0), turn(0.4, 0.1), turn(0.3, 0.6)]);
        let motion = Motion::new(&times, &keys, Scheme::Bessel, Ends::Natural);
        let values: Vec<f32> = keys.iter().flat_map(|q| q.to_xyzw()).map(|x| x as f32).collect();
        for (interpolation, held) in [("LINEAR", false), ("STEP", true)] {
            let mut worst: f64 = 0.0;
            for i in 0..=20_000 {
                let t = 2.5 * f64::from(i) / 20_000.0;
                let k = usize::from(t >= 1.0);
                let u = if held { 0.0 } else { (t - times[k]) / (times[k + 1] - times[k]) };
                let played = glam::DQuat::from(keys[k]).slerp(keys[k + 1].into(), u);
                worst = worst.max(Quat::from(played).angle_to(motion.at(t)).to_degrees());
            }
            // Seen 20,000 times the crest is missed by 1e-7 of itself, the step at the last
            // key by the turn of 1e-4 s; float32 adds 1e-5°.
            let slack = 2e-5 + if held { 1e-3 * worst } else { 1e-6 * worst };
            assert_eq!(proven(interpolation, &values, &motion, worst + slack), Outcome::Within);
            let found = proven(interpolation, &values, &motion, worst - slack);
            assert!(matches!(found, Outcome::Beyond { .. }), "{found:?}");
        }
    }

    #[test]
    fn a_long_way_from_a_pose_is_proven_closely() {
        // A pose that is held while the motion turns by so much.
        for degrees in [60.0, 119.0, 150.0, 179.0] {
            let turned = Quat::exp(Vec3::new(f64::to_radians(0.5 * degrees), 0.0, 0.0));
            let keys = [Quat::IDENTITY, turned];
            let motion = Motion::new(&[0.0, 1.0], &keys, Scheme::Slerp, Ends::Natural);
            let values: Vec<f32> = keys.iter().flat_map(|q| q.to_xyzw()).map(|x| x as f32).collect();
            assert_eq!(proven("STEP", &values, &motion, degrees + 1e-3), Outcome::Within, "{degrees}");
            let beyond = proven("STEP", &values, &motion, degrees - 1e-3);
            assert!(matches!(beyond, Outcome::Beyond { .. }), "{degrees}: {beyond:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_beyond() {
        let motion = Motion::new(&[0.0, 1.0], &[Quat::IDENTITY; 2], Scheme::Slerp, Ends::Natural);
        let values = [0.0, 0.0, 0.0, 1.0, f32::NAN, 0.0, 0.0, 1.0];
        assert!(matches!(proven("LINEAR", &values, &motion, 10.0), Outcome::Beyond { .. }));
    }
}

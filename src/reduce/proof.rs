//! The proof that the keys that were found keep the tolerance.
//!
//! The search looks at samples. Here every interval is bounded from the written
//! numbers, by branch and bound with the curve's own rates; one whose bound exceeds the
//! tolerance gets a key on the curve in its middle. Of a curve without known rates the
//! largest distance is measured.

use super::curve::Curve;
use super::pace;
use super::reach::Key;
use super::search::Stuck;
use super::value::{OtherBlend, Step, Value};
use crate::curve::Rates;
use crate::sample::worst::{Gap, Part, Worst};
use rayon::prelude::*;

/// Keys that keep the tolerance, with what is known of their playback; in the units of
/// [`Value::distance`].
pub(super) struct Proven<V: Value> {
    pub(super) keys: Vec<Key<V>>,
    /// No distance is larger.
    pub(super) deviation: f64,
    /// The same for players that blend otherwise.
    pub(super) other: f64,
    /// The largest distance at a knot.
    pub(super) moved: f64,
}

/// Where an interval is probed before anything is bounded.
const PROBES: [f64; 3] = [0.21, 0.5, 0.79];

/// Intervals that are proven one after the other, blocks of them side by side.
const BLOCK: usize = 256;
/// How many times as many keys are given up on: the curve's rates are known too badly.
const MORE: usize = 4;
/// How often an interval between two keys is halved at most.
const HALVINGS: u32 = 8;

/// Proves that playback of the keys stays within `tolerance` of the curve, or makes it
/// so; `negligible` distances are not refined.
pub(super) fn prove<C: Curve>(
    curve: &C,
    keys: &[Key<C::Value>],
    tolerance: f64,
    negligible: f64,
) -> Result<Proven<C::Value>, Stuck> {
    let worst = Worst::new(negligible);
    let mut proof = Proof {
        curve,
        tolerance,
        linear: worst,
        other: worst,
        uneven: 0.0,
        moved: 0.0,
        proven: vec![keys[0]],
    };
    keys.windows(2).for_each(|pair| proof.probe(&Interval { curve, a: pair[0], b: pair[1] }));
    let blocks = (0..keys.len() - 1).into_par_iter().step_by(BLOCK);
    let begin = |start| Proof { proven: Vec::with_capacity(BLOCK), ..proof }.block(keys, start);
    let parts: Vec<_> = blocks.map(begin).collect();
    for part in parts {
        proof.add(part?);
    }
    let last = keys[keys.len() - 1];
    let beyond = pace::beyond(curve, last.time, last.value);
    if beyond > tolerance {
        return Err(Stuck(f64::from(last.time)));
    }
    Ok(Proven {
        keys: proof.proven,
        deviation: (proof.linear.bound() + proof.uneven).min(tolerance).max(beyond),
        other: (proof.other.bound() + proof.uneven).max(beyond),
        moved: proof.moved,
    })
}

/// A bound of the distance of a curve from one value, or none if it exceeds `tolerance`.
pub(super) fn held<C: Curve>(curve: &C, key: Key<C::Value>, end: f32, tolerance: f64) -> Option<f64> {
    let interval = Interval { curve, a: key, b: Key { time: end, ..key } };
    let mut worst = Worst::new(0.1 * tolerance).one_more(tolerance);
    interval.parts(|part, rates| bound_part(&mut worst, &interval.linear(), part, rates));
    (worst.bound() <= tolerance).then(|| worst.bound())
}

struct Proof<'a, C: Curve> {
    curve: &'a C,
    tolerance: f64,
    linear: Worst,
    other: Worst,
    /// What players differ by at most over keys whose lengths are not quite one.
    uneven: f64,
    moved: f64,
    proven: Vec<Key<C::Value>>,
}

impl<C: Curve> Proof<'_, C> {
    /// Looks for the worst first: what is bounded need not be bounded closer than that.
    fn probe(&mut self, interval: &Interval<C>) {
        let (from, to) = interval.times();
        for u in PROBES {
            let t = from + u * (to - from);
            let linear = interval.linear().at(t);
            if linear <= self.tolerance {
                self.linear.note(linear);
            }
            if let Some(blend) = C::Value::other_blend() {
                self.other.note(interval.blended(blend).at(t));
            }
        }
    }

    /// Takes what became of a part of the intervals.
    fn add(&mut self, part: Self) {
        self.linear.add(&part.linear);
        self.other.add(&part.other);
        self.uneven = self.uneven.max(part.uneven);
        self.moved = self.moved.max(part.moved);
        self.proven.extend(part.proven);
    }

    /// Bounds the block of intervals that starts with a key.
    fn block(mut self, keys: &[Key<C::Value>], start: usize) -> Result<Self, Stuck> {
        for pair in keys[start..].windows(2).take(BLOCK) {
            self.interval(pair[0], pair[1], HALVINGS)?;
            if self.proven.len() > MORE * BLOCK.min(keys.len()) {
                return Err(Stuck(f64::from(pair[0].time)));
            }
        }
        Ok(self)
    }

    /// Bounds an interval, or halves it as long as its bound is too large.
    fn interval(&mut self, a: Key<C::Value>, b: Key<C::Value>, halvings: u32) -> Result<(), Stuck> {
        let interval = Interval { curve: self.curve, a, b };
        let mut parts = Vec::new();
        let way = a.value.distance(b.value);
        let uneven = C::Value::uneven_lengths(way);
        let limit = self.tolerance - uneven;
        let mut linear = self.linear.one_more(limit);
        interval.parts(|part, rates| {
            bound_part(&mut linear, &interval.linear(), part, rates);
            parts.push((part, rates));
        });
        if linear.bound() > limit {
            let middle = a.time + 0.5 * (b.time - a.time);
            if middle <= a.time || middle >= b.time || halvings == 0 {
                return Err(Stuck(f64::from(a.time)));
            }
            let middle = Key::new(middle, self.curve.at(f64::from(middle)));
            self.interval(a, middle, halvings - 1)?;
            return self.interval(middle, b, halvings - 1);
        }
        self.linear.add(&linear);
        self.uneven = self.uneven.max(uneven);
        self.moved = parts[1..].iter().map(|(part, _)| part.at_from).fold(self.moved, f64::max);
        if self.curve.knots().binary_search_by(|knot| knot.total_cmp(&f64::from(a.time))).is_ok() {
            self.moved = self.moved.max(parts[0].0.at_from);
        }
        if let Some(blend) = C::Value::other_blend() {
            let gap = interval.blended(blend);
            let near = linear.bound() + (blend.drift)(way);
            if self.other.accepts(near) {
                self.other.settle(near);
                parts.clear();
            }
            for (part, rates) in parts {
                let part = Part { at_from: gap.at(part.from), at_to: gap.at(part.to), ..part };
                bound_part(&mut self.other, &gap, part, rates);
            }
        }
        self.proven.push(b);
        Ok(())
    }
}

/// Bounds a gap on a part that no knot divides, or measures it where no rates are known.
pub(super) fn bound_part(worst: &mut Worst, gap: &impl Gap, part: Part, rates: Option<Rates>) {
    worst.note(part.at_from.max(part.at_to));
    match rates {
        Some(rates) => {
            worst.search(gap, part, rates, 0);
        }
        None => worst.note(measured(gap, &part)),
    }
}

/// How often a part is looked at that nothing is known of.
const LOOKS: u32 = 48;

/// The largest of many distances, and of the crest of the parabola through the largest
/// and its neighbours.
fn measured(gap: &impl Gap, part: &Part) -> f64 {
    let h = (part.to - part.from) / f64::from(LOOKS);
    let at: Vec<f64> = (0..=LOOKS).map(|i| gap.at(part.from + f64::from(i) * h)).collect();
    let crest = |w: &[f64]| {
        let fall = 2.0 * w[1] - w[0] - w[2];
        let top = w[1] >= w[0] && w[1] >= w[2] && fall > 0.0;
        if top { w[1] + (w[2] - w[0]) * (w[2] - w[0]) / (8.0 * fall) } else { w[1] }
    };
    at.windows(3).map(crest).fold(at[0].max(at[LOOKS as usize]), f64::max)
}

/// Playback between two keys beside the curve.
struct Interval<'a, C: Curve> {
    curve: &'a C,
    a: Key<C::Value>,
    b: Key<C::Value>,
}

impl<C: Curve> Interval<'_, C> {
    fn times(&self) -> (f64, f64) {
        (f64::from(self.a.time), f64::from(self.b.time))
    }

    fn linear(&self) -> Linear<'_, C> {
        let way = self.a.value.step_to(self.b.value);
        let speed = way.length() / (self.times().1 - self.times().0);
        Linear { interval: self, way, speed }
    }

    fn blended(&self, blend: OtherBlend<C::Value>) -> Blended<'_, C> {
        Blended { interval: self, blend, way: self.a.value.distance(self.b.value) }
    }

    /// Hands on the parts between knots, each with the curve's rates.
    fn parts(&self, mut part: impl FnMut(Part, Option<Rates>)) {
        let (start, end) = self.times();
        let gap = self.linear();
        let knots = self.curve.knots();
        let inside = &knots[knots.partition_point(|&knot| knot <= start)..];
        let inside = inside.iter().copied().take_while(|&knot| knot < end);
        let (mut from, mut at_from) = (start, gap.at(start));
        for to in inside.chain([end]) {
            let at_to = gap.at(to);
            part(Part { from, to, at_from, at_to }, self.curve.rates(from, to));
            (from, at_from) = (to, at_to);
        }
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        let unknown = Rates { speed: f64::INFINITY, acceleration: f64::INFINITY };
        self.curve.rates(from, to).unwrap_or(unknown)
    }
}

/// The distance of LINEAR playback from the curve.
struct Linear<'a, C: Curve> {
    interval: &'a Interval<'a, C>,
    way: <C::Value as Value>::Step,
    speed: f64,
}

impl<C: Curve> Gap for Linear<'_, C> {
    fn at(&self, t: f64) -> f64 {
        let (from, to) = self.interval.times();
        let played = self.interval.a.value.moved(self.way * ((t - from) / (to - from)));
        played.distance(self.interval.curve.at(t))
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        self.interval.rates(from, to)
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        C::Value::bound(rates, part.to - part.from, (part.at_from, part.at_to), self.speed)
    }
}

/// The distance of another playback from the curve.
struct Blended<'a, C: Curve> {
    interval: &'a Interval<'a, C>,
    blend: OtherBlend<C::Value>,
    way: f64,
}

impl<C: Curve> Gap for Blended<'_, C> {
    fn at(&self, t: f64) -> f64 {
        let (from, to) = self.interval.times();
        let (a, b) = (self.interval.a.value, self.interval.b.value);
        (self.blend.between)(a, b, (t - from) / (to - from)).distance(self.interval.curve.at(t))
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        self.interval.rates(from, to)
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        let (from, to) = self.interval.times();
        let place = |t: f64| (t - from) / (to - from);
        let own = (self.blend.rates)(self.way, place(part.from), place(part.to)).per_second(to - from);
        let sum = Rates { acceleration: rates.acceleration + own.acceleration, ..rates };
        C::Value::bound(sum, part.to - part.from, (part.at_from, part.at_to), own.speed)
    }
}

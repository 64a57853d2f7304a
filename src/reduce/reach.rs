//! How far one interval can reach from a key, and where it may end.
//!
//! Seen from the key, along the lines that playback takes, the curve is a vector y(τ),
//! τ seconds later, and playback the straight way τw. It stays within the tolerance ε
//! where w lies in every ball around y(τ)/τ of radius ε/τ. So an interval with a free
//! end reaches exactly as far as these balls have a point in common; the further, the
//! more of them there are.

use super::curve::Curve;
use super::value::{Step, Value};
use std::cell::RefCell;

/// Samples that a first guess of the reach is divided into.
const SAMPLES: f64 = 20.0;
/// With fewer up to the reach, it is sampled again.
const FEW: usize = 12;
/// With more, the rest is sampled half as densely.
const MANY: usize = 48;
/// How often the reach is halved between two samples.
const HALVINGS: usize = 5;
/// Moves towards the common point of the balls.
const MOVES: usize = 20;
/// How far within a ball such a move goes.
const INWARD: f64 = 0.997;
/// The part of the tolerance that is aimed at: peaks between samples are missed.
const AIM: f64 = 0.996;
/// The part within which the numbers that are written must be found.
const CHECK: f64 = 0.999;

/// What holds for every interval, in the units of [`Value::distance`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) tolerance: f64,
    /// The longest way from key to key.
    pub(super) step: f64,
    /// What rounding may add to it.
    pub(super) step_slack: f64,
    pub(super) on_curve: bool,
    /// Several ends are looked for, not only the furthest.
    pub(super) several: bool,
}

/// A key as it is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key<V: Value> {
    pub(super) time: f32,
    pub(super) stored: V::Stored,
    /// What a player makes of it.
    pub(super) value: V,
}

impl<V: Value> Key<V> {
    pub(super) fn new(time: f32, value: V) -> Key<V> {
        let stored = value.stored();
        Key { time, stored, value: V::read(stored) }
    }
}

/// A curve whose last values are remembered: the states of a round look at the same times.
pub(super) struct Remembered<'a, C: Curve> {
    pub(super) curve: &'a C,
    values: RefCell<Vec<Place<C::Value>>>,
}

/// A time with the value there, once there is one.
type Place<V> = Option<(f64, V)>;

impl<'a, C: Curve> Remembered<'a, C> {
    const PLACES: usize = 512;

    pub(super) fn new(curve: &'a C) -> Remembered<'a, C> {
        Remembered { curve, values: RefCell::new(vec![None; Self::PLACES]) }
    }

    pub(super) fn at(&self, t: f64) -> C::Value {
        // Fibonacci hashing: the high bits of the product depend on all bits of the time.
        let hash = t.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
        let place = &mut self.values.borrow_mut()[hash as usize % Self::PLACES];
        match place {
            Some((time, value)) if *time == t => *value,
            _ => place.insert((t, self.curve.at(t))).1,
        }
    }
}

/// The curve ahead of a key.
pub(super) struct Ahead<'a, C: Curve> {
    curve: &'a Remembered<'a, C>,
    limits: Limits,
    key: Key<C::Value>,
    start: f64,
    /// How far the key is off the curve.
    off: f64,
    /// The next key that must be, and whether it is the last of all.
    stop: (f32, bool),
    /// τ and y as far as one interval serves.
    samples: Vec<(f64, StepOf<C>)>,
    /// A common point of the balls.
    aim: StepOf<C>,
    /// τ of the furthest free end.
    furthest: f64,
    /// The whole way to the stop is served.
    closes: bool,
    /// On the curve: where the interval may end.
    on_curve: Vec<Key<C::Value>>,
}

type StepOf<C> = <<C as Curve>::Value as Value>::Step;

impl<'a, C: Curve> Ahead<'a, C> {
    /// Looks ahead of a key to the next one that must be; `guess` is about how long an
    /// interval lasts, seconds.
    pub(super) fn new(
        curve: &'a Remembered<'a, C>,
        limits: Limits,
        key: Key<C::Value>,
        stop: (f32, bool),
        guess: f64,
    ) -> Ahead<'a, C> {
        let start = f64::from(key.time);
        let samples = Vec::with_capacity(MANY);
        let mut ahead = Ahead {
            curve,
            limits,
            key,
            start,
            off: key.value.distance(curve.at(start)),
            stop,
            samples,
            aim: StepOf::<C>::ZERO,
            furthest: 0.0,
            closes: false,
            on_curve: Vec::new(),
        };
        ahead.look(guess);
        if limits.on_curve {
            ahead.on_curve = ahead.possible_ends();
        }
        ahead
    }

    fn whole(&self) -> f64 {
        f64::from(self.stop.0) - self.start
    }

    /// The tolerance less what float32 will do to the end.
    fn aimed(&self) -> f64 {
        (AIM * self.limits.tolerance - 0.5 * self.key.value.rounding()).max(0.5 * self.limits.tolerance)
    }

    fn seen(&self, tau: f64) -> StepOf<C> {
        self.key.value.step_to(self.curve.at(self.start + tau))
    }

    fn look(&mut self, guess: f64) {
        let mut h = guess.min(self.whole()) / SAMPLES;
        let least = f64::from(self.key.time.next_up()) - self.start;
        loop {
            let unseen = self.sample(h);
            let Some(unseen) = unseen else {
                self.closes = true;
                self.furthest = self.whole();
                return;
            };
            if self.samples.len() >= FEW || h < least {
                self.refine(unseen);
                return;
            }
            h = unseen / SAMPLES;
        }
    }

    /// Samples at grid times and at knots as far as one interval serves; returns the time
    /// that it does not serve, or none if it serves all. Grids of several keys coincide:
    /// they are multiples of a spacing of which there are two to an octave.
    fn sample(&mut self, spacing: f64) -> Option<f64> {
        self.samples.clear();
        let mut h = libm::exp2(0.5 * (2.0 * libm::log2(spacing)).floor());
        let knots = self.curve.curve.knots();
        let mut knots = knots[knots.partition_point(|&knot| knot <= self.start)..].iter().peekable();
        let (stop, mut t) = (f64::from(self.stop.0), self.start);
        while t < stop {
            let next = ((t / h + 0.1).floor() + 1.0) * h;
            let grid = if next + 0.5 * h > stop { stop } else { next };
            let next = knots.next_if(|&&knot| knot <= grid).map_or(grid, |knot| knot.min(stop));
            if next <= t {
                continue;
            }
            // Beyond the longest step there is nothing to see.
            if !self.push(next) || self.is_stepped_over() {
                return Some(next - self.start);
            }
            t = next;
            if self.samples.len().is_multiple_of(MANY) {
                h *= 2.0;
            }
        }
        None
    }

    /// Whether the last sample is further off than a step may be.
    fn is_stepped_over(&self) -> bool {
        let longest = self.limits.step + self.limits.step_slack;
        self.samples.last().is_some_and(|(_, y)| y.length() > longest)
    }

    /// Takes one more sample if one interval can serve it too.
    fn push(&mut self, t: f64) -> bool {
        let (tau, y) = (t - self.start, self.key.value.step_to(self.curve.at(t)));
        if y.length() > C::Value::LONGEST {
            return false;
        }
        if self.samples.is_empty() {
            self.aim = y * (1.0 / tau);
        }
        self.samples.push((tau, y));
        let off = y - self.aim * tau;
        if off.dot(off) <= self.aimed() * self.aimed() {
            return true; // along a straight stretch the others need not be asked again
        }
        let fitted = self.fit(self.aim, self.samples.len());
        match fitted {
            Some(aim) => self.aim = aim,
            None => {
                self.samples.pop();
            }
        }
        fitted.is_some()
    }

    /// The furthest end between the last sample and one that is too far.
    fn refine(&mut self, unseen: f64) {
        let (mut good, mut bad) = (self.samples.last().map_or(0.0, |sample| sample.0), unseen);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            if middle > good && self.push(self.start + middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        // As its sample has it: a sum and a difference may round.
        self.furthest = self.samples.last().map_or(0.0, |sample| sample.0);
    }

    /// A point common to the balls of the first samples, from a point near it.
    fn fit(&self, mut aim: StepOf<C>, count: usize) -> Option<StepOf<C>> {
        let tolerance = self.aimed();
        for _ in 0..MOVES {
            let mut worst = (tolerance * tolerance, None);
            for &(tau, y) in &self.samples[..count] {
                let off = y - aim * tau;
                let square = off.dot(off);
                if square > worst.0 {
                    worst = (square, Some((tau, off)));
                }
            }
            let Some((tau, off)) = worst.1 else { return Some(aim) };
            aim = aim + off * ((1.0 - INWARD * tolerance / worst.0.sqrt()) / tau);
        }
        None
    }

    /// When the furthest end is.
    pub(super) fn reach(&self) -> f64 {
        let furthest = self.start + self.furthest.min(self.stepped());
        self.on_curve.first().map_or(furthest, |key| f64::from(key.time))
    }

    /// When the curve is a step away, about; with the last sample at the latest.
    fn stepped(&self) -> f64 {
        let step = self.limits.step;
        let mut before = (0.0, 0.0);
        for &(tau, y) in &self.samples {
            let way = y.length();
            if way > step {
                return before.0 + (tau - before.0) * ((step - before.1) / (way - before.1)).clamp(0.0, 1.0);
            }
            before = (tau, way);
        }
        before.0
    }

    pub(super) fn key(&self) -> &Key<C::Value> {
        &self.key
    }

    /// A key at a time, if the interval up to it keeps the tolerance and the step.
    fn accept(&self, time: f32, value: C::Value) -> Option<Key<C::Value>> {
        let key = Key::new(time, value);
        let way = self.key.value.step_to(key.value);
        let short = way.length() <= self.limits.step + self.limits.step_slack;
        (short && self.serves(&key)).then_some(key)
    }

    /// Whether playback up to a key keeps the tolerance at the key and at the samples
    /// before it, and at the peaks between samples that their neighbours suggest.
    fn serves(&self, key: &Key<C::Value>) -> bool {
        let tau = f64::from(key.time) - self.start;
        let way = self.key.value.step_to(key.value);
        let limit = CHECK * self.limits.tolerance - C::Value::uneven_lengths(way.length());
        let (length, aim, along) = (way.length(), way * (1.0 / tau), direction(way));
        let off = |&(t, y): &(f64, StepOf<C>)| {
            let off = y - aim * t;
            let forward = off.dot(along);
            let across = C::Value::across(length * t / tau);
            (forward * forward + (off.dot(off) - forward * forward) * across * across).max(0.0).sqrt()
        };
        let samples = &self.samples[..self.samples.partition_point(|sample| sample.0 < tau)];
        // What fails mostly fails about half way.
        let middle = samples.get(samples.len() / 2);
        if middle.is_some_and(|sample| off(sample) > limit)
            || key.value.distance(self.curve.at(f64::from(key.time))) > limit
        {
            return false;
        }
        let mut before = [(f64::NEG_INFINITY, 0.0), (0.0, self.off)];
        samples.iter().all(|sample| {
            let now = (sample.0, off(sample));
            let crest = crest(before[0], before[1], now);
            before = [before[1], now];
            now.1.max(crest) <= limit
        })
    }

    /// The keys at which the interval may end, the most promising first.
    pub(super) fn ends(&self) -> Vec<Key<C::Value>> {
        if self.limits.on_curve { self.on_curve.clone() } else { self.possible_ends() }
    }

    fn possible_ends(&self) -> Vec<Key<C::Value>> {
        if self.closes {
            let there = self.curve.at(f64::from(self.stop.0));
            let exact = Key::new(self.stop.0, there);
            let ends = if self.serves(&exact) { self.straight(&exact) } else { Vec::new() };
            if !ends.is_empty() {
                return ends;
            }
        }
        let mut ends = if self.limits.on_curve { self.ends_on_curve() } else { self.ends_off_curve() };
        if ends.is_empty() {
            ends.extend(self.nearest());
        }
        ends
    }

    /// Ends of a stretch that one turn serves up to the stop: the stop itself, or equal
    /// steps up to it.
    fn straight(&self, exact: &Key<C::Value>) -> Vec<Key<C::Value>> {
        let way = self.key.value.step_to(exact.value);
        let steps = (way.length() / (self.limits.step + self.limits.step_slack)).ceil();
        if steps <= 1.0 {
            let mut ends = vec![*exact];
            if !self.limits.on_curve && !self.stop.1 {
                ends.extend(self.ends_at_stop());
            }
            return ends;
        }
        let time = (self.start + self.whole() / steps) as f32;
        let u = (f64::from(time) - self.start) / self.whole();
        let on_curve = self.accept(time, self.curve.at(f64::from(time)));
        let on_line = self.accept(time, self.key.value.moved(way * u)).filter(|_| !self.limits.on_curve);
        on_curve.or(on_line).into_iter().collect()
    }

    /// Ends off the curve at a stop that is no end: outwards from how the curve bends
    /// after it and before it.
    fn ends_at_stop(&self) -> Vec<Key<C::Value>> {
        let t = f64::from(self.stop.0);
        let delta = 0.25 * self.furthest;
        let there = self.curve.at(t);
        let step = |k: f64| there.step_to(self.curve.at(t + k * delta));
        let after = direction(step(2.0) - step(1.0) * 2.0);
        let before = direction(step(-2.0) - step(-1.0) * 2.0);
        let both = direction(after + before);
        let outward = |bend: StepOf<C>| there.moved(bend * -self.aimed());
        [after, before, both]
            .into_iter()
            .filter_map(|bend| self.end_near(self.stop.0, outward(bend)))
            .collect()
    }

    /// Ends on the curve: the furthest, and some before it.
    fn ends_on_curve(&self) -> Vec<Key<C::Value>> {
        let on_curve = |tau: f64| {
            let time = (self.start + tau) as f32;
            (time > self.key.time).then(|| self.accept(time, self.curve.at(f64::from(time))))?
        };
        let last = self.samples.iter().rposition(|sample| on_curve(sample.0).is_some());
        let next = last.map_or(0, |last| last + 1);
        let mut good = last.map_or(0.0, |last| self.samples[last].0);
        let mut bad = self.samples.get(next).map_or(good, |sample| sample.0);
        // A curve that turns steadily is a step away at:
        for tau in [good, bad] {
            let stepped = tau * self.limits.step / self.seen(tau).length();
            if good < stepped && stepped < bad && on_curve(stepped).is_some() {
                good = stepped;
            }
        }
        for _ in 0..10 {
            let middle = 0.5 * (good + bad);
            if on_curve(middle).is_some() { good = middle } else { bad = middle }
        }
        const SHARES: [f64; 8] = [1.0, 0.99, 0.975, 0.95, 0.92, 0.88, 0.8, 0.65];
        let ends = SHARES.iter().filter_map(|share| on_curve(share * good));
        ends.take(if self.limits.several { SHARES.len() } else { 1 }).collect()
    }

    /// Ends off the curve: the furthest, and some before it, outwards from how the curve
    /// bends there.
    fn ends_off_curve(&self) -> Vec<Key<C::Value>> {
        if self.closes && !self.stop.1 {
            let free = self.start + self.whole();
            let mut ends: Vec<_> =
                self.accept(free as f32, self.key.value.moved(self.aim * self.whole())).into_iter().collect();
            ends.extend(self.ends_at_stop());
            if !ends.is_empty() {
                return ends;
            }
        }
        let cap = self.limits.step / self.aim.length();
        let furthest = self.furthest.min(cap);
        // Where the step is what limits, offsets only lengthen the way.
        let mut ends = if self.stepped() < self.furthest { self.ends_on_curve() } else { Vec::new() };
        for share in [1.0, 0.985, 0.96, 0.92, 0.85] {
            if !self.limits.several && !ends.is_empty() {
                break;
            }
            let time = (self.start + share * furthest) as f32;
            if time <= self.key.time || time >= self.stop.0 {
                continue;
            }
            let tau = f64::from(time) - self.start;
            if share > 0.98 {
                ends.extend(self.accept(time, self.key.value.moved(self.aim * tau)));
            }
            let (there, bend) = self.bend(f64::from(time));
            ends.extend(self.end_near(time, there.moved(bend * -self.aimed())));
            if share < 0.97 {
                ends.extend(self.end_near(time, there));
            }
        }
        ends
    }

    /// The curve at a time, and the direction in which it bends there.
    fn bend(&self, t: f64) -> (C::Value, StepOf<C>) {
        let delta = 0.25 * self.furthest;
        let there = self.curve.at(t);
        let step = |t: f64| there.step_to(self.curve.at(t));
        (there, direction(step(t - delta) + step(t + delta)))
    }

    /// An end at a time, as near a value as the tolerance lets it.
    fn end_near(&self, time: f32, value: C::Value) -> Option<Key<C::Value>> {
        let tau = f64::from(time) - self.start;
        let count = self.samples.partition_point(|sample| sample.0 <= tau);
        let wish = self.key.value.step_to(value) * (1.0 / tau);
        let aim = self.fit(wish, count)?;
        self.accept(time, self.key.value.moved(aim * tau))
    }

    /// The furthest end on the curve that halving the way finds, when all else failed.
    fn nearest(&self) -> Option<Key<C::Value>> {
        let mut tau = self.furthest.min(self.whole());
        loop {
            let time = ((self.start + tau) as f32).min(self.stop.0);
            let time = if time <= self.key.time { self.key.time.next_up() } else { time };
            let key = self.accept(time, self.curve.at(f64::from(time)));
            if key.is_some() || time == self.key.time.next_up() {
                return key;
            }
            tau *= 0.5;
        }
    }
}

/// The crest of the parabola through three points, if the middle one is the highest and
/// they are evenly spaced.
fn crest(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> f64 {
    let even = ((b.0 - a.0) - (c.0 - b.0)).abs() < 1e-6 * (c.0 - a.0);
    let fall = 2.0 * b.1 - a.1 - c.1;
    if !even || b.1 < a.1 || b.1 < c.1 || fall <= 0.0 {
        return 0.0;
    }
    b.1 + (c.1 - a.1) * (c.1 - a.1) / (8.0 * fall)
}

/// The unit vector along another; zero for zero.
fn direction<S: Step>(v: S) -> S {
    let length = v.length();
    if length > 0.0 { v * (1.0 / length) } else { v }
}

//! From key to key through a stretch, each interval as far as it can reach.

use super::ball::{Ball, last_within};
use super::near::Near;
use super::{Asked, Ends, Fewer};
use crate::reduce::reach::Key;
use crate::reduce::value::Step;

/// The part of the tolerance that is aimed at: ends between keys are found as if the way
/// were straight.
const AIM: f64 = 0.998;
/// After so many keys a stretch is left as it is, if more than this part of them stayed.
const TRIAL: (usize, f64) = (1024, 0.85);
/// What f64 may add to a distance.
const ROUNDING: f64 = 1e-11;

/// Neighbouring keys, and what holds for all of them.
pub(super) struct Stretch<'a, V: Near> {
    times: &'a [f32],
    stored: &'a [V::Stored],
    values: Vec<V>,
    /// Ways from key to key that no interval may be longer than, or that bend too much
    /// beside another to be compared with it: they stay. Numbers of their first keys.
    far: Vec<usize>,
    /// No other way is longer.
    longest: f64,
    /// Numbers stored for a rotation differ from length 1 by at most this.
    uneven: f64,
}

impl<'a, V: Near> Stretch<'a, V> {
    pub(super) fn new(times: &'a [f32], stored: &'a [V::Stored], asked: Asked) -> Stretch<'a, V> {
        let mut uneven = 0.0f64;
        let read = |&stored: &V::Stored| {
            let (value, off) = V::near_read(stored);
            uneven = uneven.max(off);
            value
        };
        let values: Vec<V> = stored.iter().map(read).collect();
        // A key that is off the curve is further away.
        let near = V::FAR.min((asked.step - 2.0 * asked.tolerance).max(0.0));
        let (mut far, mut longest) = (Vec::new(), 0.0f64);
        for (i, pair) in values.windows(2).enumerate() {
            let square = pair[0].apart_squared(pair[1]);
            if square <= near * near { longest = longest.max(square) } else { far.push(i) }
        }
        Stretch { times, stored, values, far, longest: longest.sqrt(), uneven }
    }

    fn time(&self, key: usize) -> f64 {
        f64::from(self.times[key])
    }

    /// The curve at a time between a key and the next.
    fn at(&self, key: usize, t: f64) -> V {
        let (from, to) = (self.time(key), self.time(key + 1));
        let (a, b) = (self.values[key], self.values[key + 1]);
        a.near_moved(a.near_step_to(b) * ((t - from) / (to - from)))
    }
}

impl<V: Near<Stored = [f32; N]>, const N: usize> Stretch<'_, V> {
    fn as_it_is(&self) -> Fewer<N> {
        Fewer { times: self.times.to_vec(), values: self.stored.to_vec(), deviation: 0.0 }
    }
}

/// What every interval of a stretch must keep, in the units of [`Value::distance`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    tolerance: f64,
    step: f64,
    ends: Ends,
    /// How many times as far as at its ends playback may be between two keys.
    bulge: f64,
    /// What uneven lengths of the numbers there were add.
    uneven: f64,
    /// How many times as much as those of rounded numbers do written lengths differ.
    lengths: f64,
    /// The distance at keys that is aimed at.
    aim: f64,
}

impl Limits {
    /// None where the tolerance leaves nothing to aim at.
    pub(super) fn new<V: Near>(stretch: &Stretch<V>, asked: Asked) -> Option<Limits> {
        let Asked { step, ends, .. } = asked;
        let tolerance = asked.tolerance.min(V::WIDEST);
        let uneven = stretch.uneven.min(0.5);
        // A way of playback beside one of these is no longer than it and both distances.
        let way = (stretch.longest + 2.0 * tolerance) * (1.0 + uneven) / (1.0 - uneven);
        let bulge = V::bulge(way);
        let lengths = if uneven <= V::EVEN { (uneven / V::ROUNDED).max(1.0) } else { V::EVEN / V::ROUNDED };
        let both = if ends == Ends::Own { 2.0 } else { 1.0 };
        let uneven = both * V::bent(uneven, way) * bulge + ROUNDING;
        let written = match ends {
            Ends::Own => 0.0,
            _ => stretch.values.iter().map(|value| value.rounding()).fold(0.0, f64::max),
        };
        let aim = AIM * (tolerance - uneven) / bulge - 2.0 * written;
        (aim > 0.25 * tolerance).then_some(Limits { tolerance, step, ends, bulge, uneven, lengths, aim })
    }
}

/// A key that was written, and how far it is off the curve.
#[derive(Clone, Copy)]
struct Placed<V: Near> {
    key: Key<V>,
    off: f64,
    /// The number of the first key after it.
    next: usize,
}

/// What is seen of the curve from a key.
struct Seen<V: Near> {
    /// τ and the step to each of the keys ahead.
    ahead: Vec<(f64, V::Step)>,
    /// What all before the last allow.
    ball: Ball<V::Step>,
    /// How many keys one interval serves.
    served: usize,
    /// The last of these that an interval may end at exactly.
    exact: Option<usize>,
    /// The ball up to that one.
    exact_ball: Ball<V::Step>,
}

/// The walk through a stretch.
pub(super) struct Walk<'a, V: Near> {
    stretch: &'a Stretch<'a, V>,
    limits: Limits,
    seen: Seen<V>,
    times: Vec<f32>,
    values: Vec<V::Stored>,
    deviation: f64,
    tried: bool,
}

impl<'a, V: Near<Stored = [f32; N]>, const N: usize> Walk<'a, V> {
    pub(super) fn new(stretch: &'a Stretch<'a, V>, limits: Limits) -> Walk<'a, V> {
        let ball = Ball { centre: V::Step::ZERO, radius: f64::INFINITY };
        let seen = Seen { ahead: Vec::new(), ball, served: 0, exact: None, exact_ball: ball };
        Walk { stretch, limits, seen, times: Vec::new(), values: Vec::new(), deviation: 0.0, tried: false }
    }

    /// All of it, or none where an interval between two neighbouring keys has no proof.
    pub(super) fn all(mut self) -> Option<Fewer<N>> {
        let mut at = self.exact(0);
        self.write(at.key);
        for i in 0..=self.stretch.far.len() {
            let last = self.stretch.times.len() - 1;
            let stop = self.stretch.far.get(i).copied().unwrap_or(last);
            while at.next <= stop {
                at = self.interval(at, stop)?;
                self.write(at.key);
                if self.gives_up(at.next) {
                    return Some(self.stretch.as_it_is());
                }
            }
            if stop < last {
                at = self.far(stop)?;
            }
        }
        Some(Fewer { times: self.times, values: self.values, deviation: self.deviation })
    }

    /// Whether little has been gained up to a key.
    fn gives_up(&mut self, next: usize) -> bool {
        let (keys, part) = TRIAL;
        let now = !self.tried && next > keys && self.stretch.times.len() > 4 * keys;
        self.tried |= now;
        let kept = self.limits.ends == Ends::Own || self.stretch.uneven <= V::EVEN;
        now && kept && self.times.len() as f64 > part * next as f64
    }

    fn write(&mut self, key: Key<V>) {
        let value = self.values.last().map_or(key.stored, |&before| V::continuous(key.stored, before));
        self.push(key.time, value);
    }

    fn push(&mut self, time: f32, value: [f32; N]) {
        self.times.push(time);
        self.values.push(value);
    }

    /// One of the keys there were; as it was stored, if that has the length of a rotation.
    fn exact(&self, number: usize) -> Placed<V> {
        let (time, stored) = (self.stretch.times[number], self.stretch.stored[number]);
        let value = self.stretch.values[number];
        let next = number + 1;
        if self.limits.ends == Ends::Own || V::near_read(stored).1 <= V::EVEN {
            return Placed { key: Key { time, stored, value }, off: 0.0, next };
        }
        let key = written(value, time);
        Placed { key, off: key.value.distance(value), next }
    }

    /// The way from a key to the next that is too far for anything else: both as they are,
    /// and equal steps between them where it is longer than allowed.
    fn far(&mut self, number: usize) -> Option<Placed<V>> {
        let (from, to) = (self.exact(number), self.exact(number + 1));
        let way = from.key.value.distance(to.key.value);
        let parts = match self.limits.ends {
            Ends::Own => 1.0,
            _ if way <= self.limits.step => 1.0,
            _ => (way / self.limits.step.min(V::WIDE)).ceil(),
        };
        let off = self.steps(number, parts, to.key.time).max(from.off).max(to.off);
        // Of the numbers as they were stored playback is the same.
        if parts > 1.0 || off > 0.0 {
            if parts == 1.0 && way > V::LONGEST {
                return None; // half a turn, more or less: either way round
            }
            let bent = V::bent(self.stretch.uneven.min(0.5), way);
            let bound =
                V::bulge(way) * (off + bent) + self.limits.lengths * V::uneven_lengths(way) + ROUNDING;
            self.note(bound)?;
        }
        let value = V::continuous(to.key.stored, from.key.stored);
        match parts == 1.0 && self.values.last() != Some(&from.key.stored) {
            // All signs are turned since the last key that was not: so is this one.
            true => self.push(to.key.time, value.map(|x| -x)),
            false if parts == 1.0 => self.push(to.key.time, value),
            false => self.write(to.key),
        }
        Some(to)
    }

    /// Keys on the curve that divide the way after a key into equal parts; how far they
    /// are off it.
    fn steps(&mut self, number: usize, parts: f64, end: f32) -> f64 {
        let (start, h) =
            (self.stretch.time(number), self.stretch.time(number + 1) - self.stretch.time(number));
        let mut worst = 0.0f64;
        for i in 1..parts as usize {
            let time = (start + h * i as f64 / parts) as f32;
            if self.times.last().is_some_and(|&last| last < time) && time < end {
                let there = self.stretch.at(number, f64::from(time));
                let key = written(there, time);
                worst = worst.max(key.value.distance(there));
                self.write(key);
            }
        }
        worst
    }

    /// Takes note of a bound; none if it is beyond the tolerance.
    fn note(&mut self, bound: f64) -> Option<()> {
        self.deviation = self.deviation.max(bound);
        (bound <= self.limits.tolerance).then_some(())
    }

    /// The next key after one.
    fn interval(&mut self, at: Placed<V>, stop: usize) -> Option<Placed<V>> {
        self.look(at, stop);
        let whole = at.next + self.seen.served > stop;
        let furthest = match self.limits.ends {
            _ if whole && self.seen.exact == Some(self.seen.served - 1) => Some(self.exact(stop)),
            _ if whole => None,
            Ends::Free => self.free_end(at),
            Ends::OnCurve => self.end_on_curve(at),
            Ends::Own => None,
        };
        if let Some((bound, end)) = furthest.and_then(|end| self.proven(at, end)) {
            self.deviation = self.deviation.max(bound);
            return Some(end);
        }
        let mut served = self.seen.exact.unwrap_or(0);
        loop {
            let end = self.exact(at.next + served);
            if let Some((bound, end)) = self.proven(at, end) {
                self.deviation = self.deviation.max(bound);
                return Some(end);
            }
            if served == 0 {
                return None;
            }
            served /= 2;
        }
    }

    /// Looks ahead of a key as far as one interval serves.
    fn look(&mut self, at: Placed<V>, stop: usize) {
        let start = f64::from(at.key.time);
        let Limits { aim, step, .. } = self.limits;
        let seen = &mut self.seen;
        seen.ahead.clear();
        (seen.served, seen.exact) = (0, None);
        for key in at.next..=stop {
            let tau = self.stretch.time(key) - start;
            let y = at.key.value.near_step_to(self.stretch.values[key]);
            seen.ahead.push((tau, y));
            let per = 1.0 / tau;
            let (way, square) = (y * per, y.dot(y));
            let ball = Ball { centre: way, radius: aim * per };
            let met = if seen.served == 0 { Some(ball) } else { seen.ball.meet(ball) };
            let Some(met) = met.filter(|_| square <= V::LONGEST * V::LONGEST) else { return };
            let blocked = square > step * step;
            if blocked && seen.served > 0 {
                return;
            }
            seen.ball = met;
            if met.holds(way) {
                (seen.exact, seen.exact_ball) = (Some(seen.served), met);
            }
            seen.served += 1;
            if blocked {
                return;
            }
        }
    }

    /// The furthest end off the curve, between the last key that is served and the next.
    fn free_end(&self, at: Placed<V>) -> Option<Placed<V>> {
        let served = self.seen.served;
        let [(from, y), (to, z)] = self.seen.ahead.get(served.checked_sub(1)?..served + 1)? else {
            return None;
        };
        let ball = self.seen.ball;
        let e = (*z - *y) * (1.0 / (to - from));
        let p = *y - e * *from;
        let across = e - ball.centre;
        let products = (p.dot(p), p.dot(across), across.dot(across));
        let tau = last_within(products, ball.radius, self.limits.aim, *from, *to);
        self.end(at, at.next + served - 1, tau, |tau| ball.nearest((p + e * tau) * (1.0 / tau)))
    }

    /// The furthest end on the curve, between the last key that is one and the next.
    fn end_on_curve(&self, at: Placed<V>) -> Option<Placed<V>> {
        let exact = self.seen.exact?;
        let [(from, y), (to, z)] = self.seen.ahead.get(exact..exact + 2)? else { return None };
        let ball = self.seen.exact_ball;
        let e = (*z - *y) * (1.0 / (to - from));
        let p = *y - e * *from;
        let across = e - ball.centre;
        let products = (p.dot(p), p.dot(across), across.dot(across));
        let tau = last_within(products, ball.radius, 0.0, *from, *to);
        let number = at.next + exact;
        self.end(at, number, tau, |_| V::Step::ZERO).map(|end| {
            let there = self.stretch.at(number, f64::from(end.key.time));
            let key = written(there, end.key.time);
            Placed { key, off: key.value.distance(there), ..end }
        })
    }

    /// A key about τ after another, and after one of the keys there were.
    fn end(&self, at: Placed<V>, number: usize, tau: f64, way: impl Fn(f64) -> V::Step) -> Option<Placed<V>> {
        let start = f64::from(at.key.time);
        let tau = tau.min((1.0 - 1e-7) * self.limits.step / way(tau).length());
        let mut time = (start + tau) as f32;
        if f64::from(time) > start + tau {
            time = time.next_down();
        }
        let time = time.max(self.stretch.times[number]);
        if time <= at.key.time || time >= self.stretch.times[number + 1] {
            return None;
        }
        let tau = f64::from(time) - start;
        let key = written(at.key.value.near_moved(way(tau) * tau), time);
        let there = self.stretch.at(number, f64::from(time));
        Some(Placed { key, off: key.value.near_step_to(there).length(), next: number + 1 })
    }

    /// The bound of an interval, if it is within the tolerance.
    ///
    /// Steps are no shorter than the distances on the sphere that they stand for, so that
    /// the difference of two of them bounds the distance of their ends.
    fn proven(&self, at: Placed<V>, end: Placed<V>) -> Option<(f64, Placed<V>)> {
        let whole = f64::from(end.key.time) - f64::from(at.key.time);
        let step = at.key.value.near_step_to(end.key.value);
        let (per, length) = (step * (1.0 / whole), step.length());
        let inside = &self.seen.ahead[..end.next - at.next];
        let mut worst = 0.0f64;
        for &(tau, y) in inside {
            let off = y - per * tau;
            worst = worst.max(off.dot(off));
        }
        let at_keys = worst.sqrt().max(at.off).max(end.off);
        let own = self.limits.ends == Ends::Own;
        let written = if own { 0.0 } else { self.limits.lengths * V::uneven_lengths(length) };
        let bound = at_keys * self.limits.bulge + self.limits.uneven + written;
        let short =
            length <= self.limits.step * (1.0 + 2e-5) && length <= V::LONGEST + 2.0 * self.limits.tolerance;
        (bound <= self.limits.tolerance && (short || inside.is_empty())).then_some((bound, end))
    }
}

/// A key as it is written.
fn written<V: Near>(value: V, time: f32) -> Key<V> {
    let stored = value.stored();
    Key { time, stored, value: V::near_read(stored).0 }
}

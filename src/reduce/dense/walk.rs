//! From key to key through a stretch, each interval as far as it can reach.

use super::ball::{Ball, Gap};
use super::near::Near;
use super::stretch::{Limits, ROUNDING, Stretch};
use super::{Ends, Fewer};
use crate::reduce::reach::Key;
use crate::reduce::value::Step;

/// After so many keys a stretch is left as it is, if more than this part of them stayed.
const TRIAL: (usize, f64) = (1024, 0.85);

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
        // Numbers that stay must be those of rotations, and no further apart than allowed.
        let sound = self.stretch.uneven <= V::EVEN;
        let short = self.stretch.far.is_empty() || self.limits.step == f64::INFINITY;
        let kept = self.limits.ends == Ends::Own || sound && short;
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
            _ => self.parts(number, way),
        };
        let off = self.steps(number, parts, to.key.time).max(from.off).max(to.off);
        // Of the numbers as they were stored playback is the same.
        if parts > 1.0 || off > 0.0 {
            if way > V::LONGEST {
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

    /// How many steps the way after a key is divided into. Times are rounded: a step may
    /// take that much longer.
    fn parts(&self, number: usize, way: f64) -> f64 {
        let end = self.stretch.times[number + 1];
        let h = f64::from(end) - self.stretch.time(number);
        let rounding = (f64::from(end.next_up()) - f64::from(end)) / h;
        let share = self.limits.step.min(V::WIDE) / way;
        if share > rounding { (1.0 / (share - rounding)).ceil() } else { (1.0 / share).ceil() }
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
        let mut served = self.seen.exact.unwrap_or(self.seen.served.saturating_sub(1));
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
        let Limits { aim, ends, .. } = self.limits;
        let furthest = V::LONGEST.min(self.limits.step).powi(2);
        let keys = at.next..=stop;
        let ahead = self.stretch.times[keys.clone()].iter().zip(&self.stretch.values[keys]);
        let mut ball = Ball { centre: V::Step::ZERO, radius: f64::INFINITY };
        let seen = &mut self.seen;
        seen.ahead.clear();
        (seen.served, seen.exact) = (0, None);
        for (&time, &value) in ahead {
            let tau = f64::from(time) - start;
            let y = at.key.value.near_step_to(value);
            seen.ahead.push((tau, y));
            let per = 1.0 / tau;
            let one = Ball { centre: y * per, radius: aim * per };
            let Some(met) = ball.meet(one).filter(|_| y.dot(y) <= furthest || seen.served == 0) else {
                break;
            };
            ball = met;
            if ends != Ends::Free && met.holds(one.centre) {
                (seen.exact, seen.exact_ball) = (Some(seen.served), met);
            }
            seen.served += 1;
        }
        seen.ball = ball;
        if let (Ends::Free, Some((tau, y))) = (ends, seen.ahead.get(seen.served.wrapping_sub(1))) {
            seen.exact = ball.holds(*y * (1.0 / tau)).then_some(seen.served - 1);
        }
    }

    /// The furthest end off the curve, between the last key that is served and the next.
    ///
    /// The point of the ball that is nearest to where the curve is then: at the last time,
    /// and at any before it, what the ball and the curve's own allow is shared by their
    /// radii.
    fn free_end(&self, at: Placed<V>) -> Option<Placed<V>> {
        let last = self.seen.served.checked_sub(1)?;
        let gap = self.gap(last, self.seen.ball)?;
        let epsilon = self.limits.aim;
        let u = gap.last_within(epsilon);
        self.end(at, &gap, at.next + last, u, |tau, u| {
            let reach = gap.ball.radius * tau;
            gap.ball.centre * tau + gap.at(u) * (reach / (reach + epsilon))
        })
    }

    /// The furthest end on the curve, between the last key that is one and the next.
    fn end_on_curve(&self, at: Placed<V>) -> Option<Placed<V>> {
        let exact = self.seen.exact?;
        let gap = self.gap(exact, self.seen.exact_ball)?;
        let number = at.next + exact;
        let u = gap.last_within(0.0);
        let end = self.end(at, &gap, number, u, |tau, u| gap.ball.centre * tau + gap.at(u))?;
        let there = self.stretch.at(number, f64::from(end.key.time));
        let key = written(there, end.key.time);
        Some(Placed { key, off: key.value.distance(there), ..end })
    }

    /// The way from a ball to the curve between one of the keys ahead and the next.
    fn gap(&self, key: usize, ball: Ball<V::Step>) -> Option<Gap<V::Step>> {
        let &[(from, y), (to, z)] = self.seen.ahead.get(key..key + 2)? else { return None };
        let start = y - ball.centre * from;
        Some(Gap { ball, from, h: to - from, start, change: z - ball.centre * to - start })
    }

    /// A key at a share of the way from one of the keys there were to the next.
    fn end(
        &self,
        at: Placed<V>,
        gap: &Gap<V::Step>,
        number: usize,
        u: f64,
        step: impl Fn(f64, f64) -> V::Step,
    ) -> Option<Placed<V>> {
        let start = f64::from(at.key.time);
        let mut tau = gap.from + u * gap.h;
        if self.limits.step < V::LONGEST {
            tau = tau.min((1.0 - 1e-7) * tau * self.limits.step / step(tau, u).length());
        }
        let mut time = (start + tau) as f32;
        if f64::from(time) > start + tau {
            time = time.next_down();
        }
        let time = time.max(self.stretch.times[number]);
        if time <= at.key.time || time >= self.stretch.times[number + 1] {
            return None;
        }
        let tau = f64::from(time) - start;
        let u = (tau - gap.from) / gap.h;
        let key = written(at.key.value.near_moved(step(tau, u)), time);
        let there = self.stretch.share(number, u);
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

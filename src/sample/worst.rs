//! The largest value of a distance over time, by branch and bound.
//!
//! A stretch of time is done once its upper bound is little above the worst that was
//! found anywhere; any other is halved, and of the parts always the one that may be worst.

use crate::curve::Rates;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// How much the bound may exceed the worst that was found.
const SLACK: f64 = 1.05;
/// How often a part is halved, and its halves, at most.
const DEPTH: u32 = 14;
/// How many halvings there are for all stretches, of which each may take a share, and a few
/// more: what cannot be bounded, or not soon, must not take long.
const HALVINGS: u32 = 1 << 15;
const SHARE: u32 = 16;
const FEWEST_HALVINGS: u32 = 16;
/// The same where a limit is to be proven, which can be close to what there is: as many as all
/// halves of a part.
const PROVING_HALVINGS: u32 = SHARE << DEPTH;

/// Two times, with the distance at each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) at_from: f64,
    pub(crate) at_to: f64,
}

/// A distance as a function of time, which can be bounded from rates of what moves.
pub(crate) trait Gap {
    /// The distance at a time.
    fn at(&self, t: f64) -> f64;
    /// Rates between two times; they may cost much.
    fn rates(&self, from: f64, to: f64) -> Rates;
    /// An upper bound of the distance on a part, from rates that hold there.
    fn bound(&self, part: &Part, rates: Rates) -> f64;
}

/// The worst of all stretches so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Worst {
    /// The largest distance that was found.
    pub(crate) found: f64,
    /// The largest that was not excluded.
    bound: f64,
    /// What is not worth refining.
    negligible: f64,
    /// What the bound is to stay within, if it can be.
    limit: f64,
    /// How many halvings are left, and how many each stretch may take besides its share.
    halvings: u32,
    fewest: u32,
}

/// A part that is not done.
struct Open {
    bound: f64,
    part: Part,
    /// Rates that hold there.
    rates: Rates,
    level: u32,
}

impl Ord for Open {
    fn cmp(&self, other: &Open) -> Ordering {
        // Of two that may be as bad the shorter: where nothing helps, that is soon seen.
        self.bound.total_cmp(&other.bound).then(self.level.cmp(&other.level))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl Worst {
    /// Nothing is known; distances below `negligible` are not refined.
    pub(crate) fn new(negligible: f64) -> Worst {
        let (halvings, fewest) = (HALVINGS, FEWEST_HALVINGS);
        Worst { found: 0.0, bound: 0.0, negligible, limit: f64::INFINITY, halvings, fewest }
    }

    /// The same with so many halvings; once they are spent, nothing is refined.
    pub(crate) fn thrifty(negligible: f64, halvings: u32) -> Worst {
        Worst { halvings, fewest: 0, ..Worst::new(negligible) }
    }

    /// Nothing is known; stretches are refined until they are within a limit, or something
    /// beyond it is found.
    pub(crate) fn proving(limit: f64) -> Worst {
        Worst { found: limit, limit, halvings: PROVING_HALVINGS, ..Worst::new(0.0) }
    }

    /// One stretch more, refined until its bound is within a limit, or something beyond
    /// it found.
    pub(crate) fn one_more(&self, limit: f64) -> Worst {
        Worst { found: self.found.min(limit), bound: 0.0, limit, ..*self }
    }

    /// Takes what became of one stretch more.
    pub(crate) fn add(&mut self, one: &Worst) {
        self.note(one.found);
        self.settle(one.bound);
    }

    /// Takes note of a distance.
    pub(crate) fn note(&mut self, distance: f64) {
        self.found = self.found.max(distance);
    }

    /// No distance so far is larger.
    pub(crate) fn bound(&self) -> f64 {
        self.bound.max(self.found)
    }

    /// Whether a bound is near enough to the worst that was found, or changes nothing.
    pub(crate) fn accepts(&self, bound: f64) -> bool {
        bound <= (SLACK * self.found.max(self.negligible)).min(self.limit) || bound <= self.bound
    }

    /// Whether there are no halvings left.
    pub(crate) fn is_spent(&self) -> bool {
        self.halvings + self.fewest == 0
    }

    /// Takes the bound of a stretch that is done.
    pub(crate) fn settle(&mut self, bound: f64) {
        self.bound = self.bound.max(bound);
    }

    /// Bounds a gap on a part from rates that hold there; for the first `cheap` halvings
    /// without asking for the part's own if those bound anything. Returns the bound.
    pub(crate) fn search(&mut self, gap: &impl Gap, part: Part, known: Rates, cheap: u32) -> f64 {
        let mut halvings = self.halvings.div_ceil(SHARE) + self.fewest;
        let cheap = if halvings == 0 { 0 } else { cheap };
        let mut open = BinaryHeap::from([self.open(gap, part, known, (0, cheap))]);
        let mut worst = 0.0;
        // No other is beyond the one on top.
        while let Some(Open { bound, part, rates, level }) = open.pop() {
            worst = bound;
            if self.accepts(bound) || level == DEPTH || halvings == 0 || self.found > self.limit {
                break;
            }
            let middle = 0.5 * (part.from + part.to);
            let at_middle = gap.at(middle);
            self.note(at_middle);
            let halves = [
                Part { to: middle, at_to: at_middle, ..part },
                Part { from: middle, at_from: at_middle, ..part },
            ];
            open.extend(halves.map(|half| self.open(gap, half, rates, (level + 1, cheap))));
            halvings -= 1;
            self.halvings = self.halvings.saturating_sub(1);
        }
        self.settle(worst);
        worst
    }

    /// A part with its bound, from known rates or its own.
    fn open(&self, gap: &impl Gap, part: Part, known: Rates, (level, cheap): (u32, u32)) -> Open {
        let mut rates = known;
        let mut bound = gap.bound(&part, rates);
        let cheap = if rates.is_finite() { cheap } else { 0 };
        if !self.accepts(bound) && level >= cheap && self.hopeful(gap, &part, rates) {
            rates = rates.and(gap.rates(part.from, part.to));
            bound = bound.min(gap.bound(&part, rates));
        }
        Open { bound, part, rates, level }
    }

    /// Whether rates of the part alone might do.
    fn hopeful(&self, gap: &impl Gap, part: &Part, rates: Rates) -> bool {
        // Rates that bound nothing may be far from those of the part.
        let h = part.to - part.from;
        !rates.is_finite() || rates.speed * h > 1.0 || self.accepts(gap.bound(part, rates.hoped()))
    }
}

/// The peak of the parabola through a at one end and b at the other that rises by
/// `sagitta` above the middle of their chord.
pub(crate) fn parabola_peak(a: f64, b: f64, sagitta: f64) -> f64 {
    let slope = b - a;
    if slope.abs() >= 4.0 * sagitta {
        a.max(b)
    } else {
        0.5 * (a + b) + sagitta + slope * slope / (16.0 * sagitta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |c + a cos t|, whose second derivative is at most a.
    struct Wave {
        mean: f64,
        swing: f64,
    }

    impl Gap for Wave {
        fn at(&self, t: f64) -> f64 {
            (self.mean + self.swing * t.cos()).abs()
        }

        fn rates(&self, from: f64, to: f64) -> Rates {
            let around = |x: f64| (x.cos().abs() + 0.5 * (to - from)).min(1.0);
            let acceleration = self.swing * around(0.5 * (from + to));
            Rates { speed: self.swing, acceleration }
        }

        fn bound(&self, part: &Part, rates: Rates) -> f64 {
            let h = part.to - part.from;
            parabola_peak(part.at_from, part.at_to, h * h / 8.0 * rates.acceleration)
        }
    }

    fn searched(wave: &Wave, worst: Worst) -> Worst {
        let (from, to) = (0.5, 7.0);
        let mut worst = worst;
        let part = Part { from, to, at_from: wave.at(from), at_to: wave.at(to) };
        worst.note(part.at_from.max(part.at_to));
        let rates = Rates { speed: wave.swing, acceleration: wave.swing };
        worst.search(wave, part, rates, 2);
        worst
    }

    #[test]
    fn bound_is_above_the_peak_and_near_it() {
        for (mean, swing) in [(0.0, 1.0), (0.3, 2.0), (-5.0, 0.1), (1.0, 1e-6)] {
            let peak = f64::abs(mean) + swing;
            let bound = searched(&Wave { mean, swing }, Worst::new(0.0)).bound();
            assert!(bound >= peak && bound <= SLACK * peak, "{mean} {swing}: {bound}");
        }
    }

    /// Nothing bounds it, and it counts how often it is looked at.
    struct Unbounded(std::cell::Cell<u32>);

    impl Gap for Unbounded {
        fn at(&self, _t: f64) -> f64 {
            self.0.set(self.0.get() + 1);
            0.0
        }

        fn rates(&self, _from: f64, _to: f64) -> Rates {
            Rates { speed: f64::INFINITY, acceleration: f64::INFINITY }
        }

        fn bound(&self, _part: &Part, _rates: Rates) -> f64 {
            1.0
        }
    }

    #[test]
    fn no_more_is_looked_at_than_there_are_halvings() {
        let (gap, halvings) = (Unbounded(0.into()), 100);
        let mut worst = Worst::thrifty(0.0, halvings);
        for i in 0..1000 {
            let from = f64::from(i);
            let part = Part { from, to: from + 1.0, at_from: 0.0, at_to: 0.0 };
            // Without the last bound the next part would be accepted for it.
            worst.bound = 0.0;
            assert_eq!(worst.search(&gap, part, gap.rates(0.0, 0.0), 3), 1.0);
        }
        assert!(worst.is_spent());
        assert_eq!(gap.0.get(), halvings);
    }

    #[test]
    fn where_nothing_helps_is_soon_seen() {
        let (gap, mut worst) = (Unbounded(0.into()), Worst::thrifty(0.0, 1 << 15));
        let part = Part { from: 0.0, to: 1.0, at_from: 0.0, at_to: 0.0 };
        assert_eq!(worst.search(&gap, part, gap.rates(0.0, 0.0), 3), 1.0);
        // Down to the shortest part there is, and no other.
        assert_eq!(gap.0.get(), DEPTH);
    }

    #[test]
    fn limit_a_little_above_the_peak_is_kept() {
        let wave = Wave { mean: 0.3, swing: 2.0 };
        let worst = searched(&wave, Worst::new(0.0).one_more(2.3 + 1e-6));
        assert!(worst.bound() <= 2.3 + 1e-6 && worst.bound() >= 2.3);
        let beyond = searched(&wave, Worst::new(0.0).one_more(2.3 - 1e-3));
        assert!(beyond.bound() > 2.3 - 1e-3);
    }
}

//! What vector code can say of the gaps between motion and playback: a first bound of every
//! interval, so that the search has only the worst of them to look into.
//!
//! Keys cut the intervals between samples into parts, each within one segment. At a key the
//! motion is the key. Rates of segments bound the gap within a part, as the search itself
//! begins; where that is not near the worst that is known, the gap half way along the part
//! is looked at, and bounds the two halves, a few times over. Blending the four numbers is no further off than
//! slerp and what the two differ by.

use super::deviation::Search;
use super::interlude::bound;
use crate::curve::Rates;
use crate::math::{Quat, half_angles, slerps};

/// How often a part is halved at most.
const HALVINGS: usize = 4;

/// With more segments than this to an interval, no rates are kept of them all.
const MANY: usize = 16;

/// An interval that the search must look into, with its bound so far.
pub(super) struct Open {
    pub(super) interval: usize,
    pub(super) bound: f64,
}

/// A part of the interval after sample `interval`, within one segment.
#[derive(Clone, Copy)]
struct Part {
    interval: usize,
    from: f64,
    to: f64,
    rates: Rates,
    at_from: f64,
    at_to: f64,
    /// The key at its end, if that is where it ends.
    key: Option<usize>,
}

impl Part {
    fn bound(&self, playback: f64) -> f64 {
        bound(self.rates, self.to - self.from, self.at_from, self.at_to, playback)
    }

    /// Both halves, from the gap half way along.
    fn halves(&self, gap: f64) -> [Part; 2] {
        let middle = self.middle();
        [Part { to: middle, at_to: gap, key: None, ..*self }, Part { from: middle, at_from: gap, ..*self }]
    }

    fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }
}

/// Settles what it can of all intervals; returns the others: first those of which nothing is
/// known, in order.
pub(super) fn sift(search: &mut Search) -> Vec<Open> {
    let (mut parts, mut open) = cut(search);
    meet_keys(search, &mut parts);
    for _ in 0..HALVINGS {
        parts.retain(|part| {
            !search.accept(part.interval..part.interval + 1, part.bound(search.speed(part.interval)))
        });
        let middles = look_half_way(search, &parts);
        parts = parts.iter().zip(middles).flat_map(|(part, middle)| part.halves(middle)).collect();
    }
    for parts in parts.chunk_by(|a, b| a.interval == b.interval) {
        let interval = parts[0].interval;
        let bound = parts.iter().map(|part| part.bound(search.speed(interval))).fold(0.0, f64::max);
        if !search.accept(interval..interval + 1, bound) {
            open.push(Open { interval, bound });
        }
    }
    open
}

/// Cuts the intervals at keys; those of which vector code knows no rates stay open.
fn cut(search: &Search) -> (Vec<Part>, Vec<Open>) {
    let motion = search.motion();
    let times = motion.times();
    let count = search.intervals();
    let first = motion.segment_at(search.time(0), 0);
    let last = motion.segment_at(search.time(count), first);
    let segments = if last - first > MANY * count { first..first } else { first..last + 1 };
    let rates = motion.rates_of(segments);
    let (mut parts, mut open) = (Vec::with_capacity(2 * count), Vec::new());
    let mut segment = first;
    for interval in 0..count {
        let (mut from, end) = (search.time(interval), search.time(interval + 1));
        let known = parts.len();
        segment = motion.segment_at(from, segment);
        loop {
            let Some(rates) =
                rates.get(segment - first).copied().flatten().filter(|_| from < times[segment + 1])
            else {
                parts.truncate(known);
                open.push(Open { interval, bound: f64::INFINITY });
                break;
            };
            let within = times[segment + 1] >= end;
            let to = if within { end } else { times[segment + 1] };
            let key = (!within).then_some(segment + 1);
            let ends = [interval, interval + 1].map(|sample| search.at_sample(sample));
            parts.push(Part { interval, from, to, rates, at_from: ends[0], at_to: ends[1], key });
            if within {
                break;
            }
            (from, segment) = (to, segment + 1);
        }
    }
    (parts, open)
}

/// Finds the gap at every key that cuts an interval.
fn meet_keys(search: &mut Search, parts: &mut [Part]) {
    let cuts: Vec<(usize, usize)> =
        parts.iter().enumerate().filter_map(|(i, part)| part.key.map(|key| (i, key))).collect();
    let shares =
        cuts.iter().map(|&(i, _)| search.share(parts[i].interval, parts[i].to)).collect::<Vec<f64>>();
    let pairs: Vec<[Quat; 2]> = cuts.iter().map(|&(i, _)| search.ends(parts[i].interval)).collect();
    let keys: Vec<Quat> = cuts.iter().map(|&(_, key)| search.motion().key(key)).collect();
    for (&(i, _), gap) in cuts.iter().zip(half_angles(&slerps(&pairs, &shares), &keys)) {
        search.note(parts[i].interval, gap);
        (parts[i].at_to, parts[i + 1].at_from) = (gap, gap);
    }
}

/// The gap half way along each part.
fn look_half_way(search: &mut Search, parts: &[Part]) -> Vec<f64> {
    let places: Vec<(usize, f64)> = parts.iter().map(|part| (part.interval, part.middle())).collect();
    look(search, &places)
}

/// The gap half way along each of some intervals.
pub(super) fn half_way(search: &mut Search, intervals: &[usize]) -> Vec<f64> {
    let middle = |&i: &usize| (i, 0.5 * (search.time(i) + search.time(i + 1)));
    let places: Vec<(usize, f64)> = intervals.iter().map(middle).collect();
    look(search, &places)
}

/// The gap at each of some times, each within an interval.
fn look(search: &mut Search, places: &[(usize, f64)]) -> Vec<f64> {
    let (intervals, times): (Vec<usize>, Vec<f64>) = places.iter().copied().unzip();
    let shares: Vec<f64> = places.iter().map(|&(i, t)| search.share(i, t)).collect();
    let pairs: Vec<[Quat; 2]> = intervals.iter().map(|&i| search.ends(i)).collect();
    let gaps = half_angles(&slerps(&pairs, &shares), &search.motion().at_all(&times));
    intervals.iter().zip(&gaps).for_each(|(&i, &gap)| search.note(i, gap));
    gaps
}

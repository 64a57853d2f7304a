//! Plays two clips side by side and finds where they are farthest apart.
//!
//! Between neighbouring key times of all channels of both files, everything is smooth.
//! Each such interval is looked at from its start (as it is from there on) to its end (as
//! it is up to there: STEP jumps at keys) and at its quarters. Where between these there
//! may be a peak that exceeds the largest so far, golden sections find it; of some hundred
//! intervals the most promising few are searched.

use super::measure::{ByMeasure, Measure, all, one};
use super::reel::{Reel, Span};
use super::rig::{Local, Rig};
use crate::asset::play::{Clip, Interpolation};
use crate::asset::{Asset, Error};
use glam::DAffine3;
use rayon::prelude::*;

/// Numbers of both files in memory at a time.
const IN_MEMORY: usize = 1 << 22;
/// Intervals that are looked at in a row; fixed, so that results do not depend on the
/// number of threads.
const IN_A_ROW: usize = 512;
/// Where an interval is looked at, as parts of it.
const LOOKS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Golden sections of half an interval: to 1e-5 of it.
const SECTIONS: usize = 24;
/// Peaks that are searched for in a row, by pair and measure: the most promising ones.
const PEAKS: usize = 4;

/// How far apart, as a gauge, and when, seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Worst {
    pub(super) off: f64,
    pub(super) time: f64,
}

impl Worst {
    fn note(&mut self, off: f64, time: f64) {
        if off > self.off {
            *self = Worst { off, time };
        }
    }
}

/// Which of the two files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The first.
    A,
    /// The second.
    B,
}

/// One file as it plays one of its clips, or rests.
#[derive(Debug)]
pub(super) struct Side<'a> {
    rig: &'a Rig,
    reels: Vec<Reel>,
    /// The channels of each joint, as indices into `reels`.
    channels: Vec<Vec<usize>>,
    /// Whether a joint or one above it has channels.
    moves: Vec<bool>,
}

impl<'a> Side<'a> {
    pub(super) fn new(rig: &'a Rig, clip: Option<&Clip>) -> Side<'a> {
        let channels = clip.iter().flat_map(|clip| &clip.channels);
        let animation = clip.map_or(0, |clip| clip.animation);
        let reels: Vec<Reel> = channels.map(|channel| Reel::new(animation, channel.clone())).collect();
        let mut channels = vec![Vec::new(); rig.joints.len()];
        for (index, reel) in reels.iter().enumerate() {
            channels[reel.channel.node].push(index);
        }
        let mut moves = vec![false; rig.joints.len()];
        for &joint in &rig.order {
            let above = rig.joints[joint].parent.is_some_and(|parent| moves[parent]);
            moves[joint] = above || !channels[joint].is_empty();
        }
        Side { rig, reels, channels, moves }
    }

    /// A joint and those above it that move, from the top down.
    fn chain(&self, joint: usize) -> Vec<usize> {
        let above = std::iter::successors(Some(joint), |&joint| self.rig.joints[joint].parent);
        let mut chain: Vec<usize> = above.filter(|&joint| self.moves[joint]).collect();
        chain.reverse();
        chain
    }

    fn spans(&self, time: f64) -> Vec<Span<'_>> {
        self.reels.iter().map(|reel| reel.span(time)).collect()
    }

    /// Whether a channel jumps at a time.
    fn jumps(&self, time: f64) -> bool {
        let steps = self.reels.iter().filter(|reel| reel.channel.interpolation == Interpolation::Step);
        steps.into_iter().any(|reel| reel.times().binary_search_by(|t| t.total_cmp(&time)).is_ok())
    }
}

/// Where the joints of a side are at some time.
#[derive(Clone)]
struct Pose {
    locals: Vec<Local>,
    worlds: Vec<DAffine3>,
    value: Vec<f64>,
}

impl Pose {
    fn resting(rig: &Rig) -> Pose {
        let locals: Vec<Local> = rig.joints.iter().map(|joint| joint.rest.clone()).collect();
        let mut worlds = vec![DAffine3::IDENTITY; locals.len()];
        for &joint in &rig.order {
            let above = rig.joints[joint].parent.map_or(DAffine3::IDENTITY, |parent| worlds[parent]);
            worlds[joint] = above * locals[joint].affine();
        }
        Pose { locals, worlds, value: Vec::new() }
    }

    /// Moves some joints to a time within the spans, parents first.
    fn set(&mut self, side: &Side, spans: &[Span], time: f64, joints: &[usize]) {
        for &joint in joints {
            for &channel in &side.channels[joint] {
                let reel = &side.reels[channel];
                reel.value(spans[channel], time, &mut self.value);
                self.locals[joint].set(reel.channel.property, &self.value);
            }
            let above = side.rig.joints[joint].parent;
            let above = above.map_or(DAffine3::IDENTITY, |parent| self.worlds[parent]);
            self.worlds[joint] = above * self.locals[joint].affine();
        }
    }

    fn of(&self, joint: usize) -> (&Local, &DAffine3) {
        (&self.locals[joint], &self.worlds[joint])
    }
}

/// Two sides, and which joints of theirs belong together.
struct Sweep<'a> {
    a: Side<'a>,
    b: Side<'a>,
    pairs: &'a [(usize, usize)],
    /// The pairs of which one moves, as indices into `pairs`.
    moving: Vec<usize>,
    /// The joints whose motion matters, parents first.
    joints: (Vec<usize>, Vec<usize>),
}

/// The largest differences of each pair of joints, over the longer of the two clips.
///
/// Joints are indices into the rigs. Keys are read a window at a time; memory does not
/// grow with their number. The error says in which file it is.
pub(super) fn sweep(
    a: (&mut Asset, Side),
    b: (&mut Asset, Side),
    pairs: &[(usize, usize)],
) -> Result<Vec<ByMeasure<Worst>>, (Which, Error)> {
    let ((a_asset, a), (b_asset, b)) = (a, b);
    let mut sweep = Sweep::new(a, b, pairs);
    let mut found = sweep.resting();
    if sweep.moving.is_empty() {
        return Ok(found);
    }
    let count = sweep.keys_in_memory();
    sweep.wind((&mut *a_asset, &mut *b_asset), f64::NEG_INFINITY, count)?;
    let mut start = sweep.first();
    loop {
        let (times, last) = sweep.window(start);
        let windows: Vec<&[f64]> = overlapping(&times);
        let row = |times: &&[f64]| sweep.row(times, &found);
        let rows: Vec<Vec<ByMeasure<Worst>>> = windows.par_iter().map(row).collect();
        rows.iter().for_each(|row| sweep.merge(&mut found, row));
        start = times.last().copied().unwrap_or(start);
        if last {
            // From the last key on everything stays as it is.
            let end = sweep.row(&[start, start], &found);
            sweep.merge(&mut found, &end);
            return Ok(found);
        }
        sweep.wind((&mut *a_asset, &mut *b_asset), start, count)?;
    }
}

/// Rows of times, each beginning with the last time of the one before.
fn overlapping(times: &[f64]) -> Vec<&[f64]> {
    let count = times.len().saturating_sub(1).div_ceil(IN_A_ROW);
    (0..count).map(|i| &times[i * IN_A_ROW..times.len().min((i + 1) * IN_A_ROW + 1)]).collect()
}

impl<'a> Sweep<'a> {
    fn new(a: Side<'a>, b: Side<'a>, pairs: &'a [(usize, usize)]) -> Sweep<'a> {
        let moves = |&i: &usize| a.moves[pairs[i].0] || b.moves[pairs[i].1];
        let moving: Vec<usize> = (0..pairs.len()).filter(moves).collect();
        let joints = |side: &Side, of: &dyn Fn(usize) -> usize| {
            let mut matter = vec![false; side.rig.joints.len()];
            moving.iter().flat_map(|&i| side.chain(of(i))).for_each(|joint| matter[joint] = true);
            side.rig.order.iter().copied().filter(|&joint| matter[joint]).collect()
        };
        let joints = (joints(&a, &|i| pairs[i].0), joints(&b, &|i| pairs[i].1));
        Sweep { a, b, pairs, moving, joints }
    }

    /// Differences of what nothing moves; of the rest none yet.
    fn resting(&self) -> Vec<ByMeasure<Worst>> {
        let (a, b) = (Pose::resting(self.a.rig), Pose::resting(self.b.rig));
        let moves = |&(of_a, of_b): &(usize, usize)| self.a.moves[of_a] || self.b.moves[of_b];
        let pairs = self.pairs.iter().map(|pair| match moves(pair) {
            true => Default::default(),
            false => all(a.of(pair.0), b.of(pair.1)).map(|off| Worst { off, time: 0.0 }),
        });
        pairs.collect()
    }

    fn reels(&self) -> impl Iterator<Item = &Reel> {
        self.a.reels.iter().chain(&self.b.reels)
    }

    fn keys_in_memory(&self) -> usize {
        let numbers: usize = self.reels().map(|reel| 1 + reel.channel.stored_width()).sum();
        (IN_MEMORY / numbers.max(1)).clamp(64, 1 << 16)
    }

    fn wind(
        &mut self,
        (a, b): (&mut Asset, &mut Asset),
        time: f64,
        count: usize,
    ) -> Result<(), (Which, Error)> {
        let all = |side: &mut Side, asset: &mut Asset| {
            side.reels.iter_mut().try_for_each(|reel| reel.wind(asset, time, count))
        };
        all(&mut self.a, a).map_err(|error| (Which::A, error))?;
        all(&mut self.b, b).map_err(|error| (Which::B, error))
    }

    /// When to begin: at 0, or in a broken file before.
    fn first(&self) -> f64 {
        self.reels().filter_map(|reel| reel.times().first().copied()).fold(0.0, f64::min)
    }

    /// The key times in memory from `start` on, as far as all channels are known, and
    /// whether there are no more.
    fn window(&self, start: f64) -> (Vec<f64>, bool) {
        let known = self.reels().filter_map(Reel::known_until).reduce(f64::min);
        let end = known.unwrap_or(f64::INFINITY);
        let within = |&time: &f64| time > start && time <= end;
        let keys = self.reels().flat_map(|reel| reel.times().iter().copied().filter(within));
        let mut times: Vec<f64> = std::iter::once(start).chain(keys).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        (times, known.is_none())
    }

    fn merge(&self, found: &mut [ByMeasure<Worst>], row: &[ByMeasure<Worst>]) {
        for (&pair, row) in self.moving.iter().zip(row) {
            for (found, row) in found[pair].iter_mut().zip(row) {
                found.note(row.off, row.time);
            }
        }
    }

    /// The largest differences of the moving pairs from the first of some neighbouring
    /// times to the last; no less than what was `found` before.
    fn row(&self, times: &[f64], found: &[ByMeasure<Worst>]) -> Vec<ByMeasure<Worst>> {
        let mut row = Row {
            sweep: self,
            a: Pose::resting(self.a.rig),
            b: Pose::resting(self.b.rig),
            looks: vec![Default::default(); self.moving.len()],
            worst: self.moving.iter().map(|&pair| found[pair]).collect(),
            promising: vec![Default::default(); self.moving.len()],
        };
        let mut known = false;
        for pair in times.windows(2) {
            let (start, end) = (pair[0], pair[1]);
            row.interval(&self.spans(start), start, end, known);
            known = !(self.a.jumps(end) || self.b.jumps(end));
        }
        row.refine();
        row.worst
    }

    fn spans(&self, time: f64) -> Spans<'_> {
        (self.a.spans(time), self.b.spans(time))
    }
}

/// What both sides do from one time to the next.
type Spans<'a> = (Vec<Span<'a>>, Vec<Span<'a>>);

/// Some intervals one after the other.
struct Row<'a> {
    sweep: &'a Sweep<'a>,
    a: Pose,
    b: Pose,
    /// What was seen of each moving pair in the interval.
    looks: Vec<[ByMeasure<f64>; LOOKS.len()]>,
    worst: Vec<ByMeasure<Worst>>,
    /// Where peaks may be.
    promising: Vec<ByMeasure<Vec<Promise>>>,
}

/// A stretch of an interval in which there may be a peak.
#[derive(Clone, Copy, Debug)]
struct Promise {
    /// What it may reach.
    possible: f64,
    /// When the interval begins.
    start: f64,
    from: f64,
    to: f64,
}

impl Row<'_> {
    /// Looks at an interval; `known` says that its start is as the last one's end.
    fn interval(&mut self, spans: &Spans, start: f64, end: f64, known: bool) {
        let last = LOOKS.len() - 1;
        if known {
            self.looks.iter_mut().for_each(|looks| looks[0] = looks[last]);
        } else {
            self.look(spans, start, 0);
        }
        let time = |u: f64| start + u * (end - start);
        if end > start {
            for (look, &u) in LOOKS.iter().enumerate().skip(1) {
                self.look(spans, if look == last { end } else { time(u) }, look);
            }
        } else {
            self.looks.iter_mut().for_each(|looks| *looks = [looks[0]; LOOKS.len()]);
        }
        for pair in 0..self.looks.len() {
            for measure in Measure::ALL {
                self.note((start, end), pair, measure);
            }
        }
    }

    fn look(&mut self, spans: &Spans, time: f64, look: usize) {
        let Sweep { a, b, pairs, moving, joints } = self.sweep;
        self.a.set(a, &spans.0, time, &joints.0);
        self.b.set(b, &spans.1, time, &joints.1);
        for (looks, &pair) in self.looks.iter_mut().zip(moving) {
            let (of_a, of_b) = pairs[pair];
            looks[look] = all(self.a.of(of_a), self.b.of(of_b));
        }
    }

    fn note(&mut self, (start, end): (f64, f64), pair: usize, measure: Measure) {
        let at = measure as usize;
        let seen = self.looks[pair].map(|look| look[at]);
        let worst = &mut self.worst[pair][at];
        let time = |look: usize| start + LOOKS[look] * (end - start);
        for (look, &off) in seen.iter().enumerate() {
            // Up to the end, not at it, where a jump may have been made.
            worst.note(off, time(look).min(end.next_down().max(start)));
        }
        for look in 0..LOOKS.len() {
            if let Some((possible, from, to)) = peak(&seen, look).filter(|peak| peak.0 > worst.off) {
                let promise = Promise { possible, start, from: time(from), to: time(to) };
                self.promising[pair][at].push(promise);
            }
        }
    }

    /// Looks for the most promising peaks.
    fn refine(&mut self) {
        for pair in 0..self.worst.len() {
            for measure in Measure::ALL {
                let at = measure as usize;
                let mut promising = std::mem::take(&mut self.promising[pair][at]);
                promising.sort_by(|a, b| b.possible.total_cmp(&a.possible));
                for promise in promising.into_iter().take(PEAKS) {
                    if promise.possible > self.worst[pair][at].off {
                        let spans = self.sweep.spans(promise.start);
                        let (off, time) = self.refined(&spans, (promise.from, promise.to), pair, measure);
                        self.worst[pair][at].note(off, time);
                    }
                }
            }
        }
    }

    /// The largest difference between two times, between which it has one peak.
    fn refined(
        &mut self,
        spans: &Spans,
        (mut low, mut high): (f64, f64),
        pair: usize,
        measure: Measure,
    ) -> (f64, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let Sweep { a, b, pairs, moving, .. } = self.sweep;
        let (of_a, of_b) = pairs[moving[pair]];
        let chains = (a.chain(of_a), b.chain(of_b));
        let mut off = |time: f64| {
            self.a.set(a, &spans.0, time, &chains.0);
            self.b.set(b, &spans.1, time, &chains.1);
            one(measure, self.a.of(of_a), self.b.of(of_b))
        };
        let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_left, mut at_right) = (off(left), off(right));
        for _ in 0..SECTIONS {
            if at_left >= at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = off(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = off(right);
            }
        }
        if at_left >= at_right { (at_left, left) } else { (at_right, right) }
    }
}

/// What a peak beside a look may reach, where that look is higher than its neighbours,
/// and the looks between which it is.
///
/// Inside, the parabola through three looks tells how far the peak is above the middle
/// one; four times that serves for peaks as sharp as a roof. At an end there is no third
/// look: the steepest way to it goes on for a whole one. Less than a thousandth more is
/// not looked for there.
fn peak(seen: &[f64; LOOKS.len()], look: usize) -> Option<(f64, usize, usize)> {
    const LEAST: f64 = 1e-3;
    let last = LOOKS.len() - 1;
    let (from, to) = (look.saturating_sub(1), last.min(look + 1));
    let at = seen[look];
    if seen[from] > at || seen[to] > at {
        return None;
    }
    let possible = if from == look || to == look {
        let (next, beyond) = if from == look { (seen[1], seen[2]) } else { (seen[last - 1], seen[last - 2]) };
        (at + (at - next).abs().max((next - beyond).abs())) / (1.0 + LEAST)
    } else {
        let bend = 2.0 * at - seen[from] - seen[to];
        at + (seen[to] - seen[from]).powi(2) / (2.0 * bend.max(f64::MIN_POSITIVE))
    };
    Some((possible, from, to))
}

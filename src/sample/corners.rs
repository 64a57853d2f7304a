//! How far a corner of a chain of boxes can be from where it should be: a proven bound.
//!
//! A corner's place is a sum of vectors, each turned by all rotations above it. With Ω the
//! sum of their speeds and A that of their accelerations and of all products of two of the
//! speeds, a vector v so turned has an acceleration of at most |v| (A + Ω²). Between two
//! moments h apart the difference of two such places is at most as far as a parabola says
//! that rises h²/8 of the sum of both accelerations above the distances there. Branch and
//! bound makes it close. The argument: docs/math/deviation.md.

use super::blend::{self, Blend};
use super::deviation::{NEGLIGIBLE, on_stretch, whole, written};
use super::translations::{Travel, straight_bound};
use super::worst::{Gap, Part, Worst};
use crate::curve::{Arc, Motion, Piece, Rates};
use crate::math::Quat;
use glam::{DQuat, DVec3};
use rayon::prelude::*;
use std::f64::consts::FRAC_1_SQRT_2;

/// A rotation, and the keys from which it is played by slerp.
pub(crate) struct Limb<'a> {
    pub(crate) motion: Motion<'a>,
    pub(crate) times: &'a [f32],
    pub(crate) written: &'a [[f32; 4]],
}

/// A way, and the keys from which it is played straight.
pub(crate) struct Trail<'a> {
    pub(crate) travel: &'a dyn Travel,
    pub(crate) times: &'a [f32],
    pub(crate) written: &'a [[f32; 3]],
}

/// Boxes of a length, each hinged to the end of the one above; all turned by what stands
/// first, where the root turns, and carried by the root.
pub(crate) struct Chain<'a> {
    pub(crate) root: Option<Trail<'a>>,
    /// The root's rotation, if it has one, then the boxes'.
    pub(crate) limbs: Vec<Limb<'a>>,
    /// Whether the first limb is the root.
    pub(crate) root_turns: bool,
    pub(crate) length: f64,
}

/// Parts that are bounded at once.
const BLOCK: usize = 1024;
/// How often a part is halved before its own rates are worked out.
const CHEAP: u32 = 3;

/// An upper bound of the distance between any corner and its playback, at any time.
pub(crate) fn largest_displacement(chain: &Chain) -> f64 {
    let moments = chain.moments();
    // What is found at the moments and half way says early what is worth refining.
    let looked: Vec<Vec<[f64; 3]>> = blocks(&moments).map(|block| chain.look(block)).collect();
    let mut worst = Worst::new(2.0 * NEGLIGIBLE * chain.reach());
    looked.iter().flatten().flatten().for_each(|&off| worst.note(off));
    let bounds = blocks(&moments).zip(&looked).map(|(block, looked)| chain.bound(block, looked, worst));
    bounds.reduce(|| worst.found, f64::max) + chain.uneven_lengths()
}

/// The moments in blocks, each of which begins with the last of the one before.
fn blocks(moments: &[f64]) -> impl IndexedParallelIterator<Item = &[f64]> {
    let starts = (moments.len() - 1).div_ceil(BLOCK);
    (0..starts).into_par_iter().map(move |i| {
        let from = i * BLOCK;
        &moments[from..moments.len().min(from + BLOCK + 1)]
    })
}

/// Where each limb's keys and pieces were found last.
#[derive(Default)]
struct Cursor {
    keys: Vec<usize>,
    pieces: Vec<Option<Piece>>,
}

impl Cursor {
    /// The last key at or before a time, of the limb of that number; times do not fall.
    fn key(&mut self, limb: usize, times: &[f32], t: f64) -> usize {
        if self.keys.len() <= limb {
            self.keys.resize(limb + 1, usize::MAX);
        }
        let key = &mut self.keys[limb];
        if *key == usize::MAX {
            *key = times.partition_point(|&time| f64::from(time) <= t).saturating_sub(1);
        }
        while times.get(*key + 1).is_some_and(|&next| f64::from(next) <= t) {
            *key += 1;
        }
        *key
    }

    /// The piece of a motion at a time, of the limb of that number.
    fn piece(&mut self, limb: usize, motion: &Motion, t: f64) -> Piece {
        if self.pieces.len() <= limb {
            self.pieces.resize(limb + 1, None);
        }
        match self.pieces[limb] {
            Some(piece) if piece.start <= t && t < piece.end => piece,
            _ => *self.pieces[limb].insert(motion.piece_at(t)),
        }
    }
}

impl Chain<'_> {
    /// The distances at the start, half way and at the end of the stretches between moments.
    fn look(&self, moments: &[f64]) -> Vec<[f64; 3]> {
        let mut cursor = Cursor::default();
        // The start is looked at anew: some schemes jump at keys.
        let look = |pair: &[f64]| {
            let stretch = self.stretch(&mut cursor, pair[0], pair[1]);
            [pair[0], 0.5 * (pair[0] + pair[1]), pair[1]].map(|t| stretch.at(t))
        };
        moments.windows(2).map(look).collect()
    }

    /// An upper bound over all stretches, from what was found there.
    fn bound(&self, moments: &[f64], looked: &[[f64; 3]], mut worst: Worst) -> f64 {
        let mut cursor = Cursor::default();
        for (pair, &[at_from, at_middle, at_to]) in moments.windows(2).zip(looked) {
            let (from, to, middle) = (pair[0], pair[1], 0.5 * (pair[0] + pair[1]));
            let stretch = self.stretch(&mut cursor, from, to);
            let rates = stretch.whole_rates();
            worst.search(&stretch, Part { from, to: middle, at_from, at_to: at_middle }, rates, CHEAP);
            worst.search(&stretch, Part { from: middle, to, at_from: at_middle, at_to }, rates, CHEAP);
        }
        worst.bound()
    }

    /// All times at which anything may cease to be smooth, increasing.
    fn moments(&self) -> Vec<f64> {
        let mut times: Vec<f64> = Vec::new();
        for limb in &self.limbs {
            times.extend(limb.times.iter().map(|&t| f64::from(t)));
            times.extend(limb.motion.times().iter().copied().chain(limb.motion.ramp()));
        }
        if let Some(trail) = &self.root {
            times.extend(trail.times.iter().map(|&t| f64::from(t)));
            times.extend(trail.travel.knots());
        }
        times.retain(|&t| t >= 0.0);
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// How far the last corner can be from the root.
    fn reach(&self) -> f64 {
        let boxes = self.limbs.len() - usize::from(self.root_turns);
        (boxes - 1) as f64 * self.length + self.corner()
    }

    /// How far a box's corners are from its hinge at most.
    fn corner(&self) -> f64 {
        self.length.hypot(FRAC_1_SQRT_2)
    }

    fn stretch(&self, cursor: &mut Cursor, from: f64, to: f64) -> Stretch<'_> {
        let turns = self.limbs.iter().enumerate().map(|(i, limb)| {
            let key = cursor.key(i + 1, limb.times, from);
            let between = Between::new(limb.times, limb.written, key).map(written);
            let step = between.ends[0].aligned_to(between.ends[1]).conjugate() * between.ends[1];
            let piece = cursor.piece(i, &limb.motion, from);
            Turn { piece, start: between.ends[0], way: step.log(), between }
        });
        let turns = turns.collect();
        let trail = self.root.as_ref().map(|trail| {
            let key = cursor.key(0, trail.times, from);
            let place = |p: [f32; 3]| DVec3::from_array(p.map(f64::from));
            (trail.travel, Between::new(trail.times, trail.written, key).map(place))
        });
        Stretch { chain: self, from, to, turns, trail }
    }

    /// What players may differ by over keys whose lengths are not quite one.
    fn uneven_lengths(&self) -> f64 {
        let turn = |q: &[[f32; 4]]| 0.5 * written(q[0]).angle_to(written(q[1]));
        let largest = |limb: &Limb| limb.written.windows(2).map(turn).fold(0.0, f64::max);
        let uneven = |limb: &Limb| 2.0 * blend::uneven_lengths(Blend::Slerp, largest(limb));
        self.limbs.iter().map(uneven).sum::<f64>() * self.reach()
    }
}

/// Two keys in a row and the times between them; one key alone, which holds.
#[derive(Clone, Copy)]
struct Between<T> {
    start: f64,
    /// Zero where it holds.
    rate: f64,
    ends: [T; 2],
}

impl<T: Copy> Between<T> {
    fn new(times: &[f32], values: &[T], key: usize) -> Between<T> {
        let start = f64::from(times[key]);
        match times.get(key + 1) {
            Some(&next) => {
                let rate = 1.0 / (f64::from(next) - start);
                Between { start, rate, ends: [values[key], values[key + 1]] }
            }
            None => Between { start, rate: 0.0, ends: [values[key]; 2] },
        }
    }

    fn map<U>(self, f: impl Fn(T) -> U) -> Between<U> {
        Between { start: self.start, rate: self.rate, ends: self.ends.map(f) }
    }

    fn place(&self, t: f64) -> f64 {
        ((t - self.start) * self.rate).max(0.0)
    }
}

/// A rotation and its playback on a stretch on which both are smooth.
struct Turn {
    piece: Piece,
    start: Quat,
    /// The logarithm of the step that playback takes.
    way: crate::math::Vec3,
    between: Between<Quat>,
}

/// All of a chain on such a stretch.
struct Stretch<'a> {
    chain: &'a Chain<'a>,
    from: f64,
    to: f64,
    turns: Vec<Turn>,
    trail: Option<(&'a dyn Travel, Between<DVec3>)>,
}

impl Stretch<'_> {
    /// The motion's and playback's rates, as angles by second.
    fn rates_by(&self, of_piece: impl Fn(&Piece) -> Rates, (from, to): (f64, f64)) -> Rates {
        let moves = |turn: &Turn| {
            let Rates { speed, acceleration } = of_piece(&turn.piece);
            [2.0 * speed, 2.0 * acceleration]
        };
        let plays = |turn: &Turn| [2.0 * turn.way.length() * turn.between.rate, 0.0];
        let (moved, played) = (self.corner_rates(moves), self.corner_rates(plays));
        let mut rates = Rates {
            speed: moved.speed + played.speed,
            acceleration: moved.acceleration + played.acceleration,
        };
        if let Some((travel, between)) = &self.trail {
            let walked = between.ends[0].distance(between.ends[1]) * between.rate;
            rates.speed += travel.speed_bound(from, to) + walked;
            rates.acceleration += travel.acceleration_bound(from, to);
        }
        rates
    }

    /// Speed and acceleration of the last box's corners from those of all rotations.
    fn corner_rates(&self, of: impl Fn(&Turn) -> [f64; 2]) -> Rates {
        let (mut spin, mut bend) = (0.0, 0.0);
        let mut rates = Rates { speed: 0.0, acceleration: 0.0 };
        let last = self.turns.len() - 1;
        for (i, turn) in self.turns.iter().enumerate() {
            let [speed, acceleration] = of(turn);
            bend += acceleration + spin * speed;
            spin += speed;
            let arm = match i {
                0 if self.chain.root_turns => 0.0,
                i if i == last => self.chain.corner(),
                _ => self.chain.length,
            };
            rates.speed += arm * spin;
            rates.acceleration += arm * (bend + spin * spin);
        }
        rates
    }

    /// Rates of the whole pieces, cheap.
    fn whole_rates(&self) -> Rates {
        self.rates_by(|piece| moving(piece).map_or(RESTING, whole), (self.from, self.to))
    }
}

impl Gap for Stretch<'_> {
    fn at(&self, t: f64) -> f64 {
        // Where the hinge is, and how what hangs there is turned: as it should, as played.
        let mut places = [DVec3::ZERO; 2];
        if let Some((travel, between)) = &self.trail {
            let [a, b] = between.ends;
            places = [travel.at(t), a.lerp(b, between.place(t))];
        }
        let mut turned = [DQuat::IDENTITY; 2];
        let mut worst: f64 = 0.0;
        for (i, turn) in self.turns.iter().enumerate() {
            let exact = turn.piece.at(turn.piece.parameter(t));
            let played = turn.start * Quat::exp(turn.way * turn.between.place(t));
            turned = [turned[0] * DQuat::from(exact), turned[1] * DQuat::from(played)];
            if i == 0 && self.chain.root_turns {
                continue;
            }
            worst = worst.max(corners(self.chain.length, places, turned));
            let down = DVec3::NEG_Y * self.chain.length;
            places = [places[0] + turned[0] * down, places[1] + turned[1] * down];
        }
        worst
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        self.rates_by(|piece| moving(piece).map_or(RESTING, |piece| on_stretch(piece, from, to)), (from, to))
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        straight_bound(rates, part.to - part.from, (part.at_from, part.at_to), 0.0)
    }
}

const RESTING: Rates = Rates { speed: 0.0, acceleration: 0.0 };

/// A piece, unless it is the rest after the last key, which has no end.
fn moving(piece: &Piece) -> Option<&Piece> {
    piece.end.is_finite().then_some(piece)
}

/// The largest distance between the corners of a box, unit square and of a length, at two
/// places and turned in two ways.
fn corners(length: f64, places: [DVec3; 2], turned: [DQuat; 2]) -> f64 {
    let off = places[0] - places[1];
    let axis = |v: DVec3| turned[0] * v - turned[1] * v;
    let (x, y, z) = (axis(DVec3::X) * 0.5, axis(DVec3::NEG_Y) * length, axis(DVec3::Z) * 0.5);
    let mut worst: f64 = 0.0;
    for middle in [off, off + y] {
        for corner in [middle + x + z, middle + x - z, middle - x + z, middle - x - z] {
            worst = worst.max(corner.length_squared());
        }
    }
    worst.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Ends, Scheme};
    use crate::math::Vec3;
    use glam::DMat4;

    /// Three boxes' keys with steps up to about 100°.
    fn keys(seed: f64, count: usize) -> Vec<Quat> {
        let wave = |i: usize, k: f64| (k * i as f64 + seed).sin();
        let turn = |i: usize| Vec3::new(wave(i, 1.3), wave(i, 2.3), wave(i, 4.1)) * 0.5;
        (0..count)
            .scan(Quat::IDENTITY, |q, i| {
                *q = *q * Quat::exp(turn(i));
                Some(*q)
            })
            .collect()
    }

    /// Straight on, and round.
    struct Round;

    impl Travel for Round {
        fn at(&self, t: f64) -> DVec3 {
            DVec3::new(t.sin(), 0.0, t.cos()) * 2.0
        }
        fn acceleration_bound(&self, _: f64, _: f64) -> f64 {
            2.0
        }
        fn speed_bound(&self, _: f64, _: f64) -> f64 {
            2.0
        }
        fn knots(&self) -> &[f64] {
            &[0.0, 6.0]
        }
    }

    /// The largest displacement at many times, by matrices and another slerp.
    fn measured(chain: &Chain, end: f64) -> f64 {
        let played = |times: &[f32], t: f64| {
            let after = times.partition_point(|&time| f64::from(time) <= t).clamp(1, times.len().max(2) - 1);
            let (a, b) = (f64::from(times[after - 1]), f64::from(times[after]));
            (after, ((t - a) / (b - a)).clamp(0.0, 1.0))
        };
        let mut worst: f64 = 0.0;
        for i in 0..=60_000 {
            let t = end * f64::from(i) / 60_000.0;
            let mut world = [DMat4::IDENTITY; 2];
            if let Some(trail) = &chain.root {
                let (after, u) = played(trail.times, t);
                let place = |k: usize| DVec3::from_array(trail.written[k].map(f64::from));
                world =
                    [trail.travel.at(t), place(after - 1).lerp(place(after), u)].map(DMat4::from_translation);
            }
            for (i, limb) in chain.limbs.iter().enumerate() {
                let (after, u) = played(limb.times, t);
                let key = |k: usize| DQuat::from_array(limb.written[k].map(f64::from)).normalize();
                let turned = [DQuat::from(limb.motion.at(t)), key(after - 1).slerp(key(after), u)];
                world = [0, 1].map(|k| world[k] * DMat4::from_quat(turned[k]));
                if i == 0 && chain.root_turns {
                    continue;
                }
                for corner in 0..8 {
                    let side = |bit: i32| if corner & bit == 0 { 0.5 } else { -0.5 };
                    let point =
                        DVec3::new(side(1), if corner & 4 == 0 { 0.0 } else { -chain.length }, side(2));
                    worst = worst
                        .max(world[0].transform_point3(point).distance(world[1].transform_point3(point)));
                }
                world = world.map(|w| w * DMat4::from_translation(DVec3::NEG_Y * chain.length));
            }
        }
        worst
    }

    #[test]
    fn bound_is_above_what_is_measured_and_near_it() {
        let times = [0.0, 1.0, 1.7, 3.2, 4.0, 6.0];
        let all: Vec<Vec<Quat>> = (0..3).map(|seed| keys(f64::from(seed), times.len())).collect();
        for (scheme, spacings) in [(Scheme::Bessel, [0.1, 0.1, 0.1]), (Scheme::Squad, [0.05, 0.13, 0.31])] {
            for (root_turns, travels) in [(false, false), (true, true)] {
                let grids: Vec<Vec<f32>> = spacings
                    .iter()
                    .map(|h| (0..=(6.0 / h) as usize).map(|i| (h * i as f64) as f32).chain([6.0]).collect())
                    .map(|mut grid: Vec<f32>| {
                        grid.dedup();
                        grid
                    })
                    .collect();
                let motions: Vec<Motion> =
                    all.iter().map(|keys| Motion::new(&times, keys, scheme, Ends::Natural)).collect();
                let written: Vec<Vec<[f32; 4]>> = motions
                    .iter()
                    .zip(&grids)
                    .map(|(motion, grid)| {
                        grid.iter().map(|&t| motion.at(f64::from(t)).to_xyzw().map(|x| x as f32)).collect()
                    })
                    .collect();
                let places: Vec<[f32; 3]> =
                    grids[0].iter().map(|&t| Round.at(f64::from(t)).as_vec3().to_array()).collect();
                let limbs = motions
                    .iter()
                    .zip(grids.iter().zip(&written))
                    .map(|(motion, (times, written))| Limb { motion: motion.clone(), times, written });
                let chain = Chain {
                    root: travels.then_some(Trail { travel: &Round, times: &grids[0], written: &places }),
                    limbs: limbs.collect(),
                    root_turns,
                    length: 2.5,
                };
                let (bound, worst) = (largest_displacement(&chain), measured(&chain, 6.0));
                assert!(bound >= worst, "{bound} {worst}");
                assert!(bound <= 1.055 * worst, "{bound} {worst}");
            }
        }
    }
}

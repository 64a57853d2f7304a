//! How far a corner of a chain of boxes can be from where it should be: a proven bound.
//!
//! A corner's place is a sum of vectors, each turned by all rotations above it; so is the
//! place where playback puts it. Both are nearly the same, and so are their accelerations: from
//! what all rotations do half way, and from how much the largest accelerations of single
//! rotations can change that, follows how fast the difference bends. It stays below a parabola
//! through its lengths at both ends. Branch and bound makes it close. The argument:
//! docs/math/deviation.md.

mod frame;

use super::blend;
use super::deviation::{NEGLIGIBLE, written};
use super::interlude::{on_stretch, whole};
use super::translations::{Travel, straight_bound};
use super::worst::{Gap, Part, Worst};
use crate::curve::{Arc, Motion, Piece, Rates};
use crate::math::{Jet, Quat, Vec3};
use frame::{Frame, Moment};
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

/// An upper bound of the distance between any corner and its playback, at any time; infinite
/// where rates of a rotation have no bound.
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
    /// With the largest rates there.
    pieces: Vec<Option<(Piece, Rates)>>,
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

    /// The piece of a motion at a time, of the limb of that number, and its largest rates.
    fn piece(&mut self, limb: usize, motion: &Motion, t: f64) -> (Piece, Rates) {
        if self.pieces.len() <= limb {
            self.pieces.resize(limb + 1, None);
        }
        match self.pieces[limb] {
            Some(known) if known.0.start <= t && t < known.0.end => known,
            _ => {
                let piece = motion.piece_at(t);
                *self.pieces[limb].insert((piece, moving(&piece).map_or(RESTING, whole)))
            }
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
            let rates = stretch.rates(from, to);
            if rates.acceleration.is_infinite() {
                return f64::INFINITY;
            }
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
        libm::hypot(self.length, FRAC_1_SQRT_2)
    }

    fn stretch(&self, cursor: &mut Cursor, from: f64, to: f64) -> Stretch<'_> {
        let turns = self.limbs.iter().enumerate().map(|(i, limb)| {
            let key = cursor.key(i + 1, limb.times, from);
            let between = Between::new(limb.times, limb.written, key).map(written);
            let step = between.ends[0].aligned_to(between.ends[1]).conjugate() * between.ends[1];
            let (piece, whole) = cursor.piece(i, &limb.motion, from);
            let rates = if whole.acceleration.is_finite() { whole } else { on_stretch(&piece, from, to) };
            Turn { piece, rates, start: between.ends[0], way: step.log(), between }
        });
        let turns = turns.collect();
        let trail = self.root.as_ref().map(|trail| {
            let key = cursor.key(0, trail.times, from);
            let place = |p: [f32; 3]| DVec3::from_array(p.map(f64::from));
            (trail.travel, Between::new(trail.times, trail.written, key).map(place))
        });
        Stretch { chain: self, turns, trail }
    }

    /// What players may differ by over keys whose lengths are not quite one.
    fn uneven_lengths(&self) -> f64 {
        let turn = |q: &[[f32; 4]]| 0.5 * written(q[0]).angle_to(written(q[1]));
        let largest = |limb: &Limb| limb.written.windows(2).map(turn).fold(0.0, f64::max);
        let uneven = |limb: &Limb| 2.0 * blend::uneven_lengths(largest(limb), blend::lengths(limb.written));
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
    /// The largest of all the piece, or of the stretch.
    rates: Rates,
    start: Quat,
    /// The logarithm of the step that playback takes.
    way: Vec3,
    between: Between<Quat>,
}

impl Turn {
    fn at(&self, t: f64) -> Moment {
        let played = self.start * Quat::exp(self.way * self.between.place(t));
        let plays = vector(self.way) * (2.0 * self.between.rate);
        let Some(piece) = moving(&self.piece) else {
            let rest = self.piece.at(0.0);
            return Moment { turned: [rest.into(), played.into()], spins: [DVec3::ZERO, plays] };
        };
        let exact = piece.at(Jet::variable(piece.parameter(t)));
        let moves = vector(exact.half_velocity()) * (2.0 / piece.duration());
        Moment { turned: [exact.value().into(), played.into()], spins: [moves, plays] }
    }
}

fn vector(v: Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// All of a chain on such a stretch.
struct Stretch<'a> {
    chain: &'a Chain<'a>,
    turns: Vec<Turn>,
    trail: Option<(&'a dyn Travel, Between<DVec3>)>,
}

impl Stretch<'_> {
    /// How fast the difference of both places of a corner changes, and bends, between two
    /// times, from what every rotation does half way and the rates of its piece.
    fn difference(&self, from: f64, to: f64) -> Rates {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut rates = RESTING;
        if let Some((travel, between)) = &self.trail {
            let walked = between.ends[0].distance(between.ends[1]) * between.rate;
            rates.speed = travel.speed_bound(from, to) + walked;
            rates.acceleration = travel.acceleration_bound(from, to);
        }
        let (mut frame, mut hinge) = (Frame::default(), rates);
        for (i, turn) in self.turns.iter().enumerate() {
            let Rates { speed, acceleration } = turn.rates;
            frame.turn(turn.at(middle), [2.0 * speed, 2.0 * acceleration], half);
            if i == 0 && self.chain.root_turns {
                continue;
            }
            let [carried, hung] = [self.chain.length, self.chain.corner()].map(|arm| frame.rates(arm));
            let most = |corner: f64, hinge: f64, hung: f64| corner.max(hinge + hung);
            rates.speed = most(rates.speed, hinge.speed, hung.speed);
            rates.acceleration = most(rates.acceleration, hinge.acceleration, hung.acceleration);
            hinge.speed += carried.speed;
            hinge.acceleration += carried.acceleration;
        }
        rates
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
        self.difference(from, to)
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
    fn of_many_boxes_it_is_near_what_is_measured_too() {
        let times = [0.0, 0.4, 1.0, 1.3, 2.0];
        let keys: Vec<Vec<Quat>> = (0..40).map(|seed| keys(f64::from(seed), times.len())).collect();
        let grid: Vec<f32> = (0..=60).map(|i| i as f32 / 30.0).collect();
        let motion = |keys| Motion::new(&times, keys, Scheme::Bessel, Ends::Natural);
        let number = |motion: &Motion, &t: &f32| motion.at(f64::from(t)).to_xyzw().map(|x| x as f32);
        let motions: Vec<Motion> = keys.iter().map(|keys| motion(keys)).collect();
        let written: Vec<Vec<[f32; 4]>> =
            motions.iter().map(|motion| grid.iter().map(|t| number(motion, t)).collect()).collect();
        let limbs = motions.iter().zip(&written);
        let limbs = limbs.map(|(motion, written)| Limb { motion: motion.clone(), times: &grid, written });
        let limbs = limbs.collect();
        let chain = Chain { root: None, limbs, root_turns: false, length: 1.0 };
        let (bound, worst) = (largest_displacement(&chain), measured(&chain, 2.0));
        assert!(bound >= worst && bound <= 1.055 * worst, "{bound} {worst}");
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

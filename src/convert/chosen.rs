//! The keys of a move that has its own, in memory.

use crate::curve::Motion;
use crate::moves::Move;
use crate::reduce::Facts;
use crate::sample::{self, Encoding, Steps, Timeline, TrackFacts, Writing, code};
use crate::write::Interpolation;
use std::cell::LazyCell;
use std::convert::Infallible;

/// The keys of one move.
#[derive(Clone, Debug)]
pub(super) struct Chosen {
    pub(super) times: Vec<f32>,
    pub(super) values: Values,
    pub(super) facts: TrackFacts,
    /// How far playback is from the input's keys, where they were moved.
    pub(super) keys_moved: Option<f64>,
    pub(super) interpolation: Interpolation,
}

/// What stands at the keys; of cubics tangent in, value, tangent out.
#[derive(Clone, Debug)]
pub(super) enum Values {
    Rotations(Vec<[f32; 4]>),
    Places(Vec<[f32; 3]>),
    CubicRotations(Vec<[[f32; 4]; 3]>),
    CubicPlaces(Vec<[[f32; 3]; 3]>),
}

impl Values {
    pub(super) fn keys(&self) -> usize {
        match self {
            Values::Rotations(all) => all.len(),
            Values::Places(all) => all.len(),
            Values::CubicRotations(all) => all.len(),
            Values::CubicPlaces(all) => all.len(),
        }
    }

    /// How many values a key has.
    pub(super) fn per_key(&self) -> u64 {
        match self {
            Values::Rotations(_) | Values::Places(_) => 1,
            Values::CubicRotations(_) | Values::CubicPlaces(_) => 3,
        }
    }

    pub(super) fn are_rotations(&self) -> bool {
        matches!(self, Values::Rotations(_) | Values::CubicRotations(_))
    }

    /// As the file holds them.
    pub(super) fn bytes(&self, encoding: Encoding) -> Vec<u8> {
        match self {
            Values::Rotations(all) => rotation_bytes(all, encoding),
            Values::Places(all) => little_endian(all),
            Values::CubicRotations(all) => little_endian(all.as_flattened()),
            Values::CubicPlaces(all) => little_endian(all.as_flattened()),
        }
    }

    /// Holds the last value for one key more.
    fn hold_last(&mut self) {
        fn again<T: Copy>(values: &mut Vec<T>) {
            values.extend(values.last().copied());
        }
        fn at_rest<const N: usize>(values: &mut Vec<[[f32; N]; 3]>) {
            values.extend(values.last().map(|&[_, value, _]| [[0.0; N], value, [0.0; N]]));
        }
        match self {
            Values::Rotations(all) => again(all),
            Values::Places(all) => again(all),
            Values::CubicRotations(all) => at_rest(all),
            Values::CubicPlaces(all) => at_rest(all),
        }
    }

    /// Holds the first value from one key before on.
    fn hold_first(&mut self) {
        match self {
            Values::Rotations(all) => all.insert(0, all[0]),
            Values::Places(all) => all.insert(0, all[0]),
            Values::CubicRotations(all) => all.insert(0, [[0.0; 4], all[0][1], [0.0; 4]]),
            Values::CubicPlaces(all) => all.insert(0, [[0.0; 3], all[0][1], [0.0; 3]]),
        }
    }
}

impl Chosen {
    /// Keys by what the search found out.
    pub(super) fn new(
        times: Vec<f32>,
        values: Values,
        facts: &Facts,
        interpolation: Interpolation,
    ) -> Chosen {
        let keys_moved = values.are_rotations().then_some(facts.keys_moved);
        Chosen { times, values, facts: known(facts), keys_moved, interpolation }
    }

    /// Holds the last value until `end`.
    pub(super) fn hold_until(&mut self, end: f32) {
        self.times.push(end);
        self.values.hold_last();
    }

    /// A key at 0 for what starts later: until then it waits.
    pub(super) fn wait(mut self) -> Chosen {
        if self.times[0] > 0.0 {
            self.times.insert(0, 0.0);
            self.values.hold_first();
        }
        self
    }

    /// Some players let cubics swing that end before the clip does: those last as long.
    pub(super) fn span(mut self, end: f32) -> Chosen {
        let last = self.times[self.times.len() - 1];
        if self.interpolation == Interpolation::CubicSpline && last < end {
            self.hold_until(end);
        }
        self
    }
}

/// What is known of chosen keys, as samplers say it.
fn known(facts: &Facts) -> TrackFacts {
    let Facts { deviation, nlerp, proven, largest_step, .. } = *facts;
    TrackFacts {
        deviation: proven.then_some(deviation),
        nlerp: Some(nlerp).filter(|nlerp| proven && nlerp.is_finite()),
        measured: (!proven).then_some(deviation),
        steps: Steps { large: 0, worst: largest_step, at: 0.0 },
    }
}

/// The moves of an object of which some are held from key to key: those by their keys, the
/// others by the samples of a timeline.
pub(super) fn held_and_sampled<M>(moves: &[(M, Move)], timeline: &Timeline, writing: Writing) -> Vec<Chosen> {
    // Many, of a clip that is long and held; then nothing asks for them.
    let times = LazyCell::new(|| {
        (0..timeline.chunks()).flat_map(|chunk| timeline.chunk(chunk).1).collect::<Vec<f32>>()
    });
    let one = |(_, a_move): &(M, Move)| match a_move {
        Move::Keys(motion) if motion.is_step() => held(motion, writing.encoding),
        other => sampled(other, timeline, &times, writing),
    };
    moves.iter().map(one).collect()
}

/// A motion that is held: its keys as they are.
pub(super) fn held(motion: &Motion, encoding: Encoding) -> Chosen {
    let mut written: Vec<[f32; 4]> = Vec::with_capacity(motion.times().len());
    let mut off: f64 = 0.0;
    for &t in motion.times() {
        let key = motion.at(t);
        let numbers = encoding.numbers(key);
        off = off.max(sample::written(numbers).angle_to(key).to_degrees());
        written.push(numbers);
    }
    let facts = TrackFacts { deviation: Some(off), nlerp: Some(off), ..TrackFacts::default() };
    let times = motion.times().iter().map(|&t| t as f32).collect();
    let (values, interpolation) = (Values::Rotations(written), Interpolation::Step);
    Chosen { times, values, facts, keys_moved: None, interpolation }.wait()
}

/// The samples of a timeline, in memory.
fn sampled(a_move: &Move, timeline: &Timeline, times: &[f32], writing: Writing) -> Chosen {
    let (mut turns, mut places) = (Vec::new(), Vec::new());
    let mut facts = TrackFacts::default();
    if let Some(rotation) = a_move.rotation() {
        let all = sample::rotations(&[rotation], timeline, writing, |chunk| {
            turns.extend_from_slice(chunk);
            Ok::<(), Infallible>(())
        });
        facts = all.map_or(facts, |all| all[0]);
    }
    if let Some(travel) = a_move.travel() {
        let distance = sample::translations(travel, timeline, writing.hold, |chunk| {
            places.extend_from_slice(chunk);
            Ok::<(), Infallible>(())
        });
        facts.deviation = distance.ok().filter(|_| writing.bound);
    }
    let values = if turns.is_empty() { Values::Places(places) } else { Values::Rotations(turns) };
    let interpolation = if writing.hold { Interpolation::Step } else { Interpolation::Linear };
    Chosen { times: times.to_vec(), values, facts, keys_moved: None, interpolation }
}

/// The bytes of rotations by an encoding.
pub(super) fn rotation_bytes(rotations: &[[f32; 4]], encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Float => little_endian(rotations),
        Encoding::Normalized16 => {
            rotations.as_flattened().iter().flat_map(|&number| code(number).to_le_bytes()).collect()
        }
    }
}

/// The bytes of float32 numbers.
pub(super) fn little_endian<const N: usize>(values: &[[f32; N]]) -> Vec<u8> {
    let bits: Vec<u32> = values.as_flattened().iter().map(|x| x.to_bits().to_le()).collect();
    bytemuck::cast_slice(&bits).to_vec()
}

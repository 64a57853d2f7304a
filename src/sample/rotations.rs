//! Every track at every sample time, in order and in parallel.

use super::deviation::{self, Stretch, written};
use super::{Encoding, Steps, Timeline};
use crate::curve::Motion;
use crate::math::Quat;
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;

/// A rotation as a function of time.
#[derive(Clone)]
pub enum Rotation<'a> {
    /// The motion through a track's keys.
    Motion(Motion<'a>),
    /// Any function of seconds; nothing is known of it between samples.
    Function(&'a (dyn Fn(f64) -> Quat + Sync)),
}

/// What is known of a track once it is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackFacts {
    /// An upper bound of the angle between the motion and the playback of its written
    /// samples by slerp, degrees; none for a function that nothing is known of.
    pub deviation: Option<f64>,
    /// The same for players that blend the four numbers and normalise, degrees.
    pub nlerp: Option<f64>,
    /// For a function that nothing is known of: the largest angle that was found, at
    /// samples and between them. What lies between those places may be a little more.
    pub measured: Option<f64>,
    /// Steps from sample to sample; the ramp of a jump does not count.
    pub steps: Steps,
}

/// How rotations become numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Writing {
    /// What numbers.
    pub encoding: Encoding,
    /// Whether to find out how far playback of them is from the motion.
    pub bound: bool,
    /// Whether each lasts until the next.
    pub hold: bool,
}

impl Default for Writing {
    fn default() -> Writing {
        Writing { encoding: Encoding::Float, bound: true, hold: false }
    }
}

/// Some samples of one track.
struct Chunk {
    rotations: Vec<[f32; 4]>,
    /// Whether an odd number of signs was turned along the chunk.
    turned: bool,
    facts: TrackFacts,
}

/// Evaluates every motion at every time of the timeline and hands the samples, x y z w
/// as float32, to `sink`: the first motion's from first to last, then the next one's.
///
/// Each rotation is evaluated at the float32 time that is written. Signs are continuous
/// from sample to sample. Memory: a few chunks. Returns what is known of each track.
pub fn rotations<E>(
    tracks: &[Rotation],
    timeline: &Timeline,
    writing: Writing,
    mut sink: impl FnMut(&[[f32; 4]]) -> Result<(), E>,
) -> Result<Vec<TrackFacts>, E> {
    let mut facts = vec![TrackFacts::default(); tracks.len()];
    let mut turned = false;
    // A chunk whose track is not would wait for another's to be.
    tracks.par_iter().for_each(|rotation| {
        if let Rotation::Motion(motion) = rotation {
            motion.solve();
        }
    });
    let hopeless: Vec<AtomicBool> = tracks.iter().map(|_| AtomicBool::new(false)).collect();
    let job = |track: usize, chunk| sample(&tracks[track], timeline, writing, chunk, &hopeless[track]);
    in_order(tracks.len(), timeline.chunks(), job, |track, chunk, mut samples: Chunk| {
        turned &= chunk > 0;
        if turned {
            samples.rotations.iter_mut().for_each(negate);
        }
        turned ^= samples.turned;
        let known = &mut facts[track];
        // f64::max would hide a chunk of which nothing is known.
        let worst = |known: Option<f64>, now: Option<f64>| match (chunk, known, now) {
            (0, _, first) => first,
            (_, Some(a), Some(b)) => Some(a.max(b)),
            _ => None,
        };
        known.deviation = worst(known.deviation, samples.facts.deviation);
        known.nlerp = worst(known.nlerp, samples.facts.nlerp);
        known.measured = worst(known.measured, samples.facts.measured);
        known.steps = known.steps.and(samples.facts.steps);
        sink(&samples.rotations)
    })?;
    Ok(facts)
}

/// Runs a job for every track and chunk, in parallel, and hands the results on in order:
/// the first track's chunks, then the next one's. Only some results wait at a time.
pub(super) fn in_order<T: Send, E>(
    tracks: usize,
    chunks: usize,
    job: impl Fn(usize, usize) -> T + Sync,
    mut sink: impl FnMut(usize, usize, T) -> Result<(), E>,
) -> Result<(), E> {
    let jobs: Vec<(usize, usize)> =
        (0..tracks).flat_map(|track| (0..chunks).map(move |chunk| (track, chunk))).collect();
    for batch in jobs.chunks(8 * rayon::current_num_threads()) {
        let done: Vec<T> = batch.par_iter().map(|&(track, chunk)| job(track, chunk)).collect();
        for (&(track, chunk), result) in batch.iter().zip(done) {
            sink(track, chunk, result)?;
        }
    }
    Ok(())
}

/// Samples a chunk. One of which no bound says anything makes its whole track `hopeless`.
fn sample(
    rotation: &Rotation,
    timeline: &Timeline,
    writing: Writing,
    chunk: usize,
    hopeless: &AtomicBool,
) -> Chunk {
    let (before, times) = timeline.chunk(chunk);
    let times: Vec<f32> = before.into_iter().chain(times).collect();
    let (exact, between) = match rotation {
        Rotation::Motion(motion) => (motion.at_all(&times), Vec::new()),
        Rotation::Function(at) => looked_at(at, &times, writing.bound),
    };
    let mut rotations: Vec<[f32; 4]> = exact.iter().map(|&q| writing.encoding.numbers(q)).collect();
    let turned = align(&mut rotations);
    let ramp = match rotation {
        Rotation::Motion(motion) => motion.ramp().map(|start| (start, motion.times()[1])),
        Rotation::Function(_) => None,
    };
    let mut facts = TrackFacts { steps: Steps::of(ramp, &times, &rotations), ..TrackFacts::default() };
    match rotation {
        Rotation::Motion(motion) if writing.bound => {
            let stretch = Stretch { motion, times: &times, exact: &exact, written: &rotations };
            let bounds = if writing.hold {
                deviation::held_bounds(&stretch)
            } else {
                deviation::upper_bounds(&stretch, hopeless)
            };
            facts.deviation = Some(bounds.slerp.to_degrees());
            facts.nlerp = Some(bounds.nlerp.to_degrees());
        }
        Rotation::Function(_) if writing.bound => {
            facts.measured = Some(measured(&exact, &between, &rotations, writing.hold));
        }
        Rotation::Motion(_) | Rotation::Function(_) => {}
    }
    rotations.drain(..usize::from(before.is_some()));
    Chunk { rotations, turned, facts }
}

/// Where between two samples a function is looked at, as parts of the interval: nearest to
/// the middle, where a parabola peaks, and beside it.
const BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];

/// A function at some times, and if asked for also between them: in the order of time, since it may
/// remember what it was asked last.
fn looked_at(at: &dyn Fn(f64) -> Quat, times: &[f32], between: bool) -> (Vec<Quat>, Vec<[Quat; 3]>) {
    let (mut exact, mut inside) = (Vec::with_capacity(times.len()), Vec::new());
    for (i, &t) in times.iter().enumerate() {
        let start = f64::from(t);
        exact.push(at(start));
        if let Some(&next) = times.get(i + 1).filter(|_| between) {
            inside.push(BETWEEN.map(|u| at(start + u * (f64::from(next) - start))));
        }
    }
    (exact, inside)
}

/// The largest angle, degrees, between a function and the playback of its samples that
/// shows at samples and between them.
fn measured(exact: &[Quat], between: &[[Quat; 3]], rotations: &[[f32; 4]], hold: bool) -> f64 {
    let mut worst: f64 = 0.0;
    let mut note = |played: Quat, exact: Quat| worst = worst.max(played.angle_to(exact).to_degrees());
    for (i, q) in rotations.windows(2).enumerate() {
        let (a, b) = (written(q[0]), written(q[1]));
        let to = if hold { a } else { b };
        let step = (a.conjugate() * to.aligned_to(a)).log();
        BETWEEN.into_iter().zip(between[i]).for_each(|(u, exact)| note(a * Quat::exp(step * u), exact));
        note(to, exact[i + 1]);
        note(b, exact[i + 1]);
    }
    worst
}

/// Turns signs so that neighbours lie in one hemisphere; says whether the last one's was.
fn align(rotations: &mut [[f32; 4]]) -> bool {
    let mut turned = false;
    for i in 1..rotations.len() {
        let before = rotations[i - 1];
        let dot: f32 = before.iter().zip(rotations[i]).map(|(a, b)| a * b).sum();
        turned = dot < 0.0;
        if turned {
            negate(&mut rotations[i]);
        }
    }
    turned
}

fn negate(q: &mut [f32; 4]) {
    *q = q.map(|x| -x);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Ends, Scheme};
    use crate::math::Vec3;

    #[test]
    fn signs_are_continuous_across_chunks() {
        // 400° between samples: quaternions turn by 200° and change hemisphere each time.
        let times: Vec<f64> = (0..20_000).map(f64::from).collect();
        let turn = |i: usize| Quat::exp(Vec3::new(0.0, 0.0, (50.0 * i as f64).to_radians()));
        let keys: Vec<Quat> = (0..times.len()).map(turn).collect();
        let motion = Motion::new(&times, &keys, Scheme::Slerp, Ends::Natural);
        let timeline = Timeline::new(&times, None, "1/4".parse().unwrap(), false).unwrap();
        assert!(timeline.chunks() > 1);
        let mut samples = Vec::new();
        let sink = |chunk: &[[f32; 4]]| {
            samples.extend_from_slice(chunk);
            Ok::<(), ()>(())
        };
        rotations(&[Rotation::Motion(motion)], &timeline, Writing::default(), sink).unwrap();
        let dots = samples.windows(2).map(|q| (0..4).map(|i| q[0][i] * q[1][i]).sum::<f32>());
        assert!(dots.fold(1.0, f32::min) > 0.0);
    }
    #[test]
    fn a_curve_that_jumps_is_hopeless_on_any_number_of_threads() {
        let axis =
            |i: usize| Vec3::new((i as f64).sin(), (1.7 * i as f64).cos(), (2.3 * i as f64 + 1.0).sin());
        let keys: Vec<Quat> = (0..3000)
            .scan(Quat::IDENTITY, |q, i| {
                *q = *q * Quat::exp(axis(i) * (75f64.to_radians() / axis(i).length()));
                Some(*q)
            })
            .collect();
        let times: Vec<f64> = (0..keys.len()).map(|i| i as f64 * 0.1 + 0.04 * (i as f64).sin()).collect();
        let motion = Motion::new(&times, &keys, Scheme::BarryGoldman, Ends::Natural);
        assert!((0..keys.len() - 1).any(|i| motion.swings(i)));
        let timeline = Timeline::new(&times, None, "60".parse().unwrap(), true).unwrap();
        assert!(timeline.chunks() > 3);
        let facts = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let tracks = [Rotation::Motion(motion.clone())];
            pool.install(|| rotations(&tracks, &timeline, Writing::default(), |_| Ok::<(), ()>(()))).unwrap()
        };
        let alone = facts(1);
        assert_eq!((alone[0].deviation, alone[0].nlerp), (Some(180.0), Some(180.0)));
        assert_eq!(facts(4), alone);
    }
}

//! Every track at every sample time, in order and in parallel.

use super::Timeline;
use super::deviation::{self, Stretch, written};
use crate::curve::{Arc, Motion, Piece};
use crate::math::Quat;
use rayon::prelude::*;

/// Turns between neighbouring samples that component-blending viewers show inexactly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steps {
    /// How many exceed [`Steps::LARGE`].
    pub large: usize,
    /// The largest, degrees.
    pub worst: f64,
    /// When that one begins, seconds.
    pub at: f64,
}

impl Steps {
    /// Blender blends the four numbers and normalises; up to this step, in degrees, it
    /// stays within 0.01° of slerp (about 1.2e-6 · step³).
    pub const LARGE: f64 = 18.0;

    fn and(self, b: Steps) -> Steps {
        let worse = if b.worst > self.worst { b } else { self };
        Steps { large: self.large + b.large, ..worse }
    }
}

/// What is known of a track once it is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackFacts {
    /// An upper bound of the angle between the motion and the playback of its written
    /// samples by slerp, degrees.
    pub deviation: f64,
    /// Steps from sample to sample; the ramp of a jump does not count.
    pub steps: Steps,
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
    motions: &[Motion],
    timeline: &Timeline,
    mut sink: impl FnMut(&[[f32; 4]]) -> Result<(), E>,
) -> Result<Vec<TrackFacts>, E> {
    let chunks = timeline.chunks();
    let jobs: Vec<(usize, usize)> =
        (0..motions.len()).flat_map(|track| (0..chunks).map(move |chunk| (track, chunk))).collect();
    let mut facts = vec![TrackFacts::default(); motions.len()];
    let mut turned = false;
    for batch in jobs.chunks(8 * rayon::current_num_threads()) {
        let sampled: Vec<Chunk> =
            batch.par_iter().map(|&(track, chunk)| sample(&motions[track], timeline, chunk)).collect();
        for (&(track, chunk), mut samples) in batch.iter().zip(sampled) {
            turned &= chunk > 0;
            if turned {
                samples.rotations.iter_mut().for_each(negate);
            }
            turned ^= samples.turned;
            sink(&samples.rotations)?;
            let known = &mut facts[track];
            known.deviation = known.deviation.max(samples.facts.deviation);
            known.steps = known.steps.and(samples.facts.steps);
        }
    }
    Ok(facts)
}

fn sample(motion: &Motion, timeline: &Timeline, chunk: usize) -> Chunk {
    let (before, times) = timeline.chunk(chunk);
    let times: Vec<f32> = before.into_iter().chain(times).collect();
    let exact = evaluate(motion, &times);
    let mut rotations: Vec<[f32; 4]> = exact.iter().map(|q| q.to_xyzw().map(|x| x as f32)).collect();
    let turned = align(&mut rotations);
    let stretch = Stretch { motion, times: &times, exact: &exact, written: &rotations };
    let facts = TrackFacts {
        deviation: deviation::upper_bound(&stretch).to_degrees(),
        steps: steps(motion, &times, &rotations),
    };
    rotations.drain(..usize::from(before.is_some()));
    Chunk { rotations, turned, facts }
}

/// The motion at increasing times.
fn evaluate(motion: &Motion, times: &[f32]) -> Vec<Quat> {
    let mut piece: Option<Piece> = None;
    let at = |&t: &f32| {
        let t = f64::from(t);
        let current = match piece {
            Some(current) if t < current.end => current,
            _ => *piece.insert(motion.piece_at(t)),
        };
        current.at(current.parameter(t))
    };
    times.iter().map(at).collect()
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

fn steps(motion: &Motion, times: &[f32], rotations: &[[f32; 4]]) -> Steps {
    let ramp = motion.ramp().map(|start| (start, motion.times()[1]));
    let mut steps = Steps::default();
    for (t, q) in times.windows(2).zip(rotations.windows(2)) {
        let (start, end) = (f64::from(t[0]), f64::from(t[1]));
        if ramp.is_some_and(|(from, to)| start < to as f32 as f64 && end > from as f32 as f64) {
            continue;
        }
        let degrees = written(q[0]).angle_to(written(q[1])).to_degrees();
        steps = steps.and(Steps { large: usize::from(degrees > Steps::LARGE), worst: degrees, at: start });
    }
    steps
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
        rotations(&[motion], &timeline, sink).unwrap();
        let dots = samples.windows(2).map(|q| (0..4).map(|i| q[0][i] * q[1][i]).sum::<f32>());
        assert!(dots.fold(1.0, f32::min) > 0.0);
    }
}

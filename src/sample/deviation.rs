//! How far playback of the written samples can be from the motion: a proven bound.
//!
//! Between two samples a viewer turns at constant speed; the motion does not. On a
//! stretch of h seconds within one smooth piece, let f be the distance of the two as
//! unit quaternions (half the angle), A the largest half angular acceleration of the
//! motion, and v the larger of both speeds in the same unit. The second variation of
//! distance on the unit sphere gives f″ ≥ −A − 2v² tan(f/2): f stays below the parabola
//! through both its ends whose second derivative is −(A + 1.1 v² F), as long as its peak
//! F is at most 1.
//!
//! A and v are known of a whole piece in closed form. Where the bound from these is
//! much above the worst that was found, the stretch is halved, and after some halvings
//! interval arithmetic bounds A and v on the stretch alone. The whole argument:
//! docs/math/deviation.md.

use crate::curve::{Arc, Motion, Piece, Rates};
use crate::math::{Interval, Quat};
use std::f64::consts::FRAC_PI_2;

/// Samples of a motion: exact, and as written.
pub(super) struct Stretch<'a> {
    pub(super) motion: &'a Motion<'a>,
    pub(super) times: &'a [f32],
    pub(super) exact: &'a [Quat],
    pub(super) written: &'a [[f32; 4]],
}

/// The written numbers as the unit quaternion they stand for.
pub(super) fn written(q: [f32; 4]) -> Quat {
    let q = Quat::from_xyzw(q.map(f64::from));
    let scale = 1.0 / q.norm();
    Quat { w: q.w * scale, v: q.v * scale }
}

/// How much the bound may exceed the worst that was found.
const SLACK: f64 = 1.05;
/// What is not worth refining, radians: below float32's own rounding.
const NEGLIGIBLE: f64 = 2e-8;
/// How often a stretch between two samples is halved at most.
const DEPTH: u32 = 14;
/// How often it is halved before its own rates are worked out.
const CHEAP: u32 = 3;

/// An upper bound, radians, of the angle between motion and playback.
pub(super) fn upper_bound(stretch: &Stretch) -> f64 {
    let mut search = Search::new(stretch);
    let mut i = 0;
    while i + 1 < stretch.times.len() {
        i = search.run_from(i);
    }
    2.0 * (search.bound.max(search.found) + search.uneven_lengths())
}

/// How much the lengths of two quaternions of four float32 numbers can differ: each
/// number is within 2⁻²⁵ of what makes its length 1.
const LENGTHS: f64 = 1.2e-7;

struct Search<'a> {
    stretch: &'a Stretch<'a>,
    playback: Vec<Quat>,
    /// Half angles between written and exact samples.
    at_samples: Vec<f64>,
    /// The largest half angle that was found.
    found: f64,
    /// The largest that was not excluded.
    bound: f64,
}

/// Two times between neighbouring samples, with the half angle found at each.
#[derive(Clone, Copy)]
struct Part {
    sample: usize,
    from: f64,
    to: f64,
    at_from: f64,
    at_to: f64,
}

impl<'a> Search<'a> {
    fn new(stretch: &'a Stretch<'a>) -> Search<'a> {
        let playback: Vec<Quat> = stretch.written.iter().map(|&q| written(q)).collect();
        let at_samples: Vec<f64> =
            playback.iter().zip(stretch.exact).map(|(p, q)| 0.5 * p.angle_to(*q)).collect();
        let found = at_samples.iter().copied().fold(0.0, f64::max);
        Search { stretch, playback, at_samples, found, bound: 0.0 }
    }

    /// What players may differ by in blending samples whose lengths are not quite one: the
    /// longer of two pulls the blend towards it, by at most the difference of their
    /// lengths times a quarter of the way between them.
    fn uneven_lengths(&self) -> f64 {
        let step = |pair: &[Quat]| 0.5 * pair[0].angle_to(pair[1]);
        0.25 * LENGTHS * self.playback.windows(2).map(step).fold(0.0, f64::max)
    }

    fn time(&self, i: usize) -> f64 {
        f64::from(self.stretch.times[i])
    }

    /// Bounds the intervals from sample i on that lie in one piece, or the one interval
    /// that does not; returns the sample where it stopped.
    fn run_from(&mut self, i: usize) -> usize {
        let piece = self.stretch.motion.piece_at(self.time(i));
        let inside = (i + 1..self.stretch.times.len()).take_while(|&j| self.time(j) <= piece.end).count();
        if inside == 0 {
            self.across(i);
            return i + 1;
        }
        self.probe(&piece, i, i + inside);
        self.within(&piece, i, i + inside);
        i + inside
    }

    /// Looks half way between the samples i..=j, so that the search knows early what is
    /// worth refining.
    fn probe(&mut self, piece: &Piece, i: usize, j: usize) {
        for k in i..j {
            let t = 0.5 * (self.time(k) + self.time(k + 1));
            self.found = self.found.max(self.half_angle(piece, k, t));
        }
    }

    /// Half the angle between motion and playback at a time after sample k.
    fn half_angle(&self, piece: &Piece, k: usize, t: f64) -> f64 {
        let (a, b) = (self.playback[k], self.playback[k + 1]);
        let u = (t - self.time(k)) / (self.time(k + 1) - self.time(k));
        let turn = a.conjugate() * b;
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let played = a * Quat::exp(turn.log() * u);
        0.5 * played.angle_to(piece.at(piece.parameter(t)))
    }

    fn good_enough(&self) -> f64 {
        SLACK * self.found.max(NEGLIGIBLE)
    }

    /// Bounds the intervals between the samples i..=j, all within the piece.
    fn within(&mut self, piece: &Piece, i: usize, j: usize) {
        let (from, to) = (self.time(i), self.time(j));
        let longest = (i..j).map(|k| self.time(k + 1) - self.time(k)).fold(0.0, f64::max);
        let ends = self.at_samples[i..=j].iter().copied().fold(0.0, f64::max);
        let speed = (i..j).map(|k| self.playback_speed(k)).fold(0.0, f64::max);
        let mut accept = |rates: Rates| self.accept(bound(rates, longest, ends, ends, speed));
        if accept(whole(piece)) || accept(on_stretch(piece, from, to)) {
            return;
        }
        if j - i > 1 {
            let middle = i + (j - i) / 2;
            self.within(piece, i, middle);
            self.within(piece, middle, j);
        } else {
            let (at_from, at_to) = (self.at_samples[i], self.at_samples[j]);
            let part = Part { sample: i, from, to, at_from, at_to };
            self.halve(piece, part, DEPTH - CHEAP);
        }
    }

    /// Bounds the interval after sample i, which spans more than one piece: at the knots
    /// inside the distance is known, and between them the motion is smooth.
    fn across(&mut self, i: usize) {
        let end = self.time(i + 1);
        let (mut from, mut at_from) = (self.time(i), self.at_samples[i]);
        while from < end {
            let piece = self.stretch.motion.piece_at(from);
            // After the last key the motion rests.
            let to = if piece.end > from { piece.end.min(end) } else { end };
            let at_to = if to < end { self.half_angle(&piece, i, to) } else { self.at_samples[i + 1] };
            self.found = self.found.max(at_to);
            self.part(&piece, Part { sample: i, from, to, at_from, at_to }, DEPTH);
            (from, at_from) = (to, at_to);
        }
    }

    fn part(&mut self, piece: &Piece, part: Part, depth: u32) {
        let Part { sample, from, to, at_from, at_to } = part;
        let playback = self.playback_speed(sample);
        let bound_by = |rates: Rates| bound(rates, to - from, at_from, at_to, playback);
        let mut rates = whole(piece);
        if self.accept(bound_by(rates)) {
            return;
        }
        if depth <= DEPTH - CHEAP {
            rates = rates.and(on_stretch(piece, from, to));
            if self.accept(bound_by(rates)) {
                return;
            }
        }
        if depth == 0 {
            self.bound = self.bound.max(bound_by(rates));
        } else {
            self.halve(piece, part, depth);
        }
    }

    /// Takes a bound if it is near enough to the worst that was found.
    fn accept(&mut self, bound: f64) -> bool {
        let good = bound <= self.good_enough();
        if good {
            self.bound = self.bound.max(bound);
        }
        good
    }

    fn halve(&mut self, piece: &Piece, part: Part, depth: u32) {
        let middle = 0.5 * (part.from + part.to);
        let at_middle = self.half_angle(piece, part.sample, middle);
        self.found = self.found.max(at_middle);
        self.part(piece, Part { to: middle, at_to: at_middle, ..part }, depth - 1);
        self.part(piece, Part { from: middle, at_from: at_middle, ..part }, depth - 1);
    }

    /// Half the angular speed of playback after sample k.
    fn playback_speed(&self, k: usize) -> f64 {
        0.5 * self.playback[k].angle_to(self.playback[k + 1]) / (self.time(k + 1) - self.time(k))
    }
}

/// Rates of a whole piece.
fn whole(piece: &Piece) -> Rates {
    piece.rates().per_second(piece.duration())
}

/// Rates of a piece between two times.
fn on_stretch(piece: &Piece, from: f64, to: f64) -> Rates {
    let u = Interval::new(piece.parameter(from), piece.parameter(to));
    Rates::within(piece, u).per_second(piece.duration())
}

/// The bound of the head of this file on a stretch of h seconds, with half the angle at
/// either end and half the angular speed of playback.
fn bound(rates: Rates, h: f64, at_from: f64, at_to: f64, playback: f64) -> f64 {
    let v = rates.speed.max(playback);
    let steady = at_from.max(at_to) + 0.5 * h * (rates.speed + playback);
    // f64::min takes the number where the other is none: an unknown bound is the largest
    // angle there is.
    if steady.is_nan() || steady > 1.0 {
        return steady.min(FRAC_PI_2);
    }
    // The peak raises the curvature that bounds it. Twice around from what holds in any
    // case takes off all but the last digits.
    let peak = |f: f64| parabola_peak(at_from, at_to, h * h / 8.0 * (rates.acceleration + 1.1 * v * v * f));
    let first = peak(steady).min(steady);
    peak(first).min(first)
}

/// The peak of the parabola through a at one end and b at the other that rises by
/// `sagitta` above the middle of their chord.
fn parabola_peak(a: f64, b: f64, sagitta: f64) -> f64 {
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
    use crate::curve::{Ends, Scheme};
    use crate::math::Vec3;
    use crate::sample::{Rotation, Timeline, rotations};

    fn keys(step: f64, count: usize) -> Vec<Quat> {
        let axis =
            |i: usize| Vec3::new((i as f64).sin(), (1.7 * i as f64).cos(), (2.3 * i as f64 + 1.0).sin());
        let turns = (0..count).scan(Quat::IDENTITY, |q, i| {
            let axis = axis(i);
            *q = *q * Quat::exp(axis * (step.to_radians() / 2.0 / axis.length()));
            Some(*q)
        });
        turns.collect()
    }

    /// The worst deviation by brute force: many times between any two samples.
    fn measured(motion: &Motion, times: &[f32], samples: &[[f32; 4]]) -> f64 {
        let mut worst: f64 = 0.0;
        for (t, q) in times.windows(2).zip(samples.windows(2)) {
            let (a, b) = (glam_of(q[0]), glam_of(q[1]));
            for i in 0..=40 {
                let u = f64::from(i) / 40.0;
                let time = f64::from(t[0]) + u * (f64::from(t[1]) - f64::from(t[0]));
                let played = Quat::from(a.slerp(b, u));
                worst = worst.max(played.angle_to(motion.at(time)));
            }
        }
        worst.to_degrees()
    }

    fn glam_of(q: [f32; 4]) -> glam::DQuat {
        glam::DQuat::from_array(q.map(f64::from)).normalize()
    }

    #[test]
    fn bound_holds_and_is_tight() {
        let uneven = [0.0, 0.31, 0.97, 1.21, 2.0, 2.6, 3.4];
        for &scheme in Scheme::ALL {
            for ends in [Ends::Natural, Ends::Clamped, Ends::Hold] {
                for step in [20.0, 70.0, 150.0] {
                    let keys = keys(step, 7);
                    let motion = Motion::new(&uneven, &keys, scheme, ends);
                    holds_and_is_tight(motion, &format!("{} {} {step}°", scheme.name(), ends.name()));
                }
            }
        }
        for step in [5.0, 20.0, 70.0] {
            let controls = keys(step, 19);
            holds_and_is_tight(Motion::through_controls(&uneven, &controls), &format!("controls {step}°"));
        }
    }

    fn holds_and_is_tight(motion: Motion, name: &str) {
        for (fps, key_times) in [("60", true), ("60", false), ("12", true), ("7", false)] {
            let fps_parsed = fps.parse().unwrap();
            let timeline = Timeline::new(motion.times(), motion.ramp(), fps_parsed, key_times).unwrap();
            let times: Vec<f32> = (0..timeline.chunks()).flat_map(|i| timeline.chunk(i).1).collect();
            let mut samples = Vec::new();
            let facts = rotations(&[Rotation::Motion(motion.clone())], &timeline, |chunk| {
                samples.extend_from_slice(chunk);
                Ok::<(), ()>(())
            });
            let bound = facts.unwrap()[0].deviation.unwrap();
            let worst = measured(&motion, &times, &samples);
            assert!(bound >= worst, "{name} {fps} {key_times}: bound {bound} < {worst}");
            // Forty probes an interval miss the peak by little; below float32's
            // rounding the bound is not refined.
            assert!(bound < 1.08 * worst + 3e-6, "{name} {fps} {key_times}: bound {bound}, worst {worst}");
        }
    }

    #[test]
    fn rest_has_no_deviation_beyond_rounding() {
        let keys = vec![Quat::exp(Vec3::new(0.1, 0.2, 0.3)); 5];
        let motion = Motion::new(&[0.0, 1.0, 2.0, 3.0, 4.0], &keys, Scheme::Bessel, Ends::Natural);
        let timeline = Timeline::new(motion.times(), None, "60".parse().unwrap(), true).unwrap();
        let facts = rotations(&[Rotation::Motion(motion)], &timeline, |_| Ok::<(), ()>(())).unwrap();
        // Four components, each within 2⁻²⁵ of its value.
        let deviation = facts[0].deviation.unwrap();
        assert!(deviation < 1e-5, "{deviation}");
    }
}

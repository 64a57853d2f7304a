//! Playback between two keys beside one smooth piece of the motion, and a bound of the distance.
//!
//! Between two samples a viewer turns at constant speed, or blends the four numbers and
//! normalises; the motion does neither. On a stretch of h seconds within one smooth
//! piece, let f be the distance of motion and playback as unit quaternions (half the
//! angle), A the sum of the largest half angular accelerations of both, and v the larger
//! of both speeds in the same unit. The second variation of distance on the unit sphere
//! gives f″ ≥ −A − 2v² tan(f/2): f stays below the parabola through both its ends whose
//! second derivative is −(A + 1.1 v² F), as long as its peak F is at most 1; with 4/π for
//! 1.1, at most π/2. The whole argument: docs/math/deviation.md.

use super::blend::{self, Blend};
use super::worst::{Gap, Part, parabola_peak};
use crate::curve::{Arc, Piece, Rates};
use crate::math::{Interval, Quat};
use std::f64::consts::FRAC_PI_2;

/// What a player shows between two keys.
#[derive(Clone, Copy, Debug)]
pub(super) struct Playback {
    /// When it begins, seconds.
    pub(super) from: f64,
    /// How long it takes, seconds.
    pub(super) h: f64,
    /// The two keys as they are written.
    pub(super) ends: [Quat; 2],
    /// Half the angle between them.
    pub(super) turn: f64,
    pub(super) blend: Blend,
}

impl Playback {
    /// Half the angle between playback and a rotation at a time.
    fn distance(&self, t: f64, q: Quat) -> f64 {
        let u = (t - self.from) / self.h;
        0.5 * self.blend.between(self.ends[0], self.ends[1], u).angle_to(q)
    }

    /// An upper bound of the distance on a part, from rates of the motion.
    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        let h = part.to - part.from;
        let steady = self.turn / self.h;
        match self.blend {
            Blend::Slerp => bound(rates, h, part.at_from, part.at_to, steady),
            Blend::Nlerp => {
                let place = |t: f64| (t - self.from) / self.h;
                let own = blend::rates(self.turn, place(part.from), place(part.to)).per_second(self.h);
                let sum = Rates { acceleration: rates.acceleration + own.acceleration, ..rates };
                bound(sum, h, part.at_from, part.at_to, own.speed)
            }
        }
    }
}

/// Playback beside a piece of the motion.
pub(super) struct Interlude<'a> {
    pub(super) piece: &'a Piece,
    pub(super) playback: Playback,
}

impl Gap for Interlude<'_> {
    fn at(&self, t: f64) -> f64 {
        self.playback.distance(t, self.piece.at(self.piece.parameter(t)))
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        on_stretch(self.piece, from, to)
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        self.playback.bound(part, rates)
    }
}

/// Rates of a whole piece.
pub(crate) fn whole(piece: &Piece) -> Rates {
    piece.rates().per_second(piece.duration())
}

/// Rates of a piece between two times.
pub(crate) fn on_stretch(piece: &Piece, from: f64, to: f64) -> Rates {
    let u = Interval::new(piece.parameter(from), piece.parameter(to));
    Rates::within(piece, u).per_second(piece.duration())
}

/// The bound of this file's head on a stretch of h seconds, with half the angle at
/// either end and half the angular speed of playback; the acceleration is that of both.
pub(crate) fn bound(rates: Rates, h: f64, at_from: f64, at_to: f64, playback: f64) -> f64 {
    let v = rates.speed.max(playback);
    let steady = at_from.max(at_to) + 0.5 * h * (rates.speed + playback);
    // f64::min takes the number where the other is none: an unknown bound is the largest
    // angle there is.
    if steady.is_nan() || steady >= FRAC_PI_2 {
        return FRAC_PI_2;
    }
    let bend = if steady <= 1.0 { 1.1 } else { 2.0 / FRAC_PI_2 };
    // The peak raises the curvature that bounds it. Twice around from what holds in any
    // case takes off all but the last digits.
    let peak = |f: f64| parabola_peak(at_from, at_to, h * h / 8.0 * (rates.acceleration + bend * v * v * f));
    let first = peak(steady).min(steady);
    peak(first).min(first)
}

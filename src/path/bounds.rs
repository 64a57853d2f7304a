//! Upper bounds of speed and acceleration, for proofs of how far playback can be off.

use super::Path;
use super::bezier::{Bezier, longest};
use glam::DVec3;

/// Covers the rounding of the bounds themselves, a few units in the last place.
const ROUNDING: f64 = 1.0 + 1e-12;

/// How often a stretch is halved where its hull says nothing of its curvature.
const DEPTH: u32 = 40;

impl Path {
    /// An upper bound of the speed from t0 to t1, units a second.
    ///
    /// A Bézier curve's derivative lies in the hull of its control points. Under
    /// constant speed it is the speed that the easing allows, exactly.
    pub fn speed_bound(&self, t0: f64, t1: f64) -> f64 {
        let bound = match self.steady {
            Some(_) => self.pace(t0, t1).0,
            None => self.largest(t0, t1, |curve, duration| longest(curve.hodograph()) / duration),
        };
        bound * self.unit * ROUNDING
    }

    /// An upper bound of |acceleration| from t0 to t1, units a second squared.
    ///
    /// For a stretch between neighbouring [`Path::corners`] and [`Path::jumps`]: a jump
    /// of the velocity is no acceleration. Under constant speed |s̈| + ṡ²κ with a bound of
    /// the curvature κ, which is infinite only where the curve has a cusp.
    pub fn acceleration_bound(&self, t0: f64, t1: f64) -> f64 {
        let bound = match self.steady {
            Some(_) => {
                let (speed, change) = self.pace(t0, t1);
                change + self.turning(t0, t1, speed)
            }
            None => self.largest(t0, t1, |curve, duration| {
                longest(&curve.second_hodograph()) / (duration * duration)
            }),
        };
        bound * self.unit * ROUNDING
    }

    /// The largest of a bound over the pieces from t0 to t1, which takes the part of the
    /// piece's curve, over 0..=1, and the time it takes.
    fn largest(&self, t0: f64, t1: f64, bound: impl Fn(&Bezier, f64) -> f64) -> f64 {
        let bounds =
            self.overlapping(t0, t1).map(|(piece, part, width)| bound(&part, piece.duration * width));
        bounds.fold(0.0, f64::max)
    }

    /// Bounds of ṡ and |s̈| under constant speed with its easing: s̈ is linear in time,
    /// so ṡ is largest at an end or half-way through the path, where s̈ changes its sign.
    fn pace(&self, t0: f64, t1: f64) -> (f64, f64) {
        let Some(ease) = self.steady else { return (0.0, 0.0) };
        let at = |t: f64| (t / self.duration).clamp(0.0, 1.0);
        let (from, to) = (at(t0), at(t1));
        let middle = 0.5f64.clamp(from.min(to), to);
        let largest = |k: usize| [from, middle, to].iter().map(|&x| ease.at(x)[k].abs()).fold(0.0, f64::max);
        let mean = self.length / self.duration;
        (largest(1) * mean, largest(2) * mean / self.duration)
    }

    /// ṡ²κ, at most.
    fn turning(&self, t0: f64, t1: f64, speed: f64) -> f64 {
        let bends = self.overlapping(t0, t1).map(|(_, part, _)| bend(&part, DEPTH));
        let bend = bends.fold(0.0, f64::max);
        if bend == 0.0 || speed == 0.0 { 0.0 } else { speed * speed * bend }
    }
}

/// An upper bound of the curvature |B′ × B″| / |B′|³. B′ × B″ is a mean of the products
/// of control points, and B′ at least as long as the least of its control points along
/// their sum. Where that is less than half of the longest, the halves are bounded.
fn bend(curve: &Bezier, depth: u32) -> f64 {
    let (first, second) = (curve.hodograph(), curve.second_hodograph());
    let towards = first.iter().sum::<DVec3>().normalize_or_zero();
    let least = first.iter().map(|v| v.dot(towards)).fold(f64::INFINITY, f64::min);
    let products = first.iter().flat_map(|a| second.iter().map(|b| a.cross(*b).length()));
    let across = products.fold(0.0, f64::max);
    // Rounding makes a line's product about 1e-16 of the factors.
    if across <= 4e-16 * longest(first) * longest(&second) {
        return 0.0;
    }
    if least > 0.5 * longest(first) {
        return across / (least * least * least);
    }
    if depth == 0 {
        return f64::INFINITY;
    }
    let [left, right] = curve.split(0.5);
    bend(&left, depth - 1).max(bend(&right, depth - 1))
}

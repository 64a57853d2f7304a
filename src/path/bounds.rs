//! Upper bounds of speed and acceleration, for proofs of how far playback can be off.

use super::Path;
use super::bezier::{Bezier, longest};
use super::piece::Piece;
use glam::DVec3;

/// Covers the rounding of bounds and rates, relative to the largest on the whole piece.
const ROUNDING: f64 = 1e-13;

/// How much wider the range of a parameter is taken: what inverting a length may err by.
const SLACK: f64 = 1e-12;

/// How often a stretch is halved where its hull says nothing of its curvature.
const DEPTH: u32 = 40;

impl Path {
    /// An upper bound of the speed from t0 to t1, units a second.
    ///
    /// A Bézier curve's derivative lies in the hull of its control points. Under
    /// constant speed the bound is the largest speed of the easing.
    pub fn speed_bound(&self, t0: f64, t1: f64) -> f64 {
        let bound = match self.steady {
            Some(_) => self.pace(t0, t1).0,
            None => self.largest(t0, t1, |hull, duration| hull.fastest() / duration),
        };
        bound * self.unit
    }

    /// An upper bound of |acceleration| from t0 to t1, units a second squared.
    ///
    /// For a stretch without [`Path::corners`] and [`Path::jumps`] inside: a jump of the
    /// velocity is no acceleration. Under constant speed |s̈| + ṡ²κ with a bound of the
    /// curvature κ, which is infinite only where the curve's derivative vanishes, at a cusp or under
    /// clamped ends, and the curve is not straight there: so is the acceleration itself.
    pub fn acceleration_bound(&self, t0: f64, t1: f64) -> f64 {
        let bound = match self.steady {
            Some(_) => {
                let (speed, change) = self.pace(t0, t1);
                let bend = self.largest(t0, t1, |hull, _| hull.bend(DEPTH));
                // On a line no speed makes an acceleration.
                if bend == 0.0 { change } else { change + speed * speed * bend }
            }
            None => self.largest(t0, t1, |hull, duration| hull.sharpest() / (duration * duration)),
        };
        bound * self.unit
    }

    /// The largest of a bound over the pieces from t0 to t1, which takes the hull of the
    /// piece's derivatives there and the time of the whole piece.
    fn largest(&self, t0: f64, t1: f64, bound: impl Fn(&Hull, f64) -> f64) -> f64 {
        let hulls = self.overlapping(t0, t1).map(|(piece, a, b)| (Hull::new(piece, a, b), piece.duration));
        hulls.map(|(hull, duration)| bound(&hull, duration)).fold(0.0, f64::max)
    }

    /// Bounds of ṡ and |s̈| under constant speed with its easing. s̈ is linear in time and
    /// ṡ a parabola with its top at one of the path's ends or half-way, so that both are
    /// largest at an end of the stretch or at the time in it that is nearest to half-way.
    fn pace(&self, t0: f64, t1: f64) -> (f64, f64) {
        let Some(ease) = self.steady else { return (0.0, 0.0) };
        let at = |t: f64| (t / self.duration).clamp(0.0, 1.0);
        let (from, to) = (at(t0), at(t1).max(at(t0)));
        let moments = [from, 0.5f64.clamp(from, to), to];
        let largest = |k: usize| moments.iter().map(|&x| ease.at(x)[k].abs()).fold(0.0, f64::max);
        let mean = self.length / self.duration;
        ((largest(1) + ROUNDING) * mean, (largest(2) + ROUNDING) * mean / self.duration)
    }
}

/// Control points of a piece's two derivatives over a range of its parameter, which hold
/// the derivatives in their hull. They are parts of the whole piece's derivatives: the
/// differences of points that lie close together would be rounding.
struct Hull {
    first: Bezier,
    second: Bezier,
    /// What their rounding is relative to: the largest on the whole piece.
    whole: [f64; 2],
    straight: bool,
}

impl Hull {
    fn new(piece: &Piece, a: f64, b: f64) -> Hull {
        let from = (a - SLACK).clamp(0.0, 1.0 - SLACK);
        let to = (b + SLACK).clamp(from + SLACK, 1.0);
        let first = piece.curve.hodograph().to_vec();
        let mut second = piece.curve.second_hodograph();
        if second.is_empty() {
            second.push(DVec3::ZERO); // of a straight line
        }
        // The second derivative carries the rounding of the first.
        let whole = [longest(&first), longest(&first) + longest(&second)];
        let [first, second] = [first, second].map(|points| Bezier::new(points).part(from, to));
        Hull { first, second, whole, straight: piece.is_straight() }
    }

    /// |B′| at most.
    fn fastest(&self) -> f64 {
        longest(self.first.points()) + ROUNDING * self.whole[0]
    }

    /// |B″| at most.
    fn sharpest(&self) -> f64 {
        longest(self.second.points()) + ROUNDING * self.whole[1]
    }

    /// The curvature |B′ × B″| / |B′|³ at most. B′ × B″ is a mean of the products of
    /// control points, and B′ at least as long as the least of its control points along
    /// their sum. Where that is less than half of the longest, the halves are bounded.
    fn bend(&self, depth: u32) -> f64 {
        if self.straight {
            return 0.0; // though it may run to and fro
        }
        let (first, second) = (self.first.points(), self.second.points());
        let towards = first.iter().sum::<DVec3>().normalize_or_zero();
        let least = first.iter().map(|v| v.dot(towards)).fold(f64::INFINITY, f64::min);
        let products = first.iter().flat_map(|a| second.iter().map(|b| a.cross(*b).length()));
        let across = products.fold(0.0, f64::max);
        let rounding = ROUNDING * longest(first) * self.whole[1];
        if least > 0.5 * longest(first) {
            return (across + rounding) / (least * least * least);
        }
        if depth == 0 {
            return f64::INFINITY;
        }
        let [left, right] = self.halves();
        left.bend(depth - 1).max(right.bend(depth - 1))
    }

    fn halves(&self) -> [Hull; 2] {
        let ([a, b], [c, d]) = (self.first.split(0.5), self.second.split(0.5));
        let hull = |first, second| Hull { first, second, whole: self.whole, straight: self.straight };
        [hull(a, c), hull(b, d)]
    }
}

//! Balls of ways to go, and what they have in common.

use crate::reduce::value::Step;

/// All steps a second within a radius of a centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball<S: Step> {
    pub(super) centre: S,
    pub(super) radius: f64,
}

impl<S: Step> Ball<S> {
    pub(super) fn holds(&self, way: S) -> bool {
        let off = way - self.centre;
        off.dot(off) <= self.radius * self.radius
    }

    /// The largest ball within both; none where they have no point in common.
    ///
    /// Along the line of the centres it is all that they share, across it less: the
    /// lens that two balls share is wider than it is thick.
    pub(super) fn meet(self, other: Ball<S>) -> Option<Ball<S>> {
        let between = other.centre - self.centre;
        let square = between.dot(between);
        let (sum, excess) = (self.radius + other.radius, other.radius - self.radius);
        if square > sum * sum {
            return None;
        }
        if square <= excess * excess {
            return Some(if excess > 0.0 { self } else { other });
        }
        let distance = square.sqrt();
        let radius = 0.5 * (sum - distance);
        let centre = self.centre + between * ((self.radius - radius) / distance);
        Some(Ball { centre, radius })
    }

    /// The point of the ball that is nearest to another.
    pub(super) fn nearest(&self, way: S) -> S {
        let off = way - self.centre;
        let length = off.length();
        if length <= self.radius { way } else { self.centre + off * (self.radius / length) }
    }
}

/// The last τ from `from` to `to` at which |p + eτ| ≤ rτ + ε: it is so at `from`, and not
/// at `to`. `p` and `e` are given by their scalar products p·p, p·e and e·e.
pub(super) fn last_within((pp, pe, ee): (f64, f64, f64), r: f64, epsilon: f64, from: f64, to: f64) -> f64 {
    // Squared: aτ² + 2bτ + c ≤ 0, which comes to be wrong at this of the two zeros.
    let (a, b, c) = (ee - r * r, pe - r * epsilon, pp - epsilon * epsilon);
    let root = (b * b - a * c).max(0.0).sqrt();
    let tau = if b > 0.0 { -c / (b + root) } else { (root - b) / a };
    if tau.is_finite() { tau.clamp(from, to) } else { from }
}

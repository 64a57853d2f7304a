//! Balls of ways to go, and what they have in common.

use crate::reduce::value::Step;

/// All steps a second within a radius of a centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball<S: Step> {
    pub(super) centre: S,
    pub(super) radius: f64,
}

impl<S: Step> Ball<S> {
    #[inline(always)]
    pub(super) fn holds(&self, way: S) -> bool {
        let off = way - self.centre;
        off.dot(off) <= self.radius * self.radius
    }

    /// The largest ball within both; none where they have no point in common.
    ///
    /// Along the line of the centres it is all that they share, across it less: the
    /// lens that two balls share is wider than it is thick.
    #[inline(always)]
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
}

/// The way from what a ball's centre makes of a stretch of time to the curve there, which
/// is taken to be straight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap<S: Step> {
    pub(super) ball: Ball<S>,
    /// τ where it begins, and how long it is.
    pub(super) from: f64,
    pub(super) h: f64,
    pub(super) start: S,
    pub(super) change: S,
}

impl<S: Step> Gap<S> {
    pub(super) fn at(&self, u: f64) -> S {
        self.start + self.change * u
    }

    /// The last u of 0 to 1 at which it is no longer than ε and what the ball allows; at 0
    /// it is not.
    pub(super) fn last_within(&self, epsilon: f64) -> f64 {
        // |s + cu| ≤ ru + q, squared: au² + 2bu + d ≤ 0, which comes to be wrong at this
        // of the two zeros.
        let (r, q) = (self.ball.radius * self.h, self.ball.radius * self.from + epsilon);
        let a = self.change.dot(self.change) - r * r;
        let b = self.start.dot(self.change) - r * q;
        let d = self.start.dot(self.start) - q * q;
        let root = (b * b - a * d).max(0.0).sqrt();
        let u = if b > 0.0 { -d / (b + root) } else { (root - b) / a };
        if u.is_finite() { u.clamp(0.0, 1.0) } else { 0.0 }
    }
}

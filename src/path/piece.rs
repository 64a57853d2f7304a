//! A stretch of a path on which it never rests but at its ends.

use super::arc_length::ArcLength;
use super::bezier::Bezier;
use super::cusps::REST;
use super::knots::COINCIDENT;
use glam::DVec3;

/// A Bézier curve, a segment or a part of one, without a point of rest inside.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) curve: Bezier,
    /// When it begins, seconds.
    pub(super) start: f64,
    /// When the next one begins, seconds.
    pub(super) end: f64,
    /// How long it takes, seconds, above 0: their difference, without its rounding.
    pub(super) duration: f64,
    /// Length of the path up to here.
    pub(super) before: f64,
    /// Under constant speed: its own arc length.
    pub(super) arc: Option<ArcLength>,
    /// The direction that holds where the piece has none: that of the piece before, or
    /// where all before rest, of the first that moves.
    pub(super) held: Option<DVec3>,
}

impl Piece {
    /// Whether all control points are one.
    pub(super) fn rests(&self) -> bool {
        self.curve.fastest() <= COINCIDENT
    }

    /// Whether it lies on a line, as far as rounding lets one tell.
    pub(super) fn is_straight(&self) -> bool {
        let hodograph = self.curve.hodograph();
        let fastest = self.curve.fastest();
        let Some(along) = hodograph.iter().find(|v| v.length() >= 0.5 * fastest) else { return true };
        hodograph.iter().all(|v| v.cross(along.normalize_or_zero()).length() <= 1e-14 * fastest)
    }

    /// Unit direction at its start: where control points coincide, the limit.
    pub(super) fn first_direction(&self) -> Option<DVec3> {
        self.limit(self.curve.hodograph().iter())
    }

    /// Unit direction at its end: where control points coincide, the limit.
    pub(super) fn last_direction(&self) -> Option<DVec3> {
        self.limit(self.curve.hodograph().iter().rev())
    }

    /// Near an end the first control point of the derivative that is not zero leads.
    fn limit<'a>(&self, mut derivatives: impl Iterator<Item = &'a DVec3>) -> Option<DVec3> {
        let fastest = self.curve.fastest();
        let moving = derivatives.find(|d| d.length() > REST * fastest);
        if self.rests() { None } else { moving.map(|d| d.normalize()) }
    }

    /// Unit direction at u, held from elsewhere where the piece rests.
    pub(super) fn direction(&self, u: f64) -> Option<DVec3> {
        let derivative = self.curve.derivative(u);
        if !self.rests() && derivative.length() > REST * self.curve.fastest() {
            return Some(derivative.normalize());
        }
        let limit = if u < 0.5 { self.first_direction() } else { self.last_direction() };
        limit.or(self.held)
    }
}

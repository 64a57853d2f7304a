//! What orientation needs of a path.

use glam::DVec3;

/// A position that runs along a curve over time, 0 to [`Course::duration`] seconds.
pub trait Course: Sync {
    /// How long the course takes, seconds.
    fn duration(&self) -> f64;
    /// When the course passes its key points, seconds; the first is 0.
    fn key_times(&self) -> &[f64];
    /// Whether the end runs into the start.
    fn is_closed(&self) -> bool;
    /// Position at t.
    fn position(&self, t: f64) -> DVec3;
    /// Velocity at t, units a second; where it jumps, the later one.
    fn velocity(&self, t: f64) -> DVec3;
    /// Acceleration at t, units a second squared; where it jumps, the later one.
    fn acceleration(&self, t: f64) -> DVec3;
    /// Velocity and acceleration at t, for the price of one where that is less.
    fn rates(&self, t: f64) -> [DVec3; 2] {
        [self.velocity(t), self.acceleration(t)]
    }
    /// Unit direction of travel at t; where the speed is zero, the limit from inside, else the last
    /// defined one; None if the whole course has none.
    fn direction(&self, t: f64) -> Option<DVec3>;
    /// Times where the direction jumps, increasing.
    fn corners(&self) -> &[f64];
}

//! What orientation needs to know of a path.

use glam::DVec3;

/// A point that moves from time 0 to `duration`, seconds.
pub trait Course: Sync {
    /// How long it moves, seconds.
    fn duration(&self) -> f64;
    /// Times of the key points, increasing, the first 0 and the last the duration.
    fn key_times(&self) -> &[f64];
    /// Whether the end runs into the start.
    fn is_closed(&self) -> bool;
    /// Where it is at a time.
    fn position(&self, t: f64) -> DVec3;
    /// The derivative of the position, units per second.
    fn velocity(&self, t: f64) -> DVec3;
    /// The derivative of the velocity, units per second².
    fn acceleration(&self, t: f64) -> DVec3;
    /// Unit direction of travel at t; where the speed is zero, the limit from inside,
    /// else the last defined one; None if the whole course has none.
    fn direction(&self, t: f64) -> Option<DVec3>;
    /// Times where the direction jumps, increasing.
    fn corners(&self) -> &[f64];
}

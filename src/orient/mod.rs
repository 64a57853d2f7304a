//! Rotations that follow from a path: where an object looks that moves along it.
//!
//! The object's forward is +Z, its up is +Y and its left +X, glTF's own axes.
//! [`keyed`] turns from key point to key point, [`Tangent`] faces the direction of
//! travel with the least possible twist, [`Upright`] does so with its head up and
//! leans into turns, and [`Levelled`] takes pitch and roll away towards an end.
//! [`Frame`], [`Euler`] and [`model_frame`] say in whose axes numbers are meant.
//!
//! Formulas and sources: docs/math/orientation.md.

mod axis_angle;
mod bank;
mod carry;
mod euler;
mod facing;
mod frame;
mod keyed;
mod level;
mod model;
mod passage;
mod recent;
mod signs;
mod steep;
mod steps;
mod tangent;
mod transport;
mod upright;

use crate::path::Course;
pub use axis_angle::axis_angle;
pub use euler::Euler;
pub(crate) use facing::turned;
pub use frame::Frame;
pub use keyed::keyed;
pub use level::{Level, Levelled};
pub use model::{Axis, ParallelAxes, model_frame};
pub use steps::{Spot, Steps};
pub use tangent::Tangent;
pub use upright::Upright;

use crate::math::Quat;
use signs::Signs;

/// A rotation at every time of a course.
pub trait Attitude: Sync {
    /// The rotation at a time, seconds; before the start and after the end that one's.
    /// Of unit length, its sign continuous wherever the rotation is.
    fn at(&self, t: f64) -> Quat {
        self.at_spot(&self.steps().spot(t))
    }

    /// The same at a place of the course.
    fn at_spot(&self, spot: &Spot) -> Quat;

    /// The steps of the course.
    fn steps(&self) -> &Steps<'_>;
}

impl<A: Attitude + ?Sized> Attitude for Box<A> {
    fn at_spot(&self, spot: &Spot) -> Quat {
        (**self).at_spot(spot)
    }

    fn steps(&self) -> &Steps<'_> {
        (**self).steps()
    }
}

/// The rotation that takes +Z to a unit vector, with up as near to +Y as it can be;
/// straight up or down with what pitching from +Z makes of it.
pub(crate) fn facing_upright(forward: glam::DVec3) -> Quat {
    facing::Facing::upright(forward).rotation()
}

/// 3x² − 2x³ on 0..=1, and the nearer end's value outside.
fn smoothstep(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The angle in (−π, π] that differs from this one by whole turns. Within 1e-9 of −π it
/// is π − 1e-9 or more: half a turn goes one way, whatever rounding says.
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let angle = angle - TAU * (angle / TAU).round();
    if angle < 1e-9 - PI { angle + TAU } else { angle }
}

/// Rotations whose signs follow on from each other.
fn continued(rotations: impl Iterator<Item = Quat>) -> Vec<Quat> {
    let mut before = None;
    let follow = |q: Quat| *before.insert(before.map_or(q, |b| q.aligned_to(b)));
    rotations.map(follow).collect()
}

#[cfg(test)]
mod tests;

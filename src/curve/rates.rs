//! How fast a curve can turn, and how fast its turning can change.

use super::Arc;
use crate::math::{Interval, Jet};

/// Upper bounds of half the angular speed and half the angular acceleration (the units
/// of logarithms) on a stretch of a curve, by the curve's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates<N = f64> {
    /// Half the angular speed.
    pub speed: N,
    /// Half the angular acceleration.
    pub acceleration: N,
}

impl Rates {
    /// Bounds on a range of u, by interval arithmetic on the curve's derivatives: near
    /// the truth where the range is short.
    pub fn within(arc: &impl Arc, u: Interval) -> Rates {
        let jet = arc.at(Jet::variable(u));
        Rates { speed: jet.half_velocity().longest(), acceleration: jet.half_acceleration().longest() }
    }

    /// The same curve run through in `duration` seconds, by seconds.
    pub fn per_second(self, duration: f64) -> Rates {
        Rates { speed: self.speed / duration, acceleration: self.acceleration / (duration * duration) }
    }

    /// Whether these bound anything.
    pub fn is_finite(self) -> bool {
        self.speed.is_finite() && self.acceleration.is_finite()
    }

    /// What tighter bounds of a part of the same can be hoped to be; proves nothing.
    pub(crate) fn hoped(self) -> Rates {
        Rates { acceleration: 0.5 * self.acceleration, ..self }
    }

    /// The lower of two bounds of the same.
    pub fn and(self, other: Rates) -> Rates {
        // f64::min takes the number where the other is none.
        Rates { speed: self.speed.min(other.speed), acceleration: self.acceleration.min(other.acceleration) }
    }
}

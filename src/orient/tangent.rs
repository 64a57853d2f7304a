//! `tangent`: forward along the course, up with the least possible twist.

use super::steps::{Spot, Steps};
use super::transport::Transport;
use super::{Attitude, Course};
use crate::math::Quat;

/// Forward along the course at every time, up carried along without twist.
///
/// It starts with the up nearest to +Y (straight up or down: with what pitching from
/// +Z makes of it), turns at corners by the shortest arc, and is exact to 1e-6 degrees
/// at any time, whatever other times it is asked at; where thousands of segments wind, by
/// measure and not by proof (docs/math/orientation.md). On a closed course the twist that is
/// left over at the end is spread in proportion to arc length.
pub struct Tangent<'a> {
    steps: Steps<'a>,
    transport: Transport,
}

impl<'a> Tangent<'a> {
    /// Carries up along the whole course.
    pub fn new(course: &'a dyn Course) -> Self {
        let steps = Steps::new(course);
        let transport = Transport::new(&steps);
        Tangent { steps, transport }
    }
}

impl Attitude for Tangent<'_> {
    fn at_spot(&self, spot: &Spot) -> Quat {
        self.transport.rotation(&self.steps, spot)
    }

    fn steps(&self) -> &Steps<'_> {
        &self.steps
    }
}

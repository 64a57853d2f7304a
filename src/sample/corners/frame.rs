//! How the difference of two chains of rotations changes and bends, from what each rotation does
//! half way. Derived in docs/math/deviation.md.

use crate::curve::Rates;
use crate::math::Quat;
use glam::{DQuat, DVec3};

/// What a rotation and its playback are at a time: how they are turned, and how they turn, as
/// angular velocities in their own frame.
pub(super) struct Moment {
    pub(super) turned: [DQuat; 2],
    pub(super) spins: [DVec3; 2],
}

/// What hangs on some rotations, as it should be and as it is played: at the middle of a time
/// how it is turned and turns, and what holds through all of that time. Angles by second.
#[derive(Default)]
pub(super) struct Frame {
    turned: [DQuat; 2],
    spins: [DVec3; 2],
    /// The largest angular speeds and accelerations.
    speeds: [f64; 2],
    bends: [f64; 2],
    /// The largest angle between both, and differences of angular velocity and acceleration.
    apart: f64,
    spin_apart: f64,
    bend_apart: f64,
}

impl Frame {
    /// Adds a rotation: what it is half way, its largest speed and acceleration, and half the
    /// time.
    pub(super) fn turn(&mut self, moment: Moment, [speed, bend]: [f64; 2], half: f64) {
        let own = [0, 1].map(|k| moment.turned[k] * moment.spins[k]);
        let plays = own[1].length();
        let own_apart = own[0].distance(own[1]) + half * bend;
        self.bend_apart += bend + self.spin_apart * speed + self.speeds[1] * (own_apart + self.apart * plays);
        self.bends[0] += bend + self.speeds[0] * speed;
        self.bends[1] += self.speeds[1] * plays;
        for k in 0..2 {
            self.turned[k] *= moment.turned[k];
            self.spins[k] += self.turned[k] * moment.spins[k];
            self.speeds[k] = self.spins[k].length() + half * self.bends[k];
        }
        self.spin_apart = self.spins[0].distance(self.spins[1]) + half * self.bend_apart;
        self.apart = angle(self.turned) + half * self.spin_apart;
    }

    /// How fast the difference of two vectors of a length changes and bends that are turned so.
    pub(super) fn rates(&self, length: f64) -> Rates {
        let [moves, plays] = self.speeds;
        let acceleration = self.bend_apart
            + self.bends[1] * self.apart
            + moves * moves * self.apart
            + (moves + plays) * self.spin_apart;
        let speed = self.spin_apart + plays * self.apart;
        // Rates without a bound make numbers that are none.
        let known = |rate: f64| if rate.is_nan() { f64::INFINITY } else { length * rate };
        Rates { speed: known(speed), acceleration: known(acceleration) }
    }
}

/// The angle between two rotations.
fn angle([a, b]: [DQuat; 2]) -> f64 {
    Quat::from(a).angle_to(Quat::from(b))
}

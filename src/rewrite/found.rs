//! Keys that play as a track does, and how far off they may be.

use super::Options;
use super::track::Stored;
use crate::asset::play::{Interpolation, Property};

/// Keys that play as a track does, within what is allowed.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) times: Vec<f32>,
    /// As [`Track::values`].
    pub(super) values: Vec<f32>,
    pub(super) stored: Stored,
    pub(super) interpolation: Interpolation,
    /// No distance from the track's own playback is larger: degrees, or units.
    pub(super) deviation: f64,
}

impl Found {
    /// Bytes of times and values.
    pub(super) fn bytes(&self) -> usize {
        4 * self.times.len() + self.values.len() * self.stored.component.size()
    }

    /// The same with a last key at a time, where the value stays.
    pub(super) fn until(mut self, time: f32) -> Found {
        if self.times.last().is_some_and(|&last| last < time) {
            let width = self.values.len() / self.times.len();
            self.times.push(time);
            self.values.extend_from_within(self.values.len() - width..);
        }
        self
    }
}

/// What is allowed for a track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    /// Degrees or units; none where nothing but float32's rounding may be lost.
    pub(super) tolerance: Option<f64>,
    /// The largest turn from key to key, degrees.
    pub(super) max_step: Option<f64>,
    pub(super) on_curve: bool,
}

impl Allowed {
    pub(super) fn new(property: Property, options: &Options) -> Allowed {
        let tolerance = match property {
            Property::Rotation => Some(options.rotation),
            Property::Translation => options.distance,
            Property::Scale => options.scale,
            Property::MorphTargetWeights => options.weight,
        };
        let max_step = options.max_step.filter(|_| property == Property::Rotation);
        Allowed { tolerance: tolerance.filter(|&t| t > 0.0), max_step, on_curve: options.on_curve }
    }
}

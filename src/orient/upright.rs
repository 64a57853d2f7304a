//! `upright`: forward along the course, head up.

use super::bank::Bank;
use super::facing::roll;
use super::steep::Steep;
use super::steps::{Spot, Steps};
use super::{Attitude, Course, Signs};
use crate::math::Quat;

/// Forward along the course, up as near to +Y as it can be, leaning into turns.
///
/// Within 15° of the vertical, where "nearest to +Y" turns about in no time, up blends
/// to one that is carried along without twist, halfway between what +Y asks for on the
/// way in and on the way out: a loop rolls smoothly there and does not flip.
pub struct Upright<'a> {
    steps: Steps<'a>,
    steep: Steep,
    bank: Option<Bank>,
    signs: Signs,
}

impl<'a> Upright<'a> {
    /// `bank`: the lean in the sharpest turn, degrees; negative leans out of turns.
    pub fn new(course: &'a dyn Course, bank: f64) -> Self {
        let steps = Steps::new(course);
        let steep = Steep::new(&steps);
        let bank = (bank != 0.0 && course.duration() > 0.0).then(|| Bank::new(course, bank));
        let segments = 0..steps.segments();
        let signs = Signs::continued(&steps, segments, |spot| turned(&steps, &steep, bank.as_ref(), spot));
        Upright { steps, steep, bank, signs }
    }
}

impl Attitude for Upright<'_> {
    fn at_spot(&self, spot: &Spot) -> Quat {
        let rotation = |spot: &Spot| turned(&self.steps, &self.steep, self.bank.as_ref(), spot);
        self.signs.follow(&self.steps, spot, rotation)
    }

    fn steps(&self) -> &Steps<'_> {
        &self.steps
    }
}

/// The rotation at a spot, its sign as it comes.
fn turned(steps: &Steps, steep: &Steep, bank: Option<&Bank>, spot: &Spot) -> Quat {
    let lean = bank.map_or(0.0, |bank| bank.at(steps.course.time(spot.place.x)));
    steep.facing(steps, spot).rotation() * roll(lean)
}

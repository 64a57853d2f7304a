//! The values of rotation channels: unit quaternions, near enough to their
//! neighbours that every viewer turns the same way between them.

use gltf::json::accessor::ComponentType;

use super::tally::Tally;
use super::times::float_step;
use super::{Code, Report, Shared};
use crate::asset::Error;
use crate::asset::play::{Block, Channel, Interpolation, at_key};

/// How far from 1 the length of a float32 quaternion may be.
pub(super) const UNIT: f64 = 1e-5;

/// The largest step, degrees, that Blender, which blends the four numbers,
/// shows within a hundredth of a degree. The slack is for rounding.
const STEP: f64 = 18.0 + 1e-3;

/// A larger step within this many seconds is a jump that is meant: it is
/// written as a ramp of 1 ms, or of two float32 steps.
const JUMP: (f64, f64) = (1.5e-3, 3.0);

/// How far from 1 the length may be, for the type that is stored: a code step
/// of each number, and a little.
fn tolerance(component: ComponentType) -> f64 {
    match component {
        ComponentType::I8 => 1.3e-2,
        ComponentType::U8 => 6.5e-3,
        ComponentType::I16 => 6e-5,
        ComponentType::U16 => 3e-5,
        ComponentType::U32 | ComponentType::F32 => UNIT,
    }
}

/// A unit quaternion (or nearly), its length and its time.
type Placed = ([f64; 4], f64, f64);

/// A key, if it has a direction.
fn placed(channel: &Channel, stored: &[f32], t: f32) -> Option<Placed> {
    let &[x, y, z, w] = at_key(channel, stored) else { return None };
    let q = [x, y, z, w].map(f64::from);
    let length = dot(q, q).sqrt();
    (length > 0.0 && length.is_finite()).then_some((q, length, f64::from(t)))
}

struct Rotations<'a> {
    channel: &'a Channel,
    tolerance: f64,
    /// Cosine of half the largest step: that of the angle between quaternions.
    step_cosine: f64,
    previous: Option<Placed>,
    not_finite: Tally,
    not_unit: Tally,
    flips: Tally,
    steps: Tally,
    jumps: Tally,
}

/// Checks the rotations of a channel, reporting them at `place`.
pub(super) fn check(
    shared: &Shared<'_>,
    channel: &Channel,
    place: &str,
    report: &mut Report,
) -> Result<(), Error> {
    let mut rotations = Rotations {
        channel,
        tolerance: tolerance(channel.component()),
        step_cosine: libm::cos((STEP / 2.0).to_radians()),
        previous: None,
        not_finite: Tally::default(),
        not_unit: Tally::default(),
        flips: Tally::default(),
        steps: Tally::default(),
        jumps: Tally::default(),
    };
    shared.keys(channel, |block| rotations.block(block))?;
    rotations.report(place, report);
    Ok(())
}

impl Rotations<'_> {
    fn block(&mut self, block: Block<'_>) {
        let width = self.channel.stored_width();
        let stored = |i: usize| &block.values[width * i..width * (i + 1)];
        for (i, &t) in block.times.iter().enumerate() {
            if i > 0 {
                // Nearly all keys are well; to remember each of them takes longer than to see that.
                if self.is_well(stored(i - 1), stored(i)) {
                    continue;
                }
                self.previous = placed(self.channel, stored(i - 1), block.times[i - 1]);
            }
            self.next(block.first + i, t, stored(i));
        }
        if let Some(last) = block.times.len().checked_sub(1) {
            self.previous = placed(self.channel, stored(last), block.times[last]);
        }
    }

    /// Whether two keys, one after the other, certainly are near enough to unit length and to
    /// each other.
    #[inline]
    fn is_well(&self, before: &[f32], q: &[f32]) -> bool {
        let (&[a, b, c, d], &[x, y, z, w]) = (before, q) else { return false };
        let (before, q) = ([a, b, c, d].map(f64::from), [x, y, z, w].map(f64::from));
        // (1 − tolerance)² and no more than (1 + tolerance)².
        let unit = |q| (dot(q, q) - 1.0).abs() <= self.tolerance * (2.0 - self.tolerance);
        let longest = 1.0 + self.tolerance;
        unit(before) && unit(q) && dot(before, q) >= self.step_cosine * longest * longest
    }

    fn next(&mut self, key: usize, t: f32, stored: &[f32]) {
        let time = f64::from(t);
        let &[x, y, z, w] = at_key(self.channel, stored) else {
            return;
        };
        let q = [x, y, z, w].map(f64::from);
        // No float32 squared overflows an f64: not finite means not finite.
        let length = dot(q, q).sqrt();
        let tangents = stored.len() > 4;
        if !length.is_finite() || (tangents && stored.iter().any(|x| !x.is_finite())) {
            self.not_finite.note(key, time, 0.0);
            return;
        }
        if (length - 1.0).abs() > self.tolerance {
            self.not_unit.note(key, time, (length - 1.0).abs());
        }
        if let Some((p, p_length, p_time)) = self.previous {
            let cosine = dot(p, q) / (p_length * length);
            if cosine < self.step_cosine {
                self.far(key, t, time - p_time, cosine);
            }
        }
    }

    /// A key that is far from the one before, or has another sign.
    #[cold]
    fn far(&mut self, key: usize, t: f32, interval: f64, cosine: f64) {
        let time = f64::from(t);
        let linear = self.channel.interpolation == Interpolation::Linear;
        let step = 2.0 * libm::acos(cosine.abs().min(1.0)).to_degrees();
        // At exactly half a turn the sign means nothing.
        if cosine < -1e-6 && self.channel.interpolation != Interpolation::Step {
            self.flips.note(key, time, 0.0);
        }
        if linear && step > STEP {
            let jump = interval <= JUMP.0 || interval <= JUMP.1 * float_step(t);
            let tally = if jump { &mut self.jumps } else { &mut self.steps };
            tally.note(key, time, step);
        }
    }

    fn report(&self, place: &str, report: &mut Report) {
        let keys = self.channel.keys;
        if let Some(worst) = self.not_finite.worst() {
            report.add(
                Code::NotFinite,
                place,
                format!(
                    "{} of {keys} rotations hold NaN or infinity, the first is {worst}",
                    self.not_finite.count
                ),
            );
        }
        if let Some(worst) = self.not_unit.worst() {
            report.add(
                Code::RotationNotUnit,
                place,
                format!(
                    "{} of {keys} quaternions differ from length 1 by more than {:.1e}, {worst} by {:.3e}; normalise them",
                    self.not_unit.count, self.tolerance, worst.measure
                ),
            );
        }
        if let Some(worst) = self.flips.worst() {
            report.add(
                Code::RotationSignFlip,
                place,
                format!(
                    "{} of {keys} quaternions have the opposite sign of the one before, the first is {worst}; negate them, the rotation stays the same",
                    self.flips.count
                ),
            );
        }
        if let Some(worst) = self.steps.worst() {
            report.add(
                Code::RotationLargeStep,
                place,
                format!(
                    "{} of {keys} rotations are more than 18° from the one before, {worst} by {:.1}°; the error in Blender (nlerp) is up to {:.3}° there: use more samples per second",
                    self.steps.count, worst.measure, 1.22e-6 * worst.measure.powi(3)
                ),
            );
        }
        if let Some(worst) = self.jumps.worst() {
            report.add(
                Code::RotationJump,
                place,
                format!(
                    "jumps within 1.5 ms ({} in all), by {:.1}° to {worst}",
                    self.jumps.count, worst.measure
                ),
            );
        }
    }
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

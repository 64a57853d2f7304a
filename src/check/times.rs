//! The times of keys: they rise, from 0, and far enough apart for viewers.

use super::tally::Tally;
use super::{Code, Report, Shared};
use crate::asset::Error;

/// Blender merges keys that are less than a hundredth of a frame apart, which
/// at its 24 frames a second is this many seconds.
const MERGED: f64 = 0.01 / 24.0;

/// Where float32 steps are longer than this fraction of the interval between
/// keys, or than this many seconds, rounding shows in the motion.
const BLUR: (f64, f64) = (1.0 / 20.0, 1e-3);

/// The times of one accessor.
#[derive(Debug, Default)]
struct Times {
    previous: Option<f32>,
    first: Option<f32>,
    not_finite: Tally,
    negative: Tally,
    not_increasing: Tally,
    close: Tally,
    /// Intervals that are not long against float32 steps at their time.
    blurred: u64,
}

/// Checks the times of an accessor, reporting them at `place`; returns the
/// last time.
pub(super) fn check(
    shared: &Shared<'_>,
    accessor: usize,
    place: &str,
    report: &mut Report,
) -> Result<f64, Error> {
    let mut times = Times::default();
    let mut count = 0;
    shared.blocks(accessor, false, |first, block| {
        for (i, &t) in block.iter().enumerate() {
            times.next(first + i, t);
        }
        count = first + block.len();
    })?;
    times.report(count, place, report);
    Ok(times.previous.map_or(0.0, f64::from))
}

/// The distance from a float32 to the next larger one.
pub(super) fn float_step(t: f32) -> f64 {
    f64::from(t.abs().next_up()) - f64::from(t.abs())
}

impl Times {
    fn next(&mut self, key: usize, t: f32) {
        let time = f64::from(t);
        if !t.is_finite() {
            self.not_finite.note(key, time, 0.0);
            return;
        }
        if t < 0.0 {
            self.negative.note(key, time, -time);
        }
        if let Some(previous) = self.previous {
            let interval = time - f64::from(previous);
            if interval <= 0.0 {
                self.not_increasing.note(key, time, -interval);
            } else if interval < MERGED {
                self.close.note(key, time, -interval);
            }
            if interval * BLUR.0 < float_step(t) {
                self.blurred += 1;
            }
        }
        self.first.get_or_insert(t);
        self.previous = Some(t);
    }

    fn report(&self, count: usize, place: &str, report: &mut Report) {
        if let Some(worst) = self.not_finite.worst() {
            report.add(
                Code::NotFinite,
                place,
                format!(
                    "{} of {count} times are NaN or infinite, the first at key {}",
                    self.not_finite.count, worst.key
                ),
            );
        }
        if let Some(worst) = self.negative.worst() {
            report.add(
                Code::TimeNegative,
                place,
                format!(
                    "{} of {count} times are negative, the least {} s; shift them to begin at 0",
                    self.negative.count, worst.time
                ),
            );
        }
        if let Some(worst) = self.not_increasing.worst() {
            report.add(
                Code::TimeNotIncreasing,
                place,
                format!(
                    "times must rise from key to key, and {} of {count} do not; the worst, {worst}, lies {} s before the one it follows; sort them, drop repeated ones",
                    self.not_increasing.count, worst.measure
                ),
            );
        }
        if let Some(worst) = self.close.worst() {
            report.add(
                Code::KeysTooClose,
                place,
                format!(
                    "{} of {count} keys are less than 0.42 ms after the one before, {worst} only {:.3} ms; Blender merges them: keep keys 1 ms apart",
                    self.close.count, -1e3 * worst.measure
                ),
            );
        }
        if let Some(first) = self.first.filter(|&first| first > 0.0) {
            report.add(
                Code::NoKeyAtZero,
                place,
                format!("the first key is at {first} s; add one at 0 or shift all times"),
            );
        }
        self.report_blur(count, place, report);
    }

    fn report_blur(&self, count: usize, place: &str, report: &mut Report) {
        let Some(last) = self.previous else {
            return;
        };
        let step = float_step(last);
        // Equal times are an error of their own, not a blur.
        let blurred = self.blurred.saturating_sub(self.not_increasing.count);
        let many = 2 * blurred > count.saturating_sub(1) as u64;
        if many || step > BLUR.1 {
            report.add(
                Code::TimesBlurred,
                place,
                format!(
                    "float32 steps are {:.3} ms long at {last} s, so that times of keys are rounded visibly; shift them to begin at 0 or make clips shorter",
                    1e3 * step
                ),
            );
        }
    }
}

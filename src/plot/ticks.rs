//! Where axes have ticks, and what is written there.

use super::layout::{self, TICK};
use kuva::render::render_utils::compute_tick_step;

/// How numbers beside an axis are written: with as many decimals as the step needs, or as
/// powers of ten where that is shorter.
#[derive(Clone, Copy)]
pub(super) struct Numbers {
    step: f64,
    decimals: Option<usize>,
}

impl Numbers {
    pub(super) fn new(step: f64, range: [f64; 2]) -> Numbers {
        let whole = |decimals: &usize| {
            let scaled = step * 10f64.powi(*decimals as i32);
            scaled >= 0.5 && (scaled - scaled.round()).abs() < 1e-6 * scaled
        };
        let decimals = (0..=6).find(whole);
        let far = range.iter().fold(0.0, |far: f64, end| far.max(end.abs()));
        let plain = Numbers { step, decimals };
        let powers = Numbers { step, decimals: None };
        let shorter = far >= 1e6 && powers.write(far).len() < plain.write(far).len();
        if shorter { powers } else { plain }
    }

    /// A number, with a minus that is as wide as a plus.
    pub(super) fn write(&self, value: f64) -> String {
        // Rounding leaves a little where 0 should be.
        let value = if value.abs() < 1e-9 * self.step { 0.0 } else { value };
        let text = match self.decimals {
            Some(decimals) => format!("{value:.decimals$}"),
            None if value == 0.0 => "0".to_owned(),
            None => {
                // Two digits more than tell neighbours apart, lest they be rounded.
                let digits = libm::log10(value.abs() / self.step).ceil().clamp(0.0, 14.0) as usize + 2;
                let text = format!("{value:.digits$e}");
                let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
                let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
                format!("{mantissa}e{exponent}")
            }
        };
        text.replace('-', "−")
    }
}

/// Every how many units there is a tick: about every `each` pixels, and with enough room
/// for what is written there.
pub(super) fn step(range: [f64; 2], pixels: f64, each: f64, level: bool) -> f64 {
    let [low, high] = range;
    let at = |each: f64| compute_tick_step(0.0, (high - low) * (each / pixels).min(0.5), 1);
    let fits = |step: &f64| {
        let wide = |value: f64| layout::width(&Numbers::new(*step, range).write(value), TICK);
        // A value between two ticks has as many digits as they have.
        let values = range.map(|end| (end / step).trunc() * step);
        !level || values.into_iter().map(wide).fold(0.0, f64::max) + 12.0 <= step / (high - low) * pixels
    };
    let steps = [1.0, 1.5, 2.0, 3.0, 4.0].map(|more| at(more * each));
    steps.into_iter().find(fits).unwrap_or(steps[4])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_have_the_decimals_of_their_step_and_a_true_minus() {
        let written = |step: f64, value: f64| Numbers::new(step, [-1.0, 1.0]).write(value);
        assert_eq!(written(0.25, -0.5), "−0.50");
        assert_eq!(written(0.1, -1e-17), "0.0");
        assert_eq!(written(200.0, 1000.0), "1000");
        assert_eq!(written(2e-9, -4e-9), "−4e−9");
        let large = |step: f64, far: f64, value: f64| Numbers::new(step, [0.0, far]).write(value);
        assert_eq!(large(5e5, 2e6, 1.5e6), "1.5e6");
        assert_eq!(large(5e29, 1e30, 4.999_999_999_999_999e29), "5e29");
        assert_eq!(large(0.5, 1e9 + 2.0, 1e9 + 0.5), "1000000000.5");
    }

    #[test]
    fn numbers_that_need_room_stand_farther_apart() {
        assert_eq!(step([0.0, 10.0], 1000.0, 100.0, true), 1.0);
        assert_eq!(step([1e9, 1e9 + 10.0], 1000.0, 100.0, true), 2.0);
        assert_eq!(step([1e9, 1e9 + 10.0], 1000.0, 100.0, false), 1.0);
    }
}

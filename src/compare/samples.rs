//! Integrals and peaks of functions on a piece of a motion, from samples.
//!
//! Integrals are Simpson's. A peak is the highest sample, or the value where the parabola through
//! it and its neighbours is highest: of smooth functions off by the fourth power of a step. What
//! swings to and fro between two samples is not seen.

use super::Peak;

/// Steps between the samples of a piece; even, for Simpson's rule.
const STEPS: usize = 64;

/// Functions of u on 0..=1, at even steps.
pub(super) struct Samples<const N: usize>([[f64; N]; STEPS + 1]);

impl<const N: usize> Samples<N> {
    pub(super) fn of(f: impl Fn(f64) -> [f64; N]) -> Samples<N> {
        Samples(std::array::from_fn(|i| f(i as f64 / STEPS as f64)))
    }

    /// The integral over 0..=1 of what `f` makes of the values.
    pub(super) fn integral(&self, f: impl Fn(&[f64; N]) -> f64) -> f64 {
        let weight = |i: usize| match i {
            0 | STEPS => 1.0,
            i => 2.0 + 2.0 * (i % 2) as f64,
        };
        let sum: f64 = self.0.iter().enumerate().map(|(i, values)| weight(i) * f(values)).sum();
        sum / (3 * STEPS) as f64
    }

    /// Raises each peak to the largest value of its function; `f` evaluates them all, `time` is
    /// when u is.
    pub(super) fn raise(
        &self,
        peaks: &mut [Peak; N],
        f: impl Fn(f64) -> [f64; N],
        time: impl Fn(f64) -> f64,
    ) {
        for (which, peak) in peaks.iter_mut().enumerate() {
            let value = |i: usize| self.0[i][which];
            (0..=STEPS).for_each(|i| peak.rise(value(i), time(i as f64 / STEPS as f64)));
            for i in 1..STEPS {
                let (before, at, after) = (value(i - 1), value(i), value(i + 1));
                if at < before || at < after || 2.0 * at == before + after {
                    continue;
                }
                let beside = 0.5 * (after - before) / (2.0 * at - before - after);
                if at + 0.25 * (after - before) * beside > peak.value {
                    let u = (i as f64 + beside) / STEPS as f64;
                    peak.rise(f(u)[which], time(u));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_and_peaks_of_a_wave() {
        let f = |u: f64| [(7.0 * u).sin(), u * u * u];
        let samples = Samples::of(f);
        let exact = (1.0 - 7f64.cos()) / 7.0;
        // Simpson's error is h⁴/180 of the fourth derivative, 7⁴.
        assert!((samples.integral(|v| v[0]) - exact).abs() < 7f64.powi(4) / 64f64.powi(4) / 180.0);
        assert!((samples.integral(|v| v[1]) - 0.25).abs() < 1e-15);
        let mut peaks = [Peak { value: 0.0, time: 0.0 }; 2];
        samples.raise(&mut peaks, f, |u| 2.0 * u);
        let crest = std::f64::consts::FRAC_PI_2 / 7.0;
        // The parabola's crest is off by h³ 7²/24 at most, the value by half the square of 7 times that.
        let off = 49.0 / 64f64.powi(3) / 24.0;
        assert!(
            (peaks[0].time - 2.0 * crest).abs() < 2.0 * off
                && (peaks[0].value - 1.0).abs() < 25.0 * off * off
        );
        assert_eq!((peaks[1].value, peaks[1].time), (1.0, 2.0));
    }
}

//! Largest values of smooth functions: a dense look, then a search around what is highest.

use super::Peak;
use super::quadrature::{PLACES, Rule, Stretch};

/// To what part of its stretch a search finds a place, whose value is then off by the square of
/// that; and after how many steps it ends at last.
const NEAR: f64 = 1e-7;
const STEPS: u32 = 60;
/// What a search must promise to gain, relative to the value.
const GAIN: f64 = 1e-12;

/// A stretch between two places of a piece that promises to be higher than anything seen.
pub(super) struct Hill {
    /// How high, and which of the functions.
    promised: f64,
    which: usize,
    /// The piece, and where on it, from 0 to 1.
    piece: usize,
    from: f64,
    to: f64,
}

impl Hill {
    fn is_above(&self, peak: &Peak) -> bool {
        self.promised > peak.value * (1.0 + GAIN)
    }
}

/// Raises each peak to the largest of its function's values on a stretch of a piece, and keeps
/// the hills that promise more.
///
/// A maximum is found if the stretch's values resolve the function: if one of them is higher
/// than its neighbours. Its value is exact to about 1e-12. What hills promise is told by the angle
/// whose cosine the places are, in which they are even.
pub(super) fn raise<const N: usize>(
    peaks: &mut [Peak; N],
    hills: &mut Vec<Hill>,
    rule: &Rule,
    stretch: &Stretch<N>,
    (piece, time): (usize, impl Fn(f64) -> f64),
) {
    let place = |i: usize| rule.place(stretch, i);
    let last = PLACES - 1;
    for (which, peak) in peaks.iter_mut().enumerate() {
        let value = |i: usize| stretch.values[i][which];
        for i in 0..=last {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            if value(i) < value(before) || value(i) < value(after) {
                continue;
            }
            peak.rise(value(i), time(place(i)));
            let promised = if before < i && i < after {
                promised([value(before), value(i), value(after)])
            } else {
                let inwards = |n: usize| if i == 0 { n } else { last - n };
                promised_at_end([0, 1, 2].map(|n| value(inwards(n))))
            };
            let hill = Hill { promised, which, piece, from: place(before), to: place(after) };
            if hill.is_above(peak) {
                hills.push(hill);
            }
        }
    }
}

/// Raises each peak to the tops of the hills that promise more, the highest first; `on` gives
/// all functions on a piece, and `time` when it is at a place.
pub(super) fn climb<const N: usize, F: Fn(f64) -> [f64; N]>(
    peaks: &mut [Peak; N],
    mut hills: Vec<Hill>,
    on: impl Fn(usize) -> F,
    time: impl Fn(usize, f64) -> f64,
) {
    hills.retain(|hill| hill.is_above(&peaks[hill.which]));
    hills.sort_by(|a, b| b.promised.total_cmp(&a.promised));
    for hill in hills {
        let peak = &mut peaks[hill.which];
        if hill.is_above(peak) {
            let f = on(hill.piece);
            let (u, found) = highest_between(|u| f(u)[hill.which], hill.from, hill.to);
            peak.rise(found, time(hill.piece, u));
        }
    }
}

/// No less than the top of a hill whose highest values are these: a parabola through them rises a
/// quarter as much above the middle one, or less.
fn promised([before, at, after]: [f64; 3]) -> f64 {
    at + (at - 0.5 * (before + after)).max(0.0)
}

/// The largest value on 0..=1 of a + b x² + c x⁴ through three values at 0, 1 and 2: at the end of
/// a stretch a function is even in the angle.
fn promised_at_end([at, next, second]: [f64; 3]) -> f64 {
    let b = (16.0 * next - second - 15.0 * at) / 12.0;
    let c = (second - 4.0 * next + 3.0 * at) / 12.0;
    let square = if c < 0.0 { (-0.5 * b / c).clamp(0.0, 1.0) } else { 0.0 };
    (at + square * (b + square * c)).max(next)
}

/// Where a function with one maximum is largest, and how large: parabolas through the three
/// highest places, and a golden section where they lead nowhere (Brent 1973, chapter 5).
fn highest_between(f: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> (f64, f64) {
    let golden = 0.5 * (3.0 - 5f64.sqrt());
    let near = NEAR * (to - from);
    let start = from + golden * (to - from);
    // The three highest so far, and the last two steps.
    let mut best = [(start, f(start)); 3];
    let (mut step, mut before) = (0.0f64, 0.0f64);
    for _ in 0..STEPS {
        let [(x, top), ..] = best;
        let middle = 0.5 * (from + to);
        if (x - middle).abs() + 0.5 * (to - from) <= 2.0 * near {
            break;
        }
        // A step must be less than half of the one before the last, else it does not converge.
        let fitted = crest(best).filter(|u| from < *u && *u < to && (u - x).abs() < 0.5 * before.abs());
        let towards = if x < middle { to - x } else { from - x };
        (before, step) = fitted.map_or((towards, golden * towards), |u| (step, u - x));
        // Nearer to a place that is known there is nothing to learn.
        let beside = x + step - from < 2.0 * near || to - x - step < 2.0 * near;
        if fitted.is_some() && beside {
            step = near.copysign(middle - x);
        }
        let u = if step.abs() >= near { x + step } else { x + near.copysign(step) };
        let value = f(u);
        if value >= top {
            *(if u < x { &mut to } else { &mut from }) = x;
            best = [(u, value), best[0], best[1]];
            continue;
        }
        *(if u < x { &mut from } else { &mut to }) = u;
        if value >= best[1].1 || best[1].0 == x {
            best = [best[0], (u, value), best[1]];
        } else if value >= best[2].1 || best[2].0 == x || best[2].0 == best[1].0 {
            best[2] = (u, value);
        }
    }
    best[0]
}

/// Where the parabola through three places is highest; nowhere if it is not.
fn crest([(x, top), (w, second), (v, third)]: [(f64, f64); 3]) -> Option<f64> {
    let (r, q) = ((x - w) * (top - third), (x - v) * (top - second));
    let (rise, bend) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
    let crest = x - rise / bend;
    (bend != 0.0 && crest.is_finite()).then_some(crest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn search_finds_the_top_of_a_hill() {
        for top in [0.01, 0.3, 0.77, 0.999] {
            let looks = Cell::new(0);
            let hill = |u: f64| {
                looks.set(looks.get() + 1);
                5.0 - (u - top) * (u - top) * (2.0 + u)
            };
            let (u, value) = highest_between(hill, 0.0, 1.0);
            assert!(looks.get() < 25, "{top}: {}", looks.get());
            // Values near the top differ from it by less than 1e-15 within 2e-8 of it.
            assert!((u - top).abs() < 1e-7 && (value - 5.0).abs() < 1e-14, "{top}: {u} {value}");
        }
        // At an end it comes within twice what is near.
        let (_, value) = highest_between(|u| u, 0.0, 1.0);
        assert!(1.0 - value < 2.0 * NEAR);
    }

    #[test]
    fn a_hill_promises_four_times_what_a_parabola_gains() {
        let parabola = |top: f64| move |x: f64| 3.0 - 0.5 * (x - top) * (x - top);
        for top in [-0.5, 0.0, 0.4] {
            let values = [-1.0, 0.0, 1.0].map(parabola(top));
            assert!((promised(values) - values[1] - 0.5).abs() < 1e-15, "{top}");
            assert!(4.0 * (3.0 - values[1]) < 0.5 + 1e-15, "{top}");
        }
        assert_eq!(promised([2.0, 2.0, 2.0]), 2.0);
    }

    #[test]
    fn an_end_promises_what_is_even_there() {
        let quartic = |top: f64| move |x: f64| 3.0 - (x * x - top) * (x * x - top);
        for top in [0.2, 0.9] {
            let found = promised_at_end([0.0, 1.0, 2.0].map(quartic(top)));
            assert!((found - 3.0).abs() < 1e-14, "{top}: {found}");
        }
        assert_eq!(promised_at_end([2.0, 1.0, -2.0]), 2.0);
        assert_eq!(promised_at_end([0.0, 1.0, 4.0]), 1.0);
    }
}

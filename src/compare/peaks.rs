//! Largest values of smooth functions: a dense look, then a search around what is highest.

use super::Peak;
use super::quadrature::{PLACES, Rule, Stretch};
use crate::curve::Piece;

/// To what part of its stretch a search finds a place, whose value is then off by the square of
/// that; and after how many steps it ends at last.
const NEAR: f64 = 1e-7;
const STEPS: u32 = 60;
/// What a search must promise to gain, relative to the value.
const GAIN: f64 = 1e-12;

/// Raises each peak to the largest value of its function on a stretch of a piece; `f` gives all
/// at a place u of the piece, from 0 to 1.
///
/// A maximum is found if the stretch's values resolve the function: if a parabola through
/// three neighbouring ones shows it, its value is exact to about 1e-12. The parabola is one of
/// the angle whose cosine the places are, in which they are even.
pub(super) fn raise<const N: usize>(
    peaks: &mut [Peak; N],
    rule: &Rule,
    piece: &Piece,
    stretch: &Stretch<N>,
    f: impl Fn(f64) -> [f64; N],
) {
    let place = |i: usize| rule.place(stretch, i);
    let time = |u: f64| piece.start + u * piece.duration();
    let last = PLACES - 1;
    for (which, peak) in peaks.iter_mut().enumerate() {
        let value = |i: usize| stretch.values[i][which];
        for i in 0..=last {
            let highest = value(i) >= value(i.saturating_sub(1)) && value(i) >= value((i + 1).min(last));
            if !highest {
                continue;
            }
            peak.rise(value(i), time(place(i)));
            let middle = i.clamp(1, last - 1);
            if promised([value(middle - 1), value(middle), value(middle + 1)]) > peak.value * (1.0 + GAIN) {
                let (from, to) = (place(i.saturating_sub(1)), place((i + 1).min(last)));
                let (u, found) = highest_between(|u| f(u)[which], from, to);
                peak.rise(found, time(u));
            }
        }
    }
}

/// The largest value on −1..=1 of the parabola through three values at −1, 0 and 1.
fn promised([before, at, after]: [f64; 3]) -> f64 {
    let (slope, bend) = (0.5 * (after - before), 0.5 * (before + after) - at);
    let x = if bend < 0.0 { (-0.5 * slope / bend).clamp(-1.0, 1.0) } else { 0.0 };
    (at + x * (slope + x * bend)).max(before).max(after)
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
    fn a_parabola_promises_its_own_top() {
        let parabola = |top: f64| move |x: f64| 3.0 - 0.5 * (x - top) * (x - top);
        for top in [-0.9, 0.0, 0.4] {
            let found = promised([-1.0, 0.0, 1.0].map(parabola(top)));
            assert!((found - 3.0).abs() < 1e-15, "{top}: {found}");
        }
        assert_eq!(promised([2.0, 1.0, 1.5]), 2.0);
        assert_eq!(promised([1.0, 2.0, 3.0]), 3.0);
    }
}

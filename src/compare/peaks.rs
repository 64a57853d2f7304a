//! Largest values of smooth functions: a dense look, then a search around what is highest.

use super::Peak;
use super::quadrature::{PLACES, Rule, Stretch};
use crate::curve::Piece;

/// Golden sections; each leaves 0.62 of the stretch, all together 1e-9.
const SECTIONS: u32 = 44;
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

/// Golden section search (Kiefer 1953): where a function with one maximum is largest, and
/// how large.
fn highest_between(f: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> (f64, f64) {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut left, mut right) = (to - golden * (to - from), from + golden * (to - from));
    let (mut at_left, mut at_right) = (f(left), f(right));
    for _ in 0..SECTIONS {
        if at_left > at_right {
            (to, right, at_right) = (right, left, at_left);
            left = to - golden * (to - from);
            at_left = f(left);
        } else {
            (from, left, at_left) = (left, right, at_right);
            right = from + golden * (to - from);
            at_right = f(right);
        }
    }
    if at_left > at_right { (left, at_left) } else { (right, at_right) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn search_finds_the_top_of_a_hill() {
        for top in [0.01, 0.3, 0.77, 0.999] {
            let (u, value) = highest_between(|u| 5.0 - (u - top) * (u - top) * (2.0 + u), 0.0, 1.0);
            // Values near the top differ from it by less than 1e-15 within 2e-8 of it.
            assert!((u - top).abs() < 1e-7 && (value - 5.0).abs() < 1e-14, "{top}: {u} {value}");
        }
        // At an end it comes within 0.62⁴⁴ of it.
        let (_, value) = highest_between(|u| u, 0.0, 1.0);
        assert!(1.0 - value < 2e-9);
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

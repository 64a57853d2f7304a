//! `b-spline`: the cumulative cubic B-spline, knots at the key times.
//!
//! Keys are control rotations, so the curve is smooth in acceleration and passes inner keys
//! at a distance. At either end the key next to it and one that stands in beyond it are
//! chosen so that the end is met. Source: Kim, Kim and Shin 1995; docs/math/b-spline.md.

use super::arc::direction;
use super::rule::{Rule, Smoothness};
use super::span::{End, Span};
use super::{Arc, Rates};
use crate::math::{Quat, Scalar, Vec3};

pub(super) struct BSpline;

impl Rule for BSpline {
    const NAME: &'static str = "b-spline";
    const SUMMARY: &'static str = "smooths: no jumps in acceleration, but inner keys are not met";
    const SMOOTHNESS: Smoothness = Smoothness::Twice;
    const PASSES_KEYS: bool = false;
    type Arc = CumulativeBSpline;

    fn arc(span: &Span) -> CumulativeBSpline {
        let Span { start, end, h, .. } = *span;
        let [a, b, _, d, e] = span.intervals;
        let log = |from: Quat, to: Quat| (from.conjugate() * to).log();
        let own = log(start, end);
        let rule = span.end_rule;
        let first = match span.before {
            None => own * EndWeights::of(rule, h, d).outer,
            Some(before) if before.is_end => log(before.key, start) * EndWeights::of(rule, before.h, h).inner,
            Some(before) => log(before.key, start),
        };
        let last = match span.after {
            None => own * EndWeights::of(rule, h, b).outer,
            Some(after) if after.is_end => log(end, after.key) * EndWeights::of(rule, after.h, h).inner,
            Some(after) => log(end, after.key),
        };
        // The control rotation in an end key's stead, seen from the one beside it.
        let (middle, second) = match (span.before, span.after) {
            (None, _) => {
                let middle = own * EndWeights::of(rule, h, d).inner;
                (middle, end * Quat::exp(-middle))
            }
            (_, None) => (own * EndWeights::of(rule, h, b).inner, start),
            _ => (own, start),
        };
        let base = second * Quat::exp(-first);
        let weights = Weights {
            first: h * h / ((h + b) * (h + b + a)),
            last: h * h / ((h + d) * (h + d + e)),
            offset: b * b / ((b + h + d) * (b + h)),
            slope: 3.0 * h / (b + h + d),
            enter: b / (b + h),
            leave: d / (h + d),
        };
        CumulativeBSpline { start: base, steps: [first, middle, last].map(direction), weights }
    }
}

/// How long the two steps around an end are, as multiples of the step between the end key
/// and the next: from the control rotation beyond the end, and to the next key.
struct EndWeights {
    outer: f64,
    inner: f64,
}

impl EndWeights {
    /// At an end whose interval is `h` and whose next one is `beyond`. With N the weight of
    /// the next key at the end, α and β the inner and outer multiples, the end is met where
    /// α(1 − N) + βN = 1, and its velocity is (α + β)N′ steps a second.
    fn of(rule: End, h: f64, beyond: f64) -> EndWeights {
        let share = match rule {
            End::Natural => return EndWeights { outer: 1.0, inner: 1.0 },
            End::Repeat => 0.5,
            End::Chord(share) => share,
        };
        let weight = h / (2.0 * (2.0 * h + beyond));
        let sum = share * 2.0 * (2.0 * h + beyond) / (3.0 * h);
        let inner = (1.0 - sum * weight) / (1.0 - 2.0 * weight);
        EndWeights { outer: sum - inner, inner }
    }
}

/// The polynomials by which the three steps of a segment grow: 1 − first (1−u)³,
/// offset + slope (enter u + (1−enter) u² + (enter + leave − 2) u³/3), and last u³.
#[derive(Clone, Copy, Debug)]
struct Weights {
    first: f64,
    last: f64,
    offset: f64,
    slope: f64,
    enter: f64,
    leave: f64,
}

/// Three steps of four control rotations, each to a share that grows from one segment to
/// the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct CumulativeBSpline {
    start: Quat,
    /// Length and unit axis of each step.
    steps: [(f64, Vec3); 3],
    weights: Weights,
}

impl Arc for CumulativeBSpline {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let k = S::constant;
        let Weights { first, last, offset, slope, enter, leave } = self.weights;
        let v = k(1.0) - u;
        let cubic = (k((enter + leave - 2.0) / 3.0) * u + k(1.0 - enter)) * u + k(enter);
        let basis =
            [k(1.0) - k(first) * (v * v * v), k(offset) + k(slope) * u * cubic, k(last) * (u * u * u)];
        let step = |i: usize| {
            let (length, axis) = self.steps[i];
            let (sin, cos) = (basis[i] * k(length)).sin_cos();
            Quat { w: cos, v: Vec3::constant(axis) * sin }
        };
        Quat::constant(self.start) * step(0) * step(1) * step(2)
    }

    /// As for the cumulative cubic, with this basis. Derived in docs/math/deviation.md.
    fn rates(&self) -> Rates {
        let Weights { first, last, slope, enter, leave, .. } = self.weights;
        let [x, y, z] = self.steps.map(|step| step.0);
        let [a, b, c] = self.steps.map(|(length, axis)| axis * length);
        let cross = |a: Vec3, b: Vec3| a.cross(b).length();
        // Bernstein coefficients of the sum of the lengths' rates.
        let speeds = [3.0 * first * x + slope * enter * y, slope * y, slope * leave * y + 3.0 * last * z];
        let at_start = b * (2.0 * slope * (1.0 - enter)) - a * (6.0 * first);
        let at_end = c * (6.0 * last) - b * (2.0 * slope * (1.0 - leave));
        let turning = cross(a, b) * first * (6.0 * slope + 12.0 + 2.25 * last * z)
            + cross(a, c) * (1.125 * first * last)
            + cross(b, c) * (6.0 * last * slope);
        let straight = at_start.length().max(at_end.length());
        Rates { speed: speeds.into_iter().fold(0.0, f64::max), acceleration: straight + turning }
    }
}

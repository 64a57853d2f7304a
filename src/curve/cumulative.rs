//! The cubic Bézier of rotations in cumulative form, which carries several schemes.
//!
//! c₀ exp(ω₁ B̃₁(u)) exp(ω₂ B̃₂(u)) exp(ω₃ B̃₃(u)) with ωᵢ = log(cᵢ₋₁⁻¹ cᵢ) and
//! B̃₁ = 1 − (1−u)³, B̃₂ = 3u² − 2u³, B̃₃ = u³.
//! Source: Kim, Kim and Shin, SIGGRAPH 1995; docs/math/cumulative-bezier.md.

use super::arc::direction;
use super::rule::{End, Neighbour, Span};
use super::{Arc, Rates};
use crate::math::{Quat, Scalar, Vec3};

/// A cumulative cubic: its first control rotation and its three steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct CumulativeCubic {
    start: Quat,
    /// Length and unit axis of each ωᵢ.
    steps: [(f64, Vec3); 3],
}

impl CumulativeCubic {
    /// The cubic that starts at `start` and makes the steps ω₁, ω₂, ω₃, logarithms.
    pub(super) fn new(start: Quat, steps: [Vec3; 3]) -> CumulativeCubic {
        CumulativeCubic { start, steps: steps.map(direction) }
    }

    /// The cubic from `start` to `end` with the first and last step given.
    ///
    /// The steps are taken as they are, never as the logarithm of their exponential: one
    /// longer than a turn keeps its speed. The middle one brings the curve to `end`.
    fn between(start: Quat, end: Quat, first: Vec3, last: Vec3) -> CumulativeCubic {
        let middle = Quat::exp(-first) * start.conjugate() * end * Quat::exp(-last);
        CumulativeCubic::new(start, [first, middle.log(), last])
    }
}

impl Arc for CumulativeCubic {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let k = S::constant;
        let v = k(1.0) - u;
        let (uu, vvv) = (u * u, v * v * v);
        let basis = [k(1.0) - vvv, uu * (k(3.0) - k(2.0) * u), uu * u];
        let step = |i: usize| {
            let (length, axis) = self.steps[i];
            let (sin, cos) = (basis[i] * k(length)).sin_cos();
            Quat { w: cos, v: Vec3::constant(axis) * sin }
        };
        Quat::constant(self.start) * step(0) * step(1) * step(2)
    }

    /// With Ad for the turns by the later factors, q⁻¹q′ = Ad₃₂ω₁ B̃₁′ + Ad₃ω₂ B̃₂′ +
    /// ω₃ B̃₃′ and its derivative. Were all axes one, the acceleration would be
    /// 6(1−u)(ω₂ − ω₁) + 6u(ω₃ − ω₂); what turning axes add is bounded by the vector
    /// products of the steps, each with the largest value on 0..=1 of its polynomial.
    /// Derived in docs/math/deviation.md.
    fn rates(&self) -> Rates {
        let [a, b, c] = self.steps.map(|(length, axis)| axis * length);
        let cross = |a: Vec3, b: Vec3| a.cross(b).length();
        let straight = 6.0 * (b - a).length().max((c - b).length());
        let turning = (6.0 + 1.4 * self.steps[2].0) * cross(a, b) + 2.1 * cross(a, c) + 12.0 * cross(b, c);
        let longest = self.steps.iter().map(|step| step.0).fold(0.0, f64::max);
        Rates { speed: 3.0 * longest, acceleration: straight + turning }
    }
}

/// A key with both its neighbours.
pub(super) struct Corner {
    pub(super) before: Neighbour,
    pub(super) key: Quat,
    pub(super) after: Neighbour,
}

/// How near −1 a product has no axis worth using.
const NO_AXIS: f64 = 1e-6;

/// log of a product of two steps, and `sum`, of their logarithms, where the product lies
/// so near −1 that any axis would do.
pub(super) fn log_of_product(product: Quat, sum: impl FnOnce() -> Vec3) -> Vec3 {
    let from_minus_one = Quat { w: product.w + 1.0, v: product.v };
    if from_minus_one.norm() < NO_AXIS { sum() } else { product.log() }
}

/// The cubic of a span whose outer control rotations follow from the key and its
/// neighbours: `handle(corner, h)` is the step from a key to the next control rotation
/// in a segment of h seconds, which by symmetry is also the step that leads to a key.
pub(super) fn from_handles(span: &Span, handle: impl Fn(&Corner, f64) -> Vec3) -> CumulativeCubic {
    from_both_handles(span, &handle, &handle)
}

/// [`from_handles`] with one rule for the step that leaves a key and one for the step that
/// leads to it.
pub(super) fn from_both_handles(
    span: &Span,
    leaving: impl Fn(&Corner, f64) -> Vec3,
    arriving: impl Fn(&Corner, f64) -> Vec3,
) -> CumulativeCubic {
    let Span { start, end, h, end_rule, .. } = *span;
    let inner = |key: Quat| Neighbour { key, h, is_end: false };
    let first =
        span.before_or_repeated().map(|before| leaving(&Corner { before, key: start, after: inner(end) }, h));
    let last =
        span.after_or_repeated().map(|after| arriving(&Corner { before: inner(start), key: end, after }, h));
    let chord = start.conjugate() * end;
    // Where a neighbour is missing, the velocity may be given.
    let given = match end_rule {
        End::Chord(share) => Some(chord.log() * (share / 3.0)),
        End::Natural | End::Repeat => None,
    };
    match (first.or(given), last.or(given)) {
        (Some(first), Some(last)) => CumulativeCubic::between(start, end, first, last),
        (None, None) => CumulativeCubic::new(start, [chord.log() * (1.0 / 3.0); 3]),
        // The missing control rotation halves the way to the other inner one.
        (None, Some(last)) => {
            let half = (chord * Quat::exp(-last)).log() * 0.5;
            CumulativeCubic::new(start, [half, half, last])
        }
        (Some(first), None) => {
            let half = (Quat::exp(-first) * chord).log() * 0.5;
            CumulativeCubic::new(start, [first, half, half])
        }
    }
}

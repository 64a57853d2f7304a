//! The cubic Bézier of rotations in cumulative form, which carries several schemes.
//!
//! c₀ exp(ω₁ B̃₁(u)) exp(ω₂ B̃₂(u)) exp(ω₃ B̃₃(u)) with ωᵢ = log(cᵢ₋₁⁻¹ cᵢ) and
//! B̃₁ = 1 − (1−u)³, B̃₂ = 3u² − 2u³, B̃₃ = u³.
//! Source: Kim, Kim and Shin, SIGGRAPH 1995; docs/math/cumulative-bezier.md.

use super::arc::{direction, turn};
use super::rule::{Broad, Formula, Paced};
use super::span::{End, Neighbour, Span};
use super::{Arc, Rates, Tcb};
use crate::math::{Number, Quat, Scalar, Vec3};

/// A cumulative cubic: its first control rotation and its three steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct CumulativeCubic<N = f64> {
    start: Quat<N>,
    /// Length and unit axis of each ωᵢ.
    steps: [(N, Vec3<N>); 3],
}

impl<N: Number> CumulativeCubic<N> {
    /// The cubic that starts at `start` and makes the steps ω₁, ω₂, ω₃, logarithms.
    #[inline(always)]
    pub(super) fn new(start: Quat<N>, [a, b, c]: [Vec3<N>; 3]) -> CumulativeCubic<N> {
        CumulativeCubic { start, steps: [direction(a), direction(b), direction(c)] }
    }

    /// The cubic from `start` to `end` with the first and last step given.
    ///
    /// The steps are taken as they are, never as the logarithm of their exponential: one
    /// longer than a turn keeps its speed. The middle one brings the curve to `end`.
    #[inline(always)]
    fn between(start: Quat<N>, end: Quat<N>, first: Vec3<N>, last: Vec3<N>) -> CumulativeCubic<N> {
        let middle = Quat::exp(-first) * start.conjugate() * end * Quat::exp(-last);
        CumulativeCubic { start, steps: [direction(first), N::polar(middle), direction(last)] }
    }
}

impl<N: Copy> Formula<N> for CumulativeCubic<N> {
    #[inline(always)]
    fn point<S: Scalar + From<N>>(&self, u: S) -> Quat<S> {
        let k = S::constant;
        let v = k(1.0) - u;
        let (uu, vvv) = (u * u, v * v * v);
        let basis = [k(1.0) - vvv, uu * (k(3.0) - k(2.0) * u), uu * u];
        let [a, b, c] = self.steps;
        Quat::constant(self.start) * turn(a, basis[0]) * turn(b, basis[1]) * turn(c, basis[2])
    }
}

impl Arc for CumulativeCubic {
    #[inline(always)]
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        self.point(u)
    }

    fn rates(&self) -> Rates {
        self.pace()
    }
}

impl<N: Number> Paced<N> for CumulativeCubic<N> {
    /// With Ad for the turns by the later factors, q⁻¹q′ = Ad₃₂ω₁ B̃₁′ + Ad₃ω₂ B̃₂′ +
    /// ω₃ B̃₃′ and its derivative. Were all axes one, the acceleration would be
    /// 6(1−u)(ω₂ − ω₁) + 6u(ω₃ − ω₂); what turning axes add is bounded by the vector
    /// products of the steps, each with the largest value on 0..=1 of its polynomial.
    /// Derived in docs/math/deviation.md.
    #[inline(always)]
    fn pace(&self) -> Rates<N> {
        let k = N::constant;
        let [(x, a), (y, b), (z, c)] = self.steps;
        let (a, b, c) = (a * x, b * y, c * z);
        let straight = k(6.0) * N::length(b - a).larger(N::length(c - b));
        let turning = (k(6.0) + k(1.4) * z) * N::length(a.cross(b))
            + k(2.1) * N::length(a.cross(c))
            + k(12.0) * N::length(b.cross(c));
        Rates { speed: k(3.0) * x.larger(y).larger(z), acceleration: straight + turning }
    }
}

/// A key with both its neighbours.
pub(super) struct Corner<N = f64> {
    pub(super) before: Neighbour<N>,
    pub(super) key: Quat<N>,
    pub(super) after: Neighbour<N>,
}

/// How near −1 a product has no axis worth using.
const NO_AXIS: f64 = 1e-6;

/// log of a product of two steps, and `sum`, of their logarithms, where the product lies
/// so near −1 that any axis would do.
#[inline(always)]
pub(super) fn log_of_product<N: Number>(product: Quat<N>, sum: Vec3<N>) -> Vec3<N> {
    let from_minus_one = Quat { w: product.w + N::from(1.0), v: product.v };
    let (log, square) = (N::log(product), from_minus_one.dot(from_minus_one));
    let near = NO_AXIS * NO_AXIS;
    Vec3::new(
        square.below(near, sum.x, log.x),
        square.below(near, sum.y, log.y),
        square.below(near, sum.z, log.z),
    )
}

/// A scheme whose outer control rotations follow from the key and its neighbours.
pub(super) trait Handles {
    /// The step from a key to the next control rotation in a segment of h seconds.
    fn leaving<N: Number>(corner: &Corner<N>, h: N, tcb: Tcb) -> Vec3<N>;

    /// The step that leads to a key: by symmetry the same.
    #[inline(always)]
    fn arriving<N: Number>(corner: &Corner<N>, h: N, tcb: Tcb) -> Vec3<N> {
        Self::leaving(corner, h, tcb)
    }
}

impl<T: Handles> Broad for T {
    type Curve<N: Number> = CumulativeCubic<N>;

    #[inline(always)]
    fn curve<N: Number>(span: &Span<N>) -> CumulativeCubic<N> {
        let Span { start, end, h, tcb, .. } = *span;
        let own = Neighbour { key: start, h, is_end: false };
        // Not by `map`: what closures hold may stay a call, of which no vector code is made.
        let first = match span.before_or_repeated() {
            Some(before) => {
                let after = Neighbour { key: end, ..own };
                Some(T::leaving(&Corner { before, key: start, after }, h, tcb))
            }
            None => None,
        };
        let last = match span.after_or_repeated() {
            Some(after) => Some(T::arriving(&Corner { before: own, key: end, after }, h, tcb)),
            None => None,
        };
        match (first, last) {
            (Some(first), Some(last)) => CumulativeCubic::between(start, end, first, last),
            _ => at_an_end(span, first, last),
        }
    }
}

/// The cubic of a span at an end, where one step or both do not follow from neighbours.
fn at_an_end<N: Number>(span: &Span<N>, first: Option<Vec3<N>>, last: Option<Vec3<N>>) -> CumulativeCubic<N> {
    let Span { start, end, end_rule, .. } = *span;
    let k = N::constant;
    let chord = start.conjugate() * end;
    // Where a neighbour is missing, the velocity may be given.
    let given = match end_rule {
        End::Chord(share) => Some(N::log(chord) * k(share / 3.0)),
        End::Natural | End::Repeat => None,
    };
    match (first.or(given), last.or(given)) {
        (Some(first), Some(last)) => CumulativeCubic::between(start, end, first, last),
        (None, None) => CumulativeCubic::new(start, [N::log(chord) * k(1.0 / 3.0); 3]),
        // The missing control rotation halves the way to the other inner one.
        (None, Some(last)) => {
            let half = N::log(chord * Quat::exp(-last)) * k(0.5);
            CumulativeCubic::new(start, [half, half, last])
        }
        (Some(first), None) => {
            let half = N::log(Quat::exp(-first) * chord) * k(0.5);
            CumulativeCubic::new(start, [first, half, half])
        }
    }
}

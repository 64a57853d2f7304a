//! `squad`: a slerp between two slerps, one of keys and one of control rotations.

use super::arc::GreatArc;
use super::log_rates::{BEND, stretch};
use super::rule::{Broad, Formula, Paced, Rule, Smoothness};
use super::span::{End, Neighbour, Span};
use super::{Arc, Rates};
use crate::math::{Number, Quat, Scalar};

/// Shoemake 1987; docs/math/squad.md.
pub(super) struct Squad;

/// slerp(slerp(q₁, q₂, u), slerp(a₁, a₂, u), 2u(1−u)).
#[derive(Clone, Copy, Debug)]
pub(super) struct SquadArc<N = f64> {
    keys: GreatArc<N>,
    controls: GreatArc<N>,
}

impl Rule for Squad {
    const NAME: &'static str = "squad";
    const SUMMARY: &'static str = "Shoemake's spline; smooth on even keys";
    const SMOOTHNESS: Smoothness = Smoothness::EvenKeys;
    type Arc = SquadArc;

    fn arc(span: &Span) -> SquadArc {
        Squad::curve(span)
    }
}

impl Broad for Squad {
    type Curve<N: Number> = SquadArc<N>;

    #[inline(always)]
    fn curve<N: Number>(span: &Span<N>) -> SquadArc<N> {
        let Span { start, end, .. } = *span;
        let (a1, a2) = controls(span);
        SquadArc { keys: GreatArc::new(start, end), controls: GreatArc::new(a1, a2) }
    }
}

impl<N: Copy> Formula<N> for SquadArc<N> {
    #[inline(always)]
    fn point<S: Scalar + From<N>>(&self, u: S) -> Quat<S> {
        let key = self.keys.point(u);
        let across = (key.conjugate() * self.controls.point(u)).smooth_log();
        key * Quat::exp(across * (S::constant(2.0) * u * (S::constant(1.0) - u)))
    }
}

impl Arc for SquadArc {
    #[inline(always)]
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        self.point(u)
    }

    fn rates(&self) -> Rates {
        self.pace()
    }
}

impl<N: Number> Paced<N> for SquadArc<N> {
    /// With p and s the two inner arcs, which turn at constant P and S, L = log p⁻¹s and
    /// X = 2u(1−u) L, q = p exp X: its acceleration is at most
    /// 2|P||X′| + |X″| + 1.5|X||X′|². L′ and L″ follow from ρ = S − Ad(r⁻¹) P, the
    /// velocity of r = p⁻¹s. Derived in docs/math/deviation.md.
    #[inline(always)]
    fn pace(&self) -> Rates<N> {
        let k = N::constant;
        let (p, s) = (self.keys.step(), self.controls.step());
        let (turn, across) = (N::length(p), N::length(s - p));
        let (start, end) = (self.apart(k(0.0)), self.apart(k(1.0)));
        // r moves by at most |P| + |S| in all, and an end is never further than half.
        let way = -(-(turn + N::length(s))).larger(-(across + k(2.0) * turn));
        let theta = start.larger(end) + k(0.5) * way;
        let sine = theta.sin_cos().0;
        let rho = across + k(2.0) * sine * turn;
        let stretch = stretch(theta);
        let log1 = stretch * rho;
        let log2 = stretch * (k(2.0) * turn * rho + k(BEND) * theta * log1 * log1);
        let x1 = k(2.0) * theta + k(0.5) * log1;
        let x2 = k(4.0) * theta + k(4.0) * log1 + k(0.5) * log2;
        // X is no longer than half of L.
        let bent = k(0.5 * BEND) * theta * x1 * x1;
        let (speed, acceleration) = (turn + x1, k(2.0) * turn * x1 + x2 + bent);
        let unknown = k(f64::INFINITY);
        Rates {
            speed: theta.below(WIDE, speed, unknown),
            acceleration: theta.below(WIDE, acceleration, unknown),
        }
    }
}

/// Where the two inner arcs can be so far apart, as quaternions, nothing is said of rates.
const WIDE: f64 = 1.5;

impl<N: Number> SquadArc<N> {
    /// How far the two inner arcs are apart at u.
    #[inline(always)]
    fn apart(&self, u: N) -> N {
        N::length(N::log(self.keys.point(u).conjugate() * self.controls.point(u)))
    }
}

/// The control rotations a₁ and a₂ of a span.
#[inline(always)]
fn controls<N: Number>(span: &Span<N>) -> (Quat<N>, Quat<N>) {
    let Span { start, end, .. } = *span;
    match (span.before_or_repeated(), span.after_or_repeated()) {
        (Some(before), Some(after)) => (control(before, start, end), control(after, end, start)),
        _ => controls_at_an_end(span),
    }
}

/// The same where one does not follow from a neighbour, or neither.
fn controls_at_an_end<N: Number>(span: &Span<N>) -> (Quat<N>, Quat<N>) {
    let Span { start, end, .. } = *span;
    let first = span.before_or_repeated().map(|before| control(before, start, end));
    let last = span.after_or_repeated().map(|after| control(after, end, start));
    let k = N::constant;
    let log = |from: Quat<N>, to: Quat<N>| N::log(from.conjugate() * to);
    // The velocity at a key is the step's and twice the logarithm of what leads to the control.
    let outer = |key: Quat<N>, other: Quat<N>, inner: Quat<N>| match span.end_rule {
        End::Chord(share) => key * Quat::exp(log(key, other) * k(0.5 * (share - 1.0))),
        End::Natural | End::Repeat => key * Quat::exp(log(other, inner) * k(0.5)),
    };
    match (first, last) {
        (Some(a1), Some(a2)) => (a1, a2),
        (None, Some(a2)) => (outer(start, end, a2), a2),
        (Some(a1), None) => (a1, outer(end, start, a1)),
        (None, None) => (start, end),
    }
}

/// qᵢ exp(−(log(qᵢ⁻¹qᵢ₋₁) + log(qᵢ⁻¹qᵢ₊₁))/4); its two neighbours play the same part.
#[inline(always)]
fn control<N: Number>(neighbour: Neighbour<N>, key: Quat<N>, other: Quat<N>) -> Quat<N> {
    let inverse = key.conjugate();
    let sum = N::log(inverse * neighbour.key) + N::log(inverse * other);
    key * Quat::exp(sum * N::constant(-0.25))
}

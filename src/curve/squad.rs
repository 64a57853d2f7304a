//! `squad`: a slerp between two slerps, one of keys and one of control rotations.

use super::arc::GreatArc;
use super::rule::{End, Neighbour, Rule, Smoothness, Span};
use super::{Arc, Rates};
use crate::math::{Quat, Scalar};

/// Shoemake 1987; docs/math/squad.md.
pub(super) struct Squad;

/// slerp(slerp(q₁, q₂, u), slerp(a₁, a₂, u), 2u(1−u)).
#[derive(Clone, Copy, Debug)]
pub(super) struct SquadArc {
    keys: GreatArc,
    controls: GreatArc,
}

impl Rule for Squad {
    const NAME: &'static str = "squad";
    const SUMMARY: &'static str = "Shoemake's spline; smooth on even keys";
    const SMOOTHNESS: Smoothness = Smoothness::EvenKeys;
    type Arc = SquadArc;

    fn arc(span: &Span) -> SquadArc {
        let Span { start, end, .. } = *span;
        let (a1, a2) = controls(span);
        SquadArc { keys: GreatArc::new(start, end), controls: GreatArc::new(a1, a2) }
    }
}

impl Arc for SquadArc {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let key = self.keys.at(u);
        let across = (key.conjugate() * self.controls.at(u)).smooth_log();
        key * Quat::exp(across * (S::constant(2.0) * u * (S::constant(1.0) - u)))
    }

    /// With p and s the two inner arcs, which turn at constant P and S, L = log p⁻¹s and
    /// X = 2u(1−u) L, q = p exp X: its acceleration is at most
    /// 2|P||X′| + |X″| + e^{2|X|}|X′|². L′ and L″ follow from ρ = S − Ad(r⁻¹) P, the
    /// velocity of r = p⁻¹s. Derived in docs/math/deviation.md.
    fn rates(&self) -> Rates {
        let (p, s) = (self.keys.step(), self.controls.step());
        let log = |u: f64| (self.keys.at(u).conjugate() * self.controls.at(u)).log().length();
        // r moves by at most |P| + |S| in all, and an end is never further than half.
        let theta =
            log(0.0).max(log(1.0)) + 0.5 * (p.length() + s.length()).min((s - p).length() + 2.0 * p.length());
        if theta >= 1.5 {
            return Rates { speed: f64::INFINITY, acceleration: f64::INFINITY };
        }
        let rho = (s - p).length() + 2.0 * theta.sin() * p.length();
        let stretch = theta / theta.sin().max(f64::MIN_POSITIVE);
        let stretch = if theta == 0.0 { 1.0 } else { stretch };
        let log1 = stretch * rho;
        let log2 = stretch * (2.0 * p.length() * rho + (2.0 * theta).exp() * log1 * log1);
        let x1 = 2.0 * theta + 0.5 * log1;
        let x2 = 4.0 * theta + 4.0 * log1 + 0.5 * log2;
        Rates { speed: p.length() + x1, acceleration: 2.0 * p.length() * x1 + x2 + theta.exp() * x1 * x1 }
    }
}

/// The control rotations a₁ and a₂ of a span.
fn controls(span: &Span) -> (Quat, Quat) {
    let Span { start, end, .. } = *span;
    let first = span.before_or_repeated().map(|before| control(before, start, end));
    let last = span.after_or_repeated().map(|after| control(after, end, start));
    // The velocity at a key is the step's and twice the logarithm of what leads to the control.
    let outer = |key: Quat, other: Quat, inner: Quat| match span.end_rule {
        End::Chord(share) => key * Quat::exp((key.conjugate() * other).log() * (0.5 * (share - 1.0))),
        End::Natural | End::Repeat => key * Quat::exp((other.conjugate() * inner).log() * 0.5),
    };
    match (first, last) {
        (Some(a1), Some(a2)) => (a1, a2),
        (None, Some(a2)) => (outer(start, end, a2), a2),
        (Some(a1), None) => (a1, outer(end, start, a1)),
        (None, None) => (start, end),
    }
}

/// qᵢ exp(−(log(qᵢ⁻¹qᵢ₋₁) + log(qᵢ⁻¹qᵢ₊₁))/4); its two neighbours play the same part.
fn control(neighbour: Neighbour, key: Quat, other: Quat) -> Quat {
    let log = |q: Quat| (key.conjugate() * q).log();
    key * Quat::exp((log(neighbour.key) + log(other)) * -0.25)
}

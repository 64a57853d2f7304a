//! Moves of one file, searched side by side until one of them is refused.

use crate::curve::Rates;
use crate::reduce::Curve;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The first turn that was refused, if any.
pub(super) struct Refused(AtomicUsize);

impl Refused {
    pub(super) fn none() -> Refused {
        Refused(AtomicUsize::new(usize::MAX))
    }

    pub(super) fn note(&self, turn: usize) {
        self.0.fetch_min(turn, Ordering::Relaxed);
    }
}

/// A curve whose turn it is after others: of no use once one of them is refused. So what is
/// refused in the end does not depend on which search is the faster.
pub(super) struct InTurn<'a, C> {
    pub(super) curve: C,
    pub(super) turn: usize,
    pub(super) refused: &'a Refused,
}

impl<C: Curve> Curve for InTurn<'_, C> {
    type Value = C::Value;

    fn at(&self, t: f64) -> C::Value {
        self.curve.at(t)
    }

    fn knots(&self) -> &[f64] {
        self.curve.knots()
    }

    fn corners(&self) -> &[f64] {
        self.curve.corners()
    }

    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        self.curve.rates(from, to)
    }

    fn cubic(&self, from: f64, to: f64) -> Option<[[f64; 3]; 4]> {
        self.curve.cubic(from, to)
    }

    fn ramps(&self) -> &[(f64, f64)] {
        self.curve.ramps()
    }

    fn first_spin(&self) -> Option<f64> {
        self.curve.first_spin()
    }

    fn is_given_up(&self) -> bool {
        self.refused.0.load(Ordering::Relaxed) < self.turn
    }
}

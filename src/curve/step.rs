//! `step`: each key holds until the next.

use super::rule::{Rule, Smoothness};
use super::span::Span;
use super::{Arc, Rates};
use crate::math::{Quat, Scalar};

/// docs/math/step.md.
pub(super) struct Step;

impl Rule for Step {
    const NAME: &'static str = "step";
    const SUMMARY: &'static str = "each key holds until the next";
    const SMOOTHNESS: Smoothness = Smoothness::Jumps;
    const HAS_ENDS: bool = false;
    type Arc = Held;

    fn arc(span: &Span) -> Held {
        Held(span.start)
    }
}

/// A rotation that rests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held(Quat);

impl Arc for Held {
    fn at<S: Scalar>(&self, _u: S) -> Quat<S> {
        Quat::constant(self.0)
    }

    fn rates(&self) -> Rates {
        Rates { speed: 0.0, acceleration: 0.0 }
    }
}

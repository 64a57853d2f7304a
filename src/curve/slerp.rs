//! `slerp`: constant speed from key to key, a corner at each.

use super::arc::GreatArc;
use super::rule::{Broad, Rule, Smoothness};
use super::span::Span;
use crate::math::Number;

/// Shoemake 1985; docs/math/slerp.md.
pub(super) struct Slerp;

impl Rule for Slerp {
    const NAME: &'static str = "slerp";
    const SUMMARY: &'static str = "constant speed from key to key, a corner at each";
    const SMOOTHNESS: Smoothness = Smoothness::Corners;
    const HAS_ENDS: bool = false;
    type Arc = GreatArc;

    fn arc(span: &Span) -> GreatArc {
        Slerp::curve(span)
    }
}

impl Broad for Slerp {
    type Curve<N: Number> = GreatArc<N>;

    #[inline(always)]
    fn curve<N: Number>(span: &Span<N>) -> GreatArc<N> {
        GreatArc::new(span.start, span.end)
    }
}

#[cfg(test)]
mod tests {
    use crate::curve::{Ends, Motion, Scheme};
    use crate::math::{Quat, Vec3};
    use proptest::prelude::*;

    fn power(q: Quat, t: f64) -> Quat {
        Quat::exp(q.log() * t)
    }

    proptest! {
        /// The four ways in which books write it.
        #[test]
        fn four_forms_are_one(
            first in prop::array::uniform3(-1.5..1.5f64),
            turn in prop::array::uniform3(-0.85..0.85f64),
            t in 0.0..=1.0f64,
        ) {
            let rotation = |[x, y, z]: [f64; 3]| Quat::exp(Vec3::new(x, y, z));
            let a = rotation(first);
            let b = (a * rotation(turn)).aligned_to(a);
            let keys = [a, b];
            let curve = Motion::new(&[0.0, 1.0], &keys, Scheme::Slerp, Ends::Natural).at(t);
            let forms = [
                a * power(a.conjugate() * b, t),
                b * power(b.conjugate() * a, 1.0 - t),
                power(a * b.conjugate(), 1.0 - t) * b,
                power(b * a.conjugate(), t) * a,
            ];
            // A handful of products, each exact to a few units of 1.1e-16 in the numbers.
            for form in forms {
                prop_assert!(form.angle_to(curve) < 1e-14, "{form:?} {curve:?}");
            }
        }
    }
}

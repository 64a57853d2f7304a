//! `slerp`: constant speed from key to key, a corner at each.

use super::arc::GreatArc;
use super::rule::{Rule, Smoothness, Span};

/// Shoemake 1985; docs/math/slerp.md.
pub(super) struct Slerp;

impl Rule for Slerp {
    const NAME: &'static str = "slerp";
    const SUMMARY: &'static str = "constant speed from key to key, a corner at each";
    const SMOOTHNESS: Smoothness = Smoothness::Corners;
    const HAS_ENDS: bool = false;
    type Arc = GreatArc;

    fn arc(span: &Span) -> GreatArc {
        GreatArc::new(span.start, span.end)
    }
}

//! What a scheme is asked for, and what it is told.

use super::Arc;
use crate::math::Quat;

/// Where a scheme's motion has no jumps in speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothness {
    /// Not at the keys.
    Corners,
    /// At the keys too, where they are evenly spaced in time.
    EvenKeys,
    /// Everywhere.
    Always,
}

/// A neighbouring key and the time to it, seconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbour {
    pub(super) key: Quat,
    pub(super) h: f64,
}

/// What shapes the motion where a neighbour is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// It starts and stops without acceleration.
    Natural,
    /// It starts and stops at rest.
    Rest,
}

/// One segment with its surroundings: two keys h seconds apart, and their neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) before: Option<Neighbour>,
    pub(super) start: Quat,
    pub(super) end: Quat,
    pub(super) h: f64,
    pub(super) after: Option<Neighbour>,
    pub(super) end_rule: End,
}

/// A scheme: how the curve between two keys follows from them and their neighbours.
pub(super) trait Rule {
    /// As the user names it.
    const NAME: &'static str;
    /// In a line, for the help text.
    const SUMMARY: &'static str;
    const SMOOTHNESS: Smoothness;
    type Arc: Arc + Copy;
    fn arc(span: &Span) -> Self::Arc;
}

//! `barry-goldman`: a pyramid of slerps, Catmull–Rom's for knots at the key times.

use super::arc::direction;
use super::rule::{End, Neighbour, Rule, Smoothness, Span};
use super::{Arc, Rates};
use crate::math::{Interval, Quat, Scalar, Vec3};
use std::f64::consts::PI;

/// Barry and Goldman 1988 with slerps for straight lines; docs/math/barry-goldman.md.
pub(super) struct BarryGoldman;

impl Rule for BarryGoldman {
    const NAME: &'static str = "barry-goldman";
    const SUMMARY: &'static str = "Catmull-Rom by recursive slerps; smooth on any keys";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = Pyramid;

    fn arc(span: &Span) -> Pyramid {
        let Span { start, end, before, after, .. } = *span;
        let step = (start.conjugate() * end).log();
        let early = before.map(|before| Line::to(before, span.h, start));
        let late = after.map(|after| Line::to(after, span.h, end));
        let bend = |step: Vec3, inner: Option<Line>| match (span.end_rule, inner) {
            (End::Chord(share), _) => step * (share - 1.0),
            (End::Repeat, _) => step * -0.5,
            (End::Natural, Some(inner)) => natural_bend(step, inner),
            (End::Natural, None) => Vec3::ZERO,
        };
        Pyramid {
            keys: [start, end],
            step,
            sides: [
                early.map_or_else(|| Side::End(bend(step, late)), Side::Line),
                late.map_or_else(|| Side::End(bend(-step, early)), Side::Line),
            ],
        }
    }
}

/// The way from a key to its neighbour outside the segment, at constant speed.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// The step to the neighbour, in the key's frame.
    away: Vec3,
    /// The interval to it, as a multiple of the segment's.
    interval: f64,
}

impl Line {
    fn to(neighbour: Neighbour, h: f64, key: Quat) -> Line {
        Line { away: (key.conjugate() * neighbour.key).log(), interval: neighbour.h / h }
    }

    /// Where it has run on to at u within the segment, seen from the key.
    fn beyond<S: Scalar>(&self, u: S) -> Quat<S> {
        turn(self.away, u * S::constant(-1.0 / self.interval))
    }
}

/// Half of what the curve through the other three keys leaves the end faster than `step`.
/// Bent so, the end is without acceleration.
fn natural_bend(step: Vec3, inner: Line) -> Vec3 {
    let back = Quat::exp(inner.away * (-1.0 / inner.interval));
    (Quat::exp(step) * back).log() * (0.5 / (1.0 + inner.interval))
}

/// What runs through the segment's two keys on one side of it.
#[derive(Clone, Copy, Debug)]
enum Side {
    /// The curve through the neighbour too.
    Line(Line),
    /// At an end: the step, bent by this vector times u(1 − u).
    End(Vec3),
}

/// Slerps from key to key, slerps between these, and one between those.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pyramid {
    keys: [Quat; 2],
    step: Vec3,
    sides: [Side; 2],
}

impl Side {
    /// Where the side runs at u, seen from its key, from which `step` leads to the other key.
    fn at<S: Scalar>(&self, step: Vec3, u: S) -> Quat<S> {
        let k = S::constant;
        match self {
            Side::End(bend) => {
                let bent = Vec3::constant(*bend) * (u * (k(1.0) - u));
                Quat::exp(Vec3::constant(step) * u + bent)
            }
            Side::Line(line) => {
                let share = (u + k(line.interval)) * k(1.0 / (1.0 + line.interval));
                between(line.beyond(u), turn(step, u), share)
            }
        }
    }
}

impl Pyramid {
    /// How far apart what is blended may come, half an angle.
    fn reach(&self) -> f64 {
        let reach = |side: &Side| match side {
            Side::End(bend) => bend.length(),
            Side::Line(Line { away, interval }) => away.length() / interval + self.step.length(),
        };
        self.sides.iter().map(reach).sum()
    }

    /// Whether it swings round while what is blended spins through a dozen turns and more.
    pub(super) fn spins(&self) -> bool {
        self.reach() > 12.0 * PI && self.swings()
    }

    /// Whether any two slerps that are blended come so near to a full turn apart that the
    /// curve swings round, or jumps.
    pub(super) fn swings(&self) -> bool {
        const NEAR: f64 = 0.5;
        const PLACES: u32 = 64;
        let wide = |from: Quat, to: Quat| (from.conjugate() * to).log().length() > PI - NEAR;
        // What is blended is no further apart than its parts reach.
        self.reach() > PI - NEAR
            && (0..=PLACES).any(|i| {
                let u = f64::from(i) / f64::from(PLACES);
                let [early, late] = self.blends(u);
                let lines = [(0, self.step, u), (1, -self.step, 1.0 - u)];
                let apart = lines.into_iter().any(|(k, step, u)| match &self.sides[k] {
                    Side::End(_) => false,
                    Side::Line(line) => wide(line.beyond(u), turn(step, u)),
                });
                apart || wide(early, late)
            })
    }

    /// The curves of both sides at u, seen from the first key.
    fn blends<S: Scalar>(&self, u: S) -> [Quat<S>; 2] {
        let [start, end] = self.keys;
        let late = self.sides[1].at(-self.step, S::constant(1.0) - u);
        [self.sides[0].at(self.step, u), Quat::constant(start.conjugate() * end) * late]
    }
}

impl Arc for Pyramid {
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        let [early, late] = self.blends(u);
        Quat::constant(self.keys[0]) * between(early, late, u)
    }

    /// By interval arithmetic: the formula is too deep for a closed form that is near.
    fn rates(&self) -> Rates {
        Rates::within(self, Interval::new(0.0, 1.0))
    }
}

/// exp(step · u), by the sine of an angle, of which bounds do not lose sight beyond a turn.
fn turn<S: Scalar>(step: Vec3, u: S) -> Quat<S> {
    let (length, axis) = direction(step);
    let (sin, cos) = (u * S::constant(length)).sin_cos();
    Quat { w: cos, v: Vec3::constant(axis) * sin }
}

/// slerp(a, b, u), by the logarithm of the whole step: less than a full turn.
fn between<S: Scalar>(a: Quat<S>, b: Quat<S>, u: S) -> Quat<S> {
    a * Quat::exp((a.conjugate() * b).smooth_log() * u)
}

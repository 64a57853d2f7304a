//! `barry-goldman`: a pyramid of slerps, Catmull–Rom's for knots at the key times.

use super::arc::turn;
use super::log_rates::{BEND, stretch};
use super::rule::{Broad, Formula, Paced, Rule, Smoothness};
use super::span::{End, Neighbour, Span};
use super::{Arc, Rates};
use crate::math::{Interval, Number, Quat, Scalar, Vec3};
use std::f64::consts::PI;

/// Barry and Goldman 1988 with slerps for straight lines; docs/math/barry-goldman.md.
pub(super) struct BarryGoldman;

impl Rule for BarryGoldman {
    const NAME: &'static str = "barry-goldman";
    const SUMMARY: &'static str = "Catmull-Rom by recursive slerps; smooth on any keys";
    const SMOOTHNESS: Smoothness = Smoothness::Always;
    type Arc = Pyramid;

    fn arc(span: &Span) -> Pyramid {
        BarryGoldman::curve(span)
    }
}

impl Broad for BarryGoldman {
    type Curve<N: Number> = Pyramid<N>;

    #[inline(always)]
    fn curve<N: Number>(span: &Span<N>) -> Pyramid<N> {
        let Span { start, end, h, .. } = *span;
        let across = start.conjugate() * end;
        let sides = match (span.before, span.after) {
            (Some(before), Some(after)) => {
                [Side::Line(Line::to(before, h, start)), Side::Line(Line::to(after, h, end))]
            }
            _ => sides_at_an_end(span),
        };
        Pyramid { start, across, step: N::polar(across), sides }
    }

    fn is_tame(span: &Span) -> bool {
        let pyramid = BarryGoldman::curve(span);
        pyramid.widest(&pyramid.bows()) < WIDE
    }
}

/// The sides of a span where one is without a neighbour, or both.
fn sides_at_an_end<N: Number>(span: &Span<N>) -> [Side<N>; 2] {
    let Span { start, end, h, .. } = *span;
    let step = N::log(start.conjugate() * end);
    let early = span.before.map(|before| Line::to(before, h, start));
    let late = span.after.map(|after| Line::to(after, h, end));
    let bend = |step: Vec3<N>, inner: Option<Line<N>>| match (span.end_rule, inner) {
        (End::Chord(share), _) => step * N::from(share - 1.0),
        (End::Repeat, _) => step * N::from(-0.5),
        (End::Natural, Some(inner)) => natural_bend(step, inner),
        (End::Natural, None) => step * N::from(0.0),
    };
    [
        early.map_or_else(|| Side::End(bend(step, late)), Side::Line),
        late.map_or_else(|| Side::End(bend(-step, early)), Side::Line),
    ]
}

/// Half of what the curve through the other three keys leaves the end faster than `step`.
/// Bent so, the end is without acceleration.
fn natural_bend<N: Number>(step: Vec3<N>, inner: Line<N>) -> Vec3<N> {
    let faster = N::log(Quat::exp(step) * inner.beyond(N::from(1.0)));
    faster * (N::from(0.5) / (N::from(1.0) + inner.interval))
}

/// The way from a key to its neighbour outside the segment, at constant speed.
#[derive(Clone, Copy, Debug)]
struct Line<N = f64> {
    /// Length and unit axis of the step to the neighbour, in the key's frame.
    away: (N, Vec3<N>),
    /// The interval to it, as a multiple of the segment's.
    interval: N,
}

impl<N: Number> Line<N> {
    #[inline(always)]
    fn to(neighbour: Neighbour<N>, h: N, key: Quat<N>) -> Line<N> {
        Line { away: N::polar(key.conjugate() * neighbour.key), interval: neighbour.h / h }
    }

    /// The velocity at which it runs on within the segment.
    #[inline(always)]
    fn velocity(&self) -> Vec3<N> {
        self.away.1 * (-self.away.0 / self.interval)
    }

    /// Where it has run on to at u within the segment, seen from the key.
    #[inline(always)]
    fn beyond<S: Scalar + From<N>>(&self, u: S) -> Quat<S> {
        turn(self.away, u * S::from(N::from(-1.0) / self.interval))
    }
}

/// What runs through the segment's two keys on one side of it.
#[derive(Clone, Copy, Debug)]
enum Side<N = f64> {
    /// The curve through the neighbour too.
    Line(Line<N>),
    /// At an end: the step, bent by this vector times u(1 − u).
    End(Vec3<N>),
}

/// Slerps from key to key, slerps between these, and one between those.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pyramid<N = f64> {
    start: Quat<N>,
    /// From the first key to the second.
    across: Quat<N>,
    /// Length and unit axis of its logarithm.
    step: (N, Vec3<N>),
    sides: [Side<N>; 2],
}

/// Where what is blended is so near to a full turn apart, half an angle, the curve swings round.
const NEAR: f64 = 0.5;

impl<N: Number> Side<N> {
    /// Where the side runs at u, seen from its key, from which `step` leads to the other key.
    #[inline(always)]
    fn at<S: Scalar + From<N>>(&self, step: (N, Vec3<N>), u: S) -> Quat<S> {
        let one = S::constant(1.0);
        match self {
            Side::End(bend) => {
                let bent = Vec3::constant(*bend) * (u * (one - u));
                Quat::exp(Vec3::constant(step.1) * (u * S::from(step.0)) + bent)
            }
            Side::Line(line) => {
                let whole = N::from(1.0) / (N::from(1.0) + line.interval);
                let share = (u + S::from(line.interval)) * S::from(whole);
                between(line.beyond(u), turn(step, u), share)
            }
        }
    }

    /// How it leaves the straight way of a step.
    #[inline(always)]
    fn bow(&self, step: Vec3<N>) -> Bow<N> {
        match self {
            Side::End(bend) => Bow::bent(step, *bend),
            Side::Line(line) => {
                Bow::blended(step, line.velocity(), N::from(1.0) / (N::from(1.0) + line.interval))
            }
        }
    }
}

/// A curve from key to key that is nearly a parabola: its velocity is the step's and (2u − 1)
/// times a vector, its acceleration twice the vector, but for errors. It is no further from the
/// step than a quarter of the vector's length.
#[derive(Clone, Copy, Debug)]
struct Bow<N> {
    vector: Vec3<N>,
    /// The largest errors of velocity and acceleration.
    off: Rates<N>,
    /// How far apart two rotations get that are blended for it.
    width: N,
}

/// Where two rotations that are blended can be so far apart nothing is said of rates, and digits are
/// lost towards a full turn.
const WIDE: f64 = 2.5;

impl<N: Number> Bow<N> {
    /// How far apart two of one step can be.
    #[inline(always)]
    fn apart(p: &Bow<N>, s: &Bow<N>) -> N {
        N::from(0.25) * (N::length(p.vector) + N::length(s.vector))
    }

    /// exp(u step + u(1 − u) bend). With c = |step × bend| and X that sum, X × X′ is −u² and
    /// X × X″ −2u times step × bend.
    #[inline(always)]
    fn bent(step: Vec3<N>, bend: Vec3<N>) -> Bow<N> {
        let k = N::constant;
        let c = N::length(step.cross(bend));
        let acceleration = c * (k(2.0) + k(BEND) * (N::length(step) + N::length(bend)));
        Bow { vector: -bend, off: Rates { speed: c, acceleration }, width: k(0.0) }
    }

    /// The blend of a turn at `velocity` into the step, of which the second has the weight
    /// 1 − (1 − u) share: the step followed by exp Y, Y = −(1 − u) share L with L the logarithm of
    /// what leads from the first turn to the second. Derived in docs/math/deviation.md.
    #[inline(always)]
    fn blended(step: Vec3<N>, velocity: Vec3<N>, share: N) -> Bow<N> {
        let k = N::constant;
        let (difference, length) = (step - velocity, N::length(step));
        let (width, c) = (N::length(difference), k(2.0) * N::length(step.cross(velocity)));
        // L is no longer than u width, and turns at no more than this.
        let (stretch, rate) = (stretch(width), width + c);
        let log1 = stretch * rate;
        let log2 = stretch * (c + k(BEND) * width * log1 * log1);
        // What L′ differs from the difference, and Y″ from twice its share.
        let tilt = c + stretch * width * rate;
        let tilt2 = share * (k(2.0) * tilt + log2);
        let (y0, y1) = (k(0.25) * share * width, share * log1);
        let y2 = k(2.0) * share * width + tilt2;
        let off = Rates {
            speed: share * tilt + y0 * (k(2.0) * length + y1),
            acceleration: tilt2 + k(2.0) * y1 * length + y0 * (y2 + k(BEND) * y1 * y1),
        };
        Bow { vector: difference * share, off, width }
    }
}

impl Pyramid {
    /// How far apart what is blended may come, half an angle.
    fn reach(&self) -> f64 {
        let reach = |side: &Side| match side {
            Side::End(bend) => bend.length(),
            Side::Line(line) => line.away.0 / line.interval + self.step.0,
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
        const PLACES: u32 = 64;
        let wide = |from: Quat, to: Quat| (from.conjugate() * to).log().length() > PI - NEAR;
        // What is blended is no further apart than its parts reach.
        self.reach() > PI - NEAR
            && (0..=PLACES).any(|i| {
                let u = f64::from(i) / f64::from(PLACES);
                let [early, late] = self.blends(u);
                let lines = [(0, self.step, u), (1, self.back(), 1.0 - u)];
                let apart = lines.into_iter().any(|(k, step, u)| match &self.sides[k] {
                    Side::End(_) => false,
                    Side::Line(line) => wide(line.beyond(u), turn(step, u)),
                });
                apart || wide(early, late)
            })
    }
}

impl<N: Number> Pyramid<N> {
    /// The step from the second key to the first.
    #[inline(always)]
    fn back(&self) -> (N, Vec3<N>) {
        (self.step.0, -self.step.1)
    }

    /// How both sides leave the step.
    #[inline(always)]
    fn bows(&self) -> [Bow<N>; 2] {
        let step = self.step.1 * self.step.0;
        [self.sides[0].bow(step), self.sides[1].bow(-step)]
    }

    /// How far apart two rotations get that are blended, at most.
    #[inline(always)]
    fn widest(&self, [p, s]: &[Bow<N>; 2]) -> N {
        Bow::apart(p, s).larger(p.width).larger(s.width)
    }

    /// The curves of both sides at u, seen from the first key.
    #[inline(always)]
    fn blends<S: Scalar + From<N>>(&self, u: S) -> [Quat<S>; 2] {
        let late = self.sides[1].at(self.back(), S::constant(1.0) - u);
        [self.sides[0].at(self.step, u), Quat::<S>::constant(self.across) * late]
    }
}

impl<N: Number> Formula<N> for Pyramid<N> {
    #[inline(always)]
    fn point<S: Scalar + From<N>>(&self, u: S) -> Quat<S> {
        let [early, late] = self.blends(u);
        Quat::<S>::constant(self.start) * between(early, late, u)
    }
}

impl Arc for Pyramid {
    #[inline(always)]
    fn at<S: Scalar>(&self, u: S) -> Quat<S> {
        self.point(u)
    }

    /// In closed form, or where that says nothing by interval arithmetic.
    fn rates(&self) -> Rates {
        let rates = self.pace();
        if rates.is_finite() { rates } else { Rates::within(self, Interval::new(0.0, 1.0)) }
    }
}

impl<N: Number> Paced<N> for Pyramid<N> {
    /// With p and s the two sides, L = log p⁻¹s and X = uL, q = p exp X. Were all axes one and steps
    /// small, it would be a cubic, whose acceleration is linear. Derived in docs/math/deviation.md.
    #[inline(always)]
    fn pace(&self) -> Rates<N> {
        let (k, norm) = (N::constant, N::length);
        let bows = self.bows();
        let [p, s] = &bows;
        let (bowed, more) = (norm(p.vector), norm(s.vector - p.vector));
        let width = Bow::apart(p, s);
        // The largest velocity and acceleration of p, and rates of p⁻¹s.
        let speed = self.step.0 + bowed + p.off.speed;
        let acceleration = k(2.0) * bowed + p.off.acceleration;
        let slip = p.off.speed + s.off.speed + k(2.0) * width * speed;
        let rate = more + slip;
        let slip2 = p.off.acceleration + s.off.acceleration + k(2.0) * (width * acceleration + rate * speed);
        let stretch = stretch(width);
        let log1 = stretch * rate;
        // What L′ and L″ differ from (2u − 1) and 2 times the difference of both bows.
        let tilt = slip + stretch * width * rate;
        let tilt2 = slip2 + stretch * width * (k(2.0) * more + slip2 + k(BEND) * log1 * log1);
        // L is zero at both ends.
        let x1 = log1 - (-width).larger(k(-0.5) * log1);
        let x2 = k(4.0) * more + k(2.0) * tilt + tilt2;
        let straight = |a: Vec3<N>, b: Vec3<N>| norm(a * k(4.0) - b * k(2.0));
        let known = Rates {
            speed: speed + x1,
            acceleration: straight(p.vector, s.vector).larger(straight(s.vector, p.vector))
                + p.off.acceleration
                + k(2.0) * (width * acceleration + x1 * speed + tilt)
                + tilt2
                + width * (x2 + k(BEND) * x1 * x1),
        };
        let (widest, unknown) = (self.widest(&bows), k(f64::INFINITY));
        Rates {
            speed: widest.below(WIDE, known.speed, unknown),
            acceleration: widest.below(WIDE, known.acceleration, unknown),
        }
    }
}

/// slerp(a, b, u), by the logarithm of the whole step: less than a full turn.
#[inline(always)]
fn between<S: Scalar>(a: Quat<S>, b: Quat<S>, u: S) -> Quat<S> {
    a * Quat::exp((a.conjugate() * b).smooth_log() * u)
}

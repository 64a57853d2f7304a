//! The proof that cubics as they are written keep the tolerance.
//!
//! As for LINEAR playback, every interval is bounded by branch and bound from the written
//! numbers; the difference of curve and cubic has at most the sum of both accelerations.
//! Where the curve itself is a cubic, the difference is one too and lies in the hull of
//! its control points.

use super::hermite::{Flat, Hermite};
use super::search::{Limits, Piece, fit};
use crate::curve::Rates;
use crate::reduce::curve::Curve;
use crate::reduce::pace;
use crate::reduce::proof::bound_part;
use crate::reduce::search::Stuck;
use crate::reduce::value::{Numbers, Value};
use crate::sample::worst::{Gap, Part, Worst};

/// How often an interval is halved at most.
const HALVINGS: u32 = 8;

/// Cubics that keep the tolerance, with what is known of their playback.
pub(super) struct Proven<const N: usize> {
    pub(super) pieces: Vec<Piece<N>>,
    pub(super) deviation: f64,
    /// The largest distance at a knot.
    pub(super) moved: f64,
}

/// Proves that playback stays within the tolerance, or makes it so by halving intervals.
pub(super) fn prove<C: Curve<Value: Flat<N>>, const N: usize>(
    curve: &C,
    pieces: Vec<Piece<N>>,
    limits: Limits,
    negligible: f64,
) -> Result<Proven<N>, Stuck> {
    let mut proof = Proof {
        curve,
        tolerance: limits.tolerance,
        worst: Worst::new(negligible),
        proven: Proven { pieces: Vec::with_capacity(pieces.len()), deviation: 0.0, moved: 0.0 },
    };
    pieces.iter().for_each(|piece| proof.probe(piece));
    for piece in pieces {
        proof.interval(piece, HALVINGS)?;
    }
    let Proof { worst, mut proven, .. } = proof;
    let last = proven.pieces[proven.pieces.len() - 1].to;
    let beyond = pace::beyond(curve, last.time, C::Value::read(last.value));
    if beyond > limits.tolerance {
        return Err(Stuck(f64::from(last.time)));
    }
    proven.deviation = worst.bound().min(limits.tolerance).max(beyond);
    Ok(proven)
}

struct Proof<'a, C, const N: usize> {
    curve: &'a C,
    tolerance: f64,
    worst: Worst,
    proven: Proven<N>,
}

impl<C: Curve<Value: Flat<N>>, const N: usize> Proof<'_, C, N> {
    /// Looks at the crests of a good fit: what is bounded need not be bounded closer.
    fn probe(&mut self, piece: &Piece<N>) {
        let beside = Beside::new(self.curve, piece);
        for u in [0.1, 0.5, 0.9] {
            let off = beside.at(beside.from + u * (beside.to - beside.from));
            if off <= self.tolerance {
                self.worst.note(off);
            }
        }
    }

    fn interval(&mut self, piece: Piece<N>, halvings: u32) -> Result<(), Stuck> {
        let beside = Beside::new(self.curve, &piece);
        let mut worst = self.worst.one_more(self.tolerance);
        let mut moved: f64 = 0.0;
        for part in beside.parts() {
            moved = moved.max(if part.from == beside.from { 0.0 } else { part.at_from });
            match beside.hull(&part) {
                Some(hull) => {
                    worst.note(part.at_from.max(part.at_to));
                    worst.settle(hull);
                }
                None => bound_part(&mut worst, &beside, part, self.curve.rates(part.from, part.to)),
            }
        }
        if worst.bound() > self.tolerance {
            return self.halves(piece, halvings);
        }
        self.worst.add(&worst);
        self.proven.moved = self.proven.moved.max(moved);
        if self.curve.knots().binary_search_by(|knot| knot.total_cmp(&beside.from)).is_ok() {
            self.proven.moved = self.proven.moved.max(beside.at(beside.from));
        }
        self.proven.pieces.push(piece);
        Ok(())
    }

    fn halves(&mut self, piece: Piece<N>, halvings: u32) -> Result<(), Stuck> {
        let middle = piece.from.time + 0.5 * (piece.to.time - piece.from.time);
        if middle <= piece.from.time || middle >= piece.to.time || halvings == 0 {
            return Err(Stuck(f64::from(piece.from.time)));
        }
        let (first, _) = fit(self.curve, piece.from, middle);
        let (mut second, _) = fit(self.curve, first.to, piece.to.time);
        // Its numbers may have the other sign; what follows goes on from those there were.
        second.to = piece.to;
        self.interval(first, halvings - 1)?;
        self.interval(second, halvings - 1)
    }
}

/// Playback of a cubic beside the curve.
struct Beside<'a, C, const N: usize> {
    curve: &'a C,
    from: f64,
    to: f64,
    played: Hermite<N>,
}

impl<C: Curve<Value: Flat<N>>, const N: usize> Beside<'_, C, N> {
    fn new<'a>(curve: &'a C, piece: &Piece<N>) -> Beside<'a, C, N> {
        let (from, to) = piece.times();
        Beside { curve, from, to, played: piece.played() }
    }

    fn place(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }

    /// The parts between knots.
    fn parts(&self) -> Vec<Part> {
        let knots = self.curve.knots();
        let inside = &knots[knots.partition_point(|&knot| knot <= self.from)..];
        let ends = inside.iter().copied().take_while(|&knot| knot < self.to).chain([self.to]);
        let mut before = (self.from, self.at(self.from));
        let mut parts = Vec::new();
        for to in ends {
            let at_to = self.at(to);
            parts.push(Part { from: before.0, to, at_from: before.1, at_to });
            before = (to, at_to);
        }
        parts
    }

    /// An upper bound of the distance on a part where the curve is a cubic itself.
    fn hull(&self, part: &Part) -> Option<f64> {
        let curve = self.curve.cubic(part.from, part.to)?;
        let played = self.played.control_points(self.place(part.from), self.place(part.to));
        let off = |(a, b): (&[f64; 3], &Numbers<N>)| {
            (0..N).map(|i| (a[i] - b.0[i]) * (a[i] - b.0[i])).sum::<f64>().sqrt()
        };
        Some(curve.iter().zip(&played).map(off).fold(0.0, f64::max))
    }
}

impl<C: Curve<Value: Flat<N>>, const N: usize> Gap for Beside<'_, C, N> {
    fn at(&self, t: f64) -> f64 {
        C::Value::shown(self.played.at(self.place(t))).distance(self.curve.at(t))
    }

    fn rates(&self, from: f64, to: f64) -> Rates {
        let unknown = Rates { speed: f64::INFINITY, acceleration: f64::INFINITY };
        self.curve.rates(from, to).unwrap_or(unknown)
    }

    fn bound(&self, part: &Part, rates: Rates) -> f64 {
        let own = self.played.rates::<C::Value>(self.place(part.from), self.place(part.to));
        let own = own.per_second(self.to - self.from);
        let sum = Rates { acceleration: rates.acceleration + own.acceleration, ..rates };
        C::Value::bound(sum, part.to - part.from, (part.at_from, part.at_to), own.speed)
    }
}

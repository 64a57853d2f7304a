//! What is to be played from few keys.

use super::value::{Numbers, Value};
use crate::curve::{Arc, Motion, Piece, Rates};
use crate::math::{Jet, Quat};
use crate::sample::Travel;
use crate::sample::interlude::{on_stretch, whole};

/// A value as a function of time.
pub trait Curve: Sync {
    /// What it holds.
    type Value: Value;
    /// The value at a time, seconds.
    fn at(&self, t: f64) -> Self::Value;
    /// Times, increasing from the first to the last, between any two of which the curve is smooth.
    fn knots(&self) -> &[f64];
    /// Times, increasing, that are to be keys besides the first and the last.
    fn corners(&self) -> &[f64];
    /// Upper bounds of speed and acceleration between two times that no knot parts, in
    /// the units of [`Value::distance`]; none where nothing is known.
    fn rates(&self, from: f64, to: f64) -> Option<Rates>;
    /// Where the curve is a cubic from one time to another, its Bézier control points; none
    /// where it is not, or is no place.
    fn cubic(&self, _from: f64, _to: f64) -> Option<[[f64; 3]; 4]> {
        None
    }
    /// Stretches that stand for a jump, starts and ends increasing: their turn is no step.
    fn ramps(&self) -> &[(f64, f64)] {
        &[]
    }
    /// After when the curve jumps, or turns at once by so much that keys had to follow each
    /// other as closely as can be; none where it does not.
    fn first_spin(&self) -> Option<f64> {
        None
    }
    /// Whether nobody asks for its keys any more: the search for them ends with some refusal.
    fn is_given_up(&self) -> bool {
        false
    }
}

/// Whether what follows a key is part of a ramp.
pub(super) fn on_ramp(curve: &impl Curve, key: f32) -> bool {
    let ramps = curve.ramps();
    let next = ramps.partition_point(|&(_, end)| end as f32 <= key);
    ramps.get(next).is_some_and(|&(start, _)| start as f32 <= key)
}

/// Velocities that differ by less, relatively, do not jump.
const JUMP: f64 = 1e-6;

/// A motion whose pieces are worked out once.
pub struct Turning {
    /// Each with the rates of the whole, which some schemes find out slowly.
    pieces: Vec<(Piece, Rates)>,
    knots: Vec<f64>,
    corners: Vec<f64>,
    ramp: Option<(f64, f64)>,
    first_spin: Option<f64>,
}

impl Turning {
    /// The motion with all its pieces; memory as much as its keys take.
    pub fn new(motion: Motion) -> Turning {
        let times = motion.times();
        let (first, last) = (times[0], times[times.len() - 1]);
        let mut pieces: Vec<Piece> = Vec::with_capacity(times.len());
        let mut t = first;
        while t < last {
            let piece = motion.piece_at(t);
            t = piece.end;
            pieces.push(piece);
        }
        let meet = |pair: &[Piece]| is_corner(&pair[0], &pair[1]).then_some(pair[1].start);
        let mut corners: Vec<f64> = pieces.windows(2).filter_map(meet).collect();
        // A jump at the end is a jump of the value: the motion rests elsewhere.
        corners.dedup();
        let mut knots: Vec<f64> = pieces.iter().map(|piece| piece.start).collect();
        knots.push(last);
        let pieces = pieces.into_iter().map(|piece| (piece, whole(&piece))).collect();
        let ramp = motion.ramp().map(|start| (start, times[1]));
        Turning { pieces, knots, corners, ramp, first_spin: motion.first_spin() }
    }

    fn piece(&self, t: f64) -> &(Piece, Rates) {
        let after = self.knots.partition_point(|&knot| knot <= t);
        &self.pieces[after.saturating_sub(1).min(self.pieces.len() - 1)]
    }
}

/// Whether the velocity jumps where two pieces meet.
pub(crate) fn is_corner(before: &Piece, after: &Piece) -> bool {
    let velocity =
        |piece: &Piece, u: f64| piece.at(Jet::<f64>::variable(u)).half_velocity() * (1.0 / piece.duration());
    let (a, b) = (velocity(before, 1.0), velocity(after, 0.0));
    (a - b).length() > JUMP * a.length().max(b.length())
}

impl Curve for Turning {
    type Value = Quat;

    fn at(&self, t: f64) -> Quat {
        let (piece, _) = self.piece(t);
        piece.at(piece.parameter(t))
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }

    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        let (piece, rates) = self.piece(from);
        Some(rates.and(on_stretch(piece, from, to)))
    }

    fn ramps(&self) -> &[(f64, f64)] {
        self.ramp.as_slice()
    }

    fn first_spin(&self) -> Option<f64> {
        self.first_spin
    }
}

/// A place on its way.
pub struct Travelling<'a> {
    travel: &'a dyn Travel,
    knots: Vec<f64>,
    corners: Vec<f64>,
}

impl<'a> Travelling<'a> {
    /// The way from one time to another. `corners` are the times at which its velocity
    /// jumps.
    pub fn new(travel: &'a dyn Travel, (from, to): (f64, f64), corners: &[f64]) -> Travelling<'a> {
        let corners = inside(corners, from, to);
        Travelling { travel, knots: framed(travel.knots(), &corners, from, to), corners }
    }
}

/// The times between two others.
fn inside(times: &[f64], from: f64, to: f64) -> Vec<f64> {
    let mut times: Vec<f64> = times.iter().copied().filter(|&t| from < t && t < to).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// The first and the last time with all others between them.
fn framed(knots: &[f64], more: &[f64], from: f64, to: f64) -> Vec<f64> {
    let mut all: Vec<f64> = knots.iter().chain(more).copied().collect();
    all = inside(&all, from, to);
    all.insert(0, from);
    all.push(to);
    all
}

impl Curve for Travelling<'_> {
    type Value = Numbers<3>;

    fn at(&self, t: f64) -> Numbers<3> {
        Numbers(self.travel.at(t).to_array())
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }

    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        let (speed, acceleration) =
            (self.travel.speed_bound(from, to), self.travel.acceleration_bound(from, to));
        Some(Rates { speed, acceleration })
    }

    fn cubic(&self, from: f64, to: f64) -> Option<[[f64; 3]; 4]> {
        self.travel.cubic(from, to).map(|points| points.map(|point| point.to_array()))
    }
}

/// A rotation that is a plain function of time: of it nothing is known but its values.
///
/// A function that jumps cannot be played; over each ramp, the stretch before a jump,
/// what is to be played is the shortest turn from the value at its start to the value
/// at its end.
pub struct Attitude<'a> {
    at: &'a (dyn Fn(f64) -> Quat + Sync),
    knots: Vec<f64>,
    corners: Vec<f64>,
    ramps: Vec<(f64, f64)>,
    /// The values at the start and the end of each of them.
    jumps: Vec<[Quat; 2]>,
}

impl<'a> Attitude<'a> {
    /// The function from one time to another, with the times between which it is smooth,
    /// and the stretches before its jumps.
    pub fn new(
        at: &'a (dyn Fn(f64) -> Quat + Sync),
        (from, to): (f64, f64),
        knots: &[f64],
        ramps: &[(f64, f64)],
    ) -> Attitude<'a> {
        // The jump is where the file's key is.
        let near = |t: f64| f64::from(t as f32);
        let ramps: Vec<(f64, f64)> = ramps.iter().map(|&(a, b)| (near(a), near(b))).collect();
        let ends: Vec<f64> = ramps.iter().flat_map(|&(a, b)| [a, b]).collect();
        let corners = inside(&ends, from, to);
        let jumps = ramps.iter().map(|&(a, b)| [at(a), at(b)]).collect();
        Attitude { at, knots: framed(knots, &corners, from, to), corners, ramps, jumps }
    }
}

impl Curve for Attitude<'_> {
    type Value = Quat;

    fn at(&self, t: f64) -> Quat {
        let next = self.ramps.partition_point(|&(_, to)| to <= t);
        match self.ramps.get(next).filter(|&&(from, _)| from < t) {
            None => (self.at)(t),
            Some(&(from, to)) => {
                let [a, b] = self.jumps[next];
                a.moved(a.step_to(b) * ((t - from) / (to - from)))
            }
        }
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }

    fn rates(&self, _from: f64, _to: f64) -> Option<Rates> {
        None
    }

    fn ramps(&self) -> &[(f64, f64)] {
        &self.ramps
    }
}

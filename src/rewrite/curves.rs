//! The curves that a file's own keys stand for, as the specification plays them.

use super::track::Track;
use crate::asset::play::slerp;
use crate::curve::Rates;
use crate::math::Quat;
use crate::reduce::{Curve, Numbers};

/// Vectors along cubics from key to key: straight ones for LINEAR, Hermite's for
/// CUBICSPLINE. Each piece is held as the control points of a Bézier curve.
pub(super) struct Cubics<const N: usize> {
    knots: Vec<f64>,
    pieces: Vec<Cubic<N>>,
}

/// The control points of a cubic Bézier curve.
pub(super) type Cubic<const N: usize> = [[f64; N]; 4];

impl<const N: usize> Cubics<N> {
    /// The curve through a track's keys; the track has N numbers to a value.
    pub(super) fn new(track: &Track) -> Cubics<N> {
        let knots: Vec<f64> = track.times.iter().map(|&t| f64::from(t)).collect();
        let pieces = (0..knots.len() - 1).map(|k| cubic(track, k)).collect();
        Cubics { knots, pieces }
    }

    /// The piece at a time, and the parameter on it.
    fn piece(&self, t: f64) -> (&Cubic<N>, f64, f64) {
        let after = self.knots.partition_point(|&knot| knot <= t);
        let i = after.saturating_sub(1).min(self.pieces.len() - 1);
        let h = self.knots[i + 1] - self.knots[i];
        (&self.pieces[i], (t - self.knots[i]) / h, h)
    }

    fn value(&self, t: f64) -> [f64; N] {
        let (cubic, u, _) = self.piece(t);
        at(cubic, u)
    }

    /// The stretch of a piece between two times, as a curve of its own.
    fn stretch(&self, from: f64, to: f64) -> (Cubic<N>, f64) {
        let (cubic, u, h) = self.piece(0.5 * (from + to));
        let (u0, u1) = (u - 0.5 * (to - from) / h, u + 0.5 * (to - from) / h);
        let blossom = |a, b, c| {
            let ab = |i: usize, w: f64| mix(cubic[i], cubic[i + 1], w);
            let twice = |i: usize| mix(ab(i, a), ab(i + 1, a), b);
            mix(twice(0), twice(1), c)
        };
        let stretch = [blossom(u0, u0, u0), blossom(u0, u0, u1), blossom(u0, u1, u1), blossom(u1, u1, u1)];
        (stretch, to - from)
    }

    fn rates_of(&self, from: f64, to: f64) -> (Rates, Cubic<N>) {
        let (b, h) = self.stretch(from, to);
        let first: [[f64; N]; 3] = std::array::from_fn(|i| minus(b[i + 1], b[i]));
        let second: [[f64; N]; 2] = std::array::from_fn(|i| minus(first[i + 1], first[i]));
        let speed = 3.0 / h * first.iter().map(length).fold(0.0, f64::max);
        let acceleration = 6.0 / (h * h) * second.iter().map(length).fold(0.0, f64::max);
        (Rates { speed, acceleration }, b)
    }
}

/// A track's way after a key.
pub(super) fn cubic<const N: usize>(track: &Track, key: usize) -> Cubic<N> {
    let h = track.time(key + 1) - track.time(key);
    let points: [[f64; 4]; N] = std::array::from_fn(|c| {
        let (a, b) = (track.number(key, c), track.number(key + 1, c));
        let steady = (b - a) / h;
        let (out, into) = track.tangents(key, c).unwrap_or((steady, steady));
        [a, a + out * h / 3.0, b - into * h / 3.0, b]
    });
    std::array::from_fn(|i| points.map(|of_one| of_one[i]))
}

/// A Bézier curve's value.
pub(super) fn at<const N: usize>(b: &Cubic<N>, u: f64) -> [f64; N] {
    let v = 1.0 - u;
    let weights = [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u];
    std::array::from_fn(|c| (0..4).map(|i| weights[i] * b[i][c]).sum())
}

fn mix<const N: usize>(a: [f64; N], b: [f64; N], u: f64) -> [f64; N] {
    std::array::from_fn(|i| a[i] + u * (b[i] - a[i]))
}

fn minus<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(super) fn length<const N: usize>(v: &[f64; N]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The least length on a curve: all of it lies beyond the nearest of its control points
/// along the direction of its middle.
pub(super) fn least_length(b: &Cubic<4>) -> f64 {
    let middle = at(b, 0.5);
    let along = |p: &[f64; 4]| (0..4).map(|i| p[i] * middle[i]).sum::<f64>() / length(&middle);
    b.iter().map(along).fold(f64::INFINITY, f64::min).max(0.0)
}

impl<const N: usize> Curve for Cubics<N> {
    type Value = Numbers<N>;

    fn at(&self, t: f64) -> Numbers<N> {
        Numbers(self.value(t))
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn corners(&self) -> &[f64] {
        &[]
    }

    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        Some(self.rates_of(from, to).0)
    }
}

/// Rotations by CUBICSPLINE: Hermite's cubic, normalised.
pub(super) struct Normalised(pub(super) Cubics<4>);

impl Curve for Normalised {
    type Value = Quat;

    fn at(&self, t: f64) -> Quat {
        unit(self.0.value(t))
    }

    fn knots(&self) -> &[f64] {
        &self.0.knots
    }

    fn corners(&self) -> &[f64] {
        &[]
    }

    /// Of n = c/r with r = |c|: ṅ is c's part across n over r, so at most |ċ|/r, and what
    /// turns it is c̈'s part across over r less 2ṙṅ/r, at most |c̈|/r + 2|ċ|²/r².
    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        let (rates, stretch) = self.0.rates_of(from, to);
        let speed = rates.speed / least_length(&stretch);
        let acceleration = rates.acceleration / least_length(&stretch) + 2.0 * speed * speed;
        Some(Rates { speed, acceleration })
    }
}

/// Rotations by LINEAR: slerp from key to key.
pub(super) struct Slerps {
    knots: Vec<f64>,
    keys: Vec<[f64; 4]>,
}

impl Slerps {
    /// The curve through a track's rotations.
    pub(super) fn new(track: &Track) -> Slerps {
        let keys = (0..track.times.len()).map(|k| track.quat(k)).collect();
        Slerps { knots: track.times.iter().map(|&t| f64::from(t)).collect(), keys }
    }

    fn piece(&self, t: f64) -> usize {
        let after = self.knots.partition_point(|&knot| knot <= t);
        after.saturating_sub(1).min(self.keys.len() - 2)
    }
}

impl Curve for Slerps {
    type Value = Quat;

    fn at(&self, t: f64) -> Quat {
        let i = self.piece(t);
        let u = (t - self.knots[i]) / (self.knots[i + 1] - self.knots[i]);
        unit(slerp(self.keys[i], self.keys[i + 1], u))
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }

    fn corners(&self) -> &[f64] {
        &[]
    }

    fn rates(&self, from: f64, to: f64) -> Option<Rates> {
        let i = self.piece(0.5 * (from + to));
        let h = self.knots[i + 1] - self.knots[i];
        Some(slerp_rates(self.keys[i], self.keys[i + 1]).per_second(h))
    }
}

/// Rates of the direction of slerp between two quaternions, by its parameter.
///
/// With lengths l and m and φ between them the blend c has r²·speed = l m φ all the way;
/// for lengths alike the speed is φ. Otherwise it changes by 2 l m φ (c·ċ) / r⁴, where r
/// is at least the shorter length, and c·ċ at most π (m−l) times the longer: c is slerp
/// of length l, and (m−l) sin uφ / sin φ along b.
pub(super) fn slerp_rates(a: [f64; 4], b: [f64; 4]) -> Rates {
    let turn = unit(a).angle_to(unit(b)) * 0.5;
    let (l, m) = (length(&a), length(&b));
    let (short, long) = (l.min(m), l.max(m));
    let speed = long / short * turn;
    let uneven = (long - short) * std::f64::consts::PI * long;
    Rates { speed, acceleration: 2.0 * long * turn * uneven / short.powi(3) }
}

/// The unit quaternion of a file's x y z w.
pub(super) fn unit(q: [f64; 4]) -> Quat {
    let scale = 1.0 / length(&q);
    Quat::from_xyzw(q.map(|x| x * scale))
}

/// The number of a Hermite cubic at u and its derivative by time.
pub(super) fn hermite(a: f64, out: f64, into: f64, b: f64, u: f64, h: f64) -> (f64, f64) {
    let points = [[a], [a + out * h / 3.0], [b - into * h / 3.0], [b]];
    let slopes: [f64; 3] = std::array::from_fn(|i| 3.0 / h * (points[i + 1][0] - points[i][0]));
    let v = 1.0 - u;
    (at(&points, u)[0], v * v * slopes[0] + 2.0 * u * v * slopes[1] + u * u * slopes[2])
}

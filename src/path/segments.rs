//! Points to one Bézier curve a segment.

use super::bezier::Bezier;
use super::knots::{self, COINCIDENT, Spacing};
use super::{Error, Kind, PathEnds};
use glam::DVec3;

/// How near the last point is to the first, as a fraction of the path's extent, to be it.
const SEAM: f64 = 1e-6;

/// The curves of a path and the steps of time that belong to them.
pub(super) struct Segments {
    /// Positions where segments meet, first and last included.
    pub(super) keys: Vec<DVec3>,
    /// The time from each key to the next, in any unit.
    pub(super) steps: Vec<f64>,
    /// The curve from each key to the next; None where coinciding keys take no time.
    pub(super) curves: Vec<Option<Bezier>>,
}

/// Refuses a number of points of which the kind makes no curve.
pub(super) fn check_count(kind: Kind, found: usize) -> Result<(), Error> {
    match kind {
        Kind::BezierDegree(degree) if !(1..=Kind::HIGHEST_DEGREE).contains(&degree) => {
            Err(Error::Degree { degree })
        }
        _ if found < 2 => Err(Error::TooFew { found }),
        Kind::Bezier if found < 4 || found % 3 != 1 => Err(Error::CubicCount { found }),
        Kind::BezierDegree(degree) if found != degree + 1 => Err(Error::DegreeCount { degree, found }),
        _ => Ok(()),
    }
}

/// Which of `count` points are key points.
pub(super) fn key_indices(kind: Kind, count: usize) -> Vec<usize> {
    match kind {
        Kind::Bezier => (0..count).step_by(3).collect(),
        Kind::BezierDegree(_) => vec![0, count - 1],
        _ => (0..count).collect(),
    }
}

/// The segments through points whose largest coordinate is about 1.
pub(super) fn segments(
    kind: Kind,
    points: &[DVec3],
    times: Option<&[f64]>,
    spacing: Spacing,
    ends: PathEnds,
) -> Result<Segments, Error> {
    let mut points = points.to_vec();
    let added = ends == PathEnds::Closed && !close(&mut points);
    let mut keys: Vec<DVec3> = key_indices(kind, points.len()).into_iter().map(|i| points[i]).collect();
    if added {
        if spacing == Spacing::Times {
            return Err(Error::ClosingTime);
        }
        keys.push(points[0]);
    }
    let steps = knots::steps(spacing, &keys, times);
    let curves = if kind.is_bezier() {
        beziers(kind, &points, added, &steps)?
    } else if kind == Kind::Polyline {
        keys.windows(2).zip(&steps).map(|(p, &h)| (h > 0.0).then(|| Bezier::new(p.to_vec()))).collect()
    } else {
        catmull_rom(&keys, &steps, ends)
    };
    Ok(Segments { keys, steps, curves })
}

/// Whether the last point is the first one again, to which it is then made equal.
fn close(points: &mut [DVec3]) -> bool {
    let (low, high) = points.iter().fold((points[0], points[0]), |(l, h), p| (l.min(*p), h.max(*p)));
    let last = points.len() - 1;
    let closes = points[0].distance(points[last]) <= SEAM * low.distance(high);
    if closes {
        points[last] = points[0];
    }
    closes
}

fn beziers(kind: Kind, points: &[DVec3], closing: bool, steps: &[f64]) -> Result<Vec<Option<Bezier>>, Error> {
    let mut curves: Vec<Bezier> = match kind {
        Kind::Bezier => {
            (0..points.len() / 3).map(|i| Bezier::new(points[3 * i..3 * i + 4].to_vec())).collect()
        }
        _ => vec![Bezier::new(points.to_vec())],
    };
    if closing {
        curves.push(closing_cubic(&curves[0], &curves[curves.len() - 1]));
    }
    let lost = |(curve, &h): (&Bezier, &f64)| h == 0.0 && curve.fastest() > COINCIDENT;
    if let Some(segment) = curves.iter().zip(steps).position(lost) {
        return Err(Error::NoChord { segment });
    }
    Ok(curves.into_iter().zip(steps).map(|(curve, &h)| (h > 0.0).then_some(curve)).collect())
}

/// The cubic that leaves as the last curve arrives and arrives as the first leaves.
fn closing_cubic(first: &Bezier, last: &Bezier) -> Bezier {
    Bezier::hermite(last.at(1.0), last.derivative(1.0), first.derivative(0.0), first.at(0.0))
}

/// Cubics through `keys` with the knots' distances `steps`: at a key the derivative by
/// the knots is (h₊v₋ + h₋v₊)/(h₋ + h₊), with v = chord / h on either side.
/// Source: Barry and Goldman 1988, whose pyramid gives the same cubic.
fn catmull_rom(keys: &[DVec3], steps: &[f64], ends: PathEnds) -> Vec<Option<Bezier>> {
    let live: Vec<usize> = (0..steps.len()).filter(|&i| steps[i] > 0.0).collect();
    let h: Vec<f64> = live.iter().map(|&i| steps[i]).collect();
    let v: Vec<DVec3> = live.iter().map(|&i| (keys[i + 1] - keys[i]) / steps[i]).collect();
    let m = tangents(&v, &h, ends);
    let mut curves = vec![None; steps.len()];
    for (j, &i) in live.iter().enumerate() {
        curves[i] = Some(Bezier::hermite(keys[i], m[j] * h[j], m[j + 1] * h[j], keys[i + 1]));
    }
    curves
}

/// The derivative at each key, from the chords' velocities v and the steps h.
fn tangents(v: &[DVec3], h: &[f64], ends: PathEnds) -> Vec<DVec3> {
    let n = v.len();
    let blend = |a: usize, b: usize| v[a].lerp(v[b], h[a] / (h[a] + h[b]));
    let inner: Vec<DVec3> = (1..n).map(|i| blend(i - 1, i)).collect();
    // Without acceleration at the end: the cubic's c₀ − 2c₁ + c₂ = 0.
    let natural = |chord: DVec3, next: Option<&DVec3>| next.map_or(chord, |m| 1.5 * chord - 0.5 * *m);
    let (first, last) = match ends {
        PathEnds::Natural => (natural(v[0], inner.first()), natural(v[n - 1], inner.last())),
        PathEnds::Clamped => (DVec3::ZERO, DVec3::ZERO),
        PathEnds::Repeat => (0.5 * v[0], 0.5 * v[n - 1]),
        PathEnds::Closed => (blend(n - 1, 0), blend(n - 1, 0)),
    };
    [first].into_iter().chain(inner).chain([last]).collect()
}

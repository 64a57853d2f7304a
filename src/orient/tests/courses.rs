//! Small courses with every property that orientation must live with.

use super::super::Course;
use crate::math::{Jet, Scalar, Vec3};
use glam::DVec3;
use std::f64::consts::TAU;

pub(super) type Point = Vec3<Jet>;

/// A course given by a formula of time; derivatives come with it.
pub(super) struct Smooth<F> {
    keys: Vec<f64>,
    corners: Vec<f64>,
    closed: bool,
    formula: F,
}

impl<F: Fn(Jet) -> Point + Sync> Smooth<F> {
    /// Over a duration in even segments.
    pub(super) fn new(duration: f64, segments: usize, formula: F) -> Self {
        let keys = (0..=segments).map(|i| duration * (i as f64 / segments as f64)).collect();
        Smooth { keys, corners: Vec::new(), closed: false, formula }
    }

    /// A course of one key that takes no time.
    fn moment(self) -> Self {
        Smooth { keys: vec![0.0], ..self }
    }

    pub(super) fn closed(self) -> Self {
        Smooth { closed: true, ..self }
    }

    pub(super) fn with_corners(self, corners: &[f64]) -> Self {
        Smooth { corners: corners.to_vec(), ..self }
    }

    fn part(&self, t: f64, part: impl Fn(Jet) -> f64) -> DVec3 {
        let p = (self.formula)(Jet::variable(t));
        DVec3::new(part(p.x), part(p.y), part(p.z))
    }
}

impl<F: Fn(Jet) -> Point + Sync> Course for Smooth<F> {
    fn duration(&self) -> f64 {
        self.keys[self.keys.len() - 1]
    }

    fn key_times(&self) -> &[f64] {
        &self.keys
    }

    fn is_closed(&self) -> bool {
        self.closed
    }

    fn position(&self, t: f64) -> DVec3 {
        self.part(t, |j| j.value)
    }

    fn velocity(&self, t: f64) -> DVec3 {
        self.part(t, |j| j.first)
    }

    fn acceleration(&self, t: f64) -> DVec3 {
        self.part(t, |j| j.second)
    }

    /// At rest: along the acceleration away from it, before the end against it.
    fn direction(&self, t: f64) -> Option<DVec3> {
        let sign = if t >= self.duration() { -1.0 } else { 1.0 };
        let moving = Some(self.velocity(t)).filter(|v| v.length() > 1e-13);
        moving.or(Some(sign * self.acceleration(t))).and_then(DVec3::try_normalize)
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }
}

/// Straight from point to point, a second each.
pub(super) struct Polyline {
    points: Vec<DVec3>,
    keys: Vec<f64>,
    corners: Vec<f64>,
}

impl Polyline {
    pub(super) fn new(points: &[[f64; 3]]) -> Self {
        let points: Vec<DVec3> = points.iter().copied().map(DVec3::from_array).collect();
        let keys = (0..points.len()).map(|i| i as f64).collect();
        let mut course = Polyline { points, keys, corners: Vec::new() };
        let jumps = |i: &usize| {
            let (before, after) = (course.direction(*i as f64 - 0.5), course.direction(*i as f64 + 0.5));
            before != after
        };
        course.corners = (1..course.points.len() - 1).filter(jumps).map(|i| i as f64).collect();
        course
    }

    /// The same, which does not tell where it turns.
    fn secretive(self) -> Self {
        Polyline { corners: Vec::new(), ..self }
    }

    fn chord(&self, i: usize) -> DVec3 {
        self.points[i + 1] - self.points[i]
    }

    fn segment(&self, t: f64) -> usize {
        (t.max(0.0) as usize).min(self.points.len() - 2)
    }
}

impl Course for Polyline {
    fn duration(&self) -> f64 {
        self.keys[self.keys.len() - 1]
    }

    fn key_times(&self) -> &[f64] {
        &self.keys
    }

    fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }

    fn position(&self, t: f64) -> DVec3 {
        let i = self.segment(t);
        self.points[i] + self.chord(i) * (t - i as f64)
    }

    fn velocity(&self, t: f64) -> DVec3 {
        self.chord(self.segment(t))
    }

    fn acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }

    fn direction(&self, t: f64) -> Option<DVec3> {
        let before = (0..=self.segment(t)).rev().find_map(|i| self.chord(i).try_normalize());
        before.or_else(|| (0..self.points.len() - 1).find_map(|i| self.chord(i).try_normalize()))
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }
}

pub(super) fn number(x: f64) -> Jet {
    Jet::constant(x)
}

/// A helix of radius 2 about the y axis, `rise` a radian, at a radian a second.
pub(super) fn helix(turns: f64, rise: f64) -> impl Course {
    Smooth::new(turns * TAU, 4, move |t: Jet| {
        let (sin, cos) = t.sin_cos();
        Vec3::new(cos * number(2.0), t * number(rise), sin * number(2.0))
    })
}

/// Round a level circle of radius 3 in `duration` seconds, to the left (+Z to +X).
pub(super) fn circle(duration: f64) -> Smooth<impl Fn(Jet) -> Point + Sync> {
    Smooth::new(duration, 5, move |t: Jet| {
        let (sin, cos) = (t * number(TAU / duration)).sin_cos();
        Vec3::new((number(1.0) - cos) * number(3.0), number(0.0), sin * number(3.0))
    })
}

/// A loop-the-loop in four seconds, in the plane of y and z, with `drift` to the side
/// in all.
pub(super) fn looping(drift: f64) -> impl Course {
    Smooth::new(4.0, 4, move |t: Jet| {
        let (sin, cos) = (t * number(TAU / 4.0)).sin_cos();
        Vec3::new(t * number(drift / 4.0), (number(1.0) - cos) * number(3.0), sin * number(3.0))
    })
}

/// A closed curve that leaves every plane, and whose up would come back twisted.
pub(super) fn knot() -> Smooth<impl Fn(Jet) -> Point + Sync> {
    Smooth::new(6.0, 7, |t: Jet| {
        let angle = t * number(TAU / 6.0);
        let ((s2, c2), (s3, c3)) = ((angle * number(2.0)).sin_cos(), (angle * number(3.0)).sin_cos());
        let radius = c3 + number(2.5);
        Vec3::new(radius * c2, s3, radius * s2)
    })
    .closed()
}

/// From level flight along +Z down a quarter circle, then straight down.
pub(super) fn sinking() -> impl Course {
    Dive
}

/// A quarter of a circle in the first two seconds, then straight on; speed 2.
struct Dive;

impl Dive {
    const KEYS: [f64; 5] = [0.0, 1.0, 2.0, 3.0, 4.0];
    fn angle(t: f64) -> f64 {
        (t / 2.0).min(1.0) * TAU / 4.0
    }
}

impl Course for Dive {
    fn duration(&self) -> f64 {
        4.0
    }

    fn key_times(&self) -> &[f64] {
        &Self::KEYS
    }

    fn is_closed(&self) -> bool {
        false
    }

    fn position(&self, t: f64) -> DVec3 {
        let (sin, cos) = Dive::angle(t).sin_cos();
        let radius = 16.0 / TAU;
        DVec3::new(1.0, radius * (cos - 1.0) - 2.0 * (t - 2.0).max(0.0), radius * sin)
    }

    fn velocity(&self, t: f64) -> DVec3 {
        let (sin, cos) = Dive::angle(t).sin_cos();
        DVec3::new(0.0, -sin, cos) * 2.0
    }

    fn acceleration(&self, t: f64) -> DVec3 {
        let (sin, cos) = Dive::angle(t).sin_cos();
        let rate = if t < 2.0 { TAU / 8.0 } else { 0.0 };
        DVec3::new(0.0, -cos, -sin) * (2.0 * rate)
    }

    fn direction(&self, t: f64) -> Option<DVec3> {
        Some(self.velocity(t) * 0.5)
    }

    fn corners(&self) -> &[f64] {
        &[]
    }
}

/// Cubic smoothstep along a line: from rest to rest.
fn eased(direction: [f64; 3]) -> impl Course {
    Smooth::new(2.0, 2, move |t: Jet| {
        let u = t * number(0.5);
        let s = u * u * (number(3.0) - number(2.0) * u);
        Vec3::new(s * number(direction[0]), s * number(direction[1]), s * number(direction[2]))
    })
}

/// All of them, by name.
pub(super) fn all() -> Vec<(&'static str, Box<dyn Course>)> {
    let swing = |t: Jet| Vec3::new((t * number(2.0)).sin_cos().1, number(0.0), number(1.0));
    let reversals: [f64; 2] = [TAU / 4.0, TAU / 2.0];
    let cusp = |t: Jet| {
        let s = t - number(1.0);
        Vec3::new(s * s, s * s * s, s * s * s * s)
    };
    let far = |t: Jet| {
        let (sin, cos) = t.sin_cos();
        Vec3::new(cos + number(1e6), t * number(0.3), sin - number(1e6))
    };
    vec![
        ("line", Box::new(Polyline::new(&[[0.0; 3], [1.0, 2.0, 3.0]])) as Box<dyn Course>),
        ("zigzag", Box::new(Polyline::new(&[[0.0; 3], [1.0, 0.0, 1.0], [0.0, 1.0, 2.0], [3.0, 0.5, 2.0]]))),
        ("reversal", Box::new(Polyline::new(&[[0.0; 3], [0.0, 0.0, 2.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0]]))),
        ("upside down", Box::new(Polyline::new(&[[0.0; 3], [0.0, 3.0, 0.0], [0.0; 3]]))),
        ("tower", Box::new(Polyline::new(&[[0.0; 3], [0.0, 0.0, 2.0], [0.0, 2.0, 2.0], [3.0, 2.0, 2.0]]))),
        (
            "tower, corners unknown",
            Box::new(
                Polyline::new(&[[0.0; 3], [0.0, 0.0, 2.0], [0.0, 2.0, 2.0], [3.0, 2.0, 2.0]]).secretive(),
            ),
        ),
        ("standing", Box::new(Polyline::new(&[[1.0, 2.0, 3.0]; 4]))),
        (
            "pause",
            Box::new(Polyline::new(&[[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])),
        ),
        ("triangle", Box::new(Polyline::new(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 1.0], [0.0; 3]]))),
        ("vertical", Box::new(eased([0.0, -5.0, 0.0]))),
        ("eased", Box::new(eased([3.0, 1.0, -2.0]))),
        ("swing", Box::new(Smooth::new(4.0, 3, swing).with_corners(&reversals))),
        ("swing, corners unknown", Box::new(Smooth::new(4.0, 3, swing))),
        ("cusp", Box::new(Smooth::new(2.0, 1, cusp).with_corners(&[1.0]))),
        ("moment", Box::new(Smooth::new(1.0, 1, cusp).moment())),
        ("circle", Box::new(circle(5.0).closed())),
        ("helix", Box::new(helix(2.0, 0.7))),
        ("steep helix", Box::new(helix(2.0, 9.0))),
        ("far helix", Box::new(Smooth::new(6.0, 4, far))),
        ("knot", Box::new(knot())),
        ("loop", Box::new(looping(0.0))),
        ("loop with drift", Box::new(looping(1.0))),
        ("sinking", Box::new(sinking())),
    ]
}

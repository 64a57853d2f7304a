//! Where the camera stands: so that the whole motion stays in view.
//!
//! The direction of view is fixed, a three-quarter view from a bit above, with
//! +Z the front and +Y up. What is left is the camera's place, and that has a
//! closed form. In the camera's axes a point (x, y, z) is in view of an eye at
//! (cx, cy, cz) when |x − cx| ≤ (cz − z)·tan and likewise for y. Each edge of
//! the picture is thus one linear bound, e.g. cz·tan + cx ≥ max(x + z·tan), and
//! the nearest eye that fulfils all four is found from four maxima. Where that
//! leaves room to move sideways or up, the eye stands where what it sees is in
//! the middle of the picture, which the outline of the points tells.

use super::frame::{Frame, Lens};
use glam::{DMat3, DVec3};

/// From the middle of the motion to the eye.
const TOWARDS_EYE: DVec3 = DVec3::new(0.62, 0.42, 1.0);
/// Half the field of view of the picture's shorter side: tan 15°.
const TAN: f64 = 0.267_949_192_431_122_7;
/// How much of each half of the picture the motion may fill.
const FILL: f64 = 0.9;

/// What the points of a motion demand of the camera. Made in any order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Framing {
    turn: DMat3,
    tan: (f64, f64),
    /// Largest x + z·tan, −x + z·tan, y + z·tan, −y + z·tan.
    edges: [f64; 4],
    low: DVec3,
    high: DVec3,
    /// As seen from above (x, z) and from the side (y, z).
    outlines: [Outline; 2],
}

impl Framing {
    /// For a picture of this many pixels.
    pub(crate) fn new(size: (u32, u32)) -> Self {
        let (width, height) = (f64::from(size.0.max(1)), f64::from(size.1.max(1)));
        let shorter = width.min(height);
        Framing {
            turn: three_quarter_view(),
            tan: (TAN * width / shorter, TAN * height / shorter),
            edges: [f64::NEG_INFINITY; 4],
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
            outlines: [Outline::default(); 2],
        }
    }

    /// Takes one more point of the world in; ignores it when it is not finite.
    pub(crate) fn add(&mut self, point: DVec3) {
        let p = self.turn * point;
        if !p.is_finite() {
            return;
        }
        let (across, up) = (p.z * self.tan.0 * FILL, p.z * self.tan.1 * FILL);
        let bounds = [p.x + across, across - p.x, p.y + up, up - p.y];
        for (edge, bound) in self.edges.iter_mut().zip(bounds) {
            *edge = edge.max(bound);
        }
        self.low = self.low.min(p);
        self.high = self.high.max(p);
        self.outlines[0].add([p.x, p.z]);
        self.outlines[1].add([p.y, p.z]);
    }

    /// The nearest camera that sees all points. Without any it looks at the
    /// origin, so that an empty file gives an empty picture.
    pub(crate) fn frame(mut self) -> Frame {
        if self.low.x > self.high.x {
            self.add(DVec3::ZERO);
        }
        let [right, left, top, bottom] = self.edges;
        let wanted =
            ((right + left) / (2.0 * self.tan.0 * FILL)).max((top + bottom) / (2.0 * self.tan.1 * FILL));
        let least = self.least_distance();
        let depth = wanted.max(self.high.z + least);
        let across = self.outlines[0].middle(depth, bounds(right, left, depth * self.tan.0 * FILL));
        let up = self.outlines[1].middle(depth, bounds(top, bottom, depth * self.tan.1 * FILL));
        Frame {
            turn: self.turn,
            eye: DVec3::new(across, up, depth),
            lens: Lens::Perspective { tan: self.tan, near: (depth - self.high.z) / 2.0, far: None },
            distance: depth - (self.low.z + self.high.z) / 2.0,
        }
    }

    /// Keeps the eye off points that fall together, and far enough from large
    /// coordinates for the distance not to be lost in their rounding.
    fn least_distance(&self) -> f64 {
        let spread = (self.high - self.low).max_element();
        let size = self.low.abs().max(self.high.abs()).max_element();
        match spread.max(size * 1e-9) {
            least if least > f64::MIN_POSITIVE => least,
            _ => 1.0,
        }
    }
}

/// Where between the two bounds of an axis the eye may stand.
fn bounds(upper: f64, lower: f64, reach: f64) -> [f64; 2] {
    [upper - reach, reach - lower]
}

/// The points that lie farthest out in a fan of directions of a plane: enough
/// of its outline to find the middle of what is seen of it.
#[derive(Clone, Copy, Debug)]
struct Outline([Option<[f64; 2]>; 4 * Outline::QUARTER]);

impl Default for Outline {
    fn default() -> Self {
        Outline([None; 4 * Outline::QUARTER])
    }
}

impl Outline {
    /// Directions a quarter turn.
    const QUARTER: usize = 8;

    fn add(&mut self, point: [f64; 2]) {
        for (k, farthest) in self.0.iter_mut().enumerate() {
            let [x, z] = Self::direction(k);
            let out = |p: [f64; 2]| x * p[0] + z * p[1];
            if farthest.is_none_or(|f| out(point) > out(f)) {
                *farthest = Some(point);
            }
        }
    }

    /// On the edge of a diamond, which needs no sines.
    fn direction(k: usize) -> [f64; 2] {
        let (quarter, step) = (k / Self::QUARTER, (k % Self::QUARTER) as f64);
        let (a, b) = (Self::QUARTER as f64 - step, step);
        [[a, b], [-b, a], [-a, -b], [b, -a]][quarter]
    }

    /// Where, within bounds, an eye at this depth sees as much on one side as
    /// on the other; by halving, as that difference falls with the eye's place.
    fn middle(&self, depth: f64, [mut low, mut high]: [f64; 2]) -> f64 {
        let points = || self.0.iter().flatten();
        let sides = |eye: f64| {
            let slope = |p: &[f64; 2]| (p[0] - eye) / (depth - p[1]);
            let most = points().map(slope).fold(f64::NEG_INFINITY, f64::max);
            let least = points().map(slope).fold(f64::INFINITY, f64::min);
            most + least
        };
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            match sides(middle) > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        (low + high) / 2.0
    }
}

/// Only divisions and square roots, so that every machine gets the same.
fn three_quarter_view() -> DMat3 {
    let towards = TOWARDS_EYE.normalize();
    let right = DVec3::Y.cross(towards).normalize();
    DMat3::from_cols(right, towards.cross(right), towards).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;

    /// Where a point falls: x and y from −1 to 1 across the picture, depth.
    fn project(frame: &Frame, point: DVec3) -> DVec3 {
        frame.clip(DMat4::IDENTITY).project_point3(point)
    }

    fn framed(points: &[DVec3], size: (u32, u32)) -> Frame {
        let mut framing = Framing::new(size);
        points.iter().for_each(|p| framing.add(*p));
        framing.frame()
    }

    fn cloud(scale: f64, offset: f64) -> Vec<DVec3> {
        let coordinate = |i: usize, k: usize| ((i * k % 101) as f64 / 50.0 - 1.0) * scale;
        (0..200)
            .map(|i| DVec3::new(coordinate(i, 37), coordinate(i, 53), coordinate(i, 71)) + offset)
            .collect()
    }

    #[test]
    fn all_points_fill_the_view_and_stay_inside() {
        for size in [(512, 512), (640, 360), (90, 400), (1, 1)] {
            for (scale, offset) in [(1.0, 0.0), (1e-12, 0.0), (1e12, 0.0), (1e9, 1e12), (3.0, -700.0)] {
                let points = cloud(scale, offset);
                let frame = framed(&points, size);
                let seen: Vec<DVec3> = points.iter().map(|p| project(&frame, *p)).collect();
                let most = seen.iter().map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
                assert!((most - FILL).abs() < 1e-3, "{size:?} {scale} {offset}: {most}");
                assert!(seen.iter().all(|p| p.z > 0.0 && p.z <= 1.0), "{size:?} {scale}");
            }
        }
    }

    #[test]
    fn what_is_flat_and_wide_is_seen_in_the_middle() {
        let at = |i: usize, k: usize| (i * k % 101) as f64 / 50.0 - 1.0;
        for (size, wide) in [((512, 512), DVec3::new(9.0, 0.2, 7.0)), ((90, 400), DVec3::new(1.0, 1.0, 9.0))]
        {
            let points: Vec<DVec3> =
                (0..400).map(|i| wide * DVec3::new(at(i, 37), at(i, 53), at(i, 71))).collect();
            let frame = framed(&points, size);
            let seen: Vec<DVec3> = points.iter().map(|p| project(&frame, *p)).collect();
            let (low, high) =
                seen.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
            // The outline's fan leaves out a sliver: 2 % of half a picture.
            assert!((low.x + high.x).abs() < 0.02 && (low.y + high.y).abs() < 0.02, "{size:?}: {low} {high}");
        }
    }

    #[test]
    fn nothing_and_a_single_point_have_a_camera() {
        for points in [vec![], vec![DVec3::ZERO], vec![DVec3::splat(1e12)], vec![DVec3::splat(1e-300)]] {
            let frame = framed(&points, (512, 512));
            let target = points.first().copied().unwrap_or_default();
            let seen = project(&frame, target);
            assert!(seen.is_finite() && seen.xy_length() < 1e-3, "{points:?}: {seen}");
            assert!(seen.z > 0.0 && seen.z <= 1.0);
        }
    }

    #[test]
    fn points_that_are_not_finite_do_not_count() {
        let whole = framed(&cloud(1.0, 0.0), (512, 512));
        let mut points = cloud(1.0, 0.0);
        points.push(DVec3::new(f64::NAN, 0.0, 0.0));
        points.push(DVec3::new(0.0, f64::INFINITY, 0.0));
        assert_eq!(framed(&points, (512, 512)).eye, whole.eye);
    }

    #[test]
    fn front_is_nearest_right_is_right_and_up_is_up() {
        let frame = framed(&cloud(1.0, 0.0), (512, 512));
        let at = |x, y, z| project(&frame, DVec3::new(x, y, z));
        assert!(at(0.0, 0.0, 1.0).z > at(0.0, 0.0, -1.0).z);
        assert!(at(1.0, 0.0, 0.0).x > at(-1.0, 0.0, 0.0).x);
        assert!(at(0.0, 1.0, 0.0).y > at(0.0, -1.0, 0.0).y);
        assert_eq!((frame.turn * DVec3::Y).x, 0.0);
    }

    trait XyLength {
        fn xy_length(self) -> f64;
    }
    impl XyLength for DVec3 {
        fn xy_length(self) -> f64 {
            self.truncate().length()
        }
    }
}

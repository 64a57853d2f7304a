//! A path from three sides and aslant, its colours running with time.

use super::figure::{self, Axis, Dot, Entry, Figure, Layer, Panel, Sign};
use super::series::knots;
use super::style::{Ink, Stroke};
use super::{Error, Line, Point, Subject};
use crate::orient::Frame;
use glam::DVec3;

/// In how many colours the path is drawn.
const COLOURS: usize = 64;

/// At how many places it is looked at in all, about; never fewer than its key points.
const PLACES: usize = 8000;

/// The polygon of control points.
const POLYGON: Stroke = Stroke::solid(Ink::Quiet, 1.2).dashed("5 4");

/// Of the whole extent, the least that a view shows.
const LEAST: f64 = 0.35;

/// Of the whole extent, the least share of the page that a view gets: the oblique one
/// stands below the second and beside the third.
const CELL: f64 = 0.6;

/// How a frame's axes are drawn: two level ones and one upright.
struct Drawn {
    names: [&'static str; 3],
    /// Level, level, up; from a vector of the frame.
    of: fn(DVec3) -> DVec3,
    /// Whether the second level axis leads to who looks along it at the first going right.
    towards: f64,
}

fn drawn(frame: Frame) -> Drawn {
    match frame {
        Frame::Gltf => Drawn { names: ["x", "z", "y"], of: |v| DVec3::new(v.x, v.z, v.y), towards: 1.0 },
        Frame::Frd => Drawn { names: ["x", "y", "−z"], of: |v| DVec3::new(v.x, v.y, -v.z), towards: 1.0 },
        Frame::Flu => Drawn { names: ["x", "y", "z"], of: |v| v, towards: -1.0 },
    }
}

/// What is drawn of a path: level, level, up.
struct Shape {
    /// Places with their times as shares of the whole.
    way: Vec<(f64, DVec3)>,
    controls: Vec<DVec3>,
    keys: Vec<DVec3>,
}

impl Shape {
    fn range(&self, of: impl Fn(DVec3) -> f64) -> [f64; 2] {
        let places = self.way.iter().map(|(_, place)| *place).chain(self.controls.iter().copied());
        figure::extent(places.map(of)).unwrap_or([0.0, 1.0])
    }

    /// The largest extent; of a path that is one point, but for rounding, a unit around it.
    fn whole(&self) -> f64 {
        let ranges = [0, 1, 2].map(|i| self.range(|place| place[i]));
        let extent = ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let farthest = ranges.iter().flatten().fold(0.0, |far: f64, end| far.max(end.abs()));
        if extent > 1e-12 * farthest { extent } else { 1.0 }
    }

    /// As seen by a view that makes places of it: polygon, way in its colours, points.
    fn layers(&self, see: impl Fn(DVec3) -> Point) -> Vec<Layer> {
        let mut layers = Vec::new();
        let controls = |points: &[DVec3]| points.iter().map(|&p| see(p)).collect::<Vec<_>>();
        layers.push(Layer::Trace(vec![controls(&self.controls)], POLYGON));
        let last = self.way.len() - 1;
        let stretch = last.div_ceil(COLOURS).max(1);
        for start in (0..last).step_by(stretch) {
            let part = &self.way[start..=(start + stretch).min(last)];
            let middle = 0.5 * (part[0].0 + part[part.len() - 1].0);
            let line: Line = vec![part.iter().map(|(_, place)| see(*place)).collect()];
            layers.push(Layer::Trace(line, Stroke::solid(Ink::Time(middle), 2.6)));
        }
        let beside: Vec<DVec3> = self.controls.iter().copied().filter(|p| !self.keys.contains(p)).collect();
        layers.push(Layer::Dots(controls(&beside), Dot::Control));
        layers.push(Layer::Dots(controls(&self.keys), Dot::Key));
        layers
    }
}

/// Four views of the subject's path.
pub(super) fn figure(subject: &Subject) -> Result<Figure, Error> {
    let (path, start) = subject.ground.course().ok_or(Error::NoPath("path"))?;
    let axes = drawn(subject.frame);
    let seen = |place: DVec3| (axes.of)(subject.frame.vector_from_gltf(place));
    let shape = Shape {
        way: times(&knots(path)).map(|t| (t / path.duration(), seen(path.position(t)))).collect(),
        controls: path.control_points().iter().map(|&p| seen(p)).collect(),
        keys: path.key_points().iter().map(|&p| seen(p)).collect(),
    };
    let ranges = [0, 1, 2].map(|i| shape.range(|place| place[i]));
    let whole = shape.whole();
    let ranges = ranges.map(|[low, high]| {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low).max(LEAST * whole) + 0.05 * whole);
        [middle - half, middle + half]
    });
    let view = |a: usize, b: usize| {
        let axis = |i: usize| Axis::new(format!("{} (units)", axes.names[i]), ranges[i]);
        let title = format!("{} and {}", axes.names[a], axes.names[b]);
        let layers = shape.layers(|place| [place[a], place[b]]);
        Panel { title, x: axis(a), y: axis(b), equal: true, layers }
    };
    let panels = vec![view(0, 2), view(1, 2), view(0, 1), oblique(&shape, &axes)];
    let share = |i: usize, least: f64| (ranges[i][1] - ranges[i][0]).max(least * whole);
    let legend = vec![
        Entry { label: "key points".to_owned(), sign: Sign::Dot(Dot::Key) },
        Entry { label: "control points".to_owned(), sign: Sign::Dot(Dot::Control) },
        Entry { label: "control polygon".to_owned(), sign: Sign::Line(POLYGON) },
    ];
    let all_are_keys = shape.controls.iter().all(|p| shape.keys.contains(p));
    let legend = legend.into_iter().filter(|e| !(all_are_keys && e.sign == Sign::Dot(Dot::Control)));
    let time = |t: f64| format!("{} s", (t * 1000.0).round() / 1000.0);
    Ok(Figure {
        title: subject.name.to_owned(),
        legend: legend.collect(),
        ramp: Some([time(start), time(start + path.duration())]),
        panels,
        columns: 2,
        shares: [vec![share(0, CELL), share(1, CELL)], vec![share(2, 0.0), share(1, CELL)]],
        cell: [520.0, 430.0],
    })
}

/// Times between knots, with both ends: evenly, and at least one step from each to the next.
fn times(knots: &[f64]) -> impl Iterator<Item = f64> + '_ {
    let duration = knots[knots.len() - 1];
    let steps = move |h: f64| ((h / duration * PLACES as f64).ceil() as usize).max(1);
    let between = knots.windows(2).flat_map(move |pair| {
        let (from, h) = (pair[0], pair[1] - pair[0]);
        let count = steps(h);
        (0..count).map(move |i| from + h * i as f64 / count as f64)
    });
    between.chain([duration])
}

/// The path from in front, from the right and from above, over its shadow on the ground.
fn oblique(shape: &Shape, axes: &Drawn) -> Panel {
    let ([sin, cos], [dip, flat]) = ([0.5, 0.75f64.sqrt()], [0.342, 0.94]);
    let towards = axes.towards;
    let see = move |p: DVec3| {
        let near = towards * p.y;
        let depth = p.x * sin + near * cos;
        [p.x * cos - near * sin, p.z * flat - depth * dip]
    };
    let ranges = [0, 1, 2].map(|i| shape.range(|place| place[i]));
    let corner = |i: usize, j: usize, k: usize| DVec3::new(ranges[0][i], ranges[1][j], ranges[2][k]);
    let grid = Stroke::solid(Ink::Grid, 1.2);
    let edge = |a: DVec3, b: DVec3| Layer::Trace(vec![vec![see(a), see(b)]], grid);
    let mut layers = Vec::new();
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        layers.push(edge(corner(i, j, 0), corner(i, j, 1)));
        layers.push(edge(corner(0, i, j), corner(1, i, j)));
        layers.push(edge(corner(i, 0, j), corner(i, 1, j)));
    }
    let shadow = shape.way.iter().map(|(_, p)| see(DVec3::new(p.x, p.y, ranges[2][0]))).collect();
    layers.push(Layer::Trace(vec![shadow], Stroke::solid(Ink::Quiet, 1.5).faint()));
    layers.extend(shape.layers(see));
    let corners: Vec<Point> = (0..8).map(|n| see(corner(n & 1, n >> 1 & 1, n >> 2))).collect();
    let span = |i: usize| figure::extent(corners.iter().map(|p| p[i])).unwrap_or([0.0, 1.0]);
    let size = shape.whole();
    layers.extend(names(&see, ranges, axes, 0.07 * size));
    let axis = |[low, high]: [f64; 2]| Axis::bare([low - 0.12 * size, high + 0.12 * size]);
    Panel { title: "oblique".to_owned(), x: axis(span(0)), y: axis(span(1)), equal: false, layers }
}

/// The names of the axes beside the nearest lower edges, and beside the left upright one.
fn names(
    see: &impl Fn(DVec3) -> Point,
    ranges: [[f64; 2]; 3],
    axes: &Drawn,
    off: f64,
) -> impl Iterator<Item = Layer> {
    let middle = ranges.map(|[low, high]| 0.5 * (low + high));
    let near = usize::from(axes.towards > 0.0);
    let places = [
        (DVec3::new(middle[0], ranges[1][near], ranges[2][0]), [-0.4 * off, -off]),
        (DVec3::new(ranges[0][1], middle[1], ranges[2][0]), [off, -0.6 * off]),
        (DVec3::new(ranges[0][0], ranges[1][near], middle[2]), [-off, 0.0]),
    ];
    let seen: Vec<_> = places
        .into_iter()
        .zip(axes.names)
        .map(|((p, [x, y]), name)| {
            let at = see(p);
            Layer::Words([at[0] + x, at[1] + y], name.to_owned())
        })
        .collect();
    seen.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_meet_every_knot_and_the_end() {
        let times: Vec<f64> = times(&[0.0, 0.3, 2.0]).collect();
        assert!(times.contains(&0.3) && times[0] == 0.0 && times[times.len() - 1] == 2.0);
        assert!(times.windows(2).all(|pair| pair[1] > pair[0]));
        assert!((PLACES..PLACES + 4).contains(&times.len()), "{}", times.len());
    }

    #[test]
    fn up_is_up_in_every_frame() {
        for frame in Frame::ALL {
            let axes = drawn(frame);
            let seen = |v: DVec3| (axes.of)(frame.vector_from_gltf(v));
            assert_eq!(seen(DVec3::Y).z, 1.0, "{frame:?}");
            // Right-handed as drawn: right, up, to the eye.
            let [right, eye] = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, axes.towards, 0.0)];
            let back = |v: DVec3| {
                [DVec3::X, DVec3::Y, DVec3::Z].into_iter().map(|e| e * seen(e).dot(v)).sum::<DVec3>()
            };
            assert!((back(right).cross(DVec3::Y) - back(eye)).length() < 1e-12, "{frame:?}");
        }
    }
}

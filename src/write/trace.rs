//! A path to look at: the line itself, its control points, the polygon through them.

use super::document::linear;
use super::line::Line;
use super::mesh::{Material, Mesh};
use super::scene::{Node, Scene, Shape};
use glam::{DVec3, Vec3};

/// A path as places.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Times, as shares of the whole, and places on the way; two or more.
    pub line: Vec<(f64, DVec3)>,
    /// The points by which a person shapes it; two or more.
    pub controls: Vec<DVec3>,
}

/// What the colours of a line tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colour {
    /// When the path passes: dark early, light late.
    #[default]
    Time,
    /// How far along Z: dark behind, light in front.
    Depth,
}

impl Colour {
    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Colour::Time => "time",
            Colour::Depth => "depth",
        }
    }

    /// The colours of a name, if there are any.
    pub fn from_name(name: &str) -> Option<Colour> {
        [Colour::Time, Colour::Depth].into_iter().find(|colour| colour.name() == name)
    }
}

/// Of the path's extent, half a marker's.
const MARKER: f64 = 0.008;

const MARKER_COLOUR: Material = Material { name: "control point", colour: [240, 150, 50] };
const POLYGON_COLOUR: [u8; 3] = [150, 150, 150];

impl Scene {
    /// Adds the node `path` with its line; below it `control-polygon` and, as handles,
    /// `control-1` and so on.
    pub fn add_trace(&mut self, trace: &Trace, colour: Colour) {
        let path = self.add_line("path", coloured(&trace.line, colour));
        let grey = POLYGON_COLOUR.map(light);
        let polygon = trace.controls.iter().map(|point| (point.as_vec3(), grey)).collect();
        let polygon = self.add_line("control-polygon", polygon);
        self.tops.push(path);
        let mut below = vec![polygon];
        self.materials.push(MARKER_COLOUR);
        self.meshes.push(marker(self.materials.len() - 1));
        let shape = Some(Shape::Mesh(self.meshes.len() - 1));
        // A path that stands still is marked where the object is, and smaller.
        let scale = (MARKER * extent(trace).max(self.size)) as f32;
        let scale = if scale.is_normal() { scale } else { 1.0 };
        for (i, point) in trace.controls.iter().enumerate() {
            let (name, translation) = (format!("control-{}", i + 1), point.as_vec3());
            below.push(self.add(Node { name, translation, scale, shape, ..Node::default() }));
        }
        self.nodes[path].children = below;
    }

    fn add_line(&mut self, name: &str, points: Vec<(Vec3, [u8; 3])>) -> usize {
        self.lines.push(Line { name: name.to_owned(), points });
        let shape = Some(Shape::Line(self.lines.len() - 1));
        self.add(Node { name: name.to_owned(), shape, ..Node::default() })
    }
}

/// A regular octahedron: its corners lie 1 from its middle.
fn marker(material: usize) -> Mesh {
    let mut mesh = Mesh::new("control-point");
    for x in [Vec3::X, Vec3::NEG_X] {
        for y in [Vec3::Y, Vec3::NEG_Y] {
            for z in [Vec3::Z, Vec3::NEG_Z] {
                let outwards = (x.x * y.y * z.z) > 0.0;
                mesh.face(material, &if outwards { [x, y, z] } else { [x, z, y] });
            }
        }
    }
    mesh
}

fn coloured(line: &[(f64, DVec3)], colour: Colour) -> Vec<(Vec3, [u8; 3])> {
    let depths = || line.iter().map(|(_, place)| place.z);
    let (back, front) = (depths().fold(f64::INFINITY, f64::min), depths().fold(f64::NEG_INFINITY, f64::max));
    let share = |&(time, place): &(f64, DVec3)| match colour {
        Colour::Time => time,
        // All at one depth are in the middle.
        Colour::Depth if front > back => (place.z - back) / (front - back),
        Colour::Depth => 0.5,
    };
    line.iter().map(|point| (point.1.as_vec3(), ramp(share(point)))).collect()
}

/// Colours from dark to light for 0 to 1, as shares of light.
fn ramp(x: f64) -> [u8; 3] {
    helix(x).map(light)
}

/// Colours from dark to light for 0 to 1, as screens show them: Green's cubehelix (Bulletin
/// of the Astronomical Society of India 39, 2011), which grows evenly in brightness, from
/// blue over red to green; its dark and light ends are left out, to be seen before both.
pub(crate) fn helix(x: f64) -> [u8; 3] {
    let lightness = 0.25 + 0.5 * x.clamp(0.0, 1.0);
    let angle = std::f64::consts::TAU * (0.5 / 3.0 + 1.0 - 0.9 * x);
    let amplitude = 0.5 * 1.4 * lightness * (1.0 - lightness);
    let (sin, cos) = libm::sincos(angle);
    let weights = [[-0.14861, 1.78277], [-0.29227, -0.90649], [1.97294, 0.0]];
    let level = |[c, s]: [f64; 2]| (lightness + amplitude * (c * cos + s * sin)).clamp(0.0, 1.0);
    weights.map(|weight| (255.0 * level(weight)).round() as u8)
}

/// A level as screens show it as a share of light, 255 being all.
fn light(level: u8) -> u8 {
    (255.0 * linear(level)).round() as u8
}

/// The largest extent of line and control points along an axis.
fn extent(trace: &Trace) -> f64 {
    let places = || trace.line.iter().map(|(_, place)| *place).chain(trace.controls.iter().copied());
    let low = places().fold(DVec3::INFINITY, DVec3::min);
    let high = places().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - low).max_element()
}

#[cfg(test)]
mod tests {
    use super::super::mesh::tests::{is_closed, volume};
    use super::*;

    #[test]
    fn markers_are_closed_and_face_outwards() {
        let mesh = marker(0);
        assert!(is_closed(&mesh));
        // An octahedron of edge √2 has the volume 4/3.
        assert!((volume(&mesh) - 4.0 / 3.0).abs() < 1e-6);
    }

    /// Relative luminance of shares of light (ITU-R BT.709).
    fn luminance([r, g, b]: [u8; 3]) -> f64 {
        0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
    }

    #[test]
    fn colours_grow_lighter() {
        let steps: Vec<f64> = (0..=10).map(|i| luminance(ramp(f64::from(i) / 10.0))).collect();
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
    }

    #[test]
    fn depth_counts_along_z_and_time_along_the_way() {
        let at = |t: f64, z: f64| (t, DVec3::new(0.0, 0.0, z));
        let line = [at(0.0, 5.0), at(0.5, -5.0), at(1.0, 0.0)];
        let colours = |colour| coloured(&line, colour).into_iter().map(|p| p.1).collect::<Vec<_>>();
        assert_eq!(colours(Colour::Time), [ramp(0.0), ramp(0.5), ramp(1.0)]);
        assert_eq!(colours(Colour::Depth), [ramp(1.0), ramp(0.0), ramp(0.5)]);
        let flat = [at(0.0, 1.0), at(1.0, 1.0)];
        assert_eq!(coloured(&flat, Colour::Depth)[0].1, ramp(0.5));
    }
}

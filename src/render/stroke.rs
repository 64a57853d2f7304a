//! Lines of a width in pixels, as ribbons that face the camera.

use super::frame::Frame;
use super::scene::{Alpha, Material, Part, Vertex};
use glam::{DMat4, DVec3};

/// A line through points of the world.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stroke {
    /// Each with its colour: linear, not premultiplied.
    pub points: Vec<(DVec3, [f32; 4])>,
    /// Pixels in a picture of 512 rows; twice as many in one of four times as many.
    pub width: f64,
}

/// The strokes as a part that stands in the world as it is, for one camera and
/// pictures so many pixels high; `None` where nothing is left to draw.
pub(crate) fn part(strokes: &[Stroke], frame: &Frame, height: u32) -> Option<Part> {
    let mut ribbons = Ribbons::default();
    strokes.iter().for_each(|stroke| ribbons.add(stroke, frame, height));
    ribbons.part()
}

#[derive(Default)]
struct Ribbons {
    corners: Vec<(DVec3, [f32; 4])>,
    indices: Vec<u32>,
}

impl Ribbons {
    /// A pair of corners a point, joined to the pair before.
    fn add(&mut self, stroke: &Stroke, frame: &Frame, height: u32) {
        let mut points = stroke.points.clone();
        points.retain(|(p, _)| p.is_finite());
        points.dedup_by_key(|(p, _)| *p);
        if points.len() < 2 {
            return;
        }
        let wanted = stroke.width * (f64::from(height) / 512.0).sqrt();
        // What is thinner than a pixel would break up: it is fainter instead.
        let (width, share) = (wanted.max(1.0), wanted.min(1.0) as f32);
        for (i, (p, [r, g, b, alpha])) in points.iter().enumerate() {
            let colour = [*r, *g, *b, alpha * share];
            let (before, after) = (points[i.saturating_sub(1)].0, points[(i + 1).min(points.len() - 1)].0);
            let across = (after - before).normalize_or_zero().cross(frame.towards_eye(*p));
            let side = across.normalize_or_zero() * (width / 2.0 * frame.pixel(*p, height));
            if i > 0 {
                let here = self.corners.len() as u32;
                self.indices.extend([here - 2, here - 1, here, here, here - 1, here + 1]);
            }
            self.corners.extend([(*p - side, colour), (*p + side, colour)]);
        }
    }

    /// The ribbons shrunk into the cube from −1 to 1, as parts are.
    fn part(self) -> Option<Part> {
        let places = || self.corners.iter().map(|(p, _)| *p);
        let low = places().reduce(DVec3::min)?;
        let high = places().reduce(DVec3::max)?;
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let scale = Some(half.max_element()).filter(|size| *size > 0.0 && size.is_finite())?;
        let vertex = |(p, colour): &(DVec3, [f32; 4])| Vertex {
            position: ((*p - middle) / scale).as_vec3().to_array(),
            colour: *colour,
            ..Vertex::default()
        };
        Some(Part {
            vertices: self.corners.iter().map(vertex).collect(),
            indices: self.indices,
            material: Material {
                alpha: Alpha::Blend,
                double_sided: true,
                unlit: true,
                ..Material::default()
            },
            placement: DMat4::from_translation(middle) * DMat4::from_scale(DVec3::splat(scale)),
            half_extent: half / scale,
        })
    }
}

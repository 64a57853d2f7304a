//! From the triangles of a scene to triangles on the screen: clipped where
//! they pass the camera, culled, snapped to 1/256 of a pixel.

use super::scene::{Draw, Part, Scene, Texture, Vertex};
use super::shade::{Point, Surface};

/// Steps a pixel is divided into. Whole numbers make the edge functions exact:
/// neighbours agree on every sample of the edge they share.
pub(crate) const SUBPIXELS: i32 = 256;
/// How many pictures wide the region is that triangles may reach into. It
/// bounds the coordinates, so that edge functions fit 64 bits.
const GUARD: f64 = 4.0;

/// A triangle on the screen, clockwise as seen with y down.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// Index into [`Scene::draws`].
    pub draw: u32,
    /// Indices into the part's vertices.
    pub vertices: [u32; 3],
    /// x and y in subpixels, y down.
    pub corners: [[i32; 2]; 3],
    pub depth: [f32; 3],
    pub inverse_w: [f32; 3],
    /// How much of each vertex is in each corner; `None` where the corners
    /// are the vertices.
    pub cut: Option<Box<[[f32; 3]; 3]>>,
    /// −1 when the back is seen, else 1.
    pub facing: f32,
    /// The colour, where it is the same all over.
    pub flat: Option<[f32; 4]>,
}

/// What the triangles of one draw have in common.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub index: u32,
    pub draw: &'a Draw,
    pub part: &'a Part,
    pub surface: Surface<'a>,
    size: (u32, u32),
}

/// A corner on its way through the clip planes.
#[derive(Clone, Copy)]
struct Corner {
    clip: [f32; 4],
    weight: [f32; 3],
}

impl<'a> Placed<'a> {
    pub(crate) fn new(scene: &'a Scene<'a>, index: usize) -> Self {
        let draw = &scene.draws[index];
        let part = scene.part(draw.part);
        let texture: Option<&Texture> = part.material.texture.map(|t| &scene.textures[t]);
        let surface = Surface { material: &part.material, texture, light: &scene.light };
        Placed { index: index as u32, draw, part, surface, size: scene.size }
    }

    /// Adds what is seen of one triangle of the part.
    pub(crate) fn set_up(&self, vertices: [u32; 3], out: &mut Vec<Triangle>) {
        let mut corners = [Corner::default(); 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            corner.clip = self.clip(&self.part.vertices[vertices[k] as usize]);
            corner.weight[k] = 1.0;
        }
        if corners.iter().all(Corner::inside) {
            return out.extend(self.project(vertices, corners, false));
        }
        let polygon = cut(corners);
        for k in 2..polygon.len() {
            let fan = [polygon[0], polygon[k - 1], polygon[k]];
            out.extend(self.project(vertices, fan, true));
        }
    }

    fn clip(&self, vertex: &Vertex) -> [f32; 4] {
        let [x, y, z] = vertex.position;
        let m = &self.draw.clip;
        std::array::from_fn(|i| m[0][i] * x + m[1][i] * y + m[2][i] * z + m[3][i])
    }

    fn project(&self, vertices: [u32; 3], corners: [Corner; 3], cut: bool) -> Option<Triangle> {
        let on_screen = corners.map(|c| c.on_screen(self.size));
        let area = doubled_area(on_screen);
        let front = (area < 0) != self.draw.mirrored;
        if area == 0 || !(front || self.part.material.double_sided) {
            return None;
        }
        let mut triangle = Triangle {
            draw: self.index,
            vertices,
            corners: on_screen,
            depth: corners.map(|c| c.clip[2] / c.clip[3]),
            inverse_w: corners.map(|c| 1.0 / c.clip[3]),
            cut: cut.then(|| Box::new(corners.map(|c| c.weight))),
            facing: if front { 1.0 } else { -1.0 },
            flat: None,
        };
        if area < 0 {
            triangle.turn_round();
        }
        if self.is_flat(&vertices) {
            triangle.flat = Some(self.surface.shade(&self.mix(&vertices, [1.0, 0.0, 0.0]), triangle.facing)?);
        }
        Some(triangle)
    }

    /// Whether all of the triangle has one colour.
    fn is_flat(&self, vertices: &[u32; 3]) -> bool {
        let [a, b, c] = vertices.map(|v| &self.part.vertices[v as usize]);
        let same = |other: &Vertex| other.normal == a.normal && other.colour == a.colour;
        self.surface.texture.is_none() && same(b) && same(c)
    }

    /// The surface where the vertices weigh this much; `uv_beside` stays open.
    pub(crate) fn mix(&self, vertices: &[u32; 3], weight: [f32; 3]) -> Point {
        let mut point = Point::default();
        let mut normal = [0.0; 3];
        for (vertex, weight) in vertices.iter().zip(weight) {
            let vertex = &self.part.vertices[*vertex as usize];
            add(&mut normal, vertex.normal, weight);
            add(&mut point.uv, vertex.uv, weight);
            add(&mut point.colour, vertex.colour, weight);
        }
        let m = &self.draw.normal;
        point.normal =
            std::array::from_fn(|i| m[0][i] * normal[0] + m[1][i] * normal[1] + m[2][i] * normal[2]);
        point
    }

    /// The texture coordinates where the vertices weigh this much.
    pub(crate) fn uv(&self, vertices: &[u32; 3], weight: [f32; 3]) -> [f32; 2] {
        let mut uv = [0.0; 2];
        for (vertex, weight) in vertices.iter().zip(weight) {
            add(&mut uv, self.part.vertices[*vertex as usize].uv, weight);
        }
        uv
    }
}

impl Triangle {
    fn turn_round(&mut self) {
        self.corners.swap(1, 2);
        self.depth.swap(1, 2);
        self.inverse_w.swap(1, 2);
        match &mut self.cut {
            Some(weights) => weights.swap(1, 2),
            None => self.vertices.swap(1, 2),
        }
    }

    /// Pixels, first and one past the last, that the triangle's box touches.
    pub(crate) fn pixels(&self, axis: usize, count: u32) -> std::ops::Range<usize> {
        let at = self.corners.map(|c| c[axis]);
        let low = at[0].min(at[1]).min(at[2]).div_euclid(SUBPIXELS);
        let high = at[0].max(at[1]).max(at[2]).div_euclid(SUBPIXELS) + 1;
        let within = |v: i32| v.clamp(0, count as i32) as usize;
        within(low)..within(high)
    }
}

/// Twice the area in square subpixels, positive when clockwise.
pub(crate) fn doubled_area([a, b, c]: [[i32; 2]; 3]) -> i64 {
    let (bx, by) = (i64::from(b[0] - a[0]), i64::from(b[1] - a[1]));
    let (cx, cy) = (i64::from(c[0] - a[0]), i64::from(c[1] - a[1]));
    bx * cy - by * cx
}

fn add<const N: usize>(sum: &mut [f32; N], value: [f32; N], weight: f32) {
    for (sum, value) in sum.iter_mut().zip(value) {
        *sum += value * weight;
    }
}

impl Default for Corner {
    fn default() -> Self {
        Corner { clip: [0.0; 4], weight: [0.0; 3] }
    }
}

impl Corner {
    /// How far inside the near plane, the far plane and the four sides of the
    /// guarded region; the first two keep w positive.
    fn distances(&self) -> [f64; 6] {
        let [x, y, z, w] = self.clip.map(f64::from);
        let guard = w * GUARD;
        [w - z, z, guard - x, guard + x, guard - y, guard + y]
    }

    /// False for what is not finite, too.
    fn inside(&self) -> bool {
        self.clip[3] > 0.0 && self.distances().iter().all(|d| *d >= 0.0)
    }

    fn on_screen(&self, size: (u32, u32)) -> [i32; 2] {
        let [x, y, _, w] = self.clip;
        let snap = |v: f32| (v * SUBPIXELS as f32 + 0.5).floor() as i32;
        // Where w is next to nothing, what was cut at the guarded region's sides rounds beyond them.
        let [x, y] = [x / w, y / w].map(|v| v.clamp(-GUARD as f32, GUARD as f32));
        [snap((0.5 + 0.5 * x) * size.0 as f32), snap((0.5 - 0.5 * y) * size.1 as f32)]
    }

    /// In double precision, as far ends may lie 10⁹ pictures away.
    fn towards(&self, other: &Corner, share: f64) -> Corner {
        let mix = |a: f32, b: f32| {
            let (a, b) = (f64::from(a), f64::from(b));
            (a + (b - a) * share) as f32
        };
        Corner {
            clip: std::array::from_fn(|i| mix(self.clip[i], other.clip[i])),
            weight: std::array::from_fn(|i| mix(self.weight[i], other.weight[i])),
        }
    }
}

/// What of a triangle lies inside all clip planes (Sutherland and Hodgman
/// 1974): a convex polygon, maybe empty.
fn cut(corners: [Corner; 3]) -> Vec<Corner> {
    let mut polygon = corners.to_vec();
    for plane in 0..6 {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, corner) in polygon.iter().enumerate() {
            let next = &polygon[(k + 1) % polygon.len()];
            let (here, there) = (corner.distances()[plane], next.distances()[plane]);
            if here >= 0.0 {
                kept.push(*corner);
            }
            // Always from the inside out, so that both triangles of a shared
            // edge are cut at the same point.
            if here >= 0.0 && there < 0.0 {
                kept.push(corner.towards(next, here / (here - there)));
            } else if here < 0.0 && there >= 0.0 {
                kept.push(next.towards(corner, there / (there - here)));
            }
        }
        polygon = kept;
    }
    // Rounding may leave a corner a hair outside; what is worse is not finite.
    let sound = |c: &Corner| c.clip[3] > 0.0 && c.clip.iter().all(|v| v.is_finite());
    if polygon.iter().all(sound) { polygon } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_stay_within_the_guarded_region() {
        let limit = |size: u32| (0.5 + 0.5 * GUARD as f32) * size as f32 * SUBPIXELS as f32 + 1.0;
        for w in [1.0, 1e-20, 1e-38, f32::MIN_POSITIVE / 8.0, 0.0] {
            for [x, y] in [[w, -w], [1.0, -1.0], [-1e30, 1e30], [0.0, f32::MAX], [f32::NAN, 0.0]] {
                let corner = Corner { clip: [x, y, 0.0, w], ..Corner::default() };
                let on_screen = corner.on_screen((640, 480));
                for (at, size) in on_screen.into_iter().zip([640, 480]) {
                    assert!((at as f32).abs() <= limit(size), "{x} {y} {w}: {at}");
                }
            }
        }
    }
}

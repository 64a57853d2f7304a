//! The one description of a picture that both renderers draw from.
//!
//! A [`Part`] is a glTF primitive turned into plain triangles; it stays as it
//! is while the clip plays. A [`Scene`] places parts before the camera at one
//! moment. Every fallback of the file format is settled before either exists.

use super::frame::Frame;
use glam::{DMat3, DMat4, DVec3, Vec3};
use std::sync::Arc;

/// A corner of a triangle, in the coordinates of its [`Part`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Vertex {
    /// Within −1..1, whatever the file's unit; see [`Part::placement`].
    pub position: [f32; 3],
    /// Of any length; zero where a triangle has none.
    pub normal: [f32; 3],
    pub uv: [f32; 2],
    /// Linear, not premultiplied; white where the file has none.
    pub colour: [f32; 4],
}

/// Triangles that share a material, shrunk into the cube from −1 to 1, so that
/// single precision serves files in nanometres and in light years alike.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub vertices: Vec<Vertex>,
    /// Three an upright triangle, each below `vertices.len()`.
    pub indices: Vec<u32>,
    pub material: Material,
    /// From −1..1 to the coordinates of the mesh in the file.
    pub placement: DMat4,
    /// Half the extent of the vertices' bounding box, at most 1 a side.
    pub half_extent: DVec3,
}

/// How the surface of a part looks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Material {
    /// Linear, multiplies texture and vertex colour.
    pub colour: [f32; 4],
    /// Index into [`Scene::textures`].
    pub texture: Option<usize>,
    pub alpha: Alpha,
    pub double_sided: bool,
    /// The same under any lamp.
    pub unlit: bool,
}

impl Default for Material {
    fn default() -> Self {
        Material { colour: [1.0; 4], texture: None, alpha: Alpha::Opaque, double_sided: false, unlit: false }
    }
}

/// What the fourth number of a colour means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Alpha {
    /// Nothing.
    Opaque,
    /// Drawn where it is at least this, else left out.
    Mask(f32),
    /// How much hides what lies behind.
    Blend,
}

/// A picture with its ever smaller copies, and how to read it.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    /// Largest first, each half the one before, down to one pixel.
    pub levels: Arc<Vec<Level>>,
    pub wrap: [Wrap; 2],
    /// Takes the nearest pixel instead of mixing four.
    pub nearest: bool,
}

/// One size of a texture.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub width: u32,
    pub height: u32,
    /// Rows from the top; sRGB colours, linear alpha.
    pub pixels: Vec<[u8; 4]>,
}

/// What lies beyond a texture's edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wrap {
    Repeat,
    Mirror,
    Clamp,
}

/// One part before the camera.
#[derive(Clone, Debug)]
pub(crate) struct Draw {
    /// Index into [`Scene::parts`].
    pub part: usize,
    /// Columns; from the part's −1..1 to clip space, depth reversed (1 near).
    pub clip: [[f32; 4]; 4],
    /// Columns; from the part's normals to the camera's axes, any length.
    pub normal: [[f32; 3]; 3],
    /// Front faces run clockwise, as in a mirror.
    pub mirrored: bool,
    /// How far before the camera the part's middle lies.
    pub depth: f64,
}

/// All that a renderer needs for one picture.
#[derive(Debug)]
pub(crate) struct Scene<'a> {
    pub parts: &'a [Part],
    /// Parts of this picture alone, such as lines; counted on from `parts`.
    pub extras: &'a [Part],
    pub textures: &'a [Texture],
    /// In the order of drawing: what lets light through last, farthest first.
    pub draws: Vec<Draw>,
    pub light: Light,
    /// Pixels across and down.
    pub size: (u32, u32),
}

/// The lamps; directions in the camera's axes: right, up, towards the viewer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    /// The world's up, for light from sky and floor.
    pub up: Vec3,
    pub key: Vec3,
    pub fill: Vec3,
    /// From the floor, from the sky, of the key lamp, of the fill lamp.
    pub strength: [f32; 4],
}

impl Light {
    /// A bright lamp above the viewer's left shoulder, a faint one from the
    /// right, and a sky lighter than the floor.
    pub(crate) fn studio(up: Vec3) -> Self {
        Light {
            up,
            key: Vec3::new(-0.4, 0.75, 0.65).normalize(),
            fill: Vec3::new(0.9, 0.1, 0.35).normalize(),
            strength: [0.26, 0.46, 0.58, 0.16],
        }
    }
}

impl<'a> Scene<'a> {
    /// Places parts before a camera. Each item is a part and the way from its
    /// mesh to the world; what is not finite or has no volume left is dropped.
    pub(crate) fn new(
        parts: &'a [Part],
        textures: &'a [Texture],
        placed: impl IntoIterator<Item = (usize, DMat4)>,
        frame: &Frame,
        size: (u32, u32),
    ) -> Self {
        let draws = placed
            .into_iter()
            .filter_map(|(part, world)| Draw::new(part, world * parts[part].placement, frame))
            .collect();
        let light = Light::studio(frame.up());
        let mut scene = Scene { parts, extras: &[], textures, draws, light, size };
        scene.sort();
        scene
    }

    /// The scene with more parts, which stand in the world as they are.
    pub(crate) fn with(mut self, extras: &'a [Part], frame: &Frame) -> Self {
        let first = self.parts.len();
        let placed = extras.iter().enumerate();
        self.draws.extend(placed.filter_map(|(i, part)| Draw::new(first + i, part.placement, frame)));
        self.extras = extras;
        self.sort();
        self
    }

    /// A part by the number that draws have of it.
    pub(crate) fn part(&self, index: usize) -> &'a Part {
        match index.checked_sub(self.parts.len()) {
            Some(extra) => &self.extras[extra],
            None => &self.parts[index],
        }
    }

    /// The material of a draw.
    #[cfg(feature = "render")]
    pub(crate) fn material(&self, draw: &Draw) -> &'a Material {
        &self.part(draw.part).material
    }

    /// Opaque parts keep the file's order; glassy ones follow, far to near by
    /// the distance of their middles, which is right unless they interlock.
    fn sort(&mut self) {
        let (parts, extras) = (self.parts, self.extras);
        let blends = |draw: &Draw| match draw.part.checked_sub(parts.len()) {
            Some(extra) => extras[extra].blends(),
            None => parts[draw.part].blends(),
        };
        self.draws.sort_by(|a, b| match (blends(a), blends(b)) {
            (true, true) => b.depth.total_cmp(&a.depth),
            (a, b) => a.cmp(&b),
        });
    }
}

impl Part {
    pub(crate) fn blends(&self) -> bool {
        self.material.alpha == Alpha::Blend
    }

    /// The corners of the bounding box, in the coordinates of the mesh.
    pub(crate) fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let corner = self.half_extent * DVec3::new(sign(0), sign(1), sign(2));
            self.placement.transform_point3(corner)
        })
    }
}

impl Draw {
    fn new(part: usize, world: DMat4, frame: &Frame) -> Option<Self> {
        let clip = frame.clip(world);
        let turned = frame.turn * DMat3::from_mat4(world);
        let draw = Draw {
            part,
            clip: clip.to_cols_array_2d().map(|c| c.map(|v| v as f32)),
            normal: normals(turned)?,
            mirrored: turned.determinant() < 0.0,
            depth: frame.depth(world.w_axis.truncate()),
        };
        let finite = draw.clip.iter().flatten().all(|v| v.is_finite());
        finite.then_some(draw)
    }
}

/// The matrix that keeps normals upright on a surface moved by `m`: its
/// cofactors, which exist even where the inverse does not. `None` when all
/// points fall together or `m` is not finite.
fn normals(m: DMat3) -> Option<[[f32; 3]; 3]> {
    let size = largest(m);
    if !(size.is_finite() && size > 0.0) {
        return None;
    }
    let m = m * (1.0 / size);
    let cofactors =
        DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    let size = largest(cofactors);
    let scale = if size > 0.0 { sign / size } else { 0.0 };
    Some((cofactors * scale).to_cols_array_2d().map(|c| c.map(|v| v as f32)))
}

fn largest(m: DMat3) -> f64 {
    // `f64::max` would hide a NaN.
    let entries = m.to_cols_array();
    if entries.iter().any(|v| v.is_nan()) {
        return f64::NAN;
    }
    entries.iter().fold(0.0, |most, v| most.max(v.abs()))
}

//! Pictures of scenes made by hand, and the two renderers against each other.

mod cpu;
#[cfg(feature = "render")]
mod gpu;
mod load;
mod pictures;

use super::frame::Frame;
use super::framing::Framing;
use super::scene::{Alpha, Level, Material, Part, Scene, Texture, Vertex, Wrap};
use glam::{DMat4, DQuat, DVec3};
use std::sync::Arc;

/// Parts and where they stand.
#[derive(Default)]
pub(super) struct Stage {
    pub parts: Vec<Part>,
    pub textures: Vec<Texture>,
    pub placed: Vec<(usize, DMat4)>,
}

impl Stage {
    pub(super) fn frame(&self, size: (u32, u32)) -> Frame {
        let mut framing = Framing::new(size);
        for (part, world) in &self.placed {
            let corners = self.parts[*part].corners();
            corners.iter().for_each(|c| framing.add(world.transform_point3(*c)));
        }
        framing.frame()
    }

    pub(super) fn scene(&self, size: (u32, u32)) -> Scene<'_> {
        let placed = self.placed.iter().copied();
        Scene::new(&self.parts, &self.textures, placed, &self.frame(size), size)
    }
}

/// A box hinged at the middle of its top face, each face in a colour.
fn box_part(length: f64) -> Part {
    let colours = [
        [0.80, 0.10, 0.08],
        [0.16, 0.42, 0.75],
        [0.13, 0.50, 0.18],
        [0.85, 0.55, 0.06],
        [0.40, 0.16, 0.60],
        [0.05, 0.45, 0.45],
    ];
    let mut part = empty(Material::default());
    for (face, [r, g, b]) in colours.into_iter().enumerate() {
        let axis = face / 2;
        let side = if face % 2 == 0 { 1.0_f32 } else { -1.0 };
        let first = part.vertices.len() as u32;
        for [s, t] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let mut vertex = Vertex { colour: [r, g, b, 1.0], ..Vertex::default() };
            vertex.position[axis] = side;
            vertex.position[(axis + 1) % 3] = s * side;
            vertex.position[(axis + 2) % 3] = t;
            vertex.normal[axis] = side;
            vertex.uv = [0.5 + 0.5 * s, 0.5 - 0.5 * t];
            part.vertices.push(vertex);
        }
        part.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    }
    part.placement = DMat4::from_translation(DVec3::new(0.0, -length / 2.0, 0.0))
        * DMat4::from_scale(DVec3::new(0.5, length / 2.0, 0.5));
    part
}

fn empty(material: Material) -> Part {
    Part {
        vertices: Vec::new(),
        indices: Vec::new(),
        material,
        placement: DMat4::IDENTITY,
        half_extent: DVec3::ONE,
    }
}

/// Boxes that hang from each other and swing.
pub(super) fn chain(count: usize, length: f64) -> Stage {
    let mut world = DMat4::IDENTITY;
    let mut placed = Vec::new();
    for i in 0..count {
        let axis = DVec3::new(0.6, 0.3, 1.0 - i as f64 * 0.3).normalize();
        let turn = DQuat::from_axis_angle(axis, 0.5 - 0.35 * i as f64);
        world *= DMat4::from_quat(turn);
        placed.push((0, world));
        world *= DMat4::from_translation(DVec3::new(0.0, -length, 0.0));
    }
    Stage { parts: vec![box_part(length)], placed, ..Stage::default() }
}

/// A ball of smooth normals; every other one mirrored.
fn balls() -> Stage {
    let mut part = empty(Material { colour: [0.7, 0.35, 0.2, 1.0], ..Material::default() });
    let (rings, sectors) = (24_u32, 32_u32);
    for ring in 0..=rings {
        for sector in 0..=sectors {
            let (v, u) = (f64::from(ring) / f64::from(rings), f64::from(sector) / f64::from(sectors));
            let (down, round) = (v * std::f64::consts::PI, u * std::f64::consts::TAU);
            let p = [down.sin() * round.sin(), down.cos(), down.sin() * round.cos()];
            part.vertices.push(Vertex {
                position: p.map(|c| c as f32),
                normal: p.map(|c| c as f32),
                uv: [u as f32 * 4.0, v as f32 * 2.0],
                colour: [1.0, 1.0 - v as f32 * 0.8, 1.0, 1.0],
            });
        }
    }
    for ring in 0..rings {
        for sector in 0..sectors {
            let a = ring * (sectors + 1) + sector;
            let b = a + sectors + 1;
            part.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
        }
    }
    let placed = (0..4).map(|i| {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let at = DVec3::new(f64::from(i) * 1.8, 0.0, f64::from(i % 2));
        (0, DMat4::from_scale_rotation_translation(DVec3::new(side, 1.3, 1.0), DQuat::IDENTITY, at))
    });
    Stage { parts: vec![part], placed: placed.collect(), ..Stage::default() }
}

/// A tiled texture of soft squares, on balls.
fn textured() -> Stage {
    with_squares(balls())
}

/// The same on boxes with smooth normals, one of them mirrored.
fn textured_boxes() -> Stage {
    let mut part = box_part(2.0);
    for vertex in &mut part.vertices {
        vertex.normal = vertex.position;
        vertex.uv = vertex.uv.map(|c| c * 3.0);
    }
    let at = |x: f64, side: f64| {
        DMat4::from_translation(DVec3::new(x, 0.0, 0.0)) * DMat4::from_scale(DVec3::new(side, 1.0, 1.0))
    };
    with_squares(Stage {
        parts: vec![part],
        placed: vec![(0, at(-1.5, 1.0)), (0, at(0.0, -1.0))],
        ..Stage::default()
    })
}

fn with_squares(mut stage: Stage) -> Stage {
    let pixel = |x: u32, y: u32| match (x / 8 + y / 8) % 2 {
        0 => [230, (x * 8) as u8, 40, 255],
        _ => [30, 90, (y * 8) as u8, 255],
    };
    let first =
        Level { width: 32, height: 32, pixels: (0..32 * 32).map(|i| pixel(i % 32, i / 32)).collect() };
    stage.textures.push(Texture {
        levels: Arc::new(super::texture::levels(first)),
        wrap: [Wrap::Repeat, Wrap::Mirror],
        nearest: false,
    });
    stage.parts[0].material.texture = Some(0);
    stage
}

/// An opaque chain behind glass, and a box with holes cut by vertex alpha.
fn glass() -> Stage {
    let mut stage = chain(3, 1.5);
    let mut pane = box_part(2.0);
    pane.material = Material {
        colour: [0.3, 0.9, 1.0, 0.4],
        alpha: Alpha::Blend,
        double_sided: true,
        ..Material::default()
    };
    let mut holes = box_part(1.0);
    holes.material = Material { alpha: Alpha::Mask(0.5), double_sided: true, ..Material::default() };
    for (i, vertex) in holes.vertices.iter_mut().enumerate() {
        vertex.colour[3] = (i % 2) as f32;
    }
    stage.parts.extend([pane, holes]);
    let at = |x, y, z| DMat4::from_translation(DVec3::new(x, y, z));
    stage.placed.extend([(1, at(0.3, 0.0, 2.0)), (2, at(1.6, 0.0, 0.0)), (1, at(-0.8, -0.5, 1.2))]);
    stage
}

/// Names and stages that both renderers draw in the tests.
pub(super) fn stages() -> Vec<(&'static str, Stage)> {
    vec![
        ("one box", chain(1, 3.0)),
        ("chain", chain(4, 3.0)),
        ("long chain", chain(16, 1.2)),
        ("balls", balls()),
        ("textured", textured()),
        ("textured boxes", textured_boxes()),
        ("glass", glass()),
        ("nothing", Stage::default()),
    ]
}

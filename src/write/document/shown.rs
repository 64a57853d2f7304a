//! Nodes, and what they show: meshes, lines, materials, cameras.

use super::{Builder, Data, exact};
use crate::write::line::Line;
use crate::write::mesh::{Material, Mesh};
use crate::write::scene::{Lens, Node, Scene, Shape};
use glam::Vec3;
use gltf_json::accessor::{ComponentType, Type};
use gltf_json::mesh::{Mode, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{self as json, Index, buffer};
use std::collections::BTreeMap;

/// What lines need to look the same wherever the lamps are.
const UNLIT: &str = "KHR_materials_unlit";

impl Builder {
    /// Meshes and lines, their materials, and cameras.
    pub(super) fn shown(&mut self, scene: &Scene) {
        self.root.materials = scene.materials.iter().map(material).collect();
        self.root.cameras = scene.lenses.iter().map(camera).collect();
        let vertices = self.meshes(&scene.meshes);
        if !scene.lines.is_empty() {
            self.lines(&scene.lines, vertices);
        }
    }

    /// Describes meshes from the start of the buffer on, and returns where they end there.
    fn meshes(&mut self, meshes: &[Mesh]) -> u64 {
        const STRIDE: usize = 24;
        let sizes = |of: fn(&Mesh) -> Vec<u8>| meshes.iter().map(|m| of(m).len() as u64).sum::<u64>();
        let (vertices, indices) = (sizes(Mesh::vertex_bytes), sizes(Mesh::index_bytes));
        let vertex_view = self.view(0, vertices, Some(STRIDE), Some(buffer::Target::ArrayBuffer));
        let index_view = self.view(vertices, indices, None, Some(buffer::Target::ElementArrayBuffer));
        let (mut vertex_at, mut index_at) = (0, 0);
        for mesh in meshes {
            let count = mesh.corners.len() as u64;
            let vertex = |offset| Data { offset: vertex_at + offset, count };
            let range = bounds(mesh.corners.iter().map(|corner| corner.0));
            let positions =
                self.accessor(vertex_view, vertex(0), Type::Vec3, ComponentType::F32, Some(range));
            let normals = self.accessor(vertex_view, vertex(12), Type::Vec3, ComponentType::F32, None);
            let attributes = BTreeMap::from([
                (Checked::Valid(Semantic::Positions), positions),
                (Checked::Valid(Semantic::Normals), normals),
            ]);
            let mut primitives = Vec::new();
            for part in &mesh.parts {
                let data = Data { offset: index_at, count: part.triangles.len() as u64 };
                let indices = self.accessor(index_view, data, Type::Scalar, ComponentType::U16, None);
                index_at += 2 * data.count;
                primitives.push(json::mesh::Primitive {
                    attributes: attributes.clone(),
                    indices: Some(indices),
                    material: Some(Index::new(part.material as u32)),
                    mode: Checked::Valid(Mode::Triangles),
                    targets: None,
                    extensions: None,
                    extras: None,
                });
            }
            vertex_at += count * STRIDE as u64;
            let name = Some(mesh.name.clone());
            self.root.push(json::Mesh { name, primitives, weights: None, extensions: None, extras: None });
        }
        (vertices + indices).next_multiple_of(4)
    }

    fn lines(&mut self, lines: &[Line], start: u64) {
        self.root.extensions_used.push(UNLIT.to_owned());
        let material = self.root.push(line_material());
        let length = lines.iter().map(|line| line.bytes().len() as u64).sum();
        let view = self.view(start, length, Some(Line::STRIDE), Some(buffer::Target::ArrayBuffer));
        let mut at = 0;
        for line in lines {
            let count = line.points.len() as u64;
            let range = bounds(line.points.iter().map(|point| point.0));
            let places = Data { offset: at, count };
            let positions = self.accessor(view, places, Type::Vec3, ComponentType::F32, Some(range));
            let colours = Data { offset: at + 12, count };
            let colours = self.accessor(view, colours, Type::Vec4, ComponentType::U8, None);
            self.root.accessors[colours.value()].normalized = true;
            at += count * Line::STRIDE as u64;
            let primitive = json::mesh::Primitive {
                attributes: BTreeMap::from([
                    (Checked::Valid(Semantic::Positions), positions),
                    (Checked::Valid(Semantic::Colors(0)), colours),
                ]),
                indices: None,
                material: Some(material),
                mode: Checked::Valid(Mode::LineStrip),
                targets: None,
                extensions: None,
                extras: None,
            };
            let (name, primitives) = (Some(line.name.clone()), vec![primitive]);
            self.root.push(json::Mesh { name, primitives, weights: None, extensions: None, extras: None });
        }
    }

    pub(super) fn nodes(&mut self, scene: &Scene) {
        let shape = |shape| match shape {
            Shape::Mesh(mesh) => Index::new(mesh as u32),
            Shape::Line(line) => Index::new((scene.meshes.len() + line) as u32),
        };
        for node in &scene.nodes {
            let children: Vec<_> = node.children.iter().map(|&child| Index::new(child as u32)).collect();
            self.root.push(json::Node {
                name: Some(node.name.clone()),
                translation: (node.translation != Vec3::ZERO).then(|| node.translation.to_array()),
                scale: (node.scale != 1.0).then_some([node.scale; 3]),
                rotation: (node.rotation != Node::default().rotation)
                    .then_some(json::scene::UnitQuaternion(node.rotation)),
                mesh: node.shape.map(shape),
                camera: node.lens.map(|lens| Index::new(lens as u32)),
                children: (!children.is_empty()).then_some(children),
                ..Default::default()
            });
        }
        let shown = self.root.push(json::Scene {
            name: None,
            nodes: scene.tops.iter().map(|&node| Index::new(node as u32)).collect(),
            extensions: None,
            extras: None,
        });
        self.root.scene = Some(shown);
    }
}

fn material(material: &Material) -> json::Material {
    let [r, g, b] = material.colour.map(linear);
    json::Material {
        name: Some(material.name.to_owned()),
        pbr_metallic_roughness: json::material::PbrMetallicRoughness {
            base_color_factor: json::material::PbrBaseColorFactor([r, g, b, 1.0]),
            metallic_factor: json::material::StrengthFactor(0.0),
            roughness_factor: json::material::StrengthFactor(0.7),
            ..Default::default()
        },
        ..Default::default()
    }
}

/// A level as screens show it (sRGB, IEC 61966-2-1) as a share of light, to 4 digits.
pub(in crate::write) fn linear(level: u8) -> f32 {
    let c = f64::from(level) / 255.0;
    let light = if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
    ((light * 1e4).round() / 1e4) as f32
}

/// White, for the colours of points to show, and the same under any lamp.
fn line_material() -> json::Material {
    json::Material {
        name: Some("line".to_owned()),
        extensions: Some(json::extensions::material::Material {
            unlit: Some(json::extensions::material::Unlit {}),
        }),
        ..Default::default()
    }
}

fn camera(lens: &Lens) -> json::Camera {
    let [znear, zfar] = lens.range;
    json::Camera {
        name: None,
        orthographic: None,
        perspective: Some(json::camera::Perspective {
            aspect_ratio: None,
            yfov: lens.field_of_view,
            zfar: Some(zfar),
            znear,
            extensions: None,
            extras: None,
        }),
        type_: Checked::Valid(json::camera::Type::Perspective),
        extensions: None,
        extras: None,
    }
}

/// The least and the greatest of each coordinate, as accessors give them.
fn bounds(places: impl Iterator<Item = Vec3> + Clone) -> [json::Value; 2] {
    let corners = [places.clone().fold(Vec3::MAX, Vec3::min), places.fold(Vec3::MIN, Vec3::max)];
    corners.map(|corner| json::Value::from(corner.to_array().map(exact).to_vec()))
}

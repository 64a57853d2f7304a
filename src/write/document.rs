//! The JSON of a glTF file, by the `gltf-json` crate.

use super::mesh::{Material, Mesh};
use super::scene::{Node, Scene};
use glam::Vec3;
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{self as json, Index, Root, buffer};
use serde_json::value::RawValue;
use std::collections::{BTreeMap, HashMap};

/// One clip of a file.
#[derive(Clone, Debug)]
pub struct Animation {
    /// Unique in the file.
    pub name: String,
    /// What it was made from and how, as JSON.
    pub extras: String,
    /// At most one for a node and property.
    pub channels: Vec<Channel>,
}

/// One property of one node over time, linear between samples.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// Index into the scene's nodes.
    pub node: usize,
    /// What of the node changes.
    pub property: Property,
    /// Times of the samples; channels with equal times share them.
    pub times: Data,
    /// The first and the last time.
    pub span: [f32; 2],
    /// The values.
    pub values: Data,
}

/// What of a node changes over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// x y z w.
    Rotation,
    /// x y z.
    Translation,
}

/// Some elements of the buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Data {
    /// Where they begin, bytes from the start of the buffer, a multiple of 4.
    pub offset: u64,
    /// How many elements.
    pub count: u64,
}

impl Data {
    /// Data whose numbers take the most digits: a document of such data is at least as
    /// long as any other of the same shape.
    pub const WIDEST: Data = Data { offset: u64::MAX, count: u64::MAX };
}

/// Describes a scene and its animations, whose data stand in one buffer of `length`
/// bytes after the scene's own, as JSON. `uri` names the buffer's file; in a .glb it has
/// none.
pub fn document(scene: &Scene, animations: &[Animation], length: u64, uri: Option<String>) -> Vec<u8> {
    let mut builder = Builder::new(scene, length, uri);
    builder.meshes(&scene.meshes);
    builder.nodes(&scene.nodes);
    builder.animations(animations);
    builder.root.to_vec().expect("plain data becomes JSON")
}

struct Builder {
    root: Root,
    buffer: Index<buffer::Buffer>,
    /// Where the animations' data begin.
    data_start: u64,
    length: u64,
}

impl Builder {
    fn new(scene: &Scene, length: u64, uri: Option<String>) -> Builder {
        let generator = Some(concat!("dat2glb ", env!("CARGO_PKG_VERSION")).to_owned());
        let mut root = Root { asset: json::Asset { generator, ..Default::default() }, ..Default::default() };
        let buffer = root.push(json::Buffer {
            byte_length: USize64(length),
            name: None,
            uri,
            extensions: None,
            extras: None,
        });
        root.materials = scene.materials.iter().map(material).collect();
        Builder { root, buffer, data_start: scene.bytes().len() as u64, length }
    }

    fn view(
        &mut self,
        offset: u64,
        length: u64,
        stride: Option<usize>,
        target: Option<buffer::Target>,
    ) -> Index<buffer::View> {
        self.root.push(buffer::View {
            buffer: self.buffer,
            byte_length: USize64(length),
            byte_offset: Some(USize64(offset)),
            byte_stride: stride.map(buffer::Stride),
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        })
    }

    fn accessor(
        &mut self,
        view: Index<buffer::View>,
        data: Data,
        kind: Type,
        component: ComponentType,
        range: Option<[json::Value; 2]>,
    ) -> Index<json::Accessor> {
        let [min, max] = range.map_or([None, None], |range| range.map(Some));
        self.root.push(json::Accessor {
            buffer_view: Some(view),
            byte_offset: Some(USize64(data.offset)),
            count: USize64(data.count),
            component_type: Checked::Valid(GenericComponentType(component)),
            type_: Checked::Valid(kind),
            min,
            max,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: None,
        })
    }

    fn meshes(&mut self, meshes: &[Mesh]) {
        const STRIDE: usize = 24;
        let sizes = |of: fn(&Mesh) -> Vec<u8>| meshes.iter().map(|m| of(m).len() as u64).sum::<u64>();
        let (vertices, indices) = (sizes(Mesh::vertex_bytes), sizes(Mesh::index_bytes));
        let vertex_view = self.view(0, vertices, Some(STRIDE), Some(buffer::Target::ArrayBuffer));
        let index_view = self.view(vertices, indices, None, Some(buffer::Target::ElementArrayBuffer));
        let (mut vertex_at, mut index_at) = (0, 0);
        for mesh in meshes {
            let count = mesh.corners.len() as u64;
            let vertex = |offset| Data { offset: vertex_at + offset, count };
            let range = bounds(mesh).map(|corner| json::Value::from(corner.to_array().map(exact).to_vec()));
            let positions =
                self.accessor(vertex_view, vertex(0), Type::Vec3, ComponentType::F32, Some(range));
            let normals = self.accessor(vertex_view, vertex(12), Type::Vec3, ComponentType::F32, None);
            let attributes = BTreeMap::from([
                (Checked::Valid(json::mesh::Semantic::Positions), positions),
                (Checked::Valid(json::mesh::Semantic::Normals), normals),
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
                    mode: Checked::Valid(json::mesh::Mode::Triangles),
                    targets: None,
                    extensions: None,
                    extras: None,
                });
            }
            vertex_at += count * STRIDE as u64;
            let name = Some(mesh.name.clone());
            self.root.push(json::Mesh { name, primitives, weights: None, extensions: None, extras: None });
        }
    }

    fn nodes(&mut self, nodes: &[Node]) {
        for node in nodes {
            let children: Vec<_> = node.children.iter().map(|&child| Index::new(child as u32)).collect();
            self.root.push(json::Node {
                name: Some(node.name.clone()),
                translation: (node.translation != Vec3::ZERO).then(|| node.translation.to_array()),
                scale: (node.scale != 1.0).then_some([node.scale; 3]),
                mesh: node.mesh.map(|mesh| Index::new(mesh as u32)),
                children: (!children.is_empty()).then_some(children),
                ..Default::default()
            });
        }
        let scene = self.root.push(json::Scene {
            name: None,
            nodes: vec![Index::new(0)],
            extensions: None,
            extras: None,
        });
        self.root.scene = Some(scene);
    }

    fn animations(&mut self, animations: &[Animation]) {
        let view = self.view(self.data_start, self.length - self.data_start, None, None);
        let mut shared_times = HashMap::new();
        for animation in animations {
            let mut channels = Vec::new();
            let mut samplers = Vec::new();
            for channel in &animation.channels {
                let input = *shared_times.entry(channel.times).or_insert_with(|| {
                    let range = channel.span.map(|t| json::Value::from(vec![exact(t)]));
                    self.accessor(
                        view,
                        self.within(channel.times),
                        Type::Scalar,
                        ComponentType::F32,
                        Some(range),
                    )
                });
                let kind = match channel.property {
                    Property::Rotation => Type::Vec4,
                    Property::Translation => Type::Vec3,
                };
                let output = self.accessor(view, self.within(channel.values), kind, ComponentType::F32, None);
                channels.push(target(channel, samplers.len()));
                samplers.push(json::animation::Sampler {
                    input,
                    output,
                    interpolation: Checked::Valid(json::animation::Interpolation::Linear),
                    extensions: None,
                    extras: None,
                });
            }
            self.root.push(json::Animation {
                name: Some(animation.name.clone()),
                channels,
                samplers,
                extensions: None,
                extras: Some(RawValue::from_string(animation.extras.clone()).expect("extras are JSON")),
            });
        }
    }

    /// Data of the buffer as the animations' view counts it.
    fn within(&self, data: Data) -> Data {
        Data { offset: data.offset - self.data_start, ..data }
    }
}

fn target(channel: &Channel, sampler: usize) -> json::animation::Channel {
    let path = match channel.property {
        Property::Rotation => json::animation::Property::Rotation,
        Property::Translation => json::animation::Property::Translation,
    };
    json::animation::Channel {
        sampler: Index::new(sampler as u32),
        target: json::animation::Target {
            node: Index::new(channel.node as u32),
            path: Checked::Valid(path),
            extensions: None,
            extras: None,
        },
        extensions: None,
        extras: None,
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
fn linear(level: u8) -> f32 {
    let c = f64::from(level) / 255.0;
    let light = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    ((light * 1e4).round() / 1e4) as f32
}

/// A float32 as the number that reads back as exactly it, by whatever a reader parses
/// with.
fn exact(x: f32) -> f64 {
    f64::from(x)
}

/// The least and the greatest of each coordinate.
fn bounds(mesh: &Mesh) -> [Vec3; 2] {
    let positions = || mesh.corners.iter().map(|corner| corner.0);
    [positions().fold(Vec3::MAX, Vec3::min), positions().fold(Vec3::MIN, Vec3::max)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::Body;

    fn animation(data: Data) -> Animation {
        let channel = |node| Channel {
            node,
            property: Property::Rotation,
            times: data,
            span: [0.0, 1.5],
            values: data,
        };
        Animation {
            name: "clip".into(),
            extras: "{\"fps\":\"60\"}".into(),
            channels: vec![channel(1), channel(2)],
        }
    }

    #[test]
    fn the_gltf_crate_accepts_it() {
        let scene = Scene::of(Body::Chain { length: 3.0 }, 2);
        let start = scene.bytes().len() as u64;
        let data = Data { offset: start, count: 4 };
        let json = document(&scene, &[animation(data)], start + 64, Some("clip.bin".into()));
        let gltf = gltf::Gltf::from_slice(&json).unwrap();
        assert_eq!(
            gltf.nodes().map(|n| n.name().unwrap().to_owned()).collect::<Vec<_>>(),
            ["root", "box1", "box2"]
        );
        assert_eq!(gltf.nodes().nth(2).unwrap().transform().decomposed().0, [0.0, -3.0, 0.0]);
        let clip = gltf.animations().next().unwrap();
        let inputs: Vec<usize> = clip.samplers().map(|s| s.input().index()).collect();
        assert_eq!(inputs[0], inputs[1], "equal times are shared");
        assert_eq!(clip.extras().as_ref().unwrap().get(), "{\"fps\":\"60\"}");
    }

    #[test]
    fn widest_data_make_the_longest_document() {
        let scene = Scene::of(Body::Free, 1);
        let size = |data: Data, length| document(&scene, &[animation(data)], length, None).len();
        let start = scene.bytes().len() as u64;
        let widest = size(Data::WIDEST, u64::MAX);
        assert!(widest >= size(Data { offset: start, count: 123_456 }, 4_294_967_295));
    }
}

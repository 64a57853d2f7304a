//! The JSON of a glTF file, by the `gltf-json` crate.

mod animations;
mod shown;

pub(super) use shown::linear;

pub use animations::{Animation, Channel, Component, Interpolation, Property};

use super::scene::Scene;
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{self as json, Index, Root, buffer};

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
    builder.shown(scene);
    builder.nodes(scene);
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
}

/// A float32 as the number that reads back as exactly it, by whatever a reader parses
/// with.
fn exact(x: f32) -> f64 {
    f64::from(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::Body;

    fn animation(data: Data) -> Animation {
        let channel = |node| Channel {
            node,
            property: Property::Rotation,
            interpolation: Interpolation::Linear,
            component: Component::F32,
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

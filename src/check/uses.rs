//! What buffer views are used for: one kind of data each, and only that of
//! vertices with a stride.

use std::collections::{BTreeMap, BTreeSet};

use gltf::json::accessor::Accessor;
use gltf::json::{Index, Root};

use super::{Code, Report};

/// What the data of a buffer view is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Use {
    Vertices,
    Indices,
    Image,
    Other,
}

impl Use {
    fn name(self) -> &'static str {
        match self {
            Use::Vertices => "vertices",
            Use::Indices => "vertex indices",
            Use::Image => "an image",
            Use::Other => "animations, skins or sparse elements",
        }
    }
}

/// The first use of each buffer view.
struct Uses<'a> {
    root: &'a Root,
    first: BTreeMap<usize, (Use, String)>,
    /// Views that have a finding already.
    mixed: BTreeSet<usize>,
    report: &'a mut Report,
}

pub(super) fn check(root: &Root, report: &mut Report) {
    strides(root, report);
    let mut uses = Uses { root, first: BTreeMap::new(), mixed: BTreeSet::new(), report };
    uses.meshes();
    uses.animations();
    for (s, skin) in root.skins.iter().enumerate() {
        if let Some(accessor) = skin.inverse_bind_matrices {
            uses.accessor(accessor, Use::Other, &format!("/skins/{s}"));
        }
    }
    for (i, image) in root.images.iter().enumerate() {
        if let Some(view) = image.buffer_view {
            uses.view(view.value(), Use::Image, &format!("/images/{i}"));
        }
    }
    for (a, accessor) in root.accessors.iter().enumerate() {
        if let Some(sparse) = &accessor.sparse {
            let place = format!("/accessors/{a}/sparse");
            uses.view(sparse.indices.buffer_view.value(), Use::Other, &place);
            uses.view(sparse.values.buffer_view.value(), Use::Other, &place);
        }
    }
}

impl Uses<'_> {
    fn meshes(&mut self) {
        for (m, mesh) in self.root.meshes.iter().enumerate() {
            for (p, primitive) in mesh.primitives.iter().enumerate() {
                let place = format!("/meshes/{m}/primitives/{p}");
                let targets = primitive.targets.iter().flatten();
                let targets = targets.flat_map(|t| [t.positions, t.normals, t.tangents]).flatten();
                for accessor in primitive.attributes.values().copied().chain(targets) {
                    self.accessor(accessor, Use::Vertices, &place);
                }
                if let Some(accessor) = primitive.indices {
                    self.accessor(accessor, Use::Indices, &place);
                }
            }
        }
    }

    fn animations(&mut self) {
        for (a, animation) in self.root.animations.iter().enumerate() {
            for (s, sampler) in animation.samplers.iter().enumerate() {
                let place = format!("/animations/{a}/samplers/{s}");
                self.accessor(sampler.input, Use::Other, &place);
                self.accessor(sampler.output, Use::Other, &place);
            }
        }
    }

    fn accessor(&mut self, accessor: Index<Accessor>, used: Use, place: &str) {
        let view = self.root.get(accessor).and_then(|stored| stored.buffer_view);
        if let Some(view) = view {
            self.view(view.value(), used, place);
        }
    }

    fn view(&mut self, view: usize, used: Use, place: &str) {
        let first = self.first.entry(view).or_insert_with(|| (used, place.to_owned()));
        if first.0 == used || !self.mixed.insert(view) {
            return;
        }
        let (before, by) = (first.0.name(), &first.1);
        self.report.add(
            Code::ViewUses,
            format!("/bufferViews/{view}"),
            format!("holds {before} for {by} and {} for {place}; give each its own view", used.name()),
        );
    }
}

/// The data of key times and values is packed.
fn strides(root: &Root, report: &mut Report) {
    let mut seen = BTreeSet::new();
    for (a, animation) in root.animations.iter().enumerate() {
        for (s, sampler) in animation.samplers.iter().enumerate() {
            for (part, accessor) in [("input", sampler.input), ("output", sampler.output)] {
                let view = root.get(accessor).and_then(|stored| stored.buffer_view);
                let stride = view.and_then(|view| root.get(view)?.byte_stride);
                if stride.is_some() && seen.insert(accessor.value()) {
                    report.add(
                        Code::SamplerStride,
                        format!("/animations/{a}/samplers/{s}/{part}"),
                        "lies in a buffer view with a byteStride, which only vertex data may have; remove it and pack the data",
                    );
                }
            }
        }
    }
}

//! Objects that nothing refers to. They do no harm but cost bytes.

use gltf::json::{Index, Root};

use super::{Code, Report};

/// Which objects of one list are referred to.
struct Marks {
    list: &'static str,
    used: Vec<bool>,
}

impl Marks {
    fn new(list: &'static str, count: usize) -> Marks {
        let used = vec![false; count];
        Marks { list, used }
    }

    fn mark<T>(&mut self, indices: impl IntoIterator<Item = Index<T>>) {
        for index in indices {
            if let Some(used) = self.used.get_mut(index.value()) {
                *used = true;
            }
        }
    }
}

pub(super) fn check(root: &Root, report: &mut Report) {
    // What extensions refer to is not known here.
    if !root.extensions_used.is_empty() {
        return;
    }
    let lists = [
        nodes(root),
        meshes(root),
        cameras(root),
        skins(root),
        materials(root),
        textures(root),
        images(root),
        accessors(root),
        views(root),
        buffers(root),
    ];
    for Marks { list, used } in lists {
        let unused = used.iter().enumerate().filter(|(_, used)| !**used);
        for (index, _) in unused {
            report.add(Code::UnusedObject, format!("/{list}/{index}"), "nothing refers to it; leave it out");
        }
    }
    for (a, animation) in root.animations.iter().enumerate() {
        let mut marks = Marks::new("samplers", animation.samplers.len());
        marks.mark(animation.channels.iter().map(|channel| channel.sampler));
        for (s, _) in marks.used.iter().enumerate().filter(|(_, used)| !**used) {
            report.add(
                Code::UnusedObject,
                format!("/animations/{a}/samplers/{s}"),
                "no channel refers to it; leave it out",
            );
        }
    }
}

fn nodes(root: &Root) -> Marks {
    let mut marks = Marks::new("nodes", root.nodes.len());
    marks.mark(root.scenes.iter().flat_map(|scene| scene.nodes.iter().copied()));
    marks.mark(root.nodes.iter().filter_map(|node| node.children.as_ref()).flatten().copied());
    marks.mark(root.skins.iter().flat_map(|skin| skin.joints.iter().copied()));
    marks
}

fn meshes(root: &Root) -> Marks {
    let mut marks = Marks::new("meshes", root.meshes.len());
    marks.mark(root.nodes.iter().filter_map(|node| node.mesh));
    marks
}

fn cameras(root: &Root) -> Marks {
    let mut marks = Marks::new("cameras", root.cameras.len());
    marks.mark(root.nodes.iter().filter_map(|node| node.camera));
    marks
}

fn skins(root: &Root) -> Marks {
    let mut marks = Marks::new("skins", root.skins.len());
    marks.mark(root.nodes.iter().filter_map(|node| node.skin));
    marks
}

fn materials(root: &Root) -> Marks {
    let mut marks = Marks::new("materials", root.materials.len());
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    marks.mark(primitives.filter_map(|primitive| primitive.material));
    marks
}

fn textures(root: &Root) -> Marks {
    let mut marks = Marks::new("textures", root.textures.len());
    for material in &root.materials {
        let surface = &material.pbr_metallic_roughness;
        marks.mark(surface.base_color_texture.as_ref().map(|info| info.index));
        marks.mark(surface.metallic_roughness_texture.as_ref().map(|info| info.index));
        marks.mark(material.normal_texture.as_ref().map(|info| info.index));
        marks.mark(material.occlusion_texture.as_ref().map(|info| info.index));
        marks.mark(material.emissive_texture.as_ref().map(|info| info.index));
    }
    marks
}

fn images(root: &Root) -> Marks {
    let mut marks = Marks::new("images", root.images.len());
    marks.mark(root.textures.iter().map(|texture| texture.source));
    marks
}

fn accessors(root: &Root) -> Marks {
    let mut marks = Marks::new("accessors", root.accessors.len());
    let primitives = || root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    marks.mark(primitives().flat_map(|primitive| primitive.attributes.values().copied()));
    marks.mark(primitives().filter_map(|primitive| primitive.indices));
    for target in primitives().flat_map(|primitive| primitive.targets.iter().flatten()) {
        marks.mark([target.positions, target.normals, target.tangents].into_iter().flatten());
    }
    let samplers = root.animations.iter().flat_map(|animation| &animation.samplers);
    marks.mark(samplers.flat_map(|sampler| [sampler.input, sampler.output]));
    marks.mark(root.skins.iter().filter_map(|skin| skin.inverse_bind_matrices));
    marks
}

fn views(root: &Root) -> Marks {
    let mut marks = Marks::new("bufferViews", root.buffer_views.len());
    marks.mark(root.accessors.iter().filter_map(|accessor| accessor.buffer_view));
    for sparse in root.accessors.iter().filter_map(|accessor| accessor.sparse.as_ref()) {
        marks.mark([sparse.indices.buffer_view, sparse.values.buffer_view]);
    }
    marks.mark(root.images.iter().filter_map(|image| image.buffer_view));
    marks
}

fn buffers(root: &Root) -> Marks {
    let mut marks = Marks::new("buffers", root.buffers.len());
    marks.mark(root.buffer_views.iter().map(|view| view.buffer));
    marks
}

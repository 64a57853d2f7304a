//! What a glTF file holds: its nodes, its clips, and where its bytes go.

use std::collections::BTreeMap;
use std::fmt;

use ::gltf::json::animation::Interpolation;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Node, Root};
use serde::Serialize;
use serde_json::Value;

use crate::asset::play::Clip;
use crate::asset::{Asset, Container, Layout};

/// What a glTF file holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct GltfSummary {
    /// `glb` or `gltf`.
    pub kind: &'static str,
    /// The version of glTF.
    pub version: String,
    /// The program that made the file.
    pub generator: Option<String>,
    /// Number of nodes.
    pub nodes: usize,
    /// The nodes of the scene, parents before children; large trees shortened.
    pub tree: Vec<TreeNode>,
    /// The clips.
    pub clips: Vec<ClipSummary>,
    /// Bytes by part.
    pub bytes: Parts,
}

/// A node in the tree.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct TreeNode {
    /// Its index in the file.
    pub node: usize,
    /// Its name.
    pub name: Option<String>,
    /// How many nodes are above it.
    pub depth: usize,
    /// It shows a mesh.
    pub mesh: bool,
    /// It holds a camera.
    pub camera: bool,
    /// Children that the tree leaves out.
    pub hidden: usize,
}

/// A clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipSummary {
    /// Its name.
    pub name: Option<String>,
    /// Number of channels.
    pub channels: usize,
    /// Keys of the channel that has most.
    pub keys: usize,
    /// Time of the last key, seconds.
    pub duration: f64,
    /// The interpolations in use, and by how many channels.
    pub interpolations: BTreeMap<&'static str, usize>,
    /// What its maker noted.
    pub extras: Option<Value>,
}

/// Bytes by part. Data that several objects share counts once for each part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Parts {
    /// All files together.
    pub total: u64,
    /// The JSON text, without data inside of it.
    pub json: u64,
    /// Vertices and indices.
    pub meshes: u64,
    /// Times of keys.
    pub animation_times: u64,
    /// Values of keys.
    pub animation_values: u64,
    /// Images within buffers.
    pub images: u64,
    /// The rest: headers, padding, what nothing refers to.
    pub other: u64,
}

/// Says what a glTF file holds. What cannot be read is left out: whether the
/// file is sound is for [`crate::check`] to say.
pub fn gltf(asset: &mut Asset) -> GltfSummary {
    let clips = asset.clips();
    let bytes = parts(asset);
    let root = asset.root();
    GltfSummary {
        kind: match asset.container() {
            Container::Glb(_) => "glb",
            Container::Text { .. } => "gltf",
        },
        version: root.asset.version.clone(),
        generator: root.asset.generator.clone(),
        nodes: root.nodes.len(),
        tree: tree(root),
        clips: clips.iter().map(|clip| summary(root, clip)).collect(),
        bytes,
    }
}

fn summary(root: &Root, clip: &Clip) -> ClipSummary {
    let stored = &root.animations[clip.animation];
    let mut interpolations = BTreeMap::new();
    for channel in &clip.channels {
        *interpolations.entry(name(channel.interpolation)).or_default() += 1;
    }
    let extras = stored.extras.as_ref();
    ClipSummary {
        name: clip.name.clone(),
        channels: stored.channels.len(),
        keys: clip.channels.iter().map(|channel| channel.keys).max().unwrap_or(0),
        duration: clip.duration,
        interpolations,
        extras: extras.and_then(|extras| serde_json::from_str(extras.get()).ok()),
    }
}

fn name(interpolation: Interpolation) -> &'static str {
    match interpolation {
        Interpolation::Linear => "LINEAR",
        Interpolation::Step => "STEP",
        Interpolation::CubicSpline => "CUBICSPLINE",
    }
}

/// How much of a tree is shown: children of one node, levels, nodes in all.
const CHILDREN: usize = 8;
const LEVELS: usize = 12;
const LINES: usize = 60;

/// The nodes of the default scene, or without scenes all roots.
fn tree(root: &Root) -> Vec<TreeNode> {
    let mut tree = Vec::new();
    // A node may be listed twice in a broken file, even below itself.
    let mut shown = vec![false; root.nodes.len()];
    let mut open: Vec<_> = roots(root).into_iter().rev().map(|node| (node, 0)).collect();
    while let Some((index, depth)) = open.pop() {
        let Some(node) = root.nodes.get(index) else {
            continue;
        };
        if tree.len() == LINES {
            break;
        }
        if std::mem::replace(&mut shown[index], true) {
            continue;
        }
        let children = node.children.as_deref().unwrap_or_default();
        let kept = match depth + 1 {
            LEVELS => 0,
            _ => children.len().min(CHILDREN),
        };
        tree.push(TreeNode {
            node: index,
            name: node.name.clone(),
            depth,
            mesh: node.mesh.is_some(),
            camera: node.camera.is_some(),
            hidden: children.len() - kept,
        });
        let below = children[..kept].iter().rev();
        open.extend(below.map(|child| (child.value(), depth + 1)));
    }
    tree
}

fn roots(root: &Root) -> Vec<usize> {
    let value = |index: &Index<Node>| index.value();
    let scene = root.scene.map_or(0, |scene| scene.value());
    if let Some(scene) = root.scenes.get(scene) {
        return scene.nodes.iter().map(value).collect();
    }
    let mut child = vec![false; root.nodes.len()];
    for index in root.nodes.iter().filter_map(|node| node.children.as_ref()).flatten() {
        if let Some(child) = child.get_mut(index.value()) {
            *child = true;
        }
    }
    (0..root.nodes.len()).filter(|&node| !child[node]).collect()
}

/// What an accessor is for.
#[derive(Clone, Copy)]
enum Use {
    Mesh,
    Times,
    Values,
}

fn parts(asset: &mut Asset) -> Parts {
    let mut parts =
        Parts { total: asset.container().length(), json: asset.json().len() as u64, ..Parts::default() };
    for buffer in 0..asset.root().buffers.len() {
        match &asset.root().buffers[buffer].uri {
            Some(uri) if uri.starts_with("data:") => {
                parts.json = parts.json.saturating_sub(uri.len() as u64);
            }
            Some(_) => parts.total += asset.buffer_length(buffer).unwrap_or(0),
            None => {}
        }
    }
    let root = asset.root();
    for (accessor, used) in uses(root) {
        let bytes = data_length(root, accessor);
        let part = match used {
            Use::Mesh => &mut parts.meshes,
            Use::Times => &mut parts.animation_times,
            Use::Values => &mut parts.animation_values,
        };
        *part = part.saturating_add(bytes);
    }
    for image in &root.images {
        let view = image.buffer_view.and_then(|view| root.get(view));
        parts.images = parts.images.saturating_add(view.map_or(0, |view| view.byte_length.0));
    }
    let Parts { json, meshes, animation_times, animation_values, images, .. } = parts;
    let named = [json, meshes, animation_times, animation_values, images];
    parts.other = named.into_iter().fold(parts.total, u64::saturating_sub);
    parts
}

/// What each accessor is for; the last use counts.
fn uses(root: &Root) -> BTreeMap<usize, Use> {
    let mut uses = BTreeMap::new();
    for primitive in root.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let targets = primitive.targets.iter().flatten();
        let targets = targets.flat_map(|t| [t.positions, t.normals, t.tangents]).flatten();
        let attributes = primitive.attributes.values().copied();
        for accessor in attributes.chain(targets).chain(primitive.indices) {
            uses.insert(accessor.value(), Use::Mesh);
        }
    }
    for sampler in root.animations.iter().flat_map(|animation| &animation.samplers) {
        uses.insert(sampler.output.value(), Use::Values);
        uses.insert(sampler.input.value(), Use::Times);
    }
    uses
}

/// Bytes of an accessor's elements, as far as its buffer view has them.
fn data_length(root: &Root, accessor: usize) -> u64 {
    let Some(stored) = root.accessors.get(accessor) else {
        return 0;
    };
    let (Checked::Valid(kind), Checked::Valid(component)) = (&stored.type_, &stored.component_type) else {
        return 0;
    };
    let view = stored.buffer_view.and_then(|view| root.get(view));
    let claimed = Layout::new(*kind, component.0).stride().saturating_mul(stored.count.0);
    view.map_or(0, |view| view.byte_length.0.min(claimed))
}

impl fmt::Display for GltfSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, version, bytes, .. } = self;
        write!(f, "glTF {version} (.{kind}), {} bytes", bytes.total)?;
        if let Some(generator) = &self.generator {
            write!(f, ", made by {generator}")?;
        }
        writeln!(f, "\nnodes: {}", self.nodes)?;
        for node in &self.tree {
            writeln!(f, "{node}")?;
        }
        let shown: usize = self.tree.len();
        if shown < self.nodes {
            writeln!(f, "  … {} more nodes", self.nodes - shown)?;
        }
        writeln!(f, "clips: {}", self.clips.len())?;
        for clip in &self.clips {
            writeln!(f, "{clip}")?;
        }
        write!(f, "{bytes}")
    }
}

impl fmt::Display for TreeNode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:indent$}", "", indent = 2 * (self.depth + 1))?;
        match &self.name {
            Some(name) => write!(f, "{name}")?,
            None => write!(f, "(node {})", self.node)?,
        }
        let marks = [(self.mesh, " [mesh]"), (self.camera, " [camera]")];
        for (_, mark) in marks.iter().filter(|(marked, _)| *marked) {
            f.write_str(mark)?;
        }
        match self.hidden {
            0 => Ok(()),
            1 => f.write_str(" … 1 more child"),
            hidden => write!(f, " … {hidden} more children"),
        }
    }
}

impl fmt::Display for ClipSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.name.as_deref().unwrap_or("(no name)");
        // The file's times are float32: more digits would be noise.
        let seconds = self.duration as f32;
        write!(f, "  {name}: {} channels, {} keys, {seconds} s", self.channels, self.keys)?;
        for (interpolation, channels) in &self.interpolations {
            write!(f, ", {channels} {interpolation}")?;
        }
        match &self.extras {
            Some(extras) => write!(f, "\n    {extras}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            ("JSON", self.json),
            ("meshes", self.meshes),
            ("animation times", self.animation_times),
            ("animation values", self.animation_values),
            ("images", self.images),
            ("other", self.other),
        ];
        writeln!(f, "bytes: {}", self.total)?;
        for (name, bytes) in parts {
            writeln!(f, "  {name}: {bytes}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::asset::tests::{animated, glb, open};

    fn nodes(nodes: Value) -> Vec<TreeNode> {
        let json = json!({"asset": {"version": "2.0"}, "nodes": nodes});
        tree(open(glb(&json, &[])).unwrap().root())
    }

    #[test]
    fn a_small_file() {
        let values = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let found = gltf(&mut animated("rotation", "LINEAR", &[0.0, 0.1], &values));
        assert_eq!(found.kind, "glb");
        assert_eq!((found.bytes.animation_times, found.bytes.animation_values), (8, 32));
        // The header, two chunk headers, and spaces after the JSON.
        assert!((28..32).contains(&found.bytes.other), "{:?}", found.bytes);
        let text = found.to_string();
        assert!(
            text.contains("\n  (node 0)\nclips: 1\n  clip: 1 channels, 2 keys, 0.1 s, 1 LINEAR\n"),
            "{text}"
        );
        assert_eq!(serde_json::to_value(&found).unwrap()["clips"][0]["interpolations"]["LINEAR"], 1);
    }

    #[test]
    fn trees_are_shortened() {
        let chain: Vec<_> =
            (1..=500).map(|i| if i < 500 { json!({"children": [i]}) } else { json!({}) }).collect();
        let found = nodes(Value::from(chain));
        assert_eq!(found.len(), LEVELS);
        assert_eq!(found[LEVELS - 1].hidden, 1);
        let mut wide = vec![json!({"name": "top", "camera": 0, "children": (1..=20).collect::<Vec<_>>()})];
        wide.resize(21, json!({"mesh": 0}));
        let found = nodes(Value::from(wide));
        assert_eq!((found.len(), found[0].hidden), (1 + CHILDREN, 12));
        assert_eq!(found[0].to_string(), "  top [camera] … 12 more children");
        assert_eq!(found[8].to_string(), "    (node 8) [mesh]");
    }

    #[test]
    fn broken_trees_end() {
        assert!(nodes(json!([{"children": [1]}, {"children": [0]}])).is_empty());
        let found = nodes(json!([{"children": [1, 9]}, {"children": [1]}]));
        assert_eq!(found.len(), 2);
    }
}

//! From a glTF file to what stands still while a clip plays: parts, textures
//! and the tree of nodes.
//!
//! A part that cannot be read is left out and named in the notes; only what
//! leaves nothing to draw from is an error, and that is found on opening.

use super::camera::Camera;
use super::mesh::{self, Left};
use super::pose::Local;
use super::scene::{Part, Texture};
use super::texture::Textures;
use crate::asset::{Asset, Error};
use gltf::json::Root;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Extensions that are drawn, or whose absence changes no picture.
const HARMLESS: [&str; 3] = ["KHR_materials_unlit", "KHR_mesh_quantization", "KHR_xmp_json_ld"];

/// A file made ready to be posed.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub parts: Vec<Part>,
    pub textures: Vec<Texture>,
    /// The nodes of the scene, parents before their children.
    pub nodes: Vec<Node>,
    /// The cameras among the nodes.
    pub cameras: Vec<Camera>,
    /// Joints of skins, as indices into the file's nodes.
    pub joints: HashSet<usize>,
    /// What of the file is not drawn, a sentence each.
    pub notes: Vec<String>,
}

/// A node of the scene.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// Its index in the file.
    pub index: usize,
    /// Index into [`Model::nodes`], smaller than the node's own.
    pub parent: Option<usize>,
    /// How it stands to its parent while nothing moves it.
    pub rest: Local,
    /// Indices into [`Model::parts`].
    pub parts: Vec<usize>,
}

impl Model {
    /// Reads what the default scene shows.
    pub(crate) fn load(asset: &mut Asset) -> Self {
        let mut model = Model { nodes: tree(asset.root()), joints: joints(asset.root()), ..Model::default() };
        model.cameras = Camera::all(asset.root(), &model.nodes);
        let mut reader = Reader {
            asset,
            textures: Textures::default(),
            meshes: HashMap::new(),
            left: BTreeSet::new(),
            unread: Vec::new(),
        };
        for node in &mut model.nodes {
            node.parts = reader.parts_of(node.index, &mut model.parts);
        }
        model.notes = reader.notes();
        model.textures = reader.textures.all;
        model
    }
}

/// The nodes of the scene that is shown, breadth first. A node that is reached
/// twice stays where it was reached first, so cycles end.
fn tree(root: &Root) -> Vec<Node> {
    let mut reached = HashSet::new();
    let mut nodes: Vec<Node> = Vec::new();
    let mut add = |index: usize, parent: Option<usize>, nodes: &mut Vec<Node>| {
        if let Some(stored) = root.nodes.get(index)
            && reached.insert(index)
        {
            nodes.push(Node { index, parent, rest: Local::of(stored), parts: Vec::new() });
        }
    };
    for index in tops(root) {
        add(index, None, &mut nodes);
    }
    let mut next = 0;
    while next < nodes.len() {
        let children = root.nodes[nodes[next].index].children.iter().flatten();
        for child in children {
            add(child.value(), Some(next), &mut nodes);
        }
        next += 1;
    }
    nodes
}

/// The nodes that a viewer starts from: the default scene's, else the first
/// scene's, else all that are no one's child.
fn tops(root: &Root) -> Vec<usize> {
    let default = root.scene.map_or(0, |scene| scene.value());
    if let Some(scene) = root.scenes.get(default) {
        return scene.nodes.iter().map(|node| node.value()).collect();
    }
    let children: HashSet<usize> = root
        .nodes
        .iter()
        .flat_map(|node| node.children.iter().flatten())
        .map(|child| child.value())
        .collect();
    (0..root.nodes.len()).filter(|node| !children.contains(node)).collect()
}

fn joints(root: &Root) -> HashSet<usize> {
    let joints = root.skins.iter().flat_map(|skin| &skin.joints);
    joints.map(|joint| joint.value()).collect()
}

/// Reads each mesh once, however many nodes show it.
struct Reader<'a> {
    asset: &'a mut Asset,
    textures: Textures,
    meshes: HashMap<usize, Vec<usize>>,
    /// Kinds of things that were met and are not drawn.
    left: BTreeSet<Left>,
    unread: Vec<Error>,
}

impl Reader<'_> {
    /// The parts of a node, added to `parts` unless they are there already.
    fn parts_of(&mut self, node: usize, parts: &mut Vec<Part>) -> Vec<usize> {
        let node = &self.asset.root().nodes[node];
        if node.skin.is_some() {
            self.left.insert(Left::Skins);
        }
        let Some(mesh) = node.mesh.map(|mesh| mesh.value()) else {
            return Vec::new();
        };
        if let Some(known) = self.meshes.get(&mesh) {
            return known.clone();
        }
        let first = parts.len();
        let count = self.asset.root().meshes.get(mesh).map_or(0, |m| m.primitives.len());
        for primitive in 0..count {
            match mesh::part(self.asset, mesh, primitive, &mut self.textures, &mut self.left) {
                Ok(part) => parts.extend(part),
                Err(error) => self.unread.push(error),
            }
        }
        let made: Vec<usize> = (first..parts.len()).collect();
        self.meshes.insert(mesh, made.clone());
        made
    }

    fn notes(&self) -> Vec<String> {
        let kinds = self.left.iter().map(|left| left.to_string());
        let extensions = self.asset.root().extensions_used.iter();
        let extensions = extensions.filter(|e| !HARMLESS.contains(&e.as_str())).cloned();
        let left: Vec<String> = kinds.chain(extensions).collect();
        let mut notes = Vec::new();
        if !left.is_empty() {
            notes.push(format!("not drawn: {}", left.join(", ")));
        }
        let unread: Vec<&Error> = self.unread.iter().chain(&self.textures.unread).collect();
        match unread[..] {
            [] => {}
            [one] => notes.push(format!("left out: {one}")),
            [first, ..] => {
                notes.push(format!("left out: {first} (and {} more)", unread.len() - 1));
            }
        }
        notes
    }
}

//! What stands still in a file: the node tree and what hangs on it.

use super::mesh::{Material, Mesh};
use super::{free_body, glider};
use crate::clip::Body;
use glam::Vec3;

/// Nodes, meshes and materials.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Node 0 is the root.
    pub nodes: Vec<Node>,
    /// Meshes that nodes refer to.
    pub meshes: Vec<Mesh>,
    /// Materials that meshes refer to.
    pub materials: Vec<Material>,
    /// For each track of the clip the node that it turns.
    pub turned: Vec<usize>,
}

/// A node of the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Unique in the file.
    pub name: String,
    /// Place in the parent's frame.
    pub translation: Vec3,
    /// Size in the parent's units.
    pub scale: f32,
    /// Index of its mesh.
    pub mesh: Option<usize>,
    /// Indices of its children.
    pub children: Vec<usize>,
}

impl Default for Node {
    fn default() -> Node {
        let (translation, children) = (Vec3::ZERO, Vec::new());
        Node { name: String::new(), translation, scale: 1.0, mesh: None, children }
    }
}

/// Faces of a box: warm colours where an axis points, cool ones where it does not.
const FACES: [Material; 6] = [
    Material { name: "+X red", colour: [214, 69, 56] },
    Material { name: "-X cyan", colour: [79, 190, 200] },
    Material { name: "+Y green", colour: [96, 173, 75] },
    Material { name: "-Y violet", colour: [142, 94, 184] },
    Material { name: "+Z blue", colour: [58, 110, 207] },
    Material { name: "-Z yellow", colour: [240, 193, 60] },
];

/// Beyond this float32 has little room for what viewers compute.
const GREATEST: f32 = 1e30;

const FREE_BODY: [Material; 6] = [
    Material { name: "body", colour: [196, 200, 206] },
    Material { name: "nose", colour: [240, 150, 50] },
    Material { name: "fin", colour: [90, 96, 108] },
    Material { name: "X axis", colour: [220, 50, 47] },
    Material { name: "Y axis", colour: [70, 170, 60] },
    Material { name: "Z axis", colour: [40, 100, 220] },
];

impl Scene {
    /// The scene that shows a clip's body turn.
    pub fn of(body: Body, tracks: usize) -> Scene {
        match body {
            Body::Chain { length } => Scene::chain(length as f32, tracks),
            Body::Free => Scene::free_body(),
        }
    }

    /// `root`, under it `box1` … `boxN`, each at the bottom of the one above it.
    fn chain(length: f32, boxes: usize) -> Scene {
        let mut mesh = Mesh::new("box");
        mesh.cuboid([0, 1, 2, 3, 4, 5], Vec3::new(-0.5, -length, -0.5), Vec3::new(0.5, 0.0, 0.5));
        let root = Node { name: "root".into(), children: vec![1], ..Node::default() };
        let link = |i: usize| Node {
            name: format!("box{i}"),
            translation: if i == 1 { Vec3::ZERO } else { Vec3::new(0.0, -length, 0.0) },
            mesh: Some(0),
            children: if i < boxes { vec![i + 1] } else { Vec::new() },
            ..Node::default()
        };
        Scene {
            nodes: std::iter::once(root).chain((1..=boxes).map(link)).collect(),
            meshes: vec![mesh],
            materials: FACES.to_vec(),
            turned: (1..=boxes).collect(),
        }
    }

    fn free_body() -> Scene {
        let mesh = free_body::mesh(&free_body::Colours { body: 0, nose: 1, fin: 2, axes: [3, 4, 5] });
        Scene { turned: vec![1], ..Scene::single("body", mesh, &FREE_BODY) }
    }

    /// The glider that a path alone moves: about an eighth as long as the path is wide,
    /// so that both can be seen.
    pub fn glider(extent: f64) -> Scene {
        let mut scene = Scene::single("glider", glider::mesh(), &glider::COLOURS);
        let scale = (extent / 8.0 / glider::LENGTH) as f32;
        if scale.is_normal() && scale < GREATEST {
            scene.nodes[1].scale = scale;
        }
        scene
    }

    /// One mesh on a node of its own below the root; nothing turns yet.
    fn single(name: &str, mesh: Mesh, materials: &[Material]) -> Scene {
        let root = Node { name: "root".into(), children: vec![1], ..Node::default() };
        let body = Node { name: name.into(), mesh: Some(0), ..Node::default() };
        Scene {
            nodes: vec![root, body],
            meshes: vec![mesh],
            materials: materials.to_vec(),
            turned: Vec::new(),
        }
    }

    /// The bytes that stand before all samples: vertices, then indices.
    pub fn bytes(&self) -> Vec<u8> {
        let vertices = self.meshes.iter().flat_map(Mesh::vertex_bytes);
        let mut bytes: Vec<u8> = vertices.chain(self.meshes.iter().flat_map(Mesh::index_bytes)).collect();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        bytes
    }
}

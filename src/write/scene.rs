//! What stands still in a file: the node tree and what hangs on it.

use super::line::Line;
use super::mesh::{Material, Mesh};
use super::{free_body, glider};
use crate::clip::Body;
use crate::math::Quat;
use glam::{DVec3, Vec3};

/// Nodes, and what they show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Every node of the tree.
    pub nodes: Vec<Node>,
    /// Indices of the nodes that are no one's child.
    pub tops: Vec<usize>,
    /// Meshes that nodes refer to.
    pub meshes: Vec<Mesh>,
    /// Lines that nodes refer to.
    pub lines: Vec<Line>,
    /// Materials that meshes refer to.
    pub materials: Vec<Material>,
    /// Cameras that nodes refer to.
    pub lenses: Vec<Lens>,
    /// What moves: one object, or several copies of it.
    pub objects: Vec<Object>,
    /// The nodes of the cameras.
    pub cameras: Vec<usize>,
    /// About how large an object is.
    pub size: f64,
}

/// The nodes by which an object moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Object {
    /// The one above all others.
    pub root: usize,
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
    /// Rotation in the parent's frame, x y z w.
    pub rotation: [f32; 4],
    /// Size in the parent's units.
    pub scale: f32,
    /// What it shows.
    pub shape: Option<Shape>,
    /// Index of its camera. Such a node shows nothing and has no children: some engines
    /// turn the node of a camera about to look the other way.
    pub lens: Option<usize>,
    /// Indices of its children.
    pub children: Vec<usize>,
}

/// What a node shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Index of its mesh.
    Mesh(usize),
    /// Index of its line.
    Line(usize),
}

/// How a camera sees: in perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// From the lower to the upper edge of the picture, radians.
    pub field_of_view: f32,
    /// Distance of the nearest and of the farthest thing that is seen.
    pub range: [f32; 2],
}

impl Default for Node {
    fn default() -> Node {
        Node {
            name: String::new(),
            translation: Vec3::ZERO,
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: 1.0,
            shape: None,
            lens: None,
            children: Vec::new(),
        }
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
            shape: Some(Shape::Mesh(0)),
            children: if i < boxes { vec![i + 1] } else { Vec::new() },
            ..Node::default()
        };
        Scene {
            nodes: std::iter::once(root).chain((1..=boxes).map(link)).collect(),
            tops: vec![0],
            meshes: vec![mesh],
            materials: FACES.to_vec(),
            objects: vec![Object { root: 0, turned: (1..=boxes).collect() }],
            size: f64::from(length) * boxes as f64,
            ..Scene::default()
        }
    }

    fn free_body() -> Scene {
        let mesh = free_body::mesh(&free_body::Colours { body: 0, nose: 1, fin: 2, axes: [3, 4, 5] });
        let object = Object { root: 0, turned: vec![1] };
        Scene { objects: vec![object], size: free_body::SIZE, ..Scene::single("body", mesh, &FREE_BODY) }
    }

    /// The glider that a path alone moves: about an eighth as long as the path is wide,
    /// so that both can be seen.
    pub fn glider(extent: f64) -> Scene {
        let mut scene = Scene::single("glider", glider::mesh(), &glider::COLOURS);
        let scale = (extent / 8.0 / glider::LENGTH) as f32;
        if scale.is_normal() && scale < GREATEST {
            scene.nodes[1].scale = scale;
        }
        scene.size = glider::LENGTH * f64::from(scene.nodes[1].scale);
        scene
    }

    /// One mesh on a node of its own below the root; nothing turns yet.
    fn single(name: &str, mesh: Mesh, materials: &[Material]) -> Scene {
        let root = Node { name: "root".into(), children: vec![1], ..Node::default() };
        let body = Node { name: name.into(), shape: Some(Shape::Mesh(0)), ..Node::default() };
        Scene {
            nodes: vec![root, body],
            tops: vec![0],
            meshes: vec![mesh],
            materials: materials.to_vec(),
            objects: vec![Object::default()],
            ..Scene::default()
        }
    }

    /// Puts copies of the object beside it, `count` in all: nodes of their own, named
    /// `root-2` and so on, that show the same meshes. The scene holds one object only.
    pub fn repeat(&mut self, count: usize) {
        let (object, nodes) = (self.objects[0].clone(), self.nodes.clone());
        for copy in 2..=count {
            let first = self.nodes.len();
            let moved = |node: &Node| Node {
                name: format!("{}-{copy}", node.name),
                children: node.children.iter().map(|child| first + child).collect(),
                ..node.clone()
            };
            self.nodes.extend(nodes.iter().map(moved));
            self.tops.push(first + object.root);
            let turned = object.turned.iter().map(|node| first + node).collect();
            self.objects.push(Object { root: first + object.root, turned });
        }
    }

    /// Adds a camera that rests at a place, or moves from there: below the first object's
    /// root, or on its own.
    pub fn add_camera(&mut self, name: String, lens: Lens, at: DVec3, turned: Quat, mounted: bool) {
        let node = self.add(Node {
            name,
            translation: at.as_vec3(),
            rotation: turned.to_xyzw().map(|x| x as f32),
            lens: Some(self.lenses.len()),
            ..Node::default()
        });
        self.lenses.push(lens);
        self.cameras.push(node);
        if mounted {
            let root = self.objects[0].root;
            self.nodes[root].children.push(node);
        } else {
            self.tops.push(node);
        }
    }

    /// Adds a node that is no one's child yet.
    pub(super) fn add(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// The bytes that stand before all samples: vertices, indices, points of lines.
    pub fn bytes(&self) -> Vec<u8> {
        let vertices = self.meshes.iter().flat_map(Mesh::vertex_bytes);
        let mut bytes: Vec<u8> = vertices.chain(self.meshes.iter().flat_map(Mesh::index_bytes)).collect();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        bytes.extend(self.lines.iter().flat_map(Line::bytes));
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_have_nodes_of_their_own_and_share_meshes() {
        let mut scene = Scene::of(Body::Chain { length: 2.0 }, 3);
        scene.repeat(3);
        assert_eq!(scene.nodes.len(), 12);
        assert_eq!(scene.tops, [0, 4, 8]);
        assert_eq!(scene.meshes.len(), 1);
        let third = &scene.objects[2];
        let names: Vec<&str> = third.turned.iter().map(|&node| scene.nodes[node].name.as_str()).collect();
        assert_eq!(names, ["box1-3", "box2-3", "box3-3"]);
        assert_eq!(scene.nodes[third.root].children, third.turned[..1]);
    }

    #[test]
    fn cameras_hang_on_the_first_object_or_stand_alone() {
        let mut scene = Scene::of(Body::Free, 1);
        scene.repeat(2);
        let lens = Lens { field_of_view: 1.0, range: [0.1, 10.0] };
        scene.add_camera("a".into(), lens, DVec3::X, Quat::IDENTITY, true);
        scene.add_camera("b".into(), lens, DVec3::Y, Quat::IDENTITY, false);
        let [a, b] = scene.cameras[..] else { panic!() };
        assert!(scene.nodes[0].children.contains(&a) && !scene.tops.contains(&a));
        assert!(scene.tops.contains(&b));
        assert!([a, b].iter().all(|&node| scene.nodes[node].shape.is_none()));
    }
}

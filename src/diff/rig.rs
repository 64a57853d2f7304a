//! A file's nodes as a tree, and how each stands while nothing moves it.

use crate::asset::play::Property;
use crate::asset::{Asset, Error};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::{Node, Root};

/// The nodes of a file, by their index in it.
#[derive(Clone, Debug)]
pub(super) struct Rig {
    pub(super) joints: Vec<Joint>,
    /// Indices of all joints, parents before their children.
    pub(super) order: Vec<usize>,
}

/// A node.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    pub(super) name: Option<String>,
    pub(super) parent: Option<usize>,
    /// Which child of its parent it is, or which of the nodes without a parent.
    pub(super) place: usize,
    pub(super) rest: Local,
}

/// How a node stands to its parent: scaled first, then turned, then moved.
#[derive(Clone, Debug)]
pub(super) struct Local {
    pub(super) translation: DVec3,
    /// x y z w; near unit length in a sound file.
    pub(super) rotation: [f64; 4],
    pub(super) scale: DVec3,
    pub(super) weights: Vec<f64>,
    /// A node's own matrix, which may shear and then is more than the three steps. No
    /// animation may change it; where one does, the steps count.
    matrix: Option<DAffine3>,
}

impl Rig {
    pub(super) fn of(asset: &Asset) -> Result<Rig, Error> {
        let root = asset.root();
        let mut parents = parents(root);
        let order = order(root, &mut parents);
        let mut joints: Vec<Joint> = root
            .nodes
            .iter()
            .zip(&parents)
            .map(|(node, &parent)| Joint {
                name: node.name.clone(),
                parent,
                place: 0,
                rest: Local::of(node, root),
            })
            .collect();
        let mut children = vec![0; joints.len()];
        let mut tops = 0;
        for &index in &order {
            let count = parents[index].map_or(&mut tops, |parent| &mut children[parent]);
            joints[index].place = *count;
            *count += 1;
        }
        match joints.iter().position(|joint| !joint.rest.is_finite()) {
            None => Ok(Rig { joints, order }),
            Some(node) => {
                let problem = "expected finite numbers, and how it stands to its parent has others";
                Err(Error::data(format!("/nodes/{node}"), problem))
            }
        }
    }

    /// The node's name, or its number where it has none.
    pub(super) fn name(&self, node: usize) -> String {
        self.joints[node].name.clone().unwrap_or_else(|| format!("node {node}"))
    }

    /// The last step of the path from the top down to a node: its name, or which child it
    /// is where it has none.
    pub(super) fn step(&self, node: usize, renamed: impl Fn(&str) -> String) -> String {
        match &self.joints[node].name {
            Some(name) => renamed(name),
            None => format!("#{}", self.joints[node].place),
        }
    }
}

/// Each node's parent; of two the first counts.
fn parents(root: &Root) -> Vec<Option<usize>> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten().map(|child| child.value()) {
            if let Some(parent @ None) = parents.get_mut(child)
                && child != index
            {
                *parent = Some(index);
            }
        }
    }
    parents
}

/// Parents before their children. In a broken file nodes may be their own ancestors:
/// such a ring is cut at the first of them.
fn order(root: &Root, parents: &mut [Option<usize>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..parents.len()).filter(|&node| parents[node].is_none()).collect();
    let mut reached = vec![false; parents.len()];
    order.iter().for_each(|&node| reached[node] = true);
    let (mut next, mut uncut) = (0, 0);
    loop {
        while let Some(&node) = order.get(next) {
            next += 1;
            for child in root.nodes[node].children.iter().flatten().map(|child| child.value()) {
                if parents.get(child) == Some(&Some(node)) && !reached[child] {
                    reached[child] = true;
                    order.push(child);
                }
            }
        }
        while reached.get(uncut) == Some(&true) {
            uncut += 1;
        }
        if uncut == parents.len() {
            return order;
        }
        parents[uncut] = None;
        reached[uncut] = true;
        order.push(uncut);
    }
}

impl Local {
    fn of(node: &Node, root: &Root) -> Local {
        let mesh = node.mesh.and_then(|mesh| root.get(mesh));
        let weights = node.weights.as_ref().or(mesh.and_then(|mesh| mesh.weights.as_ref()));
        let weights = weights.iter().flat_map(|weights| weights.iter().copied().map(f64::from)).collect();
        if let Some(matrix) = node.matrix {
            let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            let matrix = Some(DAffine3::from_mat4(matrix));
            return Local { translation, rotation: rotation.to_array(), scale, weights, matrix };
        }
        let three = |v: Option<[f32; 3]>, default| v.map_or(default, |v| v.map(f64::from).into());
        Local {
            translation: three(node.translation, DVec3::ZERO),
            rotation: node.rotation.unwrap_or_default().0.map(f64::from),
            scale: three(node.scale, DVec3::ONE),
            weights,
            matrix: None,
        }
    }

    fn is_finite(&self) -> bool {
        let numbers = self.rotation.iter().chain(&self.weights);
        let steps = self.translation.is_finite() && self.scale.is_finite();
        steps && numbers.copied().all(f64::is_finite) && self.matrix.is_none_or(|matrix| matrix.is_finite())
    }

    /// Replaces one step.
    pub(super) fn set(&mut self, property: Property, value: &[f64]) {
        if property != Property::MorphTargetWeights {
            self.matrix = None;
        }
        match (property, value) {
            (Property::Translation, [x, y, z]) => self.translation = DVec3::new(*x, *y, *z),
            (Property::Scale, [x, y, z]) => self.scale = DVec3::new(*x, *y, *z),
            (Property::Rotation, [x, y, z, w]) => self.rotation = [*x, *y, *z, *w],
            (Property::MorphTargetWeights, weights) => {
                self.weights.clear();
                self.weights.extend(weights);
            }
            _ => {}
        }
    }

    /// From the node's coordinates to its parent's. A rotation counts as if it were of
    /// unit length; zero turns nothing.
    pub(super) fn affine(&self) -> DAffine3 {
        self.matrix.unwrap_or_else(|| {
            let rotation = DQuat::from_array(self.rotation);
            let length = rotation.length();
            let unit = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
            DAffine3::from_scale_rotation_translation(self.scale, unit, self.translation)
        })
    }
}

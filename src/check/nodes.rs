//! Nodes: a forest without cycles, transforms that mean one thing, cameras
//! that see, names that tell nodes and clips apart.

use std::collections::HashMap;

use gltf::json::Root;

use super::{Code, Report};

pub(super) fn check(root: &Root, report: &mut Report) {
    let parents = parents(root, report);
    cycles(&parents, report);
    scene_roots(root, &parents, report);
    transforms(root, report);
    cameras(root, report);
    let nodes = root.nodes.iter().map(|node| node.name.as_deref());
    names("nodes", nodes, report);
    let clips = root.animations.iter().map(|clip| clip.name.as_deref());
    names("animations", clips, report);
}

/// The first parent of each node.
fn parents(root: &Root, report: &mut Report) -> Vec<Option<usize>> {
    let mut parents = vec![None; root.nodes.len()];
    for (parent, node) in root.nodes.iter().enumerate() {
        for (i, child) in node.children.iter().flatten().enumerate() {
            let Some(slot) = parents.get_mut(child.value()) else {
                continue;
            };
            match *slot {
                None => *slot = Some(parent),
                Some(first) => report.add(
                    Code::NodeTwoParents,
                    format!("/nodes/{parent}/children/{i}"),
                    format!("node {child} is a child of node {first} already; a node has one parent at most"),
                ),
            }
        }
    }
    parents
}

/// Each node has one parent at most here, so whoever walks up from a node
/// either leaves at a root or comes round to a node of the same walk.
fn cycles(parents: &[Option<usize>], report: &mut Report) {
    const NEW: usize = usize::MAX;
    let mut walked_by = vec![NEW; parents.len()];
    for start in 0..parents.len() {
        let mut at = Some(start);
        while let Some(node) = at.filter(|&node| walked_by[node] == NEW) {
            walked_by[node] = start;
            at = parents[node];
        }
        if let Some(node) = at.filter(|&node| walked_by[node] == start) {
            report.add(
                Code::NodeCycle,
                format!("/nodes/{node}"),
                "is its own ancestor; remove it from the children of one of its descendants",
            );
        }
    }
}

fn scene_roots(root: &Root, parents: &[Option<usize>], report: &mut Report) {
    for (s, scene) in root.scenes.iter().enumerate() {
        for (i, node) in scene.nodes.iter().enumerate() {
            if let Some(Some(parent)) = parents.get(node.value()) {
                report.add(
                    Code::SceneNodeNotRoot,
                    format!("/scenes/{s}/nodes/{i}"),
                    format!("node {node} is a child of node {parent}; a scene lists roots only"),
                );
            }
        }
    }
}

fn transforms(root: &Root, report: &mut Report) {
    for (n, node) in root.nodes.iter().enumerate() {
        let place = |part: &str| format!("/nodes/{n}/{part}");
        let trs = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
        if node.matrix.is_some() && trs {
            report.add(
                Code::NodeMatrixAndTrs,
                place("matrix"),
                "stands beside translation, rotation or scale; keep the one or the others",
            );
        }
        let rotation = node.rotation.map(|rotation| rotation.0);
        let parts = [
            ("matrix", node.matrix.as_ref().map(|m| &m[..])),
            ("translation", node.translation.as_ref().map(|t| &t[..])),
            ("rotation", rotation.as_ref().map(|r| &r[..])),
            ("scale", node.scale.as_ref().map(|s| &s[..])),
        ];
        for (part, numbers) in parts {
            if numbers.is_some_and(|numbers| numbers.iter().any(|x| !x.is_finite())) {
                report.add(Code::NotFinite, place(part), "holds a number beyond the range of float32");
            }
        }
        if let Some(q) = rotation {
            let length = q.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
            if (length - 1.0).abs() > super::rotations::UNIT {
                report.add(
                    Code::NodeRotation,
                    place("rotation"),
                    format!("must be of length 1 and is of length {length:.6}; normalise it"),
                );
            }
        }
    }
}

fn cameras(root: &Root, report: &mut Report) {
    for (c, camera) in root.cameras.iter().enumerate() {
        if let Some(lens) = &camera.perspective {
            let far = lens.zfar.is_none_or(|far| far > lens.znear);
            let above_0 = |x: f32| x > 0.0 && x.is_finite();
            let wide = above_0(lens.yfov) && lens.aspect_ratio.is_none_or(above_0);
            if !(wide && above_0(lens.znear) && far) {
                report.add(
                    Code::InvalidValue,
                    format!("/cameras/{c}/perspective"),
                    "yfov, aspectRatio and znear must be finite and above 0, and zfar beyond znear",
                );
            }
        }
    }
}

fn names<'a>(list: &str, names: impl Iterator<Item = Option<&'a str>>, report: &mut Report) {
    let mut first = HashMap::new();
    for (i, name) in names.enumerate() {
        let Some(name) = name else {
            continue;
        };
        let place = || format!("/{list}/{i}/name");
        if let Some(before) = first.get(name) {
            report.add(
                Code::DuplicateName,
                place(),
                format!("{name:?} is the name of /{list}/{before} too; Blender renames one of them: give each its own"),
            );
        } else {
            first.insert(name, i);
        }
        if name.len() > 63 {
            report.add(
                Code::NameTooLong,
                place(),
                format!("has {} bytes; Blender keeps the first 63", name.len()),
            );
        }
    }
}

//! Animations as the JSON describes them: what moves, by what kind of data.

use std::collections::HashSet;

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::animation::{Animation, Interpolation, Property};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::{Code, Report};

pub(super) fn check(root: &Root, report: &mut Report) {
    for (a, animation) in root.animations.iter().enumerate() {
        let place = format!("/animations/{a}");
        for (list, empty) in
            [("channels", animation.channels.is_empty()), ("samplers", animation.samplers.is_empty())]
        {
            if empty {
                report.add(
                    Code::AnimationEmpty,
                    format!("{place}/{list}"),
                    "must not be empty; leave out an animation that moves nothing",
                );
            }
        }
        targets(root, animation, &place, report);
        for s in 0..animation.samplers.len() {
            sampler(root, animation, s, &format!("{place}/samplers/{s}"), report);
        }
    }
}

fn targets(root: &Root, animation: &Animation, place: &str, report: &mut Report) {
    let mut moved = HashSet::new();
    for (c, channel) in animation.channels.iter().enumerate() {
        let place = format!("{place}/channels/{c}/target");
        let index = channel.target.node;
        let Checked::Valid(path) = channel.target.path else {
            continue;
        };
        let Some(node) = root.get(index) else {
            continue;
        };
        // A property has no hash of its own.
        if !moved.insert((index.value(), path as u8)) {
            report.add(
                Code::ChannelTwice,
                place.clone(),
                format!("another channel of this clip moves the same property of node {index}; keep one"),
            );
        }
        if node.matrix.is_some() && path != Property::MorphTargetWeights {
            report.add(
                Code::AnimatedMatrix,
                place.clone(),
                format!("node {index} has a matrix; give it translation, rotation and scale instead"),
            );
        }
        if path == Property::MorphTargetWeights && targets_of(root, index.value()) == 0 {
            report.add(
                Code::WeightsWithoutTargets,
                place,
                format!("node {index} has no mesh with morph targets whose weights could change"),
            );
        }
    }
}

/// Number of morph targets of a node's mesh.
fn targets_of(root: &Root, node: usize) -> usize {
    let mesh = root.nodes.get(node).and_then(|node| root.get(node.mesh?));
    let primitive = mesh.and_then(|mesh| mesh.primitives.first());
    primitive.and_then(|primitive| primitive.targets.as_ref()).map_or(0, Vec::len)
}

fn sampler(root: &Root, animation: &Animation, index: usize, place: &str, report: &mut Report) {
    let stored = &animation.samplers[index];
    let (Some(input), Some(output)) = (root.get(stored.input), root.get(stored.output)) else {
        return;
    };
    times(input, stored.input, place, report);
    let Checked::Valid(interpolation) = stored.interpolation else {
        return;
    };
    if interpolation == Interpolation::CubicSpline && input.count.0 < 2 {
        report.add(
            Code::CubicsplineOneKey,
            format!("{place}/input"),
            format!("has {} keys, and CUBICSPLINE needs 2; use STEP for a value that stays", input.count.0),
        );
    }
    let mut paths = HashSet::new();
    let channels = animation.channels.iter().filter(|channel| channel.sampler.value() == index);
    for channel in channels {
        let Checked::Valid(path) = channel.target.path else {
            continue;
        };
        // As a rule a sampler has one channel; more may move other things.
        if paths.insert(path as u8) {
            let weights = targets_of(root, channel.target.node.value()) as u64;
            values(output, path, place, report);
            count(input, output, (interpolation, path, weights), place, report);
        }
    }
}

/// There are as many values as keys, or with tangents three times as many.
fn count(
    input: &Accessor,
    output: &Accessor,
    (interpolation, path, weights): (Interpolation, Property, u64),
    place: &str,
    report: &mut Report,
) {
    let per_key = match path {
        Property::MorphTargetWeights => weights,
        _ => 1,
    };
    let per_key = per_key * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let expected = u128::from(input.count.0) * u128::from(per_key);
    if expected != u128::from(output.count.0) && per_key > 0 {
        report.add(
            Code::OutputCount,
            format!("{place}/output"),
            format!(
                "{} keys need {expected} values ({per_key} a key) and there are {}",
                input.count.0, output.count.0
            ),
        );
    }
}

fn times(input: &Accessor, index: Index<Accessor>, place: &str, report: &mut Report) {
    let scalar = input.type_ == Checked::Valid(Type::Scalar);
    if !scalar || component(input) != Some(ComponentType::F32) || input.normalized {
        report.add(
            Code::InputType,
            format!("{place}/input"),
            format!("accessor {index} must hold float32 scalars, the times in seconds"),
        );
    }
    if input.min.is_none() || input.max.is_none() {
        report.add(
            Code::MinMaxMissing,
            format!("{place}/input"),
            format!("accessor {index} must state min and max, its first and last time"),
        );
    }
}

fn values(output: &Accessor, path: Property, place: &str, report: &mut Report) {
    let expected = match path {
        Property::Translation | Property::Scale => Type::Vec3,
        Property::Rotation => Type::Vec4,
        Property::MorphTargetWeights => Type::Scalar,
    };
    let fractions = matches!(path, Property::Rotation | Property::MorphTargetWeights);
    let component = match component(output) {
        Some(ComponentType::F32) => !output.normalized,
        Some(ComponentType::U32) | None => false,
        Some(_) => fractions && output.normalized,
    };
    if output.type_ != Checked::Valid(expected) || !component {
        let or = if fractions { " or normalized 8- or 16-bit integers" } else { "" };
        report.add(
            Code::OutputType,
            format!("{place}/output"),
            format!("must be of type {} and of float32{or} for this property", name(expected)),
        );
    }
}

fn component(accessor: &Accessor) -> Option<ComponentType> {
    match &accessor.component_type {
        Checked::Valid(component) => Some(component.0),
        Checked::Invalid => None,
    }
}

fn name(kind: Type) -> &'static str {
    match kind {
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        _ => "SCALAR",
    }
}

//! Meshes: vertex data of the right types, as many of each, and indices that
//! name vertices that exist.

use std::collections::BTreeMap;

use gltf::json::Root;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

use super::{Code, Report};
use crate::asset::{Asset, Error};

pub(super) fn check(asset: &mut Asset, report: &mut Report) {
    let root = asset.root();
    // How many vertices the indices of an accessor may name, and who says so.
    let mut indexed = BTreeMap::new();
    for (m, mesh) in root.meshes.iter().enumerate() {
        if mesh.primitives.is_empty() {
            report.add(
                Code::InvalidValue,
                format!("/meshes/{m}/primitives"),
                "must not be empty; leave out a mesh that shows nothing",
            );
        }
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("/meshes/{m}/primitives/{p}");
            attributes(root, primitive, &place, report);
            targets(root, primitive, &place, report);
            indices(root, primitive, &place, report);
            if let (Some(indices), Some(vertices)) = (primitive.indices, vertices(root, primitive)) {
                let entry = indexed.entry(indices.value()).or_insert((vertices, place));
                entry.0 = entry.0.min(vertices);
            }
        }
    }
    for (accessor, (vertices, place)) in indexed {
        // What cannot be read has a finding of its own.
        let _ = vertex_indices(asset, accessor, vertices, &place, report);
    }
}

/// The number of a primitive's vertices.
fn vertices(root: &Root, primitive: &Primitive) -> Option<u64> {
    let accessors = primitive.attributes.values().filter_map(|&index| root.get(index));
    accessors.map(|accessor| accessor.count.0).min()
}

fn attributes(root: &Root, primitive: &Primitive, place: &str, report: &mut Report) {
    let quantized = root.extensions_used.iter().any(|name| name == "KHR_mesh_quantization");
    let mut count = None;
    for (semantic, &index) in &primitive.attributes {
        let (Checked::Valid(semantic), Some(accessor)) = (semantic, root.get(index)) else {
            continue;
        };
        let place = format!("{place}/attributes/{}", semantic.to_string());
        if !quantized && !allowed(semantic, accessor) {
            report.add(
                Code::AttributeType,
                place.clone(),
                format!("accessor {index} is not of a type that glTF allows for this attribute"),
            );
        }
        if *semantic == Semantic::Positions && (accessor.min.is_none() || accessor.max.is_none()) {
            report.add(
                Code::MinMaxMissing,
                format!("/accessors/{index}"),
                "positions of vertices must state their min and max; add them",
            );
        }
        let first = *count.get_or_insert(accessor.count.0);
        if accessor.count.0 != first {
            report.add(
                Code::AttributeCount,
                place,
                format!(
                    "has {} elements, and another attribute of the primitive {first}; they must agree",
                    accessor.count.0
                ),
            );
        }
    }
}

/// Morph targets have as many elements as the attributes they move.
fn targets(root: &Root, primitive: &Primitive, place: &str, report: &mut Report) {
    let Some(vertices) = vertices(root, primitive) else {
        return;
    };
    for (t, target) in primitive.targets.iter().flatten().enumerate() {
        let accessors = [target.positions, target.normals, target.tangents];
        let accessors = accessors.into_iter().flatten().filter_map(|index| root.get(index));
        for accessor in accessors.filter(|accessor| accessor.count.0 != vertices) {
            report.add(
                Code::AttributeCount,
                format!("{place}/targets/{t}"),
                format!("has {} elements for {vertices} vertices; they must agree", accessor.count.0),
            );
        }
    }
}

/// The table of section 3.7.2.1 of the specification.
fn allowed(semantic: &Semantic, accessor: &Accessor) -> bool {
    let (Checked::Valid(kind), Checked::Valid(component)) =
        (accessor.type_.as_ref(), accessor.component_type.as_ref())
    else {
        // Said already.
        return true;
    };
    let float = component.0 == ComponentType::F32;
    let small = matches!(component.0, ComponentType::U8 | ComponentType::U16);
    let fraction = float || (small && accessor.normalized);
    match semantic {
        Semantic::Positions | Semantic::Normals => *kind == Type::Vec3 && float,
        Semantic::Tangents => *kind == Type::Vec4 && float,
        Semantic::TexCoords(_) => *kind == Type::Vec2 && fraction,
        Semantic::Colors(_) => matches!(kind, Type::Vec3 | Type::Vec4) && fraction,
        Semantic::Joints(_) => *kind == Type::Vec4 && small && !accessor.normalized,
        Semantic::Weights(_) => *kind == Type::Vec4 && fraction,
        Semantic::Extras(_) => true,
    }
}

fn indices(root: &Root, primitive: &Primitive, place: &str, report: &mut Report) {
    let Some(accessor) = primitive.indices.and_then(|index| root.get(index)) else {
        return;
    };
    let unsigned = match &accessor.component_type {
        Checked::Valid(component) => {
            matches!(component.0, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
        }
        Checked::Invalid => true,
    };
    let scalar = accessor.type_ == Checked::Valid(Type::Scalar);
    if !unsigned || !scalar || accessor.normalized {
        report.add(
            Code::AttributeType,
            format!("{place}/indices"),
            "must be unsigned integer scalars, not normalized",
        );
    }
}

fn vertex_indices(
    asset: &mut Asset,
    accessor: usize,
    vertices: u64,
    place: &str,
    report: &mut Report,
) -> Result<(), Error> {
    const AT_ONCE: usize = 1 << 16;
    let shape = asset.shape(accessor)?;
    let (mut first, mut block) = (0, Vec::new());
    let (mut beyond, mut largest) = (0, 0);
    while first < shape.count {
        let last = shape.count.min(first + AT_ONCE);
        asset.indices_into(&shape, first..last, &mut block)?;
        let too_large = block.iter().filter(|&&index| u64::from(index) >= vertices);
        beyond += too_large.count();
        largest = largest.max(block.iter().copied().max().unwrap_or(0));
        first = last;
    }
    if beyond > 0 {
        report.add(
            Code::VertexIndex,
            format!("{place}/indices"),
            format!(
                "{beyond} of {} indices name vertices beyond the {vertices} there are, up to {largest}",
                shape.count
            ),
        );
    }
    Ok(())
}

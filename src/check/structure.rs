//! The JSON as a whole: version, extensions, required values, and that every
//! index refers to something.

use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::{Checked, Error, Validate};
use gltf::json::{Path, Root};
use serde_json::Value;

use super::{Code, Report};

pub(super) fn check(root: &Root, json: &[u8], report: &mut Report) {
    version(root, report);
    extensions(root, report);
    validate(root, report);
    channels(root, report);
    match serde_json::from_slice(json) {
        Ok(value) => odd_values(&value, report),
        Err(error) => report.add(
            Code::JsonPartlyUnread,
            "",
            format!(
                "not all of it was looked at: {error}; keep values at most 127 deep, and numbers below 1e308"
            ),
        ),
    }
}

fn version(root: &Root, report: &mut Report) {
    let version = &root.asset.version;
    let minor = version.strip_prefix("2.").unwrap_or_default();
    if minor.is_empty() || !minor.bytes().all(|byte| byte.is_ascii_digit()) {
        report.add(
            Code::Version,
            "/asset/version",
            format!("must be \"2.0\" and is {version:?}; convert the file to glTF 2.0"),
        );
    }
    if let Some(least) = root.asset.min_version.as_deref().filter(|&v| v != "2.0") {
        report.add(
            Code::Version,
            "/asset/minVersion",
            format!("asks for viewers of version {least:?}; they know \"2.0\""),
        );
    }
}

fn extensions(root: &Root, report: &mut Report) {
    for (i, name) in root.extensions_required.iter().enumerate() {
        let place = format!("/extensionsRequired/{i}");
        if !root.extensions_used.contains(name) {
            report.add(
                Code::ExtensionUndeclared,
                place.clone(),
                format!("{name:?} must be listed in extensionsUsed as well"),
            );
        }
        report.add(
            Code::ExtensionRequired,
            place,
            format!("viewers without {name:?} refuse the file; leave the extension out where you can"),
        );
    }
}

/// What `gltf-json` itself can tell.
///
/// Its test of a primitive indexes the accessors with whatever POSITION says
/// and would panic, so primitives get here only once that index is known good.
fn validate(root: &Root, report: &mut Report) {
    let mut problem = |path: &dyn Fn() -> Path, error: Error| {
        let path = path();
        note(path.as_str(), error, root, report);
    };
    let at = |name: &'static str| move || Path::new().field(name);
    root.asset.validate(root, at("asset"), &mut problem);
    root.accessors.validate(root, at("accessors"), &mut problem);
    root.animations.validate(root, at("animations"), &mut problem);
    root.buffers.validate(root, at("buffers"), &mut problem);
    root.buffer_views.validate(root, at("bufferViews"), &mut problem);
    root.cameras.validate(root, at("cameras"), &mut problem);
    root.images.validate(root, at("images"), &mut problem);
    root.materials.validate(root, at("materials"), &mut problem);
    root.nodes.validate(root, at("nodes"), &mut problem);
    root.samplers.validate(root, at("samplers"), &mut problem);
    root.scene.validate(root, at("scene"), &mut problem);
    root.scenes.validate(root, at("scenes"), &mut problem);
    root.skins.validate(root, at("skins"), &mut problem);
    root.textures.validate(root, at("textures"), &mut problem);
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let path = || Path::new().field("meshes").index(m).field("primitives").index(p);
            match dangling_position(root, primitive) {
                false => primitive.validate(root, path, &mut problem),
                true => problem(&|| path().field("attributes").key("POSITION"), Error::IndexOutOfBounds),
            }
        }
    }
}

fn dangling_position(root: &Root, primitive: &Primitive) -> bool {
    let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    position.is_some_and(|accessor| accessor.value() >= root.accessors.len())
}

fn note(path: &str, error: Error, root: &Root, report: &mut Report) {
    let place = pointer(path);
    // Not required by glTF 2.0 (or, the bounds of positions, looked at
    // elsewhere): an accessor without data is one of zeros, a texture without
    // image and a primitive without positions may get them by an extension.
    let allowed = error == Error::Missing
        && ((place.starts_with("/accessors/") && place.ends_with("/bufferView"))
            || (place.starts_with("/textures/") && !root.extensions_used.is_empty())
            || place.contains("/attributes/POSITION"));
    let bounds_of_positions = place.contains("/attributes/POSITION/");
    // Strides are judged with the accessors that use them.
    if allowed || bounds_of_positions || place.ends_with("/byteStride") {
        return;
    }
    match error {
        Error::IndexOutOfBounds => report.add(
            Code::IndexOutOfRange,
            place,
            "refers to an object that does not exist; correct the index or add the object",
        ),
        Error::Missing => report.add(Code::MissingValue, place, "is required and missing; add it"),
        Error::Invalid => report.add(
            Code::InvalidValue,
            place,
            "is none of the values that glTF 2.0 allows here; correct it",
        ),
        Error::Oversize => report.add(Code::InvalidValue, place, "is larger than this machine can address"),
        Error::Unsupported => {}
    }
}

/// Targets of channels, which `gltf-json` does not look at.
fn channels(root: &Root, report: &mut Report) {
    for (a, animation) in root.animations.iter().enumerate() {
        for (c, channel) in animation.channels.iter().enumerate() {
            let place = |part: &str| format!("/animations/{a}/channels/{c}/target/{part}");
            let node = channel.target.node.value();
            if node == u32::MAX as usize {
                report.add(
                    Code::ChannelWithoutNode,
                    format!("/animations/{a}/channels/{c}/target"),
                    "names no node; viewers without the extension that tells what moves skip the channel",
                );
            } else {
                if node >= root.nodes.len() {
                    report.add(
                        Code::IndexOutOfRange,
                        place("node"),
                        format!(
                            "moves node {node}, and the file has {}; correct the index",
                            root.nodes.len()
                        ),
                    );
                }
                if channel.target.path == Checked::Invalid {
                    report.add(
                        Code::InvalidValue,
                        place("path"),
                        "must be translation, rotation, scale or weights",
                    );
                }
            }
        }
    }
}

/// A path of `gltf-json`, `a[1].b["c"]`, as a JSON pointer, `/a/1/b/c`.
fn pointer(path: &str) -> String {
    let mut pointer = String::new();
    for part in path.split(['.', '[', ']']).filter(|part| !part.is_empty()) {
        pointer.push('/');
        pointer += &escaped(part.trim_matches('"'));
    }
    pointer
}

/// A name as a part of a JSON pointer.
fn escaped(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// Values that `gltf-json` takes for something else, looked for in the JSON
/// itself: of an index it keeps the low 32 bits, so that 4294967296 would pass
/// for 0; null it takes for a missing value.
fn odd_values(json: &Value, report: &mut Report) {
    let mut open = vec![(String::new(), json, false)];
    while let Some((pointer, value, index)) = open.pop() {
        match value {
            Value::Object(object) => {
                for (key, value) in object.iter().filter(|(key, _)| !is_foreign(key)) {
                    let inside = matches!(key.as_str(), "attributes" | "targets");
                    let index = inside
                        || INDICES.contains(&key.as_str())
                        || (index && pointer.starts_with("/meshes"));
                    open.push((format!("{pointer}/{}", escaped(key)), value, index));
                }
            }
            Value::Array(array) => {
                let items = array.iter().enumerate().filter(|(_, item)| may_be_odd(item));
                open.extend(items.map(|(i, item)| (format!("{pointer}/{i}"), item, index)));
            }
            Value::Number(number) if index && number.as_u64().is_some_and(|n| n > u64::from(u32::MAX)) => {
                let message = format!("is {number}, more than any file has objects; correct it");
                report.add(Code::IndexOutOfRange, pointer, message);
            }
            Value::Null => report.add(
                Code::InvalidValue,
                pointer,
                "is null, which glTF does not know; leave the property out",
            ),
            _ => {}
        }
    }
}

/// Keys whose values are indices, or numbers that stand for a choice.
const INDICES: &[&str] = &[
    "bufferView",
    "buffer",
    "input",
    "output",
    "sampler",
    "node",
    "nodes",
    "children",
    "mesh",
    "skin",
    "camera",
    "scene",
    "source",
    "index",
    "texCoord",
    "material",
    "indices",
    "joints",
    "skeleton",
    "inverseBindMatrices",
    "componentType",
    "target",
    "mode",
    "magFilter",
    "minFilter",
    "wrapS",
    "wrapT",
];

fn is_foreign(key: &str) -> bool {
    matches!(key, "extras" | "extensions")
}

fn may_be_odd(item: &Value) -> bool {
    match item {
        Value::Number(number) => number.as_u64().is_some_and(|n| n > u64::from(u32::MAX)),
        other => other.is_object() || other.is_array() || other.is_null(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_pointers() {
        assert_eq!(pointer("animations[0].samplers[12].input"), "/animations/0/samplers/12/input");
        assert_eq!(
            pointer(r#"meshes[1].primitives[0].attributes["POSITION"]"#),
            "/meshes/1/primitives/0/attributes/POSITION"
        );
        assert_eq!(pointer(""), "");
    }
}

//! What refers to accessors, buffer views and buffers: only what animations alone use
//! may change its place or its content.

use crate::asset::Asset;
use serde_json::Value;
use std::collections::BTreeSet;

use super::Error;

/// What stays as it is, because something else than a sampler refers to it or may do so.
#[derive(Debug, Default)]
pub(super) struct Fixed {
    pub(super) accessors: BTreeSet<usize>,
    /// Buffer views whose bytes are not seen as accessors alone.
    pub(super) views: BTreeSet<usize>,
}

/// Extensions that are known to refer to no accessor, view or buffer.
const HARMLESS: &[&str] = &[
    "KHR_animation_pointer",
    "KHR_lights_",
    "KHR_materials_",
    "KHR_mesh_quantization",
    "KHR_node_",
    "KHR_texture_",
    "KHR_xmp",
    "EXT_lights_",
    "EXT_texture_",
    "MSFT_texture_dds",
];

/// What is fixed; an error where bytes of a buffer may be used in unknown ways.
pub(super) fn fixed(asset: &Asset) -> Result<Fixed, Error> {
    let root = asset.root();
    let mut fixed = Fixed::default();
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    fixed.accessors.extend(primitives.filter_map(|primitive| primitive.indices).map(|i| i.value()));
    fixed
        .accessors
        .extend(root.skins.iter().filter_map(|skin| skin.inverse_bind_matrices).map(|i| i.value()));
    fixed.views.extend(root.images.iter().filter_map(|image| image.buffer_view).map(|i| i.value()));
    // It was parsed before, and its numbers are only looked at here.
    if let Ok(value) = serde_json::from_slice::<Value>(asset.json()) {
        look_for_extensions(&value, &mut String::new(), &mut fixed)?;
    }
    let mut used = BTreeSet::new();
    for accessor in &root.accessors {
        used.extend(accessor.buffer_view.map(|view| view.value()));
        let sparse = accessor.sparse.iter().flat_map(|s| [s.indices.buffer_view, s.values.buffer_view]);
        used.extend(sparse.map(|view| view.value()));
    }
    // What nothing seems to use is left alone.
    fixed.views.extend((0..root.buffer_views.len()).filter(|view| !used.contains(view)));
    Ok(fixed)
}

/// Walks the whole tree; `pointer` says where it is.
fn look_for_extensions(value: &Value, pointer: &mut String, fixed: &mut Fixed) -> Result<(), Error> {
    let length = pointer.len();
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                *pointer += &format!("/{key}");
                match (key.as_str(), value) {
                    ("extras", _) => {}
                    ("extensions", Value::Object(extensions)) => {
                        for (name, extension) in extensions {
                            look_into(name, extension, pointer, fixed)?;
                        }
                    }
                    // Of vertices and of morph targets, under any name.
                    ("attributes" | "targets", accessors) => integers(accessors, &mut fixed.accessors),
                    _ => look_for_extensions(value, pointer, fixed)?,
                }
                pointer.truncate(length);
            }
        }
        Value::Array(elements) => {
            for (i, element) in elements.iter().enumerate() {
                *pointer += &format!("/{i}");
                look_for_extensions(element, pointer, fixed)?;
                pointer.truncate(length);
            }
        }
        _ => {}
    }
    Ok(())
}

/// Whatever could be an index in an extension that is not known counts as one.
fn look_into(name: &str, extension: &Value, pointer: &str, fixed: &mut Fixed) -> Result<(), Error> {
    if HARMLESS.iter().any(|harmless| name.starts_with(harmless)) {
        return Ok(());
    }
    let compressed = name.ends_with("_meshopt_compression");
    let on_bytes = pointer.starts_with("/buffers/") || pointer.starts_with("/bufferViews/");
    if compressed || on_bytes || names_a_buffer(extension) {
        return Err(Error::Extension { pointer: format!("{pointer}/{name}"), compressed });
    }
    integers(extension, &mut fixed.accessors);
    integers(extension, &mut fixed.views);
    if let Some(rest) = pointer.strip_prefix("/accessors/") {
        let index = rest.split('/').next().and_then(|index| index.parse::<usize>().ok());
        fixed.accessors.extend(index);
    }
    Ok(())
}

fn names_a_buffer(value: &Value) -> bool {
    match value {
        Value::Object(members) => {
            members.iter().any(|(key, value)| key == "buffer" || key == "buffers" || names_a_buffer(value))
        }
        Value::Array(elements) => elements.iter().any(names_a_buffer),
        _ => false,
    }
}

/// All numbers that could be an index, those in texts such as `/accessors/5` too.
fn integers(value: &Value, out: &mut BTreeSet<usize>) {
    match value {
        Value::Number(number) => {
            let whole = number.as_f64().filter(|x| *x >= 0.0 && *x < 4e9 && x.fract() == 0.0);
            out.extend(whole.map(|x| x as usize));
        }
        Value::String(text) => out.extend(text.split('/').filter_map(|part| part.parse::<usize>().ok())),
        Value::Array(elements) => elements.iter().for_each(|element| integers(element, out)),
        Value::Object(members) => members.values().for_each(|member| integers(member, out)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn look(value: &Value) -> Result<Fixed, Error> {
        let mut fixed = Fixed::default();
        look_for_extensions(value, &mut String::new(), &mut fixed).map(|()| fixed)
    }

    #[test]
    fn whatever_could_be_an_index_is_fixed() {
        let found = look(&json!({
            "nodes": [{"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 7, "X": 2.0}}}}],
            "extensions": {
                "X_pointer": ["/accessors/5/min", 1.5, -3],
                "KHR_lights_punctual": {"lights": [{"intensity": 9}]},
            },
            "accessors": [{}, {"extensions": {"X_any": {}}}],
            "extras": {"extensions": {"X_none": 11}},
        }));
        let fixed = found.unwrap();
        assert_eq!(fixed.accessors.into_iter().collect::<Vec<_>>(), [1, 2, 5, 7]);
        assert_eq!(fixed.views.into_iter().collect::<Vec<_>>(), [2, 5, 7]);
    }

    #[test]
    fn unknown_uses_of_bytes_are_refused() {
        for (value, place) in [
            (
                json!({"bufferViews": [{}, {"extensions": {"EXT_meshopt_compression": {"buffer": 1}}}]}),
                "/bufferViews/1/extensions/EXT_meshopt_compression",
            ),
            (json!({"buffers": [{"extensions": {"X": {}}}]}), "/buffers/0/extensions/X"),
            (json!({"extensions": {"X": [{"buffer": 0}]}}), "/extensions/X"),
        ] {
            let error = look(&value).unwrap_err().to_string();
            assert!(error.contains(place), "{error}");
        }
    }
}

//! JSON text to the tree of `gltf-json`.

use gltf::json::Root;
use serde_json::Value;

use super::Error;

/// Parses a file's JSON; extensions and odd values are for the check to judge.
pub(super) fn root(json: &[u8]) -> Result<Root, Error> {
    match serde_json::from_slice(json) {
        Ok(root) => Ok(root),
        // Parsing it as a value would keep the last of two properties of one name.
        Err(error) if error.to_string().starts_with("duplicate field") => {
            Err(Error::Schema(error.to_string()))
        }
        Err(error) if error.is_data() => completed(json).ok_or_else(|| Error::Schema(error.to_string())),
        Err(error) => Err(Error::Json(error.to_string())),
    }
}

/// Fills in what glTF lets a file leave out and `gltf-json` insists on.
fn completed(json: &[u8]) -> Option<Root> {
    let mut value: Value = serde_json::from_slice(json).ok()?;
    for scene in items(&mut value, "scenes") {
        fill(scene, "nodes", Value::Array(Vec::new()));
    }
    for animation in items(&mut value, "animations") {
        for channel in items(animation, "channels") {
            // What moves is then named by an extension, unknown here.
            if let Some(target) = channel.get_mut("target") {
                fill(target, "node", Value::from(u32::MAX));
            }
        }
    }
    serde_json::from_value(value).ok()
}

fn items<'a>(value: &'a mut Value, key: &str) -> impl Iterator<Item = &'a mut Value> {
    let array = value.get_mut(key).and_then(Value::as_array_mut);
    array.into_iter().flatten()
}

fn fill(object: &mut Value, key: &str, default: Value) {
    if let Some(object) = object.as_object_mut() {
        object.entry(key).or_insert(default);
    }
}

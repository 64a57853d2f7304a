//! Mutations of JSON that leave it JSON.

use super::dice::Dice;
use serde_json::{Number, Value};

/// Names of members that glTF knows.
const NAMES: [&str; 62] = [
    "accessors",
    "alphaCutoff",
    "alphaMode",
    "animations",
    "asset",
    "aspectRatio",
    "attributes",
    "baseColorFactor",
    "baseColorTexture",
    "buffer",
    "bufferView",
    "bufferViews",
    "buffers",
    "byteLength",
    "byteOffset",
    "byteStride",
    "camera",
    "cameras",
    "channels",
    "children",
    "componentType",
    "count",
    "doubleSided",
    "extensions",
    "extensionsRequired",
    "extensionsUsed",
    "extras",
    "generator",
    "images",
    "indices",
    "input",
    "interpolation",
    "inverseBindMatrices",
    "joints",
    "magFilter",
    "material",
    "materials",
    "matrix",
    "max",
    "mesh",
    "meshes",
    "mimeType",
    "min",
    "mode",
    "name",
    "node",
    "nodes",
    "normalized",
    "output",
    "path",
    "pbrMetallicRoughness",
    "perspective",
    "primitives",
    "rotation",
    "sampler",
    "samplers",
    "scale",
    "scene",
    "scenes",
    "skin",
    "sparse",
    "target",
];

/// Words that glTF knows.
const WORDS: [&str; 24] = [
    "",
    "BLEND",
    "CUBICSPLINE",
    "LINEAR",
    "MASK",
    "MAT2",
    "MAT4",
    "OPAQUE",
    "POSITION",
    "NORMAL",
    "TEXCOORD_0",
    "COLOR_0",
    "SCALAR",
    "STEP",
    "VEC2",
    "VEC3",
    "VEC4",
    "data:application/octet-stream;base64,AAAA",
    "image/png",
    "rotation",
    "scale",
    "translation",
    "weights",
    "../../etc/passwd",
];

/// Changes a text of JSON; one that is broken has a byte changed.
pub fn mutate(text: &mut Vec<u8>, dice: &mut Dice) {
    let Ok(mut root) = serde_json::from_slice::<Value>(text) else {
        let at = dice.below(text.len());
        if let Some(byte) = text.get_mut(at) {
            *byte ^= 1 << dice.below(8);
        }
        return;
    };
    for _ in 0..=dice.below(3) {
        let all = count(&root);
        let (mut from, mut to) = (dice.below(all), dice.below(all));
        let donor = nth(&mut root, &mut from).cloned().unwrap_or_default();
        if let Some(value) = nth(&mut root, &mut to) {
            change(value, donor, dice);
        }
    }
    if let Ok(changed) = serde_json::to_vec(&root) {
        *text = changed;
    }
}

/// How many values there are, those within others included.
fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(members) => members.values().map(count).sum::<usize>(),
        _ => 0,
    }
}

/// The value at a place among all of them; `left` counts down.
fn nth<'a>(value: &'a mut Value, left: &mut usize) -> Option<&'a mut Value> {
    if *left == 0 {
        return Some(value);
    }
    *left -= 1;
    match value {
        Value::Array(items) => items.iter_mut().find_map(|item| nth(item, left)),
        Value::Object(members) => members.values_mut().find_map(|member| nth(member, left)),
        _ => None,
    }
}

fn change(value: &mut Value, donor: Value, dice: &mut Dice) {
    if dice.one_in(8) {
        *value = donor;
        return;
    }
    match value {
        Value::Null => *value = donor,
        Value::Bool(it) => *it = !*it,
        Value::Number(number) => *value = Value::Number(another(number, dice)),
        Value::String(text) => *text = dice.pick(&WORDS).to_owned(),
        Value::Array(items) => change_items(items, donor, dice),
        Value::Object(members) => {
            let names: Vec<String> = members.keys().cloned().collect();
            let some = |dice: &mut Dice| names.get(dice.below(names.len())).cloned();
            match (dice.below(4), some(dice)) {
                (0, Some(name)) => drop(members.remove(&name)),
                (1, Some(name)) => {
                    let copy = members[&name].clone();
                    members.insert(dice.pick(&NAMES).to_owned(), copy);
                }
                (2, Some(name)) => drop(members.insert(name, donor)),
                _ => drop(members.insert(dice.pick(&NAMES).to_owned(), donor)),
            }
        }
    }
}

fn change_items(items: &mut Vec<Value>, donor: Value, dice: &mut Dice) {
    let (at, to) = (dice.below(items.len()), dice.below(items.len()));
    match dice.below(5) {
        0 if !items.is_empty() => drop(items.remove(at)),
        1 if !items.is_empty() => items.insert(to, items[at].clone()),
        2 if !items.is_empty() => items.swap(at, to),
        3 => items.clear(),
        _ => items.push(donor),
    }
}

/// A number near another, or one at the ends of what numbers can be.
fn another(number: &Number, dice: &mut Dice) -> Number {
    const WHOLE: [i64; 14] =
        [0, 1, -1, 2, 3, 4, 255, 5120, 5126, 65_535, 0x7fff_ffff, 0xffff_fffe, 0x1_0000_0000, i64::MAX];
    const BROKEN: [f64; 10] = [0.5, -0.0, 1e-45, 1e-320, 3.4e38, 3.5e38, -1e39, 1e300, f64::MAX, -1e-3];
    let near = number.as_i64().unwrap_or(1);
    match dice.below(6) {
        0 => near.wrapping_add(1).into(),
        1 => near.wrapping_sub(1).into(),
        2 => near.wrapping_mul(dice.pick(&[2, 4, -1, 16, 1 << 24])).into(),
        3 => (dice.below(32) as u64).into(),
        4 => dice.pick(&WHOLE).into(),
        _ => Number::from_f64(dice.pick(&BROKEN)).unwrap_or_else(|| 0.into()),
    }
}

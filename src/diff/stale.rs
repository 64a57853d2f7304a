//! Whether a file says what it would say if it were made again.

use crate::asset::{Asset, Error};
use serde_json::Value;

/// Where two files first differ, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Stale {
    /// JSON Pointer into the older file.
    pub pointer: String,
    /// What it says there, and what it would say.
    pub message: String,
}

/// Compares a file with the same made anew. Numbers may differ by a step of float32 (of
/// normalised integers by one), and stated figures by a hundredth of themselves: that is
/// what another machine's sine may do. The version that wrote a file, and the names of
/// files with its data, do not count.
pub fn stale(old: &mut Asset, new: &mut Asset) -> Result<Option<Stale>, Error> {
    let (was, is) = (plain(old), plain(new));
    if let Some(found) = differ(&was, &is, String::new()) {
        return Ok(Some(found));
    }
    for accessor in 0..new.root().accessors.len() {
        if let Some(found) = data(old, new, accessor)? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// A file's JSON without what does not count.
fn plain(asset: &Asset) -> Value {
    let mut root: Value = serde_json::from_slice(asset.json()).unwrap_or_default();
    root["asset"]["generator"] = Value::Null;
    let list = |root: &mut Value, name: &str, forget: &dyn Fn(&mut Value)| {
        root[name].as_array_mut().into_iter().flatten().for_each(forget);
    };
    list(&mut root, "buffers", &|buffer| buffer["uri"] = Value::Null);
    list(&mut root, "animations", &|animation| {
        if let Some(extras) = animation["extras"].as_object_mut() {
            extras.remove("dat2glb");
        }
    });
    root
}

fn differ(was: &Value, is: &Value, pointer: String) -> Option<Stale> {
    let told = |was: &str, is: &str| {
        Some(Stale { pointer: pointer.clone(), message: format!("{was}, would be {is}") })
    };
    match (was, is) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = b.keys().chain(a.keys().filter(|key| !b.contains_key(*key)));
            keys.into_iter().find_map(|key| {
                let at = format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1"));
                match (a.get(key), b.get(key)) {
                    (Some(a), Some(b)) => differ(a, b, at),
                    (None, _) => Some(Stale { pointer: at, message: "is missing".to_owned() }),
                    (_, None) => Some(Stale { pointer: at, message: "would not be there".to_owned() }),
                }
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().find_map(|(i, (a, b))| differ(a, b, format!("{pointer}/{i}")))
        }
        (Value::Array(a), Value::Array(b)) => told(&format!("has {} items", a.len()), &b.len().to_string()),
        (Value::Number(a), Value::Number(b)) => {
            let (x, y) = (a.as_f64().unwrap_or(f64::NAN), b.as_f64().unwrap_or(f64::NAN));
            let near =
                a == b || alike(x as f32, y as f32) || figure(&pointer) && (x - y).abs() <= 0.01 * y.abs();
            if near { None } else { told(&format!("is {a}"), &b.to_string()) }
        }
        (a, b) if a == b => None,
        (a, b) => told(&format!("is {a}"), &b.to_string()),
    }
}

/// Whether a number is a figure that was found out, not one that was asked for.
fn figure(pointer: &str) -> bool {
    pointer.contains("/extras/") && (pointer.contains("Degrees") || pointer.contains("Units"))
}

/// Whether two numbers are at most a step of float32 apart.
fn alike(a: f32, b: f32) -> bool {
    a == b || a.next_up() == b || a.next_down() == b
}

/// How many numbers are compared at a time.
const BLOCK: usize = 1 << 16;

fn data(old: &mut Asset, new: &mut Asset, accessor: usize) -> Result<Option<Stale>, Error> {
    let shape = new.shape(accessor)?;
    let stored = &new.root().accessors[accessor];
    // Read as float32, neighbouring codes of 16 bits lie this far apart.
    let step = if stored.normalized { 1.5 / 32767.0 } else { 0.0 };
    let (count, each) = (shape.count, shape.components);
    for from in (0..count).step_by(BLOCK) {
        let elements = from..count.min(from + BLOCK);
        let (was, is) = (old.floats(accessor, elements.clone())?, new.floats(accessor, elements)?);
        let near = |a: f32, b: f32| alike(a, b) || (a - b).abs() <= step;
        if let Some(i) = was.iter().zip(&is).position(|(&a, &b)| !near(a, b)) {
            let (element, component) = (from + i / each, i % each);
            let message =
                format!("number {component} of element {element} is {}, would be {}", was[i], is[i]);
            return Ok(Some(Stale { pointer: format!("/accessors/{accessor}"), message }));
        }
    }
    Ok(None)
}

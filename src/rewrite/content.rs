//! What an accessor holds from now on, as bytes and as JSON.

use super::json::Changes;
use super::layout::Place;
use super::plan::Change;
use super::track::Stored;
use crate::asset::play::Property;
use rayon::prelude::*;

/// Times and values of all changes.
pub(super) fn contents(changes: &[Change]) -> Vec<(Content, Content)> {
    let content = |Change { sampler, found }: &Change| {
        let (kind, components) = match sampler.property {
            Property::Rotation => ("VEC4", 4),
            Property::Translation | Property::Scale => ("VEC3", 3),
            Property::MorphTargetWeights => ("SCALAR", 1),
        };
        let values = Content::new(kind, components, found.stored, &found.values);
        (Content::times(&found.times), values)
    };
    changes.par_iter().map(content).collect()
}

/// What an accessor holds from now on.
#[derive(Clone, Debug)]
pub(super) struct Content {
    /// Times of keys, not values.
    times: bool,
    kind: &'static str,
    stored: Stored,
    count: usize,
    /// As JSON, number by number.
    min: String,
    max: String,
    pub(super) bytes: Vec<u8>,
}

impl Content {
    fn times(times: &[f32]) -> Content {
        Content { times: true, ..Content::new("SCALAR", 1, Stored::FLOATS, times) }
    }

    fn new(kind: &'static str, components: usize, stored: Stored, numbers: &[f32]) -> Content {
        let (mut least, mut most) = (vec![f32::INFINITY; components], vec![f32::NEG_INFINITY; components]);
        for element in numbers.chunks_exact(components) {
            for ((&x, least), most) in element.iter().zip(&mut least).zip(&mut most) {
                (*least, *most) = (least.min(x), most.max(x));
            }
        }
        let list = |bounds: Vec<f32>| {
            let all: Vec<String> = bounds.into_iter().map(|x| stored.as_json(x)).collect();
            format!("[{}]", all.join(","))
        };
        Content {
            times: false,
            kind,
            stored,
            count: numbers.len() / components,
            min: list(least),
            max: list(most),
            bytes: stored.bytes(numbers),
        }
    }

    /// Changes an accessor that was there; bounds stay where they were stated.
    pub(super) fn describe(&self, accessor: &mut Changes, bounds: bool) {
        accessor.set("componentType", self.stored.component.as_gl_enum());
        accessor.set("count", self.count);
        let mut optional = |key, value: Option<&str>| match value {
            Some(value) => accessor.set(key, value),
            None => accessor.remove(key),
        };
        optional("normalized", self.stored.normalized.then_some("true"));
        let bounds = bounds || self.times;
        optional("min", bounds.then_some(&self.min));
        optional("max", bounds.then_some(&self.max));
        optional("sparse", None);
    }

    /// A new accessor.
    pub(super) fn accessor(&self, place: &Place) -> String {
        let offset =
            if place.offset == 0 { String::new() } else { format!("\"byteOffset\":{},", place.offset) };
        let normalized = if self.stored.normalized { "\"normalized\":true," } else { "" };
        let (min, max) = (&self.min, &self.max);
        let bounds = if self.times { format!(",\"min\":{min},\"max\":{max}") } else { String::new() };
        format!(
            "{{\"bufferView\":{},{offset}\"componentType\":{},{normalized}\"count\":{},\"type\":\"{}\"{bounds}}}",
            place.view,
            self.stored.component.as_gl_enum(),
            self.count,
            self.kind,
        )
    }

    /// What two accessors that are one have in common, before their bytes are compared.
    pub(super) fn kind(&self) -> Kind {
        (self.times, self.kind, self.stored.component.as_gl_enum(), self.bytes.len())
    }
}

/// Use, type, component type and length.
pub(super) type Kind = (bool, &'static str, u32, usize);

impl Stored {
    /// A number as it is stored, as JSON.
    fn as_json(self, x: f32) -> String {
        let bytes = self.bytes(&[x]);
        match (self == Stored::FLOATS, &bytes[..]) {
            (true, _) => serde_json::Value::from(f64::from(x)).to_string(),
            (_, &[a]) if x < 0.0 => a.cast_signed().to_string(),
            (_, &[a]) => a.to_string(),
            (_, &[a, b]) if x < 0.0 => i16::from_le_bytes([a, b]).to_string(),
            (_, &[a, b]) => u16::from_le_bytes([a, b]).to_string(),
            (_, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]).to_string(),
            _ => x.to_string(),
        }
    }
}

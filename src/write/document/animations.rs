//! Clips: channels, samplers, and what they are made from.

use super::{Builder, Data, exact};
use gltf_json::accessor::{ComponentType, Type};
use gltf_json::validation::Checked;
use gltf_json::{self as json, Index};
use serde_json::value::RawValue;
use std::collections::HashMap;

/// One clip of a file.
#[derive(Clone, Debug)]
pub struct Animation {
    /// Unique in the file.
    pub name: String,
    /// What it was made from and how, as JSON.
    pub extras: String,
    /// At most one for a node and property.
    pub channels: Vec<Channel>,
}

/// One property of one node over time.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// Index into the scene's nodes.
    pub node: usize,
    /// What of the node changes.
    pub property: Property,
    /// What happens between samples.
    pub interpolation: Interpolation,
    /// What numbers the values are.
    pub component: Component,
    /// Times of the samples; channels with equal times share them.
    pub times: Data,
    /// The first and the last time.
    pub span: [f32; 2],
    /// The values; channels with equal values share them.
    pub values: Data,
}

/// What numbers values are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Component {
    /// float32.
    F32,
    /// Whole numbers of 16 bits, 32767 being 1.
    I16,
}

/// What happens between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The straight or shortest way from one to the next, at constant speed.
    Linear,
    /// Each lasts until the next.
    Step,
    /// Hermite's cubic; a sample is tangent in, value, tangent out.
    CubicSpline,
}

/// What of a node changes over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// x y z w.
    Rotation,
    /// x y z.
    Translation,
    /// Along x, y and z.
    Scale,
}

impl Property {
    /// Numbers a sample.
    pub fn numbers(self) -> u64 {
        match self {
            Property::Rotation => 4,
            Property::Translation | Property::Scale => 3,
        }
    }

    fn kind(self) -> Type {
        match self {
            Property::Rotation => Type::Vec4,
            Property::Translation | Property::Scale => Type::Vec3,
        }
    }

    fn target(self) -> json::animation::Property {
        match self {
            Property::Rotation => json::animation::Property::Rotation,
            Property::Translation => json::animation::Property::Translation,
            Property::Scale => json::animation::Property::Scale,
        }
    }
}

impl Builder {
    pub(super) fn animations(&mut self, animations: &[Animation]) {
        let view = self.view(self.data_start, self.length - self.data_start, None, None);
        let (mut shared_times, mut shared_values) = (HashMap::new(), HashMap::new());
        for animation in animations {
            let mut channels = Vec::new();
            let mut samplers = Vec::new();
            for channel in &animation.channels {
                let Channel { times, values, property, interpolation, .. } = *channel;
                let input = *shared_times.entry(times).or_insert_with(|| {
                    let range = channel.span.map(|t| json::Value::from(vec![exact(t)]));
                    self.accessor(view, self.within(times), Type::Scalar, ComponentType::F32, Some(range))
                });
                let key = (values, property.numbers(), channel.component);
                let output = *shared_values.entry(key).or_insert_with(|| {
                    let component = match channel.component {
                        Component::F32 => ComponentType::F32,
                        Component::I16 => ComponentType::I16,
                    };
                    let made = self.accessor(view, self.within(values), property.kind(), component, None);
                    self.root.accessors[made.value()].normalized = channel.component == Component::I16;
                    made
                });
                channels.push(target(channel, samplers.len()));
                samplers.push(json::animation::Sampler {
                    input,
                    output,
                    interpolation: Checked::Valid(match interpolation {
                        Interpolation::Linear => json::animation::Interpolation::Linear,
                        Interpolation::Step => json::animation::Interpolation::Step,
                        Interpolation::CubicSpline => json::animation::Interpolation::CubicSpline,
                    }),
                    extensions: None,
                    extras: None,
                });
            }
            self.root.push(json::Animation {
                name: Some(animation.name.clone()),
                channels,
                samplers,
                extensions: None,
                extras: Some(RawValue::from_string(animation.extras.clone()).expect("extras are JSON")),
            });
        }
    }

    /// Data of the buffer as the animations' view counts it.
    fn within(&self, data: Data) -> Data {
        Data { offset: data.offset - self.data_start, ..data }
    }
}

fn target(channel: &Channel, sampler: usize) -> json::animation::Channel {
    json::animation::Channel {
        sampler: Index::new(sampler as u32),
        target: json::animation::Target {
            node: Index::new(channel.node as u32),
            path: Checked::Valid(channel.property.target()),
            extensions: None,
            extras: None,
        },
        extensions: None,
        extras: None,
    }
}

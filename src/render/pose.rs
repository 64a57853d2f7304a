//! Where everything stands at one time of a clip.

use super::load::Model;
use crate::asset::play::{Clip, Player, Property};
use crate::asset::{Asset, Error};
use glam::{DMat4, DQuat, DVec3};
use gltf::json;
use std::collections::HashMap;

/// How a node stands to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Local {
    /// Scaled first, then turned, then moved.
    Steps {
        translation: DVec3,
        rotation: DQuat,
        scale: DVec3,
    },
    Matrix(DMat4),
}

impl Local {
    pub(crate) fn of(node: &json::Node) -> Self {
        if let Some(matrix) = node.matrix {
            return Local::Matrix(DMat4::from_cols_array(&matrix.map(f64::from)));
        }
        let three = |v: Option<[f32; 3]>, default| v.map_or(default, |v| v.map(f64::from).into());
        let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
        Local::Steps {
            translation: three(node.translation, DVec3::ZERO),
            rotation: DQuat::from_array(rotation),
            scale: three(node.scale, DVec3::ONE),
        }
    }

    fn matrix(self) -> DMat4 {
        match self {
            Local::Matrix(matrix) => matrix,
            Local::Steps { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }

    /// Replaces one step. A matrix, which glTF does not allow to be animated,
    /// is taken apart for it.
    fn set(&mut self, property: Property, value: &[f64]) {
        if let Local::Matrix(matrix) = *self {
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            *self = Local::Steps { translation, rotation, scale };
        }
        let Local::Steps { translation, rotation, scale } = self else {
            return;
        };
        match (property, value) {
            (Property::Translation, [x, y, z]) => *translation = DVec3::new(*x, *y, *z),
            (Property::Scale, [x, y, z]) => *scale = DVec3::new(*x, *y, *z),
            (Property::Rotation, [x, y, z, w]) => *rotation = DQuat::from_xyzw(*x, *y, *z, *w),
            _ => {}
        }
    }
}

/// Where each node of a model stands, in the world.
#[derive(Clone, Debug)]
pub(crate) struct Pose(Vec<DMat4>);

impl Pose {
    /// Nothing moves.
    pub(crate) fn rest(model: &Model) -> Self {
        Self::of(model, &model.nodes.iter().map(|node| node.rest).collect::<Vec<_>>())
    }

    /// The model at `t` seconds of a clip.
    pub(crate) fn at(
        model: &Model,
        asset: &mut Asset,
        clip: &Clip,
        player: &mut Player,
        t: f64,
    ) -> Result<Self, Error> {
        let place: HashMap<usize, usize> =
            model.nodes.iter().enumerate().map(|(place, node)| (node.index, place)).collect();
        let mut locals: Vec<Local> = model.nodes.iter().map(|node| node.rest).collect();
        for channel in &clip.channels {
            // Weights of morph targets are not drawn, nor nodes of no scene.
            if channel.property == Property::MorphTargetWeights {
                continue;
            }
            if let Some(place) = place.get(&channel.node) {
                let value = player.value(asset, channel, t)?;
                locals[*place].set(channel.property, &value);
            }
        }
        Ok(Self::of(model, &locals))
    }

    fn of(model: &Model, locals: &[Local]) -> Self {
        let mut world: Vec<DMat4> = Vec::with_capacity(locals.len());
        for (node, local) in model.nodes.iter().zip(locals) {
            let matrix = local.matrix();
            world.push(match node.parent {
                Some(parent) => world[parent] * matrix,
                None => matrix,
            });
        }
        Pose(world)
    }

    /// Where a node stands, by its place in the model.
    pub(crate) fn node(&self, place: usize) -> DMat4 {
        self.0.get(place).copied().unwrap_or_default()
    }

    /// No node stands anywhere.
    pub(crate) fn nothing() -> Self {
        Pose(Vec::new())
    }

    /// Each part that is shown, and the way from its mesh to the world.
    pub(crate) fn placed<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = (usize, DMat4)> + 'a {
        let nodes = model.nodes.iter().zip(&self.0);
        nodes.flat_map(|(node, world)| node.parts.iter().map(|part| (*part, *world)))
    }

    /// The corners of the boxes around all parts, in the world.
    pub(crate) fn corners<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = DVec3> + 'a {
        self.boxes(model).flatten()
    }

    /// The corners of the largest box around a part.
    pub(crate) fn largest(&self, model: &Model) -> Option<[DVec3; 8]> {
        // The first and the last corner lie opposite each other.
        let size = |corners: &[DVec3; 8]| corners[0].distance(corners[7]);
        self.boxes(model)
            .filter(|corners| size(corners).is_finite())
            .max_by(|a, b| size(a).total_cmp(&size(b)))
    }

    /// The corners of the box around each part that has anything to draw.
    pub(crate) fn boxes<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = [DVec3; 8]> + 'a {
        let drawn = |part: &usize| !model.parts[*part].indices.is_empty();
        self.placed(model).filter(move |(part, _)| drawn(part)).map(|(part, world)| {
            let corners = model.parts[part].corners();
            corners.map(|corner| world.transform_point3(corner))
        })
    }
}

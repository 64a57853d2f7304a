//! A file as it stands in the world at a time.

use dat2glb::asset::play::{Clip, Player, Property};
use dat2glb::asset::{Asset, NoFiles};
use glam::{DMat4, DQuat, DVec3};
use std::fs::File;
use std::path::Path;

/// A file whose first clip is played.
pub(crate) struct Stage {
    pub(crate) asset: Asset,
    pub(crate) clip: Clip,
    player: Player,
}

impl Stage {
    pub(crate) fn open(path: &Path) -> Stage {
        let mut asset = Asset::open(Box::new(File::open(path).unwrap()), Box::new(NoFiles)).unwrap();
        let clip = asset.clips().remove(0);
        Stage { asset, clip, player: Player::new() }
    }

    /// Names of all nodes.
    pub(crate) fn names(&self) -> Vec<String> {
        self.asset.root().nodes.iter().map(|node| node.name.clone().unwrap()).collect()
    }

    fn index(&self, name: &str) -> usize {
        self.names().iter().position(|n| n == name).unwrap_or_else(|| panic!("no node {name}"))
    }

    /// A node's way from its own axes to the world's at a time.
    pub(crate) fn world(&mut self, name: &str, t: f64) -> DMat4 {
        let mut node = Some(self.index(name));
        let mut world = DMat4::IDENTITY;
        while let Some(index) = node {
            world = self.local(index, t) * world;
            let nodes = &self.asset.root().nodes;
            let is_parent = |n: &gltf::json::Node| n.children.iter().flatten().any(|c| c.value() == index);
            node = nodes.iter().position(is_parent);
        }
        world
    }

    fn local(&mut self, index: usize, t: f64) -> DMat4 {
        let stored = &self.asset.root().nodes[index];
        let mut translation = stored.translation.unwrap_or_default().map(f64::from);
        let mut rotation = stored.rotation.unwrap_or_default().0.map(f64::from);
        let mut scale = stored.scale.unwrap_or([1.0; 3]).map(f64::from);
        for channel in self.clip.channels.iter().filter(|channel| channel.node == index) {
            let value = self.player.value(&mut self.asset, channel, t).unwrap();
            match channel.property {
                Property::Translation => translation.copy_from_slice(&value),
                Property::Rotation => rotation.copy_from_slice(&value),
                Property::Scale => scale.copy_from_slice(&value),
                Property::MorphTargetWeights => {}
            }
        }
        let rotation = DQuat::from_array(rotation).normalize();
        DMat4::from_scale_rotation_translation(scale.into(), rotation, translation.into())
    }

    pub(crate) fn place(&mut self, name: &str, t: f64) -> DVec3 {
        self.world(name, t).w_axis.truncate()
    }

    /// Where an axis of a node points.
    pub(crate) fn axis(&mut self, name: &str, axis: DVec3, t: f64) -> DVec3 {
        self.world(name, t).transform_vector3(axis).normalize()
    }

    /// Angle, degrees, between where a camera looks and a point.
    pub(crate) fn off_target(&mut self, camera: &str, target: DVec3, t: f64) -> f64 {
        let way = target - self.place(camera, t);
        self.axis(camera, DVec3::NEG_Z, t).angle_between(way).to_degrees()
    }
}

//! Cameras of a file, and the view through one of them.

use super::frame::{Frame, Lens};
use super::load::Node;
use glam::{DMat3, DMat4, DVec3};
use gltf::json::{self, Root};

/// A camera of the scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Camera {
    /// Index into the model's nodes.
    pub node: usize,
    /// The node's name and the camera's own, as far as they have any.
    pub names: [Option<String>; 2],
    projection: Projection,
}

/// What the file says of a camera's lens.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Projection {
    Perspective { yfov: f64, aspect: Option<f64>, near: f64, far: Option<f64> },
    Orthographic { half: (f64, f64), near: f64, far: f64 },
}

impl Camera {
    /// The cameras of a scene's nodes, but those whose numbers make no sense.
    pub(crate) fn all(root: &Root, nodes: &[Node]) -> Vec<Camera> {
        let camera = |(place, node): (usize, &Node)| {
            let stored = &root.nodes[node.index];
            let camera = root.cameras.get(stored.camera?.value())?;
            let projection = Projection::of(camera)?;
            Some(Camera { node: place, names: [stored.name.clone(), camera.name.clone()], projection })
        };
        nodes.iter().enumerate().filter_map(camera).collect()
    }

    /// Width by height of the picture that the file has in mind.
    pub(crate) fn aspect(&self) -> Option<f64> {
        match self.projection {
            Projection::Perspective { aspect, .. } => aspect,
            Projection::Orthographic { half, .. } => Some(half.0 / half.1),
        }
    }

    /// The view through the camera, whose node stands so in the world, as a
    /// picture of this size: nothing is stretched or cut off, what a picture of
    /// another shape has room for beside or above is seen too.
    pub(crate) fn frame(&self, world: DMat4, size: (u32, u32)) -> Frame {
        let turn = axes(world).transpose();
        let eye = turn * world.w_axis.truncate();
        let picture = f64::from(size.0) / f64::from(size.1);
        let fit = |(x, y): (f64, f64)| if picture >= x / y { (y * picture, y) } else { (x, x / picture) };
        let (lens, distance) = match self.projection {
            Projection::Perspective { yfov, aspect, near, far } => {
                let up = libm::tan(yfov / 2.0);
                let tan = fit((up * aspect.unwrap_or(picture), up));
                (Lens::Perspective { tan, near, far }, near)
            }
            Projection::Orthographic { half, near, far } => {
                (Lens::Orthographic { half: fit(half), near, far }, 1.0)
            }
        };
        Frame { turn, eye, lens, distance }
    }
}

impl Projection {
    fn of(camera: &json::Camera) -> Option<Self> {
        let positive = |x: f64| (x.is_finite() && x > 0.0).then_some(x);
        if let Some(lens) = &camera.perspective {
            let near = positive(lens.znear.into())?;
            return Some(Projection::Perspective {
                yfov: positive(lens.yfov.into()).filter(|angle| *angle < std::f64::consts::PI)?,
                aspect: lens.aspect_ratio.and_then(|ratio| positive(ratio.into())),
                near,
                far: lens.zfar.map(f64::from).filter(|far| far.is_finite() && *far > near),
            });
        }
        let lens = camera.orthographic.as_ref()?;
        let (near, far) = (f64::from(lens.znear), f64::from(lens.zfar));
        let half = (positive(lens.xmag.abs().into())?, positive(lens.ymag.abs().into())?);
        (near.is_finite() && far.is_finite() && far > near).then_some(Projection::Orthographic {
            half,
            near,
            far,
        })
    }
}

/// A node's axes without their scale, which cameras ignore (glTF 2.0, 3.10.2).
fn axes(world: DMat4) -> DMat3 {
    let m = DMat3::from_mat4(world);
    let back = m.z_axis.try_normalize().unwrap_or(DVec3::Z);
    let right = m.y_axis.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    DMat3::from_cols(right, back.cross(right), back)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn camera(aspect: Option<f64>) -> Camera {
        let projection = Projection::Perspective { yfov: 0.8, aspect, near: 0.1, far: Some(100.0) };
        Camera { node: 0, names: [None, None], projection }
    }

    #[test]
    fn the_point_looked_at_falls_in_the_middle_whatever_the_nodes_scale() {
        let turn = DQuat::from_xyzw(0.1, 0.3, -0.2, 0.9).normalize();
        let at = DVec3::new(3.0, -2.0, 5.0);
        let target = at + turn * DVec3::new(0.0, 0.0, -7.0);
        let above = target + turn * DVec3::Y;
        for scale in [DVec3::ONE, DVec3::new(2.0, 3.0, 0.5)] {
            let world = DMat4::from_scale_rotation_translation(scale, turn, at);
            for (size, aspect) in [((640, 480), None), ((100, 400), Some(1.5)), ((400, 100), Some(1.5))] {
                let frame = camera(aspect).frame(world, size);
                let (x, y) = frame.on_picture(target, size).unwrap();
                assert!((x * 2.0 - f64::from(size.0)).abs() < 1e-6, "{size:?}");
                assert!((y * 2.0 - f64::from(size.1)).abs() < 1e-6, "{size:?}");
                let (over, up) = frame.on_picture(above, size).unwrap();
                assert!((over - x).abs() < 1e-6 && up < y, "{size:?}");
                assert!((frame.depth(target) - 7.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn all_of_the_cameras_field_is_in_pictures_of_any_shape() {
        let tan = (0.8_f64 / 2.0).tan();
        for (size, expected) in [
            ((300, 200), (1.5 * tan, tan)),
            ((200, 200), (1.5 * tan, 1.5 * tan)),
            ((600, 200), (3.0 * tan, tan)),
        ] {
            let Lens::Perspective { tan, .. } = camera(Some(1.5)).frame(DMat4::IDENTITY, size).lens else {
                panic!("another lens");
            };
            assert!((tan.0 - expected.0).abs() < 1e-12 && (tan.1 - expected.1).abs() < 1e-12, "{size:?}");
        }
    }
}

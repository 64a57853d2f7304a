//! A camera: where it stands, how it is turned, what its lens takes in.

use glam::{DMat3, DMat4, DVec3, Vec3};

/// What a picture is seen through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// From the world's axes to the camera's: right, up, towards the viewer.
    pub turn: DMat3,
    /// Where the camera stands, in its own axes.
    pub eye: DVec3,
    pub lens: Lens,
    /// About the distance of what is looked at; keeps clip space near 1.
    pub distance: f64,
}

/// How what is before a camera falls on the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Lens {
    /// What is far is small.
    Perspective {
        /// Half the width and height of what is in view, at distance 1.
        tan: (f64, f64),
        near: f64,
        /// Without it there is no far plane.
        far: Option<f64>,
    },
    /// Everything keeps its size.
    Orthographic {
        /// Half the width and height of what is in view.
        half: (f64, f64),
        near: f64,
        far: f64,
    },
}

impl Frame {
    /// From the coordinates that `world` starts from to clip space, depth
    /// reversed: 1 at the near plane, 0 at the far one. A floating-point depth
    /// buffer so resolves every distance equally well.
    pub(crate) fn clip(&self, world: DMat4) -> DMat4 {
        let view = DMat4::from_translation(-self.eye) * DMat4::from_mat3(self.turn) * world;
        self.lens.projection(1.0 / self.distance) * view
    }

    /// The world's +Y in the camera's axes.
    pub(crate) fn up(&self) -> Vec3 {
        self.turn.y_axis.as_vec3()
    }

    /// How far before the camera a point of the world lies.
    pub(crate) fn depth(&self, point: DVec3) -> f64 {
        self.eye.z - (self.turn * point).z
    }

    /// From a point of the world to the camera, of length 1.
    pub(crate) fn towards_eye(&self, point: DVec3) -> DVec3 {
        let way = match self.lens {
            Lens::Perspective { .. } => self.eye - self.turn * point,
            Lens::Orthographic { .. } => DVec3::Z,
        };
        self.turn.transpose() * way.try_normalize().unwrap_or(DVec3::Z)
    }

    /// The width of a pixel at a point of the world, for a picture so many
    /// pixels high; at the near plane for points before it.
    pub(crate) fn pixel(&self, point: DVec3, height: u32) -> f64 {
        let half_height = match self.lens {
            Lens::Perspective { tan, near, .. } => tan.1 * self.depth(point).max(near),
            Lens::Orthographic { half, .. } => half.1,
        };
        2.0 * half_height / f64::from(height.max(1))
    }

    /// Where a point of the world falls on a picture, pixels right and down
    /// from its corner; `None` behind the camera.
    pub(crate) fn on_picture(&self, point: DVec3, (width, height): (u32, u32)) -> Option<(f64, f64)> {
        let clip = self.clip(DMat4::IDENTITY) * point.extend(1.0);
        let (x, y) = (clip.x / clip.w, clip.y / clip.w);
        let place = ((0.5 + 0.5 * x) * f64::from(width), (0.5 - 0.5 * y) * f64::from(height));
        (clip.w > 0.0 && x.is_finite() && y.is_finite()).then_some(place)
    }

    /// The same view of the world turned about an upright axis through `centre`
    /// by so many radians, the camera going the other way round.
    pub(crate) fn turned(&self, centre: DVec3, angle: f64) -> Frame {
        let about = DMat3::from_rotation_y(angle);
        let shift = self.turn * (centre - about * centre);
        Frame { turn: self.turn * about, eye: self.eye - shift, ..*self }
    }
}

impl Lens {
    fn projection(&self, unit: f64) -> DMat4 {
        let (scale, depth) = match *self {
            Lens::Perspective { tan, near, far } => {
                let depth = match far {
                    None => (0.0, near * unit),
                    Some(far) => (near / (far - near) * unit, near * far / (far - near) * unit),
                };
                ((unit / tan.0, unit / tan.1), depth)
            }
            Lens::Orthographic { half, near, far } => {
                ((1.0 / half.0, 1.0 / half.1), (1.0 / (far - near), far / (far - near)))
            }
        };
        let (w, one) = match self {
            Lens::Perspective { .. } => (-unit, 0.0),
            Lens::Orthographic { .. } => (0.0, 1.0),
        };
        DMat4::from_cols(
            DVec3::X.extend(0.0) * scale.0,
            DVec3::Y.extend(0.0) * scale.1,
            DVec3::new(0.0, 0.0, depth.0).extend(w),
            DVec3::new(0.0, 0.0, depth.1).extend(one),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looking_along_minus_z(lens: Lens) -> Frame {
        Frame { turn: DMat3::IDENTITY, eye: DVec3::new(1.0, 2.0, 3.0), lens, distance: 5.0 }
    }

    fn project(frame: &Frame, point: DVec3) -> DVec3 {
        frame.clip(DMat4::IDENTITY).project_point3(point)
    }

    #[test]
    fn lenses_map_their_planes_and_edges_to_the_ends_of_clip_space() {
        let tan = (0.5, 0.25);
        for (lens, edge, far) in [
            (Lens::Perspective { tan, near: 2.0, far: Some(8.0) }, DVec3::new(1.0, 0.5, -2.0), 8.0),
            (Lens::Perspective { tan, near: 2.0, far: None }, DVec3::new(1.0, 0.5, -2.0), 1e30),
            (Lens::Orthographic { half: (3.0, 4.0), near: 2.0, far: 8.0 }, DVec3::new(3.0, 4.0, -2.0), 8.0),
        ] {
            let frame = looking_along_minus_z(lens);
            let near = project(&frame, frame.eye + edge);
            assert!((near - DVec3::ONE).length() < 1e-12, "{lens:?}: {near}");
            let away = project(&frame, frame.eye + DVec3::new(0.0, 0.0, -far));
            assert!(away.length() < 1e-12, "{lens:?}: {away}");
        }
    }

    #[test]
    fn a_pixel_is_as_wide_as_two_points_that_fall_a_pixel_apart() {
        let size = (400, 200);
        for lens in [
            Lens::Perspective { tan: (0.5, 0.25), near: 0.1, far: None },
            Lens::Orthographic { half: (4.0, 2.0), near: 0.1, far: 99.0 },
        ] {
            let frame = looking_along_minus_z(lens);
            let point = DVec3::new(0.3, 1.0, -7.0);
            let beside = point + DVec3::X * frame.pixel(point, size.1);
            let [a, b] = [point, beside].map(|p| frame.on_picture(p, size).unwrap());
            assert!((b.0 - a.0 - 1.0).abs() < 1e-9 && (b.1 - a.1).abs() < 1e-9, "{lens:?}");
        }
    }

    #[test]
    fn a_turn_keeps_the_axis_in_place_and_a_whole_one_everything() {
        let lens = Lens::Perspective { tan: (0.5, 0.5), near: 0.1, far: None };
        let frame = looking_along_minus_z(lens);
        let centre = DVec3::new(4.0, 0.0, -6.0);
        let quarter = frame.turned(centre, std::f64::consts::FRAC_PI_2);
        let (here, there) = (project(&frame, centre + DVec3::Y), project(&quarter, centre + DVec3::Y));
        assert!((here - there).length() < 1e-12);
        // What was in front of the axis is now on its right.
        let front = project(&quarter, centre + DVec3::Z);
        assert!((front - project(&frame, centre + DVec3::X)).length() < 1e-12);
        let whole = frame.turned(centre, std::f64::consts::TAU);
        assert!((project(&whole, DVec3::ZERO) - project(&frame, DVec3::ZERO)).length() < 1e-9);
    }
}

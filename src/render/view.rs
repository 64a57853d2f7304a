//! How pictures look, and where they are seen from, the same for all times.

use super::background::Background;
use super::camera::Camera;
use super::floor::Floor;
use super::frame::Frame;
use super::framing::Framing;
use super::pose::Pose;
use glam::DVec3;

/// How pictures look, whatever they show.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Pixels across and down, each 1 to [`MOST_PIXELS`](super::MOST_PIXELS); of one cell
    /// where a picture has several.
    pub size: (u32, u32),
    /// What lies behind.
    pub background: Background,
    /// The camera of the file to look through, by its node's name or its own;
    /// without one pictures are framed so that the whole clip stays in view.
    pub camera: Option<String>,
    /// Whether to draw a grid on the ground and a cross of axes.
    pub floor: bool,
}

impl Default for Style {
    fn default() -> Self {
        Style { size: (512, 512), background: Background::Studio, camera: None, floor: false }
    }
}

/// Where clips are seen from, and the ground they stand on.
#[derive(Clone, Debug)]
pub(super) struct View {
    pub style: Style,
    eye: Eye,
    floor: Option<Floor>,
}

#[derive(Clone, Debug)]
enum Eye {
    /// Where it sees all, turned about an upright axis through `centre`.
    Studio {
        frame: Frame,
        centre: DVec3,
    },
    Camera(Camera),
}

impl View {
    /// The view that takes in all points that `sweep` hands out; with
    /// `turntable` from all sides.
    pub(super) fn new<E>(
        style: &Style,
        camera: Option<Camera>,
        turntable: bool,
        mut sweep: impl FnMut(&mut dyn FnMut(DVec3)) -> Result<(), E>,
    ) -> Result<View, E> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut framing = Framing::new(style.size);
        sweep(&mut |point| {
            if point.is_finite() {
                (low, high) = (low.min(point), high.max(point));
            }
            framing.add(point);
        })?;
        let centre = (low + high) / 2.0;
        if turntable && centre.is_finite() {
            let mut radius = 0.0_f64;
            sweep(&mut |point| {
                let out = (point - centre).with_y(0.0).length();
                radius = if out.is_finite() { radius.max(out) } else { radius };
            })?;
            rim(centre, radius).for_each(|p| [low.y, high.y].iter().for_each(|y| framing.add(p.with_y(*y))));
        }
        let eye = match camera {
            Some(camera) => Eye::Camera(camera),
            None => Eye::Studio { frame: framing.frame(), centre },
        };
        let floor = if style.floor { Floor::under(low, high) } else { None };
        Ok(View { style: style.clone(), eye, floor })
    }

    /// The camera for a pose; `turn` is how far a turntable has turned, radians.
    pub(super) fn frame(&self, pose: &Pose, turn: f64) -> Frame {
        match &self.eye {
            Eye::Studio { frame, centre } if turn != 0.0 => frame.turned(*centre, turn),
            Eye::Studio { frame, .. } => *frame,
            Eye::Camera(camera) => camera.frame(pose.node(camera.node), self.style.size),
        }
    }

    pub(super) fn floor(&self) -> Option<&Floor> {
        self.floor.as_ref()
    }
}

/// Points of a circle that hold it: a polygon drawn around it.
fn rim(centre: DVec3, radius: f64) -> impl Iterator<Item = DVec3> {
    const CORNERS: u32 = 64;
    let step = std::f64::consts::TAU / f64::from(CORNERS);
    let around = radius / libm::cos(step / 2.0);
    (0..CORNERS).map(move |i| {
        let (sin, cos) = libm::sincos(f64::from(i) * step);
        centre + DVec3::new(sin, 0.0, cos) * around
    })
}

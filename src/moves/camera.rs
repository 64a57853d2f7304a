//! Cameras: on a path of their own, behind the object, beside its key points.
//!
//! A glTF camera looks along its −Z with +Y up.

use super::way::Way;
use super::{Error, Ground, Move, Orient, Shape, Turn};
use crate::clip::Through;
use crate::curve::{Ends, Motion, Scheme};
use crate::math::Quat;
use crate::orient::{self, Axis, facing_upright};
use crate::path::Course;
use crate::read::{Keyframes, PathFile};
use glam::DVec3;

/// What a user asks for.
#[derive(Debug)]
pub enum Camera {
    /// One on a path of its own, which takes as long as the clip unless it has times.
    Path {
        /// Its path.
        file: Box<PathFile>,
        /// Where it looks.
        view: View,
    },
    /// One that hangs behind and above the object and looks at it.
    Follow {
        /// Where, in the object's axes: forward +Z, up +Y.
        offset: Option<DVec3>,
    },
    /// Still ones, each beside a key point of the object's path and looking at it.
    Keys,
}

/// Where a camera on a path looks.
#[derive(Debug)]
pub enum View {
    /// Along its own way, head up, or as the path's rows say.
    Ahead,
    /// At the object's root.
    Root,
    /// At a point.
    Point(DVec3),
    /// By rotations of its own, which take it from looking along −Z.
    Turned(Box<Keyframes>),
}

/// A camera where it rests, or where its motion begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Stand {
    /// Unique among the cameras.
    pub name: String,
    /// Its place, in the axes of what it hangs on.
    pub place: DVec3,
    /// Its rotation.
    pub turned: Quat,
    /// Whether it hangs on the object's root.
    pub mounted: bool,
}

/// A camera on the common clock.
pub(super) enum Post {
    Rails(Box<Rails>),
    Behind(Option<DVec3>),
    /// Beside the key point of this index.
    Beside(usize),
}

/// A path of its own, and where to look from it.
pub(super) struct Rails {
    pub(super) way: Way,
    shape: Shape,
    view: Sight,
}

enum Sight {
    Ahead,
    Root,
    Point(DVec3),
    Turned { times: Vec<f64>, keys: Vec<Quat>, through: Through },
}

/// When the clip's own inputs are over, and how cameras' times become those of the clock.
pub(super) struct Clock {
    pub(super) zero: f64,
    pub(super) duration: f64,
    pub(super) scale: f64,
}

impl Camera {
    /// The hashes of its files: path, then rotations.
    pub(super) fn hashes(&self) -> Vec<&str> {
        match self {
            Camera::Path { file, view: View::Turned(keyframes) } => vec![&file.hash, &keyframes.hash],
            Camera::Path { file, .. } => vec![&file.hash],
            Camera::Follow { .. } | Camera::Keys => Vec::new(),
        }
    }

    /// The times of day at which its inputs start that have times.
    pub(super) fn starts(&self) -> Vec<f64> {
        let Camera::Path { file, view } = self else { return Vec::new() };
        let turned = match view {
            View::Turned(keyframes) if !keyframes.untimed => Some(keyframes.clip.start),
            _ => None,
        };
        file.times.iter().map(|_| file.start).chain(turned).collect()
    }

    /// When the last of its inputs that have times ends, on the clock.
    pub(super) fn end(&self, clock: &Clock) -> f64 {
        let Camera::Path { file, view } = self else { return 0.0 };
        let path = file.times.as_ref().map(|times| file.start + times[times.len() - 1]);
        let turned = match view {
            View::Turned(keyframes) if !keyframes.untimed => {
                Some(keyframes.clip.start + keyframes.clip.duration())
            }
            _ => None,
        };
        path.into_iter().chain(turned).map(|end| (end - clock.zero) / clock.scale).fold(0.0, f64::max)
    }

    /// The cameras that this one asks for: one, or one a key point of the object's `way`.
    pub(super) fn posts(&self, clock: &Clock, frame: &Shape, way: Option<&Way>) -> Result<Vec<Post>, Error> {
        match self {
            Camera::Path { file, view } => {
                Ok(vec![Post::Rails(Box::new(Rails::new(file, view, clock, frame)?))])
            }
            Camera::Follow { offset } => Ok(vec![Post::Behind(*offset)]),
            Camera::Keys => {
                let path = &way.ok_or(Error::NoKeyPoints)?.path;
                let count = path.key_points().len() - usize::from(path.is_closed());
                Ok((0..count).map(Post::Beside).collect())
            }
        }
    }
}

impl Rails {
    fn new(file: &PathFile, view: &View, clock: &Clock, shape: &Shape) -> Result<Rails, Error> {
        let shape = Shape {
            frame: shape.frame,
            time_scale: clock.scale,
            model_forward: Axis::MinusZ,
            ..Shape::default()
        };
        let start = file.times.as_ref().map_or(0.0, |_| (file.start - clock.zero) / clock.scale);
        // A duration in the header would be the clip's, not the camera's.
        let file = PathFile { duration: None, ..file.clone() };
        let way = Way::new(&file, start, Some(clock.duration), &shape)?;
        let view = match view {
            View::Ahead => Sight::Ahead,
            View::Root => Sight::Root,
            View::Point(point) => Sight::Point(*point),
            View::Turned(keyframes) => turned(keyframes, clock),
        };
        Ok(Rails { way, shape, view })
    }

    /// When the camera turns by keys, and where its path has knots.
    pub(super) fn knots(&self) -> Vec<f64> {
        let keys = match &self.view {
            Sight::Turned { times, .. } => &times[..],
            _ => &[],
        };
        self.way.knots.iter().chain(keys).copied().collect()
    }

    /// Whether it turns through keys, as a scheme says.
    pub(super) fn has_keys(&self) -> bool {
        match &self.view {
            Sight::Turned { through, .. } => *through == Through::Keys,
            Sight::Ahead => self.way.any_given,
            Sight::Root | Sight::Point(_) => false,
        }
    }

    pub(super) fn moves<'a>(&'a self, ground: &'a Ground, scheme: Scheme) -> [Move<'a>; 2] {
        let turn = match &self.view {
            Sight::Ahead => {
                let orient = if self.way.any_given { Orient::Keyed } else { Orient::Upright };
                let ahead = self.way.attitude(orient, &self.shape, scheme);
                ahead.expect("only Orient::None turns nothing")
            }
            Sight::Root => self.look(&ground.camera_knots, move |t| ground.root_at(t)),
            Sight::Point(point) => self.look(&self.way.knots, move |_| *point),
            Sight::Turned { times, keys, through: Through::Keys } => {
                Move::Keys(Motion::new(times, keys, scheme, Ends::Natural).with_tcb(ground.shape().tcb))
            }
            Sight::Turned { times, keys, through: Through::Controls } => {
                Move::Keys(Motion::through_controls(times, keys))
            }
        };
        [turn, Move::Travel(Box::new(&self.way))]
    }

    /// Looks at a target; nothing jumps but at `knots`.
    fn look<'a>(&'a self, knots: &'a [f64], target: impl Fn(f64) -> DVec3 + Sync + 'a) -> Move<'a> {
        let end = self.way.end();
        let at = Box::new(move |t| {
            // Where eye and target meet, the view of just before counts, else of just after.
            let steps = || (0..STEPS).map(|i| if i == 0 { 0.0 } else { end * f64::powi(0.5, STEPS - i) });
            let moments = steps().map(|step| t - step).chain(steps().map(|step| t + step));
            let view = |t: f64| look_at(self.way.place(t), target(t));
            moments.filter(|&t| t >= 0.0).find_map(view).unwrap_or(backwards())
        });
        Move::Attitude(Turn { at, knots, ramps: &[] })
    }
}

/// How many times around a moment are tried for one with a view: down to 1e-12 of the whole.
const STEPS: i32 = 40;

fn turned(keyframes: &Keyframes, clock: &Clock) -> Sight {
    let clip = &keyframes.clip;
    let on_clock = |t: &f64| match keyframes.untimed {
        true => t * (clock.duration / clip.duration()),
        false => (clip.start - clock.zero + t) / clock.scale,
    };
    let times = clip.times.iter().map(on_clock).collect();
    Sight::Turned { times, keys: clip.tracks[0].clone(), through: clip.through }
}

/// From +Z to −Z about the up axis: what faces a target becomes a camera that sees it.
pub(super) fn backwards() -> Quat {
    Quat { w: 0.0, v: crate::math::Vec3::new(0.0, 1.0, 0.0) }
}

/// The rotation of a camera that sees `target` from `eye` in the middle of its picture,
/// with +Y up (straight down: +Z); none where both meet.
fn look_at(eye: DVec3, target: DVec3) -> Option<Quat> {
    let forward = (target - eye).try_normalize().filter(|forward| forward.is_finite())?;
    Some(facing_upright(forward) * backwards())
}

/// Where a following camera hangs unless told, in sizes of the object.
const BEHIND: DVec3 = DVec3::new(0.0, 0.9, -2.6);
/// How far beside a key point, and how far above it, a still camera stands, in sizes.
const BESIDE: [f64; 2] = [3.5, 1.2];

impl Post {
    /// Where the camera stands, for an object of a size.
    pub(super) fn stand(&self, ground: &Ground, size: f64) -> (DVec3, Quat, bool) {
        match self {
            Post::Rails(rails) => {
                let [turn, _] = rails.moves(ground, Scheme::Slerp);
                (rails.way.place(0.0), turn.turned(0.0), false)
            }
            Post::Behind(offset) => {
                let at = offset.unwrap_or(BEHIND * size);
                // The root turns its model's axes; the offset is told in the object's.
                let model = ground.model().conjugate();
                let turn = look_at(at, DVec3::ZERO).unwrap_or(backwards());
                (orient::turned(model, at), model * turn, true)
            }
            Post::Beside(key) => {
                let path = &ground.way.as_ref().expect("asked for with key points").path;
                let point = path.key_points()[*key];
                let forward = Course::direction(path, path.key_times()[*key]).unwrap_or(DVec3::Z);
                let right = forward.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::NEG_X);
                let at = point + size * (BESIDE[0] * right + BESIDE[1] * DVec3::Y);
                (at, look_at(at, point).unwrap_or(backwards()), false)
            }
        }
    }

    /// What it is called, but for its number.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Post::Rails(_) => "camera-path",
            Post::Behind(_) => "camera-follow",
            Post::Beside(_) => "camera-key",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orient::turned;

    #[test]
    fn cameras_see_their_target_upright() {
        let eye = DVec3::new(1.0, 2.0, 3.0);
        for target in [DVec3::ZERO, DVec3::new(-4.0, 7.0, 3.5), DVec3::new(1.0, 2.0, 1e6)] {
            let q = look_at(eye, target).unwrap();
            let seen = turned(q, DVec3::NEG_Z);
            assert!((seen - (target - eye).normalize()).length() < 1e-14);
            assert!(turned(q, DVec3::X).y.abs() < 1e-14, "the horizon is level");
            assert!(turned(q, DVec3::Y).y > 0.0);
        }
        assert_eq!(look_at(eye, eye), None);
        let down = look_at(eye, eye - 5.0 * DVec3::Y).unwrap();
        assert!((turned(down, DVec3::NEG_Z) - DVec3::NEG_Y).length() < 1e-14);
        assert!((turned(down, DVec3::Y) - DVec3::Z).length() < 1e-14);
    }
}

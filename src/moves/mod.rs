//! What every node does, over one clock: inputs and options become functions of time.
//!
//! [`Ground`] holds what is worked out once: the clock, the path, keys of orientation. A
//! scheme turns it into [`Move`]s, a node's rotation or place each. `convert` samples
//! them, `check` compares them with how a file plays.

mod camera;
mod copies;
mod ground;
mod keys;
mod way;

pub use camera::{Camera, Stand, View};
pub use copies::{Copies, Moment, Stream, TooMany};
pub use ground::Ground;
pub use keys::{camera_keys, rotation_keys};

use crate::curve::{Arc, Ends, Motion, NotClosed, Tcb};
use crate::math::Quat;
use crate::orient::{Axis, Frame, Level, ParallelAxes};
use crate::path::{self, Ease, PathEnds, Timing};
use crate::read::{Keyframes, PathFile};
use crate::sample::{Rotation, Travel};

/// What is put together.
#[derive(Debug)]
pub struct Inputs {
    /// Rotations of boxes or of one body.
    pub keyframes: Option<Keyframes>,
    /// The way of the root.
    pub path: Option<PathFile>,
    /// Who looks on.
    pub cameras: Vec<Camera>,
}

impl Inputs {
    /// The BLAKE3 hashes of all files: rotations, path, then what cameras were made of.
    pub fn hashes(&self) -> Vec<&str> {
        let keyframes = self.keyframes.iter().map(|keyframes| keyframes.hash.as_str());
        let path = self.path.iter().map(|path| path.hash.as_str());
        keyframes.chain(path).chain(self.cameras.iter().flat_map(Camera::hashes)).collect()
    }
}

/// How the object looks that moves along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orient {
    /// As it stands.
    None,
    /// By keys at key points, turned from chord to chord; the scheme runs between them.
    Keyed,
    /// Along the way, with the least twist.
    Tangent,
    /// Along the way, with its head up.
    Upright,
}

impl Orient {
    /// Every kind, in the order of the documentation.
    pub const ALL: [Orient; 4] = [Orient::None, Orient::Keyed, Orient::Tangent, Orient::Upright];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Orient::None => "none",
            Orient::Keyed => "keyed",
            Orient::Tangent => "tangent",
            Orient::Upright => "upright",
        }
    }

    /// The kind of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Orient> {
        Orient::ALL.into_iter().find(|orient| orient.name() == name)
    }
}

/// All that shapes the motion but the scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// What rotations do at their ends.
    pub ends: Ends,
    /// Tension, continuity and bias of the scheme that has them.
    pub tcb: Tcb,
    /// What the path does at its ends.
    pub path_ends: PathEnds,
    /// How time is shared out along the path.
    pub timing: Option<Timing>,
    /// Rest at the path's ends, under constant speed.
    pub ease: Ease,
    /// Mean speed along the path, units a second.
    pub speed: Option<f64>,
    /// Everything so many times as fast.
    pub time_scale: f64,
    /// Whose x, y and z the path's numbers are, where its header does not say.
    pub frame: Option<Frame>,
    /// How the root looks; without it `keyed` where the path gives orientations, `none`
    /// where rotation keys drive an object, and `upright` where the path alone does.
    pub orient: Option<Orient>,
    /// How far it leans into turns, degrees.
    pub bank: f64,
    /// How many first and last orientation keys have no pitch and no roll.
    pub level: Level,
    /// Where the model's nose points.
    pub model_forward: Axis,
    /// Where the model's top points.
    pub model_up: Axis,
    /// How many objects go the same way.
    pub copies: Copies,
}

impl Default for Shape {
    fn default() -> Shape {
        Shape {
            ends: Ends::default(),
            tcb: Tcb::default(),
            path_ends: PathEnds::default(),
            timing: None,
            ease: Ease::None,
            speed: None,
            time_scale: 1.0,
            frame: None,
            orient: None,
            bank: 0.0,
            level: Level::default(),
            model_forward: Axis::Z,
            model_up: Axis::Y,
            copies: Copies::default(),
        }
    }
}

/// Why inputs and options make no motion.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Closed ends that do not meet.
    #[error(transparent)]
    NotClosed(#[from] NotClosed),
    /// A path that cannot be.
    #[error(transparent)]
    Path(#[from] path::Error),
    /// A model whose nose and top point the same way.
    #[error(transparent)]
    Model(#[from] ParallelAxes),
    /// Still cameras without a path.
    #[error("cameras beside key points need a path with key points: use --path PATH.dat")]
    NoKeyPoints,
    /// More copies than the way has room for.
    #[error(transparent)]
    Copies(#[from] TooMany),
}

/// A node of the scene that moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mover {
    /// The root.
    Root,
    /// A box of the chain, from 0, or the one body.
    Track(usize),
}

/// What a node does.
pub enum Move<'a> {
    /// It turns through keys.
    Keys(Motion<'a>),
    /// It turns with the path.
    Attitude(Turn<'a>),
    /// It goes along the path.
    Travel(Box<dyn Travel + 'a>),
}

/// A turn of which nothing is known but its values.
pub struct Turn<'a> {
    /// The rotation at a time, seconds.
    pub at: Box<dyn Fn(f64) -> Quat + Sync + 'a>,
    /// Times between which it is smooth.
    pub knots: &'a [f64],
    /// The stretches before jumps, in which a file turns to what comes after.
    pub ramps: &'a [(f64, f64)],
}

impl Move<'_> {
    /// The rotation at a time; none of what only travels.
    pub(crate) fn turned(&self, t: f64) -> Quat {
        match self {
            Move::Keys(motion) => motion.at(t),
            Move::Attitude(turn) => (turn.at)(t),
            Move::Travel(_) => Quat::IDENTITY,
        }
    }

    /// If it is a rotation, an upper bound of its speed, degrees a second; none where
    /// nothing is known of it.
    pub fn turning_bound(&self) -> Option<Option<f64>> {
        match self {
            Move::Keys(motion) => Some(Some(turning_bound(motion).to_degrees())),
            Move::Attitude(_) => Some(None),
            Move::Travel(_) => None,
        }
    }

    /// The same as what samplers take, if it is a rotation.
    pub fn rotation(&self) -> Option<Rotation<'_>> {
        match self {
            Move::Keys(motion) => Some(Rotation::Motion(motion.clone())),
            Move::Attitude(turn) => Some(Rotation::Function(&turn.at)),
            Move::Travel(_) => None,
        }
    }

    /// The same as what samplers take, if it is a way.
    pub fn travel(&self) -> Option<&(dyn Travel + '_)> {
        match self {
            Move::Travel(travel) => Some(travel.as_ref()),
            Move::Keys(_) | Move::Attitude(_) => None,
        }
    }
}

/// An upper bound of a motion's speed, radians a second.
fn turning_bound(motion: &Motion) -> f64 {
    let (mut worst, mut piece): (f64, _) = (0.0, motion.piece_at(0.0));
    while piece.end.is_finite() {
        // Rates count half angles.
        worst = worst.max(2.0 * piece.rates().speed / piece.duration());
        piece = motion.piece_at(piece.end);
    }
    worst
}

//! What every node does, over one clock: inputs and options become functions of time.
//!
//! [`Ground`] holds what is worked out once: the clock, the path, keys of orientation. A
//! scheme turns it into [`Move`]s, a node's rotation or place each. `convert` samples
//! them, `check` compares them with how a file plays.

mod euler;
mod way;

pub use euler::euler_keys;

use crate::curve::{Ends, Motion, NotClosed, Scheme, Tcb};
use crate::math::Quat;
use crate::orient::{Axis, Frame, Level, ParallelAxes};
use crate::path::{self, Ease, PathEnds, Timing};
use crate::read::{Keyframes, PathFile};
use crate::sample::{Fps, Rotation, Timeline, TooFine, Travel};
use glam::DVec3;
use std::borrow::Cow;
use way::Way;

/// What is put together.
#[derive(Debug)]
pub struct Inputs {
    /// Rotations of boxes or of one body.
    pub keyframes: Option<Keyframes>,
    /// The way of the root.
    pub path: Option<PathFile>,
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
    /// Control rotations, which no scheme runs through.
    #[error("{0}: control rotations cannot be converted yet; euler keys can")]
    Controls(&'static str),
    /// A model whose nose and top point the same way.
    #[error(transparent)]
    Model(#[from] ParallelAxes),
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
    Attitude(Box<dyn Fn(f64) -> Quat + Sync + 'a>),
    /// It goes along the path.
    Travel(Box<dyn Travel + 'a>),
}

impl Move<'_> {
    /// Where the ramp of a jump begins, if there is one.
    fn ramp(&self) -> Option<f64> {
        match self {
            Move::Keys(motion) => motion.ramp(),
            Move::Attitude(_) | Move::Travel(_) => None,
        }
    }

    /// The same as what samplers take, if it is a rotation.
    pub fn rotation(&self) -> Option<Rotation<'_>> {
        match self {
            Move::Keys(motion) => Some(Rotation::Motion(motion.clone())),
            Move::Attitude(at) => Some(Rotation::Function(at)),
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

/// What inputs and shape come to, but for the scheme.
pub struct Ground<'a> {
    inputs: &'a Inputs,
    shape: Shape,
    /// Times of the rotation keys on the common clock.
    key_times: Cow<'a, [f64]>,
    way: Option<Way>,
    duration: f64,
    /// Times that samples must meet, but for ramps where there is no path.
    knots: Cow<'a, [f64]>,
}

impl<'a> Ground<'a> {
    /// Puts inputs on one clock, for some schemes; there is at least one input.
    pub fn new(inputs: &'a Inputs, shape: Shape, schemes: &[Scheme]) -> Result<Ground<'a>, Error> {
        let clip = inputs.keyframes.as_ref().map(|keyframes| &keyframes.clip);
        if let Some(clip) = clip.filter(|_| schemes.iter().any(|scheme| scheme.has_ends())) {
            shape.ends.accept(clip)?;
        }
        let timed = inputs.path.as_ref().filter(|path| path.times.is_some());
        let starts = clip.map(|clip| clip.start).into_iter().chain(timed.map(|path| path.start));
        let zero = starts.fold(f64::INFINITY, f64::min);
        let on_clock = |t: f64| t / shape.time_scale;
        let key_times = match clip {
            Some(clip) if clip.start == zero && shape.time_scale == 1.0 => {
                Cow::Borrowed(clip.times.as_slice())
            }
            Some(clip) => Cow::Owned(clip.times.iter().map(|t| on_clock(clip.start - zero + t)).collect()),
            None => Cow::Borrowed([].as_slice()),
        };
        let rest = key_times.last().copied();
        let way = inputs.path.as_ref().map(|file| {
            let start = if file.times.is_some() { on_clock(file.start - zero) } else { 0.0 };
            Way::new(file, start, rest, &shape)
        });
        let way = way.transpose()?;
        let duration = rest.into_iter().chain(way.as_ref().map(Way::end)).fold(0.0, f64::max);
        let knots = Cow::Borrowed([].as_slice());
        let mut ground = Ground { inputs, shape, key_times, way, duration, knots };
        ground.knots = ground.all_knots(schemes);
        Ok(ground)
    }

    /// A path's knots and all keys together; keys alone are a timeline as they are.
    fn all_knots(&self, schemes: &[Scheme]) -> Cow<'a, [f64]> {
        let Some(way) = &self.way else { return self.key_times.clone() };
        let moves = schemes.iter().flat_map(|&scheme| self.moves(scheme));
        let ramps: Vec<f64> = moves.filter_map(|(_, turn)| turn.ramp()).collect();
        let keys = self.key_times.iter().chain(&way.knots).chain(&ramps).copied();
        Cow::Owned(merged(keys.chain([0.0, self.duration])))
    }

    /// Times that samples must meet.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// When the last of all ends, seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The sample times by a scheme.
    pub fn timeline(&self, scheme: Scheme, fps: Fps, key_times: bool) -> Result<Timeline<'_>, TooFine> {
        let ramp = match &self.way {
            Some(_) => None, // among the knots
            None => self.moves(scheme).first().and_then(|(_, turn)| turn.ramp()),
        };
        Timeline::new(&self.knots, ramp, fps, key_times)
    }

    /// Whether the scheme makes a difference.
    pub fn has_schemes(&self) -> bool {
        self.inputs.keyframes.is_some() || self.orient() == Orient::Keyed
    }

    /// What was put together.
    pub fn inputs(&self) -> &'a Inputs {
        self.inputs
    }

    /// What shapes it.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What moves, by a scheme, in the order in which files hold it.
    pub fn moves(&self, scheme: Scheme) -> Vec<(Mover, Move<'_>)> {
        let tracks = self.inputs.keyframes.iter().flat_map(|keyframes| &keyframes.clip.tracks).enumerate();
        let Shape { ends, tcb, .. } = self.shape;
        let motion = |keys| Move::Keys(Motion::new(&self.key_times, keys, scheme, ends).with_tcb(tcb));
        let mut moves: Vec<(Mover, Move)> = tracks.map(|(i, keys)| (Mover::Track(i), motion(keys))).collect();
        if let Some(way) = &self.way {
            moves.extend(way.attitude(self.orient(), &self.shape, scheme).map(|turn| (Mover::Root, turn)));
            moves.push((Mover::Root, Move::Travel(Box::new(way))));
        }
        moves
    }

    /// How far the path's key points lie apart along the axis where that is most.
    pub fn extent(&self) -> f64 {
        let points = self.way.as_ref().map_or(&[][..], |way| way.path.key_points());
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        if points.is_empty() { 0.0 } else { (high - low).max_element() }
    }

    /// How the root looks.
    pub fn orient(&self) -> Orient {
        let given = self.way.as_ref().is_some_and(|way| way.any_given);
        let by_default = match &self.inputs.keyframes {
            _ if given => Orient::Keyed,
            Some(_) => Orient::None,
            None => Orient::Upright,
        };
        self.shape.orient.unwrap_or(by_default)
    }
}

/// Times in order, those that float32 cannot tell apart taken for one.
fn merged(times: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|b, a| *b as f32 == *a as f32);
    times
}

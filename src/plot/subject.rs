//! What a plot is about.

use super::figure::{Axis, Entry, Sign};
use super::style::of_scheme;
use super::{Error, Line};
use crate::clip::{Body, Clip, Through};
use crate::curve::{Motion, Scheme};
use crate::math::Quat;
use crate::moves::{Ground, Move, Mover};
use crate::orient::Frame;
use crate::read::Order;

/// Inputs on one clock, and how their rows are written.
pub struct Subject<'a> {
    /// The input's name.
    pub name: &'a str,
    /// What moves.
    pub ground: &'a Ground<'a>,
    /// By which schemes; one at least.
    pub schemes: &'a [Scheme],
    /// The order of quaternions' parts in rows.
    pub order: Order,
    /// Whose axes the rotations' rows are in.
    pub rows: Frame,
    /// Whose axes the path's rows are in.
    pub frame: Frame,
}

/// What a time axis counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Clock {
    /// Seconds.
    #[default]
    Seconds,
    /// Frames, so many a second.
    Frames(f64),
}

impl Clock {
    /// A time axis for so many seconds.
    pub(super) fn axis(self, range: [f64; 2]) -> Axis {
        match self {
            Clock::Seconds => Axis::new("time (s)", range),
            Clock::Frames(fps) => Axis::new(
                format!("frame ({} a second)", (fps * 1000.0).round() / 1000.0),
                range.map(|t| t * fps),
            ),
        }
    }

    /// A line over seconds on this clock.
    pub(super) fn line(self, mut line: Line) -> Line {
        line.iter_mut().flatten().for_each(|point| point[0] = self.time(point[0]));
        line
    }

    /// A time on this clock.
    pub(super) fn time(self, t: f64) -> f64 {
        match self {
            Clock::Seconds => t,
            Clock::Frames(fps) => t * fps,
        }
    }
}

/// One way from key to key: a scheme, or none that is chosen.
pub(super) type Method<'a> = (Option<Scheme>, Motion<'a>);

/// What a method is called in a legend.
pub(super) fn label(scheme: Option<Scheme>) -> String {
    scheme.map_or("control rotations", Scheme::name).to_owned()
}

/// The legend's entries of some methods.
pub(super) fn entries<'a>(schemes: impl Iterator<Item = &'a Option<Scheme>>) -> Vec<Entry> {
    schemes.map(|&scheme| Entry { label: label(scheme), sign: Sign::Line(of_scheme(scheme)) }).collect()
}

impl<'a> Subject<'a> {
    /// The rotations, if the input has some.
    pub(super) fn clip(&self) -> Option<&'a Clip> {
        self.ground.inputs().keyframes.as_ref().map(|keyframes| &keyframes.clip)
    }

    /// What turns by keys.
    pub(super) fn turning(&self) -> Vec<Mover> {
        let moves = self.ground.moves(self.schemes[0]);
        moves.iter().filter(|(_, a_move)| matches!(a_move, Move::Keys(_))).map(|(mover, _)| *mover).collect()
    }

    /// What turns by keys and was chosen: from 1, and the first where nobody chose.
    pub(super) fn chosen(&self, only: Option<usize>, show: &'static str) -> Result<Mover, Error> {
        let turning = self.turning();
        if turning.is_empty() {
            return Err(Error::NoRotations(show, "--show speed, acceleration, curvature and path fit it"));
        }
        let found = only.unwrap_or(1);
        let mover = found.checked_sub(1).and_then(|i| turning.get(i).copied());
        mover.ok_or(Error::Box { last: turning.len(), found })
    }

    /// A moving thing's name.
    pub(super) fn named(&self, mover: Mover) -> String {
        match (mover, self.clip().map(|clip| clip.body)) {
            (Mover::Root, _) => "root".to_owned(),
            (Mover::Track(_), Some(Body::Free)) => "body".to_owned(),
            (Mover::Track(track), _) => format!("box {}", track + 1),
        }
    }

    /// How something turns by each scheme; along control rotations there is one way only.
    pub(super) fn methods(&self, mover: Mover) -> Vec<Method<'a>> {
        let controls = self.clip().is_some_and(|clip| clip.through == Through::Controls);
        let free = controls && mover != Mover::Root;
        let schemes = if free { &self.schemes[..1] } else { self.schemes };
        let method = |&scheme: &Scheme| Some((Some(scheme).filter(|_| !free), self.motion(scheme, mover)?));
        schemes.iter().filter_map(method).collect()
    }

    fn motion(&self, scheme: Scheme, mover: Mover) -> Option<Motion<'a>> {
        let mut moves = self.ground.moves(scheme).into_iter();
        moves.find_map(|(other, a_move)| match a_move {
            Move::Keys(motion) if other == mover => Some(motion),
            _ => None,
        })
    }

    /// The rotations that something runs through, at its motion's times.
    pub(super) fn keys(&self, mover: Mover) -> Vec<Quat> {
        match (mover, self.clip()) {
            (Mover::Track(track), Some(clip)) => {
                let rotation = |i: usize| clip.tracks[track][clip.through.rotation(i)];
                (0..clip.times.len()).map(rotation).collect()
            }
            _ => self.ground.orientation_keys().map_or(Vec::new(), |(_, keys, _)| keys.to_vec()),
        }
    }

    /// A rotation's numbers as rows have them.
    pub(super) fn parts(&self, q: Quat) -> [f64; 4] {
        let q = self.rows.rotation_from_gltf(q);
        match self.order {
            Order::Wxyz => q.to_wxyz(),
            Order::Xyzw => q.to_xyzw(),
        }
    }

    /// From the first key or point to the last, seconds.
    pub(super) fn range(&self) -> [f64; 2] {
        [0.0, self.ground.duration()]
    }
}

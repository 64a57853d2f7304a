//! Inputs on one clock.

use super::camera::{Camera, Clock, Post, Stand};
use super::copies::Stream;
use super::way::{self, Way};
use super::{Error, Inputs, Move, Mover, Orient, Shape};
use crate::clip::{Body, Clip, Through};
use crate::curve::{Ends, Motion, Scheme};
use crate::math::Quat;
use crate::orient::model_frame;
use crate::path::Path;
use crate::read::Keyframes;
use crate::sample::{Fps, Timeline, TooFine};
use glam::DVec3;
use std::borrow::Cow;

/// What inputs and shape come to, but for the scheme.
pub struct Ground<'a> {
    inputs: &'a Inputs,
    shape: Shape,
    /// Times of the rotation keys on the common clock.
    key_times: Cow<'a, [f64]>,
    pub(super) way: Option<Way>,
    posts: Vec<Post>,
    stream: Stream,
    duration: f64,
    /// Times that samples of the object must meet, but for ramps where keys are alone.
    knots: Cow<'a, [f64]>,
    /// Those of them that count without key times.
    seams: Vec<f64>,
    /// The same for cameras that move.
    pub(super) camera_knots: Vec<f64>,
}

impl<'a> Ground<'a> {
    /// Puts inputs on one clock, for some schemes; there is at least one input.
    pub fn new(inputs: &'a Inputs, shape: Shape, schemes: &[Scheme]) -> Result<Ground<'a>, Error> {
        let clip = inputs.keyframes.as_ref().map(|keyframes| &keyframes.clip);
        let keys = clip.filter(|clip| clip.through == Through::Keys);
        if let Some(clip) = keys.filter(|_| schemes.iter().any(|scheme| scheme.has_ends())) {
            shape.ends.accept(clip)?;
        }
        let zero = zero(inputs);
        let mut key_times = key_times(inputs, zero, &shape);
        let way = match &inputs.path {
            Some(file) => {
                let start = if file.times.is_some() { (file.start - zero) / shape.time_scale } else { 0.0 };
                let untimed = inputs.keyframes.as_ref().is_some_and(|keyframes| keyframes.untimed);
                let says = file.times.is_some() || file.duration.is_some() || shape.speed.is_some();
                let rest = key_times.last().copied().filter(|_| !(untimed && says));
                let way = Way::new(file, start, rest, &shape)?;
                if untimed && says {
                    stretch(&mut key_times, way.end());
                }
                Some(way)
            }
            None => None,
        };
        let once =
            key_times.last().copied().into_iter().chain(way.as_ref().map(Way::end)).fold(0.0, f64::max);
        let stream = shape.copies.stream(once)?;
        let scale = shape.time_scale;
        let mut clock = Clock { zero, duration: stream.duration(), scale };
        let ends = inputs.cameras.iter().map(|camera| camera.end(&clock));
        clock.duration = ends.fold(clock.duration, f64::max);
        let mut posts = Vec::new();
        for camera in &inputs.cameras {
            posts.extend(camera.posts(&clock, &shape, way.as_ref())?);
        }
        let mut ground = Ground {
            inputs,
            shape,
            key_times,
            way,
            posts,
            stream,
            duration: clock.duration,
            knots: Cow::Borrowed([].as_slice()),
            seams: merged(stream.knots().into_iter().chain([0.0, once])),
            camera_knots: Vec::new(),
        };
        ground.camera_knots = ground.all_camera_knots();
        ground.knots = ground.all_knots(schemes);
        Ok(ground)
    }

    /// All keys, a path's knots, and what copies and cameras need; keys alone are a
    /// timeline as they are.
    fn all_knots(&self, schemes: &[Scheme]) -> Cow<'a, [f64]> {
        if self.way.is_none() && !self.has_moving_cameras() {
            return self.key_times.clone();
        }
        let ramps: Vec<f64> = schemes.iter().flat_map(|&scheme| self.ramps(scheme)).collect();
        let way = self.way.iter().flat_map(|way| &way.knots);
        // Cameras and object share their times where both take equally long.
        let cameras = self.camera_knots.iter().filter(|_| self.duration == self.stream.once);
        let times = self.key_times.iter().chain(way).chain(&ramps).chain(&self.seams).chain(cameras);
        Cow::Owned(merged(times.copied()))
    }

    fn ramps(&self, scheme: Scheme) -> Vec<f64> {
        let way = self.way.as_ref().filter(|_| self.orient() == Orient::Keyed);
        let root = way.map(|way| way.keyed(&self.shape, scheme));
        self.motions(scheme).chain(root).filter_map(|motion| motion.ramp()).collect()
    }

    fn all_camera_knots(&self) -> Vec<f64> {
        let rails = self.posts.iter().filter_map(|post| match post {
            Post::Rails(rails) => Some(rails.knots()),
            _ => None,
        });
        // What a camera looks at may turn at once.
        let way = self.way.iter().flat_map(|way| way.knots.iter().copied());
        merged(rails.flatten().chain(way).chain([0.0, self.duration]))
    }

    fn has_moving_cameras(&self) -> bool {
        self.posts.iter().any(|post| matches!(post, Post::Rails(_)))
    }

    /// Times that samples of the object must meet.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// When the last of all ends, seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The object and its copies in time.
    pub fn stream(&self) -> &Stream {
        &self.stream
    }

    /// The sample times of one object by a scheme.
    pub fn timeline(&self, scheme: Scheme, fps: Fps, key_times: bool) -> Result<Timeline<'_>, TooFine> {
        if !key_times && self.stream.wraps() {
            return Timeline::new(&self.seams, None, fps, true);
        }
        let ramp = match self.knots {
            Cow::Owned(_) => None, // among the knots, or there is none
            Cow::Borrowed(_) => self.ramps(scheme).first().copied(),
        };
        Timeline::new(&self.knots, ramp, fps, key_times)
    }

    /// The sample times of cameras, where any move.
    pub fn camera_timeline(&self, fps: Fps, key_times: bool) -> Result<Option<Timeline<'_>>, TooFine> {
        let timeline = || Timeline::new(&self.camera_knots, None, fps, key_times);
        self.has_moving_cameras().then(timeline).transpose()
    }

    /// Whether the scheme makes a difference.
    pub fn has_schemes(&self) -> bool {
        let keys = |keyframes: &Keyframes| keyframes.clip.through == Through::Keys;
        let cameras = self.posts.iter().any(|post| matches!(post, Post::Rails(rails) if rails.has_keys()));
        self.inputs.keyframes.as_ref().is_some_and(keys) || self.orient() == Orient::Keyed || cameras
    }

    /// What was put together.
    pub fn inputs(&self) -> &'a Inputs {
        self.inputs
    }

    /// What shapes it.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What of the object moves, by a scheme, in the order in which files hold it.
    pub fn moves(&self, scheme: Scheme) -> Vec<(Mover, Move<'_>)> {
        let motions = self.motions(scheme).enumerate();
        let mut moves: Vec<(Mover, Move)> =
            motions.map(|(i, motion)| (Mover::Track(i), Move::Keys(motion))).collect();
        if let Some(way) = &self.way {
            moves.extend(way.attitude(self.orient(), &self.shape, scheme).map(|turn| (Mover::Root, turn)));
            moves.push((Mover::Root, Move::Travel(Box::new(way))));
        }
        moves
    }

    /// The tracks of the keyframes in motion.
    fn motions(&self, scheme: Scheme) -> impl Iterator<Item = Motion<'_>> {
        let Shape { ends, tcb, .. } = self.shape;
        let motion = move |keys, through| match through {
            Through::Keys => Motion::new(&self.key_times, keys, scheme, ends).with_tcb(tcb),
            Through::Controls => Motion::through_controls(&self.key_times, keys),
        };
        let clip = self.inputs.keyframes.as_ref().map(|keyframes| &keyframes.clip);
        clip.into_iter().flat_map(move |clip| clip.tracks.iter().map(move |keys| motion(keys, clip.through)))
    }

    /// The keys by which the root turns on its way, their times, and what they do at
    /// their ends; where it turns by keys.
    pub fn orientation_keys(&self) -> Option<(&[f64], &[Quat], Ends)> {
        let way = self.way.as_ref().filter(|_| self.orient() == Orient::Keyed)?;
        let (times, keys) = &way.keys;
        Some((times, keys, way::key_ends(self.shape.ends)))
    }

    /// What moves which camera, as [`Ground::stands`] counts them, by a scheme: all
    /// rotations first.
    pub fn camera_moves(&self, scheme: Scheme) -> Vec<(usize, Move<'_>)> {
        let rails = self.posts.iter().enumerate().filter_map(|(i, post)| match post {
            Post::Rails(rails) => Some((i, rails)),
            _ => None,
        });
        let moves: Vec<_> = rails.map(|(i, rails)| (i, rails.moves(self, scheme))).collect();
        let (turns, travels): (Vec<_>, Vec<_>) =
            moves.into_iter().map(|(i, [turn, travel])| ((i, turn), (i, travel))).unzip();
        turns.into_iter().chain(travels).collect()
    }

    /// Where cameras stand, for an object about as large as `size`.
    pub fn stands(&self, size: f64) -> Vec<Stand> {
        let mut kinds: Vec<&str> = Vec::new();
        let stand = |post: &Post| {
            kinds.push(post.kind());
            let count = kinds.iter().filter(|kind| **kind == post.kind()).count();
            let name = match (post, count) {
                (Post::Beside(_), _) | (_, 2..) => format!("{}-{count}", post.kind()),
                _ => post.kind().to_owned(),
            };
            let (place, turned, mounted) = post.stand(self, size);
            Stand { name, place, turned, mounted }
        };
        self.posts.iter().map(stand).collect()
    }

    /// Where the root is.
    pub(super) fn root_at(&self, t: f64) -> DVec3 {
        self.way.as_ref().map_or(DVec3::ZERO, |way| way.place(t))
    }

    /// Turns the model to fit +Z forward and +Y up.
    pub(super) fn model(&self) -> Quat {
        // One that cannot be is refused where the path is read.
        let model = model_frame(self.shape.model_forward, self.shape.model_up).ok();
        model.filter(|_| self.way.is_some()).unwrap_or(Quat::IDENTITY)
    }

    /// The path as places to draw a line through, with times as shares of the whole;
    /// empty without a path.
    pub fn trace(&self) -> Vec<(f64, DVec3)> {
        self.way.as_ref().map_or(Vec::new(), Way::trace)
    }

    /// The path itself, and when it begins on the clock, seconds.
    pub fn course(&self) -> Option<(&Path, f64)> {
        self.way.as_ref().map(|way| (&way.path, way.start))
    }

    /// The points that shape the path.
    pub fn control_points(&self) -> &[DVec3] {
        self.way.as_ref().map_or(&[], |way| way.path.control_points())
    }

    /// What ends before the clip does, and when: it holds its last value from there on.
    pub fn holds(&self) -> Vec<(&'static str, f64)> {
        let rotations = self.key_times.last().map(|&end| ("rotations", end));
        let path = self.way.as_ref().map(|way| ("key points of the path", way.end()));
        let ends = rotations.into_iter().chain(path);
        ends.filter(|(_, end)| *end < self.stream.once.max(self.duration) * (1.0 - 1e-9)).collect()
    }

    /// How far the path's key points lie apart along the axis where that is most.
    pub fn extent(&self) -> f64 {
        extent(self.way.iter().flat_map(|way| way.path.key_points()))
    }

    /// The length of the chain of boxes, if the object is one.
    pub fn chain_length(&self) -> Option<f64> {
        let clip = self.inputs.keyframes.as_ref().map(|keyframes| &keyframes.clip)?;
        match clip.body {
            Body::Chain { length } => Some(length * clip.tracks.len() as f64),
            Body::Free => None,
        }
    }

    /// How far the farthest corner of what a node turns can be from where it is hinged.
    pub fn reach_below(&self, mover: Mover) -> f64 {
        let (boxes, length) = match self.inputs.keyframes.as_ref().map(|keyframes| &keyframes.clip) {
            Some(Clip { body: Body::Chain { length }, tracks, .. }) => (tracks.len(), *length),
            Some(_) => return FREE_BODY,
            None => return 0.0,
        };
        let below = match mover {
            Mover::Root => boxes,
            Mover::Track(track) => boxes - track,
        };
        // All boxes in a line, and the corner of the last one's square end.
        (below - 1) as f64 * length + libm::hypot(length, std::f64::consts::FRAC_1_SQRT_2)
    }

    /// The same of all points by which paths are shaped, cameras' too, and the origin.
    pub fn reach(&self) -> f64 {
        let rails = self.posts.iter().filter_map(|post| match post {
            Post::Rails(rails) => Some(&rails.way),
            _ => None,
        });
        let points = self.way.iter().chain(rails).flat_map(|way| way.path.control_points());
        extent(points.chain([&DVec3::ZERO]))
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

/// How far the free body reaches from its middle.
const FREE_BODY: f64 = 1.5;

/// The earliest time of all inputs that have times.
fn zero(inputs: &Inputs) -> f64 {
    let timed_keys = inputs.keyframes.as_ref().filter(|keyframes| !keyframes.untimed);
    let timed_path = inputs.path.as_ref().filter(|path| path.times.is_some());
    let starts = timed_keys.map(|keyframes| keyframes.clip.start).into_iter();
    let starts = starts.chain(timed_path.map(|path| path.start));
    let earliest = starts.chain(inputs.cameras.iter().flat_map(Camera::starts)).fold(f64::INFINITY, f64::min);
    if earliest.is_finite() { earliest } else { 0.0 }
}

/// Times of rotation keys on the clock that starts at `zero`.
fn key_times<'a>(inputs: &'a Inputs, zero: f64, shape: &Shape) -> Cow<'a, [f64]> {
    let Some(Keyframes { clip, untimed, .. }) = &inputs.keyframes else {
        return Cow::Borrowed([].as_slice());
    };
    let start = if *untimed { 0.0 } else { clip.start - zero };
    if start == 0.0 && shape.time_scale == 1.0 {
        return Cow::Borrowed(clip.times.as_slice());
    }
    Cow::Owned(clip.times.iter().map(|t| (start + t) / shape.time_scale).collect())
}

/// Makes times from 0 on last until `end`.
fn stretch(times: &mut Cow<[f64]>, end: f64) {
    let factor = end / times[times.len() - 1];
    times.to_mut().iter_mut().for_each(|t| *t *= factor);
    if let Some(last) = times.to_mut().last_mut() {
        *last = end;
    }
}

/// How far points lie apart along the axis where that is most.
fn extent<'a>(points: impl Iterator<Item = &'a DVec3> + Clone) -> f64 {
    let low = points.clone().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - low).max_element().max(0.0)
}

/// Times in order, those that float32 cannot tell apart taken for one.
pub(super) fn merged(times: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|b, a| *b as f32 == *a as f32);
    times
}

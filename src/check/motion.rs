//! Compares the clips of a file with the curves through an input's keys.
//!
//! The file says in its animations' `extras` how it was made; a file that does not say
//! it (another program wrote it again) needs to be told.

mod over_time;

pub use over_time::{Limit, Watched, over_time};

use super::against::{self, Curve, Difference, Largest};
use super::proof::{self, Outcome};
use super::{Code, Report};
use crate::asset::play::Clip;
use crate::asset::{self, Asset};
use crate::clip::Body;
use crate::curve::{Ends, Scheme, Tcb};
use crate::math::Quat;
use crate::moves::{self, Copies, Ground, Inputs, Move, Mover, Orient, Shape, Stream};
use crate::orient::{Axis, Frame, Level};
use crate::path::{Ease, PathEnds, Timing};
use crate::read::Order;
use serde::{Deserialize, Serialize};

/// What a user may say of a file that does not say it itself, or otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub struct Given {
    /// The scheme of the clips.
    pub scheme: Option<Scheme>,
    /// The ends of the clips.
    pub ends: Option<Ends>,
    /// The largest angle allowed, degrees.
    pub max_error: Option<f64>,
    /// The largest distance allowed, units.
    pub max_distance: Option<f64>,
}

/// How far one clip is from its curve.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipMotion {
    /// Name of the clip.
    pub clip: String,
    /// The scheme of the curve.
    pub scheme: &'static str,
    /// The ends of the curve.
    pub ends: &'static str,
    /// By box, and of the root where it moves.
    pub boxes: Vec<NodeMotion>,
}

/// How far one node is from its curve.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct NodeMotion {
    /// Name of the node.
    pub node: String,
    /// `rotation`, measured in degrees, or `translation`, in units.
    pub property: &'static str,
    /// The largest angle or distance allowed, if there is a limit.
    pub limit: Option<f64>,
    /// Whether it is proven that it stays within the limit at all times. False where there
    /// is none, and of what nothing is known but its values.
    pub proven: bool,
    /// At keys, at samples, and between samples.
    #[serde(flatten)]
    pub difference: Difference,
}

/// Why a file was not compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Neither the file nor the user says how it was made.
    #[error(
        "no clip says how it was made: name its scheme by --scheme and its ends by --ends (natural where not \
         given); nodes are matched by name"
    )]
    NoRecipe,
    /// A clip has no node of a name that the input moves.
    #[error("clip {0}: expected a node named {1}, which the input moves, found none")]
    NoNode(String, String),
    /// A clip says a scheme or ends that this version does not know.
    #[error("clip {0} says that it was made by {1}, which this version does not know")]
    Unknown(String, String),
    /// The inputs make no motion by what the file says.
    #[error(transparent)]
    Moves(#[from] moves::Error),
    /// The file cannot be read.
    #[error(transparent)]
    Asset(#[from] asset::Error),
}

/// What is compared beyond a stored bound: float32 and the arithmetic of players.
const MARGIN: f64 = 1e-3;

/// What a clip says of itself; what it does not say is as usual.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Recipe {
    scheme: String,
    ends: String,
    tension: f64,
    continuity: f64,
    bias: f64,
    quat_order: Option<String>,
    time_scale: Option<f64>,
    orient: Option<String>,
    path_ends: Option<String>,
    timing: Option<String>,
    ease: Option<String>,
    speed: Option<f64>,
    frame: Option<String>,
    bank: f64,
    level_start: usize,
    level_end: usize,
    model_forward: String,
    model_up: String,
    repeat: usize,
    delay: Option<f64>,
    no_wrap: bool,
    inputs: Vec<Input>,
    deviation_degrees: Vec<Option<f64>>,
    measured_degrees: Vec<Option<f64>>,
    deviation_units: Option<f64>,
    tolerance: Option<f64>,
    tolerance_distance: Option<f64>,
}

impl Default for Recipe {
    fn default() -> Recipe {
        Recipe {
            scheme: String::new(),
            ends: "natural".into(),
            tension: 0.0,
            continuity: 0.0,
            bias: 0.0,
            quat_order: None,
            time_scale: None,
            orient: None,
            path_ends: None,
            timing: None,
            ease: None,
            speed: None,
            frame: None,
            bank: 0.0,
            level_start: 0,
            level_end: 0,
            model_forward: "Z".into(),
            model_up: "Y".into(),
            repeat: 1,
            delay: None,
            no_wrap: false,
            inputs: Vec::new(),
            deviation_degrees: Vec::new(),
            measured_degrees: Vec::new(),
            deviation_units: None,
            tolerance: None,
            tolerance_distance: None,
        }
    }
}

#[derive(Clone, Debug, Deserialize)]
struct Input {
    name: String,
    blake3: String,
}

/// How much more than was measured there may be between the places that were looked at: a
/// parabola that peaks between quarters has at least 60 / 64 of its height at one of them.
const UNSEEN: f64 = 64.0 / 60.0;

impl Recipe {
    /// How far each rotation may be off, by what the file states.
    fn degrees(&self) -> Vec<Option<f64>> {
        let measured = |i: usize| Some(self.measured_degrees.get(i).copied().flatten()? * UNSEEN);
        let bounds = self.deviation_degrees.iter().enumerate();
        bounds.map(|(i, proven)| proven.or_else(|| measured(i))).collect()
    }

    /// What shapes the motion, or the word that this version does not know.
    fn shape(&self) -> Result<Shape, String> {
        fn known<T>(word: &str, from_name: fn(&str) -> Option<T>) -> Result<T, String> {
            from_name(word).ok_or_else(|| word.to_owned())
        }
        fn said<T>(word: &Option<String>, from_name: fn(&str) -> Option<T>) -> Result<Option<T>, String> {
            word.as_ref().map(|word| known(word, from_name)).transpose()
        }
        Ok(Shape {
            ends: known(&self.ends, Ends::from_name)?,
            tcb: Tcb { tension: self.tension, continuity: self.continuity, bias: self.bias },
            path_ends: said(&self.path_ends, PathEnds::from_name)?.unwrap_or_default(),
            timing: said(&self.timing, Timing::from_name)?,
            ease: said(&self.ease, Ease::from_name)?.unwrap_or_default(),
            speed: self.speed,
            time_scale: self.time_scale.unwrap_or(1.0),
            frame: said(&self.frame, Frame::from_name)?,
            orient: said(&self.orient, Orient::from_name)?,
            bank: self.bank,
            level: Level { start: self.level_start, end: self.level_end },
            model_forward: known(&self.model_forward, Axis::from_name)?,
            model_up: known(&self.model_up, Axis::from_name)?,
            copies: Copies { count: self.repeat.max(1), delay: self.delay, wrap: !self.no_wrap },
        })
    }
}

/// The order of quaternions' parts in which the file's input was read, where it says so.
pub fn quat_order(asset: &Asset) -> Option<Order> {
    let recipes = (0..asset.root().animations.len()).filter_map(|i| recipe(asset, i));
    recipes.filter_map(|recipe| Order::from_name(recipe.quat_order.as_deref()?)).next()
}

/// Whose axes the file's inputs are in, where a flag said so.
pub fn frame(asset: &Asset) -> Option<Frame> {
    let recipes = (0..asset.root().animations.len()).filter_map(|i| recipe(asset, i));
    recipes.filter_map(|recipe| Frame::from_name(recipe.frame.as_deref()?)).next()
}

/// Whether any clip of the file says how it was made.
pub fn says(asset: &Asset) -> bool {
    (0..asset.root().animations.len()).any(|i| recipe(asset, i).is_some())
}

fn recipe(asset: &Asset, animation: usize) -> Option<Recipe> {
    let recipe: Recipe =
        serde_json::from_str(asset.root().animations.get(animation)?.extras.as_ref()?.get()).ok()?;
    (!recipe.scheme.is_empty()).then_some(recipe)
}

/// Compares every clip of the file that has a curve, and adds what is amiss to `report`.
pub fn compare(
    asset: &mut Asset,
    inputs: &Inputs,
    given: Given,
    report: &mut Report,
) -> Result<Vec<ClipMotion>, Error> {
    let mut compared = Vec::new();
    for clip in asset.clips() {
        let recipe = recipe(asset, clip.animation);
        let Some((scheme, shape)) = curve_of(&clip, recipe.as_ref(), given)? else { continue };
        let ground = Ground::new(inputs, shape, &[scheme])?;
        if let Some(recipe) = &recipe {
            note_changed_inputs(&clip, recipe, inputs, report);
        }
        let mut boxes = Vec::new();
        for copy in 0..ground.stream().count {
            let mut limits = Limits::new(recipe.as_ref(), given);
            for (mover, a_move) in ground.moves(scheme) {
                let limit = limits.next(&a_move);
                let wanted = Wanted { node: node_name(mover, copy, inputs), copy, a_move, limit };
                boxes.extend(node(asset, &clip, &ground, &wanted, report)?);
            }
        }
        let (scheme, ends) = (scheme.name(), shape.ends.name());
        compared.push(ClipMotion { clip: name(&clip), scheme, ends, boxes });
    }
    if compared.is_empty() { Err(Error::NoRecipe) } else { Ok(compared) }
}

/// What each move may be off, in their order: what the user says, else what the file
/// states, and a margin.
struct Limits {
    given: Given,
    degrees: std::vec::IntoIter<Option<f64>>,
    units: Option<f64>,
}

impl Limits {
    fn new(recipe: Option<&Recipe>, given: Given) -> Limits {
        let degrees = recipe.map(Recipe::degrees).unwrap_or_default();
        Limits {
            given,
            degrees: degrees.into_iter(),
            units: recipe.and_then(|recipe| recipe.deviation_units),
        }
    }

    fn next(&mut self, a_move: &Move) -> Option<f64> {
        let stated = self.stated(a_move);
        match a_move {
            // float32 players lose a few of its steps.
            Move::Travel(_) => self.given.max_distance.or(stated.map(|bound| bound * (1.0 + MARGIN) + 1e-6)),
            Move::Keys(_) | Move::Attitude(_) => self.given.max_error.or(stated.map(|bound| bound + MARGIN)),
        }
    }

    /// What the file states of the next move.
    fn stated(&mut self, a_move: &Move) -> Option<f64> {
        match a_move {
            Move::Travel(_) => self.units,
            Move::Keys(_) | Move::Attitude(_) => self.degrees.next().flatten(),
        }
    }
}

/// The curve that a clip should follow: what the user says, else what the file says. A
/// clip that is named after another scheme than the given one is not meant.
fn curve_of(clip: &Clip, recipe: Option<&Recipe>, given: Given) -> Result<Option<(Scheme, Shape)>, Error> {
    let unknown = |word: &str| Error::Unknown(name(clip), word.to_owned());
    let said = match recipe {
        Some(recipe) => Some(Scheme::from_name(&recipe.scheme).ok_or_else(|| unknown(&recipe.scheme))?),
        None => None,
    };
    let Some(scheme) = given.scheme.or(said) else { return Ok(None) };
    let shape = recipe.map_or_else(|| Ok(Shape::default()), Recipe::shape).map_err(|word| unknown(&word))?;
    let shape = Shape { ends: given.ends.unwrap_or(shape.ends), ..shape };
    let suffixed = |scheme: &Scheme| name(clip).ends_with(&format!("-{}", scheme.name()));
    let named_after = Scheme::EVERY.iter().copied().filter(suffixed).max_by_key(|scheme| scheme.name().len());
    let meant = said.is_some() || named_after.is_none_or(|named| named == scheme);
    Ok(meant.then_some((scheme, shape)))
}

fn name(clip: &Clip) -> String {
    clip.name.clone().unwrap_or_else(|| format!("animation {}", clip.animation))
}

/// The name of the node that a move of a copy belongs to.
fn node_name(mover: Mover, copy: usize, inputs: &Inputs) -> String {
    let name = match (mover, &inputs.keyframes) {
        (Mover::Root, _) => "root".to_owned(),
        (Mover::Track(_), Some(keyframes)) if keyframes.clip.body == Body::Free => "body".to_owned(),
        (Mover::Track(track), _) => format!("box{}", track + 1),
    };
    if copy == 0 { name } else { format!("{name}-{}", copy + 1) }
}

fn note_changed_inputs(clip: &Clip, recipe: &Recipe, inputs: &Inputs, report: &mut Report) {
    for (input, hash) in
        recipe.inputs.iter().zip(inputs.hashes()).filter(|(input, hash)| input.blake3 != *hash)
    {
        let message = format!(
            "clip {} was made from an input ({}) whose BLAKE3 hash begins with {:.12}; this one's begins with \
             {hash:.12}; convert again if the new input is the one that is meant",
            name(clip),
            input.name,
            input.blake3
        );
        report.add(Code::InputChanged, format!("/animations/{}/extras", clip.animation), message);
    }
}

/// What a node of the file should do.
struct Wanted<'a> {
    node: String,
    copy: usize,
    a_move: Move<'a>,
    limit: Option<f64>,
}

fn node(
    asset: &mut Asset,
    clip: &Clip,
    ground: &Ground,
    wanted: &Wanted,
    report: &mut Report,
) -> Result<Option<NodeMotion>, Error> {
    let place = format!("/animations/{}", clip.animation);
    let Wanted { node, a_move, limit, .. } = wanted;
    let found = asset.root().nodes.iter().position(|n| n.name.as_deref() == Some(node.as_str()));
    let Some(index) = found else {
        let message = format!("expected a node named {node}, which the input moves, found none");
        report.add(Code::MotionDiffers, place, message);
        return Ok(None);
    };
    let keys = compared_keys(ground, clip, wanted);
    let (property, unit) =
        if a_move.travel().is_some() { ("translation", " units") } else { ("rotation", "°") };
    let mut difference =
        with_curve(ground, wanted, |curve| against::compare(asset, clip, index, &keys, curve))?;
    // What was looked at may keep the limit where other times do not.
    let outcome = match limit {
        Some(limit) if difference.largest().off <= *limit && ground.stream().count == 1 => {
            proven(asset, clip, index, ground, a_move, *limit)?
        }
        _ => None,
    };
    match outcome {
        Some(Outcome::Beyond { off, time }) => {
            difference.between = Largest { off, time, ..difference.between };
        }
        Some(Outcome::Open { bound, time }) => {
            let message = format!(
                "clip {}, {property} of node {node}: cannot be shown to stay within {:.6}{unit} of the curve: at \
                 about {time:.6} s it may be {bound:.6}{unit} off",
                name(clip),
                limit.unwrap_or_default()
            );
            report.add(Code::MotionDiffers, place.clone(), message);
        }
        Some(Outcome::Within) | None => {}
    }
    let worst = difference.largest();
    // Written so that a value that is no number exceeds every limit.
    if let Some(limit) = limit.filter(|&limit| worst.off.is_nan() || worst.off > limit) {
        let message = format!(
            "clip {}, {property} of node {node}: playback is up to {:.6}{unit} off the curve, at {:.6} s; at \
             most {limit:.6}{unit} is allowed",
            name(clip),
            worst.off,
            worst.time
        );
        report.add(Code::MotionDiffers, place, message);
    }
    let proven = outcome == Some(Outcome::Within);
    Ok(Some(NodeMotion { node: node.clone(), property, limit: *limit, proven, difference }))
}

/// Tries to prove the limit, where enough is known of the move.
fn proven(
    asset: &mut Asset,
    clip: &Clip,
    node: usize,
    ground: &Ground,
    a_move: &Move,
    limit: f64,
) -> Result<Option<Outcome>, Error> {
    Ok(match a_move {
        // What is held changes where the file's float32 time has the key, not the curve's.
        Move::Keys(motion) if motion.is_step() => None,
        Move::Keys(motion) => proof::rotation(asset, clip, node, motion, limit)?,
        Move::Travel(travel) => {
            proof::translation(asset, clip, node, (travel.as_ref(), ground.duration()), limit)?
        }
        Move::Attitude(_) => None,
    })
}

/// When a move is compared besides the file's own times.
fn compared_keys(ground: &Ground, clip: &Clip, wanted: &Wanted) -> Vec<f64> {
    let mut keys = keys(ground.knots(), ground.stream(), wanted.copy, clip.duration);
    if matches!(&wanted.a_move, Move::Keys(motion) if motion.is_step()) {
        keys.iter_mut().for_each(|t| *t = f64::from(*t as f32));
    }
    keys
}

/// What a move should do over time, as the comparison takes it.
fn with_curve<T>(ground: &Ground, wanted: &Wanted, with: impl FnOnce(&Curve) -> T) -> T {
    let Wanted { copy, a_move, .. } = wanted;
    let stream = ground.stream();
    match a_move {
        Move::Keys(_) | Move::Attitude(_) => with(&Curve::Rotation(&|t| {
            Quat::to_xyzw(stream.rotation(stream.moment(*copy, t), |t| turned(a_move, t)))
        })),
        Move::Travel(travel) => {
            with(&Curve::Translation(&|t| stream.place(stream.moment(*copy, t), |t| travel.at(t)).to_array()))
        }
    }
}

/// The rotation at a time. What is held until a key changes where the file's float32 time
/// has the key.
fn turned(a_move: &Move, t: f64) -> Quat {
    match a_move {
        Move::Keys(motion) if motion.is_step() => {
            let times = motion.times();
            // What the moment of a copy is rounded by is far less than from one float32 to the next.
            let next = times.partition_point(|&key| f64::from(key as f32) <= t * (1.0 + 1e-10));
            motion.at(times[next.saturating_sub(1)])
        }
        other => other.turned(t),
    }
}

/// When a copy passes the knots of the way, in order. The file ends at a float32 time:
/// what lies beyond it is compared there.
fn keys(knots: &[f64], stream: &Stream, copy: usize, end: f64) -> Vec<f64> {
    let phase = if stream.wraps() { stream.phase(copy) } else { 0.0 };
    let time = |&knot: &f64| match copy {
        0 => knot,
        // As float32 times have them: within a ramp a little makes much.
        _ if phase > 0.0 && knot >= phase => f64::from((knot - phase) as f32),
        _ => knot + stream.start(copy),
    };
    let mut keys: Vec<f64> = knots.iter().map(time).map(|t| t.min(end)).collect();
    keys.sort_by(f64::total_cmp);
    keys
}

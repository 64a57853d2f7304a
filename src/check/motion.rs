//! Compares the clips of a file with the curves through an input's keys.
//!
//! The file says in its animations' `extras` how it was made; a file that does not say
//! it (another program wrote it again) needs to be told.

use super::against::{self, Difference};
use super::{Code, Report};
use crate::asset::play::Clip;
use crate::asset::{self, Asset};
use crate::clip::Body;
use crate::curve::{Ends, Motion, NotClosed, Scheme};
use crate::math::Quat;
use crate::read::{Keyframes, Order};
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
    /// By box.
    pub boxes: Vec<NodeMotion>,
}

/// How far one node is from its curve.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct NodeMotion {
    /// Name of the node.
    pub node: String,
    /// The largest angle allowed, degrees, if there is a limit.
    pub limit: Option<f64>,
    /// Angles at keys, at samples, and between samples.
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
    /// A clip says a scheme or ends that this version does not know.
    #[error("clip {0} says that it was made by {1}, which this version does not know")]
    Unknown(String, String),
    /// The input's ends do not meet.
    #[error(transparent)]
    NotClosed(#[from] NotClosed),
    /// The file cannot be read.
    #[error(transparent)]
    Asset(#[from] asset::Error),
}

/// What is compared beyond a stored bound: float32 and the arithmetic of players.
const MARGIN: f64 = 1e-3;

/// What a clip says of itself.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Recipe {
    scheme: String,
    ends: String,
    #[serde(default)]
    quat_order: Option<String>,
    #[serde(default)]
    inputs: Vec<Input>,
    #[serde(default)]
    deviation_degrees: Vec<Option<f64>>,
}

#[derive(Clone, Debug, Deserialize)]
struct Input {
    name: String,
    blake3: String,
}

/// The order of quaternions' parts in which the file's input was read, where it says so.
pub fn quat_order(asset: &Asset) -> Option<Order> {
    let recipes = (0..asset.root().animations.len()).filter_map(|i| recipe(asset, i));
    recipes.filter_map(|recipe| Order::from_name(recipe.quat_order.as_deref()?)).next()
}

fn recipe(asset: &Asset, animation: usize) -> Option<Recipe> {
    serde_json::from_str(asset.root().animations.get(animation)?.extras.as_ref()?.get()).ok()
}

/// Compares every clip of the file that has a curve, and adds what is amiss to `report`.
pub fn compare(
    asset: &mut Asset,
    keyframes: &Keyframes,
    given: Given,
    report: &mut Report,
) -> Result<Vec<ClipMotion>, Error> {
    let mut compared = Vec::new();
    for clip in asset.clips() {
        let recipe = recipe(asset, clip.animation);
        let Some((scheme, ends)) = curve_of(&clip, recipe.as_ref(), given)? else { continue };
        if scheme != Scheme::Slerp {
            ends.accept(&keyframes.clip)?;
        }
        if let Some(recipe) = &recipe {
            note_changed_input(&clip, recipe, keyframes, report);
        }
        let stored = recipe.map(|recipe| recipe.deviation_degrees).unwrap_or_default();
        let limit = |track: usize| {
            given.max_error.or(stored.get(track).copied().flatten().map(|bound| bound + MARGIN))
        };
        let mut boxes = Vec::new();
        for track in 0..keyframes.clip.tracks.len() {
            let motion = Motion::new(&keyframes.clip.times, &keyframes.clip.tracks[track], scheme, ends);
            boxes.extend(node(asset, &clip, track, keyframes, &motion, limit(track), report)?);
        }
        compared.push(ClipMotion { clip: name(&clip), scheme: scheme.name(), ends: ends.name(), boxes });
    }
    if compared.is_empty() { Err(Error::NoRecipe) } else { Ok(compared) }
}

/// The curve that a clip should follow: what the user says, else what the file says. A
/// clip that is named after another scheme than the given one is not meant.
fn curve_of(clip: &Clip, recipe: Option<&Recipe>, given: Given) -> Result<Option<(Scheme, Ends)>, Error> {
    let unknown = |word: &String| Error::Unknown(name(clip), word.clone());
    let said = match recipe {
        Some(Recipe { scheme, ends, .. }) => {
            let scheme = Scheme::from_name(scheme).ok_or_else(|| unknown(scheme))?;
            Some((scheme, Ends::from_name(ends).ok_or_else(|| unknown(ends))?))
        }
        None => None,
    };
    let Some(scheme) = given.scheme.or(said.map(|said| said.0)) else { return Ok(None) };
    let ends = given.ends.or(said.map(|said| said.1)).unwrap_or_default();
    let suffixed = |scheme: &Scheme| name(clip).ends_with(&format!("-{}", scheme.name()));
    let named_after = Scheme::ALL.iter().copied().filter(suffixed).max_by_key(|scheme| scheme.name().len());
    let meant = said.is_some() || named_after.is_none_or(|named| named == scheme);
    Ok(meant.then_some((scheme, ends)))
}

fn name(clip: &Clip) -> String {
    clip.name.clone().unwrap_or_else(|| format!("animation {}", clip.animation))
}

fn note_changed_input(clip: &Clip, recipe: &Recipe, keyframes: &Keyframes, report: &mut Report) {
    if let [input] = recipe.inputs.as_slice()
        && input.blake3 != keyframes.hash
    {
        let message = format!(
            "clip {} was made from an input ({}) whose BLAKE3 hash begins with {:.12}; this one's begins with \
             {:.12}; convert again if the new input is the one that is meant",
            name(clip),
            input.name,
            input.blake3,
            keyframes.hash
        );
        report.add(Code::InputChanged, format!("/animations/{}/extras", clip.animation), message);
    }
}

fn node(
    asset: &mut Asset,
    clip: &Clip,
    track: usize,
    keyframes: &Keyframes,
    motion: &Motion,
    limit: Option<f64>,
    report: &mut Report,
) -> Result<Option<NodeMotion>, Error> {
    let wanted = match keyframes.clip.body {
        Body::Chain { .. } => format!("box{}", track + 1),
        Body::Free => "body".to_owned(),
    };
    let place = format!("/animations/{}", clip.animation);
    let found = asset.root().nodes.iter().position(|node| node.name.as_deref() == Some(&wanted));
    let Some(index) = found else {
        let message = format!("expected a node named {wanted} for the input's box {}, found none", track + 1);
        report.add(Code::MotionDiffers, place, message);
        return Ok(None);
    };
    // The file ends at a float32 time: keys beyond it are compared there.
    let keys: Vec<f64> = keyframes.clip.times.iter().map(|&t| t.min(clip.duration)).collect();
    let curve = |t: f64| Quat::to_xyzw(motion.at(t));
    let difference = against::rotation(asset, clip, index, &keys, &curve)?;
    let worst = difference.largest();
    // Written so that an angle that is no number exceeds every limit.
    if let Some(limit) = limit.filter(|&limit| worst.degrees.is_nan() || worst.degrees > limit) {
        let message = format!(
            "clip {}, node {wanted}: playback is up to {:.6}° off the curve, at {:.6} s; at most {limit:.6}° is \
             allowed",
            name(clip),
            worst.degrees,
            worst.time
        );
        report.add(Code::MotionDiffers, place, message);
    }
    Ok(Some(NodeMotion { node: wanted, limit, difference }))
}

//! What a clip of the output is made from and how, as its `extras` say it.

use super::Options;
use super::facts::rounded_up;
use crate::curve::Scheme;
use crate::moves::{Ground, Orient};
use crate::path::{Ease, PathEnds};
use crate::sample::TrackFacts;
use serde::Serialize;

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Recipe<'a> {
    dat2glb: &'a str,
    scheme: &'a str,
    ends: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    tension: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    continuity: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bias: Option<f64>,
    fps: String,
    key_times: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    quat_order: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_scale: Option<f64>,
    #[serde(flatten)]
    path: Option<PathRecipe<'a>>,
    inputs: Vec<Input<'a>>,
    /// Upper bounds of the angle between playback (slerp) and the curve, degrees, by box
    /// and last of the root, where it turns; null where nothing is known between samples.
    deviation_degrees: Vec<Option<f64>>,
    /// An upper bound of the distance between playback and the path.
    #[serde(skip_serializing_if = "Option::is_none")]
    deviation_units: Option<f64>,
}

/// What is said where there is a path; left out what was not asked for.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PathRecipe<'a> {
    orient: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    path_ends: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    timing: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ease: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bank: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    level_start: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    level_end: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model_forward: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model_up: Option<&'a str>,
}

#[derive(Serialize)]
struct Input<'a> {
    name: &'a str,
    blake3: &'a str,
}

/// The recipe as JSON.
pub(super) fn recipe(
    ground: &Ground,
    options: &Options,
    scheme: Scheme,
    tracks: &[TrackFacts],
    distance: Option<f64>,
) -> String {
    let inputs = ground.inputs();
    let keyframes = inputs.keyframes.as_ref();
    let hashes = keyframes.map(|k| &k.hash).into_iter().chain(inputs.path.as_ref().map(|p| &p.hash));
    let shape = ground.shape();
    let said = |x: f64| (scheme.has_tcb() && x != 0.0).then_some(x);
    let recipe = Recipe {
        dat2glb: env!("CARGO_PKG_VERSION"),
        scheme: scheme.name(),
        ends: shape.ends.name(),
        tension: said(shape.tcb.tension),
        continuity: said(shape.tcb.continuity),
        bias: said(shape.tcb.bias),
        fps: options.fps.to_string(),
        key_times: options.key_times,
        quat_order: keyframes.map(|keyframes| keyframes.order.name()),
        time_scale: (shape.time_scale != 1.0).then_some(shape.time_scale),
        path: inputs.path.as_ref().map(|_| path_recipe(ground, ground.orient())),
        inputs: options.inputs.iter().zip(hashes).map(|(name, blake3)| Input { name, blake3 }).collect(),
        deviation_degrees: tracks.iter().map(|track| track.deviation.map(rounded_up)).collect(),
        deviation_units: distance.map(rounded_up),
    };
    serde_json::to_string(&recipe).expect("plain data becomes JSON")
}

fn path_recipe<'a>(ground: &Ground, orient: Orient) -> PathRecipe<'a> {
    let shape = ground.shape();
    let (forward, up) = (shape.model_forward.name(), shape.model_up.name());
    PathRecipe {
        orient: orient.name(),
        path_ends: (shape.path_ends != PathEnds::default()).then(|| shape.path_ends.name()),
        timing: shape.timing.map(|timing| timing.name()),
        ease: (shape.ease != Ease::None).then(|| shape.ease.name()),
        speed: shape.speed,
        frame: shape.frame.map(|frame| frame.name()),
        bank: (shape.bank != 0.0).then_some(shape.bank),
        level_start: (shape.level.start > 0).then_some(shape.level.start),
        level_end: (shape.level.end > 0).then_some(shape.level.end),
        model_forward: (forward != "Z").then_some(forward),
        model_up: (up != "Y").then_some(up),
    }
}

//! What a clip of the output is made from and how, as its `extras` say it.

use super::facts::{ClipFacts, rounded_up};
use super::{Fewest, Options, Sampling};
use crate::curve::Scheme;
use crate::moves::{Ground, Orient};
use crate::path::{Ease, PathEnds};
use crate::read::Order;
use crate::sample::{Encoding, TrackFacts};
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
    #[serde(skip_serializing_if = "Option::is_none")]
    fps: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    key_times: Option<bool>,
    #[serde(flatten)]
    fewest: Option<FewestRecipe>,
    #[serde(skip_serializing_if = "Option::is_none")]
    interpolation: Option<&'static str>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    quantized: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    quat_order: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_scale: Option<f64>,
    #[serde(flatten)]
    path: Option<PathRecipe<'a>>,
    /// How many objects go the same way, seconds from one to the next, and whether each
    /// is hidden until it starts.
    #[serde(skip_serializing_if = "Option::is_none")]
    repeat: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    delay: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_wrap: Option<bool>,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    cameras: &'a [String],
    inputs: Vec<Input<'a>>,
    /// Upper bounds of the angle between playback (slerp) and the curve, degrees, by box
    /// and last of the root, where it turns; null where nothing is known between samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    deviation_degrees: Option<Vec<Option<f64>>>,
    /// The same for players that blend the four numbers and normalise.
    #[serde(skip_serializing_if = "Option::is_none")]
    nlerp_degrees: Option<Vec<Option<f64>>>,
    /// Where nothing is known between samples, the largest angle that was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    measured_degrees: Option<Vec<Option<f64>>>,
    /// An upper bound of the distance between playback and the path.
    #[serde(skip_serializing_if = "Option::is_none")]
    deviation_units: Option<f64>,
    /// An upper bound of how far a corner of the chain can be from where it should be.
    #[serde(skip_serializing_if = "Option::is_none")]
    displacement_units: Option<f64>,
}

/// What is said where keys were chosen by a tolerance.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct FewestRecipe {
    tolerance: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance_distance: Option<f64>,
    max_step: f64,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    on_curve: bool,
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
pub(super) fn recipe(ground: &Ground, options: &Options, scheme: Scheme, facts: &ClipFacts) -> String {
    let inputs = ground.inputs();
    let (shape, stream) = (ground.shape(), ground.stream());
    let copies = stream.count > 1;
    let (rate, fewest) = match options.sampling {
        Sampling::Rate { fps, key_times } => (Some((fps, key_times)), None),
        Sampling::Fewest(fewest) => (None, Some(fewest_recipe(fewest))),
    };
    let tracks = |figure: fn(&TrackFacts) -> Option<f64>| {
        let all = facts.tracks.iter().map(|track| figure(track).map(rounded_up)).collect();
        Some(all).filter(|_| options.writing.bound)
    };
    let measured = facts.tracks.iter().any(|track| track.measured.is_some());
    let said = |x: f64| (scheme.has_tcb() && x != 0.0).then_some(x);
    let recipe = Recipe {
        dat2glb: env!("CARGO_PKG_VERSION"),
        scheme: scheme.name(),
        ends: shape.ends.name(),
        tension: said(shape.tcb.tension),
        continuity: said(shape.tcb.continuity),
        bias: said(shape.tcb.bias),
        fps: rate.map(|(fps, _)| fps.to_string()),
        key_times: rate.map(|(_, key_times)| key_times),
        fewest,
        interpolation: interpolation(options),
        quantized: options.writing.encoding == Encoding::Normalized16,
        quat_order: options.quat_order.map(Order::name),
        time_scale: (shape.time_scale != 1.0).then_some(shape.time_scale),
        path: inputs.path.as_ref().map(|_| path_recipe(ground, ground.orient())),
        repeat: copies.then_some(stream.count),
        delay: copies.then_some(stream.delay),
        no_wrap: (copies && !stream.wrap).then_some(true),
        cameras: &options.cameras,
        inputs: options
            .inputs
            .iter()
            .zip(inputs.hashes())
            .map(|(name, blake3)| Input { name, blake3 })
            .collect(),
        deviation_degrees: tracks(|track| track.deviation),
        nlerp_degrees: tracks(|track| track.nlerp),
        measured_degrees: tracks(|track| track.measured).filter(|_| measured),
        deviation_units: facts.deviation_units,
        displacement_units: facts.displacement_units,
    };
    serde_json::to_string(&recipe).expect("plain data becomes JSON")
}

/// What is not LINEAR, in glTF's word.
fn interpolation(options: &Options) -> Option<&'static str> {
    match options.sampling {
        Sampling::Rate { .. } => options.writing.hold.then_some("STEP"),
        Sampling::Fewest(fewest) => fewest.cubic.then_some("CUBICSPLINE"),
    }
}

fn fewest_recipe(fewest: Fewest) -> FewestRecipe {
    let Fewest { tolerance, distance, max_step, on_curve, .. } = fewest;
    FewestRecipe { tolerance, tolerance_distance: distance, max_step, on_curve }
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

//! The same file with fewer keys: any glTF file's animations reduced, all else in it
//! left byte for byte as it was.
//!
//! What is measured is the distance from the input's own playback. Nothing is numbered
//! anew, so that whatever refers to an object by its index finds it. How it is done:
//! docs/reduce.md.

mod content;
mod curves;
mod file;
mod found;
mod json;
mod keys;
mod layout;
mod many;
mod plan;
mod refs;
mod subset;
mod track;
mod verify;

#[cfg(test)]
mod tests;

pub use file::{External, Reduced};
pub use verify::{Strayed, strayed};

use crate::asset::{self, Asset};
use crate::reduce;
use rayon::prelude::*;
use serde::Serialize;

/// How far playback may stray from the input's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Rotations, degrees; at least [`reduce::Options::LEAST_DEGREES`].
    pub rotation: f64,
    /// Translations, units; none where they may lose no more than float32's rounding.
    pub distance: Option<f64>,
    /// Scales, as [`Options::distance`].
    pub scale: Option<f64>,
    /// Weights of morph targets, as [`Options::distance`].
    pub weight: Option<f64>,
    /// How far rotations may turn from key to key, degrees.
    pub max_step: Option<f64>,
    /// New keys stay on the input's curve.
    pub on_curve: bool,
}

impl Options {
    /// A tolerance for rotations; all else loses nothing.
    pub fn new(rotation: f64) -> Options {
        Options { rotation, distance: None, scale: None, weight: None, max_step: None, on_curve: false }
    }

    /// The tolerances.
    pub fn allowed(&self) -> Strayed {
        Strayed {
            degrees: self.rotation,
            units: self.distance.unwrap_or(0.0),
            scale: self.scale.unwrap_or(0.0),
            weight: self.weight.unwrap_or(0.0),
        }
    }
}

/// Why a file cannot be reduced.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A part of the file cannot be read.
    #[error("{0}")]
    Asset(#[from] asset::Error),
    /// An extension uses bytes of buffers in its own way.
    #[error(
        "{pointer}: expected buffers that only accessors and images use, found an extension {}",
        if *.compressed {
            "that compresses them: decompress the file first, reduce it, and compress it again"
        } else {
            "that may refer to their bytes, which would move: take it out first"
        }
    )]
    Extension {
        /// JSON pointer to the extension.
        pointer: String,
        /// It is one of the known ones that compress buffer views.
        compressed: bool,
    },
    /// The tolerance for rotations is too small for float32.
    #[error("expected a tolerance of {least:.0e}° or more, found {found:e}°: float32 numbers need that much")]
    Tolerance {
        /// What was asked for, degrees.
        found: f64,
        /// What is possible.
        least: f64,
    },
    /// The JSON is not built as glTF's is.
    #[error("{0}: expected what the glTF 2.0 schema has there")]
    Json(String),
    /// The reduced file does not fit its container.
    #[error("the reduced file would have {0} bytes, and a .glb can have 4294967295")]
    TooLarge(u64),
}

/// What became of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Facts {
    /// One for each animation of the file.
    pub clips: Vec<ClipFacts>,
    /// Bytes of the file and of all buffers beside it that change.
    pub bytes_before: u64,
    /// The same afterwards.
    pub bytes_after: u64,
}

/// What became of a clip. Keys are those of its samplers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipFacts {
    /// Its name, where it has one.
    pub name: Option<String>,
    /// Keys in the input.
    pub keys_before: usize,
    /// Keys in the output.
    pub keys_after: usize,
    /// Upper bounds of the distance between both playbacks.
    pub deviation: Strayed,
}

/// Reduces a file; `uri` names a buffer's new file by sixteen digits of its content's hash.
///
/// Memory as much as the new file and its keys take, and two of its longest channels or
/// 8 MB of shorter ones.
pub fn reduce(
    asset: &mut Asset,
    options: &Options,
    uri: impl FnMut(&str) -> String,
) -> Result<Reduced, Error> {
    let least = reduce::Options::LEAST_DEGREES;
    if options.rotation.is_nan() || options.rotation < least {
        return Err(Error::Tolerance { found: options.rotation, least });
    }
    let fixed = refs::fixed(asset)?;
    let found = found(asset, options)?;
    let changes = plan::changes(asset, &fixed, found);
    file::write(asset, &fixed, changes, uri)
}

/// Numbers of keys read at once, but for a longer track.
const AT_ONCE: usize = 1 << 20;

/// Fewer keys for all samplers that can be reduced and for which there are. Some are read
/// while others are reduced.
fn found(asset: &mut Asset, options: &Options) -> Result<Vec<plan::Change>, Error> {
    let samplers = asset.root().animations.iter().enumerate();
    let samplers = samplers.flat_map(|(a, animation)| (0..animation.samplers.len()).map(move |s| (a, s)));
    let mut samplers = samplers.collect::<Vec<_>>().into_iter();
    let mut all = Vec::new();
    let mut tracks = read(asset, &mut samplers)?;
    while !tracks.is_empty() {
        let (found, next) = rayon::join(|| reduced(&tracks, options), || read(asset, &mut samplers));
        all.extend(found);
        tracks = next?;
    }
    Ok(all)
}

/// The next tracks; none after the last.
fn read(
    asset: &mut Asset,
    samplers: &mut impl Iterator<Item = (usize, usize)>,
) -> Result<Vec<track::Track>, Error> {
    let (mut tracks, mut numbers) = (Vec::new(), 0);
    while numbers < AT_ONCE
        && let Some((animation, sampler)) = samplers.next()
    {
        if let Some(track) = track::Track::read(asset, animation, sampler)? {
            numbers += track.times.len() + track.values.len();
            tracks.push(track);
        }
    }
    Ok(tracks)
}

fn reduced(tracks: &[track::Track], options: &Options) -> Vec<plan::Change> {
    let reduced = tracks.par_iter().map(|track| {
        let found = keys::fewest(track, options)?;
        Some(plan::Change { sampler: track.sampler, found })
    });
    reduced.flatten().collect()
}

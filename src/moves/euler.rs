//! Euler angles as keys.

use super::Error;
use crate::clip::{Body, Clip};
use crate::math::Quat;
use crate::orient::{Euler, Frame};
use crate::read::{Keyframes, Order, Rotations, RotationsFile};

/// Euler angles as rotation keys of one free body, in glTF's frame; without times they are
/// evenly spaced, and without a duration a second apart. `frame` says whose axes are meant
/// where the file does not.
pub fn euler_keys(file: RotationsFile, frame: Option<Frame>) -> Result<Keyframes, Error> {
    let frame = frame.or(file.frame).unwrap_or(file.rotations.usual_frame());
    let Rotations::Euler(angles) = &file.rotations else {
        return Err(Error::Controls(file.rotations.name()));
    };
    let even = |i: usize| i as f64 * file.duration.map_or(1.0, |seconds| seconds / (angles.len() - 1) as f64);
    let times = file.times.unwrap_or_else(|| (0..angles.len()).map(even).collect());
    let mut track: Vec<Quat> = Vec::with_capacity(angles.len());
    for &[roll, pitch, yaw] in angles {
        let key = frame.rotation_to_gltf(Euler { roll, pitch, yaw }.rotation());
        track.push(track.last().map_or(key, |&before| key.aligned_to(before)));
    }
    let clip = Clip { body: Body::Free, start: file.start, times, tracks: vec![track], lines: file.lines };
    Ok(Keyframes {
        clip,
        order: Order::default(),
        warnings: file.warnings,
        largest_norm_error: file.largest_norm_error,
        hash: file.hash,
        bytes: file.bytes,
    })
}

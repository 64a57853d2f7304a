//! Rotations of one body as keys, or as control rotations, of a clip.

use super::camera::backwards;
use crate::clip::{Body, Clip, Through};
use crate::math::Quat;
use crate::orient::{Euler, Frame};
use crate::read::{Keyframes, Order, Rotations, RotationsFile};

/// Rotations of one free body in glTF's frame. Without times, keys (or segments between
/// control rotations) are evenly spaced, and without a duration a second apart. `frame`
/// says whose axes are meant where the file does not. Of a rotation's two quaternions each
/// is the one nearer to the one before it.
pub fn rotation_keys(file: RotationsFile, frame: Option<Frame>) -> Keyframes {
    let frame = frame.or(file.frame).unwrap_or(file.rotations.usual_frame());
    let euler = |&[roll, pitch, yaw]: &[f64; 3]| Euler { roll, pitch, yaw }.rotation();
    let (rotations, through): (Vec<Quat>, Through) = match &file.rotations {
        Rotations::Euler(angles) => (angles.iter().map(euler).collect(), Through::Keys),
        Rotations::EulerBezier(angles) => (angles.iter().map(euler).collect(), Through::Controls),
        Rotations::QuatBezier(rotations) => (rotations.clone(), Through::Controls),
    };
    let mut track: Vec<Quat> = Vec::with_capacity(rotations.len());
    for rotation in rotations {
        let rotation = frame.rotation_to_gltf(rotation);
        track.push(track.last().map_or(rotation, |&before| rotation.aligned_to(before)));
    }
    let intervals = through.times(track.len()) - 1;
    let even = |i: usize| i as f64 * file.duration.map_or(1.0, |seconds| seconds / intervals as f64);
    let untimed = file.times.is_none() && file.duration.is_none();
    let times = file.times.unwrap_or_else(|| (0..=intervals).map(even).collect());
    let (body, start, tracks, lines) = (Body::Free, file.start, vec![track], file.lines);
    Keyframes {
        clip: Clip { body, start, times, tracks, through, lines },
        untimed,
        order: Order::default(),
        warnings: file.warnings,
        largest_norm_error: file.largest_norm_error,
        hash: file.hash,
        bytes: file.bytes,
    }
}

/// The same as rotations of a camera. Quaternions in glTF's own axes stand as they are:
/// they take a camera from looking along −Z. Where a body's axes are meant, whose nose
/// points along +Z in glTF, the camera looks where the nose points.
pub fn camera_keys(file: RotationsFile, frame: Option<Frame>) -> Keyframes {
    let meant = frame.or(file.frame).unwrap_or(file.rotations.usual_frame());
    let mut keys = rotation_keys(file, frame);
    if meant != Frame::Gltf {
        keys.clip.tracks[0].iter_mut().for_each(|key| *key = *key * backwards());
    }
    keys
}

//! `keyed`: one rotation a key point, each facing the next point.

use super::facing::Facing;
use super::level::{Level, level_keys};
use super::{Course, continued};
use crate::math::Quat;
use glam::DVec3;

/// Chords shorter than this, relative to the coordinates, are rounding.
const COINCIDENT: f64 = 1e-14;

/// The rotation at each key time: key i faces the next key point, turned there from
/// key i − 1 by the shortest arc, key 0 from +Z; the last key repeats the one before.
///
/// The turns accumulate, so that no spin appears that the path does not force. A turn
/// of 180° is about the current up; coincident points keep the direction before.
/// `given` replaces rotations, key by key (missing ones count as none), after `level`
/// has taken pitch and roll from the others; it plays no part in the accumulation.
pub fn keyed(course: &dyn Course, given: &[Option<Quat>], level: Level) -> Vec<Quat> {
    let mut rotations = accumulated(&points(course));
    level_keys(&mut rotations, level);
    for (rotation, given) in rotations.iter_mut().zip(given) {
        *rotation = given.unwrap_or(*rotation);
    }
    continued(rotations.into_iter())
}

fn points(course: &dyn Course) -> Vec<DVec3> {
    course.key_times().iter().map(|&t| course.position(t)).collect()
}

fn accumulated(points: &[DVec3]) -> Vec<Quat> {
    let size = points.iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    let chords = points.windows(2).map(|pair| pair[1] - pair[0]);
    let directions =
        chords.map(|chord| if chord.length() > COINCIDENT * size { chord.normalize() } else { DVec3::ZERO });
    // The last key has no chord: it holds the direction, as a chord of no length does.
    let directions = directions.chain(points.last().map(|_| DVec3::ZERO));
    let turn = |facing: &mut Facing, direction: DVec3| {
        if direction != DVec3::ZERO {
            *facing = facing.turned_to(direction);
        }
        Some(facing.rotation())
    };
    directions.scan(Facing::START, turn).collect()
}

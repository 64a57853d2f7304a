//! How far a clip's playback can be from where it should be, in the world.

use super::chosen::Values;
use super::{ClipPlan, When};
use crate::moves::{Ground, Move, Mover};
use crate::sample::Writing;
use crate::sample::corners::{Chain, Limb, Trail, largest_displacement};
use crate::write::Interpolation;
use rayon::prelude::*;
use std::borrow::Cow;

/// Clips of more samples, or of more rotations, are bounded by the sum of what each rotation is
/// off: looking at all at once would take longer than making them.
const MOST_SAMPLES: usize = 1 << 16;
const MOST_ROTATIONS: usize = 1 << 18;

/// What a move is played by.
type Keys<'p> = (&'p [f32], Cow<'p, Values>);

/// An upper bound of how far a corner of the chain can be from where it should be, units.
/// None where there is no chain, something of it is not played LINEAR from what is known,
/// or the clip is long.
pub(super) fn displacement(ground: &Ground, plan: &ClipPlan, writing: Writing) -> Option<f64> {
    let grid = grid(&plan.when, plan.object.len())?;
    let keys = (0..plan.object.len()).map(|i| keys(plan, i, &grid, writing));
    let keys: Vec<Keys> = keys.collect::<Option<_>>()?;
    let (mut limbs, mut root, mut root_turns, mut boxes) = (Vec::new(), None, false, 0);
    for ((mover, a_move), (times, values)) in plan.object.iter().zip(&keys) {
        match (a_move, &**values) {
            (Move::Keys(motion), Values::Rotations(written)) => {
                let limb = Limb { motion: motion.clone(), times, written };
                match mover {
                    Mover::Root => {
                        root_turns = true;
                        limbs.insert(0, limb);
                    }
                    Mover::Track(_) => {
                        boxes += 1;
                        limbs.push(limb);
                    }
                }
            }
            (Move::Travel(travel), Values::Places(written)) => {
                root = Some(Trail { travel: travel.as_ref(), times, written });
            }
            _ => return None,
        }
    }
    let length = ground.chain_length()? / f64::from(boxes);
    Some(largest_displacement(&Chain { root, limbs, root_turns, length }))
}

fn are_few(times: usize, moves: usize) -> bool {
    times <= MOST_SAMPLES && times * moves <= MOST_ROTATIONS
}

/// The times that so many moves share; none if there is too much to look at.
fn grid(when: &When, moves: usize) -> Option<Vec<f32>> {
    match when {
        When::Grid { object, .. } => are_few(object.len(), moves)
            .then(|| (0..object.chunks()).flat_map(|chunk| object.chunk(chunk).1).collect()),
        When::Chosen { object, .. } => {
            let all: usize = object.iter().map(|chosen| chosen.times.len()).sum();
            // Each has times of its own, at which all others are looked at too.
            are_few(all, moves).then(Vec::new)
        }
    }
}

/// The keys of a move as the file holds them, if they are played LINEAR.
fn keys<'p>(plan: &'p ClipPlan, index: usize, grid: &'p [f32], writing: Writing) -> Option<Keys<'p>> {
    if let When::Chosen { object, .. } = &plan.when {
        let chosen = &object[index];
        let linear = chosen.interpolation == Interpolation::Linear;
        return linear.then_some((&chosen.times[..], Cow::Borrowed(&chosen.values)));
    }
    let values = match &plan.object[index].1 {
        Move::Keys(motion) => {
            let number = |&t: &f32| writing.encoding.numbers(motion.at(f64::from(t)));
            Values::Rotations(grid.par_iter().map(number).collect())
        }
        Move::Travel(travel) => {
            let place = |&t: &f32| travel.at(f64::from(t)).as_vec3().to_array();
            Values::Places(grid.par_iter().map(place).collect())
        }
        Move::Attitude(_) => return None,
    };
    (!writing.hold).then_some((grid, Cow::Owned(values)))
}

//! How far a file is off its curves over time.

use super::{Error, Given, Limits, Recipe, Wanted, compared_keys, curve_of, name, node_name, recipe};
use super::{against, with_curve};
use crate::asset::Asset;
use crate::moves::{Ground, Inputs, Mover};

/// A node of a clip that is looked at over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// How many were looked at before it.
    pub index: usize,
    /// Name of the clip.
    pub clip: String,
    /// The scheme of the curve.
    pub scheme: &'static str,
    /// Name of the node.
    pub node: String,
    /// Whether it is moved, and distances are in units; else it is turned, and they are
    /// degrees.
    pub travels: bool,
    /// What the file was made to keep, where it says so: else a bound that it states.
    pub limit: Option<Limit>,
    /// How long the clip is, seconds.
    pub duration: f64,
    /// Times that the input gives, seconds.
    pub keys: Vec<f64>,
}

/// How far a file may be off by what it says of itself, degrees or units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The tolerance by which its keys were chosen.
    Tolerance(f64),
    /// The bound that was worked out for it.
    Bound(f64),
}

/// Says of every clip that has a curve, and of every node that it moves (or of `only`
/// one), how far off it is: each node once, with times in rising order, seconds, and
/// degrees or units. Of several copies of an object the first is looked at.
pub fn over_time(
    asset: &mut Asset,
    inputs: &Inputs,
    given: Given,
    only: Option<Mover>,
    note: &mut dyn FnMut(&Watched, f64, f64),
) -> Result<(), Error> {
    let (mut index, mut any) = (0, false);
    for clip in asset.clips() {
        let recipe = recipe(asset, clip.animation);
        let Some((scheme, shape)) = curve_of(&clip, recipe.as_ref(), given)? else { continue };
        any = true;
        let ground = Ground::new(inputs, shape, &[scheme])?;
        let mut bounds = Limits::new(recipe.as_ref(), given);
        for (mover, a_move) in ground.moves(scheme) {
            let bound = bounds.stated(&a_move);
            if only.is_some_and(|only| only != mover) {
                continue;
            }
            let travels = a_move.travel().is_some();
            let wanted = Wanted { node: node_name(mover, 0, inputs), copy: 0, a_move, limit: None };
            let found = asset.root().nodes.iter().position(|n| n.name.as_deref() == Some(&wanted.node));
            let node = found.ok_or_else(|| Error::NoNode(name(&clip), wanted.node.clone()))?;
            let watched = Watched {
                index,
                clip: name(&clip),
                scheme: scheme.name(),
                node: wanted.node.clone(),
                travels,
                limit: limit(recipe.as_ref(), travels, bound),
                duration: clip.duration,
                keys: compared_keys(&ground, &clip, &wanted),
            };
            index += 1;
            let mut note = |time: f64, off: f64| note(&watched, time, off);
            with_curve(&ground, &wanted, |curve| {
                against::over_time(asset, &clip, node, &watched.keys, curve, &mut note)
            })?;
        }
    }
    if any { Ok(()) } else { Err(Error::NoRecipe) }
}

fn limit(recipe: Option<&Recipe>, travels: bool, bound: Option<f64>) -> Option<Limit> {
    let asked = recipe.and_then(|recipe| if travels { recipe.tolerance_distance } else { recipe.tolerance });
    asked.map(Limit::Tolerance).or(bound.map(Limit::Bound))
}

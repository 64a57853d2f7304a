//! What there is to see.

use crate::moves::{Ground, Stand};
use crate::write::{Colour, Lens, Scene, Trace};

/// From the lower to the upper edge of a camera's picture, radians: 40°.
const FIELD_OF_VIEW: f32 = 0.698_131_7;

/// The body that keyframes turn, or a glider, its copies, cameras, and the path itself
/// where it is asked for.
pub(super) fn scene(ground: &Ground, path_colour: Option<Colour>) -> Scene {
    let mut scene = match &ground.inputs().keyframes {
        Some(keyframes) => Scene::of(keyframes.clip.body, keyframes.clip.tracks.len()),
        None => Scene::glider(ground.extent()),
    };
    scene.repeat(ground.stream().count);
    let size = scene.size;
    let lens = Lens { field_of_view: FIELD_OF_VIEW, range: range(size, ground.reach()) };
    for Stand { name, place, turned, mounted } in ground.stands(size) {
        scene.add_camera(name, lens, place, turned, mounted);
    }
    let line = path_colour.map_or(Vec::new(), |_| ground.trace());
    if let Some(colour) = path_colour.filter(|_| !line.is_empty()) {
        scene.add_trace(&Trace { line, controls: ground.control_points().to_vec() }, colour);
    }
    scene
}

/// Nearest and farthest of what a camera sees: from a fiftieth of the object to well
/// beyond all that moves.
fn range(size: f64, reach: f64) -> [f32; 2] {
    let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
    [0.02 * size, 10.0 * (size + reach)].map(|distance| (distance as f32).clamp(1e-30, 1e30))
}

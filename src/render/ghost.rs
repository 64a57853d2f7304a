//! A motion in one still picture: its poses, older ones fainter, and the ways
//! of the corners that travel farthest.

use super::cell::ground;
use super::error::Error;
use super::frame::Frame;
use super::layer::{Layer, fade, lay_over};
use super::session::Session;
use super::stroke::{self, Stroke};
use super::view::View;
use crate::asset::Asset;
use glam::DVec3;

/// How much remains of the oldest pose and of the last but one.
const FAINTEST: f32 = 0.18;
const STRONGEST: f32 = 0.7;
/// Moments at which traces are taken.
const MOMENTS: u32 = 480;
/// Boxes that leave traces, each of one corner.
const BOXES: usize = 12;
/// Linear colours of traces, one a box in turn: Okabe and Ito's, which most
/// colour-blind people tell apart (2008).
const COLOURS: [[f32; 3]; 6] = [
    [0.000, 0.168, 0.445],
    [0.665, 0.112, 0.000],
    [0.000, 0.342, 0.171],
    [0.604, 0.191, 0.386],
    [0.791, 0.347, 0.000],
    [0.093, 0.456, 0.812],
];
/// Pixels.
const WIDTH: f64 = 2.0;

impl Session {
    /// Poses at equal steps of time up to `until`, each over the one before,
    /// the last with the traces; as the camera sees the last.
    pub(super) fn ghosts(
        &mut self,
        asset: &mut Asset,
        view: &View,
        clip: Option<usize>,
        poses: u32,
        until: f64,
    ) -> Result<(Layer, Frame), Error> {
        let size = view.style.size;
        let last = self.pose(asset, clip, until)?;
        let frame = view.frame(&last, 0.0);
        let mut layer = Layer::new(size.0, size.1);
        let before = poses.saturating_sub(1);
        for i in 0..before {
            let pose = self.pose(asset, clip, until * f64::from(i) / f64::from(before))?;
            let mut ghost = self.draw(&pose, &frame, size, &[])?;
            fade(&mut ghost, strength(i, before));
            lay_over(&mut layer, &ghost);
        }
        let strokes = self.traces(asset, clip, until)?;
        let traces: Vec<_> = stroke::part(&strokes, &frame, size.1).into_iter().collect();
        lay_over(&mut layer, &self.draw(&last, &frame, size, &traces)?);
        let floor = ground(view, &frame);
        let layer = if floor.is_empty() { layer } else { self.underlay(&frame, &floor, &layer)? };
        Ok((layer, frame))
    }

    /// The ways of the corners of the largest boxes, faint where long ago.
    fn traces(&mut self, asset: &mut Asset, clip: Option<usize>, until: f64) -> Result<Vec<Stroke>, Error> {
        let largest = largest(self.pose(asset, clip, until)?.boxes(&self.model));
        let mut ways = vec![vec![Vec::new(); 8]; largest.len()];
        for i in 0..=MOMENTS {
            let pose = self.pose(asset, clip, until * f64::from(i) / f64::from(MOMENTS))?;
            for (number, corners) in pose.boxes(&self.model).enumerate() {
                if let Ok(at) = largest.binary_search(&number) {
                    ways[at].iter_mut().zip(corners).for_each(|(way, corner)| way.push(corner));
                }
            }
        }
        let colours = COLOURS.into_iter().cycle();
        Ok(ways.into_iter().zip(colours).filter_map(|(ways, c)| Some(trace(farthest(ways)?, c))).collect())
    }
}

/// The numbers of the largest boxes, in order.
fn largest(boxes: impl Iterator<Item = [DVec3; 8]>) -> Vec<usize> {
    // The first and the last corner lie opposite each other.
    let mut sizes: Vec<(usize, f64)> = boxes.map(|b| b[0].distance(b[7])).enumerate().collect();
    sizes.retain(|(_, size)| size.is_finite());
    sizes.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut largest: Vec<usize> = sizes.into_iter().take(BOXES).map(|(number, _)| number).collect();
    largest.sort();
    largest
}

/// How much remains of a pose, of so many before the last.
fn strength(pose: u32, before: u32) -> f32 {
    let share = if before > 1 { pose as f32 / (before - 1) as f32 } else { 1.0 };
    FAINTEST + (STRONGEST - FAINTEST) * share
}

/// The longest of the ways that the corners of a box go; none where it rests.
fn farthest(ways: Vec<Vec<DVec3>>) -> Option<Vec<DVec3>> {
    let length = |way: &[DVec3]| way.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    ways.into_iter().filter(|way| length(way) > 0.0).max_by(|a, b| length(a).total_cmp(&length(b)))
}

fn trace(way: Vec<DVec3>, [r, g, b]: [f32; 3]) -> Stroke {
    let last = (way.len() - 1).max(1) as f32;
    let alpha = |i: usize| 0.25 + 0.7 * (i as f32 / last).powi(2);
    let points = way.into_iter().enumerate().map(|(i, p)| (p, [r, g, b, alpha(i)])).collect();
    Stroke { points, width: WIDTH }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn older_poses_are_fainter() {
        let strengths: Vec<f32> = (0..5).map(|i| strength(i, 5)).collect();
        assert!(strengths.is_sorted() && strengths[0] == FAINTEST && strengths[4] == STRONGEST);
        assert_eq!(strength(0, 1), STRONGEST);
    }

    #[test]
    fn the_corner_that_travels_farthest_leaves_a_trace() {
        let line = |length: f64| vec![DVec3::ZERO, DVec3::X * length];
        let ways = [1.0, 3.0, 0.0, 2.0].map(line).to_vec();
        assert_eq!(farthest(ways), Some(line(3.0)));
        assert_eq!(farthest(vec![line(0.0)]), None);
    }
}

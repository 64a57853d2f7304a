//! Two files at a moment each, side by side.

use super::error::Error;
use super::grid::Grid;
use super::layer::{compose, covered};
use super::session::close_up;
use super::{Background, Picture, Renderer, Session};
use crate::asset::Asset;

/// A time of a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Index among the file's animations; None for the file at rest.
    pub clip: Option<usize>,
    /// Seconds; before a clip's first key and after its last these hold.
    pub time: f64,
}

/// Draws a moment of each of two files, the first on the left. One camera sees both, so
/// near that both poses fill its view; `size` is that of a half, in pixels.
pub fn side_by_side(
    (left, of_left): (&mut Asset, Moment),
    (right, of_right): (&mut Asset, Moment),
    size: (u32, u32),
    renderer: Renderer,
    background: Background,
) -> Result<Picture, Error> {
    let mut sessions = (Session::new(left, renderer)?, Session::new(right, renderer)?);
    let left = sessions.0.pose(left, of_left.clip, of_left.time)?;
    let right = sessions.1.pose(right, of_right.clip, of_right.time)?;
    let corners = left.corners(&sessions.0.model).chain(right.corners(&sessions.1.model));
    let frame = close_up(corners, size)?;
    let layers = (sessions.0.draw(&left, &frame, size, &[])?, sessions.1.draw(&right, &frame, size, &[])?);
    let covered = (covered(&layers.0) + covered(&layers.1)) / 2.0;
    let grid = Grid::new(2, 1, size)?;
    let mut pixels = grid.blank();
    grid.put(&mut pixels, 0, &compose(layers.0, background));
    grid.put(&mut pixels, 1, &compose(layers.1, background));
    let note = |side: &'static str| move |note: &String| format!("{side}: {note}");
    let left = sessions.0.notes().iter().map(note("left"));
    let notes = left.chain(sessions.1.notes().iter().map(note("right"))).collect();
    Ok(Picture { pixels, covered, renderer: sessions.0.renderer().to_owned(), notes })
}

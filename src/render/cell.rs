//! One cell of a picture: what a clip shows, on its ground, with its words.

use super::background::Background;
use super::error::Error;
use super::floor::Floor;
use super::frame::Frame;
use super::layer::{Layer, compose, covered, lay_over};
use super::pose::Pose;
use super::scene::Part;
use super::session::Session;
use super::view::View;
use super::{colour, grid::Grid, label, stroke};
use crate::asset::Asset;
use image::RgbaImage;

/// What one cell of a picture shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    pub clip: Option<usize>,
    pub shows: Shows,
    /// Words in the upper left corner, and in the lower left one.
    pub words: [Option<String>; 2],
}

/// How time becomes still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shows {
    /// One moment, with the turntable so far round: seconds and radians.
    Moment { t: f64, turn: f64 },
    /// So many poses from the start up to a moment.
    Ghost { poses: u32, until: f64 },
}

impl Session {
    /// Draws cells into a grid, and says what share of the pixels is drawn to.
    pub(super) fn cells(
        &mut self,
        asset: &mut Asset,
        view: &View,
        grid: &Grid,
        cells: &[Cell],
    ) -> Result<(RgbaImage, f64), Error> {
        if let [cell] = cells
            && grid.cells() == 1
        {
            return self.cell(asset, view, cell);
        }
        let (mut whole, mut share) = (grid.blank(), 0.0);
        for index in 0..grid.cells() {
            let cell = match cells.get(index as usize) {
                Some(cell) => self.cell(asset, view, cell)?,
                None => {
                    (compose(Layer::new(view.style.size.0, view.style.size.1), view.style.background), 0.0)
                }
            };
            share += cell.1;
            grid.put(&mut whole, index, &cell.0);
        }
        Ok((whole, share / f64::from(grid.cells())))
    }

    fn cell(&mut self, asset: &mut Asset, view: &View, cell: &Cell) -> Result<(RgbaImage, f64), Error> {
        let (layer, frame) = match cell.shows {
            Shows::Moment { t, turn } => {
                let pose = self.pose(asset, cell.clip, t)?;
                self.moment(view, &pose, turn)?
            }
            Shows::Ghost { poses, until } => self.ghosts(asset, view, cell.clip, poses, until)?,
        };
        let share = covered(&layer);
        let mut image = compose(layer, view.style.background);
        if let Some(floor) = view.floor() {
            letters(&mut image, floor, &frame, view.style.background);
        }
        for (text, below) in cell.words.iter().zip([false, true]) {
            if let Some(text) = text {
                label::caption(&mut image, text, below, view.style.background);
            }
        }
        Ok((image, share))
    }

    fn moment(&mut self, view: &View, pose: &Pose, turn: f64) -> Result<(Layer, Frame), Error> {
        let frame = view.frame(pose, turn);
        let lines = ground(view, &frame);
        Ok((self.draw(pose, &frame, view.style.size, &lines)?, frame))
    }

    /// Draws lines alone, under what is given.
    pub(super) fn underlay(&mut self, frame: &Frame, lines: &[Part], over: &Layer) -> Result<Layer, Error> {
        let mut layer = self.draw(&Pose::nothing(), frame, over.dimensions(), lines)?;
        lay_over(&mut layer, over);
        Ok(layer)
    }
}

/// The floor's lines, where there is one.
pub(super) fn ground(view: &View, frame: &Frame) -> Vec<Part> {
    let on_light = view.style.background.is_light();
    let strokes = view.floor().map(|floor| floor.strokes(on_light)).unwrap_or_default();
    stroke::part(&strokes, frame, view.style.size.1).into_iter().collect()
}

fn letters(image: &mut RgbaImage, floor: &Floor, frame: &Frame, background: Background) {
    for (letter, place, [r, g, b, _]) in floor.letters(background.is_light()) {
        if let Some(at) = frame.on_picture(place, image.dimensions()) {
            label::word(image, letter, at, [r, g, b].map(colour::encode));
        }
    }
}

//! Still pictures: a moment, a contact sheet, ghosts, clips side by side.

use super::cell::{Cell, Shows};
use super::error::Error;
use super::grid::Grid;
use super::view::Style;
use super::{Picture, Session, Time};
use crate::asset::Asset;

/// A clip, an index into [`Session::clips`], or the file at rest.
pub type Which = Option<usize>;

impl Session {
    /// Draws a moment of a clip. The view is the same for all times of a clip.
    pub fn picture(
        &mut self,
        asset: &mut Asset,
        clip: Which,
        time: Time,
        style: &Style,
    ) -> Result<Picture, Error> {
        let (t, clamped) = time.within(self.duration(clip));
        let cell = Cell { clip, shows: Shows::Moment { t, turn: 0.0 }, words: [None, None] };
        let grid = Grid::new(1, 1, style.size)?;
        Ok(self.still(asset, style, grid, &[cell])?.noting(clamped))
    }

    /// Draws the same moment of several clips next to each other, each with its
    /// name; shares of time are the longest clip's, shorter ones rest at their ends.
    pub fn abreast(
        &mut self,
        asset: &mut Asset,
        clips: &[Which],
        time: Time,
        style: &Style,
    ) -> Result<Picture, Error> {
        let (t, clamped) = time.within(self.longest(clips));
        let cell = |&clip| Cell {
            clip,
            shows: Shows::Moment { t, turn: 0.0 },
            words: [Some(self.title(clip)), None],
        };
        let cells: Vec<Cell> = clips.iter().map(cell).collect();
        let grid = Grid::beside(cells.len() as u32, style.size)?;
        Ok(self.still(asset, style, grid, &cells)?.noting(clamped))
    }

    /// Draws `columns` times `rows` moments at equal steps, from the start to
    /// the end, each with its time; of several clips one sheet under the other,
    /// all over the time of the longest.
    pub fn sheet(
        &mut self,
        asset: &mut Asset,
        clips: &[Which],
        (columns, rows): (u32, u32),
        style: &Style,
    ) -> Result<Picture, Error> {
        let grid = Grid::new(columns, rows.saturating_mul(clips.len() as u32), style.size)?;
        let (count, duration) = (columns * rows, self.longest(clips));
        let mut cells = Vec::new();
        for &clip in clips {
            for i in 0..count {
                let t = match count {
                    1 => duration / 2.0,
                    _ => duration * f64::from(i) / f64::from(count - 1),
                };
                let name = (i == 0 && clips.len() > 1).then(|| self.title(clip));
                let words = [Some(format!("{t:.2} s")), name];
                cells.push(Cell { clip, shows: Shows::Moment { t, turn: 0.0 }, words });
            }
        }
        self.still(asset, style, grid, &cells)
    }

    /// Draws so many poses at equal steps of time from the start up to `time`,
    /// older ones fainter, with the ways that corners of boxes have gone; of
    /// several clips next to each other, each with its name.
    pub fn ghost(
        &mut self,
        asset: &mut Asset,
        clips: &[Which],
        poses: u32,
        time: Time,
        style: &Style,
    ) -> Result<Picture, Error> {
        let (until, clamped) = time.within(self.longest(clips));
        let name = |clip| (clips.len() > 1).then(|| self.title(clip));
        let cell = |&clip| Cell { clip, shows: Shows::Ghost { poses, until }, words: [name(clip), None] };
        let cells: Vec<Cell> = clips.iter().map(cell).collect();
        let grid = Grid::beside(cells.len() as u32, style.size)?;
        Ok(self.still(asset, style, grid, &cells)?.noting(clamped))
    }

    fn still(
        &mut self,
        asset: &mut Asset,
        style: &Style,
        grid: Grid,
        cells: &[Cell],
    ) -> Result<Picture, Error> {
        let mut clips: Vec<Which> = cells.iter().map(|cell| cell.clip).collect();
        clips.dedup();
        let view = self.view(asset, &clips, style, false)?;
        let (pixels, covered) = self.cells(asset, &view, &grid, cells)?;
        Ok(Picture { pixels, covered, renderer: self.renderer().to_owned(), notes: self.notes().to_vec() })
    }

    /// A clip's name, or its number.
    pub(super) fn title(&self, clip: Which) -> String {
        match clip.and_then(|clip| self.clips.get(clip)) {
            Some(clip) => clip.name.clone().unwrap_or_else(|| format!("clip {}", clip.animation + 1)),
            None => "at rest".to_owned(),
        }
    }

    /// How long the longest of some clips is, seconds.
    pub(super) fn longest(&self, clips: &[Which]) -> f64 {
        clips.iter().map(|&clip| self.duration(clip)).fold(0.0, f64::max)
    }
}

impl Picture {
    fn noting(mut self, note: Option<String>) -> Picture {
        self.notes.extend(note);
        self
    }
}

//! Pictures of one size side by side in rows.

use super::MOST_PIXELS;
use super::error::Error;
use image::{Rgba, RgbaImage, imageops};

/// Pixels between neighbours, and their colour.
const GAP: u32 = 2;
const GAP_COLOUR: Rgba<u8> = Rgba([96, 96, 96, 255]);

/// Where cells lie, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Grid {
    columns: u32,
    rows: u32,
    cell: (u32, u32),
    /// Pixels of the whole.
    pub size: (u32, u32),
}

impl Grid {
    pub(super) fn new(columns: u32, rows: u32, cell: (u32, u32)) -> Result<Grid, Error> {
        let side = |count: u32, pixels: u32| {
            let whole = u64::from(count) * u64::from(pixels) + u64::from(GAP) * u64::from(count.max(1) - 1);
            u32::try_from(whole).ok().filter(|side| (1..=MOST_PIXELS).contains(side))
        };
        match (side(columns, cell.0), side(rows, cell.1)) {
            (Some(width), Some(height)) => Ok(Grid { columns, rows, cell, size: (width, height) }),
            _ if columns == 1 && rows == 1 => Err(Error::Size(cell.0, cell.1)),
            _ => Err(Error::Cells { columns, rows, cell }),
        }
    }

    /// One row of so many cells, or several rows of at most four.
    pub(super) fn beside(count: u32, cell: (u32, u32)) -> Result<Grid, Error> {
        let rows = count.div_ceil(4).max(1);
        Grid::new(count.div_ceil(rows), rows, cell)
    }

    /// The whole without its cells.
    pub(super) fn blank(&self) -> RgbaImage {
        RgbaImage::from_pixel(self.size.0, self.size.1, GAP_COLOUR)
    }

    /// Puts a cell, counted row by row, in its place.
    pub(super) fn put(&self, whole: &mut RgbaImage, index: u32, cell: &RgbaImage) {
        let place = |at: u32, pixels: u32| i64::from(at) * i64::from(pixels + GAP);
        let (x, y) = (place(index % self.columns, self.cell.0), place(index / self.columns, self.cell.1));
        imageops::replace(whole, cell, x, y);
    }

    pub(super) fn cells(&self) -> u32 {
        self.columns * self.rows
    }
}

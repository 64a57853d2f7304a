//! Why there is no plot.

/// What keeps a plot from being made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Something of rotations is asked for, and there are none.
    #[error("--show {0} needs rotations that run through keys, found only a path: {1}")]
    NoRotations(&'static str, &'static str),
    /// Something of a path is asked for, and there is none.
    #[error("--show {0} needs a path, found only rotations: give a file of points, or use --path PATH.dat")]
    NoPath(&'static str),
    /// A file's playback is asked for, and there is none.
    #[error("--show error needs a .glb or .gltf, and its input by --against IN.dat")]
    NoFile,
    /// A number of the row that is not there.
    #[error("expected components from 1 to {last}, which is what a row of this input holds, found {found}")]
    Component {
        /// How many there are.
        last: usize,
        /// What was asked for.
        found: usize,
    },
    /// A box that is not there.
    #[error("expected a box from 1 to {last}, found {found}")]
    Box {
        /// How many there are.
        last: usize,
        /// What was asked for.
        found: usize,
    },
    /// More panels than a page has room for.
    #[error("{found} panels are more than the {most} that a page has room for: choose by {by}")]
    TooMany {
        /// How many there would be.
        found: usize,
        /// How many there may be.
        most: usize,
        /// What to choose them by.
        by: &'static str,
    },
    /// A picture too small for what is in it.
    #[error("expected {width}x{height} pixels at least for {panels} panels, found {}x{}", .found.0, .found.1)]
    TooSmall {
        /// The least width.
        width: u32,
        /// The least height.
        height: u32,
        /// How many there are.
        panels: usize,
        /// What was asked for.
        found: (u32, u32),
    },
    /// The picture could not be drawn.
    #[error("the SVG cannot be drawn as a PNG: {0}")]
    Png(String),
}

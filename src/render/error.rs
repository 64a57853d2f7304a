//! Why there is no picture.

use super::MOST_PIXELS;
use super::film::MOST_FRAMES;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file's animation cannot be read.
    #[error(transparent)]
    Asset(#[from] crate::asset::Error),
    /// wgpu finds nothing to draw with.
    #[error(
        "no graphics adapter: {reason}\n\
         any machine can have one in software: install mesa-vulkan-drivers (Debian, Ubuntu, \
         Fedora), vulkan-swrast (Arch), mesa-vulkan-swrast (Alpine) or libvulkan_lvp \
         (openSUSE); or choose the renderer that is built in"
    )]
    NoAdapter {
        /// In wgpu's words.
        reason: String,
    },
    /// The adapter is there but failed.
    #[error("the graphics adapter failed: {reason}")]
    Adapter {
        /// In wgpu's words.
        reason: String,
    },
    /// No picture can have this size.
    #[error("a picture of {0}x{1} pixels cannot be drawn: each side is 1 to {MOST_PIXELS} pixels")]
    Size(u32, u32),
    /// No picture can hold so many cells of this size.
    #[error(
        "{columns}x{rows} cells of {0}x{1} pixels make too large a picture: each side is 1 to \
         {MOST_PIXELS} pixels",
        .cell.0, .cell.1
    )]
    Cells {
        /// Cells a row.
        columns: u32,
        /// Rows.
        rows: u32,
        /// Pixels of a cell, across and down.
        cell: (u32, u32),
    },
    /// The file has no camera of this name.
    #[error("there is no camera named `{name}`: {}", known(.cameras))]
    NoCamera {
        /// The name that was asked for.
        name: String,
        /// Those that there are.
        cameras: Vec<String>,
    },
    /// Nothing happens over time.
    #[error("no clip lasts any time: there is nothing to play, unless a turntable turns it")]
    NothingMoves,
    /// Frames would last too long.
    #[error("{0} frames a second are too few: each may be shown for at most 30 s")]
    Rate(crate::sample::Fps),
    /// Moving pictures would have too many frames.
    #[error("{0} frames are more than moving pictures may have: at most {MOST_FRAMES}")]
    Frames(u64),
    /// What is drawn cannot be written.
    #[error("cannot be written: {0}")]
    Write(#[from] std::io::Error),
    /// The file has no clip of this name.
    #[error("there is no clip named `{name}`: {}", known(.clips))]
    NoClip {
        /// The name that was asked for.
        name: String,
        /// Those that there are.
        clips: Vec<String>,
    },
}

fn known(clips: &[String]) -> String {
    match clips {
        [] => "the file has none with a name".to_owned(),
        names => format!("the file has `{}`", names.join("`, `")),
    }
}

#[cfg(feature = "render")]
impl Error {
    pub(crate) fn adapter(reason: impl std::fmt::Display) -> Self {
        Error::Adapter { reason: reason.to_string() }
    }
}

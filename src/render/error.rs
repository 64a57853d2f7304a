//! Why there is no picture.

use super::MOST_PIXELS;

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

impl Error {
    pub(crate) fn adapter(reason: impl std::fmt::Display) -> Self {
        Error::Adapter { reason: reason.to_string() }
    }
}

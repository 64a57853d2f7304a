//! Why there is no picture.

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// wgpu finds nothing to draw with; holds its reason.
    #[error(
        "no graphics adapter: {0}\n\
         a software adapter does: install mesa-vulkan-drivers (Debian, Ubuntu, Fedora), \
         vulkan-swrast (Arch), mesa-vulkan-swrast (Alpine) or Mesa-libvulkan_lvp, \
         libvulkan_lvp (openSUSE); or draw with the built-in software renderer"
    )]
    NoAdapter(String),
    /// The adapter is there but failed; holds its reason.
    #[error("the graphics adapter failed: {0}")]
    Adapter(String),
    /// No such picture can be made.
    #[error("a picture of {0}x{1} pixels cannot be drawn: each side is 1 to {MOST} pixels", MOST = super::MOST_PIXELS)]
    Size(u32, u32),
}

//! Two numbers with an x between them.

#[cfg(not(feature = "render"))]
use dat2glb::plot::MOST_PIXELS;
#[cfg(feature = "render")]
use dat2glb::render::MOST_PIXELS;

/// Width and height of a picture.
pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = pair(text, MOST_PIXELS);
    sides.ok_or_else(|| format!("expected width and height, 1 to {MOST_PIXELS} pixels each, such as 512x512"))
}

/// Two numbers from 1 to `most`.
pub(super) fn pair(text: &str, most: u32) -> Option<(u32, u32)> {
    let number = |text: &str| text.parse().ok().filter(|n| (1..=most).contains(n));
    let (first, second) = text.split_once(['x', 'X'])?;
    Some((number(first)?, number(second)?))
}

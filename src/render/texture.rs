//! Smaller copies of a texture, for surfaces far away.

use super::colour::{LINEAR, encode};
use super::scene::Level;

/// The picture and its copies, each half the one before, down to one pixel.
pub(crate) fn levels(first: Level) -> Vec<Level> {
    let mut levels = vec![first];
    while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
        levels.push(half(last));
    }
    levels
}

/// Each pixel the mean light of four; at an odd edge the last row or column is
/// left out, as graphics cards do.
fn half(level: &Level) -> Level {
    let (width, height) = ((level.width / 2).max(1), (level.height / 2).max(1));
    let at = |x: u32, y: u32| {
        let (x, y) = (x.min(level.width - 1), y.min(level.height - 1));
        level.pixels[y as usize * level.width as usize + x as usize]
    };
    let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = rows
        .map(|(x, y)| {
            mean([
                at(2 * x, 2 * y),
                at(2 * x + 1, 2 * y),
                at(2 * x, 2 * y + 1),
                at(2 * x + 1, 2 * y + 1),
            ])
        })
        .collect();
    Level {
        width,
        height,
        pixels,
    }
}

fn mean(four: [[u8; 4]; 4]) -> [u8; 4] {
    let light = |i: usize| encode(four.iter().map(|p| LINEAR[p[i] as usize]).sum::<f32>() / 4.0);
    let alpha = four.iter().map(|p| u32::from(p[3])).sum::<u32>();
    [light(0), light(1), light(2), ((alpha + 2) / 4) as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_halve_down_to_one_pixel_and_keep_the_light() {
        let pixel = |i: u32| if i % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] };
        let first = Level {
            width: 6,
            height: 4,
            pixels: (0..24).map(pixel).collect(),
        };
        let levels = levels(first);
        let sizes: Vec<_> = levels.iter().map(|l| (l.width, l.height)).collect();
        assert_eq!(sizes, [(6, 4), (3, 2), (1, 1)]);
        // Half the light is level 188 in sRGB, not 128.
        assert!(levels[1].pixels.iter().all(|p| *p == [188, 188, 188, 255]));
    }
}

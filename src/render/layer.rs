//! What a renderer leaves behind, and what is behind that.

use super::background::Background;
use super::colour::{LINEAR, encode};
use image::RgbaImage;
use rayon::prelude::*;

/// The parts alone, over nothing: colours premultiplied in linear light, then
/// as sRGB; alpha linear. A graphics card's sRGB target holds just that.
pub(crate) type Layer = RgbaImage;

/// The share of pixels, 0 to 1, that anything was drawn to.
pub(crate) fn covered(layer: &Layer) -> f64 {
    let drawn = layer.pixels().filter(|p| p[3] > 0).count();
    drawn as f64 / (f64::from(layer.width()) * f64::from(layer.height())).max(1.0)
}

/// Lays the parts over the background.
pub(crate) fn compose(mut layer: Layer, background: Background) -> RgbaImage {
    let (width, height) = layer.dimensions();
    let row_length = (width as usize * 4).max(1);
    let row = |(y, pixels): (usize, &mut [u8])| match background.row(y, height) {
        Some(behind) => pixels.as_chunks_mut().0.iter_mut().for_each(|p| over(p, behind)),
        None => pixels.as_chunks_mut().0.iter_mut().for_each(divide_by_alpha),
    };
    layer.par_chunks_mut(row_length).enumerate().for_each(row);
    layer
}

fn over(pixel: &mut [u8; 4], behind: [u8; 3]) {
    match pixel[3] {
        255 => return,
        0 => *pixel = [behind[0], behind[1], behind[2], 255],
        alpha => {
            let through = 1.0 - f32::from(alpha) / 255.0;
            for (channel, behind) in pixel.iter_mut().zip(behind) {
                let light = LINEAR[*channel as usize] + LINEAR[behind as usize] * through;
                *channel = encode(light);
            }
        }
    }
    pixel[3] = 255;
}

/// Lets only a share of a layer's light and cover remain, 0 to 1.
pub(crate) fn fade(layer: &mut Layer, share: f32) {
    // Both scale alike, so tables of 256 entries say it all.
    let light: Vec<u8> = LINEAR.iter().map(|light| encode(light * share)).collect();
    let alpha: Vec<u8> = (0..=255_u8).map(|alpha| (f32::from(alpha) * share + 0.5) as u8).collect();
    layer.as_mut().par_chunks_mut(4 << 10).for_each(|pixels| {
        for pixel in pixels.as_chunks_mut::<4>().0 {
            let [r, g, b, a] = *pixel;
            *pixel = [light[r as usize], light[g as usize], light[b as usize], alpha[a as usize]];
        }
    });
}

/// Lays a layer of the same size over another.
pub(crate) fn lay_over(under: &mut Layer, over: &Layer) {
    let pairs = under.as_chunks_mut::<4>().0.par_iter_mut().zip(over.as_chunks::<4>().0);
    pairs.with_min_len(1 << 10).for_each(|(under, over)| match over[3] {
        0 => {}
        255 => *under = *over,
        alpha => {
            let through = 1.0 - f32::from(alpha) / 255.0;
            for (under, over) in under[..3].iter_mut().zip(over) {
                *under = encode(LINEAR[*over as usize] + LINEAR[*under as usize] * through);
            }
            under[3] = (f32::from(alpha) + f32::from(under[3]) * through + 0.5) as u8;
        }
    });
}

/// PNG wants colours that are not multiplied by alpha.
fn divide_by_alpha(pixel: &mut [u8; 4]) {
    let alpha = f32::from(pixel[3]) / 255.0;
    if alpha == 0.0 || alpha == 1.0 {
        return;
    }
    for channel in &mut pixel[..3] {
        *channel = encode(LINEAR[*channel as usize] / alpha);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    fn one(pixel: [u8; 4], background: Background) -> [u8; 4] {
        compose(Layer::from_pixel(1, 1, Rgba(pixel)), background)[(0, 0)].0
    }

    #[test]
    fn what_is_opaque_hides_the_background() {
        for background in [Background::Studio, Background::Plain([9, 9, 9]), Background::Transparent] {
            assert_eq!(one([1, 2, 3, 255], background), [1, 2, 3, 255]);
        }
        assert_eq!(one([0; 4], Background::Plain([7, 8, 9])), [7, 8, 9, 255]);
        assert_eq!(one([0; 4], Background::Transparent), [0; 4]);
    }

    #[test]
    fn half_white_over_black_is_half_the_light() {
        let half = encode(0.5);
        assert_eq!(one([half, half, half, 128], Background::Plain([0; 3])), [half, half, half, 255]);
        let whole = one([half, half, half, 128], Background::Transparent);
        assert!(whole[..3].iter().all(|c| *c >= 254) && whole[3] == 128, "{whole:?}");
    }

    #[test]
    fn a_layer_faded_by_half_lets_half_of_another_through() {
        let mut under = Layer::from_pixel(2, 1, Rgba([255, 0, 0, 255]));
        let mut over = Layer::from_pixel(2, 1, Rgba([0, 0, 255, 255]));
        over.put_pixel(1, 0, Rgba([0; 4]));
        fade(&mut over, 0.5);
        assert_eq!(over[(0, 0)].0, [0, 0, encode(0.5), 128]);
        lay_over(&mut under, &over);
        let [r, g, b, a] = under[(0, 0)].0;
        assert!(r.abs_diff(encode(0.5)) <= 1 && g == 0 && b == encode(0.5) && a == 255, "{r} {g} {b} {a}");
        assert_eq!(under[(1, 0)].0, [255, 0, 0, 255]);
    }

    #[test]
    fn covered_counts_pixels() {
        let mut layer = Layer::new(4, 5);
        layer.put_pixel(1, 1, Rgba([0, 0, 0, 1]));
        assert_eq!(covered(&layer), 0.05);
    }
}

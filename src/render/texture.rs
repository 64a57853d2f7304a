//! Materials, their textures, and smaller copies of these for what is far away.

use super::colour::{LINEAR, encode};
use super::scene::{Alpha, Level, Material, Texture, Wrap};
use crate::asset::{Asset, Error};
use gltf::json;
use gltf::json::material::AlphaMode;
use gltf::json::texture::{MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use image::{DynamicImage, ImageDecoder};
use std::collections::HashMap;
use std::sync::Arc;

/// Textures larger than this a side start with a smaller copy.
const MOST_TEXELS: u32 = 4096;
/// An image that would need more memory than this, and so many times its own bytes, is left
/// out: a few bytes of a hostile file can claim a gigabyte.
const MOST_BYTES: u64 = 64 << 20;
const TIMES_ITS_BYTES: u64 = 64;

/// The textures in use, each image decoded once.
#[derive(Debug, Default)]
pub(crate) struct Textures {
    pub all: Vec<Texture>,
    /// Images that are left out, and why.
    pub unread: Vec<Error>,
    /// From the file's textures to `all`.
    known: HashMap<usize, Option<usize>>,
    images: HashMap<usize, Option<Arc<Vec<Level>>>>,
}

impl Textures {
    /// A material, the default one where there is none, and which set of
    /// texture coordinates it uses.
    pub(crate) fn material(&mut self, asset: &mut Asset, index: Option<usize>) -> (Material, usize) {
        let Some(stored) = index.and_then(|i| asset.root().materials.get(i)) else {
            return (Material::default(), 0);
        };
        let pbr = &stored.pbr_metallic_roughness;
        let texture = pbr.base_color_texture.as_ref();
        let reference = texture.map(|info| (info.index.value(), info.tex_coord as usize));
        let material = Material {
            colour: pbr.base_color_factor.0,
            texture: None,
            alpha: alpha(stored),
            double_sided: stored.double_sided,
            unlit: stored.extensions.as_ref().is_some_and(|extensions| extensions.unlit.is_some()),
        };
        let Some((texture, uv_set)) = reference else {
            return (material, 0);
        };
        let texture = self.texture(asset, texture);
        (Material { texture, ..material }, uv_set)
    }

    fn texture(&mut self, asset: &mut Asset, index: usize) -> Option<usize> {
        if let Some(known) = self.known.get(&index) {
            return *known;
        }
        let made = self.make(asset, index).map(|texture| {
            self.all.push(texture);
            self.all.len() - 1
        });
        self.known.insert(index, made);
        made
    }

    fn make(&mut self, asset: &mut Asset, index: usize) -> Option<Texture> {
        let root = asset.root();
        let stored = root.textures.get(index)?;
        let image = stored.source.value();
        let sampler = stored.sampler.and_then(|s| root.samplers.get(s.value()));
        let sampler = sampler.cloned().unwrap_or_default();
        let nearest = sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest));
        Some(Texture {
            levels: self.image(asset, image)?,
            wrap: [wrap(sampler.wrap_s), wrap(sampler.wrap_t)],
            nearest,
        })
    }

    fn image(&mut self, asset: &mut Asset, index: usize) -> Option<Arc<Vec<Level>>> {
        if let Some(known) = self.images.get(&index) {
            return known.clone();
        }
        let decoded = match decode(asset, index) {
            Ok(levels) => Some(Arc::new(levels)),
            Err(error) => {
                self.unread.push(error);
                None
            }
        };
        self.images.insert(index, decoded.clone());
        decoded
    }
}

fn alpha(material: &json::Material) -> Alpha {
    match material.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => Alpha::Mask(material.alpha_cutoff.map_or(0.5, |c| c.0)),
        Checked::Valid(AlphaMode::Blend) => Alpha::Blend,
        _ => Alpha::Opaque,
    }
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

fn decode(asset: &mut Asset, index: usize) -> Result<Vec<Level>, Error> {
    let broken = |e: &dyn std::fmt::Display| Error::data(format!("/images/{index}"), e.to_string());
    let bytes = asset.image(index)?;
    let most = MOST_BYTES + TIMES_ITS_BYTES * bytes.len() as u64;
    let mut reader =
        image::ImageReader::new(std::io::Cursor::new(bytes)).with_guessed_format().map_err(|e| broken(&e))?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(most);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|e| broken(&e))?;
    let (width, height) = decoder.dimensions();
    // As decoded and with four bytes a pixel, or with these twice.
    let each = (u64::from(decoder.color_type().bytes_per_pixel()) + 4).max(8);
    if each.saturating_mul(u64::from(width) * u64::from(height)) > most {
        return Err(broken(&format!(
            "has {width} × {height} pixels, too many for the bytes it is stored in"
        )));
    }
    let pixels = DynamicImage::from_decoder(decoder).map_err(|e| broken(&e))?.into_rgba8();
    if pixels.is_empty() {
        return Err(broken(&"has no pixels"));
    }
    let first =
        Level { width: pixels.width(), height: pixels.height(), pixels: pixels.as_chunks().0.to_vec() };
    let mut levels = levels(first);
    levels.retain(|level| level.width <= MOST_TEXELS && level.height <= MOST_TEXELS);
    Ok(levels)
}

/// The picture and its copies, each half the one before, down to one pixel.
pub(crate) fn levels(first: Level) -> Vec<Level> {
    let mut levels = vec![first];
    while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
        levels.push(half(last));
    }
    levels
}

/// Each pixel the mean light of four; at an odd edge the last row or column is
/// left out.
fn half(level: &Level) -> Level {
    let (width, height) = ((level.width / 2).max(1), (level.height / 2).max(1));
    let at = |x: u32, y: u32| {
        let (x, y) = (x.min(level.width - 1), y.min(level.height - 1));
        level.pixels[y as usize * level.width as usize + x as usize]
    };
    let four = |x: u32, y: u32| [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| at(2 * x + i, 2 * y + j));
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Level { width, height, pixels: places.map(|(x, y)| mean(four(x, y))).collect() }
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
        let pixel = |i: u32| [[255; 4], [0, 0, 0, 255]][i as usize % 2];
        let first = Level { width: 6, height: 4, pixels: (0..24).map(pixel).collect() };
        let levels = levels(first);
        let sizes: Vec<_> = levels.iter().map(|l| (l.width, l.height)).collect();
        assert_eq!(sizes, [(6, 4), (3, 2), (1, 1)]);
        // Half the light is level 188 in sRGB, not 128.
        assert!(levels[1].pixels.iter().all(|p| *p == [188, 188, 188, 255]));
    }
}

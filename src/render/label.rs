//! Letters on pictures, in DejaVu Sans.

use super::background::Background;
use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};
use image::RgbaImage;

/// How much of what lies behind a label its plate hides.
const PLATE: f32 = 0.72;
const DARK: [u8; 3] = [45, 48, 54];
const LIGHT: [u8; 3] = [236, 238, 242];

/// Writes a line into the upper left corner or the lower one, as large as the
/// picture asks for and cut short where it would not fit.
pub(super) fn caption(image: &mut RgbaImage, text: &str, below: bool, background: Background) {
    let height = (image.height() as f32 / 22.0).clamp(11.0, 30.0);
    let pad = (height * 0.4).round();
    let Some(line) = Line::fitting(text, height, image.width() as f32 - 4.0 * pad) else { return };
    let colour = if background.is_light() { DARK } else { LIGHT };
    let room = (image.height() as f32 - line.height() - 2.0 * pad).max(0.0);
    let top = if below { room } else { 0.0 };
    let (right, bottom) = (line.width + 3.0 * pad, top + line.height() + 1.5 * pad);
    plate(image, [pad, top + 0.5 * pad, right, bottom], background);
    line.draw(image, (2.0 * pad, top + pad), colour);
}

/// Writes a word around a place, pixels right and down.
pub(super) fn word(image: &mut RgbaImage, text: &str, (x, y): (f64, f64), colour: [u8; 3]) {
    let height = (image.height() as f32 / 30.0).clamp(10.0, 22.0);
    if let Some(line) = Line::fitting(text, height, f32::INFINITY) {
        line.draw(image, (x as f32 - line.width / 2.0, y as f32 - line.height() / 2.0), colour);
    }
}

/// Letters one after another, the first at 0.
struct Line {
    font: FontRef<'static>,
    scale: PxScale,
    glyphs: Vec<Glyph>,
    width: f32,
}

impl Line {
    /// As much of a text as fits, with an ellipsis where that is not all;
    /// `None` where nothing fits.
    fn fitting(text: &str, height: f32, room: f32) -> Option<Line> {
        let font = FontRef::try_from_slice(dejavu::sans::regular()).ok()?;
        let set = |text: &str| Line::set(font.clone(), text, height);
        let whole = set(text);
        if whole.width <= room {
            return Some(whole);
        }
        let ends = text.char_indices().map(|(end, _)| end).rev();
        ends.filter(|end| *end > 0)
            .map(|end| set(&format!("{}…", &text[..end])))
            .find(|line| line.width <= room)
    }

    fn set(font: FontRef<'static>, text: &str, height: f32) -> Line {
        let scale = PxScale::from(height);
        let scaled = font.as_scaled(scale);
        let (mut glyphs, mut x, mut last) = (Vec::new(), 0.0, None);
        for letter in text.chars().filter(|c| !c.is_control()) {
            let id = font.glyph_id(letter);
            x += last.map_or(0.0, |last| scaled.kern(last, id));
            glyphs.push(id.with_scale_and_position(scale, point(x, scaled.ascent())));
            x += scaled.h_advance(id);
            last = Some(id);
        }
        Line { font, scale, glyphs, width: x }
    }

    fn height(&self) -> f32 {
        self.scale.y
    }

    fn draw(&self, image: &mut RgbaImage, (left, top): (f32, f32), colour: [u8; 3]) {
        let outlined = self.glyphs.iter().filter_map(|glyph| self.font.outline_glyph(glyph.clone()));
        for glyph in outlined {
            let corner = glyph.px_bounds().min;
            let (x0, y0) = ((corner.x + left.round()) as i64, (corner.y + top.round()) as i64);
            glyph.draw(|x, y, cover| {
                // A word may be meant for a place far off the picture.
                let (x, y) = (x0.saturating_add(i64::from(x)), y0.saturating_add(i64::from(y)));
                blend(image, x, y, colour, cover);
            });
        }
    }
}

fn plate(image: &mut RgbaImage, [left, top, right, bottom]: [f32; 4], background: Background) {
    let height = image.height();
    for y in top as i64..bottom as i64 {
        let colour = background.row(y.max(0) as usize, height).unwrap_or([255; 3]);
        (left as i64..right as i64).for_each(|x| blend(image, x, y, colour, PLATE));
    }
}

/// Lays a share of a colour over a pixel that is not premultiplied, in sRGB as
/// letters are drawn by habit.
fn blend(image: &mut RgbaImage, x: i64, y: i64, colour: [u8; 3], cover: f32) {
    let within = |at: i64, count: u32| u32::try_from(at).ok().filter(|at| *at < count);
    let (Some(x), Some(y)) = (within(x, image.width()), within(y, image.height())) else { return };
    let cover = cover.clamp(0.0, 1.0);
    let pixel = image.get_pixel_mut(x, y);
    let behind = f32::from(pixel[3]) / 255.0 * (1.0 - cover);
    let alpha = cover + behind;
    if alpha > 0.0 {
        for (channel, colour) in pixel.0[..3].iter_mut().zip(colour) {
            let mixed = (f32::from(colour) * cover + f32::from(*channel) * behind) / alpha;
            *channel = (mixed + 0.5) as u8;
        }
        pixel[3] = (alpha * 255.0 + 0.5) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_word_far_off_the_picture_is_not_drawn() {
        let blank = RgbaImage::from_pixel(40, 40, Rgba([9, 9, 9, 255]));
        for at in [1e300, -1e300, 1e19, 1e3, -1e3, f64::MAX] {
            for place in [(at, 20.0), (20.0, at), (at, at)] {
                let mut image = blank.clone();
                word(&mut image, "X", place, [255, 0, 0]);
                assert!(image == blank, "{place:?}");
            }
        }
    }

    fn written(text: &str, width: u32) -> RgbaImage {
        let mut image = RgbaImage::from_pixel(width, 60, Rgba([255, 255, 255, 255]));
        caption(&mut image, text, false, Background::Plain([255; 3]));
        image
    }

    /// The columns that letters have left a mark in.
    fn inked(image: &RgbaImage) -> Vec<u32> {
        let dark = |x: u32| (0..image.height()).any(|y| image[(x, y)][0] < 128);
        (0..image.width()).filter(|x| dark(*x)).collect()
    }

    #[test]
    fn letters_are_dark_on_light_and_stay_inside() {
        let ink = inked(&written("2.50 s", 200));
        assert!(ink.len() > 15 && ink[0] > 2 && *ink.last().unwrap() < 80, "{ink:?}");
        assert!(inked(&written("", 200)).is_empty());
    }

    #[test]
    fn what_is_too_long_is_cut_short_and_what_cannot_fit_left_out() {
        let long = inked(&written("a name that is much too long for so small a picture", 100));
        assert!(*long.last().unwrap() < 98 && long.len() > 30, "{long:?}");
        assert!(inked(&written("name", 12)).is_empty());
        for (width, height) in [(1, 1), (1, 500), (500, 1)] {
            caption(&mut RgbaImage::new(width, height), "any", true, Background::Transparent);
        }
    }

    #[test]
    fn letters_over_nothing_are_opaque_where_they_are() {
        let mut image = RgbaImage::new(100, 700);
        caption(&mut image, "II", false, Background::Transparent);
        assert!(image.pixels().any(|p| p[3] > 250 && p[0] < 60));
        assert_eq!(image[(99, 699)].0, [0; 4]);
    }
}

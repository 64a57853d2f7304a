//! The colour of a point of a surface: what `mesh.wgsl` says, in plain
//! arithmetic, so that every machine computes the same bits.

use super::colour::LINEAR;
use super::scene::{Alpha, Level, Light, Material, Texture, Wrap};

/// What is known of a surface where a pixel's middle meets it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    /// In the camera's axes, of any length, out of the front.
    pub normal: [f32; 3],
    pub uv: [f32; 2],
    /// `uv` at the pixels to the right and below.
    pub uv_beside: [[f32; 2]; 2],
    /// The vertices' colour alone.
    pub colour: [f32; 4],
}

/// How a part is shaded: its material with what that refers to.
#[derive(Clone, Copy)]
pub(crate) struct Surface<'a> {
    pub material: &'a Material,
    pub texture: Option<&'a Texture>,
    pub light: &'a Light,
}

impl Surface<'_> {
    /// Linear, premultiplied; `None` where the material is cut out. `facing`
    /// is −1 on the back of a surface, else 1.
    pub(crate) fn shade(&self, point: &Point, facing: f32) -> Option<[f32; 4]> {
        let mut colour: [f32; 4] =
            std::array::from_fn(|i| (point.colour[i] * self.material.colour[i]).clamp(0.0, 1.0));
        if let Some(texture) = self.texture {
            let texel = texture.read(point.uv, point.uv_beside);
            colour = std::array::from_fn(|i| colour[i] * texel[i]);
        }
        let alpha = match self.material.alpha {
            Alpha::Mask(cutoff) if colour[3] < cutoff => return None,
            Alpha::Opaque | Alpha::Mask(_) => 1.0,
            Alpha::Blend => colour[3],
        };
        let bright = if self.material.unlit { 1.0 } else { brightness(self.light, point.normal, facing) };
        let lit = |i: usize| (colour[i] * bright).min(1.0) * alpha;
        Some([lit(0), lit(1), lit(2), alpha])
    }
}

fn brightness(light: &Light, normal: [f32; 3], facing: f32) -> f32 {
    let length = dot(normal, normal).sqrt();
    let n = if length > 0.0 { normal.map(|v| v * (facing / length)) } else { [0.0, 0.0, 1.0] };
    let sky = 0.5 + 0.5 * dot(n, light.up.to_array());
    let [floor, above, key, fill] = light.strength;
    floor
        + (above - floor) * sky
        + key * dot(n, light.key.to_array()).max(0.0)
        + fill * dot(n, light.fill.to_array()).max(0.0)
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Texture {
    /// Linear colour at `uv`, from the level whose pixels come nearest to the
    /// picture's.
    fn read(&self, uv: [f32; 2], beside: [[f32; 2]; 2]) -> [f32; 4] {
        let level = &self.levels[self.level(uv, beside)];
        let x = uv[0] * level.width as f32;
        let y = uv[1] * level.height as f32;
        if self.nearest {
            return self.texel(level, x.floor(), y.floor());
        }
        let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (right, down) = (x - 0.5 - left, y - 0.5 - top);
        let upper = mix(self.texel(level, left, top), self.texel(level, left + 1.0, top), right);
        let lower = mix(self.texel(level, left, top + 1.0), self.texel(level, left + 1.0, top + 1.0), right);
        mix(upper, lower, down)
    }

    /// round(log₂ of pixels of the texture a pixel of the picture), by
    /// comparing squares: 4^(k − ½) is where level k begins.
    fn level(&self, uv: [f32; 2], beside: [[f32; 2]; 2]) -> usize {
        let size = [self.levels[0].width as f32, self.levels[0].height as f32];
        let step = |b: [f32; 2]| {
            let (x, y) = ((b[0] - uv[0]) * size[0], (b[1] - uv[1]) * size[1]);
            x * x + y * y
        };
        let area = step(beside[0]).max(step(beside[1]));
        let mut begin = 2.0;
        let mut level = 0;
        while level + 1 < self.levels.len() && area >= begin {
            begin *= 4.0;
            level += 1;
        }
        level
    }

    fn texel(&self, level: &Level, x: f32, y: f32) -> [f32; 4] {
        let x = self.wrap[0].index(x, level.width);
        let y = self.wrap[1].index(y, level.height);
        let [r, g, b, a] = level.pixels[(y * level.width + x) as usize];
        let linear = |v: u8| LINEAR[v as usize];
        [linear(r), linear(g), linear(b), f32::from(a) / 255.0]
    }
}

impl Wrap {
    /// The pixel of a row of `count` that stands for whole number `at`.
    fn index(self, at: f32, count: u32) -> u32 {
        // The cast saturates and takes NaN to 0.
        let (at, count) = (at as i64, i64::from(count));
        let index = match self {
            Wrap::Repeat => at.rem_euclid(count),
            Wrap::Clamp => at.clamp(0, count - 1),
            Wrap::Mirror => {
                let there_and_back = at.rem_euclid(2 * count);
                there_and_back.min(2 * count - 1 - there_and_back)
            }
        };
        index as u32
    }
}

fn mix(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_follows_the_edge_rules() {
        let row = |wrap: Wrap| (-4..8).map(|x| wrap.index(x as f32, 3)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
        assert_eq!(Wrap::Clamp.index(f32::INFINITY, 3), 2);
        assert_eq!(Wrap::Repeat.index(f32::NAN, 3), 0);
    }

    #[test]
    fn a_face_towards_the_key_lamp_is_brighter() {
        let light = Light::studio(glam::Vec3::Y);
        let key = light.key.to_array();
        let towards = brightness(&light, key, 1.0);
        assert!(towards > 1.5 * brightness(&light, key, -1.0));
        assert_eq!(towards, brightness(&light, key.map(|v| v * 1024.0), 1.0));
    }
}

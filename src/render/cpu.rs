//! The renderer for machines without a graphics driver.
//!
//! Triangles are set up in parallel, sorted into bands of rows, and the bands
//! are drawn in parallel, each by one thread in the scene's order. So the
//! picture does not depend on the number of threads; and as only the four
//! operations and the square root touch a pixel, nor on the machine.

use super::colour::encode;
use super::layer::Layer;
use super::scene::{Alpha, Scene};
use super::triangle::{Placed, SUBPIXELS, Triangle, doubled_area};
use rayon::prelude::*;
use std::ops::Range;

/// Where colour and depth are sampled, in subpixels from a pixel's middle: the
/// pattern that graphics cards use for 4 samples.
const SAMPLES: [[i32; 2]; 4] = [[-32, -96], [96, -32], [-96, 32], [32, 96]];
/// Rows that one thread draws at a time: few enough to stay in its cache.
const BAND: usize = 8;
/// Triangles that one thread sets up at a time.
const CHUNK: usize = 4096;

/// Draws the parts of a scene.
pub(crate) fn draw(scene: &Scene) -> Layer {
    let (width, height) = scene.size;
    let placed: Vec<Placed> = (0..scene.draws.len()).map(|i| Placed::new(scene, i)).collect();
    let triangles = set_up(&placed);
    let bands = sort_into_bands(&triangles, height);
    let mut layer = Layer::new(width, height);
    let band_bytes = (width as usize * 4 * BAND).max(1);
    layer.par_chunks_mut(band_bytes).enumerate().for_each_init(
        || Band::new(width),
        |band, (index, pixels)| {
            let triangles = bands[index].iter().map(|t| &triangles[*t as usize]);
            band.start(index * BAND, pixels.len() / (width as usize * 4));
            triangles.for_each(|t| band.draw(t, &placed[t.draw as usize]));
            band.resolve(pixels);
        },
    );
    layer
}

/// All triangles on the screen, in the order of drawing.
fn set_up(placed: &[Placed]) -> Vec<Triangle> {
    let chunks: Vec<(&Placed, &[u32])> = placed
        .iter()
        .flat_map(|p| p.part.indices.chunks(CHUNK * 3).map(move |indices| (p, indices)))
        .collect();
    let triangles = |(placed, indices): &(&Placed, &[u32])| {
        let mut out = Vec::with_capacity(indices.len() / 3);
        let corners = indices.as_chunks().0;
        corners.iter().for_each(|v| placed.set_up(*v, &mut out));
        out
    };
    chunks.par_iter().map(triangles).collect::<Vec<_>>().concat()
}

/// For each band of rows the triangles that reach into it.
fn sort_into_bands(triangles: &[Triangle], height: u32) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); (height as usize).div_ceil(BAND)];
    for (index, triangle) in triangles.iter().enumerate() {
        let rows = triangle.pixels(1, height);
        for band in &mut bands[rows.start / BAND..rows.end.div_ceil(BAND)] {
            band.push(index as u32);
        }
    }
    bands
}

/// The samples of a few rows, and what is drawn to them.
struct Band {
    width: usize,
    rows: Range<usize>,
    /// Columns that anything was drawn to; the others are stale.
    used: Range<usize>,
    /// Reversed: 0 far, 1 near.
    depth: Vec<[f32; 4]>,
    colour: Vec<[[f32; 4]; 4]>,
}

impl Band {
    fn new(width: u32) -> Self {
        let pixels = width as usize * BAND;
        Band {
            width: width as usize,
            rows: 0..0,
            used: 0..0,
            depth: vec![[0.0; 4]; pixels],
            colour: vec![[[0.0; 4]; 4]; pixels],
        }
    }

    fn start(&mut self, first: usize, count: usize) {
        self.rows = first..first + count;
        self.used = 0..0;
    }

    /// Makes columns ready to be drawn to, once.
    fn open(&mut self, columns: &Range<usize>) {
        if self.used.is_empty() {
            self.clear(columns.clone());
            self.used = columns.clone();
            return;
        }
        if columns.start < self.used.start {
            self.clear(columns.start..self.used.start);
            self.used.start = columns.start;
        }
        if columns.end > self.used.end {
            self.clear(self.used.end..columns.end);
            self.used.end = columns.end;
        }
    }

    fn clear(&mut self, columns: Range<usize>) {
        for row in 0..self.rows.len() {
            let at = row * self.width;
            self.depth[at + columns.start..at + columns.end].fill([0.0; 4]);
            self.colour[at + columns.start..at + columns.end].fill([[0.0; 4]; 4]);
        }
    }

    fn draw(&mut self, triangle: &Triangle, placed: &Placed) {
        let columns = triangle.pixels(0, self.width as u32);
        let rows = triangle.pixels(1, self.rows.end as u32);
        if columns.is_empty() {
            return;
        }
        self.open(&columns);
        let raster = Raster::new(triangle, placed);
        for y in rows.start.max(self.rows.start)..rows.end {
            let row = (y - self.rows.start) * self.width;
            let mut edges = raster.edges_at(columns.start, y);
            for x in columns.clone() {
                let inside = raster.samples_inside(edges);
                if inside != 0 {
                    self.pixel(row + x, inside, &raster, x, y, edges);
                }
                edges = std::array::from_fn(|k| edges[k] + raster.step[k]);
            }
        }
    }

    #[inline(always)]
    fn pixel(&mut self, at: usize, inside: u8, raster: &Raster, x: usize, y: usize, edges: [i64; 3]) {
        let depth = raster.depth_at(x, y);
        let seen = |s: &usize| inside >> s & 1 == 1 && depth[*s] > self.depth[at][*s];
        let seen = (0..4).filter(seen).fold(0_u8, |mask, s| mask | 1 << s);
        if seen == 0 {
            return;
        }
        let Some(colour) = raster.colour(edges) else {
            return;
        };
        for s in (0..4).filter(|s| seen >> s & 1 == 1) {
            let under = &mut self.colour[at][s];
            if raster.blends {
                let through = 1.0 - colour[3];
                *under = std::array::from_fn(|i| colour[i] + under[i] * through);
            } else {
                *under = colour;
                self.depth[at][s] = depth[s];
            }
        }
    }

    fn resolve(&self, pixels: &mut [u8]) {
        for row in 0..self.rows.len() {
            for x in self.used.clone() {
                let at = row * self.width + x;
                pixels[at * 4..at * 4 + 4].copy_from_slice(&mean(&self.colour[at]));
            }
        }
    }
}

/// Four samples become a pixel: the mean of their light, as sRGB.
fn mean(samples: &[[f32; 4]; 4]) -> [u8; 4] {
    let [a, b, c, d] = samples;
    let [red, green, blue, alpha] = std::array::from_fn(|i| (a[i] + b[i] + c[i] + d[i]) * 0.25);
    if alpha == 0.0 {
        return [0; 4];
    }
    [encode(red), encode(green), encode(blue), (alpha * 255.0 + 0.5) as u8]
}

/// A triangle made ready for its pixels.
struct Raster<'a> {
    triangle: &'a Triangle,
    placed: &'a Placed<'a>,
    blends: bool,
    /// The edge function opposite each corner is across·x + down·y + start in
    /// subpixels, positive inside.
    across: [i64; 3],
    down: [i64; 3],
    start: [i64; 3],
    /// `across` for a whole pixel.
    step: [i64; 3],
    /// 0 where the edge's own points belong to the triangle, else 1.
    open: [i64; 3],
    /// What each sample adds to each edge function.
    sample: [[i64; 4]; 3],
    inverse_area: f32,
    /// How depth changes a subpixel across and down.
    slope: [f32; 2],
    /// Smallest and largest depth of the corners.
    depths: [f32; 2],
}

impl<'a> Raster<'a> {
    fn new(triangle: &'a Triangle, placed: &'a Placed<'a>) -> Self {
        let corner = |k: usize| triangle.corners[k % 3].map(i64::from);
        let side = |k: usize| (corner(k + 1), corner(k + 2));
        let across = [0, 1, 2].map(|k| side(k).0[1] - side(k).1[1]);
        let down = [0, 1, 2].map(|k| side(k).1[0] - side(k).0[0]);
        let start = [0, 1, 2].map(|k| -across[k] * side(k).0[0] - down[k] * side(k).0[1]);
        // Of two triangles that share an edge, only the one whose left or top
        // edge it is draws a sample that lies on it.
        let left_or_top = |k: usize| across[k] > 0 || (across[k] == 0 && down[k] > 0);
        let area = doubled_area(triangle.corners) as f32;
        let [d0, d1, d2] = triangle.depth;
        let slope = |e: [i64; 3]| ((d1 - d0) * e[1] as f32 + (d2 - d0) * e[2] as f32) / area;
        Raster {
            triangle,
            placed,
            blends: placed.part.material.alpha == Alpha::Blend,
            across,
            down,
            start,
            step: across.map(|a| a * i64::from(SUBPIXELS)),
            open: [0, 1, 2].map(|k| i64::from(!left_or_top(k))),
            sample: [0, 1, 2]
                .map(|k| SAMPLES.map(|[x, y]| across[k] * i64::from(x) + down[k] * i64::from(y))),
            inverse_area: 1.0 / area,
            slope: [slope(across), slope(down)],
            depths: [d0.min(d1).min(d2), d0.max(d1).max(d2)],
        }
    }

    /// The edge functions in the middle of a pixel.
    fn edges_at(&self, x: usize, y: usize) -> [i64; 3] {
        let [x, y] = [x, y].map(middle);
        std::array::from_fn(|k| self.across[k] * x + self.down[k] * y + self.start[k])
    }

    /// A bit for each sample that lies in the triangle.
    #[inline(always)]
    fn samples_inside(&self, edges: [i64; 3]) -> u8 {
        let mut mask = 0;
        for s in 0..4 {
            let lies = |k: usize| edges[k] + self.sample[k][s] >= self.open[k];
            mask |= u8::from(lies(0) & lies(1) & lies(2)) << s;
        }
        mask
    }

    /// Depth at the samples of a pixel. Held between the corners' depths, as a
    /// sliver's slope is steep enough to be lost in rounding.
    #[inline(always)]
    fn depth_at(&self, x: usize, y: usize) -> [f32; 4] {
        let [x0, y0] = self.triangle.corners[0].map(i64::from);
        let (x, y) = (middle(x) - x0, middle(y) - y0);
        SAMPLES.map(|[across, down]| {
            let x = (x + i64::from(across)) as f32;
            let y = (y + i64::from(down)) as f32;
            let depth = self.triangle.depth[0] + self.slope[0] * x + self.slope[1] * y;
            depth.clamp(self.depths[0], self.depths[1])
        })
    }

    #[inline(always)]
    fn colour(&self, edges: [i64; 3]) -> Option<[f32; 4]> {
        match self.triangle.flat {
            Some(colour) => Some(colour),
            None => self.shade(edges),
        }
    }

    fn shade(&self, edges: [i64; 3]) -> Option<[f32; 4]> {
        let vertices = &self.triangle.vertices;
        let mut point = self.placed.mix(vertices, self.weights(edges));
        if self.placed.surface.texture.is_some() {
            point.uv_beside = [self.across, self.down].map(|step| {
                let beside = |k: usize| edges[k] + step[k] * i64::from(SUBPIXELS);
                let weights = self.weights([beside(0), beside(1), beside(2)]);
                self.placed.uv(vertices, weights)
            });
        }
        self.placed.surface.shade(&point, self.triangle.facing)
    }

    /// How much of each vertex is in a point of the triangle, seen in
    /// perspective.
    fn weights(&self, edges: [i64; 3]) -> [f32; 3] {
        let inverse_w = self.triangle.inverse_w;
        let part: [f32; 3] = std::array::from_fn(|k| edges[k] as f32 * self.inverse_area * inverse_w[k]);
        let sum = part[0] + part[1] + part[2];
        let share = part.map(|p| p / sum);
        let Some(cut) = &self.triangle.cut else {
            return share;
        };
        std::array::from_fn(|v| share[0] * cut[0][v] + share[1] * cut[1][v] + share[2] * cut[2][v])
    }
}

fn middle(pixel: usize) -> i64 {
    pixel as i64 * i64::from(SUBPIXELS) + i64::from(SUBPIXELS / 2)
}

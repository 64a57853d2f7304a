//! The few colours that stand best for many.
//!
//! Where there are few enough they are taken as they are. Else the box of
//! colours with the largest sum of squared distances from its mean is cut there,
//! across its longest side, until there are enough boxes (the idea is Wu's, in
//! Graphics Gems II, 1991); then each colour goes to the nearest mean, once
//! round of k-means.

use std::ops::Range;

/// How much a step of red, green and blue matters to the eye.
const WEIGHT: [f32; 3] = [1.0, 1.4, 0.8];
/// Colours are told apart no finer than this many allow.
const MOST_DISTINCT: usize = 1 << 14;

/// A palette, and which colours it stands for.
#[derive(Debug)]
pub(super) struct Palette {
    colours: Vec<[u8; 3]>,
    /// All colours met, coarsened by `mask`, in order, each with its entry.
    known: Vec<(u32, u8)>,
    mask: u32,
}

impl Palette {
    /// A palette of at most `most` colours, 1 to 256, for pixels of these colours.
    pub(super) fn of(pixels: impl Iterator<Item = [u8; 3]>, most: usize) -> Palette {
        let mut counted = count(pixels);
        let mut mask = 0xff_ffff;
        for bits in 1..8 {
            if counted.len() <= MOST_DISTINCT {
                break;
            }
            mask = 0x01_0101 * (0xff << bits & 0xff);
            counted.iter_mut().for_each(|(colour, _)| *colour &= mask);
            counted = merge(counted);
        }
        if counted.len() <= most {
            let known = counted.iter().zip(0..).map(|(&(colour, _), entry)| (colour, entry)).collect();
            return Palette { colours: counted.iter().map(|(c, _)| split(*c)).collect(), known, mask };
        }
        let mut points: Vec<Point> = counted.iter().map(|&(c, n)| Point::new(c, n)).collect();
        let means = boxes(&mut points, most);
        let means = nearest_means(&points, &means);
        let known = counted.iter().map(|&(c, n)| (c, nearest(&means, &Point::new(c, n)) as u8)).collect();
        Palette { colours: means.iter().map(|mean| unweighted(*mean)).collect(), known, mask }
    }

    pub(super) fn colours(&self) -> &[[u8; 3]] {
        &self.colours
    }

    /// The entry for each colour that was met.
    pub(super) fn lookup(&self) -> impl FnMut([u8; 3]) -> u8 {
        let mut last = (u32::MAX, 0);
        move |colour| {
            let colour = joined(colour) & self.mask;
            if colour != last.0 {
                let found = self.known.binary_search_by_key(&colour, |(c, _)| *c);
                last = (colour, found.map_or(0, |at| self.known[at].1));
            }
            last.1
        }
    }
}

fn joined([r, g, b]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

fn split(colour: u32) -> [u8; 3] {
    let [_, r, g, b] = colour.to_be_bytes();
    [r, g, b]
}

/// Each colour once, in order, with how often it was met.
fn count(pixels: impl Iterator<Item = [u8; 3]>) -> Vec<(u32, u32)> {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for colour in pixels.map(joined) {
        match runs.last_mut() {
            Some((last, count)) if *last == colour => *count += 1,
            _ => runs.push((colour, 1)),
        }
    }
    merge(runs)
}

fn merge(mut runs: Vec<(u32, u32)>) -> Vec<(u32, u32)> {
    runs.sort_unstable();
    runs.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0 };
        same
    });
    runs
}

/// A colour as the eye sees distances.
#[derive(Clone, Copy, Debug)]
struct Point {
    at: [f32; 3],
    count: f32,
}

impl Point {
    fn new(colour: u32, count: u32) -> Point {
        let rgb = split(colour);
        // The root lets thin edges have their say beside large areas.
        Point { at: [0, 1, 2].map(|i| f32::from(rgb[i]) * WEIGHT[i]), count: (count as f32).sqrt() }
    }
}

fn unweighted(at: [f32; 3]) -> [u8; 3] {
    [0, 1, 2].map(|i| (at[i] / WEIGHT[i] + 0.5) as u8)
}

/// A box of colours: a range of points with their mean.
struct Cluster {
    points: Range<usize>,
    mean: [f32; 3],
    /// The axis along which they lie farthest apart.
    axis: usize,
    /// Sum of squared distances from the mean.
    error: f32,
}

impl Cluster {
    fn new(all: &[Point], points: Range<usize>) -> Cluster {
        let inside = &all[points.clone()];
        let total: f32 = inside.iter().map(|p| p.count).sum();
        let sum = |value: &dyn Fn(&Point) -> f32| inside.iter().map(|p| p.count * value(p)).sum::<f32>();
        let mean = [0, 1, 2].map(|i| sum(&|p| p.at[i]) / total);
        let errors = [0, 1, 2].map(|i| sum(&|p| (p.at[i] - mean[i]) * (p.at[i] - mean[i])));
        let axis = (0..3).max_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap_or(0);
        Cluster { points, mean, axis, error: errors.iter().sum() }
    }
}

/// Means of at most `most` boxes.
fn boxes(points: &mut [Point], most: usize) -> Vec<[f32; 3]> {
    let mut boxes = vec![Cluster::new(points, 0..points.len())];
    while boxes.len() < most {
        let worst = (0..boxes.len()).max_by(|a, b| boxes[*a].error.total_cmp(&boxes[*b].error)).unwrap_or(0);
        let Cluster { points: range, mean, axis, .. } = &boxes[worst];
        let (range, axis, cut) = (range.clone(), *axis, mean[*axis]);
        let below = partition(&mut points[range.clone()], |p| p.at[axis] < cut);
        if below == 0 || below == range.len() {
            break;
        }
        let middle = range.start + below;
        boxes[worst] = Cluster::new(points, range.start..middle);
        boxes.push(Cluster::new(points, middle..range.end));
    }
    boxes.into_iter().map(|b| b.mean).collect()
}

/// Moves what passes to the front and says how many do.
fn partition(points: &mut [Point], passes: impl Fn(&Point) -> bool) -> usize {
    let mut front = 0;
    for i in 0..points.len() {
        if passes(&points[i]) {
            points.swap(front, i);
            front += 1;
        }
    }
    front
}

/// The means of the points that are nearest to each of `means`.
fn nearest_means(points: &[Point], means: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut sums = vec![([0.0; 3], 0.0); means.len()];
    for point in points {
        let (sum, total) = &mut sums[nearest(means, point)];
        (0..3).for_each(|i| sum[i] += point.at[i] * point.count);
        *total += point.count;
    }
    let mean = |((sum, total), old): (&([f32; 3], f32), &[f32; 3])| match *total > 0.0 {
        true => sum.map(|s| s / total),
        false => *old,
    };
    sums.iter().zip(means).map(mean).collect()
}

fn nearest(means: &[[f32; 3]], point: &Point) -> usize {
    let distance = |mean: &[f32; 3]| {
        let [x, y, z] = [0, 1, 2].map(|i| mean[i] - point.at[i]);
        x * x + y * y + z * z
    };
    let (mut best, mut least) = (0, f32::INFINITY);
    for (i, mean) in means.iter().enumerate() {
        let d = distance(mean);
        if d < least {
            (best, least) = (i, d);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest distance of a channel from what stands for it.
    fn worst(pixels: &[[u8; 3]], most: usize) -> (usize, u8) {
        let palette = Palette::of(pixels.iter().copied(), most);
        let mut entry = palette.lookup();
        let off = |pixel: &[u8; 3]| {
            let shown = palette.colours()[entry(*pixel) as usize];
            (0..3).map(|i| shown[i].abs_diff(pixel[i])).max().unwrap()
        };
        let worst = pixels.iter().map(off).max().unwrap_or(0);
        (palette.colours().len(), worst)
    }

    #[test]
    fn few_colours_are_exact() {
        let pixels: Vec<[u8; 3]> = (0..255).map(|i| [i, 255 - i, i / 2]).collect();
        assert_eq!(worst(&pixels, 255), (255, 0));
        assert_eq!(worst(&[], 255), (0, 0));
    }

    #[test]
    fn many_colours_are_near() {
        // A line of 1024 colours by 255 entries: steps of four.
        let line: Vec<[u8; 3]> = (0..=255).flat_map(|g| [0, 1, 2, 3].map(|r| [r, g, 40])).collect();
        let (count, off) = worst(&line, 255);
        assert!(count == 255 && off <= 4, "{count} {off}");
        // The whole cube, in steps of 4: 255 boxes are about 40 wide.
        let cube: Vec<[u8; 3]> =
            (0..1 << 18).map(|i: u32| [i, i >> 6, i >> 12].map(|c| (c as u8 & 63) * 4)).collect();
        let (count, off) = worst(&cube, 255);
        assert!(count == 255 && off <= 48, "{count} {off}");
    }

    #[test]
    fn a_rare_colour_far_from_all_others_keeps_its_entry() {
        let mut pixels: Vec<[u8; 3]> =
            (0..100_000_u32).map(|i| [(i % 200) as u8, (i % 150) as u8, 90]).collect();
        pixels.push([250, 10, 250]);
        let palette = Palette::of(pixels.into_iter(), 255);
        assert_eq!(palette.colours()[palette.lookup()([250, 10, 250]) as usize], [250, 10, 250]);
    }
}

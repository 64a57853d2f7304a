//! The layers of a panel as what an SVG knows: paths, circles, words.

use super::figure::{Dot, Layer, Panel};
use super::layout::{Area, LEGEND};
use super::style::{Ink, Rgb, Stroke, Theme};
use super::thin::{Line, Point, thinned};
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};
use std::collections::{BTreeMap, HashSet};
use std::fmt::Write;

/// The line that marks a time.
pub(super) const MARK: Stroke = Stroke::solid(Ink::Quiet, 0.8).dashed("2 3");

/// Marks that are nearer to each other than this, pixels, do not cross the panel.
const MARKS_APART: f64 = 7.0;

/// How long marks are then, pixels.
const SHORT_MARK: f64 = 7.0;

/// Of a trace, places that are nearer than this to the one before are left out, pixels.
const SEEN: f64 = 0.25;

/// Colours and the scene that grows.
pub(super) struct Brush {
    pub(super) theme: Theme,
    pub(super) scene: Scene,
}

/// From a panel's units to pixels.
pub(super) struct Map {
    area: Area,
    x: [f64; 2],
    y: [f64; 2],
}

impl Map {
    pub(super) fn new(panel: &Panel, area: Area) -> Map {
        Map { area, x: panel.x.range, y: panel.y.range }
    }

    fn at(&self, [x, y]: Point) -> Point {
        let share = |v: f64, [low, high]: [f64; 2]| (v - low) / (high - low);
        let Area { x: left, y: top, width, height } = self.area;
        [left + width * share(x, self.x), top + height * (1.0 - share(y, self.y))]
    }

    fn line(&self, line: &Line) -> Line {
        line.iter().map(|stretch| stretch.iter().map(|&point| self.at(point)).collect()).collect()
    }
}

impl Brush {
    pub(super) fn new(theme: Theme, scene: Scene) -> Brush {
        Brush { theme, scene }
    }

    /// Everything in a panel; lines end at its edges, dots and words do not.
    pub(super) fn layers(&mut self, layers: &[Layer], map: &Map, number: usize) {
        let Area { x, y, width, height } = map.area;
        let id = format!("panel-{number}");
        self.scene.add(Primitive::ClipStart { x, y, width, height, id });
        let outside = |layer: &&Layer| matches!(layer, Layer::Dots(..) | Layer::Words(..));
        layers.iter().filter(|layer| !outside(layer)).for_each(|layer| self.layer(layer, map));
        self.scene.add(Primitive::ClipEnd);
        layers.iter().filter(outside).for_each(|layer| self.layer(layer, map));
    }

    fn layer(&mut self, layer: &Layer, map: &Map) {
        let Area { x: left, y: top, width, height } = map.area;
        match layer {
            Layer::Graph(line, stroke) => {
                let columns = width.ceil().max(1.0) as usize;
                let line = map.line(&thinned(line, map.x, columns));
                self.jumps(&line, stroke);
                self.path(&line, stroke);
            }
            Layer::Trace(line, stroke) => self.path(&apart(map.line(line)), stroke),
            Layer::Dots(points, dot) => self.dots(points, *dot, map),
            Layer::Marks(times) => self.marks(times, map),
            Layer::Level(at, stroke) => {
                let y = map.at([map.x[0], *at])[1].clamp(top, top + height);
                self.segment([left, y], [left + width, y], stroke);
            }
            Layer::Words(at, words) => {
                let [x, y] = map.at(*at);
                self.text(x, y + 0.36 * f64::from(LEGEND), words, LEGEND, TextAnchor::Middle, false);
            }
        }
    }

    /// A line of stretches, in pixels, as one path.
    fn path(&mut self, line: &[Vec<Point>], stroke: &Stroke) {
        let mut d = String::new();
        for stretch in line.iter().filter(|stretch| stretch.len() > 1) {
            for (i, [x, y]) in stretch.iter().enumerate() {
                let _ = write!(d, "{}{} {}", if i == 0 { 'M' } else { 'L' }, Pixels(*x), Pixels(*y));
            }
        }
        if d.is_empty() {
            return;
        }
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: None,
            stroke: colour(self.theme.stroke(stroke)),
            stroke_width: stroke.width,
            opacity: None,
            stroke_dasharray: (!stroke.dashes.is_empty()).then(|| stroke.dashes.to_owned()),
        })));
    }

    /// Thin lines that join what lies on either side of a jump.
    fn jumps(&mut self, line: &[Vec<Point>], stroke: &Stroke) {
        let ends = line.windows(2).filter_map(|pair| Some([*pair[0].last()?, *pair[1].first()?]));
        let upright = ends.filter(|[a, b]| (a[0] - b[0]).abs() < 0.5).map(|ends| ends.to_vec());
        let upright: Line = upright.collect();
        self.path(&upright, &Stroke { width: 0.7, dashes: "", ..*stroke });
    }

    /// A straight line, in pixels.
    pub(super) fn segment(&mut self, from: Point, to: Point, stroke: &Stroke) {
        self.path(&[vec![from, to]], stroke);
    }

    /// Dots, of which those are left out that would lie on another. Of more than can be told
    /// apart the highest and the lowest of each column are drawn.
    fn dots(&mut self, points: &[Point], dot: Dot, map: &Map) {
        let spacing = map.area.width / points.len().max(1) as f64;
        let radius = if spacing >= 9.0 { 4.2 } else { (0.45 * spacing).clamp(1.3, 4.2) };
        let mut places: Vec<Point> = points.iter().map(|&point| map.at(point)).collect();
        places.retain(|place| place.iter().all(|c| c.is_finite()));
        if spacing < 0.5 {
            places = outline(&places, 2.0 * radius);
        }
        let mut taken: HashSet<[i64; 2]> = HashSet::new();
        places.retain(|place| taken.insert(place.map(|c| (c / radius).round() as i64)));
        places.into_iter().for_each(|[x, y]| self.dot(x, y, dot, radius));
    }

    /// A dot, in pixels.
    pub(super) fn dot(&mut self, cx: f64, cy: f64, dot: Dot, r: f64) {
        let (ground, words, quiet) =
            (self.theme.background(), self.theme.colour(Ink::Words), self.theme.colour(Ink::Quiet));
        let small = r < 3.0;
        let (fill, edge) = match dot {
            Dot::Key if small => (words, words),
            Dot::Key => (ground, words),
            Dot::Control => (quiet, quiet),
        };
        let r = if dot == Dot::Control { 0.72 * r } else { r };
        self.scene.add(Primitive::Circle {
            cx,
            cy,
            r: if small { r } else { r - 0.7 },
            fill: colour(fill),
            fill_opacity: None,
            stroke: (!small).then(|| colour(edge)),
            stroke_width: (!small).then_some(1.4),
        });
    }

    /// Upright lines across the panel; short ones at its top where they stand so close
    /// that they would hide what is below.
    fn marks(&mut self, times: &[f64], map: &Map) {
        let Area { y: top, width, height, .. } = map.area;
        let crowded = times.len() as f64 * MARKS_APART > width;
        let (bottom, apart) = if crowded { (top + SHORT_MARK, 2.0) } else { (top + height, 0.0) };
        let (mut line, mut last) = (Line::new(), f64::NEG_INFINITY);
        for &time in times {
            let x = map.at([time, map.y[0]])[0];
            if x - last >= apart {
                line.push(vec![[x, top], [x, bottom]]);
                last = x;
            }
        }
        self.path(&line, &if crowded { MARK.dashed("") } else { MARK });
    }

    /// Words, in pixels; control characters, which XML has not, become spaces.
    pub(super) fn text(&mut self, x: f64, y: f64, words: &str, size: u32, anchor: TextAnchor, bold: bool) {
        // A dollar sign would begin a formula.
        let content: String = words.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let content = content.replace('$', "\\$");
        self.scene.add(Primitive::Text { x, y, content, size, anchor, rotate: None, bold, color: None });
    }
}

/// A number of pixels: hundredths, without needless noughts.
struct Pixels(f64);

impl std::fmt::Display for Pixels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Far outside of any picture, where lines are cut all the same.
        let hundredths = (self.0.clamp(-1e6, 1e6) * 100.0).round();
        write!(f, "{}", hundredths / 100.0)
    }
}

fn colour([r, g, b]: Rgb) -> Color {
    Color::Rgb(r, g, b)
}

/// The highest and the lowest place of each column.
fn outline(places: &[Point], width: f64) -> Vec<Point> {
    let mut columns: BTreeMap<i64, [Point; 2]> = BTreeMap::new();
    for &place in places {
        let [low, high] = columns.entry((place[0] / width).floor() as i64).or_insert([place; 2]);
        if place[1] < low[1] {
            *low = place;
        }
        if place[1] > high[1] {
            *high = place;
        }
    }
    columns.into_values().flatten().collect()
}

/// A trace without places that cannot be told from the one before; the last one stays.
fn apart(mut line: Line) -> Line {
    for stretch in &mut line {
        let end = stretch.last().copied();
        let mut before: Option<Point> = None;
        stretch.retain(|p| {
            let near = |b: Point| libm::hypot(p[0] - b[0], p[1] - b[1]) < SEEN;
            let keep = before.is_none_or(|b| !near(b));
            if keep {
                before = Some(*p);
            }
            keep
        });
        if end.is_some() && stretch.last() != end.as_ref() {
            stretch.extend(end);
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_short() {
        let texts = [1.0, -0.004, 12.346, 1e300, f64::NEG_INFINITY].map(|x| Pixels(x).to_string());
        assert_eq!(texts, ["1", "-0", "12.35", "1000000", "-1000000"]);
    }

    #[test]
    fn traces_lose_what_cannot_be_seen_but_not_their_ends() {
        let line = vec![(0..=1000).map(|i| [f64::from(i) * 0.01, 0.0]).collect::<Vec<_>>()];
        let thin = apart(line);
        assert!(thin[0].len() < 50);
        assert_eq!((thin[0][0], thin[0][thin[0].len() - 1]), ([0.0, 0.0], [10.0, 0.0]));
    }
}

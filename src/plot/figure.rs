//! A figure as plain data: what is drawn where, in the units of its axes.

use super::style::Stroke;
use super::thin::{Line, Point};

/// A page of panels below a title and a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What is shown.
    pub title: String,
    /// What lines and marks stand for, in all panels alike.
    pub legend: Vec<Entry>,
    /// What the ends of the colours that run with time stand for.
    pub ramp: Option<[String; 2]>,
    /// In rows, from left to right.
    pub panels: Vec<Panel>,
    /// How many stand in a row.
    pub columns: usize,
    /// Widths of columns and heights of rows, in any unit; even where empty.
    pub shares: [Vec<f64>; 2],
    /// Width and height of a panel's place in pixels, where nobody asks for a size.
    pub cell: [f64; 2],
}

/// A line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What it stands for.
    pub label: String,
    /// How it looks.
    pub sign: Sign,
}

/// How an entry of the legend looks.
#[derive(Clone, Debug, PartialEq)]
pub enum Sign {
    /// A piece of a line.
    Line(Stroke),
    /// A dot.
    Dot(Dot),
    /// The upright line that marks a time.
    Mark,
}

/// A diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// From left to right.
    pub x: Axis,
    /// From bottom to top.
    pub y: Axis,
    /// Whether both axes have one scale, which all such panels of a figure share.
    pub equal: bool,
    /// What is drawn, one above the other.
    pub layers: Vec<Layer>,
}

/// One axis of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it counts, with its unit; none for a drawing, which has no scale.
    pub label: Option<String>,
    /// From where to where.
    pub range: [f64; 2],
}

/// Something in a panel.
#[derive(Clone, Debug, PartialEq)]
pub enum Layer {
    /// A function of x: of its points those are drawn that a picture can show. Jumps are
    /// joined by a thin line.
    Graph(Line, Stroke),
    /// A line through a plane or a space.
    Trace(Line, Stroke),
    /// Points along x.
    Dots(Vec<Point>, Dot),
    /// Upright lines at places of x.
    Marks(Vec<f64>),
    /// A level line from side to side.
    Level(f64, Stroke),
    /// Words with their middle at a place.
    Words(Point, String),
}

/// How a dot looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dot {
    /// A key that a curve runs through.
    Key,
    /// A point that shapes a curve from beside.
    Control,
}

impl Figure {
    /// Panels over time, as many in a row as stay readable.
    pub(super) fn over_time(title: String, legend: Vec<Entry>, panels: Vec<Panel>) -> Figure {
        let (columns, cell) = match panels.len() {
            0 | 1 => (1, [1000.0, 500.0]),
            2 => (1, [1000.0, 350.0]),
            3 => (1, [1000.0, 290.0]),
            4..=12 => (2, [620.0, 350.0]),
            _ => (4, [500.0, 310.0]),
        };
        Figure { title, legend, ramp: None, panels, columns, shares: [Vec::new(), Vec::new()], cell }
    }
}

/// Lines as graphs, dashed ones last: where lines lie on each other, those below show
/// through the gaps.
pub(super) fn graphs(lines: impl Iterator<Item = (Line, Stroke)>) -> impl Iterator<Item = Layer> {
    let (solid, dashed): (Vec<_>, Vec<_>) = lines.partition(|(_, stroke)| stroke.dashes.is_empty());
    solid.into_iter().chain(dashed).map(|(line, stroke)| Layer::Graph(line, stroke))
}

impl Axis {
    /// An axis with a scale.
    pub fn new(label: impl Into<String>, range: [f64; 2]) -> Axis {
        Axis { label: Some(label.into()), range }
    }

    /// One without.
    pub fn bare(range: [f64; 2]) -> Axis {
        Axis { label: None, range }
    }
}

/// The least and the largest of some numbers; none of no finite ones.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.filter(|v| v.is_finite()).fold(None, |range, v| match range {
        None => Some([v, v]),
        Some([low, high]) => Some([low.min(v), high.max(v)]),
    })
}

/// A range with some room on either side. Numbers that are all the same but for rounding
/// get the room of `least`.
pub(super) fn with_room([low, high]: [f64; 2], least: f64) -> [f64; 2] {
    let span = high - low;
    if span > 1e-9 * low.abs().max(high.abs()) && span > 1e-9 * least {
        return [low - 0.06 * span, high + 0.06 * span];
    }
    let (middle, half) = (0.5 * (low + high), 0.5 * least.max(0.2 * low.abs()));
    [middle - half, middle + half]
}

/// The range from 0 to a largest value, which is `least` at least where all is rounding.
pub(super) fn from_zero(largest: f64, least: f64) -> [f64; 2] {
    [0.0, if largest > 1e-9 * least { 1.06 * largest } else { least }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_room_and_are_never_empty() {
        assert_eq!(with_room([0.0, 100.0], 1.0), [-6.0, 106.0]);
        assert_eq!(with_room([1.0, 1.0 + 1e-12], 1.0), [0.5 + 5e-13, 1.5 + 5e-13]);
        assert_eq!(with_room([100.0, 100.0], 1.0), [90.0, 110.0]);
        assert_eq!(from_zero(1e-12, 1.0), [0.0, 1.0]);
        assert_eq!(from_zero(50.0, 1.0), [0.0, 53.0]);
    }

    #[test]
    fn extents_pass_over_what_is_no_number() {
        assert_eq!(extent([2.0, f64::NAN, -1.0, f64::INFINITY].into_iter()), Some([-1.0, 2.0]));
        assert_eq!(extent([f64::NAN].into_iter()), None);
    }
}

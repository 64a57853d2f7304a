//! The ground: a grid that fades away from the motion, and a cross of axes.

use super::stroke::Stroke;
use glam::DVec3;

/// A level grid under a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Floor {
    /// On the ground, below the middle of the motion.
    middle: DVec3,
    /// From line to line: 1, 2 or 5 times a power of ten.
    step: f64,
    /// From the middle to where the lines have faded.
    reach: f64,
    /// Where the axes cross.
    cross: DVec3,
}

/// Of lines, linear; their cover in the middle.
const DARK: [f32; 3] = [0.03, 0.035, 0.05];
const LIGHT: [f32; 3] = [0.20, 0.21, 0.24];
const COVER: f32 = 0.4;
/// The axes' letters, directions and colours.
const AXES: [(&str, DVec3, [f32; 4]); 3] = [
    ("X", DVec3::X, [0.70, 0.03, 0.03, 1.0]),
    ("Y", DVec3::Y, [0.03, 0.33, 0.03, 1.0]),
    ("Z", DVec3::Z, [0.02, 0.11, 0.70, 1.0]),
];
/// Pieces a line consists of, so that it can fade.
const PIECES: u32 = 24;

impl Floor {
    /// The ground of a motion within these bounds; `None` where they hold nothing.
    pub(crate) fn under(low: DVec3, high: DVec3) -> Option<Floor> {
        let extent = high - low;
        let span = extent.x.max(extent.z).max(extent.y / 2.0);
        if !(span.is_finite() && span > 0.0) {
            return None;
        }
        let step = easily_said(span / 6.0);
        let middle = ((low + high) / 2.0).with_y(low.y);
        let reach = 0.75 * span + 2.0 * step;
        let origin = DVec3::new(0.0, low.y, 0.0);
        let near_by = (origin - middle).length() < 0.7 * reach;
        let crossing = (middle / step).round() * step;
        let cross = if near_by { origin } else { crossing.with_y(low.y) };
        Some(Floor { middle, step, reach, cross })
    }

    /// The lines of the grid and of the axes.
    pub(crate) fn strokes(&self, on_light: bool) -> Vec<Stroke> {
        let colour = if on_light { DARK } else { LIGHT };
        let mut strokes = Vec::new();
        for (along, across) in [(DVec3::X, DVec3::Z), (DVec3::Z, DVec3::X)] {
            let place = self.middle.dot(across);
            let [first, last] = [place - self.reach, place + self.reach].map(|x| x / self.step);
            for line in first.ceil() as i64..=last.floor() as i64 {
                strokes.push(self.line(along, across * (line as f64 * self.step - place), colour));
            }
        }
        let length = self.axis_length();
        strokes.extend(AXES.map(|(_, axis, colour)| {
            let colour = seen(colour, on_light);
            let points = vec![(self.cross, colour), (self.cross + axis * length, colour)];
            Stroke { points, width: 2.5 }
        }));
        strokes
    }

    /// The axes' letters and where they belong.
    pub(crate) fn letters(&self, on_light: bool) -> [(&'static str, DVec3, [f32; 4]); 3] {
        let place = |axis: DVec3| self.cross + axis * (1.18 * self.axis_length());
        AXES.map(|(letter, axis, colour)| (letter, place(axis), seen(colour, on_light)))
    }

    fn axis_length(&self) -> f64 {
        1.5 * self.step
    }

    /// A line through the middle moved by `off`, within the circle of the floor.
    fn line(&self, along: DVec3, off: DVec3, [r, g, b]: [f32; 3]) -> Stroke {
        let half = (self.reach * self.reach - off.length_squared()).max(0.0).sqrt();
        let point = |i: u32| {
            let from_middle = off + along * (half * (2.0 * f64::from(i) / f64::from(PIECES) - 1.0));
            let share = (from_middle.length() / self.reach).min(1.0) as f32;
            (self.middle + from_middle, [r, g, b, COVER * (1.0 - share * share)])
        };
        Stroke { points: (0..=PIECES).map(point).collect(), width: 1.2 }
    }
}

/// A colour that is made for light grounds, lighter for dark ones.
fn seen([r, g, b, alpha]: [f32; 4], on_light: bool) -> [f32; 4] {
    let light = |c: f32| if on_light { c } else { c + (1.0 - c) * 0.12 };
    [light(r), light(g), light(b), alpha]
}

/// The nearest of 1, 2, 5 and 10 times a power of ten from below.
fn easily_said(length: f64) -> f64 {
    let power = libm::pow(10_f64, libm::log10(length).floor());
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * power <= length);
    digit.unwrap_or(1.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_easily_said() {
        for (length, step) in [(1.0, 1.0), (1.9, 1.0), (2.1, 2.0), (0.06, 0.05), (9e5, 5e5)] {
            assert!((easily_said(length) / step - 1.0).abs() < 1e-12, "{length}");
        }
    }

    #[test]
    fn the_grid_lies_at_the_lowest_point_on_whole_steps() {
        let floor = Floor::under(DVec3::new(-3.0, -2.0, 1.0), DVec3::new(9.0, 5.0, 4.0)).unwrap();
        assert_eq!(floor.step, 2.0);
        let strokes = floor.strokes(true);
        let (grid, axes) = strokes.split_at(strokes.len() - 3);
        assert!(grid.len() >= 10);
        for stroke in grid {
            let (first, last) = (stroke.points[0].0, stroke.points.last().unwrap().0);
            assert!(stroke.points.iter().all(|(p, _)| (p.y + 2.0).abs() < 1e-12));
            let whole = |x: f64| (x / 2.0 - (x / 2.0).round()).abs() < 1e-9;
            assert!((first.x == last.x && whole(first.x)) || (first.z == last.z && whole(first.z)));
        }
        assert_eq!(axes[0].points[0].0, DVec3::new(0.0, -2.0, 0.0));
        assert!(Floor::under(DVec3::ZERO, DVec3::ZERO).is_none());
        assert!(Floor::under(DVec3::INFINITY, DVec3::NEG_INFINITY).is_none());
    }
}

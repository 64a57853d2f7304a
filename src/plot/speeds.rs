//! Speed, acceleration, jerk and curvature over time.

use super::figure::{self, Axis, Entry, Figure, Layer, Panel, Sign};
use super::series;
use super::style::of_scheme;
use super::subject::{Subject, entries};
use super::{Asked, Error, Line, Show};
use crate::curve::Scheme;
use crate::moves::Mover;

/// So many times what nine tenths of a line stay below, and peaks beyond are cut: at a
/// cusp curvature has no end.
const CUT: f64 = 20.0;

/// A line over time by each method.
type Lines = Vec<(Option<Scheme>, Line)>;

/// What a quantity is called, and its unit, for turns and for paths.
struct Quantity {
    turning: Option<[&'static str; 2]>,
    moving: Option<[&'static str; 2]>,
    /// Its place among what [`series::rates`] and [`series::path_rates`] give.
    index: usize,
}

fn quantity(show: Show) -> Quantity {
    let (turning, moving, index) = match show {
        Show::Acceleration => {
            (Some(["angular acceleration", "°/s²"]), Some(["acceleration on the path", "units/s²"]), 1)
        }
        Show::Jerk => (Some(["angular jerk", "°/s³"]), None, 2),
        Show::Curvature => (None, Some(["curvature of the path", "1/units"]), 2),
        _ => (Some(["angular speed", "°/s"]), Some(["speed along the path", "units/s"]), 0),
    };
    Quantity { turning, moving, index }
}

/// A panel for the chosen rotation, and one for the path, as far as there are both.
pub(super) fn figure(subject: &Subject, asked: &Asked) -> Result<Figure, Error> {
    let Quantity { turning, moving, index } = quantity(asked.show);
    let has_turns = !subject.turning().is_empty();
    let path = subject.ground.course().filter(|_| asked.only.is_none());
    if moving.is_some() && turning.is_none() && path.is_none() {
        return Err(Error::NoPath(asked.show.name()));
    }
    let (mut panels, mut legend, mut title) = (Vec::new(), Vec::new(), subject.name.to_owned());
    let wants_turns = has_turns || moving.is_none() || path.is_none();
    if let Some([name, unit]) = turning.filter(|_| wants_turns) {
        let mover = subject.chosen(asked.only, asked.show.name())?;
        let lines = turning_lines(subject, mover, index);
        legend = entries(lines.iter().map(|(scheme, _)| scheme));
        let named = subject.named(mover);
        title = format!("{title}: {named}");
        panels.push(panel(subject, asked, [name, unit], lines, key_times(subject, mover)));
    }
    if let (Some([name, unit]), Some((path, start))) = (moving, path) {
        let rates = series::path_rates(path, start, subject.range());
        let keys = path.key_times().iter().map(|t| start + t).collect();
        panels.push(panel(subject, asked, [name, unit], vec![(None, rates[index].clone())], keys));
        legend.push(Entry { label: "path".to_owned(), sign: Sign::Line(of_scheme(None)) });
    }
    legend.push(Entry { label: "key times".to_owned(), sign: Sign::Mark });
    Ok(Figure::over_time(title, legend, panels))
}

fn turning_lines(subject: &Subject, mover: Mover, index: usize) -> Lines {
    let methods = subject.methods(mover);
    let line = |motion| series::motion_rates(motion, subject.range())[index].clone();
    methods.iter().map(|(scheme, motion)| (*scheme, line(motion))).collect()
}

fn key_times(subject: &Subject, mover: Mover) -> Vec<f64> {
    subject.methods(mover).first().map_or(Vec::new(), |(_, motion)| motion.times().to_vec())
}

fn panel(subject: &Subject, asked: &Asked, [name, unit]: [&str; 2], lines: Lines, keys: Vec<f64>) -> Panel {
    let clock = asked.clock;
    let values = || lines.iter().flat_map(|(_, line)| line.iter().flatten()).map(|point| point[1]);
    let (top, cut) = top(values().collect());
    let title = match cut {
        Some(largest) => format!("{name} (up to {largest:.3e}: peaks are cut)"),
        None => name.to_owned(),
    };
    let mut layers = vec![Layer::Marks(keys.into_iter().map(|t| clock.time(t)).collect())];
    let lines = lines.into_iter().map(|(scheme, line)| (clock.line(line), of_scheme(scheme)));
    layers.extend(figure::graphs(lines));
    let y = Axis::new(format!("{name} ({unit})"), figure::from_zero(top, 1.0));
    Panel { title, x: clock.axis(subject.range()), y, equal: false, layers }
}

/// How high the axis reaches, and the largest value where that lies far beyond.
fn top(mut values: Vec<f64>) -> (f64, Option<f64>) {
    values.sort_by(f64::total_cmp);
    let Some(&largest) = values.last() else { return (0.0, None) };
    let usual = values[(values.len() - 1) * 9 / 10] * CUT;
    if usual > 0.0 && largest > 5.0 * usual { (usual, Some(largest)) } else { (largest, None) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_peaks_far_beyond_the_rest_are_cut() {
        assert_eq!(top(vec![1.0, 2.0, 3.0]), (3.0, None));
        assert_eq!(top(vec![0.0; 4]), (0.0, None));
        let mut values = vec![1.0; 100];
        values[40] = 1e6;
        assert_eq!(top(values), (20.0, Some(1e6)));
        assert_eq!(top(Vec::new()), (0.0, None));
    }
}

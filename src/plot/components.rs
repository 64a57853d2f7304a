//! Quaternions' parts and a path's places over time, as the columns of the input's rows.

use super::figure::{self, Axis, Dot, Entry, Figure, Layer, Panel, Sign};
use super::series;
use super::style::of_scheme;
use super::subject::{Method, Subject, entries, label};
use super::{Asked, Clock, Error, Line, Point};
use crate::curve::Scheme;
use crate::moves::{Mover, Orient};

/// How many panels of components a page has room for.
const MOST: usize = 64;

/// A number of a row, but for its time.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// Part of a rotation, in the order of rows.
    Part(Mover, usize),
    /// x, y or z of a place.
    Place(usize),
}

impl Subject<'_> {
    fn columns(&self) -> Vec<Column> {
        let parts = |mover: Mover| (0..4).map(move |part| Column::Part(mover, part));
        if let Some(clip) = self.clip() {
            return (0..clip.tracks.len()).flat_map(|track| parts(Mover::Track(track))).collect();
        }
        let turned = (self.ground.orient() == Orient::Keyed).then(|| parts(Mover::Root));
        (0..3).map(Column::Place).chain(turned.into_iter().flatten()).collect()
    }

    /// The columns of some numbers, counted from 1; without any those of the chosen box,
    /// or of the path.
    fn asked(&self, asked: &Asked) -> Result<Vec<(usize, Column)>, Error> {
        let columns = self.columns();
        let number = |&found: &usize| {
            let column = found.checked_sub(1).and_then(|i| columns.get(i));
            column.map(|&column| (found, column)).ok_or(Error::Component { last: columns.len(), found })
        };
        if !asked.components.is_empty() {
            return asked.components.iter().map(number).collect();
        }
        let places = asked.only.is_none() && self.clip().is_none();
        let mover = if places { None } else { Some(self.chosen(asked.only, "components --box")?) };
        let fits = |(_, column): &(usize, Column)| match column {
            Column::Part(other, _) => Some(*other) == mover,
            Column::Place(_) => places,
        };
        Ok((1..).zip(columns.iter().copied()).filter(fits).collect())
    }

    fn column_name(&self, column: Column) -> String {
        match column {
            Column::Place(axis) => ["x", "y", "z"][axis].to_owned(),
            Column::Part(mover, part) => {
                format!("{}, {}", self.named(mover), &self.order.name()[part..=part])
            }
        }
    }
}

/// The numbers of a column by every method, and its keys.
struct Drawn {
    lines: Vec<(Option<Scheme>, Line)>,
    keys: Vec<Point>,
    unit: &'static str,
}

impl Drawn {
    fn range(&self) -> [f64; 2] {
        let lines = self.lines.iter().flat_map(|(_, line)| line.iter().flatten());
        let values = lines.chain(&self.keys).map(|point| point[1]);
        figure::with_room(figure::extent(values).unwrap_or([0.0, 1.0]), 0.2)
    }
}

/// The four numbers of a rotation by each method.
type PartLines = Vec<(Option<Scheme>, [Line; 4])>;

/// Everything of the columns that are asked for, each mover's lines worked out once.
fn drawn(subject: &Subject, columns: &[(usize, Column)], clock: Clock) -> Vec<Drawn> {
    let mut of_movers: Vec<(Mover, PartLines)> = Vec::new();
    let mut places: Option<[Line; 3]> = None;
    columns
        .iter()
        .map(|&(_, column)| match column {
            Column::Place(axis) => {
                let lines = places.get_or_insert_with(|| place_lines(subject));
                let keys = place_keys(subject, axis, clock);
                let line = clock.line(lines[axis].clone());
                Drawn { lines: vec![(None, line)], keys, unit: " (units)" }
            }
            Column::Part(mover, part) => {
                if !of_movers.iter().any(|(other, _)| *other == mover) {
                    of_movers.push((mover, part_lines(subject, mover)));
                }
                let of_mover = of_movers.iter().find(|(other, _)| *other == mover);
                let methods = of_mover.map_or([].as_slice(), |(_, methods)| methods);
                let line = |(scheme, lines): &(Option<Scheme>, [Line; 4])| {
                    (*scheme, clock.line(lines[part].clone()))
                };
                let keys = part_keys(subject, mover, part, clock);
                Drawn { lines: methods.iter().map(line).collect(), keys, unit: "" }
            }
        })
        .collect()
}

fn part_lines(subject: &Subject, mover: Mover) -> PartLines {
    let range = subject.range();
    let lines =
        |(scheme, motion): &Method| (*scheme, series::components(motion, range, |q| subject.parts(q)));
    subject.methods(mover).iter().map(lines).collect()
}

fn part_keys(subject: &Subject, mover: Mover, part: usize, clock: Clock) -> Vec<Point> {
    let methods = subject.methods(mover);
    let times = methods.first().map_or([].as_slice(), |(_, motion)| motion.times());
    let keys = subject.keys(mover);
    times.iter().zip(keys).map(|(&t, key)| [clock.time(t), subject.parts(key)[part]]).collect()
}

fn place_lines(subject: &Subject) -> [Line; 3] {
    let frame = subject.frame;
    let lines = subject.ground.course().map(|(path, start)| {
        series::places(path, start, subject.range(), |place| frame.vector_from_gltf(place).to_array())
    });
    lines.unwrap_or_default()
}

fn place_keys(subject: &Subject, axis: usize, clock: Clock) -> Vec<Point> {
    let Some((path, start)) = subject.ground.course() else { return Vec::new() };
    let place = |place| subject.frame.vector_from_gltf(place).to_array()[axis];
    let keys = path.key_times().iter().zip(path.key_points());
    keys.map(|(t, &point)| [clock.time(start + t), place(point)]).collect()
}

/// A panel a column, each with all methods.
pub(super) fn figure(subject: &Subject, asked: &Asked) -> Result<Figure, Error> {
    let columns = subject.asked(asked)?;
    if columns.len() > MOST {
        return Err(Error::TooMany { found: columns.len(), most: MOST, by: "--component" });
    }
    let drawn = drawn(subject, &columns, asked.clock);
    let panels = columns.iter().zip(&drawn).map(|(&(number, column), drawn)| {
        let title = format!("component {number}: {}", subject.column_name(column));
        panel(subject, asked.clock, title, column, drawn, |_| true, drawn.range())
    });
    let panels = panels.collect();
    Ok(Figure::over_time(title(subject, &columns), legend(subject, &drawn), panels))
}

fn title(subject: &Subject, columns: &[(usize, Column)]) -> String {
    let movers: Vec<Mover> = columns
        .iter()
        .filter_map(|(_, column)| match column {
            Column::Part(mover, _) => Some(*mover),
            Column::Place(_) => None,
        })
        .collect();
    match movers.first() {
        Some(mover) if movers.len() == columns.len() && movers.iter().all(|other| other == mover) => {
            format!("{}: {}", subject.name, subject.named(*mover))
        }
        _ => subject.name.to_owned(),
    }
}

fn legend(subject: &Subject, drawn: &[Drawn]) -> Vec<Entry> {
    let mut schemes: Vec<Option<Scheme>> = Vec::new();
    for (scheme, _) in drawn.iter().flat_map(|drawn| &drawn.lines) {
        if !schemes.contains(scheme) {
            schemes.push(*scheme);
        }
    }
    let path = subject.clip().is_none();
    let mut entries = entries(schemes.iter());
    for entry in entries.iter_mut().zip(&schemes).filter(|(_, scheme)| path && scheme.is_none()) {
        entry.0.label = "path".to_owned();
    }
    let keys = if path { "key points" } else { "keys" };
    entries.push(Entry { label: keys.to_owned(), sign: Sign::Dot(Dot::Key) });
    entries
}

fn panel(
    subject: &Subject,
    clock: Clock,
    title: String,
    column: Column,
    drawn: &Drawn,
    shown: impl Fn(Option<Scheme>) -> bool,
    range: [f64; 2],
) -> Panel {
    let lines = drawn.lines.iter().filter(|(scheme, _)| shown(*scheme));
    let lines = lines.map(|(scheme, line)| (line.clone(), of_scheme(*scheme)));
    let mut layers: Vec<Layer> = figure::graphs(lines).collect();
    layers.push(Layer::Dots(drawn.keys.clone(), Dot::Key));
    let name = match column {
        Column::Place(axis) => ["x", "y", "z"][axis],
        Column::Part(_, part) => &subject.order.name()[part..=part],
    };
    let y = Axis::new(format!("{name}{}", drawn.unit), range);
    Panel { title, x: clock.axis(subject.range()), y, equal: false, layers }
}

/// So many figures fit side by side.
const WIDE: usize = 4;

/// The numbers that a course on curves looks at, where a row has them: else its second and
/// its last.
const COURSE: [usize; 2] = [2, 16];

/// Figures of several inputs on one page: a row for each of the inputs and of its
/// components, with a panel for each scheme alone, and one for all of them together. With
/// two inputs, two components and three schemes these are sixteen. Without `components`
/// the 2nd and the 16th number of rows, or the last one.
pub fn all_figures(subjects: &[Subject], components: &[usize], clock: Clock) -> Result<Figure, Error> {
    let (mut rows, mut legends) = (Vec::<Vec<Panel>>::new(), Vec::<Entry>::new());
    for subject in subjects {
        let last = subject.columns().len();
        let usual = COURSE.map(|number| number.min(last)).to_vec();
        let components = if components.is_empty() { usual } else { components.to_vec() };
        let asked = Asked { components, clock, ..Asked::default() };
        let numbers = subject.asked(&asked)?;
        let drawn = drawn(subject, &numbers, clock);
        for (&(number, column), drawn) in numbers.iter().zip(&drawn) {
            let one = |shown: Option<Option<Scheme>>, what: &str| {
                let shown = |scheme| shown.is_none_or(|shown| shown == scheme);
                let title = format!("{}: {what}", subject.name);
                let mut panel = panel(subject, clock, title, column, drawn, shown, drawn.range());
                let name = format!("component {number} ({}){}", subject.column_name(column), drawn.unit);
                panel.y.label = Some(name);
                panel
            };
            let schemes = drawn.lines.iter().map(|(scheme, _)| *scheme);
            let mut row: Vec<Panel> = schemes.map(|scheme| one(Some(scheme), &label(scheme))).collect();
            row.extend((row.len() > 1).then(|| one(None, "all")));
            rows.push(row);
        }
        legends.extend(legend(subject, &drawn));
    }
    let found = rows.iter().map(Vec::len).sum();
    if found > MOST {
        return Err(Error::TooMany { found, most: MOST, by: "--component or --scheme" });
    }
    let (panels, columns) = arranged(rows);
    // The keys once, and last.
    let mut legend: Vec<Entry> = Vec::new();
    let (dots, lines): (Vec<_>, Vec<_>) = legends.into_iter().partition(|e| matches!(e.sign, Sign::Dot(_)));
    for entry in lines.into_iter().chain(dots) {
        if !legend.contains(&entry) {
            legend.push(entry);
        }
    }
    let names: Vec<&str> = subjects.iter().map(|subject| subject.name).collect();
    let mut figure = Figure::over_time(names.join(" and "), legend, panels);
    (figure.columns, figure.cell) = (columns, [500.0, 310.0]);
    Ok(figure)
}

/// Rows of panels as they stand on the page, and how many stand side by side: what is too
/// wide is turned, so that rows become columns.
fn arranged(rows: Vec<Vec<Panel>>) -> (Vec<Panel>, usize) {
    let (count, wide) = (rows.len(), rows.iter().map(Vec::len).max().unwrap_or(1));
    let full = rows.iter().all(|row| row.len() == wide);
    if wide <= WIDE || count >= wide || !full {
        return (rows.into_iter().flatten().collect(), wide);
    }
    let at = |i: usize| rows[i % count][i / count].clone();
    ((0..count * wide).map(at).collect(), count)
}

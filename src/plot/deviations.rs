//! How far a file's playback is off its curve over time.

use super::figure::{self, Axis, Entry, Figure, Layer, Panel, Sign};
use super::style::{LIMIT, of_scheme};
use super::subject::label;
use super::thin::Thinner;
use super::{Clock, Stroke};
use crate::asset::Asset;
use crate::check::motion::{self, Given, Limit, Watched};
use crate::curve::Scheme;
use crate::moves::{Inputs, Mover};

/// In how many columns lines are kept.
const COLUMNS: usize = 4096;

/// Deviations rise and fall between every two keys of the file: lines are thin.
const THIN: f64 = 1.2;

/// What is known of one node in one clip.
struct Series {
    watched: Watched,
    thinner: Thinner,
    largest: f64,
}

/// How a figure of deviations is to be.
#[derive(Clone, Debug, Default)]
pub struct AskedOfFile<'a> {
    /// The file's name.
    pub name: &'a str,
    /// What the file does not say of itself.
    pub given: Given,
    /// One thing that moves, or all.
    pub only: Option<Mover>,
    /// The clips of these schemes alone; of all where empty.
    pub schemes: &'a [Scheme],
    /// A limit to draw, degrees or units; without it what the file says of itself.
    pub tolerance: Option<f64>,
    /// What the time axis counts.
    pub clock: Clock,
}

/// A panel for each node, with a line for each clip and one for its limit. Fails where the
/// file cannot be read, or does not follow the inputs.
pub fn deviations(asset: &mut Asset, inputs: &Inputs, wanted: &AskedOfFile) -> Result<Figure, motion::Error> {
    let mut found: Vec<Series> = Vec::new();
    let mut note = |watched: &Watched, time: f64, off: f64| {
        if found.last().is_none_or(|series| series.watched.index != watched.index) {
            let thinner = Thinner::new([0.0, watched.duration], COLUMNS);
            found.push(Series { watched: watched.clone(), thinner, largest: 0.0 });
        }
        if let Some(series) = found.last_mut() {
            series.thinner.push([time, off]);
            series.largest = series.largest.max(off);
        }
    };
    motion::over_time(asset, inputs, wanted.given, wanted.only, &mut note)?;
    let asked = |series: &Series| {
        wanted.schemes.is_empty()
            || wanted.schemes.iter().any(|scheme| scheme.name() == series.watched.scheme)
    };
    found.retain(asked);
    Ok(drawn(found, wanted))
}

fn drawn(found: Vec<Series>, wanted: &AskedOfFile) -> Figure {
    let duration = found.iter().map(|series| series.watched.duration).fold(0.0, f64::max);
    let mut legend: Vec<Entry> = Vec::new();
    // Node by node, those that are turned before what is moved.
    let mut nodes: Vec<(String, bool, Vec<Series>)> = Vec::new();
    for series in found {
        let scheme = Scheme::from_name(series.watched.scheme);
        let entry = Entry { label: label(scheme), sign: Sign::Line(of_scheme(scheme)) };
        if !legend.contains(&entry) {
            legend.push(entry);
        }
        let (node, travels) = (series.watched.node.clone(), series.watched.travels);
        match nodes.iter_mut().find(|other| other.0 == node && other.1 == travels) {
            Some(of_node) => of_node.2.push(series),
            None => nodes.push((node, travels, vec![series])),
        }
    }
    let mut limits: Vec<&'static str> = Vec::new();
    let panels = nodes.into_iter().map(|(node, travels, series)| {
        let (panel, what) = panel(&node, travels, series, duration, wanted);
        limits.extend(what.filter(|what| !limits.contains(what)));
        panel
    });
    let panels: Vec<Panel> = panels.collect();
    legend.extend(limits.iter().map(|what| Entry { label: (*what).to_owned(), sign: Sign::Line(LIMIT) }));
    legend.push(Entry { label: "key times".to_owned(), sign: Sign::Mark });
    let mut figure = Figure::over_time(format!("{}: playback error", wanted.name), legend, panels);
    if figure.panels.len() == 4 {
        (figure.columns, figure.cell) = (1, [1000.0, 250.0]);
    }
    figure
}

fn panel(
    node: &str,
    travels: bool,
    series: Vec<Series>,
    duration: f64,
    wanted: &AskedOfFile,
) -> (Panel, Option<&'static str>) {
    let unit = if travels { "units" } else { "°" };
    let largest = series.iter().map(|series| series.largest).fold(0.0, f64::max);
    let stated = series.iter().filter_map(|series| series.watched.limit);
    let limits: Vec<(f64, &str)> = match wanted.tolerance {
        Some(tolerance) => vec![(tolerance, "tolerance")],
        None => stated.map(limit).collect(),
    };
    let keys = series.first().map_or(Vec::new(), |series| series.watched.keys.clone());
    let mut layers = vec![Layer::Marks(keys.into_iter().map(|t| wanted.clock.time(t)).collect())];
    let lines = series.into_iter().map(|series| {
        let stroke = of_scheme(Scheme::from_name(series.watched.scheme));
        (wanted.clock.line(series.thinner.finish()), Stroke { width: THIN, ..stroke })
    });
    layers.extend(figure::graphs(lines));
    let mut drawn: Vec<f64> = Vec::new();
    for &(at, _) in &limits {
        if !drawn.contains(&at) {
            drawn.push(at);
            layers.push(Layer::Level(at, LIMIT));
        }
    }
    let top = drawn.iter().copied().fold(largest, f64::max);
    let title = format!("{node}: {}", if travels { "position" } else { "rotation" });
    let y = Axis::new(format!("deviation ({unit})"), figure::from_zero(top, 1e-6));
    let panel = Panel { title, x: wanted.clock.axis([0.0, duration]), y, equal: false, layers };
    (panel, limits.first().map(|(_, what)| *what))
}

fn limit(limit: Limit) -> (f64, &'static str) {
    match limit {
        Limit::Tolerance(at) => (at, "tolerance"),
        Limit::Bound(at) => (at, "stated bound"),
    }
}

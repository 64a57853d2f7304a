//! Plots of curves: what moves becomes a [`Figure`] (plain data), that an SVG, and that a
//! PNG.
//!
//! What each shows and how exact it is: docs/plots.md.

mod components;
mod deviations;
mod error;
mod figure;
mod layout;
mod paint;
#[cfg(feature = "plot-png")]
mod png;
mod series;
mod show;
mod speeds;
mod sphere;
mod style;
mod subject;
mod svg;
mod thin;
mod ticks;
mod views;

pub use components::all_figures;
pub use deviations::{AskedOfFile, deviations};
pub use error::Error;
pub use figure::{Axis, Dot, Entry, Figure, Layer, Panel, Sign};
#[cfg(feature = "plot-png")]
pub use png::png;
pub use show::Show;
pub use style::{Ink, Rgb, Stroke, Theme};
pub use subject::{Clock, Subject};
pub use svg::svg;
pub use thin::{Line, Point};

/// The largest width and height of a plot, pixels.
pub const MOST_PIXELS: u32 = 16384;

/// What of a subject is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// What is shown.
    pub show: Show,
    /// Which numbers of the input's rows, from 1; empty for all of one box.
    pub components: Vec<usize>,
    /// Which box, from 1; none for what a figure shows of its own.
    pub only: Option<usize>,
    /// What the time axis counts.
    pub clock: Clock,
}

/// The figure of a subject.
pub fn figure(subject: &Subject, asked: &Asked) -> Result<Figure, Error> {
    match asked.show {
        Show::Components => components::figure(subject, asked),
        Show::Speed | Show::Acceleration | Show::Jerk | Show::Curvature => speeds::figure(subject, asked),
        Show::Path => views::figure(subject),
        Show::Sphere => sphere::figure(subject, asked),
        Show::Error => Err(Error::NoFile),
    }
}

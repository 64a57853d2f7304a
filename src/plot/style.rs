//! Colours and dashes.
//!
//! Series take the colours of Okabe and Ito (Color Universal Design, 2008), which people
//! who see few colours can tell apart; each scheme has its own colour and its own dashes,
//! the same in every figure.

use crate::curve::Scheme;
use crate::write::helix;

/// A colour of the screen: red, green, blue.
pub type Rgb = [u8; 3];

/// What a line or a word is coloured by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ink {
    /// As words are.
    Words,
    /// Less than words.
    Quiet,
    /// As the grid.
    Grid,
    /// One of the colours of series.
    Series(usize),
    /// When, as a share of the whole from 0 to 1.
    Time(f64),
    /// A limit.
    Limit,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub ink: Ink,
    /// Lengths of dashes and of gaps, pixels; empty for a solid line.
    pub dashes: &'static str,
    /// Pixels.
    pub width: f64,
    /// Nearly as the background.
    pub faint: bool,
}

impl Stroke {
    /// A solid line.
    pub const fn solid(ink: Ink, width: f64) -> Stroke {
        Stroke { ink, dashes: "", width, faint: false }
    }

    /// The same, faint.
    pub const fn faint(self) -> Stroke {
        Stroke { faint: true, ..self }
    }

    /// The same, dashed.
    pub const fn dashed(self, dashes: &'static str) -> Stroke {
        Stroke { dashes, ..self }
    }
}

/// How thick the lines of series are, pixels.
const LINE: f64 = 2.0;

/// Colours and dashes of schemes, in the order of [`Scheme::EVERY`], and then of what has
/// no scheme.
const SERIES: [(usize, &str); 12] = [
    (0, ""),
    (1, "2 3"),
    (5, "9 4"),
    (3, "10 3 2 3"),
    (4, ""),
    (6, "6 3"),
    (2, "12 3 3 3 3 3"),
    (6, "14 4"),
    (1, "16 3 4 3"),
    (2, "3 4"),
    (0, "5 5"),
    (5, ""),
];

/// How a scheme's line is drawn.
pub(super) fn of_scheme(scheme: Option<Scheme>) -> Stroke {
    let index = Scheme::EVERY.iter().position(|&other| Some(other) == scheme);
    let (colour, dashes) = SERIES[index.unwrap_or(SERIES.len() - 1)];
    Stroke::solid(Ink::Series(colour), LINE).dashed(dashes)
}

/// How the line of a tolerance is drawn.
pub(super) const LIMIT: Stroke = Stroke::solid(Ink::Limit, 1.5).dashed("7 4");

/// Dark on light, or light on dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Dark on white.
    #[default]
    Light,
    /// Light on a dark grey.
    Dark,
}

impl Theme {
    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Theme::Light => "light",
            Theme::Dark => "dark",
        }
    }

    /// The theme of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Theme> {
        [Theme::Light, Theme::Dark].into_iter().find(|theme| theme.name() == name)
    }

    /// What is behind all.
    pub fn background(self) -> Rgb {
        match self {
            Theme::Light => [255, 255, 255],
            Theme::Dark => [24, 26, 31],
        }
    }

    /// The colour of an ink.
    pub fn colour(self, ink: Ink) -> Rgb {
        let light = self == Theme::Light;
        match ink {
            Ink::Words if light => [32, 33, 36],
            Ink::Words => [232, 234, 237],
            Ink::Quiet if light => [110, 112, 117],
            Ink::Quiet => [150, 154, 161],
            Ink::Grid if light => [222, 224, 228],
            Ink::Grid => [58, 62, 70],
            Ink::Series(i) => self.series()[i % 7],
            Ink::Time(share) => helix(share),
            Ink::Limit if light => [160, 20, 60],
            Ink::Limit => [255, 120, 150],
        }
    }

    /// The colour of a line: a faint one is three quarters background.
    pub fn stroke(self, stroke: &Stroke) -> Rgb {
        let (colour, ground) = (self.colour(stroke.ink), self.background());
        if !stroke.faint {
            return colour;
        }
        std::array::from_fn(|i| ((u16::from(colour[i]) + 3 * u16::from(ground[i])) / 4) as u8)
    }

    /// Okabe and Ito's colours: yellow is too pale for white, and blue too dark for dark
    /// grey, where yellow stands for it.
    fn series(self) -> [Rgb; 7] {
        let [orange, sky, green, blue] = [[230, 159, 0], [86, 180, 233], [0, 158, 115], [0, 114, 178]];
        let [vermilion, purple, yellow] = [[213, 94, 0], [204, 121, 167], [240, 228, 66]];
        match self {
            Theme::Light => [[70, 70, 74], orange, sky, green, blue, vermilion, purple],
            Theme::Dark => [[225, 227, 230], orange, sky, [0, 178, 130], yellow, [240, 112, 30], purple],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast as WCAG 2.1 has it.
    fn contrast(a: Rgb, b: Rgb) -> f64 {
        let luminance = |c: Rgb| {
            let linear = |x: u8| {
                let x = f64::from(x) / 255.0;
                if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2])
        };
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    #[test]
    fn words_and_lines_stand_out() {
        for theme in [Theme::Light, Theme::Dark] {
            let against = |ink| contrast(theme.colour(ink), theme.background());
            assert!(against(Ink::Words) > 12.0 && against(Ink::Quiet) > 4.5 && against(Ink::Limit) > 4.5);
            for i in 0..7 {
                assert!(against(Ink::Series(i)) > 2.2, "{theme:?} {i}: {}", against(Ink::Series(i)));
            }
        }
    }

    #[test]
    fn every_scheme_has_a_look_of_its_own() {
        assert_eq!(SERIES.len(), Scheme::EVERY.len() + 1);
        let looks: Vec<Stroke> = Scheme::EVERY.iter().map(|&scheme| of_scheme(Some(scheme))).collect();
        for (i, look) in looks.iter().enumerate() {
            assert!(!looks[..i].contains(look), "{look:?}");
        }
    }
}

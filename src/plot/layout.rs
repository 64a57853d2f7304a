//! Where on the page what stands.

use super::Error;
use super::figure::{Entry, Figure, Sign};

/// Letters of the title, of the legend, of panels' titles, of axes' names and of ticks, pixels.
pub(super) const TITLE: u32 = 21;
pub(super) const LEGEND: u32 = 16;
pub(super) const HEADING: u32 = 17;
pub(super) const LABEL: u32 = 16;
pub(super) const TICK: u32 = 15;

/// Room at the page's edges.
pub(super) const EDGE: f64 = 16.0;

/// The sign of an entry of the legend, a line or a dot, and the room from there to its words.
const LINE_SIGN: f64 = 40.0;
const DOT_SIGN: f64 = 12.0;
pub(super) const SIGN_GAP: f64 = 8.0;
const ENTRY_GAP: f64 = 26.0;
const ROW: f64 = 25.0;

/// The strip of colours that run with time.
pub(super) const RAMP: f64 = 150.0;

/// The least width and height of a panel's place.
const LEAST: [f64; 2] = [260.0, 190.0];

/// A rectangle: its left upper corner, its width and its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

/// A page divided up.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Page {
    pub(super) width: f64,
    pub(super) height: f64,
    /// Where each entry of the legend begins, at the height of its middle.
    pub(super) entries: Vec<[f64; 2]>,
    /// The same of the strip of colours.
    pub(super) ramp: Option<[f64; 2]>,
    pub(super) cells: Vec<Area>,
}

/// About how wide words are in DejaVu Sans, pixels; never less than they are.
pub(super) fn width(text: &str, size: u32) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | 'I' | ' ' | 'f' | 't' | '-' | '(' | ')'
        | 'r' => 0.43,
        'm' | 'w' | 'M' | 'W' | '%' | '@' | '—' | '…' => 1.01,
        'A'..='Z' | '+' | '−' | '=' | '<' | '>' | '~' | '&' | '#' => 0.86,
        c if c.is_ascii() => 0.66,
        _ => 1.02,
    };
    text.chars().map(em).sum::<f64>() * f64::from(size)
}

/// Words in as few pixels as there are: smaller, and if that is not enough, cut.
pub(super) fn fitted(text: &str, size: u32, room: f64) -> (String, u32) {
    let least = size.min(12);
    if let Some(size) = (least..=size).rev().find(|&size| width(text, size) <= room) {
        return (text.to_owned(), size);
    }
    // The end says which box or scheme; the middle of a long name says least.
    let chars: Vec<char> = text.chars().collect();
    for kept in (1..chars.len()).rev() {
        let (head, tail) = (kept / 3, kept - kept / 3);
        let cut: String = chars[..head].iter().chain(&['…']).chain(&chars[chars.len() - tail..]).collect();
        if width(&cut, least) <= room {
            return (cut, least);
        }
    }
    (String::new(), least)
}

/// Divides a page up: as large as was asked, or as its panels like to be.
pub(super) fn page(figure: &Figure, size: Option<(u32, u32)>) -> Result<Page, Error> {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let rows = figure.panels.len().div_ceil(columns).max(1);
    let [cell_width, cell_height] = figure.cell;
    let page_width = size.map_or(2.0 * EDGE + columns as f64 * cell_width, |size| f64::from(size.0)).ceil();
    let (entries, ramp, header) = legend(figure, page_width);
    let page_height = size.map_or(header + EDGE + rows as f64 * cell_height, |size| f64::from(size.1)).ceil();
    let room = [page_width - 2.0 * EDGE, page_height - header - EDGE];
    let widths = shared(&figure.shares[0], columns, room[0]);
    let heights = shared(&figure.shares[1], rows, room[1]);
    let cells = (0..figure.panels.len()).map(|i| {
        let (column, row) = (i % columns, i / columns);
        let (x, y) = (widths[..column].iter().sum::<f64>(), heights[..row].iter().sum::<f64>());
        Area { x: EDGE + x, y: header + y, width: widths[column], height: heights[row] }
    });
    let cells: Vec<Area> = cells.collect();
    if let Some(found) = size
        && cells.iter().any(|cell| cell.width < LEAST[0] || cell.height < LEAST[1])
    {
        return Err(too_small(figure, found, [columns, rows], header));
    }
    Ok(Page { width: page_width, height: page_height, entries, ramp, cells })
}

fn too_small(figure: &Figure, found: (u32, u32), [columns, rows]: [usize; 2], header: f64) -> Error {
    let least = |shares: &[f64], n: usize, least: f64| {
        let smallest = shared(shares, n, 1.0).into_iter().fold(1.0, f64::min);
        least / smallest
    };
    let width = 2.0 * EDGE + least(&figure.shares[0], columns, LEAST[0]);
    let header = legend(figure, width).2.max(header);
    let height = header + EDGE + least(&figure.shares[1], rows, LEAST[1]);
    let up = |x: f64| (x.ceil() as u32).next_multiple_of(10);
    Error::TooSmall { width: up(width), height: up(height), panels: figure.panels.len(), found }
}

/// A length in shares; even ones where none are given.
fn shared(shares: &[f64], count: usize, length: f64) -> Vec<f64> {
    let shares = if shares.len() == count { shares.to_vec() } else { vec![1.0; count] };
    let whole: f64 = shares.iter().sum();
    shares.into_iter().map(|share| length * share / whole).collect()
}

/// How wide the sign of an entry is.
pub(super) fn sign(entry: &Entry) -> f64 {
    if matches!(entry.sign, Sign::Line(_)) { LINE_SIGN } else { DOT_SIGN }
}

/// Where entries of the legend stand, where the strip of colours does, and where panels
/// begin below them.
fn legend(figure: &Figure, page_width: f64) -> (Vec<[f64; 2]>, Option<[f64; 2]>, f64) {
    let label = |entry: &Entry| sign(entry) + SIGN_GAP + width(&entry.label, LEGEND);
    let ramp = figure
        .ramp
        .as_ref()
        .map(|[from, to]| RAMP + 2.0 * SIGN_GAP + width(from, LEGEND) + width(to, LEGEND));
    let (mut x, mut y) = (EDGE, EDGE + f64::from(TITLE) + 22.0);
    let mut places = Vec::new();
    for wide in figure.legend.iter().map(label).chain(ramp) {
        if x > EDGE && x + wide > page_width - EDGE {
            (x, y) = (EDGE, y + ROW);
        }
        places.push([x, y]);
        x += wide + ENTRY_GAP;
    }
    let bottom = if places.is_empty() { EDGE + f64::from(TITLE) } else { y + 0.5 * ROW };
    let strip = ramp.and_then(|_| places.pop());
    (places, strip, bottom + 8.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_too_long_lose_their_middle() {
        let (text, size) = fitted("a-very-long-name-of-a-file-that-nobody-wants.dat: box 3", 20, 200.0);
        assert!(text.contains('…') && text.ends_with("box 3") && size == 12, "{text}");
        assert!(width(&text, size) <= 200.0);
        assert_eq!(fitted("box 1", 20, 200.0), ("box 1".to_owned(), 20));
    }

    #[test]
    fn legends_run_over_into_rows() {
        let entry = |i: usize| Entry { label: format!("scheme {i}"), sign: super::super::Sign::Mark };
        let legend = (0..12).map(entry).collect();
        let panel = super::super::Panel {
            title: String::new(),
            x: super::super::Axis::bare([0.0, 1.0]),
            y: super::super::Axis::bare([0.0, 1.0]),
            equal: false,
            layers: Vec::new(),
        };
        let figure = Figure::over_time("t".into(), legend, vec![panel]);
        let wide = page(&figure, None).unwrap();
        let narrow = page(&figure, Some((300, 600))).unwrap();
        let bottom = |page: &Page| page.entries.iter().map(|e| e[1]).fold(0.0, f64::max);
        assert!(bottom(&narrow) > bottom(&wide));
        assert!(narrow.cells[0].y > bottom(&narrow));
        assert!(matches!(page(&figure, Some((100, 600))), Err(Error::TooSmall { .. })));
        let Err(Error::TooSmall { width, height, .. }) = page(&figure, Some((100, 100))) else { panic!() };
        assert!(page(&figure, Some((width, height))).is_ok(), "{width} {height}");
    }
}

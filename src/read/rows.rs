//! Rows of numbers: a time and a quaternion for each box.

use super::Order;
use super::blocks::{Block, Blocks, lines};
use super::oddities::Oddities;
use super::refusal::Problem;
use super::words::{not_utf8, number, skip_space, words};
use crate::math::Quat;
use rayon::prelude::*;
use std::io::{self, Read};

/// What every row must look like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) boxes: usize,
    pub(super) order: Order,
}

impl Form {
    /// Numbers in a row.
    pub(super) fn numbers(self) -> usize {
        1 + 4 * self.boxes
    }
}

/// The rows of some lines, up to the first that is wrong.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) times: Vec<f64>,
    /// Unit quaternions, row by row; signs as in the file.
    pub(super) keys: Vec<Quat>,
    /// Where each row's line begins in the text, and the how-manieth line it is.
    pub(super) places: Vec<(usize, usize)>,
    pub(super) oddities: Oddities,
    pub(super) wrong: Option<Wrong>,
    /// How many lines the text has.
    lines: usize,
}

/// A row that is refused.
#[derive(Debug)]
pub(super) struct Wrong {
    /// Where its line begins in the text.
    pub(super) line_start: usize,
    /// The how-manieth line it is, from 0.
    pub(super) line: usize,
    /// The place of the problem within the line.
    pub(super) offset: usize,
    pub(super) problem: Problem,
    /// The row has the wrong count of numbers.
    pub(super) miscounted: bool,
}

/// How much text one task parses.
const TASK: usize = 128 << 10;

/// The rows of a text, its parts parsed in parallel; `first_line` numbers the first line
/// for what is noted along the way.
pub(super) fn parse(text: &[u8], first_line: usize, form: Form) -> Vec<(usize, Rows)> {
    let parts = parts(text);
    let mut parsed: Vec<(usize, Rows)> =
        parts.into_par_iter().map(|from| (from.start, parse_part(&text[from], form))).collect();
    let mut line = first_line;
    for (start, rows) in &mut parsed {
        let counted = rows.lines;
        rows.shift(*start, line - first_line);
        rows.oddities.shift(line);
        line += counted;
    }
    parsed
}

/// The text cut into parts of about [`TASK`] bytes at ends of lines.
fn parts(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut parts = Vec::new();
    let mut from = 0;
    while from < text.len() {
        let about = (from + TASK).min(text.len());
        let end = memchr::memchr(b'\n', &text[about..]).map_or(text.len(), |n| about + n + 1);
        parts.push(from..end);
        from = end;
    }
    parts
}

fn parse_part(text: &[u8], form: Form) -> Rows {
    let mut rows = Rows::default();
    let first = memchr::memchr(b'\n', text).map_or(text.len(), |end| end + 1);
    rows.reserve(text.len() / first.max(1) + 1, form);
    for (number, (start, line)) in lines(text).enumerate() {
        rows.lines = number + 1;
        if let Err((offset, problem, miscounted)) = rows.take(line, (start, number), form) {
            rows.wrong = Some(Wrong { line_start: start, line: number, offset, problem, miscounted });
            break;
        }
    }
    rows
}

type Refused = (usize, Problem, bool);

impl Rows {
    /// Makes room for rows of about the same length.
    fn reserve(&mut self, rows: usize, form: Form) {
        // The first line may be short for another reason: no row is shorter than its numbers.
        let rows = rows.min(TASK / form.numbers());
        self.times.reserve(rows);
        self.places.reserve(rows);
        self.keys.reserve(rows * form.boxes);
    }

    fn shift(&mut self, bytes: usize, lines: usize) {
        for place in &mut self.places {
            *place = (place.0 + bytes, place.1 + lines);
        }
        if let Some(wrong) = &mut self.wrong {
            wrong.line_start += bytes;
            wrong.line += lines;
        }
    }

    /// Takes one line: a row, a comment, or nothing.
    fn take(&mut self, line: &[u8], place: (usize, usize), form: Form) -> Result<(), Refused> {
        let start = skip_space(line, 0);
        match line.get(start) {
            None => return Ok(()),
            Some(b'#') => return check_utf8(line).map_err(|(offset, problem)| (offset, problem, false)),
            Some(_) => {}
        }
        let refuse = |offset| move |problem| (offset, problem, false);
        let (time, mut at) = number(line, start).map_err(refuse(start))?;
        for index in 0..form.boxes {
            let mut parts = [0.0; 4];
            let mut first = at;
            for (i, part) in parts.iter_mut().enumerate() {
                let from = skip_space(line, at);
                if from == line.len() {
                    return Err(miscounted(line, form, line.trim_ascii_end().len()));
                }
                if i == 0 {
                    first = from;
                }
                (*part, at) = number(line, from).map_err(refuse(from))?;
            }
            let key =
                unit(&mut self.oddities, parts, form.order, place.1, Some(index)).map_err(refuse(first))?;
            self.keys.push(key);
        }
        let surplus = skip_space(line, at);
        if surplus < line.len() {
            number(line, surplus).map_err(refuse(surplus))?;
            return Err(miscounted(line, form, surplus));
        }
        self.times.push(time);
        self.places.push(place);
        Ok(())
    }
}

/// The unit quaternion of four parts, and a note of what is odd about them.
// Inlined for the sake of large keyframe files, a tenth slower otherwise.
#[inline(always)]
pub(super) fn unit(
    oddities: &mut Oddities,
    parts: [f64; 4],
    order: Order,
    line: usize,
    index: Option<usize>,
) -> Result<Quat, Problem> {
    let q = match order {
        Order::Wxyz => Quat::from_wxyz(parts),
        Order::Xyzw => Quat::from_xyzw(parts),
    };
    oddities.look(parts, order, line);
    // Scaled by a power of two where the squares would overflow or vanish.
    let largest = parts.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
    if largest == 0.0 {
        return Err(Problem::new("expected a rotation, found a quaternion of zeros").hint(match order {
            Order::Wxyz => "no rotation is '1 0 0 0' in the order w x y z",
            Order::Xyzw => "no rotation is '0 0 0 1' in the order x y z w",
        }));
    }
    let (scale, back) = match largest {
        l if l < 1e-150 => (2f64.powi(700), 2f64.powi(-700)),
        l if l > 1e150 => (2f64.powi(-700), 2f64.powi(700)),
        _ => (1.0, 1.0),
    };
    let scaled = Quat { w: q.w * scale, v: q.v * scale };
    let norm = scaled.dot(scaled).sqrt();
    oddities.measure(norm * back, line, index);
    Ok(Quat { w: scaled.w / norm, v: scaled.v * (1.0 / norm) })
}

fn miscounted(line: &[u8], form: Form, offset: usize) -> Refused {
    let found = words(line).count();
    let Form { boxes, .. } = form;
    let quaternions = if boxes == 1 { "a quaternion".to_owned() } else { format!("{boxes} quaternions") };
    let expected = form.numbers();
    let problem =
        Problem::new(format!("expected {expected} numbers (a time and {quaternions}), found {found}"));
    (offset, problem, true)
}

/// Whether a comment is text, or the place where it is not.
pub(super) fn check_utf8(line: &[u8]) -> Result<(), (usize, Problem)> {
    match std::str::from_utf8(line) {
        Ok(_) => Ok(()),
        Err(error) => Err((error.valid_up_to(), not_utf8(line[error.valid_up_to()]))),
    }
}

/// How many rows there are, if all of them from `text` to the end of the file have `count`
/// numbers; `rest` is the block after `text`.
pub(super) fn agreeing<R: Read>(
    count: usize,
    text: &[u8],
    rest: Option<Block>,
    blocks: &mut Blocks<R>,
) -> io::Result<Option<usize>> {
    let mut seen = 0;
    let mut agree = |text: &[u8]| {
        word_counts(text).all(|n| {
            seen += 1;
            n == count
        })
    };
    let mut all = agree(text);
    let mut block = rest;
    while let Some(next) = block.filter(|_| all) {
        all = agree(&next.text);
        block = blocks.next()?;
    }
    Ok(all.then_some(seen))
}

/// How many words each row of a text has; comments and blank lines do not count.
fn word_counts(text: &[u8]) -> impl Iterator<Item = usize> {
    let rows = lines(text).filter(|(_, line)| {
        let start = skip_space(line, 0);
        line.get(start).is_some_and(|&b| b != b'#')
    });
    rows.map(|(_, line)| words(line).count())
}

//! Rows of points or rotations: numbers of which some rows also carry a time, some a
//! quaternion at the end.

use super::blocks::{Block, Blocks, last_line, lines};
use super::kind::{Header, Kind};
use super::oddities::Oddities;
use super::refusal::{Problem, Refusal};
use super::rows::{agreeing, check_utf8, unit};
use super::words::{number, skip_space};
use super::{Error, Order, times};
use crate::clip::Lines;
use crate::math::Quat;
use std::io::Read;

/// A file that is read as far as its header.
pub(super) struct Opening {
    pub(super) header: Header,
    line: usize,
    text: Vec<u8>,
    /// The lines after the header that are read already.
    rest: Block,
    next: Option<Block>,
    last_line: (usize, Vec<u8>),
}

impl Opening {
    /// `from`: where the header's line begins in the first block; `next`: the block after it.
    pub(super) fn new(header: Header, mut first: Block, from: usize, next: Option<Block>) -> Opening {
        let line = first.line + memchr::memchr_iter(b'\n', &first.text[..from]).count();
        let last_line = last_line(&first.text, first.line);
        let end = memchr::memchr(b'\n', &first.text[from..]).map_or(first.text.len(), |n| from + n + 1);
        let rest = Block { text: first.text.split_off(end), line: line + 1 };
        let text = first.text[from..].trim_ascii_end().to_vec();
        Opening { header, line, text, rest, next, last_line }
    }

    /// The refusal of a file that must be keyframes.
    pub(super) fn refuse_as_keyframes(&self, source_name: &str) -> Refusal {
        let found = self.header.kind.name();
        let problem =
            Problem::new(format!("expected a header of keyframes, such as '# 4 3.0', found '{found}'"));
        self.refuse(source_name, self.header.at, problem)
    }

    fn refuse(&self, source_name: &str, offset: usize, problem: Problem) -> Refusal {
        Refusal::new(source_name, self.line, &self.text, offset, problem)
    }
}

/// What rows look like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    /// Names of the numbers that every row has, such as `x y z`; none where a row is a
    /// quaternion alone.
    pub(super) columns: &'static str,
    /// Numbers further than this from 0 are refused.
    pub(super) limit: f64,
    pub(super) quaternion: Quaternion,
    pub(super) order: Order,
    pub(super) keys: Keys,
    /// What a row is, and what several are.
    pub(super) nouns: [&'static str; 2],
}

/// Which rows end in a quaternion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Quaternion {
    Never,
    /// Keys may.
    Maybe,
    Always,
}

/// Which rows are keys: those that the curve is at, at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Keys {
    Every,
    /// Every third: the ends of cubic segments.
    Cubic,
    /// The first and this one: the ends of one curve of this degree.
    Degree(usize),
}

impl Keys {
    /// Whether the row `i` is a key.
    pub(super) fn contains(self, i: usize) -> bool {
        match self {
            Keys::Every => true,
            Keys::Cubic => i.is_multiple_of(3),
            Keys::Degree(n) => i == 0 || i == n,
        }
    }
}

impl Form {
    /// Names of a row's numbers.
    fn row(&self, timed: bool) -> String {
        let time = if timed { "t " } else { "" };
        let values = if self.columns.is_empty() { self.parts() } else { self.columns };
        format!("{time}{values}")
    }

    /// Names of a quaternion's parts.
    fn parts(&self) -> &'static str {
        match self.order {
            Order::Wxyz => "w x y z",
            Order::Xyzw => "x y z w",
        }
    }

    /// The smallest and the largest count of numbers in a row, and no count between.
    fn counts(&self, timed: bool, key: bool) -> (usize, usize) {
        let base = self.columns.split_ascii_whitespace().count() + usize::from(timed);
        match self.quaternion {
            Quaternion::Never => (base, base),
            Quaternion::Maybe => (base, base + if key { 4 } else { 0 }),
            Quaternion::Always => (base + 4, base + 4),
        }
    }

    /// Whether a first row of that many numbers begins with a time.
    fn timed(&self, found: usize) -> Option<bool> {
        [false, true].into_iter().find(|&timed| {
            let (smallest, largest) = self.counts(timed, true);
            found == smallest || found == largest
        })
    }

    /// What may stand at the end of a row, for messages.
    fn hint(&self) -> Option<String> {
        let one = self.nouns[0];
        (self.quaternion == Quaternion::Maybe).then(|| {
            format!("4 more numbers at the end of a row are the {one}'s orientation, {}", self.parts())
        })
    }
}

/// The rows of a file.
pub(super) struct Table {
    form: Form,
    pub(super) header: Header,
    /// The numbers of every row, where there are columns.
    pub(super) values: Vec<[f64; 3]>,
    /// Quaternions of keys, or of every row where each is one; signs as in the file.
    pub(super) quaternions: Vec<Option<Quat>>,
    /// The time of the first key as the file gives it.
    pub(super) start: f64,
    /// Times of keys since the first, if rows carry times.
    pub(super) times: Option<Vec<f64>>,
    pub(super) lines: Lines,
    pub(super) oddities: Oddities,
    rows: usize,
    first_line: usize,
    /// The line of the last key.
    key_line: usize,
}

/// A problem and what it is about.
enum Fault {
    /// A place in the row.
    Row(usize, Problem),
    /// A place in the header.
    Header(usize, Problem),
    /// The very first row, which has so many numbers: whether row or header is wrong, the
    /// other rows tell.
    Miscounted(usize, Problem, usize),
}

impl From<(usize, Problem)> for Fault {
    fn from((offset, problem): (usize, Problem)) -> Fault {
        Fault::Row(offset, problem)
    }
}

/// Reads all rows after the header.
pub(super) fn read<R: Read>(
    source_name: &str,
    mut opening: Opening,
    blocks: &mut Blocks<R>,
    form: Form,
) -> Result<Table, Error> {
    let io = |error| Error::Io { source_name: source_name.to_owned(), error };
    let mut table = Table::new(opening.header.clone(), form);
    let mut block = Some(std::mem::replace(&mut opening.rest, Block { text: Vec::new(), line: 1 }));
    let mut numbers = Vec::new();
    while let Some(Block { text, line: first_line }) = block {
        for (i, (start, line)) in lines(&text).enumerate() {
            let at = first_line + i;
            let refuse = |offset, problem| Refusal::new(source_name, at, line, offset, problem);
            match table.take(line, at, &mut numbers) {
                Ok(()) => {}
                Err(Fault::Row(offset, problem)) => return Err(refuse(offset, problem).into()),
                Err(Fault::Header(offset, problem)) => {
                    return Err(opening.refuse(source_name, offset, problem).into());
                }
                Err(Fault::Miscounted(offset, problem, count)) => {
                    let rest = opening.next.take().map_or_else(|| blocks.next(), |next| Ok(Some(next)));
                    let rest = rest.map_err(io)?;
                    return Err(match agreeing(count, &text[start..], rest, blocks).map_err(io)? {
                        Some(seen) if seen > 1 => {
                            opening.refuse(source_name, opening.header.at, table.disagreement(seen, count))
                        }
                        _ => refuse(offset, problem),
                    }
                    .into());
                }
            }
        }
        if !text.is_empty() {
            opening.last_line = last_line(&text, first_line);
        }
        block = match opening.next.take() {
            Some(next) => Some(next),
            None => blocks.next().map_err(io)?,
        };
    }
    match table.miscount() {
        None => Ok(table),
        Some(Fault::Header(offset, problem)) => Err(opening.refuse(source_name, offset, problem).into()),
        Some(Fault::Row(_, problem) | Fault::Miscounted(_, problem, _)) => {
            let (line, text) = &opening.last_line;
            Err(Refusal::new(source_name, *line, text, text.len(), problem).into())
        }
    }
}

impl Table {
    fn new(header: Header, form: Form) -> Table {
        Table {
            form,
            header,
            values: Vec::new(),
            quaternions: Vec::new(),
            start: 0.0,
            times: None,
            lines: Lines::default(),
            oddities: Oddities::default(),
            rows: 0,
            first_line: 0,
            key_line: 0,
        }
    }

    /// Takes one line: a row, a comment, or nothing. `numbers` is room to work in.
    fn take(&mut self, line: &[u8], at: usize, numbers: &mut Vec<(usize, f64)>) -> Result<(), Fault> {
        let mut from = skip_space(line, 0);
        match line.get(from) {
            None => return Ok(()),
            Some(b'#') => return Ok(check_utf8(line)?),
            Some(_) => {}
        }
        numbers.clear();
        while from < line.len() {
            let (value, end) = number(line, from).map_err(|problem| (from, problem))?;
            numbers.push((from, value));
            from = skip_space(line, end);
        }
        let end = line.trim_ascii_end().len();
        if self.rows == 0 {
            self.take_form(at, end, numbers)?;
        }
        self.take_row(at, line, numbers)
    }

    /// Learns from the first row whether rows carry times.
    fn take_form(&mut self, at: usize, end: usize, numbers: &[(usize, f64)]) -> Result<(), Fault> {
        let found = numbers.len();
        let Some(timed) = self.form.timed(found) else {
            let (least, timed) = (self.form.counts(false, true), self.form.counts(true, true));
            let offset = surplus(numbers, end, if found > timed.0 { timed } else { least });
            let (row, timed_row) = (self.form.row(false), self.form.row(true));
            let problem = Problem {
                hint: self.form.hint(),
                ..Problem::new(format!(
                    "expected {} numbers ({row}) or {} ({timed_row}), found {found}",
                    least.0, timed.0
                ))
            };
            return Err(Fault::Miscounted(offset, problem, found));
        };
        if let Some((offset, seconds)) = self.header.duration.filter(|_| timed) {
            let row = self.form.row(true);
            let problem = Problem::new(format!(
                "expected no duration, because rows have times ({row}, from line {at} on), found {seconds}"
            ));
            return Err(Fault::Header(offset, problem.hint("leave out the duration, or the times")));
        }
        self.first_line = at;
        self.times = timed.then(Vec::new);
        Ok(())
    }

    fn take_row(&mut self, at: usize, line: &[u8], numbers: &[(usize, f64)]) -> Result<(), Fault> {
        let end = line.trim_ascii_end().len();
        let key = self.form.keys.contains(self.rows);
        let timed = self.times.is_some() && key;
        let (smallest, largest) = self.form.counts(timed, key);
        let found = numbers.len();
        if found != smallest && found != largest {
            return Err(self.unlike(end, key, numbers));
        }
        let (time, rest) = numbers.split_at(usize::from(timed));
        if let (Some(times), [(offset, time)]) = (&mut self.times, time) {
            if times.is_empty() {
                self.start = *time;
            }
            let key_line = self.key_line;
            let t = times::next(self.start, times.last().copied(), *time, || key_line, || line);
            times.push(t.map_err(|problem| (*offset, problem))?);
        }
        let mut rest = rest;
        if let [a, b, c, more @ ..] = rest
            && !self.form.columns.is_empty()
        {
            self.values.push([self.value(a)?, self.value(b)?, self.value(c)?]);
            rest = more;
        }
        let quaternion = match rest {
            [(offset, a), (_, b), (_, c), (_, d)] => {
                let unit = unit(&mut self.oddities, [*a, *b, *c, *d], self.form.order, at, None);
                Some(unit.map_err(|problem| (*offset, problem))?)
            }
            _ => None,
        };
        if key || self.form.quaternion == Quaternion::Always {
            self.quaternions.push(quaternion);
        }
        if key {
            self.key_line = at;
        }
        self.lines.push(at);
        self.rows += 1;
        Ok(())
    }

    fn value(&self, &(offset, value): &(usize, f64)) -> Result<f64, Fault> {
        let limit = self.form.limit;
        if value.abs() <= limit {
            return Ok(value);
        }
        let problem = format!("expected a number between -{limit:e} and {limit:e}, found {value:e}");
        Err(Fault::Row(offset, Problem::new(problem)))
    }

    /// A row, not the first, that is not like the others.
    fn unlike(&self, end: usize, key: bool, numbers: &[(usize, f64)]) -> Fault {
        let Form { keys, nouns: [one, _], .. } = self.form;
        let (timed, found) = (self.times.is_some(), numbers.len());
        let counts @ (smallest, largest) = self.form.counts(timed && key, key);
        let offset = match found == smallest + 1 && timed && !key {
            true => numbers[0].0,
            false => surplus(numbers, end, counts),
        };
        let why = match keys {
            Keys::Cubic | Keys::Degree(_) if !key && found == smallest + 4 => {
                format!(": an inner {one} has no orientation")
            }
            Keys::Cubic if timed && key => ": a segment begins or ends here".to_owned(),
            Keys::Degree(_) if timed && key => ": the curve ends here".to_owned(),
            Keys::Cubic | Keys::Degree(_) if timed => format!(": an inner {one} has no time"),
            _ => format!(", as in line {}", self.first_line),
        };
        let row = self.form.row(timed && key);
        let or =
            if largest > smallest { format!(" or {largest} with an orientation") } else { String::new() };
        let problem = Problem::new(format!("expected {smallest} numbers ({row}{why}){or}, found {found}"));
        let (ends, inner) = (self.form.row(true), self.form.row(false));
        let hint = match keys {
            _ if !timed => self.form.hint(),
            Keys::Every => self.form.hint(),
            Keys::Cubic => Some(format!(
                "with times, rows 1, 4, 7, …, where segments begin and end, are '{ends}', all others '{inner}'"
            )),
            Keys::Degree(_) => {
                Some(format!("with times, the first row and the last are '{ends}', all others '{inner}'"))
            }
        };
        Fault::Row(offset, Problem { hint, ..problem })
    }

    /// The header that no row agrees with.
    fn disagreement(&self, seen: usize, count: usize) -> Problem {
        let name = self.header.kind.name();
        let problem = Problem::new(format!(
            "expected a header that fits the rows, found '{name}' where all {seen} rows have {count} numbers"
        ));
        let (row, timed) = (self.form.row(false), self.form.row(true));
        problem.hint(match count {
            3 | 4 | 7 | 8 if self.header.kind == Kind::QuatBezier => {
                format!("rows of '{name}' are '{row}' or '{timed}'; those of points begin with '# bezier'")
            }
            5.. if (count - 1).is_multiple_of(4) => {
                let boxes = (count - 1) / 4;
                format!("keyframes, a time and 4 numbers for each box, begin with '# {boxes} 3.0'")
            }
            _ => format!("rows of '{name}' are '{row}' or '{timed}'"),
        })
    }

    /// What is wrong with the count of rows.
    fn miscount(&self) -> Option<Fault> {
        let (rows, [one, many]) = (self.rows, self.form.nouns);
        match (self.form.keys, self.header.degree) {
            (Keys::Every, _) if rows < 2 => {
                let found = if rows == 0 { "none" } else { "one" };
                let problem = Problem::new(format!("expected two {many} or more, found {found}"));
                let (row, timed) = (self.form.row(false), self.form.row(true));
                Some(Fault::Row(0, problem.hint(format!("a {one} is a row: '{row}' or '{timed}'"))))
            }
            (Keys::Cubic, _) if rows < 4 || rows % 3 != 1 => Some(Fault::Row(0, self.not_cubic())),
            (Keys::Degree(n), Some((offset, _))) if rows != n + 1 => {
                let (found, needed) = (rows, n + 1);
                let off = if found > needed {
                    format!("{} too many", found - needed)
                } else {
                    format!("{} missing", needed - found)
                };
                let problem = Problem::new(format!(
                    "expected {needed} {many} for one curve of degree {n}, found {found}: {off}"
                ));
                let this = if rows < 2 {
                    String::new()
                } else {
                    format!("degree={} for these {rows}, or ", rows - 1)
                };
                let hint = format!("write {this}no degree for cubic segments, which need 4, 7, 10, … {many}");
                Some(Fault::Header(offset, problem.hint(hint)))
            }
            _ => None,
        }
    }

    fn not_cubic(&self) -> Problem {
        let (rows, [one, many]) = (self.rows, self.form.nouns);
        let noun = |n| if n == 1 { one } else { many };
        let (off, add) = if rows < 4 {
            let missing = 4 - rows;
            (format!("{missing} missing"), format!("add {missing} {}", noun(missing)))
        } else {
            let over = (rows - 1) % 3;
            let missing = 3 - over;
            let add = format!("add {missing} {} or leave out {over}", noun(missing));
            (format!("{missing} missing or {over} over"), add)
        };
        let problem = Problem::new(format!(
            "expected 3n + 1 {many} for n cubic segments (4, 7, 10, …), found {rows}: {off}"
        ));
        match self.header.kind {
            Kind::Path(_) if rows >= 2 => {
                let degree = rows - 1;
                problem.hint(format!(
                    "{add}; or write degree={degree} in the header for one curve of all {rows}"
                ))
            }
            _ => problem.hint(add),
        }
    }
}

/// The place of a wrong count: the first number too many, or the line's end.
fn surplus(numbers: &[(usize, f64)], end: usize, (smallest, largest): (usize, usize)) -> usize {
    let fitting = if numbers.len() > largest { largest } else { smallest };
    numbers.get(fitting).map_or(end, |(offset, _)| *offset)
}

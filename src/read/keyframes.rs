//! A keyframe file, from its first byte to a clip.

use super::blocks::{Block, Blocks, last_line, lines};
use super::header::{self, ADVICE, Header};
use super::kind;
use super::oddities::Oddities;
use super::refusal::{Problem, Refusal};
use super::rows::{self, Form, Rows};
use super::table::Opening;
use super::times;
use super::words::{not_utf8, quoted, skip_space, words};
use super::{Error, Order};
use crate::clip::{Clip, Lines, Through, Warning};
use std::io::Read;

/// What a keyframe file holds.
#[derive(Debug)]
pub struct Keyframes {
    /// The keys, checked.
    pub clip: Clip,
    /// Whether neither rows nor header say when: evenly spaced keys, which last as long as
    /// what they go with.
    pub untimed: bool,
    /// The order of quaternions' parts in which they were read.
    pub order: Order,
    /// What a user should know.
    pub warnings: Vec<Warning>,
    /// How far from 1 the length of the worst quaternion was.
    pub largest_norm_error: f64,
    /// BLAKE3 hash of the file's bytes, in hexadecimal.
    pub hash: String,
    /// Bytes read.
    pub bytes: u64,
}

/// Reads a keyframe file; `source_name` stands in messages, `order` overrides the
/// header's. The format: docs/format.md.
///
/// Memory: the keys, and a few blocks of text.
pub fn keyframes(
    source_name: &str,
    input: impl Read + Send,
    order: Option<Order>,
) -> Result<Keyframes, Error> {
    match start(source_name, &mut Blocks::new(input), order)? {
        Start::Keyframes(keyframes) => Ok(keyframes),
        Start::Other(opening) => Err(opening.refuse_as_keyframes(source_name).into()),
    }
}

/// What a file turned out to be.
pub(super) enum Start {
    /// Keyframes, read to the end.
    Keyframes(Keyframes),
    /// Something else, read to its header.
    Other(Box<Opening>),
}

/// Reads a keyframe file to its end, and any other file to its header.
pub(super) fn start<R: Read + Send>(
    source_name: &str,
    blocks: &mut Blocks<R>,
    order: Option<Order>,
) -> Result<Start, Error> {
    let io = |error| Error::Io { source_name: source_name.to_owned(), error };
    let mut reader = Reader::new(source_name, order);
    let mut block = blocks.next().map_err(io)?;
    if let Some(first) = &mut block {
        reader.strip_mark(first)?;
    }
    while let Some(Block { text, line }) = block {
        if reader.is_under_way() {
            reader.follow(Block { text, line }, blocks)?;
            break;
        }
        // The next block is read while this one is parsed.
        let (taken, next) = rayon::join(|| reader.take(&text, line), || blocks.next());
        match taken {
            Ok(()) => {
                block = next.map_err(io)?;
                blocks.reuse(text);
            }
            Err(Stop::Refused(refusal)) => return Err((*refusal).into()),
            Err(Stop::Miscounted(refusal, count)) => {
                let rest = next.map_err(io)?;
                return Err(reader.blame(*refusal, count, &text, rest, blocks).map_err(io)?.into());
            }
            Err(Stop::Other(header, from)) => {
                let next = next.map_err(io)?;
                return Ok(Start::Other(Box::new(Opening::new(*header, Block { text, line }, from, next))));
            }
        }
    }
    let largest_norm_error = reader.oddities.largest_norm_error();
    let (clip, order, warnings) = reader.finish()?;
    let hash = blocks.hasher.finalize().to_hex().to_string();
    let bytes = blocks.bytes;
    Ok(Start::Keyframes(Keyframes { clip, untimed: false, order, warnings, largest_norm_error, hash, bytes }))
}

/// Why reading stopped.
enum Stop {
    Refused(Box<Refusal>),
    /// The very first row has another count of numbers than the header says: whether row
    /// or header is wrong, the other rows tell.
    Miscounted(Box<Refusal>, usize),
    /// The header says that these are no keyframes: the header, and where in the block
    /// its line begins.
    Other(Box<kind::Header>, usize),
}

/// A row that does not fit; where it has the wrong count of numbers, how many it has.
struct Unfit {
    refusal: Box<Refusal>,
    count: Option<usize>,
}

impl From<Refusal> for Unfit {
    fn from(refusal: Refusal) -> Unfit {
        Unfit { refusal: Box::new(refusal), count: None }
    }
}

impl From<Refusal> for Stop {
    fn from(refusal: Refusal) -> Stop {
        Stop::Refused(Box::new(refusal))
    }
}

struct Reader<'a> {
    source_name: &'a str,
    order: Option<Order>,
    header: Option<(Header, usize, Vec<u8>)>,
    /// A header of another family, and where in the block its line begins.
    other: Option<(Box<kind::Header>, usize)>,
    /// The first comment that nearly is a header: line and reason.
    near_header: Option<(usize, String)>,
    start: f64,
    times: Vec<f64>,
    tracks: Vec<Vec<crate::math::Quat>>,
    lines: Lines,
    oddities: Oddities,
    /// The last line that was seen, for what is missing at the end.
    last_line: (usize, Vec<u8>),
}

impl<'a> Reader<'a> {
    fn new(source_name: &'a str, order: Option<Order>) -> Reader<'a> {
        Reader {
            source_name,
            order,
            header: None,
            other: None,
            near_header: None,
            start: 0.0,
            times: Vec::new(),
            tracks: Vec::new(),
            lines: Lines::default(),
            oddities: Oddities::default(),
            last_line: (1, Vec::new()),
        }
    }

    fn refuse(&self, line: usize, text: &[u8], offset: usize, problem: Problem) -> Refusal {
        Refusal::new(self.source_name, line, text, offset, problem)
    }

    /// Removes a UTF-8 byte-order mark; refuses UTF-16.
    fn strip_mark(&self, block: &mut Block) -> Result<(), Refusal> {
        // Without a mark every other byte of ASCII text is zero.
        let utf16 =
            matches!(block.text[..], [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, _, 0, ..] | [_, 0, _, 0, ..]);
        if utf16 {
            let problem = Problem::new("expected UTF-8 text, found UTF-16");
            return Err(self.refuse(1, b"", 0, problem.hint("save the file as UTF-8")));
        }
        if block.text.starts_with(&[0xef, 0xbb, 0xbf]) {
            block.text.drain(..3);
        }
        Ok(())
    }

    /// Whether there are rows that fit the header.
    fn is_under_way(&self) -> bool {
        !self.times.is_empty()
    }

    /// Takes all blocks from one on: each is parsed while the one before it is appended and
    /// the one after it is read.
    fn follow<R: Read + Send>(&mut self, first: Block, blocks: &mut Blocks<R>) -> Result<(), Error> {
        let form = self.form().expect("rows stand under a header");
        let (mut block, mut parsed) = (Some(first), None);
        loop {
            let parse = || block.as_ref().map(|block| rows::parse(&block.text, block.line, form));
            let append = || self.append_all(parsed.take(), form);
            let (appended, (rows, next)) = rayon::join(append, || rayon::join(parse, || blocks.next()));
            if let Some(text) = appended? {
                blocks.reuse(text);
            }
            let (Some(now), Some(rows)) = (block, rows) else { return Ok(()) };
            block = next.map_err(|error| Error::Io { source_name: self.source_name.to_owned(), error })?;
            if block.is_none() {
                self.remember_last_line(&now.text, now.line);
            }
            parsed = Some((now, rows));
        }
    }

    /// Appends what was parsed of a block, if there is one, and returns its room.
    fn append_all(
        &mut self,
        parsed: Option<(Block, Vec<(usize, Rows)>)>,
        form: Form,
    ) -> Result<Option<Vec<u8>>, Refusal> {
        let Some((Block { text, line }, parts)) = parsed else { return Ok(None) };
        for (_, rows) in parts {
            self.append(rows, &text, line, form).map_err(|unfit| *unfit.refusal)?;
        }
        Ok(Some(text))
    }

    /// What rows must look like, as the header says.
    fn form(&self) -> Option<Form> {
        let (header, ..) = &self.header.as_ref()?;
        let order = self.order.or(header.order).unwrap_or_default();
        Some(Form { boxes: header.boxes, order })
    }

    fn take(&mut self, text: &[u8], first_line: usize) -> Result<(), Stop> {
        let (from, skipped) =
            if self.header.is_none() { self.find_header(text, first_line)? } else { (0, 0) };
        if let Some((header, start)) = self.other.take() {
            return Err(Stop::Other(header, start));
        }
        self.remember_last_line(text, first_line);
        let Some(form) = self.form() else { return Ok(()) };
        let first_line = first_line + skipped;
        let text = &text[from..];
        for (_, rows) in rows::parse(text, first_line, form) {
            self.append(rows, text, first_line, form).map_err(|Unfit { refusal, count }| match count {
                Some(count) if !self.is_under_way() => Stop::Miscounted(refusal, count),
                _ => Stop::Refused(refusal),
            })?;
        }
        Ok(())
    }

    /// Looks for the header among the lines before the first row; returns where the text
    /// after it begins and how many lines were passed.
    fn find_header(&mut self, text: &[u8], first_line: usize) -> Result<(usize, usize), Refusal> {
        for (number, (start, line)) in lines(text).enumerate() {
            let at = first_line + number;
            let first = skip_space(line, 0);
            if first == line.len() {
                continue;
            }
            if let Err(error) = std::str::from_utf8(line) {
                let offset = error.valid_up_to();
                return Err(self.refuse(at, line, offset, not_utf8(line[offset])));
            }
            if line[first] != b'#' {
                return Err(self.missing_header(at, line, first));
            }
            match header::parse(line) {
                header::Line::Header(header) => {
                    self.header = Some((header, at, line.to_vec()));
                    return Ok(((start + line.len()).min(text.len()), number));
                }
                header::Line::Kind(header) => {
                    self.other = Some((Box::new(header), start));
                    return Ok((start, number));
                }
                header::Line::Wrong(offset, problem) => return Err(self.refuse(at, line, offset, problem)),
                header::Line::Comment(reason) => {
                    let near = reason.map(|(_, reason)| (at, reason));
                    self.near_header = self.near_header.take().or(near);
                }
            }
        }
        Ok((text.len(), 0))
    }

    fn missing_header(&self, line: usize, text: &[u8], offset: usize) -> Refusal {
        let found = words(text).next().map_or_else(|| "nothing".to_owned(), |(_, word)| quoted(word));
        let near = match &self.near_header {
            Some((line, reason)) => format!("; line {line} is a comment, because {reason}"),
            None => String::new(),
        };
        let problem = Problem::new(format!("expected a header before the first row, found {found}{near}"));
        self.refuse(line, text, offset, problem.hint(header::advice(words(text).count())))
    }

    fn append(&mut self, rows: Rows, text: &[u8], first_line: usize, form: Form) -> Result<(), Unfit> {
        if self.tracks.is_empty() && !rows.times.is_empty() {
            self.start = rows.times[0];
            self.tracks = vec![Vec::new(); form.boxes];
        }
        for (row, &time) in rows.times.iter().enumerate() {
            let (at, line) = rows.places[row];
            self.push_time(time, &text[at..], first_line + line)?;
            self.lines.push(first_line + line);
        }
        for (index, track) in self.tracks.iter_mut().enumerate() {
            track.reserve(rows.times.len());
            let mut previous = track.last().copied();
            for key in rows.keys.iter().skip(index).step_by(form.boxes).take(rows.times.len()) {
                let key = previous.map_or(*key, |previous| key.aligned_to(previous));
                track.push(key);
                previous = Some(key);
            }
        }
        self.oddities = self.oddities.and(rows.oddities);
        let Some(wrong) = rows.wrong else { return Ok(()) };
        let line = lines(&text[wrong.line_start..]).next().map_or(b"".as_slice(), |(_, line)| line);
        let count = words(line).count();
        let refusal = self.refuse(first_line + wrong.line, line, wrong.offset, wrong.problem);
        Err(Unfit { refusal: Box::new(refusal), count: wrong.miscounted.then_some(count) })
    }

    fn push_time(&mut self, time: f64, text: &[u8], line: usize) -> Result<(), Refusal> {
        let before = self.times.last().copied();
        let row = || lines(text).next().map_or(b"".as_slice(), |(_, line)| line);
        match times::next(self.start, before, time, || self.lines.of(self.times.len() - 1), row) {
            Ok(t) => self.times.push(t),
            Err(problem) => return Err(self.refuse(line, row(), skip_space(row(), 0), problem)),
        }
        Ok(())
    }

    fn remember_last_line(&mut self, text: &[u8], first_line: usize) {
        self.last_line = last_line(text, first_line);
    }

    /// Decides who is wrong where the first row does not have the header's count: the
    /// header, if all rows agree with each other.
    fn blame<R: Read>(
        &self,
        refusal: Refusal,
        count: usize,
        text: &[u8],
        rest: Option<Block>,
        blocks: &mut Blocks<R>,
    ) -> std::io::Result<Refusal> {
        let agreeing = rows::agreeing(count, text, rest, blocks)?;
        Ok(match (&self.header, agreeing) {
            (Some((header, line, text)), Some(seen)) if seen > 1 => {
                let problem = disagreement(*header, seen, count);
                self.refuse(*line, text, header.boxes_at, problem)
            }
            _ => refusal,
        })
    }

    fn finish(self) -> Result<(Clip, Order, Vec<Warning>), Refusal> {
        let (line, text) = &self.last_line;
        let missing = |problem: Problem| self.refuse(*line, text, text.len(), problem);
        let Some((header, ..)) = &self.header else {
            let found = if text.is_empty() { "an empty file" } else { "the end of the file" };
            let near = match &self.near_header {
                Some((line, reason)) => format!("; line {line} is a comment, because {reason}"),
                None => String::new(),
            };
            return Err(missing(
                Problem::new(format!("expected a header, found {found}{near}")).hint(ADVICE),
            ));
        };
        let found = match self.times.len() {
            0 => "none",
            1 => "one",
            _ => {
                let order = self.order.or(header.order).unwrap_or_default();
                let warnings = self.oddities.warnings(order);
                let Reader { start, times, tracks, lines, .. } = self;
                let body = header.body;
                let clip = Clip { body, start, times, tracks, through: Through::Keys, lines };
                return Ok((clip, order, warnings));
            }
        };
        let problem = Problem::new(format!("expected two keys or more, found {found}"));
        Err(missing(problem.hint("a key is a row: a time and a quaternion for each box")))
    }
}

/// The header that no row agrees with.
fn disagreement(header: Header, rows: usize, count: usize) -> Problem {
    let box_or_boxes = |n: usize| if n == 1 { "box" } else { "boxes" };
    let problem = Problem::new(format!(
        "expected a header that fits the rows, found {} {} where all {rows} rows have {count} numbers",
        header.boxes,
        box_or_boxes(header.boxes)
    ));
    if count > 1 && (count - 1).is_multiple_of(4) {
        let boxes = (count - 1) / 4;
        let plural = box_or_boxes(boxes);
        problem.hint(format!("rows of {count} numbers are {boxes} {plural}: a time and 4 numbers for each"))
    } else {
        let untimed = if count.is_multiple_of(4) { "; is the time missing?" } else { "" };
        problem.hint(format!("a row is a time and 4 numbers for each box: 5, 9, 13, 17, … numbers{untimed}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::Body;
    use crate::math::Quat;

    fn read(text: impl AsRef<[u8]>) -> Result<Keyframes, Error> {
        keyframes("clip.dat", text.as_ref(), None)
    }

    fn refusal(text: impl AsRef<[u8]>) -> String {
        read(text).unwrap_err().to_string()
    }

    /// Rows of several blocks, the first in line 2.
    fn long(rows: usize) -> String {
        let row = |i: usize| format!("{i} {:.9} {:.9} 0 0\n", (i as f64).cos(), (i as f64).sin());
        "# 1 2\n".to_owned() + &(0..rows).map(row).collect::<String>()
    }

    #[test]
    fn blocks_are_appended_in_their_order() {
        let text = long(300_000);
        assert!(text.len() > 4 * (2 << 20));
        let clip = read(&text).unwrap().clip;
        assert_eq!(clip.times.len(), 300_000);
        assert!(clip.times.iter().enumerate().all(|(i, &t)| t == i as f64));
        for i in [0, 77_777, 150_000, 299_999] {
            let expected = Quat::from_wxyz([(i as f64).cos(), (i as f64).sin(), 0.0, 0.0]);
            assert!(clip.tracks[0][i].angle_to(expected) < 1e-8);
            assert_eq!(clip.line(i), i + 2);
        }
    }

    #[test]
    fn first_row_that_is_wrong_is_named_in_whatever_block() {
        let text = long(300_000);
        for (row, wrong, words) in [
            (299_999, "1 0 0 0", "expected 5 numbers"),
            (150_000, "0 1 0 0 0", "later than"),
            (77_777, "77777 1 0 x 0", "expected a number, found 'x'"),
        ] {
            let mut lines: Vec<&str> = text.lines().collect();
            lines[row + 1] = wrong;
            lines[299_999] = "never looked at";
            if row == 299_999 {
                lines.truncate(row + 2);
                lines[299_999] = "299998 1 0 0 0";
            }
            let message = refusal(lines.join("\n"));
            assert!(message.contains(&format!("clip.dat:{}:", row + 2)), "{message}");
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn reads_what_it_must() {
        let text = b"\xef\xbb\xbf# a comment\r\n\r\n# 2 1.5\r\n12.5 1 0 0 0\t0 1 0 0 \r\n# more\r\n\r\n13. -2 0 0 0 0 -.5E0 0 0";
        let Keyframes { clip, warnings, bytes, hash, .. } = read(text).unwrap();
        assert_eq!(clip.body, Body::Chain { length: 1.5 });
        assert_eq!((clip.start, clip.times.as_slice()), (12.5, [0.0, 0.5].as_slice()));
        let key = |w, x| crate::math::Quat::from_wxyz([w, x, 0.0, 0.0]);
        assert_eq!(clip.tracks[0], [key(1.0, 0.0), key(1.0, 0.0)]);
        assert_eq!(clip.tracks[1], [key(0.0, 1.0), key(0.0, 1.0)]);
        assert_eq!((clip.lines.of(0), clip.lines.of(1)), (4, 7));
        assert_eq!(warnings.len(), 1);
        assert!(warnings[0].message.contains("2 quaternions are") && warnings[0].message.contains("line 7"));
        assert_eq!((bytes, hash), (text.len() as u64, blake3::hash(text).to_hex().to_string()));
    }

    #[test]
    fn many_blocks_are_one_file() {
        let row = |i: usize| format!("{} 1 0 0 {}\n", i as f64 * 0.01, (i % 7) as f64 * 0.1);
        let text: String = std::iter::once("# 1 2\n".to_owned()).chain((0..600_000).map(row)).collect();
        assert!(text.len() > 9 << 20);
        let clip = read(&text).unwrap().clip;
        assert_eq!(clip.times.len(), 600_000);
        assert_eq!(clip.lines.of(599_999), 600_001);
        let mut broken = text.into_bytes();
        let last = broken.len() - 3;
        broken[last] = b'x';
        assert!(refusal(broken).starts_with("clip.dat:600001:"));
    }

    #[test]
    fn the_earliest_problem_counts() {
        assert!(
            refusal("# 1 2\n0 1 0 0 0\n0 1 0 0 0\n1 x 0 0 0\n")
                .starts_with("clip.dat:3:1: expected a time later")
        );
        assert!(
            refusal("# 1 2\n0 1 0 0 0\n1 x 0 0 0\n0 1 0 0 0\n")
                .starts_with("clip.dat:3:3: expected a number")
        );
    }

    #[test]
    fn times_that_float64_cannot_tell_apart() {
        let text = refusal("# 1 2\n-1e20 1 0 0 0\n1 1 0 0 0\n2 1 0 0 0\n");
        assert!(text.starts_with("clip.dat:4:1: expected a time that float64 can tell"), "{text}");
        assert!(refusal("# 1 2\n-1e308 1 0 0 0\n1e308 1 0 0 0\n").contains("1.8e308"));
    }

    #[test]
    fn the_header_is_blamed_when_all_rows_agree() {
        let two = "# 2 3\n0 1 0 0 0\n1 1 0 0 0\n";
        assert!(
            refusal(two).starts_with("clip.dat:1:3: expected a header that fits the rows, found 2 boxes")
        );
        assert!(refusal(two).ends_with("rows of 5 numbers are 1 box: a time and 4 numbers for each"));
        let mixed = "# 2 3\n0 1 0 0 0\n1 1 0 0 0 1 0 0 0\n";
        assert!(
            refusal(mixed)
                .starts_with("clip.dat:2:10: expected 9 numbers (a time and 2 quaternions), found 5")
        );
        let six = "# 1 3\n0 1 0 0 0 9\n1 1 0 0 0 9\n";
        assert!(refusal(six).contains("5, 9, 13"));
    }

    #[test]
    fn extreme_lengths_become_unit() {
        let text = "# 1 2\n0 1e-320 0 0 0\n1 1e200 1e200 0 0\n";
        let clip = read(text).unwrap().clip;
        for key in &clip.tracks[0] {
            assert!((key.norm() - 1.0).abs() < 1e-15, "{key:?}");
        }
    }

    #[test]
    fn suspicious_order_is_named() {
        let order = |text: &str| {
            let warnings = read(text).unwrap().warnings;
            warnings.iter().find(|w| w.code == "QUAT_ORDER").map(|w| w.message.clone())
        };
        let scipy = "# 1 2\n0 -.6 0 0 .8\n1 .6 0 0 .8\n2 .8 0 0 .6\n";
        assert!(order(scipy).unwrap().contains("--quat-order xyzw"));
        assert!(order("# 1 2 xyzw\n0 .6 0 0 -.8\n1 .6 0 0 .8\n").unwrap().contains("--quat-order wxyz"));
        assert!(order("# 1 2\n0 0 0 0 1\n1 .6 0 0 .8\n").unwrap().contains("line 2"));
        // Rotations about x alone, through more than a turn: z is zero, not a scalar.
        assert_eq!(order("# 1 2\n0 .6 .8 0 0\n1 -.6 .8 0 0\n"), None);
        assert_eq!(order("# 1 2\n0 1 0 0 0\n1 0 0 0 1\n"), None);
        assert_eq!(order("# 1 2\n0 .6 0 0 .8\n1 .8 0 0 .6\n"), None);
    }

    #[test]
    fn order_of_the_option_wins_over_the_header() {
        let text = "# 1 2 xyzw\n0 1 0 0 0\n1 1 0 0 0\n";
        let read = |order| keyframes("x", text.as_bytes(), order).unwrap().clip.tracks[0][0];
        assert_eq!(read(None).to_xyzw(), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(read(Some(Order::Wxyz)), crate::math::Quat::IDENTITY);
    }
}

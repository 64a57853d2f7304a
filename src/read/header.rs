//! The header: `# 4 3.0 wxyz`, boxes, length of a box, order of a quaternion's parts.
//! A line whose first word is no whole number may be a header of the other family: `kind`.

use super::Order;
use super::kind;
use super::refusal::Problem;
use super::words::{number, quoted, words};
use crate::clip::Body;

/// What a header says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Header {
    pub(super) boxes: usize,
    pub(super) body: Body,
    pub(super) order: Option<Order>,
    /// Where the number of boxes stands in the line.
    pub(super) boxes_at: usize,
}

/// What a line that begins with `#` is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Line {
    Header(Header),
    /// A header of a path or of rotations.
    Kind(kind::Header),
    /// A comment; where it nearly is a header, the place and the reason it is none.
    Comment(Option<(usize, String)>),
    /// A header with a mistake, at a place in the line.
    Wrong(usize, Problem),
}

/// What a header looks like, for messages.
pub(super) const ADVICE: &str =
    "begin the file with the number of boxes and the length of a box, such as '# 4 3.0'";

/// [`ADVICE`] where the first row has as many numbers as no keyframe has, but a point may.
pub(super) fn advice(numbers: usize) -> &'static str {
    match numbers {
        3 | 4 | 7 | 8 => {
            "begin a file of points with its kind, such as '# bezier', '# catmull-rom 20' or '# polyline'"
        }
        _ => ADVICE,
    }
}

/// Reads a line that begins with `#`. It is a header if it holds a whole number, at most
/// one length and at most `wxyz` or `xyzw`, and nothing else.
pub(super) fn parse(line: &[u8]) -> Line {
    let hash = line.iter().position(|&b| b == b'#').map_or(0, |at| at + 1);
    let mut rest: Vec<(usize, &[u8])> = words(&line[hash..]).map(|(at, word)| (at + hash, word)).collect();
    if rest.is_empty() || !is_whole(rest[0].1) {
        return kind::parse(&rest);
    }
    let (boxes_at, boxes) = rest.remove(0);
    let order = rest.last().and_then(|(_, word)| Order::from_name_bytes(word));
    if order.is_some() {
        rest.pop();
    }
    let length = match rest.as_slice() {
        [] => None,
        [(at, word)] => match number(word, 0) {
            Ok((length, _)) => Some((*at, length)),
            Err(problem) if looks_like_a_number(word) => return Line::Wrong(*at, problem),
            Err(_) => return nearly(*at, word, "neither a length nor wxyz or xyzw"),
        },
        [(at, word), ..] if number(word, 0).is_err() && Order::from_name_bytes(word).is_none() => {
            return nearly(*at, word, "neither a length nor wxyz or xyzw");
        }
        [_, (at, word)] if order.is_none() => return nearly(*at, word, "neither wxyz nor xyzw"),
        [_, (at, word), ..] => return nearly(*at, word, "one word too many"),
    };
    checked(line.len(), (boxes_at, boxes), length, order)
}

/// A comment that would be a header but for one word.
fn nearly(at: usize, word: &[u8], what_it_is: &str) -> Line {
    Line::Comment(Some((at, format!("{} is {what_it_is}", quoted(word)))))
}

/// Lengths of a box that float32, glTF's number for places, can draw.
const LENGTHS: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

fn checked(
    end: usize,
    (boxes_at, boxes): (usize, &[u8]),
    length: Option<(usize, f64)>,
    order: Option<Order>,
) -> Line {
    let count = String::from_utf8_lossy(boxes).parse::<i128>().ok();
    let boxes = match count {
        Some(n @ 1..=0xffff_ffff) => n as usize,
        _ => {
            let range =
                if boxes.starts_with(b"-") || count == Some(0) { "1 or more" } else { "at most 4294967295" };
            let found = quoted(boxes);
            return Line::Wrong(
                boxes_at,
                Problem::new(format!("expected a number of boxes, {range}, found {found}")),
            );
        }
    };
    let body = match length {
        Some((_, length)) if LENGTHS.contains(&length) => Body::Chain { length },
        Some((at, length)) if length > 0.0 => {
            let range = "a length of a box from 1e-9 to 1e9";
            return Line::Wrong(at, Problem::new(format!("expected {range}, found {length:e}")));
        }
        Some((at, length)) => {
            return Line::Wrong(
                at,
                Problem::new(format!("expected a positive length of a box, found {length}")),
            );
        }
        None if boxes == 1 => Body::Free,
        None => {
            let problem =
                Problem::new(format!("expected the length of a box after the number of boxes, {boxes}"));
            return Line::Wrong(end, problem.hint("only '# 1', one free body, may lack it"));
        }
    };
    Line::Header(Header { boxes, body, order, boxes_at })
}

fn is_whole(word: &[u8]) -> bool {
    let digits = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)
}

/// Whether someone meant a number: `3,0`, `nan`, `1e999`.
pub(super) fn looks_like_a_number(word: &[u8]) -> bool {
    let dotted: Vec<u8> = word.iter().map(|&b| if b == b',' { b'.' } else { b }).collect();
    fast_float2::parse::<f64, _>(&dotted).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(text: &str) -> (usize, Body, Option<Order>) {
        match parse(text.as_bytes()) {
            Line::Header(h) => (h.boxes, h.body, h.order),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn headers() {
        let chain = |length| Body::Chain { length };
        assert_eq!(header("# 4 3.000000"), (4, chain(3.0), None));
        assert_eq!(header("#4 3"), (4, chain(3.0), None));
        assert_eq!(header("  #\t16 .5 xyzw"), (16, chain(0.5), Some(Order::Xyzw)));
        assert_eq!(header("# 1 1.0 xyzw"), (1, chain(1.0), Some(Order::Xyzw)));
        assert_eq!(header("# 1"), (1, Body::Free, None));
        assert_eq!(header("# 1 wxyz"), (1, Body::Free, Some(Order::Wxyz)));
    }

    #[test]
    fn comments() {
        for text in ["#", "# made by hand", "# 2026-11-22", "# 4.5 3", "# wxyz 4", "## 4 3"] {
            assert_eq!(parse(text.as_bytes()), Line::Comment(None), "{text}");
        }
        for (text, at) in [
            ("# 4 boxes", 4),
            ("# 4 3.0 wxzy", 8),
            ("# 4 3 2 xyzw", 6),
            ("# 4 xyzw 3", 9),
            ("# 2 boxes of length 3", 4),
        ] {
            match parse(text.as_bytes()) {
                Line::Comment(Some((place, _))) => assert_eq!(place, at, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    #[test]
    fn mistakes() {
        let wrong = |text: &str| match parse(text.as_bytes()) {
            Line::Wrong(at, problem) => (at, problem.text),
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(wrong("# 0 3.0").0, 2);
        assert_eq!(wrong("# -4 3.0").1, "expected a number of boxes, 1 or more, found '-4'");
        assert_eq!(wrong("# 99999999999999999999999 3.0").0, 2);
        assert_eq!(wrong("# 4 -3").1, "expected a positive length of a box, found -3");
        assert_eq!(wrong("# 4 0.0").0, 4);
        assert_eq!(wrong("# 4 1e39").1, "expected a length of a box from 1e-9 to 1e9, found 1e39");
        assert_eq!(wrong("# 4 1e-60").0, 4);
        assert_eq!(wrong("# 4 nan").1, "expected a finite number, found 'nan'");
        assert_eq!(wrong("# 4 3,0").0, 4);
        assert_eq!(wrong("# 4").0, 3);
        assert_eq!(wrong("# 4 wxyz").0, 8);
    }
}

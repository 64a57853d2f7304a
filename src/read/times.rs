//! Times of keys: seconds since the first, strictly increasing.

use super::refusal::Problem;
use super::words::{quoted, skip_space, words};

/// The next key's time since the first, which is at `start`; `before` is the time since
/// the first of the key before it, which stands in the line `line`. `text` holds the time
/// as its first word; both are asked for only where something is wrong.
#[inline]
pub(super) fn next<'a>(
    start: f64,
    before: Option<f64>,
    time: f64,
    line: impl FnOnce() -> usize,
    text: impl FnOnce() -> &'a [u8],
) -> Result<f64, Problem> {
    let t = time - start;
    let (expected, hint) = match before {
        None => return Ok(t),
        Some(_) if !t.is_finite() => {
            let expected = format!("expected a time less than 1.8e308 s after the first, {start:e}");
            (expected, "no number can hold the time between them")
        }
        Some(before) if t > before => return Ok(t),
        Some(before) if time > start + before => {
            let expected = format!("expected a time that float64 can tell from the one in line {}", line());
            (expected, "times are counted from the first: one that is far away blurs all others")
        }
        Some(before) => {
            let expected = format!("expected a time later than {} in line {}", start + before, line());
            (expected, "times must increase from row to row")
        }
    };
    let text = text();
    let from = skip_space(text, 0);
    let found = words(&text[from..]).next().map_or_else(String::new, |(_, word)| quoted(word));
    Err(Problem::new(format!("{expected}, found {found}")).hint(hint))
}

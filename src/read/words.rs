//! Words and numbers of a line, with their places.

use super::decimal;
use super::refusal::Problem;

/// What separates words. A carriage return within a line is white space too.
#[inline]
fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\x0b' | b'\x0c')
}

/// The first byte at or after `from` that is no white space, or the line's end.
#[inline]
pub(super) fn skip_space(line: &[u8], from: usize) -> usize {
    line[from..].iter().position(|&b| !is_space(b)).map_or(line.len(), |n| from + n)
}

/// The end of the word that begins at `from`.
fn word_end(line: &[u8], from: usize) -> usize {
    line[from..].iter().position(|&b| is_space(b)).map_or(line.len(), |n| from + n)
}

/// The words of a line, each with the byte at which it begins.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = skip_space(line, from);
        from = word_end(line, start);
        (start < from).then(|| (start, &line[start..from]))
    })
}

/// The finite number that begins at `from`, and where it ends.
// A call and its result in memory would cost as much as the number.
#[inline(always)]
pub(super) fn number(line: &[u8], from: usize) -> Result<(f64, usize), Problem> {
    match decimal::plain(line, from) {
        Some((value, end)) if line.get(end).is_none_or(|&b| is_space(b)) => Ok((value, end)),
        _ => any_number(line, from),
    }
}

/// The same in any notation.
#[cold]
fn any_number(line: &[u8], from: usize) -> Result<(f64, usize), Problem> {
    if let Ok((value, length)) = fast_float2::parse_partial::<f64, _>(&line[from..]) {
        let end = from + length;
        if value.is_finite() && line.get(end).is_none_or(|&b| is_space(b)) {
            return Ok((value, end));
        }
    }
    let end = word_end(line, from);
    unusual_number(&line[from..end]).map(|value| (value, end))
}

/// A word as a finite number in a spelling that the fast path does not know: Fortran's
/// `1.0D+00`, or a leading plus.
fn unusual_number(word: &[u8]) -> Result<f64, Problem> {
    let plain = word.strip_prefix(b"+").filter(|rest| !rest.starts_with(b"-")).unwrap_or(word);
    let plain: Vec<u8> = plain.iter().map(|&b| if matches!(b, b'd' | b'D') { b'e' } else { b }).collect();
    match fast_float2::parse::<f64, _>(&plain) {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(not_finite(word)),
        Err(_) => Err(no_number(word)),
    }
}

fn not_finite(word: &[u8]) -> Problem {
    let found = quoted(word);
    if word.iter().any(u8::is_ascii_digit) {
        Problem::new(format!("expected a number of at most 1.8e308, found {found}"))
    } else {
        Problem::new(format!("expected a finite number, found {found}"))
    }
}

fn no_number(word: &[u8]) -> Problem {
    if let Err(error) = std::str::from_utf8(word) {
        let byte = word[error.valid_up_to()];
        return not_utf8(byte);
    }
    let problem = Problem::new(format!("expected a number, found {}", quoted(word)));
    let text = String::from_utf8_lossy(word);
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    if text.contains(',') && is_number(&text.replacen(',', ".", 1)) && !text.ends_with(',') {
        problem.hint(format!("decimal comma: write {}", text.replacen(',', ".", 1)))
    } else if text.split([',', ';']).all(|part| part.is_empty() || is_number(part)) {
        problem.hint("numbers are separated by spaces or tabs, not by commas or semicolons")
    } else if is_number(&text.replace('\u{2212}', "-")) {
        problem.hint("the minus sign is the hyphen of the keyboard, '-'")
    } else if text.starts_with('#') {
        problem.hint("a comment stands on a line of its own")
    } else {
        problem
    }
}

/// The problem of a byte that is no UTF-8.
pub(super) fn not_utf8(byte: u8) -> Problem {
    Problem::new(format!("expected UTF-8 text, found the byte 0x{byte:02X}"))
        .hint("save the file as UTF-8; is it a .dat file at all?")
}

/// A word in quotes, cut when it is long.
pub(super) fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(word);
    let mut short: String = text.chars().take(40).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    format!("'{}'", short.escape_debug().to_string().replace("\\'", "'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_float_notation() {
        let cases = [
            ("1", 1.0),
            ("-1.", -1.0),
            (".5", 0.5),
            ("+0.5", 0.5),
            ("1E-3", 1e-3),
            ("1e+3", 1e3),
            ("-5.473870e-01", -0.547387),
            ("1.0D+00", 1.0),
            ("2d-1", 0.2),
            ("-0", 0.0),
            ("1e-400", 0.0),
            ("00012", 12.0),
            ("0.1000000000000000055511151231257827", 0.1),
            ("5e-324", 5e-324),
        ];
        for (text, value) in cases {
            let line = format!("  {text}\t9");
            assert_eq!(number(line.as_bytes(), 2), Ok((value, 2 + text.len())), "{text}");
        }
    }

    #[test]
    fn no_numbers() {
        let text = |word: &str| {
            let problem = number(word.as_bytes(), 0).unwrap_err();
            format!("{} | {}", problem.text, problem.hint.unwrap_or_default())
        };
        assert_eq!(text("nan"), "expected a finite number, found 'nan' | ");
        assert_eq!(text("-inf"), "expected a finite number, found '-inf' | ");
        assert_eq!(text("1e999"), "expected a number of at most 1.8e308, found '1e999' | ");
        assert_eq!(text("0,64"), "expected a number, found '0,64' | decimal comma: write 0.64");
        assert!(text("0.64,").contains("not by commas"));
        assert!(text("1,2,3").contains("not by commas"));
        assert!(text("\u{2212}0.5").contains("hyphen"));
        assert!(text("#").contains("line of its own"));
        assert_eq!(text("abc"), "expected a number, found 'abc' | ");
        assert_eq!(text("1.5x"), "expected a number, found '1.5x' | ");
        assert_eq!(text("+-1"), "expected a number, found '+-1' | ");
        assert!(number(b"1\xff", 0).unwrap_err().text.contains("0xFF"));
        assert!(text(&"y".repeat(100)).contains("yyy…'"));
    }

    #[test]
    fn words_have_places() {
        let found: Vec<_> = words(b" a\tbc \r").collect();
        assert_eq!(found, [(1, b"a".as_slice()), (3, b"bc")]);
    }
}

//! Why and where an input is refused, as a compiler would say it.

use std::fmt;

/// The first problem of an input: place, expected, found, what to do.
///
/// Displayed as `FILE:LINE:COLUMN: problem`, the line, a caret, and the hint. Lines and
/// columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Refusal {
    /// The input's name.
    pub source_name: String,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// What was expected and what was found.
    pub problem: String,
    /// What to do, where there is advice.
    pub hint: Option<String>,
    excerpt: Excerpt,
}

/// The part of the line around the place, and how far the place is from its start.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Excerpt {
    text: String,
    /// White space as wide as what stands before the place.
    indent: String,
}

/// How many characters are shown on either side of the place.
const CONTEXT: usize = 60;

impl Refusal {
    /// A refusal of what stands at byte `offset` of the text of a line.
    pub(super) fn new(
        source_name: &str,
        line: usize,
        text: &[u8],
        offset: usize,
        problem: Problem,
    ) -> Refusal {
        let offset = offset.min(text.len());
        let (before, after) = (shown(&text[..offset]), shown(&text[offset..]));
        Refusal {
            source_name: source_name.to_owned(),
            line,
            column: before.chars().count() + 1,
            problem: problem.text,
            hint: problem.hint,
            excerpt: Excerpt::around(&before, &after),
        }
    }
}

impl Excerpt {
    fn around(before: &str, after: &str) -> Excerpt {
        let skipped = before.chars().count().saturating_sub(CONTEXT);
        let mut left: String = before.chars().skip(skipped).collect();
        if skipped > 0 {
            left.insert(0, '…');
        }
        let mut right: String = after.chars().take(CONTEXT).collect();
        if right.len() < after.len() {
            right.push('…');
        }
        let indent = left.chars().map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
        Excerpt { text: left + &right, indent }
    }
}

/// Bytes as they can be shown: invalid UTF-8 and control characters replaced.
fn shown(bytes: &[u8]) -> String {
    let visible = |c: char| if c.is_control() && c != '\t' { '\u{fffd}' } else { c };
    String::from_utf8_lossy(bytes).chars().map(visible).collect()
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Refusal { source_name, line, column, problem, excerpt, .. } = self;
        write!(f, "{source_name}:{line}:{column}: {problem}")?;
        if !excerpt.text.is_empty() {
            write!(f, "\n  {}\n  {}^", excerpt.text, excerpt.indent)?;
        }
        match &self.hint {
            Some(hint) => write!(f, "\n  {hint}"),
            None => Ok(()),
        }
    }
}

/// What is wrong, without its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) text: String,
    pub(super) hint: Option<String>,
}

impl Problem {
    pub(super) fn new(text: impl Into<String>) -> Problem {
        Problem { text: text.into(), hint: None }
    }

    pub(super) fn hint(self, hint: impl Into<String>) -> Problem {
        Problem { hint: Some(hint.into()), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &[u8], offset: usize) -> Refusal {
        Refusal::new("arm.dat", 7, text, offset, Problem::new("expected a number, found 'x'").hint("try 1"))
    }

    #[test]
    fn place_line_caret_and_hint() {
        let shown = at("1 \t x".as_bytes(), 4).to_string();
        assert_eq!(shown, "arm.dat:7:5: expected a number, found 'x'\n  1 \t x\n    \t ^\n  try 1");
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(at("äö x".as_bytes(), 5).column, 4);
        assert_eq!(at(b"\xff\xfe x", 3).column, 4);
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let text = "1 ".repeat(1000);
        let refusal = at(text.as_bytes(), 1000);
        assert_eq!(refusal.column, 1001);
        let lines: Vec<String> = refusal.to_string().lines().map(str::to_owned).collect();
        assert!(lines[1].chars().count() < 130);
        assert_eq!(lines[2].chars().count(), 2 + 1 + CONTEXT + 1);
    }
}

//! Where the parts of a JSON text are, and changes to some of them that leave the others
//! as they were written: the order of members, the spelling of numbers, spaces.
//!
//! The text is known to be JSON: another parser has read it. Of text that is not, parts
//! come out as missing.

use std::ops::Range;

/// The bytes of a value.
pub(super) type Span = Range<usize>;

/// A member of an object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Member {
    pub(super) key: String,
    /// From its key to the end of its value.
    pub(super) whole: Span,
    pub(super) value: Span,
}

/// The root value of a text.
pub(super) fn root(text: &str) -> Option<Span> {
    let mut at = Cursor { text: text.as_bytes(), at: 0 };
    at.value()
}

/// The members of an object, in their order.
pub(super) fn members(text: &str, object: &Span) -> Option<Vec<Member>> {
    let mut at = Cursor { text: text.get(..object.end)?.as_bytes(), at: object.start };
    let mut members = Vec::new();
    at.list(b'{', b'}', |at| {
        let key = at.string()?;
        at.skip(b':')?;
        let value = at.value()?;
        let name = serde_json::from_str(text.get(key.clone())?).ok()?;
        members.push(Member { key: name, whole: key.start..value.end, value });
        Some(())
    })?;
    Some(members)
}

/// The elements of an array.
pub(super) fn elements(text: &str, array: &Span) -> Option<Vec<Span>> {
    let mut at = Cursor { text: text.get(..array.end)?.as_bytes(), at: array.start };
    let mut elements = Vec::new();
    at.list(b'[', b']', |at| {
        elements.push(at.value()?);
        Some(())
    })?;
    Some(elements)
}

/// The value of an object's member; of several of one name the last, as parsers have it.
pub(super) fn member(text: &str, object: &Span, key: &str) -> Option<Span> {
    members(text, object)?.into_iter().rev().find(|member| member.key == key).map(|member| member.value)
}

struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    fn spaces(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    /// Steps over spaces and one character.
    fn skip(&mut self, character: u8) -> Option<()> {
        self.spaces();
        (self.text.get(self.at) == Some(&character)).then(|| self.at += 1)
    }

    /// What stands between two brackets, each part by `part`.
    fn list(&mut self, open: u8, close: u8, mut part: impl FnMut(&mut Self) -> Option<()>) -> Option<()> {
        self.skip(open)?;
        if self.skip(close).is_some() {
            return Some(());
        }
        loop {
            part(self)?;
            if self.skip(close).is_some() {
                return Some(());
            }
            self.skip(b',')?;
        }
    }

    fn string(&mut self) -> Option<Span> {
        self.spaces();
        let start = self.at;
        self.skip(b'"')?;
        loop {
            match self.text.get(self.at)? {
                b'"' => break,
                b'\\' => self.at += 2,
                _ => self.at += 1,
            }
        }
        self.at += 1;
        Some(start..self.at)
    }

    fn value(&mut self) -> Option<Span> {
        self.spaces();
        let start = self.at;
        match self.text.get(start)? {
            b'"' => self.string().map(drop)?,
            b'{' | b'[' => self.nested()?,
            _ => {
                let ends = |b: &u8| b.is_ascii_whitespace() || b",]}".contains(b);
                self.at += self.text[start..].iter().position(ends).unwrap_or(self.text.len() - start);
            }
        }
        Some(start..self.at)
    }

    /// Steps over an object or an array; their depth costs no stack.
    fn nested(&mut self) -> Option<()> {
        let mut depth = 0usize;
        loop {
            match self.text.get(self.at)? {
                b'"' => {
                    self.string()?;
                    continue;
                }
                b'{' | b'[' => depth += 1,
                b'}' | b']' => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return Some(());
            }
        }
    }
}

/// Changes to a text.
#[derive(Debug, Default)]
pub(super) struct Edits(Vec<(Span, String)>);

impl Edits {
    /// Puts a text in the place of another.
    pub(super) fn replace(&mut self, span: Span, by: String) {
        self.0.push((span, by));
    }

    /// Adds elements at the end of an array.
    pub(super) fn append(&mut self, text: &str, array: &Span, new: &[String]) -> Option<()> {
        let spans = elements(text, array)?;
        let (at, mut added) = match spans.last() {
            Some(last) => (last.end, String::new()),
            None => (array.start + 1, String::new()),
        };
        let between = match &spans[..] {
            [.., a, b] => text.get(a.end..b.start)?,
            _ => ",",
        };
        for (i, element) in new.iter().enumerate() {
            if i > 0 || !spans.is_empty() {
                added += between;
            }
            added += element;
        }
        self.replace(at..at, added);
        Some(())
    }

    /// The text with all changes, which must not overlap.
    pub(super) fn apply(mut self, text: &str) -> Option<String> {
        self.0.sort_by_key(|(span, _)| (span.start, span.end));
        let mut out = String::with_capacity(text.len());
        let mut at = 0;
        for (span, by) in &self.0 {
            out += text.get(at..span.start)?;
            out += by;
            at = span.end;
        }
        out += text.get(at..)?;
        Some(out)
    }
}

/// Changes to the members of one object.
#[derive(Debug, Default)]
pub(super) struct Changes(Vec<(&'static str, Option<String>)>);

impl Changes {
    /// Gives a member a value, as JSON; a new one goes to the end.
    pub(super) fn set(&mut self, key: &'static str, value: impl ToString) {
        self.0.push((key, Some(value.to_string())));
    }

    /// Whether nothing changes.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes a member out.
    pub(super) fn remove(&mut self, key: &'static str) {
        self.0.push((key, None));
    }

    /// The object's text with these changes; all else stays as it was written.
    pub(super) fn apply(self, text: &str, object: &Span) -> Option<String> {
        let old = members(text, object)?;
        let first = old.first().map_or(object.start + 1, |member| member.whole.start);
        let mut out = text.get(object.start..first)?.to_owned();
        let mut any = false;
        for (i, member) in old.iter().enumerate() {
            let change = self.0.iter().find(|(key, _)| *key == member.key);
            if let Some((_, None)) = change {
                continue;
            }
            if any {
                out += text.get(old[i - 1].whole.end..member.whole.start)?;
            }
            any = true;
            match change {
                Some((_, Some(value))) if !same(text.get(member.value.clone())?, value) => {
                    out += text.get(member.whole.start..member.value.start)?;
                    out += value;
                }
                _ => out += text.get(member.whole.clone())?,
            }
        }
        let (between, colon) = match &old[..] {
            [a, b, ..] => (text.get(a.whole.end..b.whole.start)?, colon(text, a)?),
            [a] => (",", colon(text, a)?),
            [] => (",", ":"),
        };
        for (key, value) in &self.0 {
            let Some(value) = value else { continue };
            if old.iter().all(|member| member.key != *key) {
                if any {
                    out += between;
                }
                any = true;
                out += &format!("\"{key}\"{colon}{value}");
            }
        }
        let last = old.last().map_or(object.start + 1, |member| member.whole.end);
        out += text.get(last..object.end)?;
        Some(out)
    }
}

/// Whether two texts stand for the same value: then the older spelling stays.
fn same(old: &str, new: &str) -> bool {
    let parsed = |text: &str| serde_json::from_str::<serde_json::Value>(text).ok().map(as_numbers);
    old == new || parsed(old).is_some_and(|old| Some(old) == parsed(new))
}

/// Numbers compared by value: 0 and 0.0 are one.
fn as_numbers(value: serde_json::Value) -> serde_json::Value {
    match value {
        serde_json::Value::Number(n) => n.as_f64().map_or(serde_json::Value::Null, Into::into),
        serde_json::Value::Array(all) => all.into_iter().map(as_numbers).collect(),
        other => other,
    }
}

/// What stands between a member's key and its value.
fn colon<'a>(text: &'a str, member: &Member) -> Option<&'a str> {
    let head = text.get(member.whole.start..member.value.start)?;
    head.get(head.rfind(':')?..).map(|colon| if colon.trim() == ":" { colon } else { ":" })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "{ \"a\" : [1.50, {\"x\":\"}\\\"]\"} ,\n\t-0.0e0],\"b\":{},\"\\u0063\": null }  ";

    fn texts(spans: &[Span]) -> Vec<&'static str> {
        spans.iter().map(|span| &TEXT[span.clone()]).collect()
    }

    #[test]
    fn parts_are_where_they_stand() {
        let root = root(TEXT).unwrap();
        assert_eq!(root, 0..TEXT.len() - 2);
        let members = members(TEXT, &root).unwrap();
        let keys: Vec<&str> = members.iter().map(|member| member.key.as_str()).collect();
        assert_eq!(keys, ["a", "b", "c"]);
        assert_eq!(
            texts(&[members[2].whole.clone(), members[2].value.clone()]),
            ["\"\\u0063\": null", "null"]
        );
        let elements = elements(TEXT, &members[0].value).unwrap();
        assert_eq!(texts(&elements), ["1.50", "{\"x\":\"}\\\"]\"}", "-0.0e0"]);
        assert_eq!(super::elements(TEXT, &members[1].value), None);
        assert_eq!(super::members(TEXT, &members[1].value), Some(Vec::new()));
    }

    #[test]
    fn broken_text_has_no_parts() {
        for text in ["", "{", "{\"a\"", "{\"a\":", "{\"a\":1", "{\"a\" 1}", "[1", "[\"", "[\"\\"] {
            let whole = 0..text.len();
            assert!(members(text, &whole).is_none() && elements(text, &whole).is_none(), "{text}");
        }
    }

    #[test]
    fn changes_leave_the_rest() {
        let change = |text: &str| {
            let mut changes = Changes::default();
            changes.set("count", 7);
            changes.set("max", "[1.0]");
            changes.remove("sparse");
            changes.set("new", "\"x\"");
            changes.apply(text, &(0..text.len())).unwrap()
        };
        assert_eq!(change("{}"), r#"{"count":7,"max":[1.0],"new":"x"}"#);
        assert_eq!(change("{ }"), r#"{"count":7,"max":[1.0],"new":"x" }"#);
        assert_eq!(
            change("{ \"sparse\" : {} , \"k\" : 1.0e0, \"count\" : 9,\n\"max\" : [ 1.00 ] }"),
            "{ \"k\" : 1.0e0, \"count\" : 7,\n\"max\" : [ 1.00 ] , \"new\": \"x\" }"
        );
        assert_eq!(change("{\"count\":7.0,\"sparse\":0}"), "{\"count\":7.0,\"max\":[1.0],\"new\":\"x\"}");
    }

    #[test]
    fn edits_come_in_any_order() {
        let text = "[1,  [ ], {}]";
        let mut edits = Edits::default();
        let spans = elements(text, &(0..text.len())).unwrap();
        edits.append(text, &(0..text.len()), &["8".into(), "9".into()]).unwrap();
        edits.replace(spans[2].clone(), "{\"a\":0}".into());
        edits.append(text, &spans[1], &["5".into(), "6".into()]).unwrap();
        assert_eq!(edits.apply(text).unwrap(), "[1,  [5,6 ], {\"a\":0}, 8, 9]");
    }
}

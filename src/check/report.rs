//! What a check found.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Serialize, Serializer};

use super::code::{Code, Severity};

/// One thing that a check found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// What kind of finding it is.
    pub code: Code,
    /// How serious it is: its code's severity.
    pub severity: Severity,
    /// Where in the file.
    #[serde(flatten)]
    pub place: Place,
    /// What was expected, what was found, what to do.
    pub message: String,
}

/// Where in a file something was found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Place {
    /// A JSON pointer (RFC 6901).
    Pointer(String),
    /// Bytes from the beginning of the file.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Pointer(pointer) if pointer.is_empty() => f.write_str("the JSON's root"),
            Place::Pointer(pointer) => f.write_str(pointer),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

impl From<String> for Place {
    fn from(pointer: String) -> Self {
        Place::Pointer(pointer)
    }
}

impl From<&str> for Place {
    fn from(pointer: &str) -> Self {
        Place::Pointer(pointer.to_owned())
    }
}

impl From<u64> for Place {
    fn from(byte: u64) -> Self {
        Place::Byte(byte)
    }
}

/// All that a check found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    findings: Vec<Finding>,
    counts: BTreeMap<Code, u64>,
}

/// Findings of one code that are kept; beyond these they are only counted, so
/// that a file with a million broken objects does not make a million lines.
const KEPT: u64 = 100;

impl Report {
    /// Adds a finding.
    pub fn add(&mut self, code: Code, place: impl Into<Place>, message: impl Into<String>) {
        self.extend([Finding {
            code,
            severity: code.severity(),
            place: place.into(),
            message: message.into(),
        }]);
    }

    /// The findings, in the order of the file's layers. Of each code the
    /// first hundred are kept; see [`Report::count_of`].
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The findings that were kept.
    pub(super) fn into_findings(self) -> Vec<Finding> {
        self.findings
    }

    /// The most serious severity among the findings.
    pub fn worst(&self) -> Option<Severity> {
        self.counts.keys().map(|code| code.severity()).max()
    }

    /// How many findings are of this severity.
    pub fn count(&self, severity: Severity) -> u64 {
        let of_it = self.counts.iter().filter(|(code, _)| code.severity() == severity);
        of_it.map(|(_, count)| count).sum()
    }

    /// How many findings have this code.
    pub fn count_of(&self, code: Code) -> u64 {
        self.counts.get(&code).copied().unwrap_or(0)
    }

    /// Findings that were counted but not kept, by code.
    pub(crate) fn left_out(&self) -> impl Iterator<Item = (Code, u64)> {
        let beyond = |(&code, &count): (&Code, &u64)| (count > KEPT).then(|| (code, count - KEPT));
        self.counts.iter().filter_map(beyond)
    }

    /// The report for machines.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "schema": 1,
            "errors": self.count(Severity::Error),
            "warnings": self.count(Severity::Warning),
            "infos": self.count(Severity::Info),
            "findings": self.findings,
            "leftOut": self.left_out().map(|(code, n)| (code.to_string(), n)).collect::<BTreeMap<_, _>>(),
        })
    }

    /// The report for people, a line a finding, each beginning with the name
    /// of the file.
    pub fn text(&self, file: &str) -> String {
        let mut lines = String::new();
        for finding in &self.findings {
            let Finding { code, severity, place, message } = finding;
            lines += &format!("{file}: {severity} {code} at {place}: {message}\n");
        }
        for (code, count) in self.left_out() {
            let severity = code.severity();
            lines += &format!("{file}: {severity} {code}: and {count} more of this kind\n");
        }
        lines
    }
}

impl Extend<Finding> for Report {
    fn extend<I: IntoIterator<Item = Finding>>(&mut self, findings: I) {
        for finding in findings {
            let count = self.counts.entry(finding.code).or_default();
            *count += 1;
            if *count <= KEPT {
                self.findings.push(finding);
            }
        }
    }
}

impl Serialize for Report {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_json().serialize(serializer)
    }
}

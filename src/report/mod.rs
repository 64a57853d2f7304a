//! Findings in the forms that other programs read.
//!
//! A [`Run`] holds what one call of a tool found in each of its files. [`Run::github`],
//! [`Run::junit`] and [`Run::sarif`] write all of it as one document; docs/reports.md
//! says which part of it goes where. Text and JSON have a line or an object a file and
//! more in them than findings: those are for each command to write.

mod github;
mod junit;
mod sarif;
#[cfg(test)]
mod tests;

use crate::check::{Code, Report, Severity};

/// How a report is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Lines for people.
    #[default]
    Text,
    /// A JSON object a file, a line each.
    Json,
    /// Workflow commands of GitHub Actions, which become annotations.
    Github,
    /// JUnit's XML, which most CI services show as tests.
    Junit,
    /// SARIF 2.1.0, for code scanning and editors.
    Sarif,
}

impl Format {
    /// All of them.
    pub const ALL: &[Format] = &[Format::Text, Format::Json, Format::Github, Format::Junit, Format::Sarif];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Format::Text => "text",
            Format::Json => "json",
            Format::Github => "github",
            Format::Junit => "junit",
            Format::Sarif => "sarif",
        }
    }

    /// What it is, in a few words.
    pub fn summary(self) -> &'static str {
        match self {
            Format::Text => "human-readable",
            Format::Json => "JSON Lines, one object per file",
            Format::Github => "GitHub Actions annotations",
            Format::Junit => "JUnit XML",
            Format::Sarif => "SARIF 2.1.0",
        }
    }

    /// The format of that name.
    pub fn from_name(name: &str) -> Option<Format> {
        Format::ALL.iter().copied().find(|format| format.name() == name)
    }
}

/// A file, and what was found in it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Its path as the user gave it.
    pub file: String,
    /// What was found, or why the file could not be looked at.
    pub outcome: Result<Report, String>,
}

/// All that one call of a tool found.
#[derive(Clone, Debug)]
pub struct Run {
    /// The command: `check`, `diff`.
    pub command: &'static str,
    /// Its files, in the order given.
    pub subjects: Vec<Subject>,
    /// Findings at least this serious fail the run.
    pub fails_from: Severity,
    /// The exit code.
    pub exit: u8,
}

impl Run {
    /// The run as a document of this format; None for text and JSON.
    pub fn document(&self, format: Format) -> Option<String> {
        match format {
            Format::Github => Some(self.github()),
            Format::Junit => Some(self.junit()),
            Format::Sarif => Some(self.sarif()),
            Format::Text | Format::Json => None,
        }
    }
}

/// A finding as the formats share it, also for those that were only counted.
struct Line {
    code: Code,
    /// Where, in words; nowhere for what was only counted.
    place: Option<crate::check::Place>,
    message: String,
}

impl Line {
    /// Place and message in one.
    fn text(&self) -> String {
        match &self.place {
            Some(place) => format!("{place}: {}", self.message),
            None => self.message.clone(),
        }
    }
}

/// The findings of a report, and how many of a kind were left out.
fn lines(report: &Report) -> Vec<Line> {
    let found = report.findings().iter().map(|finding| Line {
        code: finding.code,
        place: Some(finding.place.clone()),
        message: finding.message.clone(),
    });
    let counted = report.left_out().map(|(code, count)| Line {
        code,
        place: None,
        message: format!("and {count} more of this kind"),
    });
    found.chain(counted).collect()
}

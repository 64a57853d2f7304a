//! Workflow commands: lines on standard output that GitHub Actions turns into
//! annotations of files.

use super::{Run, lines};
use crate::check::Severity;

impl Run {
    /// The run as workflow commands, a line each.
    pub fn github(&self) -> String {
        let mut commands = String::new();
        for subject in &self.subjects {
            match &subject.outcome {
                Ok(report) => {
                    for line in lines(report) {
                        let level = level(line.code.severity());
                        commands += &command(level, &subject.file, line.code.as_str(), &line.text());
                    }
                }
                Err(reason) => commands += &command("error", &subject.file, "cannot be read", reason),
            }
        }
        commands
    }
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "notice",
    }
}

fn command(level: &str, file: &str, title: &str, message: &str) -> String {
    format!("::{level} file={},title={}::{}\n", property(file), property(title), data(message))
}

/// A message: what would end the line, or begin an escape, is escaped.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// A property's value, which a colon or a comma would end as well.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

//! JUnit's XML as Jenkins, GitLab and others read it: a test suite a file, in it a test
//! case for reading the file and one for each kind of finding.

use super::{Line, Run, Subject, lines};
use crate::check::{Code, Severity};
use std::fmt::Write;

/// How many test cases there are, and how they went.
#[derive(Clone, Copy, Default)]
struct Counts {
    tests: usize,
    failures: usize,
    errors: usize,
}

impl Run {
    /// The run as JUnit XML. A kind of finding that fails the run is a failed test, any
    /// other a passed one that says something; a file that cannot be read is an error.
    pub fn junit(&self) -> String {
        let (mut suites, mut all) = (String::new(), Counts::default());
        for subject in &self.subjects {
            let (cases, counts) = cases(subject, self.fails_from);
            let name = escaped(&subject.file);
            suites +=
                &format!("  <testsuite name=\"{name}\" {}>\n{cases}  </testsuite>\n", attributes(counts));
            all.tests += counts.tests;
            all.failures += counts.failures;
            all.errors += counts.errors;
        }
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"dat2glb {}\" {}>\n{suites}</testsuites>\n",
            escaped(self.command),
            attributes(all)
        )
    }
}

fn attributes(Counts { tests, failures, errors }: Counts) -> String {
    format!("tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\"")
}

fn cases(subject: &Subject, fails_from: Severity) -> (String, Counts) {
    let class = escaped(&subject.file);
    let mut counts = Counts { tests: 1, ..Counts::default() };
    let report = match &subject.outcome {
        Ok(report) => report,
        Err(reason) => {
            counts.errors = 1;
            let (first, reason) = (escaped(reason.lines().next().unwrap_or_default()), escaped(reason));
            let case = format!(
                "    <testcase classname=\"{class}\" name=\"can be read\">\n      <error message=\"{first}\" \
                 type=\"refused\">{reason}</error>\n    </testcase>\n"
            );
            return (case, counts);
        }
    };
    let mut cases = format!("    <testcase classname=\"{class}\" name=\"can be read\"/>\n");
    let lines = lines(report);
    for code in Code::ALL.iter().filter(|&&code| lines.iter().any(|line| line.code == code)) {
        let fails = code.severity() >= fails_from;
        let of_it: Vec<&Line> = lines.iter().filter(|line| line.code == *code).collect();
        let text: Vec<String> = of_it.iter().map(|line| line.text()).collect();
        let text = escaped(&text.join("\n"));
        let _ = writeln!(cases, "    <testcase classname=\"{class}\" name=\"{code}\">");
        if fails {
            let meaning = escaped(code.meaning());
            let _ = writeln!(cases, "      <failure message=\"{meaning}\" type=\"{code}\">{text}</failure>");
        } else {
            let _ = writeln!(cases, "      <system-out>{}: {text}</system-out>", code.severity());
        }
        cases += "    </testcase>\n";
        counts.tests += 1;
        counts.failures += usize::from(fails);
    }
    (cases, counts)
}

/// Text as it stands in XML 1.0, between tags or quotes. Characters that XML cannot hold
/// at all become U+FFFD.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => {
                let _ = write!(out, "&#{};", u32::from(c));
            }
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

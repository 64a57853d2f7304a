//! SARIF 2.1.0 (OASIS), the static analysis results interchange format.

use super::{Line, Run, Subject, lines};
use crate::check::{Code, Place, Severity};
use serde_json::{Value, json};

/// Where the schema of the format is published.
const SCHEMA: &str =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";

impl Run {
    /// The run as a SARIF log. Each code of the catalogue is a rule.
    pub fn sarif(&self) -> String {
        let results: Vec<Value> = self.subjects.iter().flat_map(results).collect();
        let unread: Vec<Value> = self.subjects.iter().filter_map(notification).collect();
        let invocation = json!({
            "executionSuccessful": unread.is_empty(),
            "exitCode": self.exit,
            "toolExecutionNotifications": unread,
        });
        let driver = json!({
            "name": "dat2glb",
            "version": env!("CARGO_PKG_VERSION"),
            "rules": Code::ALL.iter().map(|&code| rule(code)).collect::<Vec<_>>(),
        });
        let log = json!({
            "$schema": SCHEMA,
            "version": "2.1.0",
            "runs": [{
                "tool": {"driver": driver},
                "automationDetails": {"id": format!("dat2glb/{}/", self.command)},
                "invocations": [invocation],
                "results": results,
            }],
        });
        format!("{log:#}\n")
    }
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "note",
    }
}

fn rule(code: Code) -> Value {
    let page = format!("docs/checks.md#{}", code.anchor());
    json!({
        "id": code.as_str(),
        "shortDescription": {"text": code.meaning()},
        "help": {
            "text": format!("{} See {page} of dat2glb.", code.meaning()),
            "markdown": format!("{} See `{page}` of dat2glb.", code.meaning()),
        },
        "defaultConfiguration": {"level": level(code.severity())},
    })
}

fn results(subject: &Subject) -> Vec<Value> {
    let lines = subject.outcome.as_ref().map(lines).unwrap_or_default();
    lines.iter().map(|line| result(&subject.file, line)).collect()
}

fn result(file: &str, line: &Line) -> Value {
    json!({
        "ruleId": line.code.as_str(),
        "ruleIndex": Code::ALL.iter().position(|&code| code == line.code),
        "level": level(line.code.severity()),
        "message": {"text": line.text()},
        "locations": [location(file, line.place.as_ref())],
    })
}

fn location(file: &str, place: Option<&Place>) -> Value {
    let mut location = json!({"physicalLocation": {"artifactLocation": {"uri": uri(file)}}});
    match place {
        // The root of the JSON is the file.
        Some(Place::Pointer(pointer)) if !pointer.is_empty() => {
            let name = pointer.rsplit('/').next().unwrap_or_default();
            location["logicalLocations"] = json!([{"name": name, "fullyQualifiedName": pointer}]);
        }
        Some(Place::Byte(byte)) => {
            location["physicalLocation"]["region"] = json!({"byteOffset": byte});
        }
        Some(Place::Pointer(_)) | None => {}
    }
    location
}

/// A file that could not be looked at.
fn notification(subject: &Subject) -> Option<Value> {
    let reason = subject.outcome.as_ref().err()?;
    Some(json!({
        "level": "error",
        "message": {"text": reason},
        "locations": [location(&subject.file, None)],
    }))
}

/// A path as a URI reference (RFC 3986): relative paths stay relative.
fn uri(path: &str) -> String {
    let path = if cfg!(windows) { path.replace('\\', "/") } else { path.to_owned() };
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let encoded = |byte: u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    let encoded: String = path.bytes().map(encoded).collect();
    match path.as_bytes() {
        [b'/', ..] => format!("file://{encoded}"),
        [_, b':', b'/', ..] if cfg!(windows) => format!("file:///{encoded}"),
        _ => encoded,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_uris() {
        assert_eq!(uri("out/a b.glb"), "out/a%20b.glb");
        assert_eq!(uri("a:b,ü.glb"), "a%3Ab%2C%C3%BC.glb");
        #[cfg(unix)]
        assert_eq!(uri("/tmp/x.glb"), "file:///tmp/x.glb");
    }
}

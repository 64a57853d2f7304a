//! Reports for programs: each format, and the schemas of what is JSON.
//!
//! The schemas of docs/schemas are the documentation of the outputs. Here they are read
//! strictly: a property that they do not describe is an error, so that they stay
//! complete. The published schemas of SARIF and JUnit are large and not ours; what is
//! held against is the part of them that the reports use, written down below.

use crate::support::altered::Glb;
use crate::support::schema::Schema;
use crate::support::tool::{Ran, run_in};
use crate::support::{fixtures, keyframes, repository};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// The schema of a command's output, closed against what it does not describe.
fn schema(command: &str) -> Schema {
    let path = repository().join("docs/schemas").join(format!("{command}.json"));
    Schema::closed(serde_json::from_slice(&fs::read(path).unwrap()).unwrap())
}

#[track_caller]
fn valid(schema: &Schema, value: &Value) {
    let problems = schema.problems(value);
    assert!(problems.is_empty(), "{problems:#?}\n{value:#}");
}

/// A folder with good.glb, bad.glb, which breaks a rule, and warned.glb.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let input = keyframes("chain-even");
    run_in(folder.path(), [input.as_os_str(), "good.glb".as_ref(), "-q".as_ref()]).exits(0);
    let mut glb = Glb::read(&at("good.glb"));
    glb.json["nodes"][3]["name"] = "box1".into();
    glb.write(&at("warned.glb"));
    glb.json["animations"][0]["channels"][1]["target"]["node"] = 99.into();
    glb.write(&at("bad.glb"));
    folder
}

fn run(folder: &Path, line: &str) -> Ran {
    run_in(folder, line.split(' '))
}

#[test]
fn check_writes_what_its_schema_says() {
    let folder = folder();
    let schema = schema("check");
    let lines = run(folder.path(), "check good.glb warned.glb bad.glb none.glb --json").exits(3).json_lines();
    assert_eq!(lines.len(), 4);
    lines.iter().for_each(|line| valid(&schema, line));
    fs::copy(keyframes("chain-even"), folder.path().join("in.dat")).unwrap();
    let report = run(folder.path(), "check good.glb --report json --against in.dat").exits(0).json();
    assert!(report["motion"][0]["boxes"][0]["keys"]["off"].is_number());
    valid(&schema, &report);
    // The container's findings have bytes as their places.
    let bytes = fs::read(folder.path().join("good.glb")).unwrap();
    fs::write(folder.path().join("cut.glb"), &bytes[..bytes.len() - 100]).unwrap();
    let report = run(folder.path(), "check cut.glb --json").exits(3).json();
    assert!(report["findings"][0]["byte"].is_number(), "{report}");
    valid(&schema, &report);
    // The schema has teeth.
    for (pointer, wrong) in
        [("/findings/0/severity", json!("fatal")), ("/errors", json!(-1)), ("/schema", json!(2))]
    {
        let mut report = report.clone();
        *report.pointer_mut(pointer).unwrap() = wrong;
        assert!(!schema.problems(&report).is_empty(), "{pointer}");
    }
    let mut more = report;
    more["more"] = json!(1);
    assert!(!schema.problems(&more).is_empty());
}

#[test]
fn diff_writes_what_its_schema_says() {
    let folder = folder();
    let schema = schema("diff");
    let input = keyframes("chain-even");
    let other = ["convert", input.to_str().unwrap(), "-o", "other.glb", "--scheme", "slerp,bessel", "-q"];
    run_in(folder.path(), other).exits(0);
    for (line, exit) in [
        ("diff good.glb good.glb --json", 0),
        ("diff good.glb warned.glb --report json --strict", 3),
        ("diff good.glb other.glb --map chain-even=chain-even-slerp --max-error 1 --json", 3),
        ("diff good.glb bad.glb --json", 1),
        ("diff good.glb other.glb --json", 3),
    ] {
        valid(&schema, &run(folder.path(), line).exits(exit).json());
    }
}

#[test]
fn convert_writes_what_its_schema_says() {
    let folder = folder();
    let schema = schema("convert");
    let (keys, path) = (keyframes("chain-even"), fixtures().join("paths/flight.dat"));
    let options = ["-o", "out.glb", "--json"];
    for inputs in [vec![&keys], vec![&path], vec![&keys, &path]] {
        let mut arguments = vec!["convert", inputs[0].to_str().unwrap()];
        if let Some(path) = inputs.get(1) {
            arguments.extend(["--path", path.to_str().unwrap()]);
        }
        valid(&schema, &run_in(folder.path(), [&arguments[..], &options].concat()).exits(0).json());
    }
    let warned = ["convert", keys.to_str().unwrap(), "--fps", "4", "--no-key-times"];
    let summary = run_in(folder.path(), [&warned[..], &options].concat()).exits(0).json();
    assert!(!summary["warnings"].as_array().unwrap().is_empty(), "{summary}");
    valid(&schema, &summary);
    valid(&schema, &run(folder.path(), "convert none.dat -o none.glb --json").exits(1).json());
}

#[test]
fn inspect_writes_what_its_schema_says() {
    let folder = folder();
    let schema = schema("inspect");
    let files =
        ["keyframes/chain-even.dat", "keyframes/body-free.dat", "paths/flight.dat", "paths/euler.dat"];
    let fixtures = files.map(|file| fixtures().join(file));
    for file in fixtures.iter().map(|path| path.to_str().unwrap()).chain(["good.glb"]) {
        valid(&schema, &run_in(folder.path(), ["inspect", file, "--json"]).exits(0).json());
    }
    run(folder.path(), "convert good.glb -o x.glb").exits(1);
    fs::write(
        folder.path().join("least.gltf"),
        r#"{"asset":{"version":"2.0"},"animations":[{"channels":[],"samplers":[]}]}"#,
    )
    .unwrap();
    valid(&schema, &run(folder.path(), "inspect least.gltf --json").exits(0).json());
}

/// What of the published schema of SARIF 2.1.0 the reports use.
fn sarif_schema() -> Value {
    let text = json!({"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}});
    let level = json!({"enum": ["none", "note", "warning", "error"]});
    let location = json!({
        "type": "object",
        "properties": {
            "physicalLocation": {"type": "object", "properties": {
                "artifactLocation": {"type": "object", "properties": {
                    "uri": {"type": "string", "pattern": "^[A-Za-z0-9._~:/%-]+$"},
                }},
                "region": {"type": "object", "properties": {"byteOffset": {"type": "integer", "minimum": 0}}},
            }},
            "logicalLocations": {"type": "array", "minItems": 1, "items": {"type": "object", "properties": {
                "name": {"type": "string"}, "fullyQualifiedName": {"type": "string"},
            }}},
        },
    });
    let locations = json!({"type": "array", "items": location});
    let rule = json!({"type": "object", "required": ["id"], "properties": {
        "id": {"type": "string"}, "shortDescription": text, "help": text,
        "defaultConfiguration": {"type": "object", "properties": {"level": level}},
    }});
    let result = json!({"type": "object", "required": ["message"], "properties": {
        "ruleId": {"type": "string"}, "ruleIndex": {"type": "integer", "minimum": 0},
        "level": level, "message": text, "locations": locations,
    }});
    let invocation = json!({"type": "object", "required": ["executionSuccessful"], "properties": {
        "executionSuccessful": {"type": "boolean"}, "exitCode": {"type": "integer"},
        "toolExecutionNotifications": {"type": "array", "items": {"type": "object", "required": ["message"],
            "properties": {"message": text, "level": level, "locations": locations}}},
    }});
    let driver = json!({"type": "object", "required": ["name"], "properties": {
        "name": {"type": "string"}, "version": {"type": "string"}, "rules": {"type": "array", "items": rule},
    }});
    let run = json!({"type": "object", "required": ["tool"], "properties": {
        "tool": {"type": "object", "required": ["driver"], "properties": {"driver": driver}},
        "automationDetails": {"type": "object", "properties": {"id": {"type": "string"}}},
        "invocations": {"type": "array", "items": invocation},
        "results": {"type": "array", "items": result},
    }});
    json!({"type": "object", "required": ["version", "runs"], "properties": {
        "$schema": {"type": "string"}, "version": {"const": "2.1.0"}, "runs": {"type": "array", "items": run},
    }})
}

#[test]
fn sarif_has_the_shape_of_its_schema() {
    let folder = folder();
    let schema = Schema::open(sarif_schema());
    for (line, exit, results) in [
        ("check good.glb --report sarif", 0, 0),
        ("check good.glb warned.glb bad.glb none.glb --report sarif", 3, 3),
        ("diff good.glb warned.glb --report sarif --strict", 3, 3),
    ] {
        let log = run(folder.path(), line).exits(exit).json();
        valid(&schema, &log);
        let run = &log["runs"][0];
        assert!(run["results"].as_array().unwrap().len() >= results, "{line}: {}", run["results"]);
        assert_eq!(run["invocations"][0]["exitCode"], exit);
        assert_eq!(run["invocations"][0]["executionSuccessful"], !line.contains("none.glb"));
    }
}

/// Where the help of each rule says that it stands, it stands.
#[test]
fn rules_lead_to_their_place_in_the_docs() {
    let folder = folder();
    let log = run(folder.path(), "check good.glb --report sarif").exits(0).json();
    let page = fs::read_to_string(repository().join("docs/checks.md")).unwrap();
    let rules = log["runs"][0]["tool"]["driver"]["rules"].as_array().unwrap();
    assert!(rules.len() > 60);
    for rule in rules {
        let help = rule["help"]["text"].as_str().unwrap();
        let anchor = help.split("docs/checks.md#").nth(1).unwrap().split(' ').next().unwrap();
        let id = rule["id"].as_str().unwrap();
        assert!(page.contains(&format!("<a name=\"{anchor}\"></a>`{id}`")), "{help}");
    }
}

#[test]
fn junit_has_a_suite_a_file() {
    let folder = folder();
    let line = "check good.glb warned.glb bad.glb none.glb --report junit";
    let xml = run(folder.path(), line).exits(3).out();
    assert!(xml.starts_with(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"dat2glb check\" tests="
    ));
    assert!(xml.contains("<testsuite name=\"good.glb\" tests=\"1\" failures=\"0\" errors=\"0\">"), "{xml}");
    assert!(xml.contains("<testsuite name=\"none.glb\" tests=\"1\" failures=\"0\" errors=\"1\">"), "{xml}");
    let count = |words: &str| xml.matches(words).count();
    assert_eq!(
        (count("<testsuite "), count("</testsuite>"), count("type=\"INDEX_OUT_OF_RANGE\"")),
        (4, 4, 1)
    );
    // A warning is a test that passes, unless warnings fail.
    assert!(xml.contains("name=\"DUPLICATE_NAME\">\n      <system-out>warning: "), "{xml}");
    let strict = run(folder.path(), "check warned.glb --report junit --strict").exits(3).out();
    assert!(strict.contains("type=\"DUPLICATE_NAME\">"), "{strict}");
}

#[test]
fn github_gets_a_command_a_finding() {
    let folder = folder();
    let text =
        run(folder.path(), "check good.glb warned.glb bad.glb none.glb --report github").exits(3).out();
    assert!(text.lines().all(|line| line.starts_with("::")), "{text}");
    assert!(text.contains("::warning file=warned.glb,title=DUPLICATE_NAME::/nodes"), "{text}");
    assert!(
        text.contains("::error file=bad.glb,title=INDEX_OUT_OF_RANGE::/animations/0/channels/1"),
        "{text}"
    );
    assert!(text.contains("::error file=none.glb,title=cannot be read::none.glb: expected a file"), "{text}");
    assert_eq!(run(folder.path(), "check good.glb --report github").exits(0).out(), "");
    assert_eq!(run(folder.path(), "check bad.glb --report github -q").exits(3).out(), "");
    let diff = run(folder.path(), "diff good.glb warned.glb --report github").exits(0).out();
    assert!(diff.contains("::warning file=warned.glb,title=ONLY_IN_ONE::"), "{diff}");
}

#[test]
fn formats_are_listed_and_one_at_a_time() {
    let folder = folder();
    for command in ["check good.glb", "diff good.glb good.glb"] {
        run(folder.path(), &format!("{command} --report html"))
            .exits(2)
            .says(&["text", "json", "github", "junit", "sarif"]);
        run(folder.path(), &format!("{command} --report junit --json")).exits(2).says(&["--json"]);
    }
}

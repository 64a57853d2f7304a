//! Reports with awkward contents.

use super::*;
use serde_json::Value;

fn run(fails_from: Severity) -> Run {
    let mut report = Report::default();
    report.add(Code::NotFinite, "/accessors/3", "50% of <these>,\n \"all\": & more\u{1}");
    report.add(Code::GlbTruncated, 12u64, "cut");
    for node in 0..102 {
        report.add(Code::DuplicateName, format!("/nodes/{node}"), "twice");
    }
    report.add(Code::UnusedObject, "", "nobody");
    let bad = Subject { file: "bad, 50%:1.glb".into(), outcome: Ok(report) };
    let good = Subject { file: "good.glb".into(), outcome: Ok(Report::default()) };
    let gone = Subject { file: "gone.glb".into(), outcome: Err("expected a file,\nfound none".into()) };
    Run { command: "check", subjects: vec![bad, good, gone], fails_from, exit: 3 }
}

#[test]
fn workflow_commands_are_escaped() {
    let text = run(Severity::Error).github();
    let lines: Vec<&str> = text.lines().collect();
    // Two errors, a hundred warnings and a word about the others, an info, a file.
    assert_eq!(lines.len(), 2 + 101 + 1 + 1, "{text}");
    assert_eq!(
        lines[0],
        "::error file=bad%2C 50%25%3A1.glb,title=NOT_FINITE::/accessors/3: 50%25 of <these>,%0A \"all\": & more\u{1}"
    );
    assert!(lines[2].starts_with("::warning ") && lines[102].starts_with("::notice "), "{text}");
    assert!(lines[103].ends_with("title=DUPLICATE_NAME::and 2 more of this kind"), "{}", lines[103]);
    assert_eq!(lines[104], "::error file=gone.glb,title=cannot be read::expected a file,%0Afound none");
}

/// Tags in order, each with whether it opens, closes or stands alone; checks nesting.
fn tags(xml: &str) -> Vec<String> {
    let (mut open, mut seen) = (Vec::new(), Vec::new());
    for part in xml.split('<').skip(1) {
        let (tag, text) = part.split_once('>').unwrap();
        assert!(!text.contains('>'), "{text}");
        let name = tag.split([' ', '/']).find(|word| !word.is_empty()).unwrap().to_owned();
        match tag.as_bytes() {
            [b'?', ..] => continue,
            [b'/', ..] => assert_eq!(open.pop(), Some(name)),
            [.., b'/'] => seen.push(name),
            _ => {
                open.push(name.clone());
                seen.push(name);
            }
        }
    }
    assert!(open.is_empty());
    seen
}

#[test]
fn junit_counts_what_it_holds() {
    for (fails_from, failures) in [(Severity::Error, 2), (Severity::Warning, 3)] {
        let xml = run(fails_from).junit();
        let of = |name: &str| tags(&xml).iter().filter(|tag| *tag == name).count();
        assert_eq!((of("testsuites"), of("testsuite")), (1, 3));
        assert_eq!((of("testcase"), of("failure"), of("error")), (7, failures, 1));
        assert_eq!(of("system-out"), 4 - failures);
        let head =
            format!("<testsuites name=\"dat2glb check\" tests=\"7\" failures=\"{failures}\" errors=\"1\">");
        assert!(xml.contains(&head), "{xml}");
        let bad =
            format!("<testsuite name=\"bad, 50%:1.glb\" tests=\"5\" failures=\"{failures}\" errors=\"0\">");
        assert!(xml.contains(&bad), "{xml}");
        assert!(xml.contains("/accessors/3: 50% of &lt;these&gt;,&#10; &quot;all&quot;: &amp; more\u{fffd}"));
        assert!(xml.contains("twice&#10;and 2 more of this kind</"));
    }
}

#[test]
fn sarif_refers_to_rules_files_and_places() {
    let log: Value = serde_json::from_str(&run(Severity::Error).sarif()).unwrap();
    let run = &log["runs"][0];
    let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
    assert_eq!(rules.len(), Code::ALL.len());
    let results = run["results"].as_array().unwrap();
    assert_eq!(results.len(), 2 + 101 + 1);
    for result in results {
        let rule = &rules[result["ruleIndex"].as_u64().unwrap() as usize];
        assert_eq!(rule["id"], result["ruleId"]);
        assert_eq!(rule["defaultConfiguration"]["level"], result["level"]);
        let file = &result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"];
        assert_eq!(file, "bad%2C%2050%25%3A1.glb");
    }
    assert_eq!(results[0]["locations"][0]["logicalLocations"][0]["fullyQualifiedName"], "/accessors/3");
    assert_eq!(results[1]["locations"][0]["physicalLocation"]["region"]["byteOffset"], 12);
    let invocation = &run["invocations"][0];
    assert_eq!((&invocation["executionSuccessful"], &invocation["exitCode"]), (&false.into(), &3.into()));
    let notification = &invocation["toolExecutionNotifications"][0];
    assert_eq!(notification["message"]["text"], "expected a file,\nfound none");
}

#[test]
fn formats_have_names() {
    for &format in Format::ALL {
        assert_eq!(Format::from_name(format.name()), Some(format));
    }
    assert_eq!(Format::from_name("html"), None);
}

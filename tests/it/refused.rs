//! Every refusal: an input in fixtures/refused and the message it must get, word for word.

use crate::support::tool::{names, run};
use crate::support::{ACCEPT, accept, fixtures};
use std::fs;
use std::path::Path;

/// NAME.dat is converted with the words of NAME.args, if there are any.
fn refuse(name: &str, output: &Path) -> String {
    let folder = fixtures().join("refused");
    let extra = fs::read_to_string(folder.join(format!("{name}.args"))).unwrap_or_default();
    let input = format!("fixtures/refused/{name}.dat");
    let output = output.to_str().unwrap();
    let mut arguments = vec!["convert", &input, "-o", output];
    arguments.extend(extra.split_whitespace());
    let ran = run(arguments).exits(1);
    assert!(ran.stdout.is_empty(), "{name}: {}", ran.out());
    ran.stderr
}

/// The names that have a file with this ending.
fn with_ending(ending: &str) -> Vec<String> {
    let all = names(&fixtures().join("refused"));
    all.iter().filter_map(|name| name.strip_suffix(ending)).map(str::to_owned).collect()
}

#[test]
fn every_refusal_says_what_its_file_says_and_touches_nothing() {
    let inputs = with_ending(".dat");
    assert!(inputs.len() >= 50, "only {} inputs", inputs.len());
    let folder = tempfile::tempdir().unwrap();
    let (fresh, existing) = (folder.path().join("fresh.glb"), folder.path().join("existing.glb"));
    fs::write(&existing, "what was here before").unwrap();
    let mut wrong = Vec::new();
    for name in &inputs {
        let message = refuse(name, &fresh);
        assert_eq!(message, refuse(name, &existing), "{name}");
        assert_eq!(names(folder.path()), ["existing.glb"], "{name}");
        assert_eq!(fs::read(&existing).unwrap(), b"what was here before", "{name}");
        let file = fixtures().join("refused").join(format!("{name}.expect"));
        if accept() {
            fs::write(&file, &message).unwrap();
        }
        let expected = fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
        if message != expected {
            wrong.push(format!("{name}: expected\n{expected}found\n{message}"));
        }
    }
    assert!(wrong.is_empty(), "{}\nIf these are better, {ACCEPT}=1 writes them down.", wrong.join("\n"));
}

#[test]
fn every_message_and_every_line_of_the_readme_has_its_input() {
    let inputs = with_ending(".dat");
    for ending in [".expect", ".args"] {
        for name in with_ending(ending) {
            assert!(inputs.contains(&name), "{name}{ending} has no {name}.dat");
        }
    }
    let readme = fs::read_to_string(fixtures().join("refused/README.md")).unwrap();
    let listed: Vec<String> = readme
        .lines()
        .filter_map(|line| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned()))
        .collect();
    assert_eq!(listed, inputs);
}

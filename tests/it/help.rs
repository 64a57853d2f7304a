//! Help, completions and the manual page come from the same definitions.

use crate::support::tool::{finish, program, run};

const COMMANDS: &[&str] = &[
    "convert",
    "check",
    "diff",
    #[cfg(feature = "render")]
    "thumbnail",
    "inspect",
    "reduce",
    "sample",
    "compare",
    #[cfg(feature = "plot-png")]
    "plot",
    "example",
    "completions",
    "man",
];

/// The long options that a command's help lists.
fn flags(command: &str) -> Vec<String> {
    let help = run([command, "--help"]).exits(0).out();
    let words = help.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
    let mut flags: Vec<String> =
        words.filter(|word| word.starts_with("--") && word.len() > 3).map(str::to_owned).collect();
    flags.sort();
    flags.dedup();
    flags
}

#[test]
fn help_names_every_command_and_the_exit_codes() {
    let help = run(["--help"]).exits(0).out();
    for words in
        COMMANDS.iter().chain(&["0 done", "1 input refused", "2 usage", "3 output failed", "4 environment"])
    {
        assert!(help.contains(words), "{words} not in:\n{help}");
    }
    let version = run(["--version"]).exits(0).out();
    assert_eq!(version, concat!("dat2glb ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn every_command_shows_an_example() {
    for &command in COMMANDS {
        for flag in ["-h", "--help"] {
            let help = run([command, flag]).exits(0).out();
            assert!(help.contains(&format!("\n  dat2glb {command} ")), "{help}");
        }
    }
}

#[test]
fn options_of_convert_are_grouped() {
    let help = run(["convert", "--help"]).exits(0).out();
    let headings = ["Input", "Curve", "Path", "Sampling", "Cameras", "Copies", "Output", "Checks"];
    let at: Vec<Option<usize>> =
        headings.iter().map(|heading| help.find(&format!("\n{heading}:\n"))).collect();
    assert!(at.iter().all(Option::is_some) && at.is_sorted(), "{at:?} in:\n{help}");
}

#[test]
fn completions_know_every_command_and_flag() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run(["completions", shell]).exits(0).out();
        for &command in COMMANDS {
            assert!(script.contains(command), "{shell}: no {command}");
            for flag in flags(command) {
                // fish writes them without the hyphens.
                let flag = if shell == "fish" { flag.trim_start_matches('-') } else { &flag };
                assert!(script.contains(flag), "{shell}: no {flag} of {command}");
            }
        }
    }
    run(["completions", "tcsh"]).exits(2).says(&["tcsh", "bash"]);
}

#[cfg(unix)]
#[test]
fn bash_accepts_its_script() {
    let script = run(["completions", "bash"]).exits(0).stdout;
    finish(std::process::Command::new("bash").arg("-n"), &script).exits(0);
}

#[test]
fn the_manual_page_knows_every_command_and_flag() {
    let page = finish(program().arg("man"), b"").exits(0).out().replace("\\-", "-");
    assert!(page.contains(".TH dat2glb 1"), "{page}");
    for &command in COMMANDS {
        assert!(page.contains(&format!("\ndat2glb {command}\n")), "{command}");
        for flag in flags(command) {
            assert!(page.contains(&flag), "{flag} of {command}");
        }
    }
}

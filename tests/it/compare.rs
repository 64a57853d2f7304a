//! `dat2glb compare`: schemes side by side, for people and for programs.

use crate::support::tool::{finish, program, run};
use crate::support::{fixtures, keyframes};
use dat2glb::curve::Scheme;
use serde_json::{Value, json};

/// Keys that turn about x: times and degrees; quaternions in the order w x y z, or last.
fn about_x(keys: &[(f64, f64)], scalar_last: bool) -> String {
    let row = |&(time, degrees): &(f64, f64)| {
        let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
        if scalar_last { format!("{time} {sin} 0 0 {cos}\n") } else { format!("{time} {cos} {sin} 0 0\n") }
    };
    std::iter::once("# 1 2\n".to_owned()).chain(keys.iter().map(row)).collect()
}

const ZIGZAG: [(f64, f64); 4] = [(5.0, 0.0), (6.0, 60.0), (8.0, 20.0), (8.5, 100.0)];

#[track_caller]
fn near(value: &Value, expected: f64) {
    let found = value.as_f64().unwrap();
    assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
}

#[test]
fn json_of_a_zigzag_has_its_rates() {
    let arguments = ["compare", "-", "--scheme", "slerp", "--json"];
    let found = finish(program().args(arguments), about_x(&ZIGZAG, false).as_bytes()).exits(0).json();
    for (name, expected) in [
        ("schema", json!(1)),
        ("file", json!("-")),
        ("ends", json!("natural")),
        ("keys", json!(4)),
        ("seconds", json!(3.5)),
        ("maxStep", json!(18.0)),
        ("warnings", json!([])),
    ] {
        assert_eq!(found[name], expected, "{name}");
    }
    assert_eq!(found["boxes"].as_array().unwrap().len(), 1);
    assert_eq!(found["boxes"][0]["box"], 1);
    let method = &found["boxes"][0]["methods"][0];
    assert_eq!(method["scheme"], "slerp");
    // 60, −20 and 160 degrees a second.
    near(&method["speed"]["largest"]["value"], 160.0);
    near(&method["speed"]["rms"], ((3600.0 + 2.0 * 400.0 + 0.5 * 25600.0) / 3.5f64).sqrt());
    near(&method["acceleration"]["largest"]["value"], 0.0);
    near(&method["acceleration"]["rms"], 0.0);
    near(&method["jumps"]["velocity"]["value"], 180.0);
    near(&method["jumps"]["velocity"]["time"], 3.0);
    near(&method["jumps"]["acceleration"]["value"], 0.0);
    near(&method["jumps"]["rotation"]["value"], 0.0);
    near(&method["overshoot"]["value"], 0.0);
    near(&method["stray"]["value"], 0.0);
    // Steps of 18° at most: 4, 3 and 5 of them.
    for (needed, tolerance) in method["keys"].as_array().unwrap().iter().zip([0.1, 0.01, 0.001]) {
        assert_eq!(*needed, json!({ "tolerance": tolerance, "keys": 13, "bytes": 260, "counted": true }));
    }
}

/// The rows of a table's block, name and numbers apart.
fn rows(text: &str) -> Vec<(&str, Vec<&str>)> {
    let block = text.split("\n\n").nth(1).unwrap();
    block
        .lines()
        .skip(2)
        .map(|line| (line.split(' ').next().unwrap(), line.split_whitespace().skip(1).collect()))
        .collect()
}

#[test]
fn the_table_says_what_the_json_says() {
    for (name, boxes) in [("chain-uneven", 4), ("very-uneven", 2), ("body-free", 1)] {
        let file = keyframes(name);
        let file = file.to_str().unwrap();
        let text = run(["compare", file]).exits(0).out();
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        assert_eq!(text.matches("speed °/s").count(), boxes);
        let json = run(["compare", file, "--json"]).exits(0).json();
        let methods = json["boxes"][0]["methods"].as_array().unwrap();
        let rows = rows(&text);
        assert_eq!((rows.len(), methods.len()), (Scheme::ALL.len(), Scheme::ALL.len()));
        for ((name, cells), method) in rows.iter().zip(methods) {
            assert_eq!(method["scheme"], *name);
            let numbers = [
                &method["speed"]["largest"]["value"],
                &method["speed"]["rms"],
                &method["acceleration"]["largest"]["value"],
                &method["acceleration"]["rms"],
                &method["jumps"]["velocity"]["value"],
                &method["jumps"]["acceleration"]["value"],
                &method["overshoot"]["value"],
                &method["stray"]["value"],
                &method["keys"][0]["keys"],
                &method["keys"][1]["keys"],
                &method["keys"][2]["keys"],
                &method["keys"][1]["bytes"],
            ];
            assert_eq!(cells.len(), numbers.len(), "{text}");
            for (cell, number) in cells.iter().zip(numbers) {
                let cell = cell.strip_prefix('~').unwrap_or(cell);
                let (shown, number): (f64, f64) = (cell.parse().unwrap(), number.as_f64().unwrap());
                // Two digits at least; rounding errors are shown as nought.
                assert!((shown - number).abs() <= 0.053 * number.max(1e-9), "{cell} {number}");
            }
        }
    }
}

#[test]
fn columns_stand_below_their_headings() {
    let file = keyframes("chain-even");
    let text = run(["compare", file.to_str().unwrap()]).exits(0).out();
    assert!(text.starts_with(file.to_str().unwrap()) && text.contains("26 keys, 10.0 s, ends natural\n"));
    let blocks: Vec<&str> = text.split("\n\n").skip(1).collect();
    assert_eq!(blocks.len(), 4);
    for (i, block) in blocks.iter().enumerate() {
        let lines: Vec<Vec<char>> = block.lines().map(|line| line.chars().collect()).collect();
        assert!(block.starts_with(&format!("box{} ", i + 1)), "{block}");
        // Where a heading ends, all numbers end.
        let heading = &lines[1];
        let ends = (0..heading.len())
            .filter(|&at| heading[at] != ' ' && heading.get(at + 1).is_none_or(|c| *c == ' '));
        for at in ends.skip(1) {
            for line in &lines[2..] {
                assert!(line[at] != ' ' && line.get(at + 1).is_none_or(|c| *c == ' '), "{at} in\n{block}");
            }
        }
    }
}

#[test]
fn one_box_and_some_schemes() {
    let file = keyframes("chain-uneven");
    let file = file.to_str().unwrap();
    let schemes = "--scheme=squad,bessel,squad";
    let all = run(["compare", file, "--json", schemes]).exits(0).json();
    let one = run(["compare", file, "--json", schemes, "--box", "3"]).exits(0).json();
    assert_eq!(one["boxes"].as_array().unwrap().len(), 1);
    assert_eq!(one["boxes"][0], all["boxes"][2]);
    let names: Vec<&Value> =
        one["boxes"][0]["methods"].as_array().unwrap().iter().map(|method| &method["scheme"]).collect();
    assert_eq!(names, ["squad", "bessel"]);
    let text = run(["compare", file, schemes, "--box", "3"]).exits(0).out();
    assert!(text.contains("\nbox3 ") && !text.contains("box1"), "{text}");
}

#[test]
fn the_order_of_parts_can_be_said() {
    let compared = |scalar_last: bool| {
        let order = if scalar_last { "xyzw" } else { "wxyz" };
        let text = about_x(&ZIGZAG, scalar_last);
        let arguments = ["compare", "-", "--json", "--quat-order", order];
        finish(program().args(arguments), text.as_bytes()).exits(0).json()
    };
    assert_eq!(compared(true), compared(false));
}

#[test]
fn other_kinds_of_rotations() {
    let paths = fixtures().join("paths");
    let euler = run(["compare", paths.join("euler.dat").to_str().unwrap()]).exits(0).out();
    assert!(euler.contains("\nbody ") && rows(&euler).len() == Scheme::ALL.len(), "{euler}");
    let controls = paths.join("quat-bezier.dat");
    let json = run(["compare", controls.to_str().unwrap(), "--json"]).exits(0).json();
    let methods = json["boxes"][0]["methods"].as_array().unwrap();
    assert_eq!(methods.len(), 1);
    assert_eq!(methods[0]["scheme"], Value::Null);
    let text = run(["compare", controls.to_str().unwrap()]).exits(0).out();
    assert!(text.contains("\ncontrol rotations "), "{text}");
}

#[test]
fn a_jump_is_said() {
    let file = keyframes("single-even");
    let arguments = ["compare", file.to_str().unwrap(), "--scheme", "slerp,bessel", "--ends", "hold"];
    let text = run(arguments).exits(0).out();
    assert!(text.ends_with(" at 0.500 s, which no other figure counts\n"), "{text}");
    assert!(text.contains("\nbessel jumps by ") && !text.contains("slerp jumps"), "{text}");
}

#[test]
fn oddities_of_the_input_are_said() {
    let text = "# 1 2\n0 1 0 0 0\n1 0.9 0.5 0 0\n2 1 0 0 0\n";
    let ran = finish(program().args(["compare", "-"]), text.as_bytes()).exits(0);
    assert!(ran.out().contains("3 keys"));
    ran.says(&["warning: <stdin>: ", "NOT_UNIT"]);
    let json = finish(program().args(["compare", "-", "--json"]), text.as_bytes()).exits(0);
    assert_eq!(json.stderr, "");
    assert_eq!(json.json()["warnings"][0]["code"], "NOT_UNIT");
}

#[test]
fn what_cannot_be_compared_says_so() {
    let chain = keyframes("chain-uneven");
    let chain = chain.to_str().unwrap();
    let path = fixtures().join("paths").join("flight.dat");
    run(["compare", path.to_str().unwrap()]).exits(1).says(&["flight.dat: ", "rotations", "found a path"]);
    run(["compare", chain, "--box", "5"]).exits(2).says(&["expected a box from 1 to 4, found 5"]);
    run(["compare", chain, "--box", "0"]).exits(2).says(&["--box"]);
    let apart = ["compare", "fixtures/refused/closed-ends-apart.dat", "--ends", "closed"];
    run(apart).exits(1).says(&["closed-ends-apart.dat: box 2: ", "closed ends"]);
    run(["compare", chain, "--scheme", "linear"]).exits(2).says(&["bessel"]);
    run(["compare", "nothing.dat"]).exits(1).says(&["nothing.dat"]);
    run(["compare", "fixtures/refused/nan.dat"]).exits(1).says(&["fixtures/refused/nan.dat"]);
}

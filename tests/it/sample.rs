//! `dat2glb sample`: tables that other programs read.

use crate::support::tool::{finish, program, run, run_in};
use crate::support::{fixtures, keyframes};
use std::fs;

/// The rows of a table, without its header.
fn rows(csv: &str) -> Vec<Vec<f64>> {
    csv.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

fn near(found: &[f64], expected: &[f64], limit: f64) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= limit)
}

#[test]
fn a_bezier_matches_a_printed_table() {
    let text = "# bezier 1\n0.201 0.096 0.100\n0.108 0.682 0.200\n0.727 0.746 0.300\n0.432 0.197 2.743\n";
    let arguments = ["sample", "-", "--count", "100", "--orient", "none"];
    let table = finish(program().args(arguments), text.as_bytes()).exits(0).out();
    assert!(table.starts_with("t,x,y,z\n"), "{table}");
    let rows = rows(&table);
    assert_eq!(rows.len(), 101);
    // The control points were printed with 3 digits, the table with 6.
    assert!(near(&rows[10], &[0.1, 0.192751, 0.256021, 0.132343], 2e-4), "{:?}", rows[10]);
    assert!(near(&rows[25], &[0.25, 0.239162, 0.436269, 0.211609], 2e-4), "{:?}", rows[25]);
}

#[test]
fn euler_angles_come_back() {
    let path = fixtures().join("paths").join("euler.dat");
    let table = run(["sample", path.to_str().unwrap(), "--as", "euler", "--fps", "2"]).exits(0).out();
    assert!(table.starts_with("t,body_roll,body_pitch,body_yaw\n"), "{table}");
    let rows = rows(&table);
    for line in fs::read_to_string(path).unwrap().lines().filter(|line| !line.starts_with('#')) {
        let key: Vec<f64> = line.split_whitespace().map(|x| x.parse().unwrap()).collect();
        let row = rows.iter().find(|row| row[0] == key[0]).unwrap();
        assert!(near(row, &key, 1e-9), "{row:?} {key:?}");
    }
}

#[test]
fn boxes_and_the_root_have_their_columns() {
    let folder = tempfile::tempdir().unwrap();
    let (chain, way) = (keyframes("late-start"), fixtures().join("paths").join("bezier.dat"));
    let arguments =
        ["sample", chain.to_str().unwrap(), "--path", way.to_str().unwrap(), "--as", "axis-angle"];
    run_in(folder.path(), arguments.iter().chain(&["--orient", "tangent", "-o", "out.csv"])).exits(0);
    let table = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let header: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    assert_eq!(header.len(), 1 + 2 * 4 + 4 + 3);
    assert_eq!(
        (header[1], header[5], header[9], header[13]),
        ("box1_angle", "box2_angle", "root_angle", "root_x")
    );
    let rows = rows(&table);
    // 15 s at 25 rows a second, and the last time.
    assert_eq!(rows.len(), 376);
    assert_eq!(rows[375][0], 15.0);
    assert!(rows.iter().all(|row| row.len() == header.len() && (0.0..=180.0).contains(&row[1])));
}

#[test]
fn what_makes_no_table_says_so() {
    let chain = keyframes("single-even");
    run(["sample", chain.to_str().unwrap(), "--as", "degrees"]).exits(2).says(&["axis-angle"]);
    run(["sample", chain.to_str().unwrap(), "--count", "0"]).exits(2);
    run(["sample", "nothing.dat"]).exits(1).says(&["nothing.dat"]);
}

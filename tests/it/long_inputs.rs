//! Inputs of more than half a megabyte take no more time and memory than their size and that of
//! what comes out allow.

use crate::support::confined::{Limits, confined};
use dat2glb::curve::Scheme;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Numbers between −1 and 1 that look like chance, the same every time.
fn chance() -> impl FnMut() -> f64 {
    let mut state = 1u64;
    move || {
        // Knuth's MMIX generator; the high bits are the good ones.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 32) as f64 / 2f64.powi(31) - 1.0
    }
}

/// Keys of so many boxes that turn by up to 40° about any axis, at uneven times.
fn keys(boxes: usize, count: usize) -> String {
    let (mut next, mut t) = (chance(), 0.0);
    let mut chain = vec![glam::DQuat::IDENTITY; boxes];
    let mut text = format!("# {boxes} 2\n");
    for _ in 0..count {
        t += 0.1 + 0.05 * next();
        write!(text, "{t:.6}").unwrap();
        for q in &mut chain {
            let turn = glam::DVec3::new(next(), next(), next()) * 0.4;
            *q = (*q * glam::DQuat::from_scaled_axis(turn)).normalize();
            write!(text, " {:.10} {:.10} {:.10} {:.10}", q.w, q.x, q.y, q.z).unwrap();
        }
        text.push('\n');
    }
    text
}

/// 16,000 points that wind, 1,000 seconds.
fn points(kind: &str) -> String {
    let (mut next, mut at) = (chance(), glam::DVec3::ZERO);
    let mut text = format!("# {kind} 1000\n");
    for _ in 0..16_000 {
        at += glam::DVec3::new(2.0 * next() + 1.0, next(), 2.0 * next());
        writeln!(text, "{:.6} {:.6} {:.6}", at.x, at.y, at.z).unwrap();
    }
    text
}

/// 60,000 points from 0 to 9 in ten seconds: the least bytes to the most turns.
fn digits() -> String {
    let mut next = chance();
    let mut digit = || (5.0 + 5.0 * next()).floor();
    let mut text = "# catmull-rom 10\n".to_owned();
    for _ in 0..60_000 {
        writeln!(text, "{} {} {}", digit(), digit(), digit()).unwrap();
    }
    text
}

/// 12,000 rows of Euler angles that wander by up to 20°.
fn angles() -> String {
    let (mut next, mut at) = (chance(), [0.0; 3]);
    let mut text = "# euler\n".to_owned();
    for i in 0..12_000 {
        at = at.map(|angle: f64| angle + 20.0 * next());
        writeln!(text, "{:.2} {:.4} {:.4} {:.4}", 0.1 * f64::from(i), at[0], at[1], at[2]).unwrap();
    }
    text
}

/// Runs commands on files of a folder, each of which writes no more than so many bytes.
#[track_caller]
fn are_soon_done(folder: &Path, commands: &[(&str, u64)]) {
    for (command, most) in commands {
        is_soon_done(folder, command, *most);
    }
}

/// Runs a command on files of a folder; it writes no more than so many bytes.
#[track_caller]
fn is_soon_done(folder: &Path, command: &str, most: u64) {
    ends_soon(folder, command, most, 0);
}

/// Runs a command on files of a folder that ends with a code.
#[track_caller]
fn ends_soon(folder: &Path, command: &str, most: u64, code: i32) {
    let words: Vec<String> =
        command.replace("FOLDER", folder.to_str().unwrap()).split(' ').map(str::to_owned).collect();
    let read: u64 = words.iter().filter_map(|word| fs::metadata(word).ok()).map(|file| file.len()).sum();
    let limits = Limits::of(read + most);
    // What computes much is slower in a build for development than what reads.
    let slower = if cfg!(debug_assertions) { 2 } else { 1 };
    let limits = Limits { seconds: slower * limits.seconds, ..limits };
    let ran = confined(&words, limits).unwrap_or_else(|how| panic!("{command}: {how}"));
    assert_eq!(ran.code, code, "{command}: {}", ran.stderr);
    let output = words.iter().position(|word| word == "-o").map(|at| &words[at + 1]);
    let output = output.filter(|_| code == 0);
    let written = output.map_or(0, |output| fs::metadata(output).unwrap().len()) + ran.stdout.len() as u64;
    assert!(written <= most, "{command} wrote {written} bytes");
    if let Some(output) = output.filter(|output| !output.contains("kept.")) {
        fs::remove_file(output).unwrap();
    }
}

#[test]
fn keys_by_every_scheme() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("keys.dat"), keys(1, 9_000)).unwrap();
    for scheme in Scheme::ALL {
        let command = format!("convert FOLDER/keys.dat --scheme {} -o FOLDER/out.glb", scheme.name());
        is_soon_done(folder, &command, 1_500_000);
    }
    are_soon_done(
        folder,
        &[
            ("convert FOLDER/keys.dat --tolerance 0.1 -o FOLDER/out.glb", 1_500_000),
            ("convert FOLDER/keys.dat --quantize -o FOLDER/kept.glb", 1_500_000),
            ("check FOLDER/kept.glb --against FOLDER/keys.dat", 1_000),
            ("reduce FOLDER/kept.glb --tolerance 1 -o FOLDER/out.glb", 1_500_000),
            ("compare FOLDER/keys.dat", 5_000),
            ("plot FOLDER/keys.dat --scheme all -o FOLDER/out.svg", 1_000_000),
            ("sample FOLDER/keys.dat -o FOLDER/out.csv", 3_000_000),
        ],
    );
}

#[test]
fn keys_of_many_boxes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("keys.dat"), keys(500, 20)).unwrap();
    are_soon_done(
        folder,
        &[
            ("convert FOLDER/keys.dat -o FOLDER/kept.glb", 2_000_000),
            ("check FOLDER/kept.glb --against FOLDER/keys.dat", 100_000),
            ("convert FOLDER/keys.dat --tolerance 0.1 -o FOLDER/out.glb", 2_000_000),
            ("convert FOLDER/keys.dat --interpolation cubicspline -o FOLDER/out.glb", 2_000_000),
            ("compare FOLDER/keys.dat", 1_000_000),
            ("sample FOLDER/keys.dat -o FOLDER/out.csv", 4_000_000),
        ],
    );
}

#[test]
fn angles_and_json() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("angles.dat"), angles()).unwrap();
    are_soon_done(
        folder,
        &[
            ("convert FOLDER/angles.dat -o FOLDER/kept.gltf", 3_000_000),
            ("check FOLDER/kept.gltf --against FOLDER/angles.dat", 1_000),
            ("reduce FOLDER/kept.gltf --tolerance 1 -o FOLDER/out.gltf", 3_000_000),
            ("convert FOLDER/angles.dat --tolerance 0.1 -o FOLDER/out.glb", 2_000_000),
        ],
    );
}

#[test]
fn paths_that_wind_and_paths_of_corners() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for kind in ["catmull-rom", "polyline"] {
        fs::write(folder.join("path.dat"), points(kind)).unwrap();
        are_soon_done(
            folder,
            &[
                ("convert FOLDER/path.dat -o FOLDER/kept.glb", 3_000_000),
                ("check FOLDER/kept.glb --against FOLDER/path.dat", 2_000),
                ("convert FOLDER/path.dat --orient tangent -o FOLDER/out.glb", 3_000_000),
                ("convert FOLDER/path.dat --orient keyed -o FOLDER/out.glb", 3_000_000),
                ("convert FOLDER/path.dat --timing constant-speed -o FOLDER/out.glb", 3_000_000),
                ("plot FOLDER/path.dat -o FOLDER/out.svg", 1_000_000),
                ("sample FOLDER/path.dat -o FOLDER/out.csv", 4_000_000),
            ],
        );
    }
    // Every corner is a jump of the rotation, and a key of its own before and after it.
    is_soon_done(folder, "convert FOLDER/path.dat --tolerance 0.01 -o FOLDER/out.glb", 1_500_000);
}

#[test]
fn paths_that_turn_at_every_byte() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("path.dat"), digits()).unwrap();
    are_soon_done(
        folder,
        &[
            ("convert FOLDER/path.dat -o FOLDER/kept.glb", 2_250_000),
            ("check FOLDER/kept.glb --against FOLDER/path.dat", 2_000),
            ("convert FOLDER/path.dat --path-ends closed --level-end 9 -o FOLDER/out.glb", 3_000_000),
            ("convert FOLDER/path.dat --timing constant-speed -o FOLDER/out.glb", 2_250_000),
            ("convert FOLDER/path.dat --camera follow -o FOLDER/out.glb", 3_750_000),
            ("convert FOLDER/path.dat --repeat 3 -o FOLDER/out.glb", 9_000_000),
            // Next to nothing comes out of these.
            ("sample FOLDER/path.dat --fps 1 -o FOLDER/out.csv", 2_000),
            ("sample FOLDER/path.dat --fps 1 --orient tangent -o FOLDER/out.csv", 2_000),
            ("sample FOLDER/path.dat --fps 1 --timing constant-speed -o FOLDER/out.csv", 2_000),
        ],
    );
    // Rotations cannot be kept, places could, by a multitude of keys.
    ends_soon(folder, "convert FOLDER/path.dat --tolerance 0.1 -o FOLDER/out.glb", 0, 1);
    assert!(!folder.join("out.glb").exists());
}

//! Paths through the real program: every kind, every orientation, together with a chain.

use crate::support::fixtures;
use crate::support::keyframes;
use crate::support::tool::{run, run_in};
use dat2glb::asset::play::{Player, Property};
use dat2glb::asset::{Asset, NoFiles};
use dat2glb::math::{Quat, Vec3};
use glam::DVec3;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

fn path(name: &str) -> PathBuf {
    fixtures().join("paths").join(format!("{name}.dat"))
}

fn names() -> Vec<String> {
    let entries = fs::read_dir(fixtures().join("paths")).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> =
        entries.map(|p| p.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    assert!(names.len() >= 20, "{names:?}");
    names
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn every_kind_converts_checks_clean_and_plays_as_it_should() {
    let folder = tempfile::tempdir().unwrap();
    for name in names() {
        let (input, output) = (path(&name), folder.path().join("out.glb"));
        run(["convert", text(&input), "-o", text(&output)]).exits(0);
        let checked = run(["check", text(&output), "--against", text(&input)]).exits(0);
        assert!(!checked.out().contains(": warning "), "{name}: {}", checked.out());
    }
}

/// The root of a file, played.
struct Root {
    asset: Asset,
    clip: dat2glb::asset::play::Clip,
    player: Player,
}

impl Root {
    fn open(path: &Path) -> Root {
        let mut asset = Asset::open(Box::new(File::open(path).unwrap()), Box::new(NoFiles)).unwrap();
        let clip = asset.clips().remove(0);
        Root { asset, clip, player: Player::new() }
    }

    fn value(&mut self, property: Property, t: f64) -> Vec<f64> {
        let channel = self.clip.channels.iter().find(|c| c.node == 0 && c.property == property).unwrap();
        self.player.value(&mut self.asset, channel, t).unwrap()
    }

    fn place(&mut self, t: f64) -> DVec3 {
        DVec3::from_slice(&self.value(Property::Translation, t))
    }

    /// Where an axis of the root points.
    fn axis(&mut self, axis: Vec3, t: f64) -> DVec3 {
        let q = Quat::from_xyzw(self.value(Property::Rotation, t).try_into().unwrap());
        let v = (q * Quat { w: 0.0, v: axis } * q.conjugate()).v;
        DVec3::new(v.x, v.y, v.z)
    }
}

#[test]
fn forward_is_the_direction_of_travel() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    let (forward, nose_down) = (Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, -1.0, 0.0));
    for (flags, axis) in [
        (&["--orient", "tangent"][..], forward),
        (&["--orient", "upright", "--bank", "40"], forward),
        (&["--model-forward", "-Y", "--model-up", "Z"], nose_down),
    ] {
        let input = path("flight");
        let arguments = ["convert", text(&input), "-o", text(&output), "--fps", "120"];
        run(arguments.iter().chain(flags)).exits(0);
        let mut root = Root::open(&output);
        for i in 1..100 {
            let (t, h) = (root.clip.duration * f64::from(i) / 100.0, 0.02);
            let travel = (root.place(t + h) - root.place(t - h)).normalize();
            let angle = travel.angle_between(root.axis(axis, t)).to_degrees();
            // The chord of 40 ms lags behind the tangent by what the flight turns in it.
            assert!(angle < 1.0, "{flags:?} at {t}: {angle} degrees");
        }
    }
}

#[test]
fn a_landing_is_level() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    for (name, orient) in [("flight", "upright"), ("flight", "keyed"), ("sink", "upright"), ("sink", "keyed")]
    {
        let input = path(name);
        let level = ["--orient", orient, "--level-end", "2"];
        run(["convert", text(&input), "-o", text(&output)].iter().chain(&level)).exits(0);
        let mut root = Root::open(&output);
        let end = root.clip.duration;
        let tilt = root.axis(Vec3::new(0.0, 1.0, 0.0), end).angle_between(DVec3::Y).to_degrees();
        assert!(tilt < 1e-3, "{name} {orient}: {tilt} degrees off level");
    }
}

#[test]
fn constant_speed_is_constant() {
    let folder = tempfile::tempdir().unwrap();
    let (input, output) = (path("bezier"), folder.path().join("out.glb"));
    run(["convert", text(&input), "-o", text(&output), "--timing", "constant-speed", "--no-key-times"])
        .exits(0);
    let mut root = Root::open(&output);
    let steps: Vec<f64> = (1..600)
        .map(|i| f64::from(i) / 60.0)
        .map(|t| {
            let before = root.place(t - 1.0 / 60.0);
            root.place(t).distance(before)
        })
        .collect();
    let (least, most) = steps.iter().fold((f64::MAX, 0.0f64), |(a, b), &s| (a.min(s), b.max(s)));
    // Chords are shorter than arcs where the path bends: by 1/24 of the angle squared.
    assert!(most / least < 1.002, "{least} {most}");
}

#[test]
fn a_chain_goes_along_a_path_on_one_clock() {
    let folder = tempfile::tempdir().unwrap();
    let (chain, way, output) = (keyframes("late-start"), path("bezier"), folder.path().join("out.glb"));
    let made = run(["convert", text(&chain), "--path", text(&way), "-o", text(&output), "--json"]).exits(0);
    let json = made.json();
    // The path has its own 15 s, the keys 6.3 s; both begin at 0.
    assert_eq!((json["boxes"].as_u64(), json["points"].as_u64()), (Some(2), Some(16)));
    assert_eq!(json["seconds"].as_f64(), Some(15.0));
    run(["check", text(&output), "--against", text(&chain), "--against", text(&way)]).exits(0);
    let mut root = Root::open(&output);
    assert_eq!(root.clip.channels.len(), 3, "two boxes turn, the root only travels");
    let inputs: std::collections::BTreeSet<usize> = root.clip.channels.iter().map(|c| c.input).collect();
    assert_eq!(inputs.len(), 1, "all share their times");
    assert!(root.place(15.0).distance(root.place(0.0)) > 1.0);
}

#[test]
fn a_moved_control_point_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let text = fs::read_to_string(path("bezier")).unwrap();
    fs::write(here.join("way.dat"), &text).unwrap();
    run_in(here, ["convert", "way.dat"]).exits(0);
    let row = text.lines().find(|line| !line.starts_with('#')).unwrap();
    fs::write(here.join("way.dat"), text.replacen(row, "1000 0 0", 1)).unwrap();
    let found = run_in(here, ["check", "way.glb", "--against", "way.dat"]).exits(3);
    assert!(
        found.out().contains("MOTION_DIFFERS") && found.out().contains("INPUT_CHANGED"),
        "{}",
        found.out()
    );
    run_in(here, ["check", "way.glb", "--against", "way.dat", "--max-distance", "1e6", "--max-error", "180"])
        .exits(0);
}

#[test]
fn options_of_a_path_need_one() {
    let folder = tempfile::tempdir().unwrap();
    let (chain, output) = (keyframes("single-even"), folder.path().join("out.glb"));
    let arguments = ["convert", text(&chain), "-o", text(&output), "--timing", "chord"];
    run(arguments).exits(2).says(&["--path"]);
    let two = [path("bezier"), path("flight")];
    let arguments = ["convert", text(&two[0]), "--path", text(&two[1]), "-o", text(&output)];
    run(arguments).exits(2).says(&["only once"]);
    let arguments = ["convert", text(&two[0]), "-o", text(&output), "--model-up", "Z"];
    run(arguments).exits(2).says(&["one line"]);
    let arguments = ["convert", text(&two[0]), "-o", text(&output), "--ease", "in"];
    run(arguments).exits(2).says(&["constant-speed"]);
    let arguments = ["sample", text(&chain), "--timing", "chord"];
    run(arguments).exits(2).says(&["--path"]);
    for wrong in [["--speed", "-3"], ["--time-scale", "0"], ["--bank", "nan"]] {
        run(["convert", text(&two[0])].iter().chain(&wrong)).exits(2).says(&["expected a number"]);
    }
    let refused =
        ["convert", text(&path("chordal")), "-o", text(&output), "--timing", "uniform"].map(str::to_owned);
    run(refused).exits(1).says(&["catmull-rom", "constant-speed"]);
    assert!(!output.exists());
}

#[test]
fn time_scale_is_for_everything() {
    let folder = tempfile::tempdir().unwrap();
    let (chain, way, output) = (keyframes("single-even"), path("flight"), folder.path().join("out.glb"));
    let arguments = ["convert", text(&chain), "--path", text(&way), "-o", text(&output), "--time-scale", "4"];
    let json = run(arguments.iter().chain(&["--json"])).exits(0).json();
    assert_eq!(json["seconds"].as_f64(), Some(10.0), "the flight's 40 s are longer than the keys'");
    run(["check", text(&output), "--against", text(&chain), "--against", text(&way)]).exits(0);
}

#[test]
fn ends_that_a_path_does_not_have_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    for (name, ends, warned) in
        [("bezier", "clamped", true), ("bezier", "closed", false), ("flight", "clamped", false)]
    {
        let (input, said) = (path(name), ["--path-ends", ends]);
        let made = run(["convert", text(&input), "-o", text(&output)].iter().chain(&said)).exits(0);
        assert_eq!(made.stderr.contains("[IDLE_ENDS]"), warned, "{name} {ends}: {}", made.stderr);
    }
}

#[test]
fn angles_without_times_last_as_long_as_the_path() {
    let folder = tempfile::tempdir().unwrap();
    let (angles, output) = (folder.path().join("angles.dat"), folder.path().join("out.glb"));
    fs::write(&angles, "# euler\n0 0 0\n0 0 90\n0 0 90\n").unwrap();
    let (bezier, made) = (path("bezier"), text(&output));
    run(["convert", text(&angles), "--path", text(&bezier), "-o", made]).exits(0);
    run(["check", made, "--against", text(&angles), "--against", text(&bezier)]).exits(0);
    let table = run([
        "sample",
        text(&angles),
        "--path",
        text(&bezier),
        "--count",
        "2",
        "--as",
        "euler",
        "--frame",
        "frd",
    ]);
    let yaw = |row: usize| -> f64 {
        let row = table.out().lines().nth(1 + row).unwrap().to_owned();
        row.split(',').nth(3).unwrap().parse().unwrap()
    };
    // Half way along the path, after 7.5 s, is the second of three keys.
    assert!((yaw(1) - 90.0).abs() < 1e-9 && (yaw(2) - 90.0).abs() < 1e-9, "{}", table.out());
    // One that has a time of its own keeps it, and holds; the summary says so.
    fs::write(&angles, "# euler 6\n0 0 0\n0 0 90\n0 0 90\n").unwrap();
    let said = run(["convert", text(&angles), "--path", text(&bezier), "-o", made]).exits(0);
    assert!(said.stderr.contains("rotations end at 6 s and hold"), "{}", said.stderr);
}

//! What stands beside the object: cameras, copies of it, and the path itself.

use crate::support::stage::Stage;
use crate::support::tool::{program, run};
use crate::support::{fixtures, keyframes};
use glam::DVec3;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

fn path(name: &str) -> String {
    text(&fixtures().join("paths").join(format!("{name}.dat"))).to_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A folder, and the file in it that conversions write.
fn output() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.glb");
    (folder, output)
}

fn convert(input: &str, output: &Path, flags: &[&str]) {
    run(["convert", input, "-o", text(output)].iter().chain(flags)).exits(0);
    let checked = run(["check", text(output)]).exits(0);
    assert!(!checked.out().contains(": warning "), "{}", checked.out());
}

#[test]
fn cameras_look_at_their_target() {
    let (_folder, output) = output();
    let camera = path("camera");
    let root = format!("{camera},look-at=root");
    let point = format!("{camera},look-at=1:2.5:-3");
    let flags = ["--camera", &root, "--camera", &point, "--camera", "follow", "--camera", "keys"];
    convert(&path("flight"), &output, &flags);
    let mut stage = Stage::open(&output);
    for i in 0..=200 {
        let t = stage.clip.duration * f64::from(i) / 200.0;
        let root = stage.place("root", t);
        // Between samples both are where float32 and straight lines have them.
        assert!(stage.off_target("camera-path", root, t) < 0.01, "at {t}");
        assert!(stage.off_target("camera-path-2", DVec3::new(1.0, 2.5, -3.0), t) < 0.01, "at {t}");
        assert!(stage.off_target("camera-follow", root, t) < 1e-3, "at {t}");
        for name in ["camera-path", "camera-path-2"] {
            let across = stage.axis(name, DVec3::X, t);
            assert!(across.y.abs() < 1e-3, "the horizon of {name} is level at {t}");
        }
        let forward = stage.axis("root", DVec3::Z, t);
        let behind = stage.place("camera-follow", t) - root;
        assert!(behind.dot(forward) < 0.0 && behind.dot(stage.axis("root", DVec3::Y, t)) > 0.0);
    }
}

#[test]
fn still_cameras_stand_beside_key_points() {
    let (_folder, output) = output();
    convert(&path("polyline"), &output, &["--camera", "keys"]);
    let mut stage = Stage::open(&output);
    let points: Vec<DVec3> = rows(&path("polyline"));
    let count = stage.names().iter().filter(|name| name.starts_with("camera-key-")).count();
    assert_eq!(count, points.len());
    for (i, &point) in points.iter().enumerate() {
        let name = format!("camera-key-{}", i + 1);
        assert!(stage.off_target(&name, point, 0.0) < 1e-3, "{name}");
        assert!(stage.place(&name, 0.0).distance(point) > 0.0);
    }
}

/// The points of a file whose rows are `x y z`.
fn rows(path: &str) -> Vec<DVec3> {
    let text = fs::read_to_string(path).unwrap();
    let lines = text.lines().map(|line| line.split('#').next().unwrap().trim());
    let numbers = |line: &str| line.split_whitespace().map(|n| n.parse().unwrap()).collect::<Vec<f64>>();
    lines.filter(|line| !line.is_empty()).map(|line| DVec3::from_slice(&numbers(line))).collect()
}

#[test]
fn a_camera_looks_along_its_own_way_or_by_rotations_of_its_own() {
    let (folder, output) = output();
    let turns = folder.path().join("turns.dat");
    // In aerospace's axes: yaw turns the nose to the right, +Z towards −X.
    fs::write(&turns, "# euler\n0 0 0\n0 0 90\n").unwrap();
    let quaternions = folder.path().join("still.dat");
    fs::write(&quaternions, "# 1\n0 1 0 0 0\n9 1 0 0 0\n").unwrap();
    let camera = path("camera");
    let cameras = [
        camera.clone(),
        format!("{camera},rotation={}", text(&turns)),
        format!("{camera},rotation={}", text(&quaternions)),
    ];
    let flags: Vec<&str> = cameras.iter().flat_map(|camera| ["--camera", camera]).collect();
    convert(&path("flight"), &output, &flags);
    let mut stage = Stage::open(&output);
    let end = stage.clip.duration;
    for i in 1..100 {
        let (t, h) = (end * f64::from(i) / 100.0, 1e-2 * end);
        let ahead = stage.place("camera-path", t + h);
        // A chord of a hundredth of the way lags behind the direction by what it turns.
        assert!(stage.off_target("camera-path", ahead, t) < 10.0, "at {t}");
    }
    let looks = |stage: &mut Stage, name: &str, t: f64| stage.axis(name, DVec3::NEG_Z, t);
    assert!((looks(&mut stage, "camera-path-2", 0.0) - DVec3::Z).length() < 1e-6);
    assert!((looks(&mut stage, "camera-path-2", end) - DVec3::NEG_X).length() < 1e-6);
    let half = DVec3::new(-1.0, 0.0, 1.0).normalize();
    assert!((looks(&mut stage, "camera-path-2", end / 2.0) - half).length() < 1e-4);
    assert!((looks(&mut stage, "camera-path-3", 5.0) - DVec3::NEG_Z).length() < 1e-6);
}

#[test]
fn a_camera_on_its_target_keeps_its_last_view() {
    let (folder, output) = output();
    let through = folder.path().join("through.dat");
    fs::write(&through, "# polyline 4\n-2 0 0\n2 0 0\n").unwrap();
    let object = folder.path().join("object.dat");
    fs::write(&object, "# polyline 4\n0 0 -1\n0 0 1\n").unwrap();
    let camera = format!("{},look-at=0:0:0", text(&through));
    // The view turns by 180° at once there, of which users are warned.
    run(["convert", text(&object), "-o", text(&output), "--camera", &camera]).exits(0);
    let mut stage = Stage::open(&output);
    let ahead = |stage: &mut Stage, t: f64| stage.axis("camera-path", DVec3::NEG_Z, t);
    assert!((ahead(&mut stage, 1.0) - DVec3::X).length() < 1e-6);
    assert!((ahead(&mut stage, 2.0) - DVec3::X).length() < 1e-6, "where both meet");
    assert!((ahead(&mut stage, 3.0) - DVec3::NEG_X).length() < 1e-6);
}

#[test]
fn cameras_stand_alone_on_leaves() {
    let (_folder, output) = output();
    let camera = path("camera");
    convert(&path("flight"), &output, &["--camera", &camera, "--camera", "follow", "--camera", "keys"]);
    let stage = Stage::open(&output);
    let cameras: Vec<_> = stage.asset.root().nodes.iter().filter(|node| node.camera.is_some()).collect();
    assert!(cameras.len() > 10);
    assert!(cameras.iter().all(|node| node.mesh.is_none() && node.children.is_none()));
}

#[test]
fn what_cameras_lack_is_said() {
    let (_folder, output) = output();
    let chain = text(&keyframes("chain-even")).to_owned();
    let refused = |camera: &str, code, words: &[&str]| {
        run(["convert", &chain, "-o", text(&output), "--camera", camera]).exits(code).says(words);
    };
    refused("keys", 2, &["key points", "--path"]);
    refused("nowhere.dat", 1, &["nowhere.dat", "expected a file"]);
    refused(&path("euler"), 1, &["expected the path of a camera", "rotation="]);
    refused(&format!("{},rotation={chain}", path("camera")), 1, &["one camera", "4 boxes"]);
    refused("follow,look-at=root", 2, &["does not go with"]);
    assert!(!output.exists());
}

#[test]
fn copies_follow_one_another_and_share_what_they_can() {
    let (_folder, output) = output();
    convert(&path("bezier"), &output, &["--repeat", "4", "--delay", "2.5"]);
    run(["check", text(&output), "--against", &path("bezier")]).exits(0);
    let mut stage = Stage::open(&output);
    let end = stage.clip.duration;
    for copy in 2..=4 {
        let (name, delay) = (format!("root-{copy}"), 2.5 * f64::from(copy - 1));
        for i in 0..300 {
            let t = end * f64::from(i) / 300.0;
            let on = (t - delay).rem_euclid(end);
            // But for the last millisecond before the wrap, when it is on its way back.
            if end - on > 2e-3 {
                let off = stage.place(&name, t).distance(stage.place("root", on));
                // Between samples both run along the same straight lines, times being
                // rounded to 1e-6 s where the speed is a few units a second.
                assert!(off < 1e-4, "{name} at {t}: {off}");
            }
        }
    }
    let root = stage.asset.root();
    assert_eq!(root.meshes.len(), 1);
    let lengths: Vec<u64> = root.buffer_views.iter().map(|view| view.byte_length.0).collect();
    let one = 901 * 28; // rotations and places of one object
    assert!(lengths[2] < 2 * one + 5 * 4 * 910, "all copies' values in two objects' room: {lengths:?}");
}

#[test]
fn copies_that_do_not_wrap_are_hidden_until_they_start() {
    let (_folder, output) = output();
    convert(&path("flight"), &output, &["--repeat", "3", "--delay", "4", "--no-wrap"]);
    run(["check", text(&output), "--against", &path("flight")]).exits(0);
    let mut stage = Stage::open(&output);
    assert_eq!(stage.clip.duration, 48.0);
    let size = |stage: &mut Stage, t: f64| stage.world("root-3", t).determinant();
    assert_eq!(size(&mut stage, 0.0), 0.0);
    assert_eq!(size(&mut stage, 7.9), 0.0);
    assert!((size(&mut stage, 8.0) - 1.0).abs() < 1e-12);
    let (late, first) = (stage.place("root-3", 30.0), stage.place("root", 22.0));
    assert!(late.distance(first) < 1e-3, "{late} {first}");
}

#[test]
fn copies_that_do_not_fit_are_refused() {
    let (_folder, output) = output();
    let arguments = ["convert", &path("flight"), "-o", text(&output), "--repeat", "30", "--delay", "4"];
    run(arguments).exits(1).says(&["30 objects 4 s apart need 120 s", "the way takes 40 s", "--no-wrap"]);
    let chain = keyframes("chain-even");
    run(["convert", text(&chain), "-o", text(&output), "--repeat", "3"]).exits(2).says(&["--path"]);
    run(["convert", &path("flight"), "-o", text(&output), "--delay", "3"]).exits(2).says(&["--repeat"]);
    assert!(!output.exists());
}

#[test]
fn the_path_is_shown_with_its_handles() {
    let (_folder, output) = output();
    convert(&path("bezier"), &output, &["--export-path"]);
    let mut stage = Stage::open(&output);
    for (i, point) in rows(&path("bezier")).into_iter().enumerate() {
        let handle = stage.place(&format!("control-{}", i + 1), 0.0);
        assert!(handle.distance(point) < 1e-6 * point.length(), "{handle} {point}");
    }
    let root = stage.asset.root();
    let mesh = |name: &str| {
        let node = root.nodes.iter().find(|node| node.name.as_deref() == Some(name)).unwrap();
        &root.meshes[node.mesh.unwrap().value()].primitives[0]
    };
    let strip = gltf::json::validation::Checked::Valid(gltf::json::mesh::Mode::LineStrip);
    assert!(["path", "control-polygon"].iter().all(|name| mesh(name).mode == strip));
    let accessor = |semantic| {
        let semantic = gltf::json::validation::Checked::Valid(semantic);
        mesh("path").attributes[&semantic].value()
    };
    let positions = accessor(gltf::json::mesh::Semantic::Positions);
    let colours = accessor(gltf::json::mesh::Semantic::Colors(0));
    let count = stage.asset.shape(positions).unwrap().count;
    let places = stage.asset.floats(positions, 0..count).unwrap();
    let colours = stage.asset.floats(colours, 0..count).unwrap();
    // 5 segments of 32 steps, and the end.
    assert_eq!(count, 161);
    let end = stage.clip.duration;
    for (i, place) in places.as_chunks::<3>().0.iter().enumerate() {
        let t = end * i as f64 / 160.0;
        let place = DVec3::from_array(place.map(f64::from));
        assert!(place.distance(stage.place("root", t)) < 1e-3, "point {i}");
    }
    let green: Vec<f32> = colours.as_chunks::<4>().0.iter().map(|c| c[1]).collect();
    assert!(green[160] > green[0], "colours grow lighter with time");
}

#[test]
fn lines_are_drawn() {
    let (_folder, output) = output();
    let picture = output.with_extension("png");
    convert(&path("bezier"), &output, &["--export-path", "--thumbnail", text(&picture)]);
    let with = image::open(&picture).unwrap().into_rgb8();
    convert(&path("bezier"), &output, &["--thumbnail", text(&picture)]);
    let without = image::open(&picture).unwrap().into_rgb8();
    let differing = with.pixels().zip(without.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing > 1000, "{differing} pixels");
}

/// Waits until something is so; the limit is for what is broken, not for what is slow.
fn wait_until(what: &str, mut so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn watching_converts_again_and_survives_errors() {
    let (folder, output) = output();
    let (input, log) = (folder.path().join("in.dat"), folder.path().join("log"));
    fs::write(&input, "# polyline 2\n0 0 0\n1 0 0\n").unwrap();
    let mut command = program();
    command.args(["convert", text(&input), "-o", text(&output), "--watch"]);
    command.stdin(Stdio::null()).stderr(fs::File::create(&log).unwrap());
    let mut child = command.spawn().unwrap();
    let said = || fs::read_to_string(&log).unwrap();
    let end = |output: &Path| Stage::open(output).place("root", 2.0);
    wait_until("it watches", || said().contains("watching 1 file"));
    assert_eq!(end(&output), DVec3::X);

    fs::write(&input, "# polyline 2\n0 0 0\n1 0 zero\n").unwrap();
    wait_until("errors are said", || said().contains("expected a number, found 'zero'"));
    assert_eq!(end(&output), DVec3::X, "the output stays");

    // As editors do: a new file takes the old one's name.
    let draft = folder.path().join("draft");
    fs::write(&draft, "# polyline 2\n0 0 0\n0 3 0\n").unwrap();
    fs::rename(&draft, &input).unwrap();
    wait_until("a replaced input counts", || end(&output) == DVec3::new(0.0, 3.0, 0.0));
    assert!(child.try_wait().unwrap().is_none(), "it goes on");
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn watching_needs_files() {
    run(["convert", "-", "-o", "out.glb", "--watch"]).exits(2).says(&["standard input or output"]);
}

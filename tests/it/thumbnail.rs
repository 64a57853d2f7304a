//! `dat2glb thumbnail`, and `convert --thumbnail`: pictures by both renderers.

use crate::support::tool::{Ran, finish, names, program, run, run_in};
use crate::support::{ACCEPT, accept, fixtures, keyframes};
use image::RgbaImage;
use std::fs;
use std::path::Path;

/// Set to 1 where an adapter must be found, as CI does.
const REQUIRED: &str = "DAT2GLB_REQUIRE_ADAPTER";

/// A folder with swing.glb, the showcase, 4 boxes and 10 s.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("swing.glb");
    run([keyframes("chain-even").as_os_str(), output.as_os_str(), "-q".as_ref()]).exits(0);
    folder
}

/// Draws swing.glb to out.png, small and in software unless the options say otherwise.
fn draw(folder: &Path, options: &[&str]) -> Ran {
    let mut arguments = vec!["thumbnail", "swing.glb", "-o", "out.png"];
    for [option, value] in [["--size", "128x128"], ["--renderer", "cpu"]] {
        if !options.contains(&option) {
            arguments.extend([option, value]);
        }
    }
    arguments.extend(options);
    run_in(folder, arguments)
}

fn picture(path: &Path) -> RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgba8()
}

/// The share of pixels that differ by more than 8 levels in some channel.
fn differing(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let far = a.pixels().zip(b.pixels()).filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 8));
    far.count() as f64 / f64::from(a.width() * a.height())
}

/// Whether wgpu has anything to draw with; where that is not a must, says so.
fn adapter(folder: &Path) -> bool {
    let ran = draw(folder, &["--renderer", "wgpu"]);
    let required = std::env::var_os(REQUIRED).is_some_and(|value| value == "1");
    if ran.code == 4 && !required {
        eprintln!("NOT RUN for want of a graphics adapter: {}", ran.stderr);
        return false;
    }
    ran.exits(0);
    true
}

/// Small pictures in fixtures/thumbnails are what was seen, looked at and found good.
#[test]
fn both_renderers_draw_the_pictures_that_were_looked_at() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let mut wgpu = None;
    for name in ["chain-even", "body-free"] {
        let input = keyframes(name);
        run_in(path, [input.as_os_str(), "swing.glb".as_ref(), "-q".as_ref()]).exits(0);
        let good = fixtures().join("thumbnails").join(format!("{name}.png"));
        for renderer in ["cpu", "wgpu"] {
            if renderer == "wgpu" && !*wgpu.get_or_insert_with(|| adapter(path)) {
                continue;
            }
            draw(path, &["--time", "3.1", "--renderer", renderer]).exits(0);
            if accept() && renderer == "cpu" {
                fs::copy(path.join("out.png"), &good).unwrap();
            }
            let share = differing(&picture(&path.join("out.png")), &picture(&good));
            assert!(
                share <= 0.005,
                "{name} by {renderer}: {:.2} % of the pixels differ from {}; if they are better, {ACCEPT}=1 \
                 writes them down",
                share * 100.0,
                good.display()
            );
        }
    }
}

/// The tolerance of the comparison is not so wide that it sees nothing.
#[test]
fn another_moment_is_another_picture() {
    let folder = folder();
    let path = folder.path();
    let at = |time: &str| {
        draw(path, &["--time", time]).exits(0);
        picture(&path.join("out.png"))
    };
    let good = picture(&fixtures().join("thumbnails/chain-even.png"));
    assert!(differing(&at("3.1"), &good) <= 0.005);
    assert!(differing(&at("3.3"), &good) > 0.02);
    // A share of the clip is a time.
    assert!(at("31%") == at("3.1"));
    assert!(at("50%") == at("5"));
    let last = at("10");
    let ran = draw(path, &["--time", "99"]).exits(0);
    assert!(
        ran.stderr.contains("99 s is after the clip's end") && ran.stderr.contains("10 s"),
        "{}",
        ran.stderr
    );
    assert!(picture(&path.join("out.png")) == last);
}

#[test]
fn the_software_picture_does_not_depend_on_threads() {
    let folder = folder();
    let drawn = |threads: &str| {
        let mut command = program();
        command.current_dir(&folder).env("RAYON_NUM_THREADS", threads);
        command.args(["thumbnail", "swing.glb", "-o", "-", "--renderer", "cpu", "--size", "200x100"]);
        finish(&mut command, b"").exits(0).stdout
    };
    let one = drawn("1");
    assert!(one.starts_with(b"\x89PNG") && one == drawn("5"));
    let decoded = image::load_from_memory(&one).unwrap();
    assert_eq!((decoded.width(), decoded.height()), (200, 100));
}

#[test]
fn the_default_is_512_by_512_half_way_beside_the_file() {
    let folder = folder();
    run_in(folder.path(), ["thumbnail", "swing.glb", "--renderer", "cpu", "-q"]).exits(0);
    assert_eq!(names(folder.path()), ["swing.glb", "swing.png"]);
    let default = picture(&folder.path().join("swing.png"));
    draw(folder.path(), &["--size", "512x512", "--time", "5"]).exits(0);
    assert!(picture(&folder.path().join("out.png")) == default);
}

#[test]
fn clips_are_chosen_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let input = keyframes("large-steps");
    run_in(path, [input.as_os_str(), "swing.glb".as_ref(), "--scheme=slerp,squad".as_ref()]).exits(0);
    let of = |options: &[&str]| {
        draw(path, &[options, &["--time", "1.9"]].concat()).exits(0);
        picture(&path.join("out.png"))
    };
    let slerp = of(&["--clip", "large-steps-slerp"]);
    assert!(slerp == of(&[]));
    assert!(differing(&slerp, &of(&["--clip", "large-steps-squad"])) > 0.01);
    let ran = draw(path, &["--clip", "large-steps"]).exits(2);
    ran.says(&["`large-steps`", "`large-steps-slerp`", "`large-steps-squad`"]);
}

#[test]
fn convert_draws_what_it_wrote() {
    let folder = folder();
    let path = folder.path();
    let input = keyframes("chain-even");
    let arguments = ["convert", input.to_str().unwrap(), "-o", "swing.glb", "--thumbnail", "thumb.png"];
    run_in(path, arguments).exits(0);
    let converted = picture(&path.join("thumb.png"));
    assert_eq!(converted.dimensions(), (512, 512));
    let later = ["thumbnail", "swing.glb", "-o", "out.png", "--renderer", "auto"];
    run_in(path, later).exits(0);
    assert!(differing(&converted, &picture(&path.join("out.png"))) <= 0.005);
    // A refused input leaves the picture as it was.
    let before = fs::read(path.join("thumb.png")).unwrap();
    let refused = fixtures().join("refused/nan.dat");
    let arguments = ["convert", refused.to_str().unwrap(), "-o", "swing.glb", "--thumbnail", "thumb.png"];
    run_in(path, arguments).exits(1);
    assert!(fs::read(path.join("thumb.png")).unwrap() == before);
}

#[test]
fn command_lines_that_make_no_sense() {
    let folder = folder();
    let check = |options: &[&str], exit: i32, words: &[&str]| {
        draw(folder.path(), options).exits(exit).says(words);
        assert_eq!(names(folder.path()), ["swing.glb"], "{options:?}");
    };
    check(&["--size", "0x5"], 2, &["width and height"]);
    check(&["--size", "512"], 2, &["512x512"]);
    check(&["--time", "half"], 2, &["50%"]);
    check(&["--time=-1"], 2, &["seconds"]);
    check(&["--renderer", "opengl"], 2, &["auto", "wgpu", "cpu"]);
    let input = keyframes("two-keys");
    let no_gltf = ["thumbnail", input.to_str().unwrap(), "-o", "x.png", "--renderer", "cpu"];
    run_in(folder.path(), no_gltf).exits(1).says(&["two-keys.dat"]);
    let itself = ["thumbnail", "swing.glb", "-o", "swing.glb", "--renderer", "cpu"];
    run_in(folder.path(), itself).exits(2).says(&["no input"]);
    let a_folder = ["thumbnail", "swing.glb", "-o", ".", "--renderer", "cpu"];
    run_in(folder.path(), a_folder).exits(2).says(&["found a directory"]);
    assert_eq!(names(folder.path()), ["swing.glb"]);
}

/// Machines without graphics get a picture all the same, and are told how it was made.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_software_draws_and_says_so() {
    let folder = folder();
    let without = |renderer: &str| {
        let mut command = program();
        command.current_dir(&folder);
        for drivers in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "__EGL_VENDOR_LIBRARY_FILENAMES"] {
            command.env(drivers, "/nowhere");
        }
        command.args([
            "thumbnail",
            "swing.glb",
            "-o",
            "out.png",
            "--size",
            "128x128",
            "--renderer",
            renderer,
        ]);
        finish(&mut command, b"")
    };
    let wgpu = without("wgpu").exits(4);
    wgpu.says(&["no graphics adapter: ", "mesa-vulkan-drivers", "vulkan-swrast"]);
    assert_eq!(names(folder.path()), ["swing.glb"]);
    let auto = without("auto").exits(0);
    assert!(auto.stderr.contains("drawn by the built-in software renderer"), "{}", auto.stderr);
    let said = fs::read(folder.path().join("out.png")).unwrap();
    draw(folder.path(), &[]).exits(0);
    assert!(fs::read(folder.path().join("out.png")).unwrap() == said);
}

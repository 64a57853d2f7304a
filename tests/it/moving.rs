//! `dat2glb thumbnail`: sheets, ghosts, clips side by side, cameras, moving pictures.

use crate::support::keyframes;
use crate::support::tool::{Ran, names, run, run_in};
use image::{AnimationDecoder, RgbaImage};
use std::fs;
use std::io::Cursor;
use std::path::Path;

/// A folder with `swing.glb`: of a fixture, with these options.
fn folder(fixture: &str, options: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("swing.glb");
    let input = keyframes(fixture);
    let arguments = [&[input.to_str().unwrap(), output.to_str().unwrap(), "-q"], options].concat();
    run(arguments).exits(0);
    folder
}

/// Draws swing.glb in software.
fn draw(folder: &Path, output: &str, options: &[&str]) -> Ran {
    let arguments = ["thumbnail", "swing.glb", "-o", output, "--renderer", "cpu"];
    run_in(folder, [&arguments, options].concat())
}

fn still(folder: &Path, options: &[&str]) -> RgbaImage {
    draw(folder, "out.png", options).exits(0);
    image::open(folder.join("out.png")).unwrap().to_rgba8()
}

#[test]
fn a_contact_sheet_has_a_cell_a_moment() {
    let folder = folder("chain-even", &[]);
    let sheet = still(folder.path(), &["--sheet", "4x3", "--size", "100x80"]);
    assert_eq!(sheet.dimensions(), (4 * 100 + 6, 3 * 80 + 4));
    let last = still(folder.path(), &["--time", "100%", "--size", "100x80"]);
    let cell = image::imageops::crop_imm(&sheet, 306, 164 + 30, 100, 50).to_image();
    assert!(cell == image::imageops::crop_imm(&last, 0, 30, 100, 50).to_image());
}

#[test]
fn every_clip_is_shown_side_by_side() {
    let folder = folder("large-steps", &["--scheme", "slerp,squad,bessel"]);
    let row = still(folder.path(), &["--side-by-side", "--time", "1.9", "--size", "64x64"]);
    assert_eq!(row.dimensions(), (3 * 64 + 4, 64));
    let sheet = still(folder.path(), &["--side-by-side", "--sheet", "5x1", "--size", "64x64"]);
    assert_eq!(sheet.dimensions(), (5 * 64 + 8, 3 * 64 + 4));
    let ghosts = still(folder.path(), &["--side-by-side", "--ghost", "3", "--size", "64x64"]);
    assert_eq!(ghosts.dimensions(), row.dimensions());
    draw(folder.path(), "out.gif", &["--side-by-side", "--size", "32x32", "--fps", "5", "--floor"]).exits(0);
    let gif = gif::Decoder::new(fs::File::open(folder.path().join("out.gif")).unwrap()).unwrap();
    assert_eq!((gif.width(), gif.height()), (3 * 32 + 4, 32));
}

#[test]
fn ghosts_end_at_the_time_asked_for() {
    let folder = folder("chain-even", &[]);
    let size = ["--size", "128x128"];
    let ghost = |options: &[&str]| still(folder.path(), &[&size, options].concat());
    assert!(ghost(&["--ghost", "4"]) == ghost(&["--ghost", "4", "--time", "100%"]));
    assert!(ghost(&["--ghost", "4"]) != ghost(&["--ghost", "4", "--time", "3"]));
    assert!(ghost(&["--ghost", "4", "--time", "3"]) != ghost(&["--ghost", "5", "--time", "3"]));
}

/// Frames and how long each is shown, milliseconds.
fn apng(path: &Path) -> (Vec<RgbaImage>, Vec<u32>) {
    let file = Cursor::new(fs::read(path).unwrap());
    let decoder = image::codecs::png::PngDecoder::new(file).unwrap();
    let frame = |frame: image::Frame| {
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        (frame.into_buffer(), numerator / denominator)
    };
    decoder.apng().unwrap().into_frames().map(|f| frame(f.unwrap())).unzip()
}

fn webp(path: &Path) -> (usize, Vec<u32>, bool) {
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(fs::read(path).unwrap())).unwrap();
    let mut pixels = vec![0; decoder.output_buffer_size().unwrap()];
    let delays = (0..decoder.num_frames()).map(|_| decoder.read_frame(&mut pixels).unwrap()).collect();
    (decoder.num_frames() as usize, delays, decoder.loop_count() == image_webp::LoopCount::Forever)
}

fn gif(path: &Path) -> (Vec<u32>, bool) {
    let mut decoder = gif::Decoder::new(fs::File::open(path).unwrap()).unwrap();
    let mut delays = Vec::new();
    while let Some(frame) = decoder.next_frame_info().unwrap() {
        delays.push(u32::from(frame.delay));
    }
    (delays, decoder.repeat() == gif::Repeat::Infinite)
}

#[test]
fn moving_pictures_last_as_long_as_the_clip_in_every_format() {
    let folder = folder("chain-uneven", &["--scheme", "bessel"]);
    let path = folder.path();
    let clip = run_in(path, ["inspect", "swing.glb", "--json"]).exits(0).json();
    let seconds = clip["clips"][0]["duration"].as_f64().unwrap_or_else(|| panic!("{clip}"));
    let options = ["--size", "48x48", "--fps", "23.976"];
    for output in ["out.gif", "out.apng", "out.webp"] {
        draw(path, output, &options).exits(0);
    }
    let (frames, of_apng) = apng(&path.join("out.apng"));
    let (count, of_webp, _) = webp(&path.join("out.webp"));
    let (of_gif, _) = gif(&path.join("out.gif"));
    assert_eq!((of_apng.len(), of_gif.len()), (count, count));
    let expected = (seconds * 1000.0).round() as u32;
    assert_eq!(of_apng.iter().sum::<u32>(), expected);
    assert_eq!(of_webp, of_apng);
    assert_eq!(of_gif.iter().sum::<u32>(), (seconds * 100.0).round() as u32);
    assert!(of_gif.iter().all(|delay| (2..=6).contains(delay)), "{of_gif:?}");
    for (frame, time) in [(0, "0".to_owned()), (24, (24.0 * 1000.0 / 23976.0).to_string())] {
        assert!(frames[frame] == still(path, &["--size", "48x48", "--time", &time]), "{frame}");
    }
}

#[test]
fn closed_clips_repeat_and_open_ones_play_once() {
    let closed = folder("closed-loop", &["--ends", "closed"]);
    let open = folder("large-steps", &[]);
    let size = ["--size", "32x32", "--fps", "10"];
    for (folder, options, repeats) in
        [(&closed, &[][..], true), (&open, &[][..], false), (&open, &["--loop"][..], true)]
    {
        for output in ["out.gif", "out.webp"] {
            draw(folder.path(), output, &[&size, options].concat()).exits(0);
        }
        assert_eq!(gif(&folder.path().join("out.gif")).1, repeats);
        assert_eq!(webp(&folder.path().join("out.webp")).2, repeats);
    }
    // What plays once ends with the last pose.
    draw(open.path(), "out.apng", &size).exits(0);
    let frames = apng(&open.path().join("out.apng")).0;
    assert!(*frames.last().unwrap() == still(open.path(), &["--size", "32x32", "--time", "100%"]));
}

#[test]
fn a_turntable_turns_and_backgrounds_are_seen() {
    let folder = folder("two-keys", &[]);
    let path = folder.path();
    draw(path, "out.apng", &["--turntable", "--size", "40x40", "--fps", "8", "--background", "transparent"])
        .exits(0);
    let frames = apng(&path.join("out.apng")).0;
    assert!(frames.iter().all(|f| f[(0, 0)].0 == [0; 4] && f.pixels().any(|p| p[3] == 255)));
    assert!(frames[1] != frames[0]);
    let corner = |background: &str| still(path, &["--size", "9x9", "--background", background])[(0, 0)].0;
    assert_eq!(corner("#fa0"), [255, 170, 0, 255]);
    assert_eq!(corner("navy"), [0, 0, 128, 255]);
    assert_eq!(corner("transparent"), [0; 4]);
}

#[test]
fn cameras_of_the_file_are_looked_through() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for kind in ["flight", "camera"] {
        fs::write(path.join(format!("{kind}.dat")), run(["example", kind]).exits(0).stdout).unwrap();
    }
    let cameras = ["--camera", "camera.dat,look-at=root", "--camera", "follow", "-q"];
    run_in(path, [&["flight.dat", "swing.glb"], &cameras[..]].concat()).exits(0);
    let through = |camera: &str| still(path, &["--camera", camera, "--size", "64x64", "--time", "3"]);
    let (follow, beside) = (through("camera-follow"), through("camera-path"));
    assert!(follow != beside && follow != still(path, &["--size", "64x64", "--time", "3"]));
    draw(path, "out.png", &["--camera", "me"]).exits(2).says(&["`me`", "`camera-follow`", "`camera-path`"]);
}

#[test]
fn command_lines_that_make_no_sense() {
    let folder = folder("two-keys", &[]);
    let check = |output: &str, options: &[&str], words: &[&str]| {
        draw(folder.path(), output, options).exits(2).says(words);
        assert_eq!(names(folder.path()), ["swing.glb"], "{options:?}");
    };
    check("out.gif", &["--sheet", "2x2"], &["--sheet", "images", "out.gif"]);
    check("out.webp", &["--ghost", "2"], &["--ghost", ".png"]);
    check("out.apng", &["--time", "1"], &["--time"]);
    check("out.png", &["--fps", "25"], &["--fps", "animations", ".webp"]);
    check("out.png", &["--turntable"], &["--turntable"]);
    check("-", &["--loop"], &["--loop"]);
    check("out.gif", &["--fps", "60"], &["at most 50", ".apng"]);
    check("out.gif", &["--fps", "1/60"], &["too few"]);
    check("out.gif", &["--fps", "0"], &["frames per second"]);
    check("out.mp4", &[], &[".gif", ".apng", ".webp"]);
    check("out.png", &["--sheet", "2x2", "--ghost", "3"], &["cannot be used with"]);
    check("out.png", &["--sheet", "2x2", "--time", "3"], &["cannot be used with"]);
    check("out.png", &["--side-by-side", "--clip", "x"], &["cannot be used with"]);
    check("out.gif", &["--turntable", "--camera", "x"], &["cannot be used with"]);
    check("out.png", &["--sheet", "0x2"], &["4x3"]);
    check("out.png", &["--sheet", "900x2"], &["900x2 cells", "16384"]);
    check("out.png", &["--ghost", "0"], &["--ghost"]);
    check("out.png", &["--background", "beigeish"], &["#rrggbb", "white"]);
    check("out.png", &["--camera", "x"], &["no camera named `x`"]);
}

#[test]
fn a_file_at_rest_has_nothing_to_play_but_may_turn() {
    let folder = folder("two-keys", &[]);
    let path = folder.path();
    let mut bytes = fs::read(path.join("swing.glb")).unwrap();
    // The same file without its animation.
    let at = bytes.windows(12).position(|w| w == b"\"animations\"").unwrap();
    bytes[at + 1..at + 11].copy_from_slice(b"animation_");
    fs::write(path.join("swing.glb"), bytes).unwrap();
    draw(path, "out.gif", &[]).exits(2).says(&["nothing to play", "turntable"]);
    draw(path, "out.gif", &["--turntable", "--size", "24x24", "--fps", "5"]).exits(0);
    assert_eq!(gif(&path.join("out.gif")), (vec![20; 20], true));
}

#[test]
fn moving_pictures_replace_a_file_whole_or_not_at_all() {
    let folder = folder("two-keys", &[]);
    let path = folder.path();
    fs::write(path.join("out.gif"), "before").unwrap();
    draw(path, "out.gif", &["--clip", "none"]).exits(2);
    assert_eq!(fs::read(path.join("out.gif")).unwrap(), b"before");
    draw(path, "out.gif", &["--size", "16x16"]).exits(0);
    assert!(fs::read(path.join("out.gif")).unwrap().starts_with(b"GIF89a"));
    assert_eq!(names(path), ["out.gif", "swing.glb"]);
}

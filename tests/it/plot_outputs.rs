//! `dat2glb plot`: every input, SVG and PNG, and what does not fit.

use crate::support::drawn::{panels, paths, plot, svg, words, words_stand_apart_and_within};
use crate::support::tool::{Ran, finish, names, program, run};
use crate::support::{fixtures, keyframes};
use resvg::tiny_skia::Pixmap;
use resvg::usvg::roxmltree::Document;
use std::fs;
use std::path::Path;

#[test]
fn png_has_the_asked_size_and_something_in_it() {
    let folder = tempfile::tempdir().unwrap();
    for (theme, ground) in [("light", [255, 255, 255]), ("dark", [24, 26, 31])] {
        let out = folder.path().join(format!("{theme}.PNG"));
        let more = ["--size", "640x400", "--component", "2", "--theme", theme, "-o", out.to_str().unwrap()];
        run(plot(&keyframes("chain-even"), &more)).exits(0);
        let picture = Pixmap::decode_png(&fs::read(&out).unwrap()).unwrap();
        assert_eq!((picture.width(), picture.height()), (640, 400));
        let same = |p: &resvg::tiny_skia::PremultipliedColorU8| [p.red(), p.green(), p.blue()] == ground;
        let behind = picture.pixels().iter().filter(|pixel| same(pixel)).count() as f64 / 256_000.0;
        assert!((0.6..0.99).contains(&behind), "{theme}: {behind}");
        assert!(picture.pixels().iter().all(|pixel| pixel.alpha() == 255));
    }
    assert_eq!(names(folder.path()), ["dark.PNG", "light.PNG"]);
}

#[test]
fn words_are_words_and_stand_apart_in_every_picture() {
    let chain = keyframes("chain-uneven");
    for (input, more) in [
        (chain.clone(), &["--scheme", "all"][..]),
        (chain.clone(), &["--scheme", "all", "--show", "speed", "--size", "700x420"]),
        (chain.clone(), &["--scheme", "all", "--show", "acceleration", "--theme", "dark"]),
        (chain, &["--show", "jerk", "--scheme", "bessel,natural-c2"]),
        (keyframes("large-steps"), &["--show", "sphere", "--scheme", "all"]),
        (keyframes("sixteen"), &["--show", "sphere"]),
        (paths("bezier"), &["--show", "path"]),
        (paths("frd"), &["--show", "path", "--theme", "dark"]),
        (paths("loop"), &["--show", "path"]),
        (paths("pauses"), &["--show", "path"]),
        (paths("camera"), &["--show", "curvature"]),
        (paths("euler-bezier"), &["--show", "speed"]),
        (paths("oriented"), &["--component", "1,2,3,4,5,6,7"]),
    ] {
        let text = svg(&input, more);
        words_stand_apart_and_within(&text, &format!("{} {more:?}", input.display()));
    }
}

#[test]
fn every_input_of_the_fixtures_can_be_drawn() {
    let folders = ["keyframes", "paths"].map(|name| fixtures().join(name));
    let inputs = folders.iter().flat_map(|folder| names(folder).into_iter().map(|name| folder.join(name)));
    for input in inputs.filter(|path| path.extension().is_some_and(|ending| ending == "dat")) {
        let is_path = input.parent().unwrap().ends_with("paths");
        for show in ["components", "speed", "acceleration", "sphere"] {
            let text = svg(&input, &["--show", show]);
            let document = Document::parse(&text).unwrap_or_else(|e| panic!("{}: {e}", input.display()));
            assert!(!panels(&document).is_empty() && !text.contains("NaN"), "{} {show}", input.display());
        }
        let rotations = input.file_name().unwrap().to_str().unwrap().contains("euler")
            || input.file_name().unwrap() == "quat-bezier.dat";
        let path = run(plot(&input, &["--show", "path", "-o", "-"]));
        if is_path && !rotations {
            path.exits(0);
        } else {
            path.exits(1).says(&["--show path needs a path", "found only rotations"]);
        }
    }
}

#[test]
fn a_hundred_thousand_keys_are_a_small_picture() {
    let row = |i: u32| {
        let (sin, cos) = (0.4 * (f64::from(i) * 0.9).sin()).sin_cos();
        format!("{} {cos} {sin} 0 0\n", f64::from(i) * 0.01)
    };
    let text: String = std::iter::once("# 1 2\n".to_owned()).chain((0..100_000).map(row)).collect();
    for more in
        [&["--show", "components"][..], &["--show", "speed", "--scheme", "slerp"], &["--show", "sphere"]]
    {
        let ran = finish(program().args(["plot", "-"]).args(more), text.as_bytes()).exits(0);
        assert!(ran.stdout.len() < 1_000_000, "{more:?}: {} bytes", ran.stdout.len());
        Document::parse(&ran.out()).unwrap();
    }
}

#[test]
fn odd_names_are_drawn_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("a & <b> $x$ \"q\".dat");
    fs::copy(keyframes("single-even"), &input).unwrap();
    let text = svg(&input, &["--component", "2"]);
    let words = words(&Document::parse(&text).unwrap());
    assert!(words.contains(&"a & <b> $x$ \"q\".dat: box 1".to_owned()), "{words:?}");
}

#[test]
fn outputs_go_where_they_are_sent() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("clip.dat");
    fs::copy(keyframes("single-even"), &input).unwrap();
    run(plot(&input, &[])).exits(0);
    assert_eq!(names(folder.path()), ["clip.dat", "clip.svg"]);
    let wrong = |out: &str, words: &[&str], code: i32| {
        let out = folder.path().join(out);
        let ran: Ran = run(plot(&input, &["-o", out.to_str().unwrap()]));
        ran.exits(code).says(words);
    };
    wrong("clip.pdf", &["clip.pdf: expected a name that ends in .svg or .png"], 2);
    wrong("clip", &[".svg or .png"], 2);
    wrong("nowhere/clip.svg", &["cannot be written"], 4);
    assert_eq!(names(folder.path()), ["clip.dat", "clip.svg"]);
}

#[test]
fn what_does_not_fit_says_so() {
    let chain = keyframes("chain-even");
    let out = ["-o", "-"];
    let refused = |input: &Path, more: &[&str], code: i32, words: &[&str]| {
        run(plot(input, &[more, &out].concat())).exits(code).says(words);
    };
    refused(&chain, &["--show", "path"], 1, &["chain-even.dat: --show path needs a path", "--path PATH.dat"]);
    refused(&chain, &["--show", "curvature"], 1, &["--show curvature needs a path"]);
    refused(&paths("flight"), &["--show", "jerk"], 1, &["--show jerk needs rotations", "found only a path"]);
    refused(
        &paths("flight"),
        &["--show", "sphere", "--orient", "none"],
        1,
        &["--show sphere needs rotations"],
    );
    refused(&chain, &["--show", "error"], 2, &["--show error needs a .glb or .gltf", "--against IN.dat"]);
    refused(&chain, &["--against", "x.dat"], 2, &["--against goes with --show error"]);
    refused(&chain, &["--box", "5"], 2, &["expected a box from 1 to 4, found 5"]);
    refused(&chain, &["--show", "sphere", "--box", "5"], 2, &["expected a box from 1 to 4, found 5"]);
    refused(&chain, &["--size", "300x200"], 2, &["at least for 4 panels", "found 300x200"]);
    refused(&chain, &["--size", "0x200"], 2, &["1 to 16384 pixels"]);
    refused(&chain, &["--show", "everything"], 2, &["sphere"]);
    refused(&chain, &["--scheme", "spline"], 2, &["catmull-rom"]);
    refused(&chain, &["--tension", "0.5"], 2, &["kochanek-bartels only"]);
    refused(&chain, &["--speed", "3"], 2, &["no path"]);
    let second = keyframes("chain-uneven");
    refused(&chain, &[second.to_str().unwrap()], 2, &["expected one input, found 2", "--all-figures"]);
    refused(&chain, &["--all-figures", "--show", "speed"], 2, &["--all-figures"]);
    refused(Path::new("missing.dat"), &[], 1, &["missing.dat: expected a file"]);
    refused(Path::new("clip.glb"), &[], 2, &["--show error --against IN.dat"]);
    refused(&fixtures().join("refused/nan.dat"), &[], 1, &["fixtures/refused/nan.dat"]);
    let apart = fixtures().join("refused/closed-ends-apart.dat");
    refused(&apart, &["--ends", "closed"], 1, &["closed ends"]);
}

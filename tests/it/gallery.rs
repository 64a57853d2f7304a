//! docs/gallery.md and its pictures are what the program draws now.
//!
//! `DAT2GLB_ACCEPT=1 cargo test --test it gallery` makes them anew.

use crate::support::tool::run;
use crate::support::{accept, keyframes, repository};
use dat2glb::curve::Scheme;
use image::RgbaImage;
use std::fs;
use std::path::{Path, PathBuf};

/// Pixels may differ in this share of a picture, by rounding on another machine.
const FEW: f64 = 0.005;
/// A pixel differs whose parts do by more.
const MUCH: u8 = 24;

const HEAD: &str = "\
# Gallery

What each scheme makes of the same keys: nine, unevenly spaced and up to 150° apart, of two boxes
([very-uneven.dat](../fixtures/keyframes/very-uneven.dat)). On the left the second component of the rows
(box 1's x) with the keys as dots, in the middle how fast box 1 turns, on the right the motion. Lines
that break in the middle are jumps in speed, which one sees; bends there are jumps in acceleration, which
one feels. `dat2glb plot YOURS.dat --scheme all` draws the same of your own keys, and
`dat2glb compare YOURS.dat` puts numbers to it.

Made by `DAT2GLB_ACCEPT=1 cargo test --test it gallery`.
";

/// The row of a scheme in docs/schemes.md: what happens between keys, and when to choose it.
fn words(scheme: Scheme) -> [String; 2] {
    let schemes = fs::read_to_string(repository().join("docs/schemes.md")).unwrap();
    let start = format!("| [`{}`]", scheme.name());
    let row = schemes.lines().find(|line| line.starts_with(&start));
    let row = row.unwrap_or_else(|| panic!("docs/schemes.md has no row for {}", scheme.name()));
    let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
    [cells[1].to_owned(), cells[2].to_owned()]
}

fn page() -> String {
    let mut page = HEAD.to_owned();
    for &scheme in Scheme::EVERY {
        let (name, [between, choose]) = (scheme.name(), words(scheme));
        page += &format!(
            "\n## {name}\n\nBetween keys: {between}. When to choose it: {choose}. \
             [How it works](math/{name}.md).\n\n\
             | One component | Angular speed | The motion |\n|---|---|---|\n\
             | ![{name}: a component over time](gallery/{name}-component.png) \
             | ![{name}: angular speed over time](gallery/{name}-speed.png) \
             | ![{name}: eight moments](gallery/{name}-sheet.png) |\n"
        );
    }
    page
}

/// Draws a scheme's three pictures into a folder.
fn draw(scheme: &str, folder: &Path) -> Vec<PathBuf> {
    let input = keyframes("very-uneven");
    let input = input.to_str().unwrap();
    let picture = |kind: &str| folder.join(format!("{scheme}-{kind}.png"));
    let [component, speed, sheet] = ["component", "speed", "sheet"].map(picture);
    let plot = |output: &Path, show: [&str; 2]| {
        let output = output.to_str().unwrap();
        run([&["plot", input, "--scheme", scheme, "--size", "420x300", "-o", output][..], &show].concat())
            .exits(0);
    };
    plot(&component, ["--component", "2"]);
    plot(&speed, ["--show", "speed"]);
    let file = folder.join("motion.glb");
    let (file, sheet_name) = (file.to_str().unwrap(), sheet.to_str().unwrap());
    run(["convert", input, "-o", file, "--scheme", scheme, "-q"]).exits(0);
    let how = ["--sheet", "4x2", "--size", "104x149", "--renderer", "cpu", "-q"];
    run([&["thumbnail", file, "-o", sheet_name][..], &how].concat()).exits(0);
    fs::remove_file(file).unwrap();
    vec![component, speed, sheet]
}

/// The share of pixels that differ.
fn differing(a: &RgbaImage, b: &RgbaImage) -> f64 {
    if a.dimensions() != b.dimensions() {
        return 1.0;
    }
    let differs =
        |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > MUCH);
    let count = a.pixels().zip(b.pixels()).filter(|pair| differs(*pair)).count();
    count as f64 / (a.width() as f64 * a.height() as f64)
}

#[test]
fn the_gallery_is_up_to_date() {
    const ADVICE: &str = "run DAT2GLB_ACCEPT=1 cargo test --test it gallery, and look at it";
    let (text, pictures) = (repository().join("docs/gallery.md"), repository().join("docs/gallery"));
    if accept() {
        fs::create_dir_all(&pictures).unwrap();
        fs::write(&text, page()).unwrap();
        Scheme::EVERY.iter().for_each(|scheme| drop(draw(scheme.name(), &pictures)));
    }
    assert!(fs::read_to_string(&text).unwrap() == page(), "docs/gallery.md is stale: {ADVICE}");
    let fresh = tempfile::tempdir().unwrap();
    for scheme in Scheme::EVERY {
        for drawn in draw(scheme.name(), fresh.path()) {
            let committed = pictures.join(drawn.file_name().unwrap());
            let [a, b] = [&drawn, &committed].map(|path| image::open(path).unwrap().into_rgba8());
            let share = differing(&a, &b);
            assert!(share <= FEW, "{} is stale ({share:.3} of it differs): {ADVICE}", committed.display());
        }
    }
    let expected = 3 * Scheme::EVERY.len();
    assert_eq!(fs::read_dir(&pictures).unwrap().count(), expected, "docs/gallery has others too");
}

//! Plots as the tool draws them, taken apart.

use super::fixtures;
use super::tool::run;
use resvg::usvg::fontdb::Database;
use resvg::usvg::roxmltree::{Document, Node};
use resvg::usvg::{self, Tree};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The tool's arguments.
pub(crate) fn plot(input: &Path, more: &[&str]) -> Vec<String> {
    let mut arguments = vec!["plot".to_owned(), input.to_str().unwrap().to_owned()];
    arguments.extend(more.iter().map(|&word| word.to_owned()));
    arguments
}

/// Runs the tool for an SVG on standard output.
pub(crate) fn svg(input: &Path, more: &[&str]) -> String {
    run(plot(input, &[more, &["-o", "-"]].concat())).exits(0).out()
}

pub(crate) fn paths(name: &str) -> PathBuf {
    fixtures().join("paths").join(format!("{name}.dat"))
}

pub(crate) fn all_with<'a>(document: &'a Document, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    document.descendants().filter(move |node| node.has_tag_name(name))
}

pub(crate) fn panels<'a>(document: &'a Document) -> Vec<Node<'a, 'a>> {
    all_with(document, "g").filter(|g| g.attribute("class") == Some("panel")).collect()
}

/// The words of a picture.
pub(crate) fn words(document: &Document) -> Vec<String> {
    all_with(document, "text").map(|text| text.text().unwrap_or_default().to_owned()).collect()
}

/// The lines of series in a panel: their colours and dashes.
pub(crate) fn lines<'a>(panel: &Node<'a, 'a>) -> Vec<(&'a str, Option<&'a str>)> {
    let paths = panel.descendants().filter(|node| node.has_tag_name("path"));
    let series = paths.filter(|path| matches!(path.attribute("stroke-width"), Some("2" | "1.2")));
    series.map(|path| (path.attribute("stroke").unwrap(), path.attribute("stroke-dasharray"))).collect()
}

/// The places that a path's `d` goes through.
pub(crate) fn places(d: &str) -> Vec<[f64; 2]> {
    let pair = |word: &str| {
        let (x, y) = word.split_once(' ').unwrap();
        [x, y].map(|number| number.parse().unwrap())
    };
    d.split(['M', 'L']).filter(|word| !word.is_empty()).map(pair).collect()
}

/// How far a place is from the straight line between two others.
pub(crate) fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (d, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let u = ((r[0] * d[0] + r[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
    (r[0] - u * d[0]).hypot(r[1] - u * d[1])
}

/// Boxes around all words, as DejaVu Sans has them: left, top, right, bottom.
fn boxes(svg: &str) -> Vec<(String, [f32; 4])> {
    let mut fonts = Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    let options = usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = Tree::from_str(svg, &options).unwrap();
    let mut found = Vec::new();
    collect(tree.root(), &mut found);
    found
}

fn collect(group: &usvg::Group, found: &mut Vec<(String, [f32; 4])>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => collect(group, found),
            usvg::Node::Text(text) => {
                let words = text.chunks().iter().map(|chunk| chunk.text()).collect();
                let b = text.abs_bounding_box();
                found.push((words, [b.left(), b.top(), b.right(), b.bottom()]));
            }
            _ => {}
        }
    }
}

#[track_caller]
pub(crate) fn words_stand_apart_and_within(svg: &str, what: &str) {
    let document = Document::parse(svg).unwrap();
    let side = |name| document.root_element().attribute(name).unwrap().parse::<f32>().unwrap();
    let (width, height) = (side("width"), side("height"));
    let boxes = boxes(svg);
    assert!(!boxes.is_empty() && boxes.len() == words(&document).len());
    for (i, (text, [left, top, right, bottom])) in boxes.iter().enumerate() {
        let within = *left >= 0.0 && *top >= 0.0 && *right <= width && *bottom <= height;
        assert!(within, "{what}: {text:?} leaves the picture");
        for (other, b) in &boxes[..i] {
            // Boxes reach from the highest letters down to the lowest: digits fill neither end.
            let apart = *right <= b[0] || b[2] <= *left || *bottom <= b[1] + 6.0 || b[3] <= *top + 6.0;
            assert!(apart, "{what}: {text:?} and {other:?} overlap");
        }
    }
}

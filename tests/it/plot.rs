//! `dat2glb plot`: what is drawn, and where.

use crate::support::drawn::{
    distance, lines, panels, paths, places, plot, svg, words, words_stand_apart_and_within,
};
use crate::support::keyframes;
use crate::support::tool::{finish, program, run};
use resvg::usvg::roxmltree::{Document, Node};
use std::fs;
use std::path::{Path, PathBuf};

#[test]
fn a_panel_for_each_part_of_a_box_with_a_line_for_each_scheme() {
    let text = svg(&keyframes("chain-uneven"), &["--scheme", "slerp,catmull-rom,bessel", "--box", "3"]);
    let document = Document::parse(&text).unwrap();
    let panels = panels(&document);
    assert_eq!(panels.len(), 4);
    for panel in &panels {
        let lines = lines(panel);
        assert_eq!(lines.len(), 3);
        assert!(lines[0].0 != lines[1].0 && lines[1].1 != lines[2].1, "{lines:?}");
        // Keys of the fixture.
        let dots = panel.descendants().filter(|node| node.has_tag_name("circle")).count();
        assert_eq!(dots, fs::read_to_string(keyframes("chain-uneven")).unwrap().lines().count() - 1);
    }
    let words = words(&document);
    for expected in ["chain-uneven.dat: box 3", "slerp", "catmull-rom", "bessel", "keys", "time (s)"] {
        assert!(words.iter().any(|word| word == expected), "no {expected:?} in {words:?}");
    }
    assert!(words.contains(&"component 9: box 3, w".to_owned()));
}

#[test]
fn components_count_through_the_row_in_the_order_of_its_file() {
    let titles = |name: &str, components: &str| {
        let text = svg(&keyframes(name), &["--component", components]);
        let document = Document::parse(&text).unwrap();
        let titles = words(&document).into_iter().filter(|word| word.starts_with("component"));
        titles.collect::<Vec<_>>()
    };
    assert_eq!(titles("chain-even", "16,2"), ["component 16: box 4, z", "component 2: box 1, x"]);
    assert_eq!(titles("xyzw", "1,4"), ["component 1: box 1, x", "component 4: box 1, w"]);
    run(plot(&keyframes("chain-even"), &["--component", "17", "-o", "-"])).exits(2).says(&[
        "chain-even.dat: ",
        "components from 1 to 16",
        "found 17",
    ]);
    run(plot(&keyframes("chain-even"), &["--component", "0", "-o", "-"])).exits(2).says(&["--component"]);
}

#[test]
fn numbers_stand_where_their_axes_say() {
    // Keys at 0, 1 and 3 s whose x grows from 0 to 0.6: the line through them by slerp.
    let text = "# 1 2 xyzw\n0 0 0 0 1\n1 0.28 0 0 0.96\n3 0.6 0 0 0.8\n";
    let arguments = ["plot", "-", "--scheme", "slerp", "--component", "1"];
    let ran = finish(program().args(arguments), text.as_bytes()).exits(0);
    let out = ran.out();
    let document = Document::parse(&out).unwrap();
    let panel = panels(&document)[0];
    let circles: Vec<[f64; 2]> = panel
        .descendants()
        .filter(|node| node.has_tag_name("circle"))
        .map(|node| ["cx", "cy"].map(|c| node.attribute(c).unwrap().parse().unwrap()))
        .collect();
    assert_eq!(circles.len(), 3);
    let [a, b, c] = [circles[0], circles[1], circles[2]];
    let share = |i: usize| (b[i] - a[i]) / (c[i] - a[i]);
    assert!((share(0) - 1.0 / 3.0).abs() < 1e-3 && (share(1) - 0.28 / 0.6).abs() < 1e-3, "{circles:?}");
    let line = panel.descendants().find(|node| node.attribute("stroke-width") == Some("2")).unwrap();
    let line = places(line.attribute("d").unwrap());
    // Of the points in a pixel's column the lowest and the highest are drawn.
    let met = |key: &[f64; 2]| line.windows(2).any(|pair| distance(*key, pair[0], pair[1]) < 0.3);
    assert!(circles.iter().all(met), "{circles:?}");
    // Half way between the first two keys: sin of half of half the angle whose sine is 0.28.
    let x = a[0] + (b[0] - a[0]) / 2.0;
    let wanted = a[1] + (c[1] - a[1]) * (0.28f64.asin() / 2.0).sin() / 0.6;
    let near = line.iter().min_by(|p, q| (p[0] - x).abs().total_cmp(&(q[0] - x).abs())).unwrap();
    assert!((near[1] - wanted).abs() < 0.5, "{near:?} {wanted}");
}

#[test]
fn speed_jumps_at_the_keys_of_slerp_and_nowhere_else() {
    let text = svg(&keyframes("chain-uneven"), &["--scheme", "slerp,natural-c2", "--show", "speed"]);
    let document = Document::parse(&text).unwrap();
    let panel = panels(&document)[0];
    let series = panel.descendants().filter(|node| node.attribute("stroke-width") == Some("2"));
    let stretches: Vec<usize> =
        series.map(|path| path.attribute("d").unwrap().matches('M').count()).collect();
    let keys = fs::read_to_string(keyframes("chain-uneven")).unwrap().lines().count() - 1;
    assert_eq!(stretches, [keys - 1, 1]);
    let words = words(&document);
    assert!(words.contains(&"angular speed (°/s)".to_owned()) && words.contains(&"key times".to_owned()));
}

#[test]
fn frames_are_counted_where_that_is_asked() {
    let ticks = |more: &[&str]| {
        let text = svg(&keyframes("chain-even"), &[&["--component", "2"], more].concat());
        words(&Document::parse(&text).unwrap())
    };
    assert!(ticks(&[]).contains(&"10".to_owned()));
    let frames = ticks(&["--x", "frames"]);
    assert!(
        frames.contains(&"frame (25 a second)".to_owned()) && frames.contains(&"250".to_owned()),
        "{frames:?}"
    );
    let ntsc = ticks(&["--x", "frames", "--fps", "30000/1001"]);
    assert!(
        ntsc.contains(&"frame (29.97 a second)".to_owned()) && ntsc.contains(&"250".to_owned()),
        "{ntsc:?}"
    );
}

#[test]
fn sixteen_figures_are_one_page() {
    let inputs = [keyframes("chain-even"), keyframes("chain-uneven")];
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("figures.svg");
    let mut arguments = plot(&inputs[0], &[inputs[1].to_str().unwrap(), "--all-figures", "-o"]);
    arguments.push(out.to_str().unwrap().to_owned());
    run(arguments).exits(0);
    let text = fs::read_to_string(&out).unwrap();
    let document = Document::parse(&text).unwrap();
    let panels = panels(&document);
    assert_eq!(panels.len(), 16);
    for row in panels.chunks(4) {
        let counts: Vec<usize> = row.iter().map(|panel| lines(panel).len()).collect();
        assert_eq!(counts, [1, 1, 1, 3]);
        let single: Vec<_> = row[..3].iter().map(|panel| lines(panel)[0]).collect();
        assert_eq!(lines(&row[3]), single);
    }
    let words = words(&document);
    let count = |wanted: &str| words.iter().filter(|word| *word == wanted).count();
    for file in ["chain-even.dat", "chain-uneven.dat"] {
        for scheme in ["slerp", "catmull-rom", "bessel-overhauser", "all"] {
            assert_eq!(count(&format!("{file}: {scheme}")), 2, "{words:?}");
        }
    }
    assert_eq!((count("component 2 (box 1, x)"), count("component 16 (box 4, z)")), (8, 8));
    words_stand_apart_and_within(&text, "all figures");
}

#[test]
fn all_figures_of_other_inputs() {
    let one = svg(&keyframes("single-even"), &["--all-figures", "--scheme", "squad"]);
    let document = Document::parse(&one).unwrap();
    assert_eq!(panels(&document).len(), 2);
    assert!(words(&document).contains(&"component 4 (box 1, z)".to_owned()));
    // Many schemes stand below each other, a column for each component.
    let many = svg(&keyframes("chain-even"), &["--all-figures", "--scheme", "all"]);
    let document = Document::parse(&many).unwrap();
    let titles = words(&document).into_iter().filter(|word| word.starts_with("chain-even.dat: "));
    let titles: Vec<String> = titles.collect();
    assert_eq!((panels(&document).len(), &titles[0], &titles[20]), (22, &titles[1], &titles[21]));
    let chosen = svg(&keyframes("chain-even"), &["--all-figures", "--component", "3"]);
    assert_eq!(panels(&Document::parse(&chosen).unwrap()).len(), 4);
}

#[test]
fn a_path_is_seen_from_four_sides_at_one_scale() {
    let text = svg(&paths("bezier"), &["--show", "path"]);
    let document = Document::parse(&text).unwrap();
    let panels = panels(&document);
    assert_eq!(panels.len(), 4);
    let words = words(&document);
    for expected in
        ["x and y", "z and y", "x and z", "oblique", "control polygon", "0 s", "15 s", "x (units)"]
    {
        assert!(words.iter().any(|word| word == expected), "no {expected:?} in {words:?}");
    }
    // Colours run with time: many in each panel.
    for panel in &panels {
        let colours: std::collections::HashSet<&str> = panel
            .descendants()
            .filter(|node| node.attribute("stroke-width") == Some("2.6"))
            .map(|node| node.attribute("stroke").unwrap())
            .collect();
        assert!(colours.len() > 40, "{}", colours.len());
    }
    // Equal scales: the polygon spans as many pixels for x above as below, and its shares
    // are the file's.
    let spans = |panel: &Node| -> [f64; 2] {
        let polygon = panel.descendants().find(|node| node.attribute("stroke-dasharray") == Some("5 4"));
        let points = places(polygon.unwrap().attribute("d").unwrap());
        [0, 1].map(|i| {
            let values = || points.iter().map(|p| p[i]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        })
    };
    let rows: Vec<Vec<f64>> = fs::read_to_string(paths("bezier"))
        .unwrap()
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect())
        .collect();
    let extent = |i: usize| {
        let values = || rows.iter().map(|row| row[i]);
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    };
    let scale = spans(&panels[0])[0] / extent(0);
    for (panel, axes) in panels.iter().zip([[0, 1], [2, 1], [0, 2]]) {
        for (span, axis) in spans(panel).into_iter().zip(axes) {
            assert!((span - scale * extent(axis)).abs() < 0.05, "{axis}: {span}");
        }
    }
}

#[test]
fn speeds_of_a_path() {
    for (show, label) in [
        ("speed", "speed along the path (units/s)"),
        ("acceleration", "acceleration on the path (units/s²)"),
        ("curvature", "curvature of the path (1/units)"),
    ] {
        let text = svg(&paths("flight"), &["--show", show]);
        let document = Document::parse(&text).unwrap();
        assert_eq!((panels(&document).len(), lines(&panels(&document)[0]).len()), (1, 1), "{show}");
        assert!(words(&document).iter().any(|word| word == label), "{show}");
    }
    // What keyframes turn on a path has both speeds.
    let path = paths("flight");
    let both = svg(&keyframes("body-free"), &["--path", path.to_str().unwrap(), "--show", "speed"]);
    assert_eq!(panels(&Document::parse(&both).unwrap()).len(), 2);
    let places = svg(&paths("flight"), &[]);
    assert_eq!(panels(&Document::parse(&places).unwrap()).len(), 3);
}

#[test]
fn a_sphere_for_each_box() {
    let chain = keyframes("chain-even");
    let text = svg(&chain, &["--show", "sphere", "--scheme", "slerp,bessel"]);
    let document = Document::parse(&text).unwrap();
    let found = panels(&document);
    assert_eq!(found.len(), 4);
    assert!(found.iter().all(|panel| lines(panel).len() >= 2));
    let one = svg(&chain, &["--show", "sphere", "--box", "2"]);
    assert_eq!(panels(&Document::parse(&one).unwrap()).len(), 1);
    // Nothing is drawn beyond the sphere: the rim is the largest circle.
    let rim = found[0].descendants().find(|node| node.attribute("stroke-width") == Some("1.1")).unwrap();
    let rim = places(rim.attribute("d").unwrap());
    let middle = |i: usize| rim[..120].iter().map(|p| p[i]).sum::<f64>() / 120.0;
    let (x, y) = (middle(0), middle(1));
    let radius = (rim[0][0] - x).hypot(rim[0][1] - y);
    for path in found[0].descendants().filter(|node| node.attribute("stroke-width") == Some("2")) {
        for p in places(path.attribute("d").unwrap()) {
            assert!((p[0] - x).hypot(p[1] - y) <= radius + 0.05);
        }
    }
}

/// Converts a fixture into a folder; the file.
fn converted(folder: &Path, input: &Path, more: &[&str]) -> PathBuf {
    let out = folder.join("clip.glb");
    let mut arguments = vec!["convert", input.to_str().unwrap(), "-o", out.to_str().unwrap()];
    arguments.extend(more);
    run(arguments).exits(0);
    out
}

#[test]
fn playback_keeps_to_the_tolerance_that_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let input = keyframes("chain-even");
    let file = converted(folder.path(), &input, &["--tolerance", "0.05", "--scheme", "bessel"]);
    let against = ["--against", input.to_str().unwrap(), "--show", "error"];
    let text = svg(&file, &against);
    let document = Document::parse(&text).unwrap();
    let panels = panels(&document);
    assert_eq!(panels.len(), 4);
    let words = words(&document);
    assert!(
        words.contains(&"tolerance".to_owned()) && words.contains(&"box1: rotation".to_owned()),
        "{words:?}"
    );
    assert!(words.contains(&"deviation (°)".to_owned()));
    for panel in &panels {
        let path = |width: &str| {
            let path = panel.descendants().find(|node| node.attribute("stroke-width") == Some(width));
            places(path.unwrap().attribute("d").unwrap())
        };
        let (line, limit) = (path("1.2"), path("1.5"));
        // Down is less. Playback comes near the limit and stays below it.
        let highest = line.iter().map(|p| p[1]).fold(f64::MAX, f64::min);
        assert!(highest >= limit[0][1] - 0.05, "{highest} {limit:?}");
        assert!(highest <= limit[0][1] + 60.0, "{highest} {limit:?}");
    }
    // Another limit, one box.
    let one = svg(&file, &[&against[..], &["--tolerance", "0.01", "--box", "2"]].concat());
    assert_eq!(one.matches("class=\"panel\"").count(), 1);
}

#[test]
fn every_clip_of_a_file_is_a_line_under_the_bound_that_it_states() {
    let folder = tempfile::tempdir().unwrap();
    let input = keyframes("body-free");
    let file = converted(folder.path(), &input, &["--scheme", "slerp,squad,bessel"]);
    let against = ["--against", input.to_str().unwrap(), "--show", "error"];
    let text = svg(&file, &against);
    let document = Document::parse(&text).unwrap();
    assert_eq!(lines(&panels(&document)[0]).len(), 3);
    assert!(words(&document).contains(&"stated bound".to_owned()));
    let squad = svg(&file, &[&against[..], &["--scheme", "squad"]].concat());
    assert_eq!(lines(&panels(&Document::parse(&squad).unwrap())[0]).len(), 1);
    run(plot(&file, &[&against[..], &["--scheme", "nlerp", "-o", "-"]].concat()))
        .exits(2)
        .says(&["--scheme"]);
}

//! Motion that is hard on numbers: the outputs are finite, of unit length and sound, or a
//! message says what to do.

use crate::support::made::{Asked, Channel, Values, inputs, made};
use dat2glb::check::Severity;
use dat2glb::convert::{Fewest, Sampling};
use dat2glb::curve::{Ends, Scheme, Tcb};
use dat2glb::moves::{Orient, Shape};
use dat2glb::path::{PathEnds, Timing};
use dat2glb::sample::{Encoding, Writing};
use std::fmt::Write as _;
use std::time::{Duration, Instant};

/// Lines of a time and one quaternion under a header.
fn keys(rows: impl IntoIterator<Item = (f64, [f64; 4])>) -> String {
    let mut text = "# 1 2\n".to_owned();
    for (t, [w, x, y, z]) in rows {
        writeln!(text, "{t:e} {w:e} {x:e} {y:e} {z:e}").unwrap();
    }
    text
}

const ONE: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
const YEAR: f64 = 31_557_600.0;

/// A turn about an axis that changes from key to key, by so many radians a key.
fn turning(key: usize, radians: f64) -> [f64; 4] {
    let half = key as f64 * radians / 2.0;
    let mut q = [half.cos(), 0.0, 0.0, 0.0];
    q[1 + key % 3] = half.sin();
    q
}

/// Keys, and what is hard about them.
fn clips() -> Vec<(&'static str, String)> {
    let axes = [ONE, [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let at = |t: fn(usize) -> f64, q: &dyn Fn(usize) -> [f64; 4]| keys((0..6).map(|i| (t(i), q(i))));
    let second = |i: usize| i as f64;
    let scaled = |by: f64| move |i: usize| turning(i, 0.5).map(|x| x * by);
    let mixed = [0.0, 1e-6, YEAR, YEAR + 64.0, 2.0 * YEAR];
    // What is half a second's step swings round a hundred times within the next minute.
    let spinning = [0.0, 0.5, 60.5, 61.0, 121.0];
    vec![
        ("identical", at(second, &|_| [0.6, 0.8, 0.0, 0.0])),
        ("identical but for signs", at(second, &|i| if i % 2 == 0 { ONE } else { [-1.0, 0.0, 0.0, 0.0] })),
        ("half turns about one axis", at(second, &|i| axes[i % 2])),
        ("half turns about all axes", at(second, &|i| axes[i % 4])),
        ("half turns there and back", at(second, &|i| if i == 2 { axes[2] } else { axes[0] })),
        ("a billionth of a degree", at(second, &|i| turning(i, 1e-9_f64.to_radians()))),
        ("a microsecond apart", at(|i| i as f64 * 1e-6, &|i| turning(i, 0.3))),
        ("a microsecond apart, late", at(|i| 3600.0 + i as f64 * 1e-6, &|i| turning(i, 0.3))),
        ("a year apart", at(|i| i as f64 * YEAR, &|i| turning(i, 0.3))),
        ("a microsecond and a year", keys(mixed.into_iter().zip((0..).map(|i| turning(i, 0.3))))),
        ("half a second and a minute", keys(spinning.into_iter().zip((0..).map(|i| turning(i, 2.0))))),
        ("denormal lengths", at(second, &scaled(1e-310))),
        ("huge lengths", at(second, &scaled(1e300))),
        ("denormal parts", at(second, &|i| [1.0, i as f64 * 5e-324, 0.0, -1e-310])),
        ("two keys, the same", keys([(0.0, ONE), (1.0, ONE)])),
    ]
}

fn samplings() -> Vec<Sampling> {
    let rate = |fps: &str, key_times| Sampling::Rate { fps: fps.parse().unwrap(), key_times };
    let fewest = |cubic| {
        Sampling::Fewest(Fewest {
            tolerance: 0.01,
            distance: None,
            max_step: if cubic { Fewest::MAX_CUBIC_STEP } else { Fewest::MAX_STEP },
            on_curve: cubic,
            cubic,
        })
    };
    // Ten days to a frame: for years.
    vec![rate("10", true), rate("10", false), rate("1/864000", true), fewest(false), fewest(true)]
}

/// Asserts what holds for every output, or that the refusal helps; returns whether there
/// is an output.
#[track_caller]
fn is_sound_or_refused(name: &str, text: &str, asked: Asked) -> bool {
    let outcome = inputs(text).and_then(|inputs| made(&inputs, asked));
    let made = match outcome {
        Ok(made) => made,
        Err(message) => {
            helps(name, &message, &asked);
            return false;
        }
    };
    let report = made.report();
    assert!(report.worst() < Some(Severity::Error), "{name}: {asked:?}: {}", report.text("made.glb"));
    made.channels().iter().for_each(|channel| is_well_formed(name, channel, &asked));
    true
}

/// A refusal names its reason and a way out.
#[track_caller]
fn helps(name: &str, message: &str, asked: &Asked) {
    let ways = [
        "choose",
        "leave",
        "say",
        "--fps",
        "expected",
        "the largest",
        "add",
        "repeat",
        "must",
        "need at least",
    ];
    assert!(ways.iter().any(|way| message.contains(way)), "{name}: {asked:?}: {message}");
    assert!(!message.contains("NaN") && !message.contains("panicked"), "{name}: {asked:?}: {message}");
}

#[track_caller]
fn is_well_formed(name: &str, channel: &Channel, asked: &Asked) {
    let times = &channel.times;
    assert!(times.iter().all(|t| t.is_finite()) && times[0] >= 0.0, "{name}: {asked:?}: {times:?}");
    assert!(times.is_sorted_by(|a, b| a < b), "{name}: {asked:?}: {times:?}");
    match &channel.values {
        Values::Rotations(all) => {
            assert!(all.iter().flatten().all(|x| x.is_finite()), "{name}: {asked:?}");
            for q in channel.rotations() {
                let norm = q.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
                // Half a step of float32 in each part, or of 16 bits.
                let off = if asked.writing.encoding == Encoding::Float { 1.2e-7 } else { 6.2e-5 };
                assert!((norm - 1.0).abs() < off, "{name}: {asked:?}: {q:?} has length {norm}");
            }
        }
        Values::Translations(all) => {
            assert!(all.iter().flatten().all(|x| x.is_finite()), "{name}: {asked:?}");
        }
    }
}

fn plain(scheme: Scheme, shape: Shape, sampling: Sampling) -> Asked {
    Asked { scheme, shape, sampling, writing: Writing::default() }
}

#[test]
fn keys_by_every_scheme_and_all_ends() {
    let tcb = Tcb { tension: -1.0, continuity: 1.0, bias: 1.0 };
    for (name, text) in clips() {
        for &scheme in Scheme::EVERY {
            let mut outputs = 0;
            let by_rate = Ends::ALL.iter().map(|&ends| (ends, samplings()[0]));
            let others = if name.contains("year") { 2..5 } else { 3..5 };
            let otherwise = others.map(|i| (Ends::Natural, samplings()[i]));
            for (ends, sampling) in by_rate.chain(otherwise) {
                let shape = Shape { ends, tcb, ..Shape::default() };
                outputs += u32::from(is_sound_or_refused(name, &text, plain(scheme, shape, sampling)));
            }
            assert!(outputs > 0, "{name}: {} refuses it whatever is asked for", scheme.name());
        }
    }
}

#[test]
fn keys_as_whole_numbers_of_16_bits() {
    let writing = Writing { encoding: Encoding::Normalized16, ..Writing::default() };
    for (name, text) in clips() {
        for &scheme in Scheme::EVERY {
            let sampling = samplings()[0];
            let asked = Asked { writing, ..plain(scheme, Shape::default(), sampling) };
            is_sound_or_refused(name, &text, asked);
        }
    }
}

/// Points, and what is hard about them.
fn points() -> Vec<(&'static str, Vec<[f64; 3]>)> {
    let line = |step: f64| (0..7).map(|i| [f64::from(i) * step, 0.0, 0.0]).collect::<Vec<_>>();
    let zigzag = |size: f64| (0..7).map(|i| [size * f64::from(i % 2), size, -size * f64::from(i)]).collect();
    vec![
        ("all equal", vec![[3.0, -2.0, 1.0]; 7]),
        ("all at the origin", vec![[0.0; 3]; 7]),
        ("all but one equal", [vec![[0.0; 3]; 6], vec![[1.0, 0.0, 0.0]]].concat()),
        ("there and back", (0..7).map(|i| [f64::from(i % 2), 0.0, 0.0]).collect()),
        ("straight up", (0..7).map(|i| [0.0, f64::from(i), 0.0]).collect()),
        ("denormal", zigzag(1e-310)),
        ("denormal in float32", zigzag(1e-42)),
        ("huge", zigzag(1e29)),
        ("huge and tiny", (0..7).map(|i| [[1e30, 1e-30, -1e30], [1e-300; 3]][i % 2]).collect()),
        ("tiny steps far away", (0..7).map(|i| [1e9 + f64::from(i) * 1e-7, 0.0, 0.0]).collect()),
        ("tiny steps", line(1e-9)),
    ]
}

/// Under each kind's header, with how much time between rows, if any.
fn paths(points: &[[f64; 3]], step: Option<f64>) -> Vec<String> {
    let heads = [
        "bezier",
        "bezier degree=6",
        "catmull-rom",
        "catmull-rom-centripetal",
        "catmull-rom-chordal",
        "polyline",
    ];
    let text = |head: &&str| {
        let stride = match *head {
            "bezier" => 3,
            "bezier degree=6" => 6,
            _ => 1,
        };
        let mut text = format!("# {head}\n");
        for (i, [x, y, z]) in points.iter().enumerate() {
            if let Some(step) = step.filter(|_| i % stride == 0) {
                write!(text, "{:e} ", i as f64 * step).unwrap();
            }
            writeln!(text, "{x:e} {y:e} {z:e}").unwrap();
        }
        text
    };
    heads.iter().map(text).collect()
}

#[test]
fn paths_of_every_kind_timing_and_orientation() {
    let rate = Sampling::Rate { fps: "10".parse().unwrap(), key_times: true };
    for (name, points) in points() {
        for text in paths(&points, None) {
            let mut outputs = 0;
            let banked = |orient| Shape { orient: Some(orient), bank: 20.0, ..Shape::default() };
            let timings = [Timing::Uniform, Timing::Chord, Timing::ConstantSpeed];
            let timed = timings.map(|timing| Shape { timing: Some(timing), ..banked(Orient::Upright) });
            let ended = PathEnds::ALL.map(|path_ends| Shape { path_ends, ..banked(Orient::Tangent) });
            let shapes = Orient::ALL.map(banked).into_iter().chain(timed).chain(ended);
            for shape in shapes {
                outputs += u32::from(is_sound_or_refused(name, &text, plain(Scheme::Bessel, shape, rate)));
            }
            assert!(outputs > 0, "{name}: refused whatever is asked for: {text}");
        }
    }
}

#[test]
fn paths_of_every_kind_by_tolerance() {
    for (name, points) in points() {
        for text in paths(&points, None) {
            for sampling in samplings().into_iter().skip(3) {
                let asked = plain(Scheme::Bessel, Shape::default(), sampling);
                is_sound_or_refused(name, &text, asked);
            }
        }
    }
}

#[test]
fn paths_with_points_a_microsecond_and_a_year_apart() {
    for (name, points) in points() {
        for step in [1e-6, YEAR] {
            for text in paths(&points, Some(step)) {
                let sampling = samplings()[if step == YEAR { 2 } else { 0 }];
                is_sound_or_refused(name, &text, plain(Scheme::Bessel, Shape::default(), sampling));
            }
        }
    }
}

/// So many turns that the square of the angle is no number.
#[test]
fn angles_of_any_size() {
    let rate = samplings()[0];
    for huge in [1e18, 1e155, -3.3e170, f64::MAX] {
        let text = format!("# euler\n0 {huge:e} 3 8\n1 40 {huge:e} 9\n2 -6 0 {huge:e}\n3 0 0 150\n");
        for &scheme in Scheme::ALL {
            assert!(is_sound_or_refused("huge angles", &text, plain(scheme, Shape::default(), rate)));
        }
        let (bank, text) = (huge, "# catmull-rom 4\n0 0 0\n2 0 1\n3 0 4\n0 1 5\n");
        let banked = Shape { bank, orient: Some(Orient::Upright), ..Shape::default() };
        assert!(is_sound_or_refused("huge bank", text, plain(Scheme::Bessel, banked, rate)));
    }
}

/// A million keys that never move, in a build that is not optimised much.
#[test]
fn a_million_keys_that_never_move() {
    let text = keys((0..1_000_000).map(|i| (f64::from(i) * 0.01, ONE)));
    let started = Instant::now();
    let rate = Sampling::Rate { fps: "1".parse().unwrap(), key_times: false };
    let fewest = samplings()[3];
    let inputs = inputs(&text).unwrap();
    for sampling in [rate, fewest] {
        let made = made(&inputs, plain(Scheme::Bessel, Shape::default(), sampling)).unwrap();
        let report = made.report();
        assert!(report.worst() < Some(Severity::Error), "{}", report.text("made.glb"));
        assert_eq!(made.facts[0].tracks[0].deviation.map(|off| off < 1e-4), Some(true));
        if matches!(sampling, Sampling::Fewest(_)) {
            assert!(made.file.len() < 10_000, "{} bytes for what never moves", made.file.len());
        }
    }
    assert!(started.elapsed() < Duration::from_secs(120), "took {:?}", started.elapsed());
}

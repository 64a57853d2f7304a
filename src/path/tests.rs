//! What every path must do, whatever its kind.

use super::*;
use glam::{DMat3, DVec3};
use proptest::prelude::*;

const CATMULL_ROM: [Kind; 3] = [Kind::CatmullRom, Kind::CatmullRomCentripetal, Kind::CatmullRomChordal];
const UNEVEN: [f64; 6] = [3.0, 3.4, 5.0, 5.1, 7.0, 8.5];

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Unevenly spaced points with sharp turns.
fn bends() -> Vec<DVec3> {
    let points = [[0.0, 0.0, 0.0], [4.0, 0.5, 1.0], [5.0, 1.0, 0.0], [5.2, 3.0, -1.0], [2.0, 6.0, 0.5]];
    points.into_iter().chain([[-1.0, 2.0, 0.0]]).map(DVec3::from_array).collect()
}

/// Three cubics, smooth (C¹ under uniform timing) at their joints.
fn cubics() -> Vec<DVec3> {
    let keys = [v(0.0, 0.0, 0.0), v(2.0, 1.0, -1.0), v(3.0, 4.0, 1.0), v(0.0, 5.0, 0.0)];
    let handles = [v(0.5, 1.0, 0.0), v(1.0, 0.2, 0.4), v(-0.3, 0.7, 0.5), v(-1.0, 0.0, 0.3)];
    let segment = |i: usize| [keys[i], keys[i] + handles[i], keys[i + 1] - handles[i + 1]];
    (0..3).flat_map(segment).chain([keys[3]]).collect()
}

fn path(kind: Kind, points: &[DVec3], options: Options) -> Path {
    Path::new(kind, points, None, &options).unwrap()
}

fn timing(timing: Timing) -> Options {
    Options { timing: Some(timing), ..Options::default() }
}

/// Every kind with every timing that it takes and every kind of ends.
fn every(check: impl Fn(&str, &Path)) {
    let kinds = CATMULL_ROM.into_iter().chain([Kind::Polyline, Kind::Bezier, Kind::BezierDegree(9)]);
    let mut checked = 0;
    for kind in kinds {
        let points = if kind.is_bezier() { cubics() } else { bends() };
        for ends in PathEnds::ALL {
            for timing in [None].into_iter().chain(Timing::ALL.map(Some)) {
                let times = (timing == Some(Timing::Times)).then_some(match kind {
                    Kind::Bezier => &UNEVEN[..4],
                    Kind::BezierDegree(_) => &UNEVEN[..2],
                    _ => &UNEVEN[..],
                });
                let options = Options { ends, timing, ..Options::default() };
                match Path::new(kind, &points, times, &options) {
                    Ok(path) => {
                        checked += 1;
                        check(&format!("{kind:?} {ends:?} {timing:?}"), &path);
                    }
                    Err(Error::FixedKnots { .. } | Error::ClosingTime) => {}
                    Err(error) => panic!("{kind:?} {ends:?} {timing:?}: {error}"),
                }
            }
        }
    }
    assert_eq!(checked, 4 * (4 * 5 + 2 + 3) - 4, "some combination was refused, or one too many accepted");
}

/// Times all over a path, its keys' own not among them.
fn moments(path: &Path) -> impl Iterator<Item = f64> {
    let duration = path.duration();
    (0..200).map(move |i| duration * (f64::from(i) + 0.4321) / 200.0)
}

#[test]
fn key_points_are_passed_at_key_times() {
    every(|name, path| {
        assert_eq!(path.key_times().len(), path.key_points().len(), "{name}");
        assert_eq!(path.key_times()[0], 0.0);
        let last = path.key_times()[path.key_times().len() - 1];
        assert!((last - path.duration()).abs() <= 4e-16 * last, "{name}");
        for (&t, &key) in path.key_times().iter().zip(path.key_points()) {
            // Under constant speed the length at the key carries its 1e-12.
            assert!(path.position(t).distance(key) < 1e-11, "{name} at {t}");
        }
    });
}

#[test]
fn velocity_and_acceleration_are_derivatives() {
    every(|name, path| {
        for t in moments(path) {
            let h = 1e-5;
            if path.key_times().iter().any(|key| (key - t).abs() < 2.0 * h) {
                continue;
            }
            let (before, after) = (path.position(t - h), path.position(t + h));
            let slope = (after - before) / (2.0 * h);
            let change = (path.velocity(t + h) - path.velocity(t - h)) / (2.0 * h);
            // Rounding leaves 1e-15/h, the formula h²/6 of a third derivative below 1e3
            // (and of a fourth below 1e5).
            assert!((slope - path.velocity(t)).length() < 1e-6, "{name} at {t}");
            let size = 1.0 + path.acceleration(t).length();
            assert!((change - path.acceleration(t)).length() < 1e-5 * size, "{name} at {t}");
        }
    });
}

#[test]
fn speed_is_continuous_at_every_key_of_a_smooth_kind() {
    every(|name, path| {
        let smooth = name.starts_with("Catmull") || name.contains("ConstantSpeed");
        let even_bezier = name.starts_with("Bezier") && (name.contains("None") || name.contains("Uniform"));
        let times = path.key_times();
        for &t in &times[1..times.len() - 1] {
            let (before, after) = (path.velocity_before(t), path.velocity(t));
            if smooth || even_bezier {
                assert!((before.length() / after.length() - 1.0).abs() < 1e-6, "{name} at {t}");
            }
            if !name.starts_with("Polyline") && (smooth || even_bezier) {
                assert!(before.distance(after) < 1e-9 * after.length(), "{name} at {t}: {before} {after}");
                assert!(path.jumps().is_empty() && path.corners().is_empty(), "{name}");
            }
        }
    });
}

#[test]
fn polylines_turn_at_their_keys_and_bezier_keys_jump_where_times_say_so() {
    let line = path(Kind::Polyline, &bends(), Options::default());
    assert_eq!(line.corners(), &line.key_times()[1..5]);
    assert_eq!(line.jumps(), line.corners());
    let bezier = path(Kind::Bezier, &cubics(), timing(Timing::Chord));
    assert_eq!(bezier.jumps(), &bezier.key_times()[1..3]);
    assert!(bezier.corners().is_empty());
}

#[test]
fn closed_paths_run_on_through_their_seam() {
    every(|name, path| {
        assert_eq!(path.is_closed(), name.contains("Closed"));
        if !path.is_closed() {
            return;
        }
        let end = path.duration();
        assert_eq!(path.position(0.0), path.position(end), "{name}");
        let even_bezier = name.starts_with("Bezier") && !name.contains("Chord");
        if name.starts_with("Catmull") || even_bezier {
            let (out, back) = (path.velocity(0.0), path.velocity_before(end));
            assert!(out.distance(back) < 1e-12 * out.length(), "{name}: {out} {back}");
        }
    });
    let mut points = bends();
    let open = path(Kind::CatmullRom, &points, Options { ends: PathEnds::Closed, ..Options::default() });
    points.push(points[0]);
    let seam = path(Kind::CatmullRom, &points, Options { ends: PathEnds::Closed, ..Options::default() });
    assert_eq!(open.key_points(), seam.key_points());
    moments(&open).for_each(|t| assert_eq!(open.position(t), seam.position(t)));
}

#[test]
fn ends_do_what_they_say() {
    for kind in CATMULL_ROM {
        let with = |ends| path(kind, &bends(), Options { ends, duration: Some(7.0), ..Options::default() });
        let [natural, clamped, repeat] = [PathEnds::Natural, PathEnds::Clamped, PathEnds::Repeat].map(with);
        for (key, t) in [(0, 0.0), (4, 7.0)] {
            assert!(natural.acceleration(t).length() < 1e-12, "{kind:?}");
            assert!(clamped.velocity(t).length() < 1e-12, "{kind:?}");
            let h = repeat.key_times()[key + 1] - repeat.key_times()[key];
            let chord = (bends()[key + 1] - bends()[key]) / h;
            assert!((repeat.velocity(t) - 0.5 * chord).length() < 1e-12, "{kind:?}");
        }
    }
}

/// Barry and Goldman's pyramid: the point at t between knots 1 and 2.
fn pyramid(p: [DVec3; 4], k: [f64; 4], t: f64) -> DVec3 {
    let mix = |a: DVec3, b: DVec3, ta: f64, tb: f64| a * ((tb - t) / (tb - ta)) + b * ((t - ta) / (tb - ta));
    let a = [0, 1, 2].map(|i| mix(p[i], p[i + 1], k[i], k[i + 1]));
    let b = [0, 1].map(|i| mix(a[i], a[i + 1], k[i], k[i + 2]));
    mix(b[0], b[1], k[1], k[2])
}

#[test]
fn catmull_rom_is_barry_and_goldmans_pyramid() {
    let points = bends();
    let check = |path: &Path, name: &str| {
        let k = path.key_times();
        for i in 1..points.len() - 2 {
            for j in 0..=20 {
                let t = k[i] + (k[i + 1] - k[i]) * f64::from(j) / 20.0;
                let p = [points[i - 1], points[i], points[i + 1], points[i + 2]];
                let expected = pyramid(p, [k[i - 1], k[i], k[i + 1], k[i + 2]], t);
                assert!(path.position(t).distance(expected) < 1e-13, "{name} segment {i} {j}");
            }
        }
    };
    for kind in CATMULL_ROM {
        check(&path(kind, &points, Options::default()), kind.name());
    }
    check(&Path::new(Kind::CatmullRom, &points, Some(&UNEVEN), &Options::default()).unwrap(), "times");
    let (chord, chordal) = (timing(Timing::Chord), Options::default());
    let (a, b) = (path(Kind::CatmullRom, &points, chord), path(Kind::CatmullRomChordal, &points, chordal));
    moments(&a).for_each(|t| assert_eq!(a.position(t), b.position(t)));
}

#[test]
fn times_are_shared_out_as_the_timing_says() {
    let points = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(1.0, 4.0, 0.0), v(1.0, 4.0, 9.0)];
    let times = |kind, timing| {
        let options = Options { timing, duration: Some(14.0), ..Options::default() };
        path(kind, &points, options).key_times().to_vec()
    };
    let near = |a: &[f64], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    let thirds = [0.0, 14.0 / 3.0, 28.0 / 3.0, 14.0];
    assert!(near(&times(Kind::CatmullRom, None), thirds));
    assert!(near(&times(Kind::Polyline, Some(Timing::Uniform)), thirds));
    for kind in [Kind::CatmullRomChordal, Kind::Polyline] {
        assert!(near(&times(kind, None), [0.0, 1.0, 5.0, 14.0]));
    }
    assert!(near(&times(Kind::Polyline, Some(Timing::ConstantSpeed)), [0.0, 1.0, 5.0, 14.0]));
    let roots = [0.0, 14.0 / 6.0, 7.0, 14.0];
    assert!(near(&times(Kind::CatmullRomCentripetal, None), roots));
    // Unasked, a second a segment; the clock of the points starts at its first time.
    assert_eq!(path(Kind::CatmullRomChordal, &bends(), Options::default()).duration(), 5.0);
    let timed = Path::new(Kind::Polyline, &bends(), Some(&UNEVEN), &Options::default()).unwrap();
    assert!(timed.key_times().iter().zip(UNEVEN).all(|(a, b)| *a == b - 3.0));
    let even = Path::new(Kind::Polyline, &bends(), Some(&UNEVEN), &timing(Timing::Uniform)).unwrap();
    assert_eq!((even.duration(), even.key_times()[1]), (5.5, 1.1));
}

#[test]
fn constant_speed_is_constant() {
    for (kind, points) in
        [(Kind::Bezier, cubics()), (Kind::CatmullRom, bends()), (Kind::CatmullRomCentripetal, bends())]
    {
        let options = Options { speed: Some(2.0), ..timing(Timing::ConstantSpeed) };
        let path = path(kind, &points, options);
        assert!((path.duration() * 2.0 - path.length()).abs() < 1e-12 * path.length());
        for t in moments(&path) {
            let h = 5e-5;
            let speed = path.position(t + h).distance(path.position(t - h)) / (2.0 * h);
            // A chord is short of its arc by (κ·2·h)²/6, for κ below 10 less than 2e-7.
            assert!((speed / 2.0 - 1.0).abs() < 1e-6, "{kind:?} at {t}: {speed}");
            assert!((path.velocity(t).length() / 2.0 - 1.0).abs() < 1e-14);
        }
        // The shape is the kind's own: each point lies on the curve as it runs by itself.
        let own = super::tests::path(kind, &points, Options::default());
        let nearest = |p: DVec3| {
            let steps = (0..=20_000).map(|i| own.position(own.duration() * f64::from(i) / 20_000.0));
            steps.map(|q| q.distance(p)).fold(f64::INFINITY, f64::min)
        };
        moments(&path).step_by(40).for_each(|t| assert!(nearest(path.position(t)) < 1e-3));
    }
}

#[test]
fn lengths_and_places_agree_with_mpmath() {
    let text = include_str!("../../fixtures/reference/paths/lengths.json");
    let cases: Vec<serde_json::Value> = serde_json::from_str(text).unwrap();
    assert_eq!(cases.len(), 8);
    for case in &cases {
        let vector =
            |p: &serde_json::Value| v(p[0].as_f64().unwrap(), p[1].as_f64().unwrap(), p[2].as_f64().unwrap());
        let vectors = |key: &str| case[key].as_array().unwrap().iter().map(vector).collect::<Vec<_>>();
        let points = vectors("points");
        let kind = Kind::from_name(case["kind"].as_str().unwrap());
        let ends = PathEnds::from_name(case["ends"].as_str().unwrap()).unwrap();
        let options = Options { ends, ..timing(Timing::ConstantSpeed) };
        let path = path(kind.unwrap_or(Kind::BezierDegree(points.len() - 1)), &points, options);
        let length = case["length"].as_f64().unwrap();
        let error = (path.length() / length - 1.0).abs();
        assert!(error < 1e-11, "{}: {} off by {error}", case["name"], path.length());
        for (fraction, place) in case["fractions"].as_array().unwrap().iter().zip(vectors("positions")) {
            let t = path.duration() * fraction.as_f64().unwrap();
            let error = path.position(t).distance(place);
            assert!(error < 1e-11 * length, "{} at {fraction}: off by {error}", case["name"]);
        }
    }
}

#[test]
fn lengths_agree_with_closed_forms() {
    let line = path(Kind::CatmullRom, &[v(1.0, 2.0, 3.0), v(3.0, 5.0, 9.0)], Options::default());
    assert!((line.length() - 7.0).abs() < 1e-14);
    // A line that is run to and fro: x = 3u(1−u)(1−2u)·(1, 2, −1), turned at 3^½/6 from ½.
    let doubled = [DVec3::ZERO, v(1.0, 2.0, -1.0), v(-1.0, -2.0, 1.0), DVec3::ZERO];
    let path = path(Kind::Bezier, &doubled, timing(Timing::ConstantSpeed));
    let length = 4.0 * 6f64.sqrt() * 3f64.sqrt() / 6.0;
    assert!((path.length() - length).abs() < 1e-12);
    assert_eq!(path.corners().len(), 2);
    assert!((path.corners()[0] - 0.25).abs() < 1e-12 && (path.corners()[1] - 0.75).abs() < 1e-12);
    let along = v(1.0, 2.0, -1.0).normalize();
    for (t, sign) in [(0.0, 1.0), (0.1, 1.0), (0.5, -1.0), (0.9, 1.0), (1.0, 1.0)] {
        assert!(path.direction(t).unwrap().distance(along * sign) < 1e-9, "{t}");
    }
    let turn = path.corners()[0];
    assert!(path.direction_before(turn).unwrap().distance(along) < 1e-3);
    assert!(path.direction(turn).unwrap().distance(-along) < 1e-3);
}

#[test]
fn easing_rests_and_keeps_the_length() {
    for ease in Ease::ALL {
        let options = Options { ease, duration: Some(4.0), ..timing(Timing::ConstantSpeed) };
        let path = path(Kind::CatmullRom, &bends(), options);
        let speeds = [path.velocity(0.0).length(), path.velocity_before(4.0).length()];
        let rests = [matches!(ease, Ease::In | Ease::InOut), matches!(ease, Ease::Out | Ease::InOut)];
        (0..2).for_each(|i| assert_eq!(speeds[i] < 1e-14, rests[i], "{ease:?}"));
        // Simpson over the speed gives the length back, the speed being a parabola.
        let speed = |t: f64| path.velocity(t).length();
        let length = 4.0 / 6.0 * (speed(0.0) + 4.0 * speed(2.0) + path.velocity_before(4.0).length());
        assert!((length / path.length() - 1.0).abs() < 1e-12, "{ease:?}");
        assert!(path.direction(0.0).is_some() && path.direction(4.0).is_some());
        // Keys are still passed at rest's crawl: inverting the easing costs nothing.
        let miss = |(t, key): (&f64, &DVec3)| path.position(*t).distance(*key);
        assert!(path.key_times().iter().zip(path.key_points()).map(miss).all(|d| d < 1e-11), "{ease:?}");
    }
}

#[test]
fn a_rigid_motion_moves_the_path_along() {
    let turn = DMat3::from_axis_angle(v(0.48, 0.6, 0.64), 2.0);
    let shift = v(10.0, -3.0, 7.0);
    for kind in CATMULL_ROM.into_iter().chain([Kind::Bezier, Kind::Polyline]) {
        for options in [Options::default(), timing(Timing::ConstantSpeed)] {
            let points = if kind == Kind::Bezier { cubics() } else { bends() };
            let moved: Vec<DVec3> = points.iter().map(|p| turn * *p + shift).collect();
            let (a, b) = (path(kind, &points, options), path(kind, &moved, options));
            for t in moments(&a) {
                let error = b.position(t).distance(turn * a.position(t) + shift);
                assert!(error < 1e-11, "{kind:?} at {t}: {error}");
                assert!(b.velocity(t).distance(turn * a.velocity(t)) < 1e-9, "{kind:?} at {t}");
            }
        }
    }
}

#[test]
fn bounds_hold_and_are_near_on_short_stretches() {
    every(|name, path| {
        for pair in path.key_times().windows(2) {
            for parts in [1, 3, 200] {
                let h = (pair[1] - pair[0]) / f64::from(parts);
                for part in 0..parts {
                    let (t0, t1) = (pair[0] + h * f64::from(part), pair[0] + h * f64::from(part + 1));
                    let inside = (0..=20).map(|i| (t0 + (t1 - t0) * f64::from(i) / 20.0).min(t1.next_down()));
                    let rates = inside.map(|t| (path.velocity(t).length(), path.acceleration(t).length()));
                    let (speed, change) = rates.fold((0f64, 0f64), |a, b| (a.0.max(b.0), a.1.max(b.1)));
                    let (fast, bent) = (path.speed_bound(t0, t1), path.acceleration_bound(t0, t1));
                    assert!(
                        speed <= fast * (1.0 + 1e-12) && change <= bent * (1.0 + 1e-9),
                        "{name} {t0}: {change} {bent}"
                    );
                    // At a clamped end the curvature itself is infinite.
                    let regular = !(name.contains("Clamped") && name.contains("ConstantSpeed"));
                    if parts == 200 && regular {
                        let size = path.length() / path.duration().powi(2);
                        assert!(
                            fast < speed * 1.1 + 1e-2 * size * path.duration(),
                            "{name} {t0}: {speed} {fast}"
                        );
                        assert!(bent < change * 1.3 + size, "{name} {t0}: {change} {bent}");
                    }
                }
            }
        }
    });
}

#[test]
fn points_that_coincide_rest_or_are_passed() {
    let (a, b, c) = (v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(2.0, 1.0, 0.0));
    let twice = path(Kind::CatmullRomChordal, &[a, b, b, c], Options::default());
    assert_eq!(twice.key_times()[1], twice.key_times()[2]);
    assert!(twice.jumps().is_empty());
    let rest = path(Kind::Polyline, &[a, a, b, b, c], timing(Timing::Uniform));
    assert_eq!(rest.velocity(2.5), DVec3::ZERO);
    assert_eq!(rest.direction(0.5), Some(DVec3::X));
    assert_eq!(rest.direction(2.5), Some(DVec3::X));
    assert_eq!(rest.corners(), [3.0]);
    assert_eq!(rest.jumps(), [1.0, 2.0, 3.0]);
    let handles = path(Kind::Bezier, &[a, a, b, b], Options::default());
    assert_eq!((handles.direction(0.0), handles.direction(1.0)), (Some(DVec3::X), Some(DVec3::X)));
    for kind in Kind::ALL {
        let point = path(kind, &[c; 4], Options { speed: Some(3.0), ..timing(Timing::ConstantSpeed) });
        assert_eq!((point.length(), point.direction(1.0), point.position(1.0)), (0.0, None, c));
        assert!(point.duration() > 0.0);
    }
}

#[test]
fn what_makes_no_path_is_refused_with_the_ways_out() {
    let points = bends();
    let error = |kind, n: usize, times: Option<&[f64]>, options| {
        Path::new(kind, &points[..n], times, &options).unwrap_err().to_string()
    };
    let plain = Options::default();
    assert!(error(Kind::Polyline, 1, None, plain).contains("at least 2 points, but there are 1"));
    assert!(error(Kind::Bezier, 6, None, plain).contains("degree=5"));
    assert!(error(Kind::BezierDegree(4), 6, None, plain).contains("1 over"));
    assert!(error(Kind::BezierDegree(0), 1, None, plain).contains("from 1 to 100"));
    for (times, timing) in [(Some(&UNEVEN[..]), None), (None, Some(Timing::Uniform))] {
        let text = error(Kind::CatmullRomCentripetal, 6, times, Options { timing, ..plain });
        assert!(text.contains("choose catmull-rom,") && text.contains("constant-speed"), "{text}");
    }
    assert!(error(Kind::Polyline, 6, None, timing(Timing::Times)).contains("needs a time"));
    assert!(error(Kind::Polyline, 6, Some(&UNEVEN[..5]), plain).contains("5 times for 6"));
    let back = [0.0, 1.0, 0.5, 2.0, 3.0, 4.0];
    assert!(error(Kind::Polyline, 6, Some(&back), plain).contains("key point 3"));
    let closed = Options { ends: PathEnds::Closed, ..plain };
    assert!(error(Kind::CatmullRom, 6, Some(&UNEVEN), closed).contains("closing segment"));
    assert!(error(Kind::Polyline, 6, None, Options { ease: Ease::In, ..plain }).contains("constant-speed"));
    let both = Options { speed: Some(1.0), duration: Some(1.0), ..plain };
    assert!(error(Kind::Polyline, 6, None, both).contains("a speed and a duration"));
    for number in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        error(Kind::Polyline, 6, None, Options { speed: Some(number), ..plain });
        error(Kind::Polyline, 6, None, Options { duration: Some(number), ..plain });
        let bad = [v(0.0, 0.0, 0.0), v(0.0, number.abs() + 1e200, 0.0)];
        assert_eq!(
            Path::new(Kind::Polyline, &bad, None, &plain).unwrap_err(),
            Error::Coordinate { point: 1 }
        );
    }
    let loops = [v(0.0, 0.0, 0.0), v(1.0, 1.0, 0.0), v(-1.0, 1.0, 0.0), v(0.0, 0.0, 0.0)];
    let two: Vec<DVec3> =
        loops.into_iter().chain([v(1.0, 0.0, 0.0), v(2.0, 0.0, 0.0), v(3.0, 0.0, 0.0)]).collect();
    let error = Path::new(Kind::Bezier, &two, None, &timing(Timing::Chord)).unwrap_err();
    assert_eq!(error, Error::NoChord { segment: 0 });
}

#[test]
fn tiny_paths_are_as_sound_as_their_enlargement() {
    // A point twice, then a step of a few millionths of the coordinates.
    let row = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 1e-310;
    let (a, b) = (0.99999700000597, 1.0);
    let points = [row(a, a, b), row(a, a, b), row(b, a, 0.999996000008)];
    let options = Options { timing: Some(Timing::ConstantSpeed), ease: Ease::In, ..Options::default() };
    for kind in CATMULL_ROM {
        let Ok(path) = Path::new(kind, &points, None, &options) else { continue };
        for i in 0..=2000 {
            let t = path.duration() * f64::from(i) / 2000.0;
            let (reached, bound) = (path.acceleration(t), path.acceleration_bound(t, t + 0.1));
            let reached = (reached * 1e200).length() * 1e-200;
            assert!(
                reached <= bound * (1.0 + 1e-9) + f64::MIN_POSITIVE,
                "{kind:?} {reached:e} {bound:e} at {t}"
            );
        }
    }
}

#[test]
fn points_that_differ_by_less_than_rounding_are_one() {
    let (a, b) = (DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.5, 0.5, 4.1e-18));
    let path = path(Kind::Bezier, &[a, b, a, a], timing(Timing::ConstantSpeed));
    assert!(moments(&path).all(|t| path.position(t).distance(a) < 1e-17));
    assert_eq!(path.direction(0.3), None);
}

/// Points on a coarse grid, so that many coincide or lie on a line, of any size.
fn any_points() -> impl Strategy<Value = Vec<DVec3>> {
    let scale = prop::sample::select(vec![1.0, 1e150, 3e-200, 1e-310, 1e-7, 12345.6]);
    let noise = prop::sample::select(vec![0.0, 0.0, 1e-17, 1e-14, 1e-9, 0.1]);
    let offset = prop::sample::select(vec![0.0, 0.0, 1e6]);
    let row = prop::array::uniform3((-2..=2i32, -1.0..1.0f64));
    (prop::collection::vec(row, 2..11), scale, noise, offset).prop_map(|(rows, scale, noise, offset)| {
        let number = |(grid, random): (i32, f64)| {
            (f64::from(grid) + noise * random + offset) / (2.0 + noise + offset) * scale
        };
        rows.iter().map(|row| DVec3::from_array(row.map(number))).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn every_path_is_finite_and_stays_in_reach(
        mut points in any_points(), kind in 0..6usize, ends in 0..4usize, timing in 0..4usize, ease in 0..4usize,
    ) {
        let kind = if kind < 5 { Kind::ALL[kind] } else { Kind::BezierDegree(points.len() - 1) };
        if kind == Kind::Bezier {
            points.resize(points.len().div_ceil(3) * 3 + 1, points[0]);
        }
        let timing = [None, Some(Timing::Uniform), Some(Timing::Chord), Some(Timing::ConstantSpeed)][timing];
        let ease = if timing == Some(Timing::ConstantSpeed) { Ease::ALL[ease] } else { Ease::None };
        let options = Options { ends: PathEnds::ALL[ends], timing, ease, ..Options::default() };
        let path = match Path::new(kind, &points, None, &options) {
            Ok(path) => path,
            Err(Error::FixedKnots { .. } | Error::NoChord { .. }) => return Ok(()),
            Err(error) => panic!("{error}"),
        };
        let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        prop_assert!(path.length().is_finite());
        prop_assert!(path.key_times().is_sorted() && path.corners().is_sorted());
        let outside = [-1.0, 0.0, path.duration(), path.duration() * 2.0];
        for t in moments(&path).step_by(7).chain(path.key_times().to_vec()).chain(path.corners().to_vec()).chain(outside) {
            let p = path.position(t);
            prop_assert!(p.is_finite() && p.abs().max_element() <= 40.0 * size, "{p} at {t}");
            prop_assert!(path.velocity(t).is_finite() && path.acceleration(t).is_finite(), "{t}");
            prop_assert!(path.velocity_before(t).is_finite() && path.acceleration_before(t).is_finite());
            prop_assert!(path.direction(t).is_none_or(|d| (d.length() - 1.0).abs() < 1e-12));
            prop_assert_eq!(path.direction(t).is_some(), path.direction(0.0).is_some());
            let bound = path.acceleration_bound(t, t + 0.1);
            // Its square could overflow.
            let largest = path.acceleration(t).abs().max_element().max(f64::MIN_POSITIVE);
            let reached = (path.acceleration(t) / largest).length() * largest;
            prop_assert!(reached <= bound * (1.0 + 1e-9) + f64::MIN_POSITIVE, "{reached} {bound} at {t}");
            prop_assert!(!bound.is_nan() && path.speed_bound(t, t + 0.1).is_finite());
        }
        for (&t, key) in path.key_times().iter().zip(path.key_points()) {
            prop_assert!(path.position(t).distance(*key) <= 1e-9 * size, "{} {key} at {t}", path.position(t));
        }
    }
}

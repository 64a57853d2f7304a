//! What every attitude must do on every kind of course.

mod courses;
mod keyed;
mod landing;
mod tangent;
mod upright;

use super::facing::turned;
use super::*;
use crate::path::{Ease, Kind, Options, Path, PathEnds, Timing};
use courses::*;
use glam::DVec3;
use proptest::prelude::*;

/// Every attitude that a course can have.
fn attitudes<'a>(course: &'a dyn Course) -> Vec<(&'static str, Box<dyn Attitude + 'a>)> {
    let level = Level { start: 1, end: 1 };
    vec![
        ("tangent", Box::new(Tangent::new(course))),
        ("upright", Box::new(Upright::new(course, 0.0))),
        ("banked", Box::new(Upright::new(course, 30.0))),
        ("levelled tangent", Box::new(Levelled::new(Tangent::new(course), level))),
        ("levelled upright", Box::new(Levelled::new(Upright::new(course, 30.0), level))),
    ]
}

/// Times over the whole of a course, key times and corners and their neighbours too.
fn times(course: &dyn Course, count: usize) -> Vec<f64> {
    let even = (0..=count).map(|i| course.duration() * (i as f64 / count as f64));
    let marked =
        course.key_times().iter().chain(course.corners()).flat_map(|&t| [t.next_down(), t, t.next_up()]);
    let mut times: Vec<f64> = even.chain(marked).collect();
    times.sort_by(f64::total_cmp);
    times
}

#[test]
fn every_attitude_on_every_course_is_finite_and_of_unit_length() {
    for (name, course) in all() {
        for (kind, attitude) in attitudes(&*course) {
            for t in times(&*course, 500).into_iter().chain([-1.0, 1e9]) {
                let norm = attitude.at(t).norm();
                assert!((norm - 1.0).abs() < 1e-14, "{kind} on {name} at {t}: {norm}");
            }
        }
        let keys = super::keyed(&*course, &[], Level { start: 1, end: 1 });
        assert_eq!(keys.len(), course.key_times().len(), "{name}");
        assert!(keys.iter().all(|q| (q.norm() - 1.0).abs() < 1e-14), "{name}: {keys:?}");
    }
}

#[test]
fn forward_is_the_direction_of_travel_unless_levelled() {
    for (name, course) in all() {
        for (kind, attitude) in attitudes(&*course).into_iter().take(3) {
            for t in times(&*course, 500) {
                let Some(direction) = course.direction(t) else { continue };
                let error = (turned(attitude.at(t), DVec3::Z) - direction).length();
                assert!(error < 1e-9, "{kind} on {name} at {t}: {error}");
            }
        }
    }
}

#[test]
fn rotations_and_their_signs_are_continuous_away_from_corners() {
    // Halving the step must halve the largest change between samples: a jump would stay.
    // The steps are short enough for the fastest of the courses' turns.
    // A reversal that the course does not tell of is a jump, whatever one does.
    for (name, course) in all().into_iter().filter(|(name, _)| !name.contains("unknown")) {
        let apart = |t: f64, h: f64| course.corners().iter().all(|c| *c < t - h || *c > t + 2.0 * h);
        for (kind, attitude) in attitudes(&*course) {
            let largest = |count: usize| {
                let h = course.duration() / count as f64;
                let change = |i: usize| {
                    let t = h * i as f64;
                    let (a, b) = (attitude.at(t), attitude.at(t + h));
                    if apart(t, h) { (a.w - b.w).hypot((a.v - b.v).length()) } else { 0.0 }
                };
                (0..count).map(change).fold(0.0, f64::max)
            };
            let (coarse, fine) = (largest(4000), largest(16000));
            assert!(fine < 0.4 * coarse + 1e-12, "{kind} on {name}: {coarse} {fine}");
            assert!(fine < 0.03, "{kind} on {name}: {fine}");
        }
    }
}

/// Paths through points of a small grid: plumb lines, corners, doubled points and reversals.
fn on_a_grid() -> impl Strategy<Value = Path> {
    let points = prop::collection::vec([-1..=1i8, -1..=1i8, -1..=1i8], 2..9);
    let kinds = prop::sample::select(vec![Kind::Polyline, Kind::CatmullRom, Kind::CatmullRomCentripetal]);
    let timings = prop::sample::select(vec![
        (None, Ease::None),
        (Some(Timing::ConstantSpeed), Ease::None),
        (Some(Timing::ConstantSpeed), Ease::InOut),
    ]);
    (kinds, points, any::<bool>(), timings).prop_filter_map(
        "no path",
        |(kind, points, closes, (timing, ease))| {
            let points: Vec<DVec3> =
                points.into_iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
            let ends = if closes { PathEnds::Closed } else { PathEnds::Natural };
            Path::new(kind, &points, None, &Options { ends, timing, ease, ..Options::default() }).ok()
        },
    )
}

proptest! {
    #[test]
    fn every_attitude_looks_where_a_path_goes(path in on_a_grid()) {
        for (kind, attitude) in attitudes(&path) {
            for t in times(&path, 50) {
                let q = attitude.at(t);
                prop_assert!((q.norm() - 1.0).abs() < 1e-14, "{kind} at {t}");
                // Near a cusp directions are rounding.
                let tells = path.rates_at(path.place(t))[0].length() > 1e-5 && !kind.contains("levelled");
                let Some(direction) = path.direction(t).filter(|_| tells) else { continue };
                let off = (turned(q, DVec3::Z) - direction).length();
                prop_assert!(off < 1e-9, "{kind} at {t}: {off}");
            }
        }
    }
}

use super::super::facing::tilt;
use super::*;
use crate::math::Scalar;

fn up(attitude: &dyn Attitude, t: f64) -> DVec3 {
    turned(attitude.at(t), DVec3::Y)
}

#[test]
fn wings_are_level_and_up_is_up_away_from_the_vertical() {
    for (name, course) in all() {
        let upright = Upright::new(&*course, 0.0);
        for t in times(&*course, 300) {
            let q = upright.at(t);
            if tilt(turned(q, DVec3::Z)).to_degrees() > 15.0 {
                let (left, up) = (turned(q, DVec3::X), turned(q, DVec3::Y));
                assert!(left.y.abs() < 1e-12 && up.y > 0.0, "{name} at {t}: {left} {up}");
            }
        }
    }
}

#[test]
fn a_loop_rolls_and_does_not_flip() {
    // 30° of the loop take a third of a second; half a roll in that time, blended by
    // smoothstep, turns by at most 3π² / (2 · 15°) / 4 s ≈ 17 rad/s besides the loop.
    for drift in [0.0, 0.01, 0.3, 1.0, -0.3] {
        let course = looping(drift);
        let upright = Upright::new(&course, 0.0);
        let step = |i: i32| upright.at(f64::from(i) * 1e-3).angle_to(upright.at(f64::from(i + 1) * 1e-3));
        let fastest = (0..4000).map(step).fold(0.0, f64::max) * 1e3;
        assert!(fastest < 20.0, "drift {drift}: {fastest} rad/s");
    }
}

#[test]
fn straight_down_keeps_the_up_it_came_with() {
    let course = sinking();
    let upright = Upright::new(&course, 0.0);
    for t in [2.0, 3.0, 4.0] {
        assert!((up(&upright, t) - DVec3::Z).length() < 1e-12, "{t}: {}", up(&upright, t));
    }
}

#[test]
fn a_steady_turn_leans_by_the_angle_asked_for() {
    // To the left: the left side goes down and up leans to the left. Radius 3, even speed.
    let course = circle(5.0);
    for degrees in [30.0, -10.0, 80.0] {
        let upright = Upright::new(&course, degrees);
        for t in times(&course, 40) {
            let (left, lean) = (turned(upright.at(t), DVec3::X), f64::to_radians(degrees));
            assert!((left.y + lean.sin()).abs() < 1e-12, "{degrees} at {t}: {left}");
            let inward = (DVec3::new(3.0, 0.0, 0.0) - course.position(t)).normalize();
            assert!((up(&upright, t).dot(inward) - lean.sin()).abs() < 1e-12);
        }
    }
}

#[test]
fn straight_courses_and_loops_do_not_lean() {
    for (name, course) in all() {
        if ["line", "zigzag", "vertical", "eased", "loop", "sinking", "standing"].contains(&name) {
            let [flat, banked] = [0.0, 45.0].map(|degrees| Upright::new(&*course, degrees));
            for t in times(&*course, 60) {
                assert!(flat.at(t).angle_to(banked.at(t)) < 1e-12, "{name} at {t}");
            }
        }
    }
}

/// Left and right in turns: lateral acceleration by cosine.
fn slalom(frequency: f64) -> Smooth<impl Fn(crate::math::Jet) -> Point + Sync> {
    Smooth::new(8.0, 8, move |t: crate::math::Jet| {
        let small = (t * number(frequency)).sin_cos().1 * number(-1e-5);
        crate::math::Vec3::new(small, number(0.0), t)
    })
}

#[test]
fn the_lean_is_smoothed_by_a_gaussian() {
    // cos(ωt) under a Gaussian is exp(−ω²σ²/2) cos(ωt); the course's slope of 1e-5 ω
    // changes the lateral acceleration by its square. Splines and grid: 1e-4.
    for frequency in [2.0, 8.0] {
        let course = slalom(frequency);
        let bank = super::super::bank::Bank::new(&course, 30.0);
        for i in 0..=60 {
            let t = 1.0 + f64::from(i) / 10.0;
            let expected =
                -30f64.to_radians() * (-(frequency * 0.125).powi(2) / 2.0).exp() * (frequency * t).cos();
            assert!((bank.at(t) - expected).abs() < 1e-4, "{frequency} at {t}: {} {expected}", bank.at(t));
        }
    }
}

#[test]
fn the_lean_wraps_round_the_seam_of_a_closed_course() {
    let course = knot();
    let bank = super::super::bank::Bank::new(&course, 30.0);
    let speed = |t: f64| (bank.at(t + 1e-4) - bank.at(t - 1e-4)) / 2e-4;
    assert!((bank.at(0.0) - bank.at(6.0)).abs() < 1e-12);
    assert!((speed(1e-4) - speed(6.0 - 1e-4)).abs() < 1e-2);
    let upright = Upright::new(&course, 30.0);
    assert!(upright.at(0.0).angle_to(upright.at(6.0)) < 1e-9);
}

#[test]
fn passages_are_found_between_nodes_too() {
    // Drift 0.1 over a loop of 6π: 0.3° off the vertical at best, twice.
    let course = looping(0.1);
    let steps = Steps::new(&course);
    for degrees in [15.0f64, 1.0, 0.31] {
        let found = super::super::passage::passages(&steps, f64::to_radians(degrees));
        assert_eq!(found.len(), 2, "{degrees}");
        for (passage, middle) in found.iter().zip([1.0, 3.0]) {
            // The loop turns by 90° a second; across the cone it is 2√(limit² − off²).
            let off = (0.1f64 / (6.0 * std::f64::consts::PI)).atan().to_degrees();
            let expected = 2.0 * (degrees * degrees - off * off).sqrt();
            assert!(((passage.end - passage.start) * 90.0 - expected).abs() < 1e-3 * expected);
            assert!((0.5 * (passage.start + passage.end) - middle).abs() < 1e-9);
            for edge in [passage.before, passage.after] {
                assert!((tilt(edge.expect("inside").place.forward) - f64::to_radians(degrees)).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn a_steep_passage_may_run_across_the_seam() {
    // The same closed loop from four of its places: upright is told by what is near.
    use crate::math::{Jet, Vec3};
    let loops = [0.0, 1.0, 2.0, 3.0].map(|start| {
        let formula = move |t: Jet| {
            let angle = (t + number(start)) * number(std::f64::consts::TAU / 4.0);
            let (sin, cos) = angle.sin_cos();
            Vec3::new((angle * number(2.0)).sin_cos().0 * number(0.05), number(1.0) - cos, sin)
        };
        Smooth::new(4.0, 3, formula).closed()
    });
    let [first, others @ ..] = [0, 1, 2, 3].map(|i| Upright::new(&loops[i], 0.0));
    for (other, start) in others.iter().zip([1.0, 2.0, 3.0]) {
        for i in 0..400 {
            let t = f64::from(i) / 100.0;
            let error = other.at(t).angle_to(first.at((t + start) % 4.0));
            assert!(error < 1e-9, "from {start} at {t}: {error}");
        }
    }
}

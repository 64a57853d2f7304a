use super::super::carry::Carry;
use super::super::facing::Facing;
use super::super::steps::Steps;
use super::super::transport::Transport;
use super::*;
use crate::math::Vec3;
use crate::math::{Jet, Scalar};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

impl Tangent<'_> {
    fn facing_at(&self, t: f64) -> Facing {
        let q = self.at(t);
        Facing { forward: turned(q, DVec3::Z), up: turned(q, DVec3::Y) }
    }
}

/// 1e-6 degrees.
const PROMISED: f64 = 1e-6 * TAU / 360.0;

#[test]
fn a_helix_twists_against_its_normal_by_the_torsion() {
    // Radius r, rise c a radian: torsion c / (r² + c²), length √(r² + c²) a radian, so up
    // falls behind the principal normal by c / √(r² + c²) a radian.
    for rise in [0.1, 0.7, 2.0, 5.0] {
        let course = helix(3.0, rise);
        let tangent = Tangent::new(&course);
        let per_radian = rise / f64::hypot(2.0, rise);
        let behind = |t: f64| {
            let normal = DVec3::new(-t.cos(), 0.0, -t.sin());
            tangent.facing_at(t).roll_to(normal)
        };
        let start = behind(0.0);
        for t in times(&course, 97) {
            // The binormal is forward × normal, and torsion turns the normal towards it
            // where the helix is right-handed; this one, from +x to +z, is left-handed.
            let error = wrapped(behind(t) - start + per_radian * t).abs();
            assert!(error < PROMISED, "rise {rise} at {t}: {error}");
        }
    }
}

#[test]
fn what_a_time_gives_does_not_depend_on_other_times_or_segments() {
    let formula = |t: Jet| {
        let (sin, cos) = (t * number(1.3)).sin_cos();
        Vec3::new(sin * t, cos + t * t * number(0.1), (t * number(0.7)).sin_cos().0)
    };
    let [few, many] = [1, 23].map(|segments| Smooth::new(5.0, segments, formula));
    let (few, many) = (Tangent::new(&few), Tangent::new(&many));
    for i in 0..=1000 {
        let t = 5.0 * f64::from(i) / 1000.0;
        let error = few.at(t).angle_to(many.at(t));
        assert!(error < PROMISED, "{t}: {error}");
    }
}

#[test]
fn plane_curves_have_no_twist() {
    // The normal of the plane stands still in the object's own axes.
    let courses: [(Box<dyn Course>, DVec3); 3] = [
        (Box::new(looping(0.0)), DVec3::X),
        (Box::new(circle(5.0)), DVec3::Y),
        (Box::new(sinking()), DVec3::X),
    ];
    for (course, normal) in courses {
        let tangent = Tangent::new(&*course);
        for t in times(&*course, 100) {
            assert!((turned(tangent.at(t).conjugate(), normal) - normal).length() < 1e-13, "{t}");
        }
    }
}

#[test]
fn a_closed_course_comes_back_as_it_left() {
    let course = knot();
    let tangent = Tangent::new(&course);
    assert!(tangent.at(0.0).angle_to(tangent.at(6.0)) < 1e-12);
    // It would not by itself, and what closes it is even along the way.
    let steps = Steps::new(&course);
    let open = Transport::open(&steps);
    let open = |t: f64| open.facing(&steps, &steps.spot(t));
    let twist = |t: f64| open(t).roll_to(tangent.facing_at(t).up);
    let total = wrapped(open(6.0).roll_to(open(0.0).up));
    assert!(total.abs() > 0.5, "the test's own course: {total}");
    let speed = |t: f64| course.velocity(t).length();
    let (mut length, mut all) = (0.0, 0.0);
    for i in 0..60_000 {
        all += speed((f64::from(i) + 0.5) * 1e-4) * 1e-4;
        if i + 1 == 21_000 {
            length = all;
        }
    }
    // The midpoint rule is good to h² = 1e-8 here.
    assert!(wrapped(twist(2.1) - total * length / all).abs() < 1e-7);
}

#[test]
fn a_closed_polyline_comes_back_round_its_last_corner() {
    let course = Polyline::new(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 1.0], [0.0; 3]]);
    let tangent = Tangent::new(&course);
    let (first, last) = (tangent.facing_at(0.0), tangent.facing_at(3.0));
    assert!((last.turned_to(first.forward).up - first.up).length() < 1e-14);
}

#[test]
fn corners_turn_by_the_shortest_arc() {
    let course = Polyline::new(&[[0.0; 3], [1.0, 0.0, 1.0], [0.0, 1.0, 2.0], [3.0, 0.5, 2.0]]);
    let tangent = Tangent::new(&course);
    for corner in [1.0, 2.0f64] {
        let (before, after) = (tangent.at(corner.next_down()), tangent.at(corner));
        let (a, b) = (turned(before, DVec3::Z), turned(after, DVec3::Z));
        let arc = DQuat::from_rotation_arc(a, b);
        assert!((crate::math::Quat::from(arc) * before).angle_to(after) < 1e-14, "{corner}");
    }
}

#[test]
fn it_starts_with_the_up_nearest_to_the_worlds() {
    for (name, course) in all() {
        let Some(forward) = course.direction(0.0) else { continue };
        let up = turned(Tangent::new(&*course).at(0.0), DVec3::Y);
        let expected = if forward.y.abs() > 1.0 - 1e-12 { DVec3::Z * -forward.y } else { DVec3::Y };
        let expected = (expected - forward * expected.dot(forward)).normalize();
        assert!((up - expected).length() < 1e-12, "{name}: {up}");
    }
}

#[test]
fn a_turn_of_the_world_turns_the_motion() {
    // The start follows +Y and does not turn along: compare from the start on.
    let turn = DQuat::from_scaled_axis(DVec3::new(0.7, -1.1, 0.4));
    let formula = |t: Jet| Vec3::new(t.sin_cos().0, t * t * number(0.1), t.sin_cos().1 * t);
    let turned_formula = move |t: Jet| {
        let p = formula(t);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn * axis);
        let mix = |of: fn(DVec3) -> f64| {
            p.x * number(of(axes[0])) + p.y * number(of(axes[1])) + p.z * number(of(axes[2]))
        };
        Vec3::new(mix(|v| v.x), mix(|v| v.y), mix(|v| v.z))
    };
    let (one, other) = (Smooth::new(4.0, 3, formula), Smooth::new(4.0, 3, turned_formula));
    let (one, other) = (Tangent::new(&one), Tangent::new(&other));
    let turn = crate::math::Quat::from(turn);
    for t in [0.3, 1.0, 2.7, 4.0] {
        let moved = turn * one.at(t) * one.at(0.0).conjugate() * turn.conjugate();
        let theirs = other.at(t) * other.at(0.0).conjugate();
        assert!(moved.angle_to(theirs) < 1e-12, "{t}");
    }
}

#[test]
fn the_partition_stays_small() {
    // Rounding far from the origin, turns within an instant: neither may be chased.
    for (name, course) in all() {
        let steps = Steps::new(&*course);
        let carry = Carry::new(&steps, false);
        let nodes: usize = (0..steps.segments()).map(|i| carry.nodes(&steps, i).len()).sum();
        assert!(nodes < 4000, "{name}: {nodes}");
    }
}

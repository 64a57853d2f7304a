use super::super::facing::tilt;
use super::*;
use crate::math::Quat;
use std::f64::consts::FRAC_PI_2;

fn yaw(q: Quat) -> Option<f64> {
    let left = turned(q, DVec3::X);
    let forward = turned(q, DVec3::Z);
    (left.y.abs() < 1e-12 && forward.y.abs() < 1e-12).then(|| forward.x.atan2(forward.z))
}

#[test]
fn the_last_keys_keep_their_heading_and_nothing_else() {
    let course =
        Polyline::new(&[[0.0; 3], [1.0, 1.0, 0.0], [2.0, 1.5, 1.0], [2.0, 0.0, 2.0], [1.0, -1.0, 2.0]]);
    let plain = super::super::keyed(&course, &[], Level::default());
    let ours = super::super::keyed(&course, &[], Level { start: 1, end: 2 });
    for (i, (a, b)) in ours.iter().zip(&plain).enumerate() {
        if i == 0 || i >= 3 {
            let forward = turned(*b, DVec3::Z);
            let heading = yaw(*a).expect("level");
            assert!(wrapped(heading - forward.x.atan2(forward.z)).abs() < 1e-14, "key {i}");
            assert!(turned(*a, DVec3::Y).y > 0.0);
        } else {
            assert!(a.angle_to(*b) < 1e-15, "key {i}");
        }
    }
}

#[test]
fn a_course_that_sinks_vertically_lands_level() {
    // Keys: east, straight down twice, and the repeated last one.
    let course = Polyline::new(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, -1.0, 0.0], [1.0, -2.0, 0.0]]);
    let ours = super::super::keyed(&course, &[], Level { start: 0, end: 2 });
    assert!((yaw(ours[3]).expect("level") - FRAC_PI_2).abs() < 1e-14);
    assert!((turned(ours[1], DVec3::Z) - DVec3::NEG_Y).length() < 1e-14);

    for course in [Box::new(course) as Box<dyn Course>, Box::new(sinking())] {
        let end = course.duration();
        let heading = course.direction(0.0).map(|d| d.x.atan2(d.z)).expect("it moves");
        for levelled in [
            Box::new(Levelled::new(Tangent::new(&*course), Level { start: 0, end: 1 })) as Box<dyn Attitude>,
            Box::new(Levelled::new(Upright::new(&*course, 20.0), Level { start: 0, end: 1 })),
        ] {
            let landed = yaw(levelled.at(end)).expect("level");
            assert!(wrapped(landed - heading).abs() < 0.02, "{landed} {heading}");
            let (before, down) = (levelled.at(end - 1.0), DVec3::NEG_Y);
            assert!((turned(before, DVec3::Z) - down).length() < 1e-9, "still vertical a segment before");
            // Halfway in time half of the 90° of pitch is left.
            let half = turned(levelled.at(end - 0.5), DVec3::Z);
            assert!((tilt(half) - FRAC_PI_2 / 2.0).abs() < 0.02, "{half}");
        }
    }
}

#[test]
fn without_any_heading_it_is_plus_z() {
    let course = Polyline::new(&[[0.0; 3], [0.0, -1.0, 0.0], [0.0, -2.0, 0.0]]);
    for levelled in [Level { start: 3, end: 0 }, Level { start: 0, end: 3 }] {
        let keys = super::super::keyed(&course, &[], levelled);
        assert!(keys.iter().all(|q| q.angle_to(Quat::IDENTITY) < 1e-15), "{keys:?}");
    }
    let levelled = Levelled::new(Tangent::new(&course), Level { start: 0, end: 1 });
    assert!(levelled.at(2.0).angle_to(Quat::IDENTITY) < 1e-14);
}

#[test]
fn segments_that_are_not_levelled_stay_as_they_were() {
    let course = helix(2.0, 0.7);
    let plain = Tangent::new(&course);
    let levelled = Levelled::new(Tangent::new(&course), Level { start: 1, end: 2 });
    let keys = course.key_times();
    assert!(yaw(levelled.at(keys[0])).is_some() && yaw(levelled.at(keys[4])).is_some());
    for i in 0..400 {
        let t = course.duration() * (f64::from(i) + 0.5) / 400.0;
        let same = levelled.at(t).angle_to(plain.at(t)) < 1e-14;
        assert_eq!(same, (keys[1]..=keys[2]).contains(&t), "{t}");
    }
}

#[test]
fn more_keys_than_there_are_level_them_all() {
    let course = helix(2.0, 0.7);
    let keys = super::super::keyed(&course, &[], Level { start: 0, end: 99 });
    assert!(keys.iter().all(|q| yaw(*q).is_some()));
    let levelled = Levelled::new(Upright::new(&course, 0.0), Level { start: 99, end: 99 });
    assert!(yaw(levelled.at(0.0)).is_some() && yaw(levelled.at(course.duration())).is_some());
}

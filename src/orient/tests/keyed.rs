use super::*;
use crate::math::Quat;
use std::f64::consts::{FRAC_1_SQRT_2 as HALF, FRAC_PI_8};

fn keys(points: &[[f64; 3]]) -> Vec<Quat> {
    super::super::keyed(&Polyline::new(points), &[], Level::default())
}

fn assert_same(ours: &[Quat], expected: &[[f64; 4]]) {
    assert_eq!(ours.len(), expected.len());
    for (i, (q, e)) in ours.iter().zip(expected).enumerate() {
        let error = q.angle_to(Quat::from_wxyz(*e));
        assert!(error < 1e-14, "key {i}: {q:?}, expected {e:?}");
    }
    assert!(ours.windows(2).all(|pair| pair[0].dot(pair[1]) >= 0.0), "signs: {ours:?}");
}

#[test]
fn the_hand_worked_zigzag() {
    // Chords +X, +Y, +Z: forward turns by 90° about Y, then Z, then X.
    //   key 0: (1 + j)/√2
    //   key 1: (1 + k)/√2 · (1 + j)/√2 = (1 − i + j + k)/2
    //   key 2: (1 + i)/√2 · (1 − i + j + k)/2 = (1 + k)/√2
    // Back at +Z there is a quarter of a roll: the three turns round an octant.
    let points = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, 5.0]];
    let quarter = [HALF, 0.0, 0.0, HALF];
    assert_same(&keys(&points), &[[HALF, 0.0, HALF, 0.0], [0.5, -0.5, 0.5, 0.5], quarter, quarter]);
}

#[test]
fn a_level_zigzag_only_yaws() {
    // Headings 45°, −45°, 45° from +Z towards +X.
    let points = [[0.0; 3], [1.0, 0.0, 1.0], [0.0, 0.0, 2.0], [1.0, 0.0, 3.0]];
    let (right, left) =
        ([FRAC_PI_8.cos(), 0.0, FRAC_PI_8.sin(), 0.0], [FRAC_PI_8.cos(), 0.0, -FRAC_PI_8.sin(), 0.0]);
    assert_same(&keys(&points), &[right, left, right, right]);
}

#[test]
fn a_reversal_turns_about_the_current_up() {
    // +Z and back: half a turn about Y. Up +Y (up is then −Z) and back: about −Z.
    assert_same(
        &keys(&[[0.0; 3], [0.0, 0.0, 1.0], [0.0; 3]]),
        &[[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
    );
    let lifted = Quat::from_wxyz([HALF, -HALF, 0.0, 0.0]);
    let back = Quat::from_wxyz([0.0, 0.0, 0.0, 1.0]) * lifted;
    let expected = [lifted, back, back].map(Quat::to_wxyz);
    assert_same(&keys(&[[0.0; 3], [0.0, 1.0, 0.0], [0.0; 3]]), &expected);
}

#[test]
fn coincident_points_hold_the_last_direction() {
    let doubled = [[5.0; 3], [5.0; 3], [6.0, 5.0, 5.0], [6.0, 5.0, 5.0], [6.0, 6.0, 5.0]];
    let (east, up) = ([HALF, 0.0, HALF, 0.0], [0.5, -0.5, 0.5, 0.5]);
    assert_same(&keys(&doubled), &[[1.0, 0.0, 0.0, 0.0], east, east, up, up]);
}

#[test]
fn every_key_faces_its_chord() {
    for (name, course) in all() {
        let keys = super::super::keyed(&*course, &[], Level::default());
        for (i, pair) in course.key_times().windows(2).enumerate() {
            let chord = course.position(pair[1]) - course.position(pair[0]);
            if chord.length() > 1e-6 {
                let error = (turned(keys[i], DVec3::Z) - chord.normalize()).length();
                assert!(error < 1e-14, "{name}, key {i}: {error}");
            }
        }
    }
}

#[test]
fn given_orientations_stand_and_do_not_change_the_others() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    let course = Polyline::new(&points);
    let given = Quat::from_wxyz([0.1, 0.7, -0.1, 0.7]);
    let ours = super::super::keyed(&course, &[None, Some(given)], Level { start: 0, end: 4 });
    assert!(ours[1].angle_to(given) < 1e-15);
    let others = super::super::keyed(&course, &[], Level { start: 0, end: 4 });
    assert!([0, 2, 3].into_iter().all(|i| ours[i].angle_to(others[i]) < 1e-15));
}

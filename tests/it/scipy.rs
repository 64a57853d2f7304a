//! A file as `np.savetxt` writes it for scipy users turns the way scipy says.

use crate::support::{fixtures, keyframes, read_clip};
use dat2glb::clip::Body;
use dat2glb::curve::{Ends, Motion, Scheme};
use dat2glb::math::Quat;
use dat2glb::read::{self, Order};
use glam::{DMat3, DQuat, DVec3};
use serde::Deserialize;
use std::fs;

/// Made by fixtures/scipy_example.py: scipy's own matrices.
#[derive(Deserialize)]
struct Reference {
    keys: Rotations,
    slerp: Rotations,
}

#[derive(Deserialize)]
struct Rotations {
    times: Vec<f64>,
    /// By time; rows.
    matrices: Vec<[[f64; 3]; 3]>,
}

fn reference() -> Reference {
    serde_json::from_slice(&fs::read(fixtures().join("scipy.json")).unwrap()).unwrap()
}

/// The rotation turns every axis to where the matrix turns it.
fn check(found: Quat, matrix: [[f64; 3]; 3], what: &str) {
    let turn = DQuat::from_array(found.to_xyzw());
    let matrix = DMat3::from_cols_array_2d(&matrix).transpose();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let apart = (turn * axis - matrix * axis).length();
        assert!(apart < 1e-13, "{what}: {axis} lands {apart} off");
    }
}

#[test]
fn keys_are_the_rotations_that_scipy_wrote() {
    let clip = read_clip(&keyframes("scipy"));
    let keys = reference().keys;
    assert_eq!(clip.body, Body::Chain { length: 1.0 });
    assert_eq!((clip.times.as_slice(), clip.tracks.len()), (keys.times.as_slice(), 1));
    for (i, (&key, &matrix)) in clip.tracks[0].iter().zip(&keys.matrices).enumerate() {
        check(key, matrix, &format!("key {i}"));
    }
}

#[test]
fn slerp_is_what_scipy_calls_slerp() {
    let clip = read_clip(&keyframes("scipy"));
    let motion = Motion::new(&clip.times, &clip.tracks[0], Scheme::Slerp, Ends::Natural);
    let slerp = reference().slerp;
    assert!(slerp.times.len() > 2 * clip.times.len());
    for (&t, &matrix) in slerp.times.iter().zip(&slerp.matrices) {
        check(motion.at(t), matrix, &format!("t = {t}"));
    }
}

/// Made by fixtures/reference/rotation_spline.py.
#[derive(Deserialize)]
struct Splines {
    fixture: String,
    boxes: Vec<Spline>,
}

#[derive(Deserialize)]
struct Spline {
    times: Vec<f64>,
    /// w x y z.
    values: Vec<[f64; 4]>,
    /// The largest jump of its acceleration at a key, by the longer interval squared, rad.
    jump: f64,
}

#[test]
fn natural_c2_is_what_scipy_calls_rotation_spline() {
    let path = fixtures().join("reference/scipy/rotation-spline.json");
    let cases: Vec<Splines> = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    let mut compared = 0;
    for Splines { fixture, boxes } in cases {
        let clip = read_clip(&keyframes(&fixture));
        for (spline, track) in boxes.iter().zip(&clip.tracks) {
            let motion = Motion::new(&clip.times, track, Scheme::NaturalC2, Ends::Chord);
            // Were turns added up as vectors, a jump J beside an interval h would cost a
            // velocity Jh/4 and a place 0.3h times that: 0.08 Jh². Large turns multiply it.
            let limit = 0.25 * spline.jump + 1e-12;
            for (&t, &value) in spline.times.iter().zip(&spline.values) {
                let apart = motion.at(t).angle_to(Quat::from_wxyz(value));
                assert!(apart < limit, "{fixture} at {t}: {apart}, limit {limit}");
                compared += 1;
            }
        }
    }
    assert!(compared > 400, "{compared}");
}

#[test]
fn the_wrong_order_is_noticed_and_the_right_one_is_not() {
    let text = fs::read(keyframes("scipy")).unwrap();
    let warned = |order| {
        let warnings = read::keyframes("scipy.dat", text.as_slice(), order).unwrap().warnings;
        warnings.into_iter().filter(|w| w.code == "QUAT_ORDER").map(|w| w.message).collect::<String>()
    };
    assert_eq!(warned(None), "");
    assert!(warned(Some(Order::Wxyz)).contains("--quat-order xyzw"), "{}", warned(Some(Order::Wxyz)));
}

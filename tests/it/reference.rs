//! Every scheme against values computed by another program in another language with 50
//! digits (fixtures/reference).

use dat2glb::curve::{Ends, Motion, Scheme, Tcb};
use dat2glb::math::Quat;
use dat2glb::read;
use serde::Deserialize;
use std::fs;
use std::path::PathBuf;

#[derive(Deserialize)]
struct Reference {
    fixture: String,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    scheme: String,
    ends: String,
    /// Tension, continuity and bias.
    #[serde(default)]
    tcb: [f64; 3],
    times: Vec<f64>,
    /// By box, by time, w x y z.
    values: Vec<Vec<[f64; 4]>>,
}

fn fixtures() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fixtures")
}

#[test]
fn every_scheme_agrees_with_the_reference() {
    let mut compared = 0;
    let mut schemes = std::collections::BTreeSet::new();
    for entry in fs::read_dir(fixtures().join("reference")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ext| ext == "json") {
            let reference: Reference = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
            schemes.extend(reference.cases.iter().map(|case| case.scheme.clone()));
            compared += compare(&reference);
        }
    }
    assert_eq!(schemes.len(), Scheme::ALL.len(), "{schemes:?}");
    assert!(compared > 10_000, "only {compared} values");
}

fn compare(reference: &Reference) -> usize {
    let path = fixtures().join("keyframes").join(format!("{}.dat", reference.fixture));
    let file = fs::File::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let clip = read::keyframes(&reference.fixture, file, None).unwrap().clip;
    let mut compared = 0;
    for case in &reference.cases {
        let (scheme, ends) = (Scheme::from_name(&case.scheme).unwrap(), Ends::from_name(&case.ends).unwrap());
        assert_eq!(case.values.len(), clip.tracks.len());
        for (index, (track, values)) in clip.tracks.iter().zip(&case.values).enumerate() {
            let [tension, continuity, bias] = case.tcb;
            let motion = Motion::new(&clip.times, track, scheme, ends);
            let motion = motion.with_tcb(Tcb { tension, continuity, bias });
            for (&t, &value) in case.times.iter().zip(values) {
                let error = motion.at(t).angle_to(Quat::from_wxyz(value)).to_degrees();
                // Both are float64 at the end: keys carry 1e-16, and the steepest motion
                // among the fixtures multiplies what 1e-16 of its time is worth by 1e3.
                assert!(
                    error < 1e-11,
                    "{} {} {} box {} at {t}: {error} degrees",
                    reference.fixture,
                    case.scheme,
                    case.ends,
                    index + 1
                );
                compared += 1;
            }
        }
    }
    compared
}

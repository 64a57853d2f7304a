//! From inputs to a checked file in memory.

use dat2glb::asset::{Asset, NoFiles};
use dat2glb::check::{self, Severity};
use dat2glb::convert::{Options, Plan, Sampling};
use dat2glb::curve::Scheme;
use dat2glb::moves::{Ground, Inputs, Shape};
use dat2glb::sample::Writing;
use std::io::Cursor;

/// Outputs of more samples are planned but not written: large ones would be slow rightly.
pub const MOST_SAMPLES: u64 = 20_000;

/// What is asked for.
pub struct Asked {
    pub shape: Shape,
    pub scheme: Scheme,
    pub sampling: Sampling,
    pub writing: Writing,
}

/// Converts inputs and checks what comes out: the file's bytes, none where the inputs are
/// refused or there would be too many samples. Panics where the output is not sound.
pub fn convert(inputs: &Inputs, asked: Asked) -> Option<Vec<u8>> {
    let options = Options {
        name: "fuzz".into(),
        inputs: inputs.hashes().iter().map(|_| "fuzz.dat".to_owned()).collect(),
        quat_order: None,
        cameras: inputs.cameras.iter().map(|_| "camera".to_owned()).collect(),
        path_colour: None,
        schemes: vec![asked.scheme],
        sampling: asked.sampling,
        writing: asked.writing,
    };
    let ground = said(Ground::new(inputs, asked.shape, &options.schemes))?;
    let plan = said(Plan::new(&ground, "fuzz.dat", &options))?;
    if plan.samples() > MOST_SAMPLES || said(plan.fits_glb()).is_none() {
        return None;
    }
    let (file, _) = plan.write_glb(Cursor::new(Vec::new()), |_| ()).expect("memory can be written");
    let bytes = file.into_inner();
    let mut asset = Asset::open(Box::new(Cursor::new(bytes.clone())), Box::new(NoFiles)).expect("opens");
    let report = check::asset(&mut asset);
    assert!(report.worst() < Some(Severity::Error), "{}", report.text("fuzz.glb"));
    Some(bytes)
}

/// What went well; a refusal must have a message.
pub fn said<T, E: std::fmt::Display>(result: Result<T, E>) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(error) => {
            assert!(!error.to_string().is_empty(), "a refusal without a word");
            None
        }
    }
}

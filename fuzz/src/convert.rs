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
/// Tracks of more are not even planned.
const MOST_PLANNED: f64 = 500_000.0;

/// What is asked for.
pub struct Asked {
    pub shape: Shape,
    pub scheme: Scheme,
    pub sampling: Sampling,
    pub writing: Writing,
}

/// A sample's time and value, bytes.
const SAMPLE: usize = 20;

/// What becomes of inputs.
pub enum Outcome {
    /// A sound file.
    File(Vec<u8>),
    /// A plan that would be about so many bytes.
    Planned(usize),
    Refused,
}

impl Outcome {
    /// How much came out, or would.
    pub fn size(&self) -> usize {
        match self {
            Outcome::File(bytes) => bytes.len(),
            Outcome::Planned(bytes) => *bytes,
            Outcome::Refused => 0,
        }
    }
}

/// Converts inputs and checks what comes out. Panics where it is not sound.
pub fn convert(inputs: &Inputs, asked: Asked) -> Outcome {
    planned(inputs, asked).unwrap_or(Outcome::Refused)
}

fn planned(inputs: &Inputs, asked: Asked) -> Option<Outcome> {
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
    if let Sampling::Rate { fps, .. } = asked.sampling
        && ground.duration() / fps.interval() > MOST_PLANNED
    {
        return None;
    }
    let plan = said(Plan::new(&ground, "fuzz.dat", &options))?;
    said(plan.fits_glb())?;
    if plan.samples() > MOST_SAMPLES {
        return Some(Outcome::Planned(SAMPLE * plan.samples() as usize));
    }
    let (file, _) = plan.write_glb(Cursor::new(Vec::new()), |_| ()).expect("memory can be written");
    let bytes = file.into_inner();
    let mut asset = Asset::open(Box::new(Cursor::new(bytes.clone())), Box::new(NoFiles)).expect("opens");
    let report = check::asset(&mut asset);
    assert!(report.worst() < Some(Severity::Error), "{}", report.text("fuzz.glb"));
    Some(Outcome::File(bytes))
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

//! Bytes as a file of keyframes, on to a checked file.

#![no_main]

use dat2glb::convert::Sampling;
use dat2glb::curve::{Ends, Scheme};
use dat2glb::moves::{Inputs, Shape};
use dat2glb::read::{self, Order};
use dat2glb::sample::Writing;
use dat2glb_fuzz::convert::{Asked, convert, said};
use dat2glb_fuzz::{dice::Dice, memory::measured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| measured(data.len(), || run(data).unwrap_or(0)));

fn run(data: &[u8]) -> Option<usize> {
    let mut dice = Dice::of(data);
    let order = dice.pick(&[None, None, Some(Order::Wxyz), Some(Order::Xyzw)]);
    let keyframes = said(read::keyframes("fuzz.dat", data, order))?;
    let clip = &keyframes.clip;
    assert!(clip.times.len() >= 2 && clip.times[0] == 0.0 && clip.times.is_sorted_by(|a, b| a < b));
    assert!(clip.tracks.iter().flatten().all(|key| (key.norm() - 1.0).abs() < 1e-9));
    let inputs = Inputs { keyframes: Some(keyframes), path: None, cameras: Vec::new() };
    let asked = Asked {
        shape: Shape { ends: dice.pick(&Ends::ALL), ..Shape::default() },
        scheme: dice.pick(Scheme::EVERY),
        sampling: Sampling::Rate { fps: dice.pick(&["1", "24", "1/1000"]).parse().ok()?, key_times: true },
        writing: Writing::default(),
    };
    Some(convert(&inputs, asked).size())
}

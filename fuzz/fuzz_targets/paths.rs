//! Bytes as any input, through the motion that they make, on to a checked file.

#![no_main]

use dat2glb::convert::{Fewest, Sampling};
use dat2glb::curve::Scheme;
use dat2glb::moves::{Camera, Copies, Inputs, Orient, Shape, rotation_keys};
use dat2glb::orient::{Frame, Level};
use dat2glb::path::{Ease, PathEnds, Timing};
use dat2glb::read::{self, Input};
use dat2glb::sample::Writing;
use dat2glb_fuzz::convert::{Asked, convert, said};
use dat2glb_fuzz::{dice::Dice, memory::measured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| measured(data.len(), || run(data).unwrap_or(0)));

fn run(data: &[u8]) -> Option<usize> {
    let mut dice = Dice::of(data);
    let frame = dice.pick(&[None, Some(Frame::Gltf), Some(Frame::Frd), Some(Frame::Flu)]);
    let (keyframes, path) = match said(read::input("fuzz.dat", data, None))? {
        Input::Keyframes(keyframes) => (Some(keyframes), None),
        Input::Rotations(file) => (Some(rotation_keys(file, frame)), None),
        Input::Path(file) => (None, Some(file)),
        _ => return None,
    };
    let cameras = match dice.below(4) {
        0 => vec![Camera::Follow { offset: None }],
        1 => vec![Camera::Keys],
        _ => Vec::new(),
    };
    let inputs = Inputs { keyframes, path, cameras };
    let asked = Asked {
        shape: shape(&mut dice, frame),
        scheme: dice.pick(Scheme::EVERY),
        sampling: sampling(&mut dice)?,
        writing: Writing::default(),
    };
    Some(convert(&inputs, asked).size())
}

fn shape(dice: &mut Dice, frame: Option<Frame>) -> Shape {
    let orients =
        [None, Some(Orient::None), Some(Orient::Keyed), Some(Orient::Tangent), Some(Orient::Upright)];
    let timings = [
        None,
        None,
        Some(Timing::Uniform),
        Some(Timing::Chord),
        Some(Timing::ConstantSpeed),
        Some(Timing::Times),
    ];
    Shape {
        path_ends: dice.pick(&PathEnds::ALL),
        timing: dice.pick(&timings),
        ease: dice.pick(&[Ease::None, Ease::None, Ease::In, Ease::Out, Ease::InOut]),
        orient: dice.pick(&orients),
        frame,
        bank: dice.pick(&[0.0, 0.0, 30.0]),
        level: dice.pick(&[Level::default(), Level { start: 1, end: 2 }]),
        copies: dice.pick(&[Copies::default(), Copies { count: 3, delay: None, wrap: true }]),
        ..Shape::default()
    }
}

fn sampling(dice: &mut Dice) -> Option<Sampling> {
    if dice.one_in(4) {
        return Some(Sampling::Fewest(Fewest {
            tolerance: 1.0,
            distance: None,
            max_step: Fewest::MAX_STEP,
            on_curve: dice.one_in(2),
            cubic: false,
        }));
    }
    Some(Sampling::Rate { fps: dice.pick(&["1", "24", "1/1000"]).parse().ok()?, key_times: dice.one_in(2) })
}

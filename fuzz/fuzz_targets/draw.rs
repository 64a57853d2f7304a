//! Bytes as a glTF file, drawn small by the software renderer.

#![no_main]

use dat2glb::asset::{Asset, NoFiles};
use dat2glb::render::{self, Options, Renderer, Style, Time};
use dat2glb_fuzz::convert::said;
use dat2glb_fuzz::{dice::Dice, glb, memory::measured};
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use std::io::Cursor;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    glb::mutate(&mut data[..max_size], size, seed, |bytes, size| {
        let room = bytes.len();
        fuzzer_mutate(bytes, size, room)
    })
});

fuzz_target!(|data: &[u8]| measured(data.len(), || run(data).unwrap_or(0)));

fn run(data: &[u8]) -> Option<usize> {
    let mut dice = Dice::of(data);
    let mut asset = said(Asset::open(Box::new(Cursor::new(data.to_vec())), Box::new(NoFiles)))?;
    let camera = asset.root().cameras.first().and_then(|camera| camera.name.clone());
    let options = Options {
        time: Time::Fraction(dice.pick(&[0.0, 0.5, 1.0])),
        renderer: Renderer::Cpu,
        style: Style {
            size: (48, 36),
            floor: dice.one_in(2),
            camera: camera.filter(|_| dice.one_in(2)),
            ..Style::default()
        },
        ..Options::default()
    };
    let picture = said(render::thumbnail(&mut asset, &options))?;
    assert!((0.0..=1.0).contains(&picture.covered), "{}", picture.covered);
    Some(picture.pixels.len())
}

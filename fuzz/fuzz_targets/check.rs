//! Bytes as a glTF file, checked.

#![no_main]

use dat2glb::asset::NoFiles;
use dat2glb::check;
use dat2glb_fuzz::convert::said;
use dat2glb_fuzz::{glb, memory::measured};
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use std::io::Cursor;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    glb::mutate(&mut data[..max_size], size, seed, |bytes, size| {
        let room = bytes.len();
        fuzzer_mutate(bytes, size, room)
    })
});

fuzz_target!(|data: &[u8]| measured(data.len(), || {
    let file = Box::new(Cursor::new(data.to_vec()));
    let report = said(check::file(file, Box::new(NoFiles)));
    report.map_or(0, |report| report.text("fuzz.glb").len())
}));

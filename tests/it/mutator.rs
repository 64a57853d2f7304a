//! The mutator of the fuzz targets: nothing else runs the tests of the fuzz crate.

#![expect(dead_code, reason = "fuzz targets use the rest")]

#[path = "../../fuzz/src/dice.rs"]
mod dice;
#[path = "../../fuzz/src/glb.rs"]
mod glb;
#[path = "../../fuzz/src/json.rs"]
mod json;

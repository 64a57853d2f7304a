//! The mutator of the fuzz targets: nothing else runs the tests of the fuzz crate.

#![expect(dead_code, unreachable_pub, reason = "written for the fuzz targets")]

#[path = "../../fuzz/src/dice.rs"]
mod dice;
#[path = "../../fuzz/src/glb.rs"]
mod glb;
#[path = "../../fuzz/src/json.rs"]
mod json;

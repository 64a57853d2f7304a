//! What fuzz targets share: the rule of memory, a dice, the way from inputs to a checked
//! file, and a mutator that keeps a `.glb` in one piece.

pub mod convert;
pub mod dice;
pub mod glb;
pub mod json;
pub mod memory;

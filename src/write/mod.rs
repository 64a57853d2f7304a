//! Samples to glTF.

//! Any glTF 2.0 file, opened for reading: JSON parsed, buffers read on demand.

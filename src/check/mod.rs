//! Judges a glTF file as its users' viewers would see it.

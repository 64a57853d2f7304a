//! Draws a glTF file at a time of one of its clips.

//! Smooth motions through keys.

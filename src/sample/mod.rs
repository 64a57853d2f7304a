//! Motions to samples at the times a viewer plays.
//!
//! A [`Timeline`] says when; [`rotations`] evaluates every track there, in parallel
//! chunks that reach the caller in order, and says how far a viewer's playback of the
//! written numbers can be from the curve. Memory does not grow with the output.

pub(crate) mod blend;
pub(crate) mod corners;
pub(crate) mod deviation;
mod encoding;
mod fps;
pub(crate) mod interlude;
mod rotations;
mod sieve;
mod steps;
mod timeline;
pub(crate) mod translations;
pub(crate) mod worst;

pub(crate) use deviation::written;
pub use encoding::{Encoding, code};
pub use fps::{Fps, NotARate};
pub use rotations::{Rotation, TrackFacts, Writing, rotations};
pub use steps::Steps;
pub use timeline::{Timeline, TooFine, fits, keys_apart};
pub use translations::{Travel, translations};

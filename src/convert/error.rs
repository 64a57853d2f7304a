//! Why there is no output.

use crate::reduce;
use crate::sample::{Fps, TooFine};

/// Why keyframes and options make no file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Frames that float32 cannot tell apart.
    #[error("{0}: {1}")]
    TooFine(String, TooFine),
    /// Keys that float32 cannot tell apart.
    #[error(
        "{source_name}:{}: the keys in lines {} and {} are so close that float32, glTF's number for times, \
         cannot tell them apart {seconds} s after the first key; leave one of them out{}",
        .lines.1, .lines.0, .lines.1, if *.key_times { ", or use --no-key-times" } else { "" }
    )]
    KeysTooClose {
        /// The input's name.
        source_name: String,
        /// The lines of both.
        lines: (usize, usize),
        /// When the first of them is, from the first key on.
        seconds: f64,
        /// Whether leaving the key times out helps.
        key_times: bool,
    },
    /// More than a .glb can hold.
    #[error(
        "{source_name}: the output would have {:.2} GiB, and a .glb ends at 4 GiB; {}{}write a .gltf",
        *.bytes as f64 / (1u64 << 30) as f64, advice(*.largest_fps, *.key_times),
        if *.several_schemes { "choose fewer schemes, or " } else { "or " }
    )]
    TooLarge {
        /// The input's name.
        source_name: String,
        /// How large it would be.
        bytes: u64,
        /// A rate at which it fits, if there is one.
        largest_fps: Option<Fps>,
        /// Whether it fits with the key times.
        key_times: bool,
        /// Whether there are schemes to leave out.
        several_schemes: bool,
    },
    /// Copies of what has keys of its own, by a flag.
    #[error("{0}: copies need samples at a fixed rate: leave out {1} or --repeat")]
    Copies(String, &'static str),
    /// A tolerance that cannot be kept.
    #[error("{source_name}: {}", unkept(*.error, unit, *.reserve, *.shared))]
    Fewest {
        /// The input's name.
        source_name: String,
        /// Why.
        error: reduce::Error,
        /// What tolerances are told in.
        unit: &'static str,
        /// The part of the tolerance that 16-bit numbers take.
        reserve: f64,
        /// Whether the tolerance is one node's part of a distance that all share.
        shared: bool,
    },
}

fn unkept(error: reduce::Error, unit: &str, reserve: f64, shared: bool) -> String {
    let told = match error {
        reduce::Error::Tolerance { tolerance, least } => format!(
            "a tolerance of {tolerance:.1e}{unit} is too small: float32 numbers need at least {least:.1e}{unit}"
        ),
        reduce::Error::Swings { .. } => {
            return format!("{error}: use a fixed rate (--fps) instead, or --scheme bessel");
        }
        reduce::Error::Spins { .. } => {
            return format!("{error}: use a fixed rate (--fps) instead, or --scheme slerp");
        }
        reduce::Error::Times { time, tolerance } => format!(
            "float32 times cannot follow the curve at {time:.6} s to within {tolerance:.1e}{unit}: \
             choose a larger tolerance, or a rate (--fps) instead"
        ),
    };
    let part = if shared { "; this is the share of --tolerance-distance for one node" } else { "" };
    let coding = if reserve > 0.0 {
        format!(" (--quantize alone takes {reserve:.1e}°: choose a larger tolerance, or leave it out)")
    } else {
        String::new()
    };
    format!("{told}{part}{coding}")
}

fn advice(largest_fps: Option<Fps>, key_times: bool) -> String {
    let flag = if key_times { "" } else { " with --no-key-times" };
    largest_fps.map_or(String::new(), |fps| format!("sample at --fps {fps} or less{flag}, "))
}

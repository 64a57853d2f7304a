//! Text to checked keyframes, points of a path, or rotations.
//!
//! A `.dat` file is read in blocks of whole lines, whose rows are parsed in parallel
//! as bytes; positions are worked out only when there is something to say. Reading
//! stops at the first problem. The format: docs/format.md.

mod blocks;
mod decimal;
mod header;
mod input;
mod keyframes;
mod kind;
mod oddities;
mod path;
mod refusal;
mod rotations;
mod rows;
mod table;
mod times;
mod words;

pub use input::{Input, input};
pub use keyframes::{Keyframes, keyframes};
pub use path::PathFile;
pub use refusal::Refusal;
pub use rotations::{Rotations, RotationsFile};

/// The order in which a file gives a quaternion's parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// Scalar first: the default of `.dat` files.
    #[default]
    Wxyz,
    /// Scalar last: SciPy, ROS, glTF.
    Xyzw,
}

impl Order {
    /// As headers and options spell it.
    pub fn name(self) -> &'static str {
        match self {
            Order::Wxyz => "wxyz",
            Order::Xyzw => "xyzw",
        }
    }

    /// The order of a name, if it is one.
    pub fn from_name(name: &str) -> Option<Order> {
        [Order::Wxyz, Order::Xyzw].into_iter().find(|order| order.name() == name)
    }

    fn from_name_bytes(name: &[u8]) -> Option<Order> {
        Order::from_name(std::str::from_utf8(name).ok()?)
    }

    fn other(self) -> Order {
        match self {
            Order::Wxyz => Order::Xyzw,
            Order::Xyzw => Order::Wxyz,
        }
    }
}

/// Why an input became no clip.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The input is not what it must be.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The input could not be read.
    #[error("{source_name}: {error}")]
    Io {
        /// The input's name.
        source_name: String,
        /// The system's reason.
        error: std::io::Error,
    },
}

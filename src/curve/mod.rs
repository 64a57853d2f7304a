//! Smooth motions through keys.
//!
//! A [`Scheme`] says which curve runs between two keys, given the neighbours on
//! either side; [`Ends`] says what stands in for the neighbours the first and last
//! segment lack; a [`Motion`] is one track's keys with both, or control rotations, which
//! need neither.
//!
//! A further scheme is a file here, a line in `scheme.rs` and a page in docs/math.

mod arc;
mod b_spline;
mod barry_goldman;
mod bessel;
mod bessel_overhauser;
mod catmull_rom;
mod cumulative;
mod ends;
mod kochanek_bartels;
mod lanes;
mod log_rates;
mod motion;
mod natural_c2;
mod nlerp;
mod rates;
mod rule;
mod scheme;
mod slerp;
mod span;
mod squad;
mod step;
mod tcb;
mod track;
mod warnings;

pub use arc::Arc;
pub use ends::{Ends, NotClosed, ramp_start};
pub use motion::{Motion, Piece};
pub use rates::Rates;
pub use rule::Smoothness;
pub use scheme::Scheme;
pub use tcb::Tcb;
pub use warnings::warnings;

#[cfg(test)]
mod tests;

//! `dat2glb example`.

use clap::Args;

#[derive(Args, Debug)]
pub(crate) struct Example {
    /// Kind of input
    #[arg(value_enum)]
    pub(crate) kind: Kind,
}

/// A kind of input.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum Kind {
    /// A swinging chain of three boxes
    Chain,
    /// A tumbling free body, component order x y z w
    Body,
    /// Key points of a flight and landing
    Flight,
    /// Control points of a Bézier path
    Bezier,
    /// A Bézier path of a camera watching the flight
    Camera,
    /// Roll, pitch and yaw in degrees
    Euler,
}

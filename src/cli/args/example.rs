//! `dat2glb example`.

use clap::Args;

#[derive(Args, Debug)]
pub(crate) struct Example {
    /// Which kind of input
    #[arg(value_enum)]
    pub(crate) kind: Kind,
}

/// A kind of input.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum Kind {
    /// A chain of three boxes that swing
    Chain,
    /// One free body that tumbles, in the order x y z w
    Body,
    /// Key points of a flight that lands
    Flight,
    /// Control points of a Bézier path
    Bezier,
    /// A Bézier path for a camera that watches the flight
    Camera,
    /// Roll, pitch and yaw in degrees
    Euler,
}

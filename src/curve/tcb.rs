//! Tension, continuity and bias.

/// What shapes the tangents of `kochanek-bartels`; all zero is `bessel`.
///
/// Each from −1 to 1. Source: Kochanek and Bartels 1984; docs/math/kochanek-bartels.md.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tcb {
    /// 1 stops at every key, −1 runs through it twice as fast.
    pub tension: f64,
    /// Anything but 0 makes a corner at every key: outwards above, inwards below.
    pub continuity: f64,
    /// 1 leaves a key as it came, −1 comes to it as it will leave.
    pub bias: f64,
}

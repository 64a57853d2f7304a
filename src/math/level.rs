//! Which vector units there are.

use fearless_simd::Level;
use std::sync::LazyLock;

/// The widest vector units of this machine, found out once: asking takes long.
pub(crate) fn widest() -> Level {
    static LEVEL: LazyLock<Level> = LazyLock::new(Level::new);
    *LEVEL
}

//! What every path must do.

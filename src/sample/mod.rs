//! Motions to samples at the times a viewer plays.

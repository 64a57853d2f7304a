//! Whole-flow tests, a file a stage.

mod reference;

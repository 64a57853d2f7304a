//! Checked keyframes, shared by all stages.

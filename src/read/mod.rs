//! Text to checked keyframes.

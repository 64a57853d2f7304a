//! Why points do not make a path.

use super::{Kind, Timing};

/// Why points and options do not make a path, and what to do about it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Fewer than two points.
    #[error("a path needs at least 2 points, but there are {found}")]
    TooFew {
        /// How many there are.
        found: usize,
    },
    /// Cubic Bézier segments with points missing or over.
    #[error(
        "cubic Bézier segments need 3n+1 control points (4, 7, 10, …), but there are {found}: {}; \
         or say degree={} for one curve of them all", cubic_repair(*found), found.saturating_sub(1)
    )]
    CubicCount {
        /// How many there are.
        found: usize,
    },
    /// A single Bézier curve with points missing or over.
    #[error(
        "degree={degree} needs {} control points, but there are {found}: {}; or say degree={} for one \
         curve of them all, or leave the degree out for cubic segments of 3n+1 points",
        degree + 1, degree_repair(*degree, *found), found.saturating_sub(1)
    )]
    DegreeCount {
        /// The degree that was asked for.
        degree: usize,
        /// How many points there are.
        found: usize,
    },
    /// A degree of 0, or one that is too high.
    #[error(
        "a Bézier curve has a degree from 1 to {}, not {degree}; leave the degree out for cubic segments",
        Kind::HIGHEST_DEGREE
    )]
    Degree {
        /// The degree that was asked for.
        degree: usize,
    },
    /// A coordinate that is no number, or too large to compute with.
    #[error("point {}: coordinates must be numbers of at most 1e150", .point + 1)]
    Coordinate {
        /// The point, counted from 0.
        point: usize,
    },
    /// Times that do not belong to the key points one by one.
    #[error("there are {found} times for {expected} key points")]
    TimeCount {
        /// How many key points there are.
        expected: usize,
        /// How many times there are.
        found: usize,
    },
    /// A time that does not come after the one before.
    #[error("the time of key point {} must be later than the one before, by a nanosecond at least", .key + 1)]
    Order {
        /// The key point, counted from 0.
        key: usize,
    },
    /// Timing by times, and there are none.
    #[error("--timing times needs a time in front of each point; without, choose another timing")]
    NoTimes,
    /// A closing segment that no time belongs to.
    #[error(
        "the closing segment has no time: repeat the first point at the end, with its time, or choose \
         another timing"
    )]
    ClosingTime,
    /// A kind that is tied to its own timing.
    #[error(
        "{} cannot be run with {} timing, for its knots are its times: choose catmull-rom, which takes \
         them as knots, or --timing constant-speed, which keeps the shape", .kind.name(), .timing.name()
    )]
    FixedKnots {
        /// The kind of path.
        kind: Kind,
        /// What was asked for.
        timing: Timing,
    },
    /// Chord timing with a segment that goes somewhere and comes back.
    #[error(
        "segment {} ends where it starts, so --timing chord gives it no time; choose uniform or \
         constant-speed", .segment + 1
    )]
    NoChord {
        /// The segment, counted from 0.
        segment: usize,
    },
    /// Easing without constant speed.
    #[error("--ease shapes a constant speed: add --timing constant-speed, or leave --ease out")]
    Ease,
    /// A duration with something else that determines it.
    #[error("{0} and a duration contradict each other; leave one of them out")]
    TwoDurations(&'static str),
    /// A duration that is no usable number of seconds.
    #[error("the path would last {0} s; it must last from a nanosecond to 1e12 s")]
    Duration(f64),
    /// A speed that is none.
    #[error("a speed must be a number above 0, not {0}")]
    Speed(f64),
}

/// What makes the number of points 3n + 1, n ≥ 1.
fn cubic_repair(found: usize) -> String {
    let missing = if found < 4 { 4 - found } else { 2 - (found + 1) % 3 };
    let over = 3 - missing.min(3);
    if found < 5 { format!("{missing} missing") } else { format!("{missing} missing, or {over} over") }
}

fn degree_repair(degree: usize, found: usize) -> String {
    let needed = degree + 1;
    if found < needed { format!("{} missing", needed - found) } else { format!("{} over", found - needed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_say_what_is_missing_or_over() {
        let text = |found| Error::CubicCount { found }.to_string();
        assert!(text(2).contains("there are 2: 2 missing; or say degree=1"), "{}", text(2));
        assert!(text(3).contains(": 1 missing; or say degree=2"), "{}", text(3));
        assert!(text(5).contains(": 2 missing, or 1 over; or say degree=4"), "{}", text(5));
        assert!(text(6).contains(": 1 missing, or 2 over; or say degree=5"), "{}", text(6));
        assert!(text(8).contains(": 2 missing, or 1 over"), "{}", text(8));
        assert!(text(12).contains(": 1 missing, or 2 over"), "{}", text(12));
        let text = |found| Error::DegreeCount { degree: 5, found }.to_string();
        assert!(text(4).contains("needs 6 control points, but there are 4: 2 missing"), "{}", text(4));
        assert!(text(7).contains("1 over; or say degree=6") && text(7).contains("3n+1"), "{}", text(7));
    }
}

//! Checked keyframes, shared by all stages: what holds here need not be asked again.

use crate::math::Quat;

/// The rotations of one or more boxes at common key times.
///
/// Times start at 0 and increase strictly; there are at least two. Every track has a
/// key a time (of control rotations two more between two times), of unit length, in the
/// hemisphere of the one before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// What the rotations turn.
    pub body: Body,
    /// Time of the first key as the file gives it, seconds.
    pub start: f64,
    /// Times of the keys, seconds since the first.
    pub times: Vec<f64>,
    /// One for each box, from the top of the chain down.
    pub tracks: Vec<Vec<Quat>>,
    /// What the rotations are to the motion.
    pub through: Through,
    /// Where the keys stand in the file.
    pub lines: Lines,
}

/// What a clip's rotations turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// A linked pendulum: each box hangs from the bottom of the one above it.
    Chain {
        /// Length of a box, the distance from hinge to hinge.
        length: f64,
    },
    /// One free body: centred, nose along +Z, up +Y.
    Free,
}

/// What rotations are to the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Through {
    /// Keys that it runs through, by a scheme.
    #[default]
    Keys,
    /// Control rotations of cubic segments, 3n + 1 of them for n + 1 times; it runs
    /// through every third.
    Controls,
}

impl Through {
    /// How many times so many rotations have.
    pub fn times(self, rotations: usize) -> usize {
        match self {
            Through::Keys => rotations,
            Through::Controls => rotations / 3 + 1,
        }
    }

    /// Which rotation belongs to a time.
    pub fn rotation(self, time: usize) -> usize {
        match self {
            Through::Keys => time,
            Through::Controls => 3 * time,
        }
    }
}

impl Clip {
    /// Time from the first key to the last, seconds.
    pub fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Where key `i` stands, for messages: `t = 2.12 s (line 7)`.
    pub fn place(&self, key: usize) -> String {
        format!("t = {} s (line {})", self.start + self.times[key], self.line(key))
    }

    /// The line of the rotation that the motion runs through at time `key`.
    pub fn line(&self, key: usize) -> usize {
        self.lines.of(self.through.rotation(key))
    }
}

/// The line of every key, kept only where lines are left out between keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// Key and its line, for each key that does not stand on the line after the one
    /// before it.
    breaks: Vec<(usize, usize)>,
    next: (usize, usize),
}

impl Lines {
    /// Notes that the next key stands on `line`.
    pub fn push(&mut self, line: usize) {
        let (key, expected) = self.next;
        if self.breaks.is_empty() || line != expected {
            self.breaks.push((key, line));
        }
        self.next = (key + 1, line + 1);
    }

    /// The line of a key, counted from 1.
    pub fn of(&self, key: usize) -> usize {
        let (first, line) = self.breaks[self.breaks.partition_point(|b| b.0 <= key) - 1];
        line + (key - first)
    }
}

/// Something a user should know although the work goes on.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    /// Stable name, such as `NOT_UNIT`.
    pub code: &'static str,
    /// What was seen, where, and what to do.
    pub message: String,
}

impl Warning {
    /// A warning of the kind `code`.
    pub fn new(code: &'static str, message: impl Into<String>) -> Warning {
        Warning { code, message: message.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_survive_gaps() {
        let mut lines = Lines::default();
        let given = [3, 4, 5, 9, 10, 12];
        given.iter().for_each(|&line| lines.push(line));
        assert_eq!(lines.breaks.len(), 3);
        for (key, line) in given.into_iter().enumerate() {
            assert_eq!(lines.of(key), line);
        }
    }
}

//! A track's keys, and what its ends make of them.

use super::span::{End, Neighbour, Span};
use super::{Ends, Tcb};
use crate::math::{Quat, Vec3};

/// The keys of one box and what happens at the first and the last.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track<'a> {
    pub(super) times: &'a [f64],
    /// Keys, or control rotations.
    pub(super) keys: &'a [Quat],
    /// The last key, which closed ends make equal to the first.
    pub(super) last: Quat,
    pub(super) ends: Ends,
    /// How many keys at either end the curve leaves out.
    pub(super) margin: usize,
}

impl Track<'_> {
    /// Key i as the motion passes it.
    pub(super) fn key(&self, i: usize) -> Quat {
        if i + 1 == self.keys.len() { self.last } else { self.keys[i] }
    }

    /// Time from key i to key i + 1.
    pub(super) fn interval(&self, i: usize) -> f64 {
        self.times[i + 1] - self.times[i]
    }

    /// Segment i, between two keys, and what surrounds it.
    pub(super) fn span(&self, i: usize, velocities: [Vec3; 2], tcb: Tcb) -> Span {
        Span {
            before: self.before(i),
            start: self.key(i),
            end: self.key(i + 1),
            h: self.interval(i),
            after: self.after(i + 1),
            end_rule: self.end_rule(),
            intervals: std::array::from_fn(|k| self.interval_beyond(i as isize + k as isize - 2)),
            velocities,
            tcb,
        }
    }

    pub(super) fn end_rule(&self) -> End {
        match self.ends {
            Ends::Clamped => End::Chord(0.0),
            Ends::Chord => End::Chord(1.0),
            Ends::Repeat => End::Repeat,
            Ends::Natural | Ends::Closed | Ends::Hold => End::Natural,
        }
    }

    /// The first and the last key of the curve.
    fn bounds(&self) -> (usize, usize) {
        (self.margin, self.times.len() - 1 - self.margin)
    }

    /// The key before key i.
    fn before(&self, i: usize) -> Option<Neighbour> {
        let (first, last) = self.bounds();
        let closed = self.ends == Ends::Closed;
        if i > first {
            let is_end = i - 1 == first && !closed;
            return Some(Neighbour { key: self.key(i - 1), h: self.interval(i - 1), is_end });
        }
        // The sign that makes the last key the first.
        let key = || self.with_seam_sign(self.key(last - 1));
        closed.then(|| Neighbour { key: key(), h: self.interval(last - 1), is_end: false })
    }

    /// The key after key i.
    fn after(&self, i: usize) -> Option<Neighbour> {
        let (_, last) = self.bounds();
        let closed = self.ends == Ends::Closed;
        if i < last {
            let is_end = i + 1 == last && !closed;
            return Some(Neighbour { key: self.key(i + 1), h: self.interval(i), is_end });
        }
        let key = || self.with_seam_sign(self.key(1));
        closed.then(|| Neighbour { key: key(), h: self.interval(0), is_end: false })
    }

    fn with_seam_sign(&self, q: Quat) -> Quat {
        if self.key(0).dot(self.last) < 0.0 { -q } else { q }
    }

    /// The length of segment i, which may lie beyond the ends: intervals come again in the
    /// same order where the motion is closed, and mirrored where it is not.
    fn interval_beyond(&self, i: isize) -> f64 {
        let (first, last) = self.bounds();
        let (first, last) = (first as isize, last as isize);
        let within = match i {
            i if i >= first && i < last => i,
            i if self.ends == Ends::Closed => first + (i - first).rem_euclid(last - first),
            i if i < first => 2 * first - 1 - i,
            i => 2 * last - 1 - i,
        };
        self.interval(within.clamp(first, last - 1) as usize)
    }
}

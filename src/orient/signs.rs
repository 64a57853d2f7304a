//! The signs of rotations along a course, so that none changes for nothing.

use super::recent::Recent;
use super::steps::{Spot, Steps};
use crate::math::Quat;
use rayon::prelude::*;
use std::ops::Range;

/// The signs of rotations in some segments of a course, each of which follows on from the one
/// before; one segment at least.
pub(super) struct Signs {
    segments: Range<usize>,
    /// Where each segment begins in `turned`.
    first: Vec<usize>,
    /// Whether the rotation where a step begins or ends is taken with the other sign.
    turned: Vec<bool>,
    /// The rotations where the first step begins and the last ends.
    ends: [Quat; 2],
    recent: Recent<Quat>,
}

impl Signs {
    pub(super) fn continued(
        steps: &Steps,
        segments: Range<usize>,
        rotation: impl Fn(&Spot) -> Quat + Sync,
    ) -> Signs {
        let own = |i: usize| Chain::new(steps.spots(i).map(|spot| rotation(&spot)));
        let chains: Vec<Chain> = segments.clone().into_par_iter().map(own).collect();
        let (mut first, mut turned) = (Vec::with_capacity(chains.len()), Vec::new());
        let mut end = chains[0].start;
        for chain in &chains {
            let turns = chain.start.aligned_to(end) != chain.start;
            first.push(turned.len());
            turned.extend(chain.turned.iter().map(|own| own ^ turns));
            end = if turns { -chain.end } else { chain.end };
        }
        let ends = [chains[0].start, end];
        Signs { recent: Recent::new(turned.len()), segments, first, turned, ends }
    }

    /// The same with the sign of a rotation where they begin.
    pub(super) fn starting_as(self, q: Quat) -> Signs {
        if self.ends[0].dot(q) < 0.0 { self.opposite() } else { self }
    }

    /// The same with the sign of a rotation where they end.
    pub(super) fn ending_as(self, q: Quat) -> Signs {
        if self.ends[1].dot(q) < 0.0 { self.opposite() } else { self }
    }

    fn opposite(mut self) -> Signs {
        self.turned.iter_mut().for_each(|turned| *turned = !*turned);
        self.ends = self.ends.map(|end| -end);
        self
    }

    /// The rotation at a spot in one of the segments, with the sign of that where its step begins.
    pub(super) fn follow(&self, steps: &Steps, spot: &Spot, rotation: impl Fn(&Spot) -> Quat) -> Quat {
        let i = self.first[spot.segment - self.segments.start] + spot.step;
        let signed = |q: Quat| if self.turned[i] { -q } else { q };
        let start = steps.step_start(spot);
        if start.place == spot.place {
            return signed(rotation(spot));
        }
        let start = self.recent.get(i, || signed(rotation(&start)));
        rotation(spot).aligned_to(*start)
    }
}

/// Rotations in a row, of which some are to be turned about to follow on from each other.
struct Chain {
    start: Quat,
    turned: Vec<bool>,
    end: Quat,
}

impl Chain {
    fn new(mut rotations: impl Iterator<Item = Quat>) -> Chain {
        let start = rotations.next().unwrap_or(Quat::IDENTITY);
        let mut chain = Chain { start, turned: vec![false], end: start };
        for rotation in rotations {
            let here = rotation.aligned_to(chain.end);
            chain.turned.push(here != rotation);
            chain.end = here;
        }
        chain
    }
}

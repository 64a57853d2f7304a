//! The velocities at keys for which no acceleration jumps.
//!
//! With w the velocities, Θ the steps' logarithms, and A, D what [`Tangent`] calls
//! velocity and bend, the acceleration after key i is (6Θ − 4h w − 2h A⁻¹w₊)/h² with its
//! own step, and before it (−6Θ + 2h A w₋ + 4h w)/h² + D(A⁻¹w) with the one before. Their
//! difference vanishes at every inner key. Newton's method; each step solves a system of
//! three diagonals of 3 × 3 blocks. Derived in docs/math/natural-c2.md.

use super::Tangent;
use crate::curve::Ends;
use crate::curve::span::End;
use crate::curve::track::Track;
use crate::math::Vec3;
use glam::{DMat3, DVec3};
use std::ops::Range;

/// So many keys of a long track are solved for together, and with them so many on either side,
/// whose velocities are dropped: what is wrong where a window ends falls by half or more from
/// key to key, unless steps are near half a turn.
const WINDOW: usize = 4096;
const MARGIN: usize = 64;
/// Newton's method takes about five steps.
const MOST_STEPS: usize = 50;
/// How often a step is halved that leads further away.
const HALVINGS: usize = 12;
/// A change of a velocity that turns by this much in its shorter interval is the last.
const LAST: f64 = 1e-10;

/// Half the angular velocities at all keys, in the key's own frame, per second.
pub(super) fn velocities(track: &Track) -> Box<[Vec3]> {
    solve(track).0
}

/// Whether a motion without jumps in acceleration was found. Where steps are near half a
/// turn and intervals uneven there may be none.
pub(in crate::curve) fn is_solved(track: &Track) -> bool {
    solve(track).1
}

fn solve(track: &Track) -> (Box<[Vec3]>, bool) {
    if let Some(velocities) = by_windows(track) {
        return (velocities, true);
    }
    let keys = 0..track.times.len();
    let (mut velocities, solved) = System::of(track, keys).solve();
    // Closed ends: the last key is the first.
    velocities.extend((track.ends == Ends::Closed).then(|| velocities[0]));
    (vectors(velocities), solved)
}

/// The velocities of a long track that is open, in the memory of a window; none where windows
/// do not fit together.
fn by_windows(track: &Track) -> Option<Box<[Vec3]>> {
    let count = track.times.len();
    if count <= 2 * WINDOW || track.ends == Ends::Closed {
        return None;
    }
    let mut velocities: Vec<DVec3> = Vec::with_capacity(count);
    for start in (0..count).step_by(WINDOW) {
        let end = (start + WINDOW).min(count);
        let keys = start.saturating_sub(MARGIN)..(end + MARGIN).min(count);
        let first = start - keys.start;
        let (window, solved) = System::of(track, keys).solve();
        velocities.extend(&window[first..first + end - start]);
        let fits = start == 0 || {
            // The two keys at the seam, between two others.
            let seam = start - 2..(start + 2).min(end);
            let system = System::of(track, seam.clone());
            let jump = |i: usize| system.worth(&system.row(&velocities[seam.clone()], i), i);
            (1..seam.len() - 1).all(|i| jump(i) < LAST)
        };
        if !solved || !fits {
            return None;
        }
    }
    Some(vectors(velocities))
}

fn vectors(velocities: Vec<DVec3>) -> Box<[Vec3]> {
    velocities.into_iter().map(|w| Vec3::new(w.x, w.y, w.z)).collect()
}

/// One step from key to key.
struct Step {
    h: f64,
    tangent: Tangent,
}

impl Step {
    fn theta(&self) -> DVec3 {
        dvec(self.tangent.vector)
    }

    /// A.
    fn forward(&self) -> DMat3 {
        matrix(|y| self.tangent.velocity(y))
    }

    /// A⁻¹.
    fn back(&self) -> DMat3 {
        matrix(|w| self.tangent.vector_rate(w))
    }

    /// D(A⁻¹w), and its derivative by w.
    fn bend(&self, w: DVec3) -> (DVec3, DMat3) {
        let y = self.tangent.vector_rate(Vec3::new(w.x, w.y, w.z));
        let derivative = |w: Vec3| {
            let z = self.tangent.vector_rate(w);
            self.tangent.bend(y, z) + self.tangent.bend(z, y)
        };
        (dvec(self.tangent.bend(y, y)), matrix(derivative))
    }
}

/// One line of the linear system: what the jump at a key depends on, and the jump.
#[derive(Clone, Copy)]
struct Row {
    before: DMat3,
    here: DMat3,
    after: DMat3,
    jump: DVec3,
}

impl Row {
    const ZERO: Row = Row { before: DMat3::ZERO, here: DMat3::ZERO, after: DMat3::ZERO, jump: DVec3::ZERO };
}

/// Where Newton's method stands.
struct State {
    velocities: Vec<DVec3>,
    rows: Vec<Row>,
    /// The sum of the squares of all jumps, each as the turn it is worth.
    error: f64,
}

/// Keys that follow each other.
struct System {
    steps: Vec<Step>,
    closed: bool,
    /// The shares of the end steps' velocities at the first key and the last; without one no
    /// acceleration.
    shares: [Option<f64>; 2],
}

impl System {
    fn of(track: &Track, keys: Range<usize>) -> System {
        let step = |i: usize| Step {
            h: track.interval(i),
            tangent: Tangent::at((track.key(i).conjugate() * track.key(i + 1)).log()),
        };
        let share = match track.end_rule() {
            End::Natural => None,
            End::Repeat => Some(0.5),
            End::Chord(share) => Some(share),
        };
        let is_end = [keys.start == 0, keys.end == track.times.len()];
        let steps = (keys.start..keys.end - 1).map(step).collect();
        System { steps, closed: track.ends == Ends::Closed, shares: is_end.map(|end| share.filter(|_| end)) }
    }

    /// By Newton's method; and whether that came to an end.
    fn solve(&self) -> (Vec<DVec3>, bool) {
        let mut at = self.state(vec![DVec3::ZERO; self.unknowns()]);
        let mut solved = false;
        for _ in 0..MOST_STEPS {
            let change = self.change(&at.rows);
            solved = self.turns(&change) < LAST;
            let Some(closer) = self.closer(&at, &change) else { break };
            at = closer;
            if solved {
                break;
            }
        }
        (at.velocities, solved)
    }

    fn state(&self, velocities: Vec<DVec3>) -> State {
        let rows: Vec<Row> = (0..velocities.len()).map(|i| self.row(&velocities, i)).collect();
        let error = rows.iter().enumerate().map(|(i, row)| self.worth(row, i).powi(2)).sum();
        State { velocities, rows, error }
    }

    fn unknowns(&self) -> usize {
        self.steps.len() + usize::from(!self.closed)
    }

    /// The steps before and after key i.
    fn around(&self, i: usize) -> (Option<&Step>, Option<&Step>) {
        let before =
            if i == 0 && self.closed { self.steps.last() } else { self.steps.get(i.wrapping_sub(1)) };
        (before, self.steps.get(i))
    }

    /// The jump in acceleration at key i, and its derivatives.
    fn row(&self, velocities: &[DVec3], i: usize) -> Row {
        let count = velocities.len();
        let (before, after) = self.around(i);
        let end = match (before, after) {
            (None, Some(step)) => self.shares[0].map(|share| (share, step)),
            (Some(step), None) => self.shares[1].map(|share| (share, step)),
            _ => None,
        };
        if let Some((share, step)) = end {
            // The velocity is given.
            let scale = 4.0 / step.h;
            let jump = (velocities[i] - step.theta() * (share / step.h)) * scale;
            return Row { here: DMat3::from_diagonal(DVec3::splat(scale)), jump, ..Row::ZERO };
        }
        let mut row = Row::ZERO;
        if let Some(step) = before {
            let (bend, derivative) = step.bend(velocities[i]);
            row.before = step.forward() * (2.0 / step.h);
            row.here += DMat3::IDENTITY * (4.0 / step.h) + derivative;
            let other = velocities[(i + count - 1) % count];
            row.jump += row.before * other + velocities[i] * (4.0 / step.h) + bend
                - step.theta() * (6.0 / step.h.powi(2));
        }
        if let Some(step) = after {
            row.after = step.back() * (2.0 / step.h);
            row.here += DMat3::IDENTITY * (4.0 / step.h);
            let other = velocities[(i + 1) % count];
            row.jump +=
                row.after * other + velocities[i] * (4.0 / step.h) - step.theta() * (6.0 / step.h.powi(2));
        }
        row
    }

    /// The shorter interval at key i.
    fn shorter(&self, i: usize) -> f64 {
        let (before, after) = self.around(i);
        before.into_iter().chain(after).map(|step| step.h).fold(f64::INFINITY, f64::min)
    }

    /// The jump at key i, as the turn it is worth.
    fn worth(&self, row: &Row, i: usize) -> f64 {
        let (before, after) = self.around(i);
        let stiffness: f64 = before.into_iter().chain(after).map(|step| 4.0 / step.h).sum();
        row.jump.length() * self.shorter(i) / stiffness
    }

    /// The largest turn, within the shorter interval, that changes of velocities make.
    fn turns(&self, change: &[DVec3]) -> f64 {
        change.iter().enumerate().map(|(i, change)| change.length() * self.shorter(i)).fold(0.0, f64::max)
    }

    /// Nearer the solution, on the way of `change`.
    fn closer(&self, at: &State, change: &[DVec3]) -> Option<State> {
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let moved = at.velocities.iter().zip(change).map(|(w, c)| w + c * share).collect();
            let moved = self.state(moved);
            if moved.error < at.error {
                return Some(moved);
            }
            share *= 0.5;
        }
        None
    }

    /// Newton's step.
    fn change(&self, rows: &[Row]) -> Vec<DVec3> {
        if !self.closed {
            return eliminate(rows).into_iter().map(|(x, _)| x).collect();
        }
        // The first key's change is set aside: all others follow from it, linearly.
        let first = rows[0];
        // It stands before the second row, and after the last.
        let others = eliminate(&rows[1..]);
        let (next, last) = (others[0], others[others.len() - 1]);
        let matrix = first.here + first.after * next.1 + first.before * last.1;
        let x = matrix.inverse() * (-first.jump - first.after * next.0 - first.before * last.0);
        std::iter::once(x).chain(others.into_iter().map(|(constant, by)| constant + by * x)).collect()
    }
}

/// Solves rows for which the sum of all terms is zero, as constants and multiples of what
/// stands before the first row and after the last: the same unknown. Elimination from the
/// first row to the last, then back.
fn eliminate(rows: &[Row]) -> Vec<(DVec3, DMat3)> {
    let mut reduced: Vec<(DMat3, DVec3, DMat3)> = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let outer = if i == 0 { row.before } else { DMat3::ZERO };
        let outer = if i + 1 == rows.len() { outer + row.after } else { outer };
        let (mut pivot, mut constant, mut by) = (row.here, -row.jump, outer * -1.0);
        if let Some((after, x, y)) = reduced.last() {
            pivot -= row.before * *after;
            constant -= row.before * *x;
            by -= row.before * *y;
        }
        let inverse = pivot.inverse();
        reduced.push((inverse * row.after, inverse * constant, inverse * by));
    }
    let mut solved = vec![(DVec3::ZERO, DMat3::ZERO); rows.len()];
    let mut next = (DVec3::ZERO, DMat3::ZERO);
    for (slot, (after, x, y)) in solved.iter_mut().zip(reduced).rev() {
        next = (x - after * next.0, y - after * next.1);
        *slot = next;
    }
    solved
}

fn dvec(v: Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// The matrix of a linear function.
fn matrix(of: impl Fn(Vec3) -> Vec3) -> DMat3 {
    let column = |x, y, z| dvec(of(Vec3::new(x, y, z)));
    DMat3::from_cols(column(1.0, 0.0, 0.0), column(0.0, 1.0, 0.0), column(0.0, 0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Arc, Motion, Scheme};
    use crate::math::{Jet, Quat};
    use proptest::prelude::*;

    /// The largest jump in acceleration at inner keys, as a share of the largest speed
    /// there, squared: a number without units.
    fn worst_jump(times: &[f64], keys: &[Quat], ends: Ends) -> f64 {
        let motion = Motion::new(times, keys, Scheme::NaturalC2, ends);
        let rates = |i: usize, u: f64| {
            let piece = motion.piece(i, times[i]);
            let (jet, h) = (piece.at(Jet::variable(u)), piece.duration());
            (jet.half_velocity() * (1.0 / h), jet.half_acceleration() * (1.0 / (h * h)))
        };
        let jump = |i: usize| {
            let ((v, before), (_, after)) = (rates(i - 1, 1.0), rates(i, 0.0));
            let shorter = (times[i] - times[i - 1]).min(times[i + 1] - times[i]);
            (before - after).length() * shorter / (v.length() + 1.0 / shorter)
        };
        (1..times.len() - 1).map(jump).fold(0.0, f64::max)
    }

    type Key = ([f64; 3], f64, f64);

    /// Keys: an axis, half a turn about it, and the logarithm of an interval.
    fn keys(half_turn: f64, spread: f64) -> impl Strategy<Value = Vec<Key>> {
        proptest::collection::vec(
            ([-1.0..1.0f64, -1.0..1.0, -1.0..1.0], 0.0..half_turn, -spread..spread),
            2..40,
        )
    }

    fn track(steps: &[Key]) -> (Vec<f64>, Vec<Quat>) {
        let (mut times, mut keys) = (vec![0.0], vec![Quat::IDENTITY]);
        for &([x, y, z], half_turn, spread) in steps {
            let axis = Vec3::new(x, y, z) * (1.0 / Vec3::new(x, y, z).length().max(1e-3));
            keys.push(keys[keys.len() - 1] * Quat::exp(axis * half_turn));
            times.push(times[times.len() - 1] + f64::exp(spread));
        }
        (times, keys)
    }

    // Held ends jump on purpose.
    const OPEN: [Ends; 4] = [Ends::Natural, Ends::Clamped, Ends::Repeat, Ends::Chord];

    #[test]
    fn windows_give_what_the_whole_gives() {
        let wave = |i: usize, k: f64| (k * i as f64 + 1.0).sin();
        let steps: Vec<Key> = (0..2 * WINDOW + 1000)
            .map(|i| ([wave(i, 1.3), wave(i, 2.3), wave(i, 4.1)], 0.4 + 0.4 * wave(i, 5.7), wave(i, 2.9)))
            .collect();
        let (times, keys) = track(&steps);
        for ends in OPEN {
            let track = Track { times: &times, keys: &keys, last: keys[keys.len() - 1], ends, margin: 0 };
            let by_windows = by_windows(&track).unwrap();
            let (whole, solved) = System::of(&track, 0..times.len()).solve();
            assert!(solved && whole.len() == by_windows.len());
            for (i, (a, b)) in whole.iter().zip(&by_windows).enumerate() {
                let around = times[(i + 1).min(times.len() - 1)] - times[i.saturating_sub(1)];
                // Both end within the last of Newton's steps.
                let off = (*a - dvec(*b)).length() * around;
                assert!(off < 4.0 * LAST, "{} {i}: {off:e}", ends.name());
            }
        }
    }

    proptest! {
        #[test]
        fn acceleration_is_continuous(steps in keys(0.87, 1.5), ends in prop::sample::select(OPEN.to_vec())) {
            // Steps of up to 100°, intervals of up to twenty times another.
            let (times, keys) = track(&steps);
            let worst = worst_jump(&times, &keys, ends);
            // The last Newton step leaves 1e-20; evaluation rounds terms of 6/h² times 3 rad.
            prop_assert!(worst < 1e-10, "{worst}");
        }

        #[test]
        fn what_is_not_solved_is_said(steps in keys(1.57, 3.0), ends in prop::sample::select(OPEN.to_vec())) {
            let (times, keys) = track(&steps);
            let last = keys[keys.len() - 1];
            let solved = is_solved(&Track { times: &times, keys: &keys, last, ends, margin: 0 });
            let worst = worst_jump(&times, &keys, ends);
            prop_assert!(worst < if solved { 1e-9 } else { 10.0 }, "{solved} {worst}");
        }
    }
}

//! Fewer keys for what is keys itself, many and close together: one pass over them.
//!
//! The search of [`super::rotation`] looks at a curve through its values and is made for
//! few keys. Here LINEAR playback of the written keys is compared with LINEAR playback of
//! the keys there were, and the time is in proportion to these. How an interval's reach
//! is found and proven: docs/math/fewest-keys.md.

mod ball;
mod near;
mod stretch;
mod walk;

#[cfg(test)]
mod tests;

pub(crate) use near::Near;
use rayon::prelude::*;
use stretch::{Limits, Stretch};
use walk::Walk;

/// Where an interval may end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// At any time, and off the curve by the tolerance at most.
    Free,
    /// At any time, on the curve.
    OnCurve,
    /// At the keys there were, with their stored numbers.
    Own,
}

/// What is asked; in the units of [`super::value::Value::distance`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) tolerance: f64,
    /// How far neighbouring keys may be apart.
    pub(crate) step: f64,
    pub(crate) ends: Ends,
}

/// Keys that play as those there were, within the tolerance.
#[derive(Clone, Debug)]
pub(crate) struct Fewer<const N: usize> {
    pub(crate) times: Vec<f32>,
    pub(crate) values: Vec<[f32; N]>,
    /// No distance between both is larger; in the units of [`super::value::Value::distance`].
    pub(crate) deviation: f64,
}

/// Intervals that are searched at once. The key at either end of such a stretch stays, so
/// that the result does not depend on how many threads there are.
const STRETCH: usize = 1 << 14;

/// Fewer keys for keys that are played LINEAR; none where no bound can be given. Times
/// must increase, and there be two at least.
pub(crate) fn fewer<V: Near<Stored = [f32; N]>, const N: usize>(
    times: &[f32],
    stored: &[[f32; N]],
    asked: Asked,
) -> Option<Fewer<N>> {
    let last = times.len().min(stored.len()).checked_sub(1).filter(|&last| last > 0)?;
    let stretches: Vec<usize> = (0..last).step_by(STRETCH).collect();
    let walk = |&from: &usize| {
        let keys = from..=last.min(from + STRETCH);
        let stretch = Stretch::<V>::new(&times[keys.clone()], &stored[keys], asked);
        let limits = Limits::new(&stretch, asked)?;
        Walk::new(&stretch, limits).all()
    };
    let walked: Vec<Option<Fewer<N>>> = stretches.par_iter().map(walk).collect();
    joined::<V, N>(walked)
}

/// Stretches one after the other; each begins where the last one ended.
fn joined<V: Near<Stored = [f32; N]>, const N: usize>(stretches: Vec<Option<Fewer<N>>>) -> Option<Fewer<N>> {
    let count = stretches.iter().flatten().map(|stretch| stretch.times.len()).sum();
    let (times, values) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut all = Fewer { times, values, deviation: 0.0 };
    for stretch in stretches {
        let stretch = stretch?;
        let skipped = usize::from(!all.times.is_empty());
        // Each begins with its first key's own sign.
        let turned = all.values.last().is_some_and(|&before| before != stretch.values[0]);
        all.times.extend_from_slice(&stretch.times[skipped..]);
        let values = &stretch.values[skipped..];
        match turned {
            true => all.values.extend(values.iter().map(|value| value.map(|x| -x))),
            false => all.values.extend_from_slice(values),
        }
        all.deviation = all.deviation.max(stretch.deviation);
    }
    Some(all)
}

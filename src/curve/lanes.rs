//! A motion at many times at once, by vector code that is chosen when the program runs.
//!
//! Where samples share a segment, its curve is worked out once and followed in a loop over
//! [`Lane`]s. Where nearly each has a segment of its own, the segments themselves are worked
//! out in such loops, [`WIDTH`] at a time. Loops over lanes hold no branch and no call, so
//! that the compiler makes vector code of them, once for every set of vector units that
//! `fearless_simd` tells apart. All of them give the same digits.
//!
//! Segments at ends, and those whose angles could be beyond what lanes are good for, go the
//! plain way.

use super::motion::Motion;
use super::rule::{Broad, Formula, Paced};
use super::span::{End, Neighbour, Span};
use super::{Arc, Rates, Tcb};
use crate::math::{Lane, Number, Quat, Vec3, widest};
use fearless_simd::{Simd, dispatch};

/// How many segments are worked out side by side.
const WIDTH: usize = 32;

/// From so many samples on, a segment's curve is worked out on its own.
const DENSE: usize = 10;

/// Intervals of which neither is more often the other give angles far below
/// [`Lane::LARGEST_ANGLE`], whatever the scheme: powers of steps of half a turn.
const UNEVEN: f64 = 1e3;

/// The motion at increasing times, in order.
pub(super) fn at_all<T: Copy + Into<f64>>(motion: &Motion, times: &[T]) -> Vec<Quat> {
    let mut out = vec![Quat::IDENTITY; times.len()];
    let inner = motion.inner();
    let dense = inner.as_ref().map_or(0, |inner| if inner.has_ends { DENSE } else { usize::MAX });
    let mut sparse = Columns::new(motion.tcb());
    let (mut i, mut segment) = (0, 0);
    while i < times.len() {
        segment = motion.segment_at(times[i].into(), segment);
        let window = inner.as_ref().and_then(|inner| inner.window(segment)).filter(Window::is_tame);
        let run = match &window {
            Some(window) => times[i..].iter().take_while(|&&t| t.into() < window.end()).count(),
            None => 0,
        };
        if let Some(window) = window.as_ref().filter(|_| 0 < run && run < dense) {
            for (k, &t) in times[i..i + run].iter().enumerate() {
                sparse.push(window, t.into(), i + k);
                if sparse.places.len() == WIDTH {
                    sparse.flush(window.kernels, &mut out);
                }
            }
            i += run;
        } else {
            i += piece(motion, segment, &times[i..], &mut out[i..], window.is_some());
        }
    }
    if let Some(inner) = inner {
        sparse.flush(inner.kernels, &mut out);
    }
    out
}

/// Fills what lies in the piece that holds the first of the times; how many these are.
fn piece<T: Copy + Into<f64>>(
    motion: &Motion,
    segment: usize,
    times: &[T],
    out: &mut [Quat],
    tame: bool,
) -> usize {
    let t = times[0].into();
    let piece = if t < motion.times()[segment + 1] { motion.piece(segment, t) } else { motion.piece_at(t) };
    let run = times.iter().take_while(|&&t| t.into() < piece.end).count().max(1);
    let parameters = times[..run].iter().map(|&t| piece.parameter(t.into()));
    if tame {
        let us: Vec<f64> = parameters.collect();
        piece.fill(&us, &mut out[..run]);
    } else {
        out.iter_mut().zip(parameters).for_each(|(q, u)| *q = piece.at(u));
    }
    run
}

/// Rates, by seconds, of segments that follow each other; none of those at ends, none of
/// those that are not tame.
pub(super) fn rates(inner: &Inner, segments: std::ops::Range<usize>, tcb: Tcb) -> Vec<Option<Rates>> {
    let mut out = vec![None; segments.len()];
    let mut columns = Columns::new(tcb);
    for (place, segment) in segments.enumerate() {
        if let Some(window) = inner.window(segment).filter(Window::is_tame) {
            columns.push(&window, window.times[1], place);
        }
        if columns.places.len() == WIDTH {
            columns.flush_rates(inner.kernels, &mut out);
        }
    }
    columns.flush_rates(inner.kernels, &mut out);
    out
}

/// What works out the segments of one scheme side by side.
#[derive(Clone, Copy)]
pub(super) struct Kernels {
    /// One sample of each.
    points: fn(&Columns) -> Rows,
    /// Rates of each by seconds: speeds, then accelerations.
    paces: fn(&Columns) -> [[f64; WIDTH]; 2],
    is_tame: fn(&Span) -> bool,
}

impl Kernels {
    pub(super) fn of<B: Broad>() -> Kernels {
        Kernels { points: Columns::points::<B>, paces: Columns::paces::<B>, is_tame: B::is_tame }
    }
}

/// The segments of a motion that can be worked out side by side.
pub(super) struct Inner<'a> {
    pub(super) kernels: Kernels,
    /// Whether more than a segment's own two keys shape it.
    pub(super) has_ends: bool,
    pub(super) times: &'a [f64],
    pub(super) keys: &'a [Quat],
    /// Those that no end shapes, with a neighbour on either side.
    pub(super) segments: std::ops::Range<usize>,
}

impl<'a> Inner<'a> {
    #[inline]
    fn window(&self, segment: usize) -> Option<Window<'a>> {
        let from = segment.wrapping_sub(1);
        let four = |i: usize| i..i + 4;
        if !self.segments.contains(&segment) {
            return None;
        }
        let (times, keys) = (&self.times[four(from)], &self.keys[four(from)]);
        Some(Window { kernels: self.kernels, times: times.try_into().ok()?, keys: keys.try_into().ok()? })
    }
}

/// A segment's two keys and their neighbours.
struct Window<'a> {
    kernels: Kernels,
    times: &'a [f64; 4],
    keys: &'a [Quat; 4],
}

impl Window<'_> {
    fn end(&self) -> f64 {
        self.times[2]
    }

    fn intervals(&self) -> [f64; 3] {
        let &[a, b, c, d] = self.times;
        [b - a, c - b, d - c]
    }

    fn span(&self) -> Span {
        inner_span(*self.keys, self.intervals(), Tcb::default())
    }

    /// Whether no interval is many times another, and the scheme has nothing against it.
    fn is_tame(&self) -> bool {
        let intervals = self.intervals();
        let [a, b, c] = intervals;
        a.max(b).max(c) <= UNEVEN * a.min(b).min(c) && (self.kernels.is_tame)(&self.span())
    }
}

/// The span of a segment with a neighbour on either side, neither at an end.
#[inline(always)]
fn inner_span<N: Number>(keys: [Quat<N>; 4], [before, own, after]: [N; 3], tcb: Tcb) -> Span<N> {
    Span {
        before: Some(Neighbour { key: keys[0], h: before, is_end: false }),
        start: keys[1],
        end: keys[2],
        h: own,
        after: Some(Neighbour { key: keys[3], h: after, is_end: false }),
        end_rule: End::Natural,
        intervals: [before, before, own, after, after],
        velocities: [Vec3::new(N::from(0.0), N::from(0.0), N::from(0.0)); 2],
        tcb,
    }
}

/// A curve at many parameters.
pub(super) fn fill(arc: &impl Arc, us: &[f64], out: &mut [Quat]) {
    dispatch!(widest(), simd => follow(simd, arc, us, out));
}

#[inline(always)]
fn follow<S: Simd>(_: S, arc: &impl Arc, us: &[f64], out: &mut [Quat]) {
    for (q, &u) in out.iter_mut().zip(us) {
        *q = number(arc.at(Lane(u)));
    }
}

#[inline(always)]
fn number(q: Quat<Lane>) -> Quat {
    Quat { w: q.w.0, v: Vec3::new(q.v.x.0, q.v.y.0, q.v.z.0) }
}

/// Spans of inner segments, one sample each, number by number: the form that vector code
/// likes.
struct Columns {
    /// The key before, both keys and the key after, by w x y z.
    keys: [[[f64; WIDTH]; 4]; 4],
    /// From key to key.
    intervals: [[f64; WIDTH]; 3],
    us: [f64; WIDTH],
    tcb: Tcb,
    /// Where each sample belongs.
    places: Vec<usize>,
}

/// Quaternions, number by number.
type Rows = [[f64; WIDTH]; 4];

impl Columns {
    fn new(tcb: Tcb) -> Columns {
        // What is not filled yet is a rest, on which every formula is well.
        let mut keys = [[[0.0; WIDTH]; 4]; 4];
        keys.iter_mut().for_each(|key| key[0] = [1.0; WIDTH]);
        Columns {
            keys,
            intervals: [[1.0; WIDTH]; 3],
            us: [0.0; WIDTH],
            tcb,
            places: Vec::with_capacity(WIDTH),
        }
    }

    #[inline]
    fn push(&mut self, window: &Window, t: f64, place: usize) {
        let lane = self.places.len();
        for (columns, key) in self.keys.iter_mut().zip(window.keys) {
            columns.iter_mut().zip(key.to_wxyz()).for_each(|(column, part)| column[lane] = part);
        }
        let intervals = window.intervals();
        self.intervals.iter_mut().zip(intervals).for_each(|(column, h)| column[lane] = h);
        self.us[lane] = (t - window.times[1]) / intervals[1];
        self.places.push(place);
    }

    /// Works out all that were pushed.
    fn flush(&mut self, kernels: Kernels, out: &mut [Quat]) {
        let rows = (kernels.points)(self);
        for (lane, &place) in self.places.iter().enumerate() {
            out[place] = Quat::from_wxyz(std::array::from_fn(|part| rows[part][lane]));
        }
        self.places.clear();
    }

    /// Works out the rates of all segments that were pushed.
    fn flush_rates(&mut self, kernels: Kernels, out: &mut [Option<Rates>]) {
        let [speeds, accelerations] = (kernels.paces)(self);
        for (lane, &place) in self.places.iter().enumerate() {
            out[place] = Some(Rates { speed: speeds[lane], acceleration: accelerations[lane] });
        }
        self.places.clear();
    }

    fn paces<B: Broad>(&self) -> [[f64; WIDTH]; 2] {
        let mut rows = [[0.0; WIDTH]; 2];
        dispatch!(widest(), simd => self.measure::<_, B>(simd, &mut rows));
        rows
    }

    #[inline(always)]
    fn measure<S: Simd, B: Broad>(&self, _: S, [speeds, accelerations]: &mut [[f64; WIDTH]; 2]) {
        for lane in 0..WIDTH {
            let h = self.intervals[1][lane];
            let pace = B::curve(&self.span(lane)).pace();
            (speeds[lane], accelerations[lane]) = (pace.speed.0 / h, pace.acceleration.0 / (h * h));
        }
    }

    fn points<B: Broad>(&self) -> Rows {
        let mut rows = [[0.0; WIDTH]; 4];
        dispatch!(widest(), simd => self.work_out::<_, B>(simd, &mut rows));
        rows
    }

    #[expect(clippy::needless_range_loop, reason = "one index into many columns, as vector code wants it")]
    #[inline(always)]
    fn work_out<S: Simd, B: Broad>(&self, _: S, rows: &mut Rows) {
        for lane in 0..WIDTH {
            let q = B::curve(&self.span(lane)).point(Lane(self.us[lane]));
            (rows[0][lane], rows[1][lane], rows[2][lane], rows[3][lane]) = (q.w.0, q.v.x.0, q.v.y.0, q.v.z.0);
        }
    }

    #[inline(always)]
    fn span(&self, lane: usize) -> Span<Lane> {
        let part = |key: usize, part: usize| Lane(self.keys[key][part][lane]);
        let key = |k| Quat { w: part(k, 0), v: Vec3::new(part(k, 1), part(k, 2), part(k, 3)) };
        let [before, own, after] = [0, 1, 2].map(|k| Lane(self.intervals[k][lane]));
        inner_span([key(0), key(1), key(2), key(3)], [before, own, after], self.tcb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Ends, Scheme};
    use crate::math::Jet;
    use proptest::prelude::*;

    /// Keys with steps of up to 170°, at intervals that are powers of ten apart.
    fn track() -> impl Strategy<Value = (Vec<f64>, Vec<Quat>)> {
        let step = (prop::array::uniform3(-0.85..0.85f64), prop_oneof![0.01..1.0f64, Just(1e-5), Just(20.0)]);
        prop::collection::vec(step, 2..40).prop_map(|steps| {
            let (mut t, mut q) = (0.0, Quat::exp(Vec3::new(0.3, -0.2, 0.5)));
            let (mut times, mut keys) = (vec![t], vec![q]);
            for ([x, y, z], h) in steps {
                t += h;
                q = (q * Quat::exp(Vec3::new(x, y, z))).aligned_to(q);
                times.push(t);
                keys.push(q);
            }
            (times, keys)
        })
    }

    proptest! {
        #[test]
        fn lanes_run_where_the_plain_formulas_do((times, keys) in track(), samples in 2..400usize) {
            for &scheme in Scheme::EVERY {
                for ends in [Ends::Natural, Ends::Clamped, Ends::Repeat, Ends::Hold] {
                    let motion = Motion::new(&times, &keys, scheme, ends);
                    let last = times[times.len() - 1];
                    let at: Vec<f32> = (0..=samples).map(|i| (last * i as f64 / samples as f64) as f32).collect();
                    for (&t, q) in at.iter().zip(motion.at_all(&at)) {
                        let plain = motion.at(f64::from(t));
                        // Up to ten logarithms and exponentials of a few units of 1e-16
                        // each; uneven times multiply angles, and what they are off.
                        prop_assert!(q.angle_to(plain) < 1e-11, "{} {} {t}: {q:?} {plain:?}", scheme.name(), ends.name());
                        prop_assert!(q.dot(plain) > 0.0);
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn rates_bound_the_derivatives((times, keys) in track()) {
            for &scheme in Scheme::ALL {
                let motion = Motion::new(&times, &keys, scheme, Ends::Natural);
                let side_by_side = motion.rates_of(0..times.len() - 1);
                for (i, broad) in side_by_side.into_iter().enumerate() {
                    let piece = motion.piece(i, times[i]);
                    let broad = broad.map(|rates| rates.per_second(1.0 / piece.duration()));
                    for k in 0..=20 {
                        let jet = piece.at(Jet::variable(0.05 * f64::from(k)));
                        let (v, a) = (jet.half_velocity().length(), jet.half_acceleration().length());
                        for rates in broad.into_iter().chain([piece.rates()]) {
                            let name = format!("{} segment {i} at {k}: {v} {a} {rates:?}", scheme.name());
                            // Accelerations are what is left of squares of speeds.
                            let rounding = 1e-12 * (1.0 + rates.speed * rates.speed);
                            prop_assert!(v <= rates.speed + rounding, "{name}");
                            prop_assert!(a <= rates.acceleration * (1.0 + 1e-9) + rounding, "{name}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn no_times_no_rotations() {
        let keys = [Quat::IDENTITY; 2];
        assert!(Motion::new(&[0.0, 1.0], &keys, Scheme::Slerp, Ends::Natural).at_all::<f32>(&[]).is_empty());
    }
}

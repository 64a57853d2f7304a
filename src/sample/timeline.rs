//! The times of the samples: an even grid, and the times that must not be missed.

use super::Fps;

/// Sample times, seconds, as float32: the numbers that are written.
///
/// The grid of the frame rate from 0, the exact last time, and (unless left out) every
/// key time and the start of a jump's ramp. A grid time that lies closer to one of these
/// than the smaller of 1 ms and half a frame is left out.
#[derive(Clone, Debug)]
pub struct Timeline<'a> {
    knots: Knots<'a>,
    fps: Fps,
    /// Where each chunk begins.
    chunks: Vec<Cursor>,
    len: usize,
}

/// Times that cannot be told apart in float32.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TooFine {
    /// Two neighbouring frames become the same float32 time.
    #[error(
        "float32, glTF's number for times, cannot tell frames {} s apart from each other at {time} s; \
         the largest --fps that works for this clip is {largest_fps}", .interval
    )]
    Frames {
        /// From where on frames fall together, seconds.
        time: f64,
        /// Time from frame to frame, seconds.
        interval: f64,
        /// The largest rate at which they do not.
        largest_fps: Fps,
    },
    /// Two keys become the same float32 time: this one and the next.
    #[error("keys {key} and {} are so close that float32, glTF's number for times, cannot tell them apart", .key + 1)]
    Keys {
        /// The index of the first of them.
        key: usize,
    },
    /// The clip is longer than float32 can say.
    #[error(
        "the clip is longer than 1e18 s, where float32, glTF's number for times, ends to tell frames apart"
    )]
    TooLong,
}

/// The times that must be met, in order.
#[derive(Clone, Copy, Debug)]
struct Knots<'a> {
    keys: &'a [f64],
    ramp: Option<f64>,
    /// Only the first and the last of them.
    ends_only: bool,
}

impl Knots<'_> {
    fn get(&self, i: usize) -> Option<f64> {
        if self.ends_only {
            return [0.0, self.keys[self.keys.len() - 1]].get(i).copied();
        }
        match self.ramp {
            Some(ramp) if i == 1 => Some(ramp),
            Some(_) if i > 1 => self.keys.get(i - 1).copied(),
            _ => self.keys.get(i).copied(),
        }
    }
}

/// A place between two samples: what comes next, and the sample before.
#[derive(Clone, Copy, Debug)]
struct Cursor {
    frame: u64,
    knot: usize,
    before: Option<f32>,
}

/// How many samples a chunk has.
const CHUNK: usize = 4096;

impl<'a> Timeline<'a> {
    /// The sample times for keys at `keys` (from 0, increasing), where a motion has a
    /// ramp from `ramp` to the second key if at all.
    pub fn new(
        keys: &'a [f64],
        ramp: Option<f64>,
        fps: Fps,
        key_times: bool,
    ) -> Result<Timeline<'a>, TooFine> {
        let knots = Knots { keys, ramp, ends_only: !key_times };
        check(keys, fps, key_times)?;
        let mut timeline = Timeline { knots, fps, chunks: Vec::new(), len: 0 };
        let mut cursor = Cursor { frame: 0, knot: 0, before: None };
        loop {
            if timeline.len.is_multiple_of(CHUNK) {
                timeline.chunks.push(cursor);
            }
            if timeline.step(&mut cursor).is_none() {
                break;
            }
            timeline.len += 1;
        }
        if timeline.len.is_multiple_of(CHUNK) {
            timeline.chunks.pop();
        }
        Ok(timeline)
    }

    /// Whether another timeline has the same times, for the same reasons.
    pub fn is_same(&self, other: &Timeline) -> bool {
        let (Knots { keys, ramp, ends_only }, others) = (self.knots, other.knots);
        let alike = ramp == others.ramp && ends_only == others.ends_only && self.fps == other.fps;
        alike && (std::ptr::eq(keys, others.keys) || keys == others.keys)
    }

    /// How many samples there are.
    #[expect(clippy::len_without_is_empty, reason = "there are at least two")]
    pub fn len(&self) -> usize {
        self.len
    }

    /// In how many chunks they come.
    pub fn chunks(&self) -> usize {
        self.chunks.len()
    }

    /// The times of a chunk, and the last time of the chunk before it.
    pub fn chunk(&self, index: usize) -> (Option<f32>, Vec<f32>) {
        let mut cursor = self.chunks[index];
        let before = cursor.before;
        let times = std::iter::from_fn(|| self.step(&mut cursor)).take(CHUNK).collect();
        (before, times)
    }

    /// The last time.
    pub fn last(&self) -> f32 {
        self.knots.keys[self.knots.keys.len() - 1] as f32
    }

    /// The next time after the cursor.
    fn step(&self, cursor: &mut Cursor) -> Option<f32> {
        let knot = self.knots.get(cursor.knot)?;
        let before = if cursor.knot == 0 { None } else { self.knots.get(cursor.knot - 1) };
        let apart = (0.5 * self.fps.interval()).min(1e-3);
        let near = |grid: f64, knot: f64| (grid - knot).abs() < apart || grid as f32 == knot as f32;
        loop {
            let grid = self.fps.time(cursor.frame);
            let time = if grid >= knot || near(grid, knot) {
                cursor.knot += 1;
                knot
            } else {
                cursor.frame += 1;
                if before.is_some_and(|before| grid <= before || near(grid, before)) {
                    continue;
                }
                grid
            };
            cursor.before = Some(time as f32);
            return cursor.before;
        }
    }
}

/// The longest clip, seconds: beyond it no frame rate that can be asked for has frames
/// that float32 tells apart.
const LONGEST: f64 = 1e18;

/// Whether a clip of so many seconds is short enough for float32.
pub fn fits(duration: f64) -> Result<(), TooFine> {
    if duration > LONGEST { Err(TooFine::TooLong) } else { Ok(()) }
}

/// Whether float32 can tell keys apart.
pub fn keys_apart(keys: &[f64]) -> Result<(), TooFine> {
    match keys.windows(2).position(|pair| pair[0] as f32 == pair[1] as f32) {
        Some(key) => Err(TooFine::Keys { key }),
        None => Ok(()),
    }
}

/// Whether float32 can tell the samples apart.
fn check(keys: &[f64], fps: Fps, key_times: bool) -> Result<(), TooFine> {
    let last = keys[keys.len() - 1];
    fits(last)?;
    if key_times {
        keys_apart(keys)?;
    }
    if last as f32 == 0.0 {
        return Err(TooFine::Keys { key: 0 });
    }
    let interval = fps.interval();
    // The last frame, but for rates so high that its number does not fit.
    let latest = match fps.frame_near(last) {
        u64::MAX => last,
        frame => fps.time(frame).min(last),
    };
    if interval >= spacing_below(latest as f32) || interval > last {
        return Ok(());
    }
    // From 2ᵉ on float32 numbers are 2ᵉ⁻²³ apart: frames fall together from the first
    // power of two where that exceeds their interval.
    let time = 2f64.powi(24 + libm::log2(interval).floor() as i32);
    let largest_fps = Fps::at_most(1.0 / spacing_below(last as f32)).expect("LONGEST leaves a rate");
    Err(TooFine::Frames { time: time.min(last), interval, largest_fps })
}

/// Distance from a float32 to the one below it.
fn spacing_below(t: f32) -> f64 {
    f64::from(t) - f64::from(t.next_down())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn all(timeline: &Timeline) -> Vec<f32> {
        (0..timeline.chunks()).flat_map(|i| timeline.chunk(i).1).collect()
    }

    fn times(keys: &[f64], ramp: Option<f64>, fps: &str, key_times: bool) -> Vec<f32> {
        all(&Timeline::new(keys, ramp, fps.parse().unwrap(), key_times).unwrap())
    }

    #[test]
    fn grid_and_keys_and_the_end() {
        assert_eq!(times(&[0.0, 0.3, 1.05], None, "4", true), [0.0, 0.25, 0.3, 0.5, 0.75, 1.0, 1.05]);
        assert_eq!(times(&[0.0, 0.3, 1.05], None, "4", false), [0.0, 0.25, 0.5, 0.75, 1.0, 1.05]);
        assert_eq!(times(&[0.0, 0.5, 1.0], None, "2", true), [0.0, 0.5, 1.0]);
        assert_eq!(times(&[0.0, 1.0], None, "1/10", true), [0.0, 1.0]);
        assert_eq!(times(&[0.0, 1.0, 2.0], Some(0.999), "2", true), [0.0, 0.5, 0.999, 1.0, 1.5, 2.0]);
    }

    #[test]
    fn a_grid_time_next_to_a_key_gives_way() {
        assert_eq!(times(&[0.0, 0.2505, 1.0], None, "4", true), [0.0, 0.2505, 0.5, 0.75, 1.0]);
        assert_eq!(times(&[0.0, 0.2495, 1.0], None, "4", true), [0.0, 0.2495, 0.5, 0.75, 1.0]);
        assert_eq!(times(&[0.0, 0.2515, 1.0], None, "4", true), [0.0, 0.25, 0.2515, 0.5, 0.75, 1.0]);
        // Half a frame is less than a millisecond at 1000 frames a second.
        assert_eq!(times(&[0.0, 0.0026, 0.004], None, "1000", true), [0.0, 0.001, 0.002, 0.0026, 0.004]);
        // The last time counts without key times too.
        assert_eq!(times(&[0.0, 0.7, 1.0004], None, "4", false), [0.0, 0.25, 0.5, 0.75, 1.0004]);
    }

    #[test]
    fn chunks_join_without_a_seam() {
        for count in [CHUNK - 1, CHUNK, CHUNK + 1, 3 * CHUNK] {
            let keys = [0.0, 0.123, (count - 2) as f64 / 100.0];
            let timeline = Timeline::new(&keys, None, "100".parse().unwrap(), true).unwrap();
            let joined = all(&timeline);
            assert_eq!(joined.len(), timeline.len());
            assert_eq!(timeline.len(), count);
            assert!(joined.windows(2).all(|pair| pair[0] < pair[1]));
            for i in 1..timeline.chunks() {
                assert_eq!(timeline.chunk(i).0, timeline.chunk(i - 1).1.last().copied());
            }
        }
    }

    #[test]
    fn frames_that_fall_together_are_refused() {
        let keys = [0.0, 20_000.0];
        let error = Timeline::new(&keys, None, "1000".parse().unwrap(), false).unwrap_err();
        // From 16384 s on float32 times are 2⁻⁹ s apart, before that 2⁻¹⁰ s.
        assert_eq!(
            error,
            TooFine::Frames { time: 16_384.0, interval: 1e-3, largest_fps: "512".parse().unwrap() }
        );
        assert!(Timeline::new(&keys, None, "512".parse().unwrap(), false).is_ok());
        // Every rate that is named works, those below one frame a second too.
        for last in [1.0, 1e5, 1e9, 1e18] {
            let keys = [0.0, last];
            let Err(TooFine::Frames { largest_fps, .. }) =
                Timeline::new(&keys, None, "999999999999".parse().unwrap(), true)
            else {
                panic!("{last}");
            };
            assert_eq!(check(&keys, largest_fps, true), Ok(()));
            let asked_for: Fps = largest_fps.to_string().parse().unwrap();
            assert_eq!(asked_for, largest_fps);
        }
        let many = Timeline::new(&[0.0, 1e9], None, "999999999999".parse().unwrap(), false);
        assert!(matches!(many, Err(TooFine::Frames { .. })));
    }

    #[test]
    fn keys_that_fall_together_are_refused() {
        let keys = [0.0, 1000.0, 1000.00001, 2000.0];
        let error = Timeline::new(&keys, None, Fps::DEFAULT, true).unwrap_err();
        assert_eq!(error, TooFine::Keys { key: 1 });
        assert!(Timeline::new(&keys, None, Fps::DEFAULT, false).is_ok());
        assert_eq!(
            Timeline::new(&[0.0, 1e-60], None, Fps::DEFAULT, false).unwrap_err(),
            TooFine::Keys { key: 0 }
        );
        assert_eq!(Timeline::new(&[0.0, 1e39], None, Fps::DEFAULT, true).unwrap_err(), TooFine::TooLong);
    }

    proptest! {
        #[test]
        fn times_increase_and_hold_every_key(
            steps in proptest::collection::vec(1e-4..0.7f64, 1..30),
            fps in prop::sample::select(vec!["1", "24", "60", "30000/1001", "1000", "1/3"]),
            ramp in any::<bool>(),
        ) {
            let keys: Vec<f64> = std::iter::once(0.0).chain(steps.iter().scan(0.0, |t, h| { *t += h; Some(*t) })).collect();
            let ramp = ramp.then(|| keys[1] - 5e-5);
            let found = times(&keys, ramp, fps, true);
            prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]));
            prop_assert!(keys.iter().chain(&ramp).all(|&key| found.contains(&(key as f32))));
            let fps: Fps = fps.parse().unwrap();
            let widest = found.windows(2).map(|pair| f64::from(pair[1]) - f64::from(pair[0])).fold(0.0, f64::max);
            // At either end a grid time may give way to a key within 1 ms; below 32 s
            // float32 times are 2e-6 apart.
            prop_assert!(widest < fps.interval() + 2e-3 + 4e-6);
        }
    }
}

//! Objects that go the same way one after another.

use crate::curve::ramp_start;
use crate::math::Quat;
use glam::DVec3;

/// How many objects go the same way, and how far apart in time.
///
/// Copies that wrap are shifted in phase: at time t copy k is where the first one is at
/// t − k · delay, counted on from the end where that is before the start. Then the clip
/// lasts as long as one object's way. Copies that do not wrap start one after another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Copies {
    /// How many, the first included.
    pub count: usize,
    /// From one to the next, seconds, above 0; without it evenly over the way.
    pub delay: Option<f64>,
    /// Whether they wrap.
    pub wrap: bool,
}

impl Default for Copies {
    fn default() -> Copies {
        Copies { count: 1, delay: None, wrap: true }
    }
}

/// Copies that do not fit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{count} objects {delay} s apart need {} s, and the way takes {once} s: choose a --delay of {} s or less, \
     fewer objects, or --no-wrap", *.count as f64 * .delay, .once / *.count as f64
)]
#[expect(missing_docs, reason = "the message names them")]
pub struct TooMany {
    pub count: usize,
    pub delay: f64,
    pub once: f64,
}

/// Copies of an object whose way takes a known time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stream {
    /// How many, the first included.
    pub count: usize,
    /// From one to the next, seconds.
    pub delay: f64,
    /// Whether they wrap.
    pub wrap: bool,
    /// How long the way takes, seconds.
    pub once: f64,
}

impl Copies {
    /// The copies of an object whose way takes `once` seconds.
    pub(super) fn stream(self, once: f64) -> Result<Stream, TooMany> {
        let Copies { count, wrap, .. } = self;
        let delay = self.delay.unwrap_or(once / count as f64);
        // What was divided may come back a little larger.
        if wrap && count > 1 && count as f64 * delay > once * (1.0 + 1e-12) {
            return Err(TooMany { count, delay, once });
        }
        Ok(Stream { count, delay, wrap, once })
    }
}

impl Stream {
    /// How long the clip takes.
    pub(super) fn duration(&self) -> f64 {
        if self.wraps() { self.once } else { self.once + self.start(self.count - 1) }
    }

    /// Whether there are copies whose end runs into their start.
    pub fn wraps(&self) -> bool {
        self.wrap && self.count > 1
    }

    /// When a copy starts on its way, from 0.
    pub fn start(&self, copy: usize) -> f64 {
        copy as f64 * self.delay
    }

    /// Where on the way a copy that wraps is at time 0: seconds from the way's start.
    pub fn phase(&self, copy: usize) -> f64 {
        if copy == 0 { 0.0 } else { self.once - self.start(copy) }
    }

    /// Where on the way copies leave it to be back at its start when it ends. A channel
    /// cannot jump; a ramp stands in.
    pub fn leave(&self) -> f64 {
        ramp_start(self.once - self.delay, self.once)
    }

    /// Times on the way that samples must meet for all copies to have the same.
    pub(super) fn knots(&self) -> Vec<f64> {
        if !self.wraps() {
            return Vec::new();
        }
        (1..self.count).map(|copy| self.phase(copy)).chain([self.leave()]).collect()
    }

    /// What of the way a copy shows at a time of the clip. The ramp lies where a file's
    /// float32 times have it.
    pub fn moment(&self, copy: usize, t: f64) -> Moment {
        if copy == 0 || !self.wrap {
            return Moment::On(t - self.start(copy));
        }
        let on_clip = |way: f64| f64::from((single(way) - single(self.phase(copy))) as f32);
        let (leave, back) = (on_clip(self.leave()), on_clip(self.once));
        if t >= back {
            Moment::On(t - back)
        } else if t > leave {
            Moment::Back((t - leave) / (back - leave))
        } else {
            Moment::On(t + self.phase(copy))
        }
    }
}

/// The nearest float32 number.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// What a copy shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// So many seconds of the way.
    On(f64),
    /// This share of the ramp from where it leaves the way back to the start.
    Back(f64),
}

impl Stream {
    /// The rotation at a moment of what turns like `at` on its way.
    pub fn rotation(&self, moment: Moment, at: impl Fn(f64) -> Quat) -> Quat {
        match moment {
            Moment::On(t) => at(t),
            Moment::Back(share) => {
                let (from, to) = (at(self.leave()), at(0.0));
                from * Quat::exp((from.conjugate() * to.aligned_to(from)).log() * share)
            }
        }
    }

    /// The place at a moment of what goes like `at` on its way.
    pub fn place(&self, moment: Moment, at: impl Fn(f64) -> DVec3) -> DVec3 {
        match moment {
            Moment::On(t) => at(t),
            Moment::Back(share) => at(self.leave()).lerp(at(0.0), share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(count: usize, delay: Option<f64>, wrap: bool) -> Result<Stream, TooMany> {
        Copies { count, delay, wrap }.stream(12.0)
    }

    #[test]
    fn copies_are_late_by_their_delay() {
        let stream = stream(3, Some(2.5), true).unwrap();
        assert_eq!(stream.duration(), 12.0);
        assert_eq!(stream.moment(0, 4.0), Moment::On(4.0));
        assert_eq!(stream.moment(2, 6.0), Moment::On(1.0));
        assert_eq!(stream.moment(2, 1.0), Moment::On(8.0));
        assert_eq!(stream.moment(1, 2.5), Moment::On(0.0));
        assert_eq!(stream.phase(2), 7.0);
        let moment = stream.moment(1, 2.5 - 0.5e-3);
        let Moment::Back(share) = moment else { panic!("{moment:?}") };
        // float32 times are 2.4e-7 s apart here, the ramp is 1 ms long.
        assert!((share - 0.5).abs() < 1e-3, "{share}");
        let at = stream.place(moment, |t| DVec3::new(t, 0.0, 0.0));
        assert!((at.x - (1.0 - share) * 11.999).abs() < 1e-9, "{at}");
    }

    #[test]
    fn without_wrapping_the_clip_grows() {
        let stream = stream(4, Some(5.0), false).unwrap();
        assert_eq!(stream.duration(), 27.0);
        assert_eq!(stream.moment(3, 1.0), Moment::On(-14.0));
        assert!(stream.knots().is_empty());
    }

    #[test]
    fn too_many_are_refused_and_the_advice_works() {
        let error = stream(4, Some(3.5), true).unwrap_err();
        assert!(error.to_string().contains("need 14 s"), "{error}");
        assert!(stream(4, Some(error.once / 4.0), true).is_ok());
        for count in 2..50 {
            assert!(stream(count, None, true).is_ok(), "{count}");
        }
    }
}

//! What the walk asks of values: steps between near ones, in few operations, and how
//! playback between two keys bends beside another.

use crate::math::{Quat, Vec3};
use crate::reduce::value::{Numbers, Step, Value};

/// A value whose steps are mostly short.
pub(crate) trait Near: Value {
    /// How far lengths differ from one that are written as they are: what calculations in
    /// float32 leave.
    const EVEN: f64;
    /// What [`Value::uneven_lengths`] takes them to differ.
    const ROUNDED: f64;
    /// A way between neighbouring keys that is longer is left as it is.
    const FAR: f64;
    /// The longest part that such a way may be divided into.
    const WIDE: f64;
    /// The largest tolerance that is made use of.
    const WIDEST: f64;

    /// [`Value::read`], and by how much the length of the numbers differs from what it
    /// should be.
    fn near_read(stored: Self::Stored) -> (Self, f64);
    /// [`Value::step_to`] to 1e-11 of it.
    fn near_step_to(self, b: Self) -> Self::Step;
    /// [`Value::moved`] to about 1e-13.
    fn near_moved(self, step: Self::Step) -> Self;
    /// The square of the distance, or up to a quarter more.
    fn apart_squared(self, b: Self) -> f64;
    /// How many times as far as at both ends one playback may be from another, between two
    /// keys, where neither goes further than `way`.
    fn bulge(way: f64) -> f64;
    /// What is to be added for lengths that differ from one by `uneven`, to either end.
    fn bent(uneven: f64, way: f64) -> f64;
}

impl Near for Quat {
    const EVEN: f64 = 5e-7;
    const ROUNDED: f64 = 6e-8;
    const FAR: f64 = 0.25;
    const WIDE: f64 = 0.5;
    const WIDEST: f64 = 0.25;

    #[inline(always)]
    fn near_read(stored: [f32; 4]) -> (Quat, f64) {
        let q = Quat::from_xyzw(stored.map(f64::from));
        let square = q.dot(q);
        let d = square - 1.0;
        // Of lengths near one the series are exact to the last bit.
        let (scale, off) = if d.abs() < 1e-5 {
            (1.0 + d * (-0.5 + d * (0.375 - d * 0.3125)), 0.5 * d.abs() * (1.0 + d.abs()))
        } else {
            (1.0 / square.sqrt(), (square.sqrt() - 1.0).abs())
        };
        (Quat { w: q.w * scale, v: q.v * scale }, off)
    }

    /// With t = tan(φ/2) = |v| / (1 + w) the logarithm is 2 atan(t)/t · v / (1 + w), and
    /// the series of that is short where t is small.
    #[inline(always)]
    fn near_step_to(self, b: Quat) -> Vec3 {
        let turn = self.conjugate() * b;
        let scale = 1.0 / (1.0 + turn.w.abs());
        let z = turn.v.dot(turn.v) * scale * scale;
        let series = match z {
            z if z < 0.01 => series(z, 1.0 / 9.0),
            z if z < 0.04 => {
                let high = 1.0 / 11.0 + z * (-1.0 / 13.0 + z * (1.0 / 15.0 - z / 17.0));
                series(z, 1.0 / 9.0 - z * high)
            }
            _ => return self.step_to(b),
        };
        turn.v * (2.0 * series * scale).copysign(turn.w)
    }

    #[inline(always)]
    fn near_moved(self, step: Vec3) -> Quat {
        let z = step.dot(step);
        if z > 0.16 {
            return self.moved(step);
        }
        let square = z * z;
        let sinc = (1.0 - z / 6.0)
            + square * ((1.0 / 120.0 - z / 5040.0) + square * (1.0 / 362_880.0 - z / 39_916_800.0));
        let cos = (1.0 - z / 2.0)
            + square
                * ((1.0 / 24.0 - z / 720.0)
                    + square * ((1.0 / 40_320.0 - z / 3_628_800.0) + square / 479_001_600.0));
        self * Quat { w: cos, v: step * sinc }
    }

    /// An arc of a quarter turn is π/√8 times its chord, a shorter one less.
    #[inline(always)]
    fn apart_squared(self, b: Quat) -> f64 {
        let chord = |b: Quat| {
            let (w, v) = (self.w - b.w, self.v - b.v);
            w * w + v.dot(v)
        };
        1.234 * if self.dot(b) < 0.0 { chord(-b) } else { chord(b) }
    }

    /// docs/math/fewest-keys.md: with f'' ≥ −1.1 v² F the peak F is at most the larger end
    /// and 1.1/8 (vh)² F.
    fn bulge(way: f64) -> f64 {
        1.0 / (1.0 - 1.1 / 8.0 * way * way)
    }

    /// An eighth of the acceleration that [`crate::rewrite`] knows of such a blend: 2 l φ
    /// times π (l − m) l over m³, with l = 1 + uneven and m = 1 − uneven.
    fn bent(uneven: f64, way: f64) -> f64 {
        let (long, short) = (1.0 + uneven, 1.0 - uneven);
        let acceleration = 2.0 * long * way * (2.0 * uneven * std::f64::consts::PI * long) / short.powi(3);
        acceleration / 8.0
    }
}

/// The beginning of atan(t)/t by the square of t, where `rest` is that of the series
/// from the fifth term on.
#[inline(always)]
fn series(z: f64, rest: f64) -> f64 {
    let square = z * z;
    (1.0 - z * (1.0 / 3.0)) + square * ((0.2 - z * (1.0 / 7.0)) + square * rest)
}

impl<const N: usize> Near for Numbers<N> {
    const EVEN: f64 = 0.0;
    const ROUNDED: f64 = 1.0;
    const FAR: f64 = f64::INFINITY;
    const WIDE: f64 = f64::INFINITY;
    const WIDEST: f64 = f64::INFINITY;

    fn near_read(stored: [f32; N]) -> (Self, f64) {
        (Self::read(stored), 0.0)
    }

    fn near_step_to(self, b: Self) -> Self {
        self.step_to(b)
    }

    fn near_moved(self, step: Self) -> Self {
        self.moved(step)
    }

    fn apart_squared(self, b: Self) -> f64 {
        let step = self.step_to(b);
        step.dot(step)
    }

    /// The difference of two straight ways is straight.
    fn bulge(_way: f64) -> f64 {
        1.0
    }

    fn bent(_uneven: f64, _way: f64) -> f64 {
        0.0
    }
}

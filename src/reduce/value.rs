//! What a channel holds: rotations, or numbers side by side.
//!
//! The search sees both through steps: vectors that lead from one value to another
//! along the line that playback takes, as long as the distance between them.

use crate::curve::Rates;
use crate::math::{Quat, Vec3};
use crate::sample::blend::{self, Blend};
use crate::sample::deviation::written;
use crate::sample::interlude;
use crate::sample::translations::straight_bound;
use std::f64::consts::FRAC_PI_2;
use std::ops::{Add, Mul, Sub};

/// A vector that leads from one value to another.
pub trait Step:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> + Send + Sync
{
    /// No step.
    const ZERO: Self;
    /// Scalar product.
    fn dot(self, b: Self) -> f64;
    /// Length.
    fn length(self) -> f64 {
        self.dot(self).sqrt()
    }
}

impl Step for Vec3 {
    const ZERO: Vec3 = Vec3::ZERO;
    fn dot(self, b: Vec3) -> f64 {
        Vec3::dot(self, b)
    }
}

/// A value that LINEAR playback blends.
pub trait Value: Copy + Send + Sync {
    /// What leads from one to another.
    type Step: Step;
    /// How a file holds it.
    type Stored: Copy + Send + Sync;

    /// The step to another value, along the line that playback takes.
    fn step_to(self, b: Self) -> Self::Step;
    /// The value at the end of a step.
    fn moved(self, step: Self::Step) -> Self;
    /// As float32.
    fn stored(self) -> Self::Stored;
    /// What a player makes of stored numbers.
    fn read(stored: Self::Stored) -> Self;
    /// The same value as `stored` in other numbers, so that it follows `before`.
    fn continuous(stored: Self::Stored, before: Self::Stored) -> Self::Stored;
    /// How far `stored` can be from the value, at about this one.
    fn rounding(self) -> f64;
    /// What is left of distances across a step of this length, seen from its start.
    fn across(length: f64) -> f64;
    /// The distance to another value.
    fn distance(self, b: Self) -> f64 {
        self.step_to(b).length()
    }
    /// LINEAR playback between two values as glTF has it, u from 0 to 1.
    fn played(self, b: Self, u: f64) -> Self {
        self.moved(self.step_to(b) * u)
    }
    /// An upper bound of the distance between the curve and playback on a stretch of h
    /// seconds, from the distances at its ends, the sum of both accelerations, the
    /// curve's speed and playback's.
    fn bound(rates: Rates, h: f64, at_ends: (f64, f64), speed: f64) -> f64;
    /// What players may differ by where two keys are so far apart.
    fn uneven_lengths(way: f64) -> f64;
    /// How other players blend two values, with bounds of that blend's speed and
    /// acceleration by u from u to u; none where all blend alike.
    fn other_blend() -> Option<OtherBlend<Self>>;
    /// The longest step that the search may use.
    const LONGEST: f64;
}

/// A way to blend two values that is not glTF's.
#[derive(Clone, Copy)]
pub struct OtherBlend<V> {
    /// The value at u.
    pub between: fn(V, V, f64) -> V,
    /// Upper bounds of its speed and acceleration for two values so far apart, from one
    /// u to another.
    pub rates: fn(f64, f64, f64) -> Rates,
    /// How far this blend gets from playback between two keys so far apart, at most.
    pub drift: fn(f64) -> f64,
}

/// Rotations: steps and distances are half angles, radians.
impl Value for Quat {
    type Step = Vec3;
    type Stored = [f32; 4];

    fn step_to(self, b: Quat) -> Vec3 {
        let turn = self.conjugate() * b;
        if turn.w < 0.0 { (-turn).log() } else { turn.log() }
    }

    fn moved(self, step: Vec3) -> Quat {
        self * Quat::exp(step)
    }

    fn stored(self) -> [f32; 4] {
        self.to_xyzw().map(|x| x as f32)
    }

    fn read(stored: [f32; 4]) -> Quat {
        written(stored)
    }

    fn continuous(stored: [f32; 4], before: [f32; 4]) -> [f32; 4] {
        // Of float32 numbers the products are exact: half a turn stays the same half.
        let dot: f64 = stored.iter().zip(before).map(|(&a, b)| f64::from(a) * f64::from(b)).sum();
        if dot < 0.0 { stored.map(|x| -x) } else { stored }
    }

    /// Each number within 2⁻²⁵, three of them across.
    fn rounding(self) -> f64 {
        5.2e-8
    }

    /// Great circles through a point diverge as the sine of the way.
    fn across(length: f64) -> f64 {
        let square = length * length;
        1.0 - square / 6.0 + square * square / 120.0
    }

    fn bound(rates: Rates, h: f64, at_ends: (f64, f64), speed: f64) -> f64 {
        interlude::bound(rates, h, at_ends.0, at_ends.1, speed)
    }

    fn uneven_lengths(way: f64) -> f64 {
        blend::uneven_lengths(way, blend::LENGTHS)
    }

    fn other_blend() -> Option<OtherBlend<Quat>> {
        Some(OtherBlend {
            between: |a, b, u| Blend::Nlerp.between(a, b, u),
            rates: blend::rates,
            drift: blend::largest_drift,
        })
    }

    const LONGEST: f64 = 0.95 * FRAC_PI_2;
}

/// Numbers side by side: a place, a scale, the weights of morph targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers<const N: usize>(pub [f64; N]);

impl<const N: usize> Add for Numbers<N> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Numbers(std::array::from_fn(|i| self.0[i] + b.0[i]))
    }
}

impl<const N: usize> Sub for Numbers<N> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Numbers(std::array::from_fn(|i| self.0[i] - b.0[i]))
    }
}

impl<const N: usize> Mul<f64> for Numbers<N> {
    type Output = Self;
    fn mul(self, s: f64) -> Self {
        Numbers(self.0.map(|x| x * s))
    }
}

impl<const N: usize> Step for Numbers<N> {
    const ZERO: Self = Numbers([0.0; N]);
    fn dot(self, b: Self) -> f64 {
        self.0.iter().zip(b.0).map(|(a, b)| a * b).sum()
    }
}

impl<const N: usize> Value for Numbers<N> {
    type Step = Self;
    type Stored = [f32; N];

    fn step_to(self, b: Self) -> Self {
        b - self
    }

    fn moved(self, step: Self) -> Self {
        self + step
    }

    fn stored(self) -> [f32; N] {
        self.0.map(|x| x as f32)
    }

    fn read(stored: [f32; N]) -> Self {
        Numbers(stored.map(f64::from))
    }

    fn continuous(stored: [f32; N], _before: [f32; N]) -> [f32; N] {
        stored
    }

    /// Each number within half a step of float32.
    fn rounding(self) -> f64 {
        2f64.powi(-24) * self.length()
    }

    fn across(_length: f64) -> f64 {
        1.0
    }

    /// Playback is straight: the difference has the curve's acceleration alone.
    fn bound(rates: Rates, h: f64, at_ends: (f64, f64), speed: f64) -> f64 {
        straight_bound(rates, h, at_ends, speed)
    }

    fn uneven_lengths(_way: f64) -> f64 {
        0.0
    }

    fn other_blend() -> Option<OtherBlend<Self>> {
        None
    }

    const LONGEST: f64 = f64::INFINITY;
}

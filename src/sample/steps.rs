//! How far neighbouring samples are apart.

use crate::math::{Quat, widest};
use fearless_simd::{Simd, dispatch};

/// Turns between neighbouring samples that component-blending viewers show inexactly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steps {
    /// How many exceed [`Steps::LARGE`].
    pub large: usize,
    /// The largest, degrees.
    pub worst: f64,
    /// When that one begins, seconds.
    pub at: f64,
}

impl Steps {
    /// Blender blends the four numbers and normalises; up to this step, in degrees, it
    /// stays within 0.01° of slerp (about 1.2e-6 · step³).
    pub const LARGE: f64 = 18.0;

    pub(super) fn and(self, b: Steps) -> Steps {
        let worse = if b.worst > self.worst { b } else { self };
        Steps { large: self.large + b.large, ..worse }
    }

    /// The steps between neighbouring samples but for those within the ramp of a jump.
    pub(super) fn of(ramp: Option<(f64, f64)>, times: &[f32], rotations: &[[f32; 4]]) -> Steps {
        let mut squares = squared_tangents(rotations);
        if let Some((from, to)) = ramp {
            let (from, to) = (from as f32, to as f32);
            let within = |t: &[f32]| t[0] < to && t[1] > from;
            times
                .windows(2)
                .zip(&mut squares)
                .filter(|(t, _)| within(t))
                .for_each(|(_, square)| *square = 0.0);
        }
        let large = libm::tan((0.5 * Steps::LARGE).to_radians()).powi(2);
        let largest = squares.iter().copied().fold(0.0, f64::max);
        let at = squares.iter().position(|&square| square == largest).map_or(0.0, |i| f64::from(times[i]));
        Steps {
            large: squares.iter().filter(|&&square| square > large).count(),
            worst: (2.0 * libm::atan(largest.sqrt())).to_degrees(),
            at: if largest > 0.0 { at } else { 0.0 },
        }
    }
}

/// The squares of the tangents of half the turn from each sample to the next: quotients,
/// which do not mind how long the quaternions are.
fn squared_tangents(rotations: &[[f32; 4]]) -> Vec<f64> {
    let mut squares = vec![0.0; rotations.len().saturating_sub(1)];
    dispatch!(widest(), simd => fill(simd, rotations, &mut squares));
    squares
}

#[inline(always)]
fn fill<S: Simd>(_: S, rotations: &[[f32; 4]], squares: &mut [f64]) {
    for ((square, &a), &b) in squares.iter_mut().zip(rotations).zip(rotations.iter().skip(1)) {
        let number = |q: [f32; 4]| Quat::from_xyzw([q[0] as f64, q[1] as f64, q[2] as f64, q[3] as f64]);
        let step = number(a).conjugate() * number(b);
        *square = step.v.dot(step.v) / (step.w * step.w);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    #[test]
    fn steps_are_the_angles() {
        let turns = [0.0, 1e-4, 0.3, 0.3, 2.0, 2.1, 5.0];
        let sample = |turn: f64| {
            Quat::exp(Vec3::new(0.6, 0.0, 0.8) * (0.5 * turn)).to_xyzw().map(|x| (3.0 * x) as f32)
        };
        let rotations = turns.map(sample);
        let times: [f32; 7] = std::array::from_fn(|i| i as f32);
        let steps = Steps::of(None, &times, &rotations);
        // From 2.1 to 5 by 2.9, which float32 blurs by a few 1e-7.
        assert!((steps.worst.to_radians() - 2.9).abs() < 1e-6, "{steps:?}");
        assert_eq!((steps.large, steps.at), (2, 5.0));
        // Without the last one, which touches the ramp.
        let steps = Steps::of(Some((5.5, 7.0)), &times, &rotations);
        assert!((steps.worst.to_radians() - 1.7).abs() < 1e-6, "{steps:?}");
        let still = Steps::of(None, &times[..2], &[rotations[0]; 2]);
        assert_eq!(still, Steps::default());
    }
}

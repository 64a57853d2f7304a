//! How far apart two files hold a node, in six ways.

use super::rig::Local;
use crate::check::against::half_angle;
use glam::{DAffine3, DMat3};
use serde::Serialize;

/// A way to tell two poses of a node apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Measure {
    /// The angle between its rotations relative to its parents, degrees.
    LocalRotation,
    /// The distance between its places relative to its parents, units.
    LocalTranslation,
    /// The largest difference of one of its three scales.
    LocalScale,
    /// The largest difference of one of its morph weights.
    Weights,
    /// The angle between its axes in the world, degrees.
    WorldRotation,
    /// The distance between its origins in the world, units.
    WorldTranslation,
}

/// A number by measure.
pub(super) type ByMeasure<T> = [T; Measure::ALL.len()];

impl Measure {
    /// All of them.
    pub const ALL: [Measure; 6] = [
        Measure::LocalRotation,
        Measure::LocalTranslation,
        Measure::LocalScale,
        Measure::Weights,
        Measure::WorldRotation,
        Measure::WorldTranslation,
    ];

    /// What is compared, in words.
    pub fn words(self) -> &'static str {
        match self {
            Measure::LocalRotation => "local rotation",
            Measure::LocalTranslation => "local translation",
            Measure::LocalScale => "local scale",
            Measure::Weights => "morph weights",
            Measure::WorldRotation => "world rotation",
            Measure::WorldTranslation => "world position",
        }
    }

    /// What its numbers count, as it stands behind them.
    pub fn unit(self) -> &'static str {
        match self {
            Measure::LocalRotation | Measure::WorldRotation => "°",
            Measure::LocalTranslation | Measure::WorldTranslation => " units",
            Measure::LocalScale | Measure::Weights => "",
        }
    }
}

impl Measure {
    /// What a gauge stands for, in the measure's unit.
    pub(super) fn of_gauge(self, gauge: f64) -> f64 {
        match self {
            Measure::LocalRotation | Measure::WorldRotation => 2.0 * libm::asin(gauge.min(1.0)).to_degrees(),
            _ => gauge,
        }
    }
}

/// Gauges of all measures of a node, from how it stands to its parent and in the world.
pub(super) fn all(a: (&Local, &DAffine3), b: (&Local, &DAffine3)) -> ByMeasure<f64> {
    Measure::ALL.map(|measure| one(measure, a, b))
}

/// The gauge of a measure: a number that grows with it and costs little. Of an angle φ it is
/// sin(φ/2), accurate for small ones as for large ones, of all else the measure itself.
/// What overflows is as far as can be.
pub(super) fn one(measure: Measure, a: (&Local, &DAffine3), b: (&Local, &DAffine3)) -> f64 {
    let ((a, a_world), (b, b_world)) = (a, b);
    let off = match measure {
        Measure::LocalRotation if a.rotation == b.rotation => 0.0,
        Measure::LocalRotation => {
            let (sine, cosine) = half_angle(a.rotation, b.rotation);
            sine / (sine * sine + cosine * cosine).sqrt()
        }
        Measure::LocalTranslation => a.translation.distance(b.translation),
        Measure::LocalScale => (a.scale - b.scale).abs().max_element(),
        Measure::Weights => weights(&a.weights, &b.weights),
        Measure::WorldRotation => turn(a_world.matrix3, b_world.matrix3),
        Measure::WorldTranslation => a_world.translation.distance(b_world.translation),
    };
    if off.is_nan() { f64::MAX } else { off.min(f64::MAX) }
}

/// Weights that one of them lacks are zero.
fn weights(a: &[f64], b: &[f64]) -> f64 {
    let weight = |of: &[f64], i: usize| of.get(i).copied().unwrap_or(0.0);
    (0..a.len().max(b.len())).map(|i| (weight(a, i) - weight(b, i)).abs()).fold(0.0, f64::max)
}

/// The sine of half the angle between the axes of two nodes; 0 where one of them is
/// squeezed to a line or a point and so has none.
///
/// The axes are x, what is upright on it of y, and their product: scales do not count,
/// and of a sheared node it is the x axis that is followed. Two such frames that differ by
/// a turn of φ are 2√2 sin(φ/2) apart, as the root of the sum of squares of all nine
/// differences.
fn turn(a: DMat3, b: DMat3) -> f64 {
    let (Some(a), Some(b)) = (axes(a), axes(b)) else { return 0.0 };
    let apart = a - b;
    let squares =
        apart.x_axis.length_squared() + apart.y_axis.length_squared() + apart.z_axis.length_squared();
    (squares / 8.0).sqrt()
}

fn axes(m: DMat3) -> Option<DMat3> {
    let x = m.x_axis.try_normalize()?;
    let across = m.y_axis - x * m.y_axis.dot(x);
    // What is left of an axis that lies along the other is rounding alone.
    let apart = across.length() > 1e-9 * m.y_axis.length();
    let y = across.try_normalize().filter(|_| apart)?;
    Some(DMat3::from_cols(x, y, x.cross(y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn axes_turn_by_the_angle_whatever_their_scales() {
        let axis = DVec3::new(1.0, -2.0, 0.5).normalize();
        let start = DQuat::from_axis_angle(DVec3::new(3.0, 1.0, 1.0).normalize(), 0.8);
        for angle in [0.0f64, 1e-9, 1e-3, 1.0, 90.0, 179.9999, 180.0] {
            let turned = DQuat::from_axis_angle(axis, angle.to_radians()) * start;
            let scaled = |q, x, y, z| DMat3::from_quat(q) * DMat3::from_diagonal(DVec3::new(x, y, z));
            let gauge = turn(scaled(start, 1.0, 1.0, 1.0), scaled(turned, 2.0, 0.25, -7.0));
            let got = Measure::WorldRotation.of_gauge(gauge);
            // Rounding of 1e-16 in the sine is 1e-14 degrees in the angle, but at half a
            // turn, where the sine is flat, the root of it.
            let rounding = if angle < 179.0 { 1e-12 } else { 5e-6 };
            assert!((got - angle).abs() < rounding, "{angle}: {got}");
        }
        let flat = DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0));
        assert_eq!(turn(flat, DMat3::from_rotation_x(1.0)), 0.0);
    }

    #[test]
    fn missing_weights_are_zero() {
        assert_eq!(weights(&[0.5, 0.25], &[0.5]), 0.25);
        assert_eq!(weights(&[], &[]), 0.0);
    }
}

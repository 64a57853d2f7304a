//! How far an object leans into its turns.

use super::Course;
use super::facing::tilt;
use super::smoothstep;
use super::steep::STEEP;
use glam::DVec3;
use rayon::prelude::*;

/// Half the 0.25 s over which the lean is smoothed: the Gaussian's standard deviation,
/// so that its middle two thirds are a quarter of a second wide.
const SIGMA: f64 = 0.125;

/// Grid steps in one σ. A spline on so fine a grid is the Gaussian's own shape to 1e-4.
const PER_SIGMA: f64 = 8.0;

/// Steps on the longest course: beyond 34 minutes they grow.
const MOST_STEPS: f64 = 131_072.0;

/// The roll of a course's turns as a function of time, radians: positive lifts the left.
pub(super) struct Bank {
    step: f64,
    /// Weights of cubic B-splines, the first of them two steps before the first cell.
    weights: Vec<f64>,
}

impl Bank {
    /// −`degrees` · (lateral acceleration, to the left) / (its maximum), smoothed: a
    /// turn to the left lowers the left side.
    pub(super) fn new(course: &dyn Course, degrees: f64) -> Bank {
        let duration = course.duration();
        let count = (duration * PER_SIGMA / SIGMA).ceil().clamp(16.0, MOST_STEPS);
        let step = duration / count;
        let (cells, largest) = cells(course, count as usize, step);
        let scale = -degrees.to_radians() / largest;
        // None of what is still, or so small that its scale is no number.
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let smooth = smoothed(&cells, step, course.is_closed());
        Bank { step, weights: smooth.into_iter().map(|a| scale * a).collect() }
    }

    /// The roll at a time.
    pub(super) fn at(&self, t: f64) -> f64 {
        let x = (t / self.step - 0.5).clamp(-0.5, self.weights.len() as f64 - 4.5);
        let first = if x.is_finite() { (x.floor() + 1.0) as usize } else { 0 };
        let u = x - x.floor();
        let v = 1.0 - u;
        let basis = [v * v * v, 4.0 + 3.0 * u * u * (u - 2.0), 4.0 + 3.0 * v * v * (v - 2.0), u * u * u];
        let weights = self.weights.iter().skip(first);
        if x.is_finite() { basis.into_iter().zip(weights).map(|(b, w)| b * w / 6.0).sum() } else { 0.0 }
    }
}

/// What a course does at a time.
struct Moment {
    /// Acceleration to the left, level, units per second². Near the vertical, where left
    /// turns about, it fades away.
    lateral: f64,
    /// What rounding may make of an acceleration.
    rounding: f64,
}

impl Moment {
    fn at(course: &dyn Course, t: f64) -> Moment {
        let [velocity, acceleration] = course.rates(t);
        let rounding = 1e-9 * (acceleration.length() + velocity.length() / course.duration());
        let forward = velocity.try_normalize().or_else(|| course.direction(t));
        let lateral = forward.map_or(0.0, |forward| {
            let left = DVec3::new(forward.z, 0.0, -forward.x).normalize_or_zero();
            acceleration.dot(left) * smoothstep(tilt(forward) / STEEP)
        });
        Moment { lateral: if lateral.is_finite() { lateral } else { 0.0 }, rounding }
    }
}

/// Mean lateral acceleration in each cell of the grid, and the largest anywhere; 0 for
/// a course whose accelerations are rounding.
fn cells(course: &dyn Course, count: usize, step: f64) -> (Vec<f64>, f64) {
    const SAMPLES: [f64; 4] = [0.125, 0.375, 0.625, 0.875];
    let cell = |i: usize| SAMPLES.map(|x| Moment::at(course, (i as f64 + x) * step));
    let cells: Vec<[Moment; 4]> = (0..count).into_par_iter().map(cell).collect();
    let keys: Vec<Moment> = course.key_times().iter().map(|&t| Moment::at(course, t)).collect();
    let all = || cells.iter().flatten().chain(&keys);
    let largest = all().map(|moment| moment.lateral.abs()).fold(0.0, f64::max);
    let rounding = all().map(|moment| moment.rounding).fold(0.0, f64::max);
    let means = cells.iter().map(|cell| cell.iter().map(|moment| moment.lateral).sum::<f64>() / 4.0);
    (means.collect(), if largest > rounding { largest } else { 0.0 })
}

/// The cells under a Gaussian, from two steps before the first to two after the last:
/// wrapped where the course is closed, else the mean of what there is.
///
/// Cells and B-splines smooth by themselves: h²/12 and h²/3 of the variance.
fn smoothed(cells: &[f64], step: f64, closed: bool) -> Vec<f64> {
    let count = cells.len() as i64;
    let variance = (SIGMA * SIGMA - step * step * (1.0 / 3.0 + 1.0 / 12.0)).max(0.25 * SIGMA * SIGMA);
    let reach = ((5.0 * SIGMA / step).ceil() as i64).min(2 * count);
    let weight = |k: i64| libm::exp(-(k as f64 * step).powi(2) / (2.0 * variance));
    let kernel: Vec<f64> = (-reach..=reach).map(weight).collect();
    let mean = |j: i64| {
        let (mut sum, mut total) = (0.0, 0.0);
        for (k, weight) in (j - reach..=j + reach).zip(&kernel) {
            let cell = if closed { k.rem_euclid(count) } else { k };
            if (0..count).contains(&cell) {
                sum += weight * cells[cell as usize];
                total += weight;
            }
        }
        if total > 0.0 { sum / total } else { 0.0 }
    };
    (-2..count + 2).map(mean).collect()
}

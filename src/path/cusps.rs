//! Where a Bézier curve comes to rest inside: its derivative vanishes, and as a rule its
//! direction turns round.

use super::bezier::{Bezier, longest};
use glam::DVec3;

/// Derivatives below this fraction of the largest control point of the hodograph are
/// rounding: their direction means nothing.
pub(super) const REST: f64 = 1e-12;

/// How often an interval is halved: 2⁻⁴⁶ of u is left, on which a derivative that
/// vanishes there stays below [`REST`], and beside which it stands above rounding.
const DEPTH: u32 = 46;

/// The u strictly between 0 and 1 at which the derivative vanishes, increasing.
///
/// The derivative lies in the hull of its control points; where these lie in one
/// half-space, it vanishes at an end or nowhere. Elsewhere the interval is halved.
pub(super) fn cusps(curve: &Bezier) -> Vec<f64> {
    let hodograph = curve.hodograph();
    let size = longest(hodograph);
    let mut found = Vec::new();
    if size > 0.0 && hodograph.len() > 1 {
        search(&Bezier::new(hodograph.to_vec()), (0.0, 1.0), size, DEPTH, &mut found);
    }
    found.retain(|&u| u > 1e-9 && u < 1.0 - 1e-9);
    // One cusp may have been found from both its sides.
    found.dedup_by(|later, earlier| *later - *earlier < 1e-9);
    found
}

fn search(derivative: &Bezier, (a, b): (f64, f64), size: f64, depth: u32, found: &mut Vec<f64>) {
    if one_sided(derivative.points(), size) {
        return;
    }
    let middle = 0.5 * (a + b);
    if depth == 0 {
        return found.push(middle);
    }
    let [left, right] = derivative.split(0.5);
    search(&left, (a, middle), size, depth - 1, found);
    if right.points()[0].length() <= REST * size {
        found.push(middle);
    }
    search(&right, (middle, b), size, depth - 1, found);
}

/// Whether no vector points away from the sum of all; rounding aside.
fn one_sided(vectors: &[DVec3], size: f64) -> bool {
    let towards = vectors.iter().sum::<DVec3>().normalize_or_zero();
    towards != DVec3::ZERO && vectors.iter().all(|v| v.dot(towards) >= -1e-15 * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(points: &[[f64; 3]]) -> Vec<f64> {
        cusps(&Bezier::new(points.iter().map(|&p| DVec3::from_array(p)).collect()))
    }

    #[test]
    fn turning_points_of_a_doubled_line_are_found() {
        // x = 3u(1−u)(1−2u)·… for points 0, 1, −1, 0: x′ = 3(1 − 6u + 6u²).
        let found = of(&[[0.0, 0.0, 0.0], [1.0, 2.0, -1.0], [-1.0, -2.0, 1.0], [0.0, 0.0, 0.0]]);
        let root = 0.5 - 3f64.sqrt() / 6.0;
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0] - root).abs() < 1e-12 && (found[1] - 1.0 + root).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_cusp_of_a_plane_cubic_is_found() {
        // Crossed handles of the right length: y′ and x′ vanish together at ½.
        let found = of(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn regular_curves_and_points_have_none() {
        assert!(of(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.1, 1.0, 0.0], [1.0, 0.0, 0.0]]).is_empty());
        assert!(of(&[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]).is_empty());
        assert!(of(&[[2.0, 0.0, 0.0]; 4]).is_empty());
        assert!(of(&[[2.0, 0.0, 0.0], [1.0, 0.0, 0.0]]).is_empty());
    }
}

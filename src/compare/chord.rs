//! How far a rotation is from where its segment's two keys say it should be.

use crate::math::{Quat, Vec3};

/// The arc between the two keys of a segment, on the sphere of unit quaternions. Angles
/// are radians, and twice those between quaternions: of rotation.
///
/// Signs count, so that a rotation which has gone 190° is 190° away and not 170°.
pub(super) struct Chord {
    start: Quat,
    end: Quat,
    /// From `start` to `end`.
    angle: f64,
    /// Unit axis of that turn; zero where both are the same.
    axis: Vec3,
}

impl Chord {
    /// From one key to the other, in the signs of a motion that begins at `first`.
    pub(super) fn new(start: Quat, end: Quat, first: Quat) -> Chord {
        let (start, end) = if start.dot(first) < 0.0 { (-start, -end) } else { (start, end) };
        let v = (start.conjugate() * end).v;
        let length = v.length();
        let axis = if length == 0.0 { Vec3::ZERO } else { v * (1.0 / length) };
        Chord { start, end, angle: angle(start, end), axis }
    }

    /// Overshoot and stray of a rotation.
    ///
    /// Overshoot is by how much it is further from one key than the other key is; about
    /// the keys' own axis, how far it has turned beyond them. Stray is the distance to
    /// the nearest point of the arc. By the triangle inequality overshoot is the smaller.
    pub(super) fn measure(&self, q: Quat) -> [f64; 2] {
        let (to_start, to_end) = (angle(self.start, q), angle(self.end, q));
        let overshoot = to_start.max(to_end) - self.angle;
        [overshoot, self.stray(q, to_start.min(to_end))]
    }

    fn stray(&self, q: Quat, to_nearer_key: f64) -> f64 {
        let Quat { w, v } = self.start.conjugate() * q;
        // Along the great circle of the arc, and across it.
        let along = v.dot(self.axis);
        let across = (v - self.axis * along).length();
        let turned = 2.0 * libm::atan2(along, w);
        if (0.0..=self.angle).contains(&turned) {
            2.0 * libm::atan2(across, libm::hypot(w, along))
        } else {
            to_nearer_key
        }
    }
}

/// The angle of rotation from one unit quaternion to another, 0 to 2π: signs count.
fn angle(a: Quat, b: Quat) -> f64 {
    let relative = a.conjugate() * b;
    2.0 * libm::atan2(relative.v.length(), relative.w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn about_z(degrees: f64) -> Quat {
        Quat::exp(Vec3::new(0.0, 0.0, degrees.to_radians() / 2.0))
    }

    fn degrees(chord: &Chord, q: Quat) -> [f64; 2] {
        chord.measure(q).map(f64::to_degrees)
    }

    fn near(found: [f64; 2], expected: [f64; 2]) -> bool {
        // A product and an arc tangent of rounded numbers, in degrees.
        found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn about_the_keys_axis_both_are_what_lies_beyond() {
        for (from, to) in [(10.0, 70.0), (70.0, 10.0), (-80.0, 100.0)] {
            let chord = Chord::new(about_z(from), about_z(to), about_z(from));
            let way = f64::abs(to - from);
            for beyond in [5.0, 40.0, 100.0] {
                for side in [to + (to - from).signum() * beyond, from - (to - from).signum() * beyond] {
                    assert!(near(degrees(&chord, about_z(side)), [beyond; 2]), "{from} {to} {side}");
                }
            }
            let middle = degrees(&chord, about_z(0.5 * (from + to)));
            assert!(near(middle, [-0.5 * way, 0.0]), "{middle:?}");
        }
    }

    #[test]
    fn equal_keys_are_strayed_from_and_overshot_alike() {
        let key = about_z(30.0);
        let chord = Chord::new(key, key, key);
        let off = key * Quat::exp(Vec3::new(0.03, 0.0, 0.04));
        assert!(near(degrees(&chord, off), [0.1f64.to_degrees(); 2]));
    }

    #[test]
    fn aside_of_the_middle_is_no_overshoot() {
        let chord = Chord::new(about_z(0.0), about_z(80.0), about_z(0.0));
        // At a right angle to the arc.
        let aside = about_z(40.0) * Quat::exp(Vec3::new(0.1, 0.0, 0.0));
        let [overshoot, stray] = degrees(&chord, aside);
        assert!((stray - 0.2f64.to_degrees()).abs() < 1e-12 && overshoot < -20.0);
    }

    #[test]
    fn signs_of_the_motion_decide() {
        let [same, other] = [1.0, -1.0].map(|sign| {
            let first = if sign < 0.0 { -about_z(0.0) } else { about_z(0.0) };
            let q = if sign < 0.0 { -about_z(130.0) } else { about_z(130.0) };
            degrees(&Chord::new(about_z(0.0), about_z(120.0), first), q)
        });
        assert!(near(same, [10.0; 2]) && near(other, [10.0; 2]));
    }

    proptest! {
        /// Against the nearest of many points of the arc.
        #[test]
        fn stray_is_the_least_distance(
            step in prop::array::uniform3(-0.8..0.8f64),
            off in prop::array::uniform3(-0.9..0.9f64),
        ) {
            let vector = |[x, y, z]: [f64; 3]| Vec3::new(x, y, z);
            let (start, q) = (Quat::IDENTITY, Quat::exp(vector(off)));
            let chord = Chord::new(start, Quat::exp(vector(step)), start);
            let [overshoot, stray] = chord.measure(q);
            let points = (0..=2000).map(|i| Quat::exp(vector(step) * (f64::from(i) / 2000.0)));
            let least = points.map(|point| angle(point, q)).fold(f64::INFINITY, f64::min);
            // Points are at most 2 · 1.4 / 2000 apart, so the nearest is off by half of
            // that at most.
            prop_assert!(stray <= least + 1e-12 && least <= stray + 7e-4, "{stray} {least}");
            prop_assert!(overshoot <= stray + 1e-12);
        }
    }
}

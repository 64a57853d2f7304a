//! The numbers by which a file holds a rotation.

use super::blend::LENGTHS;
use crate::math::Quat;

/// What numbers stand for a rotation, x y z w.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// float32.
    #[default]
    Float,
    /// Whole numbers of 16 bits, 32767 being 1.
    Normalized16,
}

/// What stands for 1.
const ONE: f64 = 32767.0;

/// How far from 1 the length of a coded quaternion may be: not all viewers normalise, and
/// what they draw is scaled by it.
const LENGTH: f64 = 2e-5;

impl Encoding {
    /// The largest angle, degrees, by which coding turns a rotation. For 16 bits measured
    /// over many rotations, the worst of which was 3.2e-3 (`coded_rotations_are_near`).
    pub fn largest_error(self) -> f64 {
        match self {
            Encoding::Float => 6e-6,
            Encoding::Normalized16 => 4e-3,
        }
    }

    /// How much the lengths of two coded quaternions can differ.
    pub(crate) fn lengths(self) -> f64 {
        match self {
            Encoding::Float => LENGTHS,
            Encoding::Normalized16 => 2.0 * (LENGTH + LENGTHS),
        }
    }

    /// The numbers of a unit quaternion, as a reader finds them.
    pub fn numbers(self, q: Quat) -> [f32; 4] {
        match self {
            Encoding::Float => q.to_xyzw().map(|x| x as f32),
            Encoding::Normalized16 => nearest(q.to_xyzw()).map(|code| (f64::from(code) / ONE) as f32),
        }
    }
}

/// The code of a number that [`Encoding::Normalized16`] made.
pub fn code(number: f32) -> i16 {
    (f64::from(number) * ONE).round() as i16
}

/// Of the codes around a unit quaternion, the one nearest in angle among those of nearly
/// unit length; where none is, the one of the best length.
fn nearest(q: [f64; 4]) -> [i16; 4] {
    let scaled = q.map(|x| x * ONE);
    let around = (0..16u32).map(|corner| {
        let side = |i: usize| scaled[i].floor() + f64::from(corner >> i & 1);
        let exact = |i: usize| if scaled[i].fract() == 0.0 { scaled[i] } else { side(i) };
        [0, 1, 2, 3].map(|i| exact(i).clamp(-ONE, ONE))
    });
    let rank = |code: &[f64; 4]| {
        let length = code.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off_length = (length / ONE - 1.0).abs();
        let off = code.iter().zip(scaled).map(|(c, x)| (c / length - x / ONE).powi(2)).sum::<f64>();
        if off_length <= LENGTH { (0, off) } else { (1, off_length) }
    };
    let best = around.min_by(|a, b| {
        let ((a, x), (b, y)) = (rank(a), rank(b));
        a.cmp(&b).then(x.total_cmp(&y))
    });
    best.expect("sixteen corners").map(|x| x as i16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::sample::deviation::written;
    use proptest::prelude::*;

    #[test]
    fn exact_codes_stay() {
        for q in [[0.0, 0.0, 0.0, 1.0], [0.0, -1.0, 0.0, 0.0]] {
            assert_eq!(Encoding::Normalized16.numbers(Quat::from_xyzw(q)), q.map(|x| x as f32));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn coded_rotations_are_near(v in prop::array::uniform3(-3.2..3.2f64)) {
            let q = Quat::exp(Vec3::new(v[0], v[1], v[2]));
            for encoding in [Encoding::Float, Encoding::Normalized16] {
                let numbers = encoding.numbers(q);
                let off = written(numbers).angle_to(q).to_degrees();
                prop_assert!(off <= encoding.largest_error(), "{encoding:?}: {off}");
                if encoding == Encoding::Normalized16 {
                    let length = numbers.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt();
                    prop_assert!((length - 1.0).abs() < LENGTH + 1e-7, "{length}");
                    let codes = numbers.map(code);
                    prop_assert_eq!(codes.map(|c| (f64::from(c) / ONE) as f32), numbers);
                }
            }
        }
    }
}

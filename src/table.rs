//! Motion as a table: a row a time, columns for whatever moves.

use crate::clip::Body;
use crate::curve::Scheme;
use crate::math::Quat;
use crate::moves::{Ground, Move, Mover};
use crate::orient::{Euler, Frame, axis_angle};

/// How rotations are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Notation {
    /// w x y z.
    #[default]
    Quaternion,
    /// Angle in degrees, 0 to 180, and unit axis; no rotation has the axis x.
    AxisAngle,
    /// Roll, pitch and yaw in degrees: yaw first, then pitch, then roll; at the poles of
    /// pitch roll is 0.
    Euler,
    /// The nine numbers of the rotation matrix, row by row.
    Matrix,
}

impl Notation {
    /// Every notation, in the order of the documentation.
    pub const ALL: [Notation; 4] =
        [Notation::Quaternion, Notation::AxisAngle, Notation::Euler, Notation::Matrix];

    /// The name by which users choose it.
    pub fn name(self) -> &'static str {
        match self {
            Notation::Quaternion => "quaternion",
            Notation::AxisAngle => "axis-angle",
            Notation::Euler => "euler",
            Notation::Matrix => "matrix",
        }
    }

    /// The notation of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Notation> {
        Notation::ALL.into_iter().find(|notation| notation.name() == name)
    }

    fn columns(self) -> &'static [&'static str] {
        match self {
            Notation::Quaternion => &["w", "x", "y", "z"],
            Notation::AxisAngle => &["angle", "axis_x", "axis_y", "axis_z"],
            Notation::Euler => &["roll", "pitch", "yaw"],
            Notation::Matrix => &["m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"],
        }
    }

    fn numbers(self, q: Quat) -> Vec<f64> {
        match self {
            Notation::Quaternion => q.to_wxyz().to_vec(),
            Notation::AxisAngle => {
                let (axis, angle) = axis_angle(q);
                vec![angle, axis.x, axis.y, axis.z]
            }
            Notation::Euler => {
                let Euler { roll, pitch, yaw } = Euler::from_rotation(q);
                vec![roll, pitch, yaw]
            }
            Notation::Matrix => {
                let columns = glam::DMat3::from_quat(q.into());
                columns.transpose().to_cols_array().to_vec()
            }
        }
    }
}

/// A table that is worked out row by row.
pub struct Table<'a> {
    moves: Vec<(String, Move<'a>)>,
    notation: Notation,
    frame: Frame,
}

impl<'a> Table<'a> {
    /// What moves, by a scheme; rotations in a notation, all in the axes of `frame`.
    pub fn new(ground: &'a Ground<'a>, scheme: Scheme, notation: Notation, frame: Frame) -> Table<'a> {
        let body = ground.inputs().keyframes.as_ref().map(|keyframes| keyframes.clip.body);
        let name = |mover| match (mover, body) {
            (Mover::Root, None) => String::new(),
            (Mover::Root, Some(_)) => "root_".to_owned(),
            (Mover::Track(_), Some(Body::Free)) => "body_".to_owned(),
            (Mover::Track(track), _) => format!("box{}_", track + 1),
        };
        let moves = ground.moves(scheme).into_iter().map(|(mover, a_move)| (name(mover), a_move));
        Table { moves: moves.collect(), notation, frame }
    }

    /// The names of the columns; the first is the time, `t`.
    pub fn header(&self) -> Vec<String> {
        let columns = self.moves.iter().flat_map(|(name, a_move)| {
            let parts = match a_move {
                Move::Travel(_) => &["x", "y", "z"],
                Move::Keys(_) | Move::Attitude(_) => self.notation.columns(),
            };
            // A place and a rotation of the same node must not share a name.
            let mark = if matches!(a_move, Move::Travel(_)) || !name.is_empty() { "" } else { "q" };
            parts.iter().map(move |part| format!("{name}{mark}{part}"))
        });
        std::iter::once("t".to_owned()).chain(columns).collect()
    }

    /// The row of a time, seconds.
    pub fn row(&self, t: f64) -> Vec<f64> {
        let numbers = self.moves.iter().flat_map(|(_, a_move)| match a_move {
            Move::Keys(motion) => self.rotation(motion.at(t)),
            Move::Attitude(turn) => self.rotation((turn.at)(t)),
            Move::Travel(travel) => self.frame.vector_from_gltf(travel.at(t)).to_array().to_vec(),
        });
        std::iter::once(t).chain(numbers).collect()
    }

    fn rotation(&self, q: Quat) -> Vec<f64> {
        self.notation.numbers(self.frame.rotation_from_gltf(q))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moves::{Inputs, Shape};
    use crate::read::{Input, input};

    fn inputs(text: &str) -> Inputs {
        match input("t.dat", text.as_bytes(), None).unwrap() {
            Input::Keyframes(keyframes) => {
                Inputs { keyframes: Some(keyframes), path: None, cameras: Vec::new() }
            }
            Input::Path(path) => Inputs { keyframes: None, path: Some(path), cameras: Vec::new() },
            other => panic!("{other:?}"),
        }
    }

    fn row(text: &str, notation: Notation, frame: Frame, t: f64) -> (Vec<String>, Vec<f64>) {
        let inputs = inputs(text);
        let shape =
            Shape { orient: Some(crate::moves::Orient::None), frame: Some(frame), ..Shape::default() };
        let ground = Ground::new(&inputs, shape, &[Scheme::Slerp]).unwrap();
        let table = Table::new(&ground, Scheme::Slerp, notation, frame);
        (table.header(), table.row(t))
    }

    fn near(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn every_notation_of_a_quarter_turn_about_z() {
        let text = "# 1 2\n0 1 0 0 0\n1 0 0 0 1\n";
        let h = 0.5f64.sqrt();
        for (notation, columns, numbers) in [
            (Notation::Quaternion, "box1_w", &[h, 0.0, 0.0, h][..]),
            (Notation::AxisAngle, "box1_angle", &[90.0, 0.0, 0.0, 1.0]),
            (Notation::Euler, "box1_roll", &[0.0, 0.0, 90.0]),
            (Notation::Matrix, "box1_m00", &[0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        ] {
            let (header, row) = row(text, notation, Frame::Gltf, 0.5);
            assert_eq!((header[0].as_str(), header[1].as_str(), header.len()), ("t", columns, row.len()));
            assert!(near(&row[1..], numbers), "{row:?}");
        }
    }

    #[test]
    fn a_path_comes_back_in_its_own_frame() {
        let (header, row) = row("# polyline 2\n0 0 0\n2 4 6\n", Notation::Quaternion, Frame::Frd, 1.0);
        assert_eq!(header, ["t", "x", "y", "z"]);
        assert!(near(&row, &[1.0, 1.0, 2.0, 3.0]), "{row:?}");
    }
}

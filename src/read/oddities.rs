//! What is accepted but worth a word: quaternions that are not unit, or that look as
//! if their parts stood in the other order.

use super::Order;
use crate::clip::Warning;

/// A length that is further than this from 1 is reported.
const NOT_UNIT: f64 = 1e-3;

/// What was seen in the quaternions of some rows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Oddities {
    not_unit: usize,
    /// Distance from 1, length, line and box of the worst.
    worst: Option<Worst>,
    /// Signs seen of the part that the order makes the scalar.
    scalar: Signs,
    /// Signs seen of the part that the other order would make the scalar.
    other: Signs,
    /// Quaternions that are the identity in this order.
    identities: usize,
    /// Quaternions that are the identity in the other order, and the line of the first.
    other_identities: usize,
    other_identity_line: Option<usize>,
}

type Worst = (f64, f64, usize, Option<usize>);

#[derive(Clone, Copy, Debug, Default)]
struct Signs {
    positive: bool,
    negative: bool,
}

impl Signs {
    #[inline(always)]
    fn look(&mut self, x: f64) {
        self.positive |= x > 0.0;
        self.negative |= x < 0.0;
    }

    fn or(self, b: Signs) -> Signs {
        Signs { positive: self.positive || b.positive, negative: self.negative || b.negative }
    }
}

impl Oddities {
    /// Looks at a quaternion's parts as they stand in the file.
    #[inline(always)]
    pub(super) fn look(&mut self, parts: [f64; 4], order: Order, line: usize) {
        let [first, .., last] = parts;
        let (scalar, other) = match order {
            Order::Wxyz => (first, last),
            Order::Xyzw => (last, first),
        };
        self.scalar.look(scalar);
        self.other.look(other);
        if parts[1] == 0.0 && parts[2] == 0.0 {
            self.identities += usize::from(other == 0.0 && scalar.abs() == 1.0);
            if scalar == 0.0 && other.abs() == 1.0 {
                self.other_identities += 1;
                self.other_identity_line.get_or_insert(line);
            }
        }
    }

    /// Looks at a quaternion's length; `index` is its box, if boxes are what it turns.
    #[inline(always)]
    pub(super) fn measure(&mut self, norm: f64, line: usize, index: Option<usize>) {
        let off = (norm - 1.0).abs();
        self.not_unit += usize::from(off > NOT_UNIT);
        if self.worst.is_none_or(|worst| off > worst.0) {
            self.worst = Some((off, norm, line, index));
        }
    }

    /// How far from 1 the worst length is.
    pub(super) fn largest_norm_error(&self) -> f64 {
        self.worst.map_or(0.0, |worst| worst.0)
    }

    /// Moves line numbers from within a part to within the file.
    pub(super) fn shift(&mut self, lines: usize) {
        if let Some(worst) = &mut self.worst {
            worst.2 += lines;
        }
        self.other_identity_line = self.other_identity_line.map(|line| line + lines);
    }

    /// What was seen in both; `self` comes first in the file.
    pub(super) fn and(self, b: Oddities) -> Oddities {
        let worse = |a: Worst, b: Worst| if b.0 > a.0 { b } else { a };
        Oddities {
            not_unit: self.not_unit + b.not_unit,
            worst: self.worst.map(|a| b.worst.map_or(a, |b| worse(a, b))).or(b.worst),
            scalar: self.scalar.or(b.scalar),
            other: self.other.or(b.other),
            identities: self.identities + b.identities,
            other_identities: self.other_identities + b.other_identities,
            other_identity_line: self.other_identity_line.or(b.other_identity_line),
        }
    }

    /// What to tell the user.
    pub(super) fn warnings(&self, order: Order) -> Vec<Warning> {
        self.not_unit_warning().into_iter().chain(self.order_warning(order)).collect()
    }

    fn not_unit_warning(&self) -> Option<Warning> {
        let (_, norm, line, index) = self.worst.filter(|worst| worst.0 > NOT_UNIT)?;
        let count = match self.not_unit {
            1 => "1 quaternion is".to_owned(),
            n => format!("{n} quaternions are"),
        };
        let readable = (1e-3..1e6).contains(&norm);
        let length = if readable { format!("{norm:.6}") } else { format!("{norm:.3e}") };
        let of = index.map_or_else(String::new, |index| format!("box {}: ", index + 1));
        let message =
            format!("{count} not of unit length, the worst in line {line} ({of}length {length}); normalised");
        Some(Warning::new("NOT_UNIT", message))
    }

    fn order_warning(&self, order: Order) -> Option<Warning> {
        let (this, other) = (order.name(), order.other().name());
        let advice = format!("if the component order is {other}, use --quat-order {other}");
        let swaps =
            self.scalar.positive && self.scalar.negative && self.other.positive && !self.other.negative;
        let message = match self.other_identity_line {
            Some(line) if self.identities == 0 => format!(
                "{} of the quaternions are 'no rotation' in the order {other} (the first in line {line}), none \
                 in the order {this} they are read in; {advice}",
                self.other_identities
            ),
            _ if swaps => {
                let column = if order == Order::Wxyz { "last" } else { "first" };
                format!(
                    "the scalar part (order {this}) changes sign while the {column} part is never negative; \
                     {advice}"
                )
            }
            _ => return None,
        };
        Some(Warning::new("QUAT_ORDER", message))
    }
}

//! Clenshaw–Curtis quadrature: integrals of smooth functions from a few values, and whether
//! those were enough.
//!
//! Values are taken where a cosine of even steps is, the ends among them, so that every
//! second one makes a rule of half the order: where both rules agree, both are right.
//! Sources: Clenshaw and Curtis 1960; the weights in closed form: Waldvogel 2006.

/// Steps between values; exact for polynomials of so high a degree.
const ORDER: usize = 48;
/// Values of a stretch.
pub(super) const PLACES: usize = ORDER + 1;
/// Halvings of 0..=1, at most: some functions swing round within a fraction of it.
const HALVINGS: u32 = 3;

/// Places and weights.
pub(super) struct Rule {
    /// From 0 to 1.
    places: [f64; PLACES],
    /// Of all values, and of every second one; each sums to 1.
    weights: [Vec<f64>; 2],
}

/// A function's values on a part of 0..=1.
pub(super) struct Stretch<const N: usize> {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) values: [[f64; N]; PLACES],
}

impl Rule {
    pub(super) fn new() -> Rule {
        let places = std::array::from_fn(|i| place(i, ORDER));
        Rule { places, weights: [weights(ORDER), weights(ORDER / 2)] }
    }

    /// Where a stretch's value is.
    pub(super) fn place<const N: usize>(&self, stretch: &Stretch<N>, i: usize) -> f64 {
        stretch.from + self.places[i] * (stretch.to - stretch.from)
    }

    /// The integral of a function of the values, and what every second of them says of it.
    pub(super) fn integrals<const N: usize>(
        &self,
        stretch: &Stretch<N>,
        f: impl Fn(&[f64; N]) -> f64,
    ) -> [f64; 2] {
        let length = stretch.to - stretch.from;
        let sum = |weights: &[f64], step: usize| -> f64 {
            weights
                .iter()
                .zip(stretch.values.iter().step_by(step))
                .map(|(weight, value)| weight * f(value))
                .sum()
        };
        [length * sum(&self.weights[0], 1), length * sum(&self.weights[1], 2)]
    }

    /// A function of 0..=1 in stretches, each halved until it is `resolved`, or an eighth.
    pub(super) fn stretches<const N: usize>(
        &self,
        f: impl Fn(f64) -> [f64; N],
        resolved: impl Fn(&Stretch<N>) -> bool,
    ) -> Vec<Stretch<N>> {
        let shortest = 0.5f64.powi(HALVINGS as i32);
        let mut open = vec![(0.0, 1.0)];
        let mut found = Vec::with_capacity(1);
        while let Some((from, to)) = open.pop() {
            let values = self.places.map(|place| f(from + place * (to - from)));
            let stretch = Stretch { from, to, values };
            if to - from <= shortest || resolved(&stretch) {
                found.push(stretch);
            } else {
                let middle = 0.5 * (from + to);
                open.extend([(middle, to), (from, middle)]);
            }
        }
        found
    }
}

/// Place i of a rule of an order, on 0..=1.
fn place(i: usize, order: usize) -> f64 {
    let half = 0.5 * std::f64::consts::PI * i as f64 / order as f64;
    half.sin().powi(2)
}

/// Weights on 0..=1 of a rule of even order: (c/n) (1/2 − Σ b cos(2jθ) / (2 (4j² − 1))), c being 1 at
/// the ends and 2 between them, b 1 for the last j = n/2 and 2 before.
fn weights(order: usize) -> Vec<f64> {
    let n = order as f64;
    let term = |i: usize, j: usize| {
        let b = if 2 * j == order { 1.0 } else { 2.0 };
        let angle = std::f64::consts::TAU * ((i * j) % order) as f64 / n;
        b * angle.cos() / (4 * j * j - 1) as f64
    };
    let weight = |i: usize| {
        let c = if i == 0 || i == order { 1.0 } else { 2.0 };
        0.5 * c / n * (1.0 - (1..=order / 2).map(|j| term(i, j)).sum::<f64>())
    };
    (0..=order).map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(rule: &Rule, f: impl Fn(f64) -> f64) -> [f64; 2] {
        let stretches = rule.stretches(|u| [f(u)], |_| true);
        assert_eq!(stretches.len(), 1);
        rule.integrals(&stretches[0], |[x]| *x)
    }

    #[test]
    fn polynomials_up_to_the_order_are_exact() {
        let rule = Rule::new();
        for degree in 0..=ORDER as i32 {
            let [fine, coarse] = whole(&rule, |u| (2.0 * u - 1.0).powi(degree));
            let exact = if degree % 2 == 0 { 1.0 / f64::from(degree + 1) } else { 0.0 };
            // Terms that sum to 1 at most, each rounded.
            assert!((fine - exact).abs() < 1e-14, "{degree}: {fine}");
            assert!((coarse - exact).abs() < 1e-14 || degree > ORDER as i32 / 2, "{degree}: {coarse}");
        }
        // Of those far beyond it, parts are taken for ones of less degree.
        for (which, order) in [(0, ORDER), (1, ORDER / 2)] {
            let degree = 4 * order as i32;
            let found = whole(&rule, |u| (2.0 * u - 1.0).powi(degree))[which];
            let off = (found * f64::from(degree + 1) - 1.0).abs();
            assert!(off > 1e-6, "{order}: {off}");
        }
    }

    #[test]
    fn stretches_are_as_short_as_they_must_be() {
        let rule = Rule::new();
        // Runge's function with poles 0.01 off the middle.
        let runge = |u: f64| [1.0 / (1e-4 + (u - 0.5).powi(2))];
        let agree = |stretch: &Stretch<1>| {
            let [fine, coarse] = rule.integrals(stretch, |[x]| *x);
            (fine - coarse).abs() <= 1e-9 * fine
        };
        let stretches = rule.stretches(runge, agree);
        let ends: Vec<[f64; 2]> = stretches.iter().map(|stretch| [stretch.from, stretch.to]).collect();
        assert_eq!((ends[0][0], ends[ends.len() - 1][1]), (0.0, 1.0));
        assert!(ends.windows(2).all(|pair| pair[0][1] == pair[1][0]), "{ends:?}");
        assert!((3..8).contains(&ends.len()), "{ends:?}");
        let sum: f64 = stretches.iter().map(|stretch| rule.integrals(stretch, |[x]| *x)[0]).sum();
        let exact = 200.0 * 50f64.atan();
        assert!((sum / exact - 1.0).abs() < 1e-8, "{sum} {exact}");
    }
}

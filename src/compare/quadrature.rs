//! Gauss–Legendre quadrature: the integral of a smooth function from a few values.

/// How many values. Exact for polynomials of degree 39.
const NODES: usize = 20;

/// Places in 0..=1 and their weights, which sum to 1.
///
/// The zeros of the Legendre polynomial P₂₀, by Newton's method from
/// cos(π (i + 3/4) / (n + 1/2)), with weights 2 / ((1 − x²) P₂₀′(x)²), both mapped from
/// −1..=1. Source: Abramowitz and Stegun 1964, 25.4.29.
pub(super) fn nodes() -> [(f64, f64); NODES] {
    std::array::from_fn(|i| {
        let n = NODES as f64;
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        // The start is good to three digits; each step doubles them.
        for _ in 0..5 {
            let (value, slope) = legendre(x);
            x -= value / slope;
        }
        let (_, slope) = legendre(x);
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// P₂₀ and its derivative inside −1..=1, by Bonnet's recursion
/// k P_k = (2k − 1) x P_{k−1} − (k − 1) P_{k−2}.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=NODES {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, NODES as f64 * (x * value - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_degree_39_are_exact() {
        for degree in 0..2 * NODES as i32 {
            let sum: f64 = nodes().into_iter().map(|(u, weight)| weight * u.powi(degree)).sum();
            // Twenty terms of at most 1, each rounded.
            assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 1e-14, "{degree}: {sum}");
        }
        // The next one is not.
        let sum: f64 = nodes().into_iter().map(|(u, weight)| weight * (2.0 * u - 1.0).powi(40)).sum();
        assert!((sum - 1.0 / 41.0).abs() > 1e-13);
    }
}

//! Interpolation: cubics between nodes of equal distance, and Chebyshev polynomials.

pub(crate) mod chebyshev;

/// The first of the four nodes around a fractional index, of `nodes` nodes, and the weights of Lagrange's cubic through
/// them. Fewer than four are joined by straight lines: the weights beyond are 0.
pub fn cubic_stencil(index: f64, nodes: usize) -> (usize, [f64; 4]) {
    let index = index.clamp(0.0, (nodes - 1) as f64);
    if nodes < 4 {
        let base = (index as usize).min(nodes.saturating_sub(2));
        let t = index - base as f64;
        return (base, [1.0 - t, t, 0.0, 0.0]);
    }
    let base = (index as usize).clamp(1, nodes - 3) - 1;
    let t = index - base as f64;
    let weights = [
        -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
        t * (t - 2.0) * (t - 3.0) / 2.0,
        -t * (t - 1.0) * (t - 3.0) / 2.0,
        t * (t - 1.0) * (t - 2.0) / 6.0,
    ];
    (base, weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_exact_up_to_the_ends() {
        let f = |u: f64| ((2.0 * u - 3.0) * u + 0.5) * u + 1.0;
        for nodes in [4, 5, 17] {
            for u in [0.0, 0.03, 0.4, 0.77, 1.0] {
                let (base, weights) = cubic_stencil(u * (nodes - 1) as f64, nodes);
                let at = (0..4).map(|i| weights[i] * f((base + i) as f64 / (nodes - 1) as f64)).sum::<f64>();
                assert!((at - f(u)).abs() < 1e-14, "{nodes} nodes at {u}: {at}");
            }
        }
        assert_eq!(cubic_stencil(1.25, 3), (1, [0.75, 0.25, 0.0, 0.0]));
        assert_eq!(cubic_stencil(0.25, 1), (0, [1.0, 0.0, 0.0, 0.0]));
    }
}

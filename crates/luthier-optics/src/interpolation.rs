//! Interpolation between nodes of equal distance.

/// The first of the four nodes around a coordinate in 0..=1, of nodes that reach from 0 to 1, and the weights of Lagrange's cubic through
/// them. With fewer than four nodes: the first.
pub fn cubic_stencil(u: f64, nodes: usize) -> (usize, [f64; 4]) {
    if nodes < 4 {
        return (0, [1.0, 0.0, 0.0, 0.0]);
    }
    let p = u.clamp(0.0, 1.0) * (nodes - 1) as f64;
    let base = (p as usize).clamp(1, nodes - 3) - 1;
    let t = p - base as f64;
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
                let (base, weights) = cubic_stencil(u, nodes);
                let at = (0..4).map(|i| weights[i] * f((base + i) as f64 / (nodes - 1) as f64)).sum::<f64>();
                assert!((at - f(u)).abs() < 1e-14, "{nodes} nodes at {u}: {at}");
            }
        }
        assert_eq!(cubic_stencil(0.7, 3), (0, [1.0, 0.0, 0.0, 0.0]));
    }
}

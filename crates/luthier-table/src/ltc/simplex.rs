//! The simplex search of Nelder and Mead 1965.

/// Difference of the values of a simplex at which a search ends.
const SPREAD: f64 = 1e-9;
/// Most steps of one search.
const STEPS_MAX: usize = 240;

/// A local minimum of a function near the origin, from a simplex of the given edges, in at most 240 steps. It need not
/// be the global minimum.
pub(super) fn minimise<const N: usize>(edges: [f64; N], f: impl Fn([f64; N]) -> f64) -> [f64; N] {
    let mut corners: Vec<([f64; N], f64)> = (0..=N)
        .map(|i| {
            let at = std::array::from_fn(|k| if k + 1 == i { edges[k] } else { 0.0 });
            (at, f(at))
        })
        .collect();
    for _ in 0..STEPS_MAX {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        if corners[N].1 - corners[0].1 < SPREAD {
            break;
        }
        let centre: [f64; N] =
            std::array::from_fn(|k| corners[..N].iter().map(|corner| corner.0[k]).sum::<f64>() / N as f64);
        let along = |t: f64| {
            let at: [f64; N] = std::array::from_fn(|k| centre[k] + t * (corners[N].0[k] - centre[k]));
            (at, f(at))
        };
        let reflected = along(-1.0);
        let replacement = if reflected.1 < corners[0].1 {
            let expanded = along(-2.0);
            Some(if expanded.1 < reflected.1 { expanded } else { reflected })
        } else if reflected.1 < corners[N - 1].1 {
            Some(reflected)
        } else {
            let contracted = along(if reflected.1 < corners[N].1 { -0.5 } else { 0.5 });
            (contracted.1 < corners[N].1.min(reflected.1)).then_some(contracted)
        };
        match replacement {
            Some(corner) => corners[N] = corner,
            None => {
                let best = corners[0].0;
                for corner in &mut corners[1..] {
                    let at = std::array::from_fn(|k| 0.5 * (best[k] + corner.0[k]));
                    *corner = (at, f(at));
                }
            }
        }
    }
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    corners[0].0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        // Rosenbrock's function, with its minimum at (1, 1).
        let valley = |[x, y]: [f64; 2]| 100.0 * (y - x * x) * (y - x * x) + (1.0 - x) * (1.0 - x);
        let [x, y] = minimise([0.5, 0.5], valley);
        assert!((x - 1.0).abs() < 1e-3 && (y - 1.0).abs() < 1e-3, "{x} {y}");
    }
}

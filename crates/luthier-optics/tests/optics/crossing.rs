//! Light that crosses a rough dielectric and leaves upward all the same, against brute force.

use luthier_optics::albedo::{ReflectanceCurves, crossed_albedo};
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::Distribution;

use crate::albedo::{mean, same};
use crate::brute_force::{Facets, Heights, Surface, dielectric};

/// Standard error of a share of 0.05: 3e-4.
const WALKS: u32 = 1 << 19;

/// Walks of each estimate of the crate, and estimates that are averaged.
const ESTIMATE: u32 = 8192;
const SEEDS: u32 = 4;

/// Branches below a thousandth are dropped; of all light that is no more than this.
const BIAS: f64 = 2e-4;

/// (alpha, cos_theta).
const POINTS: [(f64, f64); 8] =
    [(0.1, 0.1), (0.3, 0.5), (0.5, 0.05), (0.5, 0.9), (0.7, 0.3), (1.0, 1.0), (1.0, 0.4), (1.0, 0.02)];

fn check(distribution: Distribution, n: f64) {
    let curve = ReflectanceCurves::new(1, |_, cos| dielectric(n, cos));
    let transparent = TransparentFacets { eta: n, from_above: |cos| curve.at(0, cos) };
    for (i, (alpha, cos_theta)) in POINTS.into_iter().enumerate() {
        let heights = if i % 2 == 0 { Heights::Uniform } else { Heights::Gaussian };
        let surface = Surface { slopes: same(distribution), heights, alpha, facets: Facets::Dielectric { n } };
        let shares = surface.shares(cos_theta, WALKS, 100 + i as u64);
        let estimates: Vec<f64> = (0..SEEDS)
            .map(|seed| crossed_albedo(distribution, alpha, transparent, cos_theta, ESTIMATE, seed))
            .collect();
        let (found, noise) = mean(&estimates);
        let sigma = shares.sigma(shares.crossed).hypot(noise);
        assert!(sigma < 1e-3, "{sigma}: {estimates:?} against {}", shares.crossed);
        assert!(
            (found - shares.crossed).abs() < 4.0 * sigma + BIAS,
            "{distribution:?} n {n} alpha {alpha} cos {cos_theta}: {found} against {}, sigma {sigma}",
            shares.crossed
        );
    }
}

#[test]
fn through_beckmann_facets() {
    check(Distribution::Beckmann, 1.5);
}

#[test]
fn through_ggx_facets() {
    check(Distribution::Ggx, 1.5);
}

#[test]
fn out_of_the_denser_medium() {
    check(Distribution::Ggx, 1.0 / 1.5);
}

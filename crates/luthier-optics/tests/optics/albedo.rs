//! FGD-infinity against brute-force walks.

use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves};
use luthier_optics::stack::Distribution;

use crate::brute_force::{Facets, Heights, Slopes, Surface, conductor, dielectric};

/// Standard error of a share of one half: 7e-4.
const WALKS: u32 = 1 << 19;

/// Effort of the baker on the points of its error scan.
const EFFORT: Effort = Effort { first: 24, later: 48 };

/// Estimates that are averaged; their spread is the standard error of the mean.
const SEEDS: u32 = 4;

/// Noise that walks that are cut short, and curves in nodes, may add.
const BIAS: f64 = 2e-4;

/// (alpha, cos_theta), from nearly smooth to the roughest, from the normal to grazing.
const POINTS: [(f64, f64); 8] =
    [(0.1, 1.0), (0.1, 0.1), (0.3, 0.5), (0.5, 0.05), (0.5, 0.9), (0.7, 0.3), (1.0, 1.0), (1.0, 0.02)];

/// Mean and its standard error.
pub(crate) fn mean(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

pub(crate) fn same(distribution: Distribution) -> Slopes {
    match distribution {
        Distribution::Beckmann => Slopes::Gaussian,
        Distribution::Ggx => Slopes::Ellipsoid,
        other => panic!("no oracle of {}", other.name()),
    }
}

fn check(distribution: Distribution, facets: Facets, reflectance: impl Fn(f64) -> f64) {
    let curves = ReflectanceCurves::new(1, |_, cos| reflectance(cos));
    for (i, (alpha, cos_theta)) in POINTS.into_iter().enumerate() {
        let heights = if i % 2 == 0 { Heights::Gaussian } else { Heights::Uniform };
        let surface = Surface { slopes: same(distribution), heights, alpha, facets };
        let shares = surface.shares(cos_theta, WALKS, i as u64);
        let statistics = (0..SEEDS).map(|s| FacetStatistics::new(distribution, alpha, cos_theta, EFFORT, s));
        let (single, albedos): (Vec<f64>, Vec<f64>) =
            statistics.map(|s| (s.single_scattering(&curves)[0], s.albedo(&curves)[0])).unzip();
        for (what, values, share) in [("one bounce", single, shares.once), ("all", albedos, shares.never_crossed)] {
            let (found, noise) = mean(&values);
            let sigma = shares.sigma(share).hypot(noise);
            assert!(sigma < 1e-3);
            let error = (found - share).abs();
            assert!(
                error < 4.0 * sigma + BIAS,
                "{distribution:?} {facets:?} alpha {alpha} cos {cos_theta}, {what}: {found} against {share}, sigma {sigma}"
            );
        }
    }
}

#[test]
fn a_perfect_reflector_of_beckmann_facets() {
    check(Distribution::Beckmann, Facets::Mirror, |_| 1.0);
}

#[test]
fn a_perfect_reflector_of_ggx_facets() {
    check(Distribution::Ggx, Facets::Mirror, |_| 1.0);
}

#[test]
fn a_conductor_of_beckmann_facets() {
    check(Distribution::Beckmann, Facets::Conductor { n: 3.2, k: 3.3 }, |cos| conductor(3.2, 3.3, cos));
}

#[test]
fn a_conductor_of_ggx_facets() {
    check(Distribution::Ggx, Facets::Conductor { n: 3.2, k: 3.3 }, |cos| conductor(3.2, 3.3, cos));
}

#[test]
fn a_dielectric_of_beckmann_facets() {
    check(Distribution::Beckmann, Facets::Dielectric { n: 1.5 }, |cos| dielectric(1.5, cos));
}

#[test]
fn a_dielectric_of_ggx_facets() {
    check(Distribution::Ggx, Facets::Dielectric { n: 1.5 }, |cos| dielectric(1.5, cos));
}

/// Below a medium of lesser index light is totally reflected beyond an angle: a kink that quadrature has to resolve.
#[test]
fn the_first_bounce_out_of_the_denser_medium() {
    let n = 1.0 / 1.5;
    let curves = ReflectanceCurves::new(1, |_, cos| dielectric(n, cos));
    for distribution in [Distribution::Beckmann, Distribution::Ggx] {
        for (i, (alpha, cos_theta)) in POINTS.into_iter().enumerate() {
            let surface = Surface {
                slopes: same(distribution),
                heights: Heights::Uniform,
                alpha,
                facets: Facets::Dielectric { n },
            };
            let share = surface.shares(cos_theta, WALKS / 4, 200 + i as u64);
            let effort = Effort { first: 128, later: 0 };
            let found = FacetStatistics::new(distribution, alpha, cos_theta, effort, 0).single_scattering(&curves)[0];
            let limit = 4.0 * share.sigma(share.once) + BIAS;
            assert!((found - share.once).abs() < limit, "{distribution:?} {alpha} {cos_theta}: {found} {}", share.once);
        }
    }
}

/// The oracle itself: a result that depends on the distribution of heights would be wrong (Heitz et al. 2016, section 4).
#[test]
fn heights_do_not_matter() {
    let shares = |heights| {
        let facets = Facets::Dielectric { n: 1.5 };
        Surface { slopes: Slopes::Ellipsoid, heights, alpha: 0.8, facets }.shares(0.4, WALKS, 7)
    };
    let (a, b) = (shares(Heights::Gaussian), shares(Heights::Uniform));
    for (a, b) in [(a.once, b.once), (a.never_crossed, b.never_crossed), (a.crossed, b.crossed)] {
        assert!((a - b).abs() < 4.0 * 2f64.sqrt() * shares(Heights::Uniform).sigma(a), "{a} {b}");
    }
}

//! Albedos of one interface against those of `luthier_optics::albedo`, from quadrature and low-discrepancy walks.

use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, Side};
use luthier_layers::references::random_walk::RandomWalk;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves, crossed_albedo};
use luthier_optics::fresnel::interface;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::Surface;
use num_complex::Complex64;

use crate::scenes::{BOTH, assert_agrees, at, conductor, cosine, dielectric, evenly, mc, mean_of};

const EFFORT: Effort = Effort { first: 32, later: 48 };

/// Accuracy of the other formulation, about.
const SLACK: f64 = 2e-4;

fn curve(ior: Complex64) -> ReflectanceCurves {
    ReflectanceCurves::new(1, move |_, cos| interface(Complex64::new(1.0, 0.0), ior, cos).unpolarised())
}

#[test]
fn conductors_reflect_what_facet_statistics_say() {
    let ior = Complex64::new(3.2, 3.3);
    for d in BOTH {
        for alpha in [0.1, 0.5, 1.0] {
            let metal = Monochrome::bare(&[(Surface::isotropic(d, alpha), conductor(ior.re, ior.im))]);
            for theta in [0.0, 60.0, 85.0] {
                let wo = at(theta, 0.0);
                let expected = FacetStatistics::new(d, alpha, wo.z, EFFORT, 0).albedo(&curve(ior))[0];
                let albedo = mc(InterfaceMode::SmithWalk, 0).albedo(&metal, wo, 40_000);
                assert_agrees(albedo.loosened(SLACK), expected, 1e-3, &format!("{d:?} {alpha} {theta}"));
            }
        }
    }
}

#[test]
fn values_of_a_conductor_integrate_to_its_facet_statistics() {
    let ior = Complex64::new(3.2, 3.3);
    for d in BOTH {
        let alpha = 0.7;
        let metal = Monochrome::bare(&[(Surface::isotropic(d, alpha), conductor(ior.re, ior.im))]);
        let wo = at(50.0, 30.0);
        let expected = FacetStatistics::new(d, alpha, wo.z, EFFORT, 0).albedo(&curve(ior))[0];
        let each = |i: u64| {
            let wi = cosine(evenly(i));
            let walks = RandomWalk { samples: 1, seed: i };
            walks.density(&metal.layers[0], (Side::Above, wo), (Side::Above, wi)).mean * std::f64::consts::PI / wi.z
        };
        let values: Vec<f64> = (0..100_000).map(each).collect();
        assert_agrees(mean_of(&values), expected, 3e-3, &format!("{d:?}"));
    }
}

#[test]
fn dielectrics_split_light_as_crossing_walks_say() {
    let n = 1.5;
    let fresnel = curve(Complex64::new(n, 0.0));
    for d in BOTH {
        for alpha in [0.2, 0.8] {
            let glass = Monochrome::bare(&[(Surface::isotropic(d, alpha), dielectric(n, 0.0))]);
            for theta in [0.0, 60.0, 85.0] {
                let wo = at(theta, 0.0);
                let facets = TransparentFacets { eta: n, from_above: |cos| fresnel.at(0, cos) };
                let expected = FacetStatistics::new(d, alpha, wo.z, EFFORT, 0).albedo(&fresnel)[0]
                    + crossed_albedo(d, alpha, facets, wo.z, 4096, 1);
                let walks = RandomWalk { samples: 150_000, seed: 3 };
                let (back, through) = walks.albedo(&glass.layers[0], Side::Above, wo);
                assert!((back.mean + through.mean - 1.0).abs() < 1e-9);
                assert_agrees(back.loosened(SLACK), expected, 1.5e-3, &format!("{d:?} {alpha} {theta}"));
            }
        }
    }
}

#[test]
fn transmitted_values_integrate_to_the_transmitted_share_from_both_sides() {
    let glass = Monochrome::bare(&[(Surface::isotropic(BOTH[1], 0.6), dielectric(1.5, 0.0))]);
    for (side, theta) in [(Side::Above, 50.0), (Side::Below, 30.0), (Side::Below, 60.0)] {
        let a = (side, at(theta, 0.0));
        let shares = RandomWalk { samples: 100_000, seed: 1 }.albedo(&glass.layers[0], a.0, a.1);
        for (to, share) in [(side, shares.0), (side.other(), shares.1)] {
            let each = |i: u64| {
                let b = cosine(evenly(i));
                RandomWalk { samples: 1, seed: i }.density(&glass.layers[0], a, (to, b)).mean * std::f64::consts::PI
                    / b.z
            };
            let values: Vec<f64> = (0..60_000).map(each).collect();
            let integral = mean_of(&values).loosened(share.std_err);
            assert_agrees(integral, share.mean, 1.2e-2, &format!("{side:?} {theta} to {to:?}"));
        }
    }
}

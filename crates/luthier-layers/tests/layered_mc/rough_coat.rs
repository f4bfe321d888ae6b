//! Rough coats on Lambertian bases against a series of diffuse bounces.
//!
//! The albedo of the interface from above comes from `luthier_optics::albedo` (quadrature over first facets and
//! low-discrepancy walks, which the reference does not use); its share of diffuse light from below follows by
//! reciprocity, `1 - (1 - mean from above) / n^2`.

use std::f64::consts::PI;

use luthier_layers::model::Estimate;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, Side};
use luthier_layers::references::random_walk::RandomWalk;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves, crossed_albedo};
use luthier_optics::fresnel::interface;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use crate::scenes::{assert_agrees, at, dielectric, ggx, lambert, mc};

struct Coat {
    distribution: Distribution,
    alpha: f64,
    n: f64,
    curve: ReflectanceCurves,
}

impl Coat {
    fn new(distribution: Distribution, alpha: f64, n: f64) -> Self {
        let fresnel = |_, cos| interface(Complex64::new(1.0, 0.0), Complex64::new(n, 0.0), cos).unpolarised();
        Self { distribution, alpha, n, curve: ReflectanceCurves::new(1, fresnel) }
    }

    /// Share of the light from above that leaves upward without the base.
    fn reflects(&self, cos: f64) -> f64 {
        let effort = Effort { first: 24, later: 32 };
        let facets = TransparentFacets { eta: self.n, from_above: |cos| self.curve.at(0, cos) };
        FacetStatistics::new(self.distribution, self.alpha, cos, effort, 0).albedo(&self.curve)[0]
            + crossed_albedo(self.distribution, self.alpha, facets, cos, 2048, 1)
    }

    /// Share of diffuse light from below that it sends back.
    fn reflects_inside(&self) -> f64 {
        let mean: f64 = gauss_legendre(12).into_iter().map(|(cos, w)| 2.0 * cos * w * self.reflects(cos)).sum();
        1.0 - (1.0 - mean) / (self.n * self.n)
    }
}

/// Noise of the other formulation.
const NOISE: f64 = 2e-4;

#[test]
fn albedo_is_a_series_of_diffuse_bounces() {
    for (d, alpha, rho) in
        [(Distribution::Ggx, 0.3, 0.8), (Distribution::Ggx, 0.8, 0.5), (Distribution::Beckmann, 0.5, 0.8)]
    {
        let coat = Coat::new(d, alpha, 1.5);
        let inside = coat.reflects_inside();
        let coated =
            Monochrome::bare(&[(Surface::isotropic(d, alpha), dielectric(1.5, 0.0)), (ggx(0.0), lambert(rho))]);
        for theta in [0.0, 60.0, 80.0] {
            let wo = at(theta, 0.0);
            let r = coat.reflects(wo.z);
            let expected = r + (1.0 - r) * rho * (1.0 - inside) / (1.0 - rho * inside);
            let albedo = mc(InterfaceMode::SmithWalk, 0).albedo(&coated, wo, 320_000);
            assert_agrees(albedo.loosened(NOISE), expected, 1e-3, &format!("{d:?} {alpha} {theta}"));
        }
    }
}

#[test]
fn value_is_the_interface_plus_a_diffuse_part() {
    let (alpha, n, rho) = (0.3, 1.5, 0.8);
    let coat = Coat::new(Distribution::Ggx, alpha, n);
    let inside = coat.reflects_inside();
    let coated = Monochrome::bare(&[(ggx(alpha), dielectric(n, 0.0)), (ggx(0.0), lambert(rho))]);
    for (wi, wo) in [(at(20.0, 0.0), at(60.0, 50.0)), (at(45.0, 0.0), at(40.0, 175.0)), (at(80.0, 0.0), at(10.0, 0.0))]
    {
        let through = (1.0 - coat.reflects(wi.z)) * (1.0 - coat.reflects(wo.z));
        let diffuse = through * rho / (PI * n * n * (1.0 - rho * inside)) * wi.z;
        let walks = RandomWalk { samples: 250_000, seed: 2 };
        let top = walks.density(&coated.layers[0], (Side::Above, wo), (Side::Above, wi));
        let value = mc(InterfaceMode::SmithWalk, 150_000).estimate(&coated, wi, wo);
        let both = Estimate::sum([(1.0, value), (-1.0, top)]).loosened(1e-4);
        assert_agrees(both, diffuse, 1e-3, &format!("{wi} {wo}"));
    }
}

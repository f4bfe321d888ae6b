//! One facet per event against formulas and quadrature written here.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::InterfaceMode;
use luthier_optics::fresnel::interface;
use luthier_optics::microfacet::{distribution, lambda};
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use crate::scenes::{BOTH, assert_agrees, at, conductor, dielectric, ggx, lambert, mc};

#[test]
fn one_interface_is_torrance_and_sparrow() {
    let ior = Complex64::new(0.2, 3.5);
    for d in BOTH {
        for alpha in [0.02, 0.3, 1.0] {
            for (wi, wo) in [(at(30.0, 0.0), at(32.0, 178.0)), (at(70.0, 10.0), at(50.0, 150.0))] {
                let wh = (wi + wo).normalize();
                let sin_sq = wh.x * wh.x + wh.y * wh.y;
                let fresnel = interface(Complex64::new(1.0, 0.0), ior, wo.dot(wh)).unpolarised();
                let g2 = 1.0 / (1.0 + lambda(d, alpha, wi.z) + lambda(d, alpha, wo.z));
                let expected = distribution(d, alpha, wh.z, sin_sq) * fresnel * g2 / (4.0 * wo.z);
                let metal = Monochrome::bare(&[(Surface::isotropic(d, alpha), conductor(0.2, 3.5))]);
                let value = mc(InterfaceMode::OneFacet, 3).estimate(&metal, wi, wo);
                assert!((value.mean - expected).abs() <= 1e-9 * expected, "{d:?} {alpha}: {value:?} {expected}");
            }
        }
    }
}

/// Shares of the light from a direction that one facet of a GGX interface reflects and transmits, by quadrature over
/// facet normals in polar slopes.
fn shares(alpha: f64, above: f64, below: f64, cos: f64) -> [f64; 2] {
    let d = Distribution::Ggx;
    let w = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let g1_inverse = 1.0 + lambda(d, alpha, cos);
    let (radii, phis) = (600, 200);
    let mut sums = [0.0; 2];
    for i in 0..radii {
        // With slope radius alpha sqrt(u / (1 - u)), D cos is uniform in u.
        let u = (f64::from(i) + 0.5) / f64::from(radii);
        let slope = alpha * (u / (1.0 - u)).sqrt();
        for j in 0..phis {
            let phi = (f64::from(j) + 0.5) / f64::from(phis) * PI;
            let m = DVec3::new(slope * phi.cos(), slope * phi.sin(), 1.0).normalize();
            let cos_d = w.dot(m);
            if cos_d <= 0.0 {
                continue;
            }
            let visible = cos_d / (m.z * cos * g1_inverse) / f64::from(radii * phis);
            let f = interface(Complex64::new(above, 0.0), Complex64::new(below, 0.0), cos_d).unpolarised();
            let reflected = 2.0 * cos_d * m - w;
            if reflected.z > 0.0 {
                sums[0] += visible * f * g1_inverse / (g1_inverse + lambda(d, alpha, reflected.z.min(1.0)));
            }
            let eta = above / below;
            let sin_t_sq = eta * eta * (1.0 - cos_d * cos_d);
            if sin_t_sq < 1.0 {
                let refracted = m * (cos_d * eta - (1.0 - sin_t_sq).sqrt()) - w * eta;
                if refracted.z < 0.0 {
                    sums[1] +=
                        visible * (1.0 - f) * g1_inverse / (g1_inverse + lambda(d, alpha, (-refracted.z).min(1.0)));
                }
            }
        }
    }
    sums
}

#[test]
fn rough_coat_on_lambert_by_quadrature() {
    // Below the coat the light is diffuse after each bounce of the base: the stack is a geometric series of
    // hemispherical shares.
    let (alpha, n, rho) = (0.4, 1.5, 0.8);
    let steps = 60;
    let mut inside = [0.0; 2];
    for k in 0..steps {
        let cos = (f64::from(k) + 0.5) / f64::from(steps);
        let [r, t] = shares(alpha, n, 1.0, cos);
        inside[0] += 2.0 * cos * r / f64::from(steps);
        inside[1] += 2.0 * cos * t / f64::from(steps);
    }
    let coated = Monochrome::bare(&[(ggx(alpha), dielectric(n, 0.0)), (ggx(0.0), lambert(rho))]);
    for theta in [0.0, 45.0, 75.0] {
        let wo = at(theta, 0.0);
        let [r, t] = shares(alpha, 1.0, n, wo.z);
        let expected = r + t * rho * inside[1] / (1.0 - rho * inside[0]);
        let albedo = mc(InterfaceMode::OneFacet, 0).albedo(&coated, wo, 200_000);
        // The quadrature is good to about 2e-4.
        assert_agrees(albedo.loosened(5e-5), expected, 1e-3, &format!("{theta}"));
    }
}

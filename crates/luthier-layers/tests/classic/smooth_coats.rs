//! Smooth coats: the corrected model against closed forms, the faithful one against the measure of its errors.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::formulas::facets::Facets;
use luthier_layers::formulas::oren_nayar;
use luthier_layers::luthier_model::{InternalReflection, Masking, PathParts};
use luthier_layers::model::Model;
use luthier_layers::models::elek::Elek;
use luthier_layers::models::microfacet::{Components, Microfacet};
use luthier_layers::models::weidlich_wilkie::corrected::WeidlichWilkieCorrected;
use luthier_layers::models::weidlich_wilkie::{Refraction, WeidlichWilkie};
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};

use crate::sphere::{albedo, at, mirrored};
use crate::stacks::{WHITE, dielectric, ggx, lambert};

/// Tolerance of the quadrature and of the finite width (1e-4) of "smooth" lobes.
const TOLERANCE: f64 = 3e-4;

const N_SQ: f64 = 2.25;

/// Fresnel at 45 degrees, n = 1.5.
const F_45: f64 = 0.0502399110;

fn coat(optical_depth: f64) -> (luthier_optics::stack::Surface, luthier_layers::monochrome::MonochromeBelow) {
    (ggx(0.0), dielectric(1.5, optical_depth))
}

fn over_mirror(optical_depth: f64) -> Monochrome {
    Monochrome::bare(&[coat(optical_depth), (ggx(0.0), WHITE)])
}

fn over_lambert(rho: f64) -> Monochrome {
    Monochrome::bare(&[coat(0.0), (ggx(0.0), lambert(rho))])
}

/// Albedo with what lies below the first interface divided by n^2.
fn compressed(model: &dyn Model, stack: &Monochrome, theta_deg: f64) -> f64 {
    let top =
        albedo(&Microfacet::new(Components { masking: Masking::VCavity, ..Components::PLAIN }), stack, at(theta_deg));
    top + (albedo(model, stack, at(theta_deg)) - top) / N_SQ
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() < tolerance, "{found} {expected}");
}

/// Oracle: F + (1-F)^2 a/(1 - F a), a = exp(-2 sigma d/cos_theta_t), n = 1.5 at 45 degrees.
#[test]
fn the_corrected_model_is_exact_for_a_coated_mirror() {
    let model = WeidlichWilkieCorrected;
    for (optical_depth, expected) in [(0.0, 1.0), (0.1, 0.7992518131), (1.0, 0.1441269347)] {
        close(albedo(&model, &over_mirror(optical_depth), at(45.0)), expected, TOLERANCE);
    }
}

/// Oracle: f = Ti To rho/(pi n^2 (1 - rho Fbar_i)) pointwise; Fbar_i from its closed form.
#[test]
fn the_corrected_model_is_exact_for_coated_lambert_surfaces() {
    let model = WeidlichWilkieCorrected;
    // At normal incidence and 45 degrees off the mirror direction, where the coat's lobe is nothing.
    let (wi, wo) = (at(0.0), at(45.0));
    for (rho, whole) in [(0.18, 0.11813908), (0.5, 0.31607089), (0.8, 0.63283341), (1.0, 1.0)] {
        let expected = 0.96 * (1.0 - F_45) * rho / (PI * N_SQ * (1.0 - rho * 0.5963457597));
        close(model.eval(&over_lambert(rho), wi, wo) / expected, 1.0, 1e-6);
        close(albedo(&model, &over_lambert(rho), at(0.0)), whole, TOLERANCE);
    }
}

/// Two coats on a white base: everything comes back, whatever lies between.
#[test]
fn the_corrected_model_keeps_energy_through_two_smooth_coats() {
    let model = WeidlichWilkieCorrected;
    for base in [WHITE, lambert(1.0)] {
        for (upper, lower) in [(1.3, 1.7), (1.7, 1.3)] {
            let two = Monochrome::bare(&[
                (ggx(0.0), dielectric(upper, 0.0)),
                (ggx(0.0), dielectric(lower, 0.0)),
                (ggx(0.0), base),
            ]);
            for theta in [0.0, 50.0] {
                // Light does not reach a lower medium beyond its critical angle: 1.7 to 1.3 has none from air.
                close(albedo(&model, &two, at(theta)), 1.0, TOLERANCE);
            }
        }
    }
}

/// Reference numbers for eq. 3.1: smooth n = 1.5 over white GGX of alpha 0.1 returns 1.968 at normal incidence, 0.897 with 1/n^2, when
/// transmission is taken at the angle of each direction. By the letter, at the half vector and with `t`, it is a little more (the
/// integral in Python: 1.9807 and 0.9025).
#[test]
fn the_faithful_model_lacks_one_over_n_squared() {
    let stack = Monochrome::bare(&[coat(0.0), (ggx(0.1), WHITE)]);
    let directions = WeidlichWilkie {
        parts: PathParts { internal_reflection: InternalReflection::Directions, ..PathParts::PLAIN },
        ..WeidlichWilkie::default()
    };
    close(albedo(&directions, &stack, at(0.0)), 1.968, 1e-3);
    close(compressed(&directions, &stack, 0.0), 0.897, 1e-3);
    close(albedo(&WeidlichWilkie::default(), &stack, at(0.0)), 1.9807, 5e-4);
    close(compressed(&WeidlichWilkie::default(), &stack, 0.0), 0.9025, 5e-4);
    // Without a roughness clamp to act, the real-time form is the same.
    close(albedo(&Elek::default(), &stack, at(0.0)), 1.9807, 5e-4);
}

/// F + (1-F)^2 at 45 degrees instead of 1, and n^2 times the second part as printed.
#[test]
fn the_faithful_model_lacks_inner_bounces() {
    let model = WeidlichWilkie::default();
    let passed = (1.0 - F_45) * (1.0 - F_45);
    close(compressed(&model, &over_mirror(0.0), 45.0), 0.952, 5e-4);
    close(albedo(&model, &over_mirror(0.0), at(45.0)), F_45 + N_SQ * passed, 1e-3);
}

/// Refraction at the half vector leaves it where it is: a mirror below then keeps its lobe's solid angle at the normal, and
/// loses a third of its light at 45 degrees.
#[test]
fn refraction_at_the_half_vector_is_no_better() {
    let model = WeidlichWilkie { refraction: Refraction::Facet, ..WeidlichWilkie::default() };
    close(albedo(&model, &over_mirror(0.0), at(0.0)), 0.04 + 0.96 * 0.96, TOLERANCE);
    close(albedo(&model, &over_mirror(0.0), at(45.0)), 0.630, 1e-3);
}

/// A coat with the index of air, and a black base: neither adds anything.
#[test]
fn limits() {
    let (wi, wo) = (at(30.0), mirrored(at(40.0)));
    let corrected = WeidlichWilkieCorrected;
    let models: [&dyn Model; 2] = [&WeidlichWilkie::default(), &corrected];
    for model in models {
        let bare = Monochrome::bare(&[(ggx(0.3), WHITE)]);
        let coated = Monochrome::bare(&[(ggx(0.1), dielectric(1.0, 0.0)), (ggx(0.3), WHITE)]);
        close(model.eval(&coated, wi, wo) / model.eval(&bare, wi, wo), 1.0, 1e-12);
        let black = Monochrome::bare(&[(ggx(0.3), dielectric(1.5, 1e4)), (ggx(0.3), WHITE)]);
        let top = Microfacet::new(Components { masking: Masking::VCavity, ..Components::PLAIN }).eval(&black, wi, wo);
        close(model.eval(&black, wi, wo) / top, 1.0, 1e-12);
    }
}

/// Oracle: eq. 3.1 as the recursion that it is, each layer's f its own BRDF, with 3.2 and 3.3; three interfaces and an Oren-Nayar
/// base, two absorbing slabs of different thickness.
#[test]
fn many_layers_are_the_recursion_of_the_course() {
    fn recursion(stack: &Monochrome, k: usize, wi: DVec3, wo: DVec3) -> f64 {
        let layer = &stack.layers[k];
        if let MonochromeBelow::Diffuse { albedo, sigma } = layer.below {
            return oren_nayar::brdf_scalar(albedo, sigma, wi, wo);
        }
        let wh = (wi + wo).normalize();
        let g = (2.0 * wh.z * wi.z / wo.dot(wh)).min(2.0 * wh.z * wo.z / wo.dot(wh)).min(1.0);
        let f = layer.reflectance(wo.dot(wh));
        let own = f * Facets::new(&layer.surface).density(wh) * g / (4.0 * wi.z * wo.z);
        let MonochromeBelow::Dielectric { ior, optical_depth, .. } = layer.below else { return own };
        let n = ior / layer.above;
        let refract = |w: DVec3| DVec3::new(w.x / n, w.y / n, (1.0 - (1.0 - w.z * w.z) / (n * n)).sqrt());
        let (wi, wo) = (refract(wi), refract(wo));
        let a = (-optical_depth * (1.0 / wi.z + 1.0 / wo.z)).exp();
        let t = (1.0 - g) + (1.0 - f) * g;
        own + (1.0 - f) * recursion(stack, k + 1, wi, wo) * a * t
    }
    let base = MonochromeBelow::Diffuse { albedo: 0.7, sigma: 0.4 };
    let layers = [(ggx(0.4), dielectric(1.3, 0.3)), (ggx(0.2), dielectric(1.7, 0.1)), (ggx(0.5), dielectric(1.4, 0.6))];
    let stack = Monochrome::bare(&[layers[0], layers[1], layers[2], (ggx(0.0), base)]);
    for (i, o) in [(10.0, 30.0), (50.0, 20.0), (70.0, 80.0)] {
        let (wi, wo) = (at(i), mirrored(at(o)));
        let expected = recursion(&stack, 0, wi, wo) * wi.z;
        close(WeidlichWilkie::default().eval(&stack, wi, wo) / expected, 1.0, 1e-12);
    }
}

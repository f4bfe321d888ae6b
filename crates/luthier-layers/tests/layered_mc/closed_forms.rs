//! Smooth coats against closed forms (physics reference, section E).

use std::f64::consts::PI;

use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::InterfaceMode;
use luthier_optics::fresnel::{dielectric_average, interface};
use luthier_optics::stack::Surface;
use num_complex::Complex64;

use crate::scenes::{assert_agrees, at, conductor, cosine, dielectric, evenly, ggx, lambert, mc, mean_of, mirror};

const N: f64 = 1.5;

fn fresnel(cos: f64) -> f64 {
    interface(Complex64::new(1.0, 0.0), Complex64::new(N, 0.0), cos).unpolarised()
}

fn coated_lambert(rho: f64) -> Monochrome {
    Monochrome::bare(&[(Surface::smooth(), dielectric(N, 0.0)), (Surface::smooth(), lambert(rho))])
}

#[test]
fn smooth_coat_on_lambert_albedo_at_normal_incidence() {
    let oracle = [(0.18, 0.11813908), (0.5, 0.31607089), (0.8, 0.63283341), (1.0, 1.0)];
    for (rho, expected) in oracle {
        let albedo = mc(InterfaceMode::SmithWalk, 0).albedo(&coated_lambert(rho), at(0.0, 0.0), 200_000);
        assert_agrees(albedo, expected, 1e-3, &format!("rho {rho}"));
    }
}

#[test]
fn smooth_coat_on_lambert_albedo_of_diffuse_light() {
    for (rho, expected) in [(0.18, 0.16570257), (0.5, 0.35295886), (0.8, 0.65263668), (1.0, 1.0)] {
        let coated = coated_lambert(rho);
        let each = |i: u64| {
            let mc = luthier_layers::references::layered_mc::LayeredMc { seed: i, ..mc(InterfaceMode::SmithWalk, 0) };
            mc.albedo(&coated, cosine(evenly(i)), 4).mean
        };
        let values: Vec<f64> = (0..80_000).map(each).collect();
        assert_agrees(mean_of(&values), expected, 1e-3, &format!("rho {rho}"));
    }
}

#[test]
fn smooth_coat_on_lambert_value() {
    let rho = 0.8;
    let inside = 1.0 - (1.0 - dielectric_average(N)) / (N * N);
    for (i, o) in [(0.0, 0.0), (30.0, 60.0), (75.0, 45.0), (85.0, 85.0)] {
        let (wi, wo) = (at(i, 20.0), at(o, 190.0));
        let f = (1.0 - fresnel(wi.z)) * (1.0 - fresnel(wo.z)) * rho / (PI * N * N * (1.0 - rho * inside));
        let value = mc(InterfaceMode::SmithWalk, 100_000).estimate(&coated_lambert(rho), wi, wo);
        assert_agrees(value, f * wi.z, 1e-3, &format!("{i} {o}"));
    }
}

#[test]
fn smooth_coat_on_a_mirror_with_absorption() {
    let formula = |cos: f64, depth: f64| {
        let cos_t = (1.0 - (1.0 - cos * cos) / (N * N)).sqrt();
        let (f, a) = (fresnel(cos), (-2.0 * depth / cos_t).exp());
        f + (1.0 - f) * (1.0 - f) * a / (1.0 - f * a)
    };
    // The printed digits first, then the formula elsewhere.
    assert!((formula(at(45.0, 0.0).z, 0.1) - 0.7992518131).abs() < 1e-9);
    assert!((formula(at(45.0, 0.0).z, 1.0) - 0.1441269347).abs() < 1e-9);
    for theta in [0.0, 45.0, 70.0, 85.0] {
        for depth in [0.0, 0.1, 1.0] {
            let coated = Monochrome::bare(&[(Surface::smooth(), dielectric(N, depth)), (Surface::smooth(), mirror())]);
            let wo = at(theta, 30.0);
            let albedo = mc(InterfaceMode::SmithWalk, 0).albedo(&coated, wo, 250_000);
            assert_agrees(albedo, formula(wo.z, depth), 1e-3, &format!("{theta} {depth}"));
        }
    }
}

#[test]
fn two_smooth_interfaces_are_a_series() {
    // Coat, second coat and Lambertian base: the two interfaces as one plate of incoherent bounces.
    let (n1, n2, rho) = (1.3, 1.7, 0.6);
    let base = Monochrome::bare(&[
        (Surface::smooth(), dielectric(n1, 0.0)),
        (Surface::smooth(), dielectric(n2, 0.0)),
        (Surface::smooth(), lambert(rho)),
    ]);
    let reflectance =
        |a: f64, b: f64, cos: f64| interface(Complex64::new(a, 0.0), Complex64::new(b, 0.0), cos).unpolarised();
    let plate = |cos: f64| {
        let cos_1 = (1.0 - (1.0 - cos * cos) / (n1 * n1)).sqrt();
        let (r1, r2) = (reflectance(1.0, n1, cos), reflectance(n1, n2, cos_1));
        (1.0 - r1) * (1.0 - r2) / (1.0 - r1 * r2)
    };
    // Light from inside, mean over the cosine, through the plate: by reciprocity that of light from outside over n2
    // squared.
    let steps = 20_000;
    let through: f64 = (0..steps)
        .map(|k| (f64::from(k) + 0.5) / f64::from(steps))
        .map(|cos| 2.0 * cos * plate(cos) / f64::from(steps))
        .sum();
    let out = through / (n2 * n2);
    let (wi, wo) = (at(50.0, 0.0), at(20.0, 120.0));
    let f = plate(wi.z) * plate(wo.z) * rho / (PI * n2 * n2 * (1.0 - rho * (1.0 - out)));
    let value = mc(InterfaceMode::SmithWalk, 100_000).estimate(&base, wi, wo);
    assert_agrees(value, f * wi.z, 1e-3, "two coats");
}

#[test]
fn a_smooth_coat_of_the_index_of_air_is_not_there() {
    // Estimates of one event against estimates of three, two of them smooth.
    let base = Monochrome::bare(&[(ggx(0.3), conductor(0.2, 3.5))]);
    let nearly = Monochrome::bare(&[(Surface::smooth(), dielectric(1.0 + 1e-7, 0.0)), (ggx(0.3), conductor(0.2, 3.5))]);
    let (wi, wo) = (at(30.0, 0.0), at(40.0, 170.0));
    let mc = mc(InterfaceMode::SmithWalk, 100_000);
    let (bare, coated) = (mc.estimate(&base, wi, wo), mc.estimate(&nearly, wi, wo));
    let sigma = bare.std_err.hypot(coated.std_err);
    assert!((bare.mean - coated.mean).abs() < 4.0 * sigma && sigma < 1e-2 * bare.mean, "{bare:?} {coated:?}");
}

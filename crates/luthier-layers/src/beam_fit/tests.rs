//! Oracle: values of the model itself, at one wavelength for each channel, which the fit does not call.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use super::*;
use crate::model::Model;
use crate::models::granier_heidrich::GranierHeidrich;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// A film of an index, or a layer, on a dielectric over a diffuse base.
fn stack(index: f64, waves: Option<f64>, albedo: f64) -> Monochrome {
    let films = waves.map(|waves| FilmLayer { ior: Complex64::new(index, 0.0), waves }).into_iter().collect();
    let ior = if waves.is_some() { 2.2 } else { index };
    let surface = Surface::isotropic(Distribution::Ggx, 0.3);
    let layer = |films, below| MonochromeLayer { surface, above: 1.0, films, below, f0: None };
    let coat =
        layer(films, MonochromeBelow::Dielectric { ior, complex_ior: Complex64::new(ior, 0.0), optical_depth: 0.0 });
    Monochrome::joined(1.0, vec![coat, layer(Vec::new(), MonochromeBelow::Diffuse { albedo, sigma: 0.0 })])
}

/// Directions over the hemisphere, and around the mirror direction, for a few directions of light.
fn pairs() -> Vec<(DVec3, DVec3)> {
    let unit = |theta: f64, phi: f64| {
        let ((sin, cos), (sin_phi, cos_phi)) = (libm::sincos(theta), libm::sincos(phi));
        DVec3::new(sin * cos_phi, sin * sin_phi, cos)
    };
    let mut pairs = Vec::new();
    for theta_i in [0.1f64, 0.5, 0.9, 1.2] {
        let wi = unit(theta_i, 0.4);
        for i in 0..7 {
            for j in 0..12 {
                pairs.push((wi, unit(0.05 + 0.2 * f64::from(i), f64::from(j) * 0.53)));
                let near = unit(theta_i + 0.08 * (f64::from(i) - 3.0), 0.4 + std::f64::consts::PI);
                pairs.push((wi, (near + 0.02 * f64::from(j) * DVec3::new(-0.39, 0.92, 0.0)).normalize()));
            }
        }
    }
    pairs.retain(|(_, wo)| wo.z > 0.02);
    pairs
}

fn lobe(eval: impl Fn(DVec3, DVec3, usize) -> f64) -> Vec<Sample> {
    let value = |(wi, wo): (DVec3, DVec3)| Sample { wi, wo, value: [0, 1, 2].map(|c: usize| eval(wi, wo, c)) };
    pairs().into_iter().map(value).collect()
}

fn near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < tolerance * b.abs()), "{found:?} {expected:?}");
}

#[test]
fn numbers_of_a_leaning_layer_come_back() {
    let (index, albedo): (Rgb, Rgb) = ([1.4, 1.45, 1.6], [0.5, 0.3, 0.1]);
    let inner_normal = DVec3::new(0.2, -0.1, 1.0).normalize();
    let model = GranierHeidrich {
        exponents: Some([90.0, 170.0]),
        inner_normal,
        specular_weight: 0.8,
        ..GranierHeidrich::default()
    };
    let samples = lobe(|wi, wo, c| model.eval(&stack(index[c], None, albedo[c]), wi, wo));
    let fitted = fit(&samples, &Form { wavelengths_nm: WAVELENGTHS_NM, thickness_nm: None, leans: true }).unwrap();
    assert!(fitted.rms_err < 1e-6 && fitted.lobe_err < 1e-6, "{fitted:?}");
    near(&fitted.index, &index, 1e-4);
    near(&fitted.exponents, &[90.0, 170.0], 1e-3);
    near(&fitted.lean, &[0.2, -0.1], 1e-3);
    near(&fitted.diffuse, &albedo, 1e-4);
    near(&[fitted.specular_weight], &[0.8], 1e-3);
}

#[test]
fn numbers_of_a_film_come_back() {
    let (index, albedo): (Rgb, Rgb) = ([1.5, 1.6, 1.8], [0.5, 0.5, 0.4]);
    let model = GranierHeidrich { exponents: Some([60.0, 20.0]), diffuse_weight: 0.5, ..GranierHeidrich::default() };
    let samples = lobe(|wi, wo, c| model.eval(&stack(index[c], Some(180.0 / WAVELENGTHS_NM[c]), albedo[c]), wi, wo));
    let form = Form { wavelengths_nm: WAVELENGTHS_NM, thickness_nm: Some([50.0, 400.0]), leans: false };
    let fitted = fit(&samples, &form).unwrap();
    assert!(fitted.rms_err < 1e-5 && fitted.lobe_err < 1e-5, "{fitted:?}");
    near(&fitted.index, &index, 1e-3);
    near(&[fitted.thickness_nm.unwrap()], &[180.0], 1e-3);
    near(&fitted.exponents, &[60.0, 20.0], 1e-3);
    near(&fitted.diffuse, &albedo.map(|a| 0.5 * a), 1e-3);
}

#[test]
fn too_few_values_are_no_lobe() {
    let samples = lobe(|_, _, _| 0.0);
    let form = Form { wavelengths_nm: WAVELENGTHS_NM, thickness_nm: None, leans: false };
    assert_eq!(fit(&samples, &form), None);
    assert_eq!(fit(&lobe(|_, _, _| 1.0)[..2], &form), None);
}

#[test]
fn mistakes_in_a_lobe_are_pointed_at() {
    for (text, expected) in [
        ("", ": no values"),
        ("theta_i,phi_i,theta_o,phi_o,r,g\n", ":1: no column `b`; expected theta_i,phi_i,theta_o,phi_o,r,g,b"),
        ("# x\ntheta_i,phi_i,theta_o,phi_o,r,g,b\n", ": no values"),
        ("theta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,30,180,1,1,x\n", ":2: b is `x`, expected a number"),
        (
            "theta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,90,180,1,1,1\n",
            ":2: theta_o is 90, expected 0 to less than 90 degrees",
        ),
        (
            "theta_i,phi_i,theta_o,phi_o,r,g,b\n\n30,0,9,180,1,-1,1\n",
            ":3: a value is negative, which no lobe of the model is",
        ),
    ] {
        assert_eq!(samples(text).unwrap_err().to_string(), expected);
    }
}

//! Oren and Nayar's full model against values from another program.

use luthier_layers::formulas::oren_nayar::{brdf, brdf_scalar};
use proptest::prelude::*;

use crate::directions::{direction, from_cosine};

/// BRDF for sigma (radians), albedo, theta_i, theta_o and azimuth between them (degrees): eq. 27-30 of Oren and Nayar 1994 in
/// angles, `rho/pi (C1 + cos phi C2 tan b + (1 - |cos phi|) C3 tan((a + b)/2)) + 0.17 rho^2/pi s^2/(s^2 + 0.13)
/// (1 - cos phi (2b/pi)^2)`, evaluated in Python with its mathematical library.
const VALUES: [([f64; 5], f64); 7] = [
    ([0.2, 0.5, 0.0, 0.0, 0.0], 0.153735072057),
    ([0.3, 0.8, 30.0, 60.0, 0.0], 0.268605590761),
    ([0.3, 0.8, 30.0, 60.0, 180.0], 0.215683360719),
    ([0.5, 1.0, 75.0, 75.0, 90.0], 0.337964571983),
    ([0.7, 0.4, 80.0, 20.0, 135.0], 0.084414908166),
    ([1.2, 0.9, 60.0, 60.0, 0.0], 0.374277872951),
    ([0.1, 0.25, 85.0, 40.0, 60.0], 0.080289952542),
];

#[test]
fn values_of_the_published_formula() {
    for ([sigma, albedo, theta_i, theta_o, phi], expected) in VALUES {
        // Turned about the normal, for good measure.
        for turn in [0.0, 77.0] {
            let found = brdf_scalar(albedo, sigma, direction(theta_i, turn), direction(theta_o, phi + turn));
            assert!((found - expected).abs() < 1e-11, "{theta_i} {theta_o} {phi}: {} {expected}", found);
        }
    }
}

#[test]
fn channels_do_not_mix() {
    let (wi, wo) = (direction(40.0, 10.0), direction(65.0, 150.0));
    let rgb = brdf([0.2, 0.5, 0.9], 0.4, wi, wo);
    for (channel, albedo) in rgb.into_iter().zip([0.2, 0.5, 0.9]) {
        assert_eq!(channel, brdf_scalar(albedo, 0.4, wi, wo));
    }
}

proptest! {
    #[test]
    fn it_is_lambert_without_roughness(cos_i in 1e-7..=1.0, cos_o in 1e-7..=1.0, phi in 0.0..6.3) {
        let found = |sigma| brdf_scalar(0.6, sigma, from_cosine(cos_i, 0.0), from_cosine(cos_o, phi));
        prop_assert!((found(0.0) - 0.6 / std::f64::consts::PI).abs() < 1e-15);
        // And continuous there, with the cosine that every use brings.
        prop_assert!((found(1e-9) - found(0.0)).abs() * cos_i < 1e-12);
    }

    #[test]
    fn it_is_reciprocal(cos_i in 1e-7..=1.0, cos_o in 1e-7..=1.0, phi in 0.0..6.3, sigma in 0.0..1.5, albedo in 0.0..=1.0) {
        let (wi, wo) = (from_cosine(cos_i, 0.3), from_cosine(cos_o, phi));
        let [there, back] = [brdf_scalar(albedo, sigma, wi, wo), brdf_scalar(albedo, sigma, wo, wi)];
        prop_assert!((there - back).abs() <= 1e-14 * there.abs());
    }

    #[test]
    fn it_is_continuous_where_the_azimuth_passes_a_right_angle(
        cos_i in 0.01..=1.0, cos_o in 0.01..=1.0, sigma in 0.0..1.5,
    ) {
        let at = |phi| brdf_scalar(0.9, sigma, from_cosine(cos_i, 0.0), from_cosine(cos_o, phi));
        let (front, back) = (at(std::f64::consts::FRAC_PI_2 - 1e-9), at(std::f64::consts::FRAC_PI_2 + 1e-9));
        // Slopes with respect to phi are below tan 89.4 degrees.
        prop_assert!((front - back).abs() < 1e-6);
    }

    #[test]
    fn it_is_finite_and_not_negative(
        exponents in [-7.0..=0.0, -7.0..=0.0f64], phi in 0.0..6.3, sigma in 0.0..1.5, albedo in 0.0..=1.0,
    ) {
        let [cos_i, cos_o] = exponents.map(|e: f64| 10f64.powf(e));
        let f = brdf_scalar(albedo, sigma, from_cosine(cos_i, 0.0), from_cosine(cos_o, phi));
        // tan of the lesser angle grows as 1/cos, which the cosine of the incident direction makes good.
        prop_assert!(f >= 0.0 && f * cos_i.max(cos_o) < 2.0);
    }
}

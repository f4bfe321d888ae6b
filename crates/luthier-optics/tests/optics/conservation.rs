//! Laws of every plane interface: energy, reciprocity, limits.

use luthier_optics::fresnel::{FilmLayer, coated, interface};
use proptest::prelude::*;

use crate::brute_force;
use crate::transfer_matrix::{Plane, c, powers, reflectance};

/// Rounding, next to numbers of order one.
const ROUNDING: f64 = 1e-12;

/// The cosine of the refracted ray, or `None` under total reflection.
fn refracted(above: f64, below: f64, cos: f64) -> Option<f64> {
    let cos_sq = 1.0 - (above / below).powi(2) * (1.0 - cos * cos);
    (cos_sq > 0.0).then(|| cos_sq.sqrt())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// R from the crate, T = Re(n2 c2) / (n1 c1) |t|^2 from Fresnel's amplitudes.
    #[test]
    fn a_lossless_interface_keeps_all_light(above in 1.0..3.0, below in 1.0..3.0, cos in 1e-3..=1.0) {
        let found = interface(c(above, 0.0), c(below, 0.0), cos);
        let Some(cos_t) = refracted(above, below, cos) else {
            prop_assert!((found.refl_s - 1.0).abs() < ROUNDING && (found.refl_p - 1.0).abs() < ROUNDING);
            return Ok(());
        };
        let t_s = 2.0 * above * cos / (above * cos + below * cos_t);
        let t_p = 2.0 * above * cos / (below * cos + above * cos_t);
        let flux = below * cos_t / (above * cos);
        prop_assert!((found.refl_s + flux * t_s * t_s - 1.0).abs() < ROUNDING);
        prop_assert!((found.refl_p + flux * t_p * t_p - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn lossless_films_keep_all_light(
        above in 1.0..2.0,
        indices in prop::collection::vec((1.0..3.0, 0.0..1.5), 1..=3),
        below in 1.0..3.0,
        cos in 0.02..=1.0,
    ) {
        let films: Vec<FilmLayer> =
            indices.iter().map(|&(n, waves)| FilmLayer { ior: c(n, 0.0), waves }).collect();
        let found = coated(c(above, 0.0), &films, c(below, 0.0), cos);
        for plane in [Plane::S, Plane::P] {
            let transmitted = powers(above, &films, c(below, 0.0), cos, plane)[1];
            prop_assert!((reflectance(found, plane) + transmitted - 1.0).abs() < 1e-11);
        }
    }

    /// Seen from below at the conjugate angle, a lossless stack turned over reflects the same.
    #[test]
    fn reflectance_is_reciprocal(
        above in 1.0..2.5,
        indices in prop::collection::vec((1.0..3.0, 0.0..1.5), 0..=3),
        below in 1.0..2.5,
        cos in 0.02..=1.0,
    ) {
        let Some(cos_t) = refracted(above, below, cos) else { return Ok(()) };
        prop_assume!(cos_t > 0.02);
        let mut films: Vec<FilmLayer> =
            indices.iter().map(|&(n, waves)| FilmLayer { ior: c(n, 0.0), waves }).collect();
        let down = coated(c(above, 0.0), &films, c(below, 0.0), cos);
        films.reverse();
        let up = coated(c(below, 0.0), &films, c(above, 0.0), cos_t);
        prop_assert!((down.refl_s - up.refl_s).abs() < 1e-11 && (down.refl_p - up.refl_p).abs() < 1e-11);
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric(n in 1.01..3.0, cos in 1e-6..=1.0) {
        let [bare, nearly] = [0.0, 1e-13].map(|k| interface(c(1.0, 0.0), c(n, k), cos).unpolarised());
        prop_assert!((bare - brute_force::dielectric(n, cos)).abs() < ROUNDING);
        prop_assert!((bare - nearly).abs() < 1e-11);
    }

    /// The formula in real numbers cancels at grazing angles, hence the tolerance.
    #[test]
    fn a_conductor_agrees_with_the_formula_in_real_numbers(n in 0.05..5.0, k in 0.0..10.0, cos in 1e-3..=1.0) {
        let found = interface(c(1.0, 0.0), c(n, k), cos).unpolarised();
        prop_assert!((found - brute_force::conductor(n, k, cos)).abs() < 1e-11);
    }

    /// `coated` clamps what rounding adds; what is not a number would pass for 1, hence the second assertion.
    #[test]
    fn reflectance_is_a_fraction(
        above in 1.0..3.0,
        films in prop::collection::vec((0.05..5.0, prop_oneof![Just(0.0), 0.0..10.0], 0.0..20_000.0), 0..=3),
        below in (0.05..5.0, prop_oneof![Just(0.0), 0.0..10.0]),
        exponent in -12.0..=0.0,
        wavelength_nm in 360.0..830.0,
    ) {
        let cos = 10f64.powf(exponent);
        let films: Vec<FilmLayer> = films
            .iter()
            .map(|&(n, k, nm): &(f64, f64, f64)| FilmLayer { ior: c(n, k), waves: nm / wavelength_nm })
            .collect();
        let found = coated(c(above, 0.0), &films, c(below.0, below.1), cos);
        for r in [found.refl_s, found.refl_p] {
            prop_assert!((0.0..=1.0).contains(&r));
        }
        let at_grazing = coated(c(above, 0.0), &films, c(below.0, below.1), 0.0);
        prop_assert!(cos > 1e-10 || (found.unpolarised() - at_grazing.unpolarised()).abs() < 1e-2);
        if below.1 > 0.01 && films.is_empty() && cos > 0.01 {
            prop_assert!(found.unpolarised() < 1.0);
        }
    }
}

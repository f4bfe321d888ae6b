//! Granier and Heidrich's model against its paper's numbers and other formulas.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::formulas::normals::exponent;
use luthier_layers::model::Model;
use luthier_layers::models::granier_heidrich::{Film, GranierHeidrich};
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_model::LobeHeight;
use luthier_optics::fresnel::FilmLayer;
use num_complex::Complex64;

use crate::sphere::{at, furnace, mirrored};
use crate::stacks::{dielectric, ggx, lambert};

fn film(eta: f64, waves_inside: Option<f64>) -> Film {
    Film { eta, f0: None, waves_inside, inner_normal: DVec3::Z, exponents: [90.0, 170.0] }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() < tolerance, "{found} {expected}");
}

/// The stated gain: 1.94 at 80 degrees, n = 1.5, beams in phase. And destructive interference takes light away.
#[test]
fn beams_in_phase_return_nearly_twice_what_falls_in() {
    let wi = at(80.0);
    // cos_theta_t of 80 degrees: the phase 2 Phi = 4 pi waves cos_theta_t is a turn.
    let cos_t = (1.0 - (80f64.to_radians().sin() / 1.5).powi(2)).sqrt();
    let at_phase = |turns: f64| film(1.5, Some(turns / (2.0 * cos_t))).specular(wi, mirrored(wi));
    close(at_phase(1.0), 1.94, 5e-3);
    assert!(at_phase(0.5) < 0.02);
    // Out of phase altogether: the two powers, which is what energy allows.
    close(film(1.5, None).specular(wi, mirrored(wi)), at_phase(0.25), 1e-12);
}

/// Eq. 14 is Schlick's mean, f + (1 - f)/21, and eq. 15 the rest. Eq. 18 for n = 1.5: Td = 0.914286.
#[test]
fn the_diffuse_term_is_that_of_the_paper() {
    for eta in [1.33, 1.5, 1.8, 2.5] {
        let f = ((eta - 1.0) / (eta + 1.0)) * ((eta - 1.0) / (eta + 1.0));
        close(film(eta, None).diffuse_reflectance(), f + (1.0 - f) / 21.0, 1e-14);
        close(1.0 - film(eta, None).diffuse_reflectance(), 80.0 / 21.0 * eta / ((1.0 + eta) * (1.0 + eta)), 1e-14);
        for waves in [0.0, 0.1, 0.25, 0.4] {
            let t = 80.0 / 21.0 * eta / ((1.0 + eta) * (1.0 + eta));
            let expected = 1.0 + 2.0 * (4.0 * PI * waves).cos() * (t * (1.0 - t)).sqrt();
            close(film(eta, Some(waves)).diffuse(), expected, 1e-13);
        }
    }
    close(film(1.5, None).diffuse(), 1.0, 1e-14);
}

/// Normals that agree send all wavelengths one way; a deviation of 14 degrees (figure 6) spreads them as Snell's law says.
#[test]
fn a_deviated_inner_normal_disperses() {
    let peak = |eta: f64, deviation: f64| {
        let inner_normal = at(deviation);
        let film = Film { eta, f0: None, waves_inside: None, inner_normal, exponents: [0.0, 1e5] };
        (-8900..8900)
            .map(|i| f64::from(i) * 0.01)
            .max_by(|a, b| {
                let value = |theta: f64| film.beams(DVec3::Z, at(theta)).transmitted;
                value(*a).total_cmp(&value(*b))
            })
            .unwrap()
    };
    for eta in [1.5, 1.6, 1.8] {
        close(peak(eta, 0.0), 0.0, 0.02);
        // Turned by twice the deviation inside, refracted on the way out.
        let expected = (eta * 28f64.to_radians().sin()).asin().to_degrees();
        close(peak(eta, 14.0), expected, 0.05);
    }
}

/// Inner boundaries that face away transmit no beam (eq. 11).
#[test]
fn boundaries_that_face_away_transmit_nothing() {
    let tilted = Film { inner_normal: at(60.0), ..film(1.5, Some(0.3)) };
    assert_eq!(tilted.beams(DVec3::Z, mirrored(at(85.0))).transmitted, 0.0);
    assert!(tilted.beams(DVec3::Z, mirrored(at(85.0))).reflected > 0.0);
    assert!(film(1.5, Some(0.3)).beams(DVec3::Z, mirrored(at(85.0))).transmitted > 0.0);
}

/// The film of figure 4 from a stack: exponent 90 is alpha 0.14744; the diffuse weight is the base's albedo, 0.7.
#[test]
fn parameters_come_from_the_stack() {
    close(exponent(0.14744), 90.0, 0.01);
    let mut granier = Monochrome::bare(&[(ggx(0.14744), dielectric(1.8, 0.0)), (ggx(0.0), lambert(0.7))]);
    granier.layers[0].films = vec![FilmLayer { ior: Complex64::new(1.45, 0.0), waves: 71.0 / 525.0 }];
    let film = GranierHeidrich::default().film(&granier).unwrap();
    assert_eq!((film.eta, film.waves_inside), (1.45, Some(1.45 * (71.0 / 525.0))));
    let diffuse = GranierHeidrich { specular_weight: 0.0, ..GranierHeidrich::default() };
    let wi = at(50.0);
    close(diffuse.eval(&granier, wi, at(10.0)), 0.7 * film.diffuse() / PI * wi.z, 1e-12);
}

/// Light of a white sky that an eye sees by narrow lobes. Without interference it is the coefficients of the two beams, `F + T_i T_o`, T_o
/// at the angle inside (eq. 10). Beams in phase add `2 sqrt(F T_i T_o)` at the peaks and less around them, because the transmitted lobe is
/// wider outside, n across and n cos_t/cos_i along the plane of incidence. Oracle: Schlick's formula, and the overlap
/// `sqrt(2 a / (1 + a^2))` per axis of Gaussians of relative width a.
#[test]
fn narrow_lobes_carry_their_coefficients() {
    for (theta, together, peak, seen_in_phase) in
        [(0.0, 0.9616, 1.3456, 1.3161), (60.0, 0.9626, 1.4625, 1.3644), (80.0, 0.9759, 1.9392, 1.4827)]
    {
        let wo = at(theta);
        let cos_t = (1.0 - (wo.x / 1.5) * (wo.x / 1.5)).sqrt();
        let waves = 0.5 / cos_t;
        let mut glossy = Monochrome::bare(&[(ggx(0.001), dielectric(1.5, 0.0)), (ggx(0.0), lambert(0.0))]);
        let seen = |stack: &Monochrome| furnace(&GranierHeidrich::default(), stack, wo);
        close(film(1.5, None).specular(mirrored(wo), wo), together, 1e-4);
        close(seen(&glossy), together, 1e-3);
        glossy.layers[0].films = vec![FilmLayer { ior: Complex64::new(1.5, 0.0), waves: waves / 1.5 }];
        close(film(1.5, Some(waves)).specular(mirrored(wo), wo), peak, 1e-4);
        let schlick = |cos: f64| 0.04 + 0.96 * (1.0 - cos).powi(5);
        let (f, t) = (schlick(wo.z), (1.0 - schlick(wo.z)) * (1.0 - schlick(cos_t)));
        let overlap = [1.5, 1.5 * cos_t / wo.z].map(|a: f64| (2.0 * a / (1.0 + a * a)).sqrt());
        close(f + t + 2.0 * (f * t).sqrt() * overlap[0] * overlap[1], seen_in_phase, 1e-3);
        close(seen(&glossy), seen_in_phase, 1e-3);
    }
}

/// A white object that scatters returns all that enters twice: mirrored, and diffuse.
#[test]
fn the_diffuse_term_comes_on_top() {
    let coated = Monochrome::bare(&[(ggx(0.1), dielectric(1.5, 0.0)), (ggx(0.0), lambert(1.0))]);
    close(furnace(&GranierHeidrich::default(), &coated, DVec3::Z), 1.0 + 0.04 + 0.96 * 0.96, 1e-2);
    close(film(1.5, Some(0.0)).diffuse(), 1.560, 1e-3);
}

/// The printed lobes have height one: with the exponents of figure 4 they carry 1/91 and, wider by refraction, 1/76 of the
/// hemisphere's 2 pi.
#[test]
fn printed_lobes_carry_a_small_share() {
    let film = film(1.5, None);
    let carried =
        |beam: fn(&Film, DVec3) -> f64| crate::sphere::integral(DVec3::Z, 500, 48, |wi| beam(&film, wi)) / (2.0 * PI);
    close(carried(|f, wi| f.beams(wi, DVec3::Z).reflected) / 0.04, 1.0 / 91.0, 1e-5);
    close(carried(|f, wi| f.beams(wi, DVec3::Z).transmitted) / (0.96 * 0.96), 1.0 / 76.0, 1e-4);
}

/// Oracle: exponents that are given, 90 and 170, in place of slope parameters that stand for them. Weights are factors on either part.
#[test]
fn slope_parameters_of_both_boundaries_are_their_exponents() {
    let alpha = (2.0f64 / 92.0).sqrt();
    let stack = |albedo: f64| Monochrome::bare(&[(ggx(alpha), dielectric(1.5, 0.0)), (ggx(0.0), lambert(albedo))]);
    let own = GranierHeidrich { inner_alpha_ratio: (92.0f64 / 172.0).sqrt(), ..GranierHeidrich::default() };
    let given = GranierHeidrich { exponents: Some([90.0, 170.0]), ..GranierHeidrich::default() };
    let weighed = GranierHeidrich { specular_weight: 0.3, diffuse_weight: 0.2, ..own };
    for (theta_i, theta_o) in [(0.0, 10.0), (30.0, 35.0), (60.0, 50.0), (80.0, 75.0)] {
        let (wi, wo) = (at(theta_i), mirrored(at(theta_o)));
        let value = |model: &GranierHeidrich, albedo| model.eval(&stack(albedo), wi, wo);
        close(value(&own, 0.5), value(&given, 0.5), 1e-10 * value(&given, 0.5));
        let (specular, whole) = (value(&own, 0.0), value(&own, 0.5));
        close(value(&weighed, 0.5), 0.3 * specular + 0.2 * (whole - specular), 1e-12);
    }
}

/// Oracle: eq. 5 as printed, by the film alone, for both beams in phase, in between, and without interference.
#[test]
fn lobes_of_height_one_are_those_of_eq_5() {
    let model = GranierHeidrich {
        exponents: Some([90.0, 170.0]),
        lobe_height: LobeHeight::One,
        specular_weight: 0.4,
        ..GranierHeidrich::default()
    };
    for waves in [None, Some(0.0), Some(0.3)] {
        let mut stack = Monochrome::bare(&[(ggx(0.1), dielectric(1.5, 0.0)), (ggx(0.0), lambert(0.0))]);
        stack.layers[0].films =
            waves.map(|waves| FilmLayer { ior: Complex64::new(1.5, 0.0), waves: waves / 1.5 }).into_iter().collect();
        for (theta_i, theta_o) in [(0.0, 0.0), (30.0, 35.0), (80.0, 75.0)] {
            let (wi, wo) = (at(theta_i), mirrored(at(theta_o)));
            let expected = film(1.5, waves).specular(wi, wo);
            assert!(expected > 1e-3);
            close(model.eval(&stack, wi, wo), 0.4 * expected, 1e-12);
        }
    }
    let metal = Monochrome::bare(&[(ggx(0.1), MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.0) })]);
    let peak = GranierHeidrich { specular_weight: 1.0, ..model }.eval(&metal, DVec3::Z, DVec3::Z);
    close(peak, (0.8f64.powi(2) + 9.0) / (1.2f64.powi(2) + 9.0), 1e-12);
}

/// Slopes of heights add up: a boundary of slope 0.25 that leans by 0.1 more at a place, and by 0.3 across.
#[test]
fn a_lean_at_a_place_comes_on_top() {
    let normal = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize();
    let model = GranierHeidrich { inner_normal: normal(0.25, 0.0), ..GranierHeidrich::default() };
    let found = model.leaning(normal(0.1, -0.3)).inner_normal;
    assert!((found - normal(0.35, -0.3)).length() < 1e-15, "{found}");
    assert_eq!(model.leaning(DVec3::Z), model);
    assert_eq!(GranierHeidrich::default().leaning(model.inner_normal), model);
}

//! Failures of usual methods in optics: one test each, with the size of the error and the crate's own value.
//!
//! The failing methods are written out here; nothing that ships uses them.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves};
use luthier_optics::constants::dataset;
use luthier_optics::f0_table::F0_TABLE;
use luthier_optics::film_color::BelcourBarla;
use luthier_optics::fresnel::{FilmLayer, coated, interface};
use luthier_optics::masking::v_cavity;
use luthier_optics::microfacet::Anisotropic;
use luthier_optics::microfacet::{distribution, scaled_distribution};
use luthier_optics::sampling::{CosineHemisphere, Sampler, VisibleNormals};
use luthier_optics::schlick::{Lazanyi, complex_f0};
use luthier_optics::stack::Distribution;
use num_complex::Complex64;

/// Greatest finite half, and smallest normal one (IEEE 754 binary16).
const F16_MAX: f64 = 65504.0;
const F16_MIN_NORMAL: f64 = 6.103515625e-5;

/// Texels of the tables of old.
const TEXELS: u32 = 512;

fn real(n: f64) -> Complex64 {
    Complex64::new(n, 0.0)
}

fn reflectance(above: f64, below: f64, cos: f64) -> f64 {
    interface(real(above), real(below), cos).unpolarised()
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} against {expected}");
}

/// pi alpha^2 D of Beckmann at an angle.
fn beckmann(alpha: f64, theta: f64) -> f64 {
    scaled_distribution(Distribution::Beckmann, alpha, theta.cos(), theta.sin().powi(2))
}

/// Largest error of a linear table of `texels` nodes against what it tabulates, over the peak.
fn table_error(texels: u32, at_node: impl Fn(f64) -> f64, exact: impl Fn(f64) -> f64) -> f64 {
    let last = f64::from(texels - 1);
    let nodes: Vec<f64> = (0..texels).map(|i| at_node(f64::from(i) / last)).collect();
    let per_interval = 16;
    (0..(texels - 1) * per_interval)
        .map(|i| {
            let u = (f64::from(i) + 0.5) / f64::from(per_interval);
            let (k, t) = (u as usize, u.fract());
            ((1.0 - t) * nodes[k] + t * nodes[k + 1] - exact(u / last)).abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn d_in_f16_overflows_where_the_scaled_form_does_not() {
    let peak = |m: f64| distribution(Distribution::Beckmann, m, 1.0, 0.0);
    assert!(peak(0.00219) > F16_MAX && peak(0.00221) < F16_MAX);
    let without_pi = |m: f64| 1.0 / (m * m);
    assert!(without_pi(0.00390) > F16_MAX && without_pi(0.00391) < F16_MAX);
    // Rows m = i/511: off the peak the first is 0/0, at the peak both overflow.
    let row = |m: f64, tan_sq: f64| (-tan_sq / (m * m)).exp() / (m * m);
    assert!(row(0.0, 0.01).is_nan() && row(0.0, 0.0).is_nan() && without_pi(1.0 / 511.0) > F16_MAX);
    for m in [0.0, 1e-6, 1.0 / 511.0, 0.1, 1.0] {
        for i in 0..=1000 {
            let scaled = beckmann(m, 0.5 * PI * f64::from(i) / 1000.0);
            assert!((0.0..=4.0 / std::f64::consts::E + 1e-12).contains(&scaled), "{m}: {scaled}");
        }
    }
}

#[test]
fn d_over_a_linear_angle_loses_the_peak_and_the_eighth_power_keeps_it() {
    for (m, linear) in [(0.02, 0.0058), (0.01, 0.022), (0.005, 0.068)] {
        let angle = |u: f64| 0.5 * PI * u;
        let found = table_error(TEXELS, |u| beckmann(m, angle(u)), |u| beckmann(m, angle(u)));
        assert_near(found, linear, 0.05 * linear + 2e-3);
        let eighth = |u: f64| 0.5 * PI * u.powi(8);
        let ours = table_error(TEXELS, |u| beckmann(m, eighth(u)), |u| beckmann(m, eighth(u)));
        assert!(ours < 2e-4, "{m}: {ours}");
    }
}

#[test]
fn the_eighth_power_of_the_cosine_is_not_the_mapping() {
    for (m, error) in [(0.02, 0.106), (0.01, 0.47)] {
        let angle = |u: f64| u.powf(0.125).acos();
        let found = table_error(TEXELS, |u| beckmann(m, angle(u)), |u| beckmann(m, angle(u)));
        assert_near(found, error, 0.02);
        let of_the_angle = |u: f64| 0.5 * PI * u.powi(8);
        let ours = table_error(TEXELS, |u| beckmann(m, of_the_angle(u)), |u| beckmann(m, of_the_angle(u)));
        assert!(ours < 2e-4, "{m}: {ours}");
    }
}

#[test]
fn d_over_a_linear_slope_errs_between_rows_and_the_scaled_form_does_not() {
    for (m, error) in [(0.02, 0.007), (0.01, 0.025), (0.005, 0.13), (0.003, 0.40)] {
        let row = (m * 511.0f64).floor();
        let [below, above] = [row, row + 1.0].map(|i| (511.0 / i).powi(2));
        let middle = (511.0 / (row + 0.5)).powi(2);
        let found = 0.5 * (below + above) / middle - 1.0;
        assert_near(found, error, 0.03 * error);
        let ours = 0.5 * (beckmann(row / 511.0, 0.0) + beckmann((row + 1.0) / 511.0, 0.0));
        assert_eq!(ours, beckmann((row + 0.5) / 511.0, 0.0));
    }
}

#[test]
fn mip_maps_of_d_are_two_and_a_half_times_too_bright() {
    let rows = (0..16).map(|i| (0.02 * 511.0 - 7.5 + f64::from(i)) / 511.0);
    let mean = rows.clone().map(|m| 1.0 / (m * m)).sum::<f64>() / 16.0;
    let factor = mean * 0.02 * 0.02;
    assert_near(factor, 2.54, 0.01);
    let ours = rows.map(|m| beckmann(m, 0.0)).sum::<f64>() / 16.0;
    assert_near(ours, 1.0, 1e-15);
}

#[test]
fn eight_bits_of_fresnel_are_a_tenth_of_waters() {
    let half_step = 0.5 / 255.0;
    assert_near(half_step / reflectance(1.0, 1.5, 1.0), 0.049, 1e-3);
    assert_near(half_step / reflectance(1.0, 1.33, 1.0), 0.098, 1e-3);
    let matched = reflectance(1.0, 1.01, 1.0);
    assert!((matched * 255.0).round() == 0.0 && matched > 2.4e-5);
    // Sixteen bits hold all three, within 0.04% of the first and a third of the last.
    let half_step = 0.5 / 65535.0;
    assert!(half_step / reflectance(1.0, 1.5, 1.0) < 4e-4 && half_step / matched < 0.34);
}

#[test]
fn fresnel_over_the_angle_is_steep_at_grazing() {
    let slope = |n: f64| (1.0 - reflectance(1.0, n, (0.5 * PI - 1e-6).cos())) / 1e-6;
    assert_near(slope(1.5), 5.81, 0.01);
    let over_angle = |n: f64| {
        table_error(128, |u| reflectance(1.0, n, (0.5 * PI * u).cos()), |u| reflectance(1.0, n, (0.5 * PI * u).cos()))
    };
    let over_cos = |n: f64| table_error(128, |u| reflectance(1.0, n, u), |u| reflectance(1.0, n, u));
    assert_near(over_angle(1.5), 7e-4, 2e-5);
    assert_near(over_cos(1.5), 3e-4, 2e-5);
    assert_near(over_angle(1.01), 1.3e-2, 5e-4);
    assert_near(over_cos(1.01), 5.7e-3, 1e-4);
}

#[test]
fn a_row_of_fresnel_from_inside_misses_the_critical_angle() {
    let exact = |cos: f64| reflectance(1.5, 1.0, cos);
    let found = table_error(128, exact, exact);
    assert!((0.2..0.3).contains(&found), "{found}");
    // Exact on both sides of the kink, and 1 beyond.
    let critical = (1.0 - 1.0 / 2.25f64).sqrt();
    assert_near(critical.acos().to_degrees(), 41.81, 5e-3);
    assert_near(exact(critical * (1.0 - 1e-9)), 1.0, 1e-12);
    assert_eq!(exact(0.0), 1.0);
    assert!(exact(critical + 1e-3) < 0.85);
    // A knot there, and points that gather at it as the square root does: no kink is left, with half the texels.
    let inside = |u: f64| exact(critical + (1.0 - critical) * u * u);
    let ours = table_error(64, inside, inside);
    assert!(ours < 2e-3, "{ours}");
}

#[test]
fn schlick_with_a_complex_f0_is_a_third_off_for_chromium() {
    let worst = |below: Complex64, approximation: &dyn Fn(f64) -> f64| {
        (0..=9000)
            .map(|i| (f64::from(i) / 9000.0 * 0.5 * PI).cos())
            .map(|cos| (approximation(cos) - interface(Complex64::ONE, below, cos).unpolarised()).abs())
            .fold(0.0, f64::max)
    };
    for (n, k, error, corrected) in [
        (0.213, 4.05, 0.024, 0.0011),
        (1.04, 2.583, 0.040, 0.0012),
        (1.0, 6.69, 0.095, 0.0063),
        (3.18, 4.41, 0.215, 0.0186),
        (1.33, 0.0, 0.060, 0.0098),
        (1.01, 0.0, 0.55, 0.0837),
    ] {
        let below = Complex64::new(n, k);
        assert_near(worst(below, &|cos| complex_f0(1.0, below, cos)), error, 6e-4);
        // With the correction term of Lazanyi and Szirmay-Kalos; the tables hold Fresnel's own formulas.
        let lazanyi = Lazanyi::fit(1.0, below);
        assert_near(worst(below, &|cos| lazanyi.eval(cos)), corrected, 1e-4);
    }
}

/// GGX's peak region in single precision: from the cosine alone, and from the tangent components.
#[test]
fn f32_ggx_from_the_cosine_loses_its_digits() {
    let from_cos = |alpha: f32, cos: f32| {
        let d = cos * cos * (alpha * alpha - 1.0) + 1.0;
        f64::from(alpha * alpha / (std::f32::consts::PI * d * d))
    };
    let from_sine = |alpha: f32, cos: f32, sin_sq: f32| {
        let d = cos * cos * alpha * alpha + sin_sq;
        f64::from(alpha * alpha / (std::f32::consts::PI * d * d))
    };
    for (alpha, error) in [(0.01f32, 0.0015), (0.002, 0.032), (0.001, 0.124)] {
        let (mut bad, mut good) = (0.0f64, 0.0f64);
        for i in 0..400 {
            let theta = f64::from(alpha) * f64::from(i) / 200.0;
            let (sin, cos) = (theta.sin(), theta.cos());
            let exact = distribution(Distribution::Ggx, f64::from(alpha), cos, sin * sin);
            bad = bad.max((from_cos(alpha, cos as f32) / exact - 1.0).abs());
            good = good.max((from_sine(alpha, cos as f32, (sin * sin) as f32) / exact - 1.0).abs());
        }
        assert_near(bad, error, 0.03 * error);
        assert!(good < 1e-6, "{alpha}: {good}");
    }
    assert!(from_cos(1e-4, 1.0).is_infinite());
    assert_near(scaled_distribution(Distribution::Ggx, 1e-4, 1.0, 0.0), 1.0, 0.0);
}

/// 1 - F of an almost lossless conductor in single precision, by the usual closed form.
#[test]
fn f32_conductor_loses_what_is_absorbed() {
    let usual = |n: f32, k: f32, cos: f32| {
        let (cos_sq, sin_sq) = (cos * cos, 1.0 - cos * cos);
        let t0 = n * n - k * k - sin_sq;
        let a2_b2 = (t0 * t0 + 4.0 * n * n * k * k).sqrt();
        let t1 = a2_b2 + cos_sq;
        let a = (0.5 * (a2_b2 + t0)).max(0.0).sqrt();
        let t2 = 2.0 * cos * a;
        let rs = (t1 - t2) / (t1 + t2);
        let t3 = cos_sq * a2_b2 + sin_sq * sin_sq;
        let t4 = t2 * sin_sq;
        0.5 * (rs + rs * (t3 - t4) / (t3 + t4))
    };
    let (n, k) = (0.01, 10.0);
    // At normal incidence 1 - F = 4 n/((n + 1)^2 + k^2), exactly.
    let exact = 4.0 * n / ((n + 1.0) * (n + 1.0) + k * k);
    let ours = 1.0 - interface(Complex64::ONE, Complex64::new(n, k), 1.0).unpolarised();
    assert!((ours / exact - 1.0).abs() < 1e-11, "{ours} against {exact}");
    let worst = (1..=100)
        .map(|i| f64::from(i) / 100.0)
        .map(|cos| {
            let exact = 1.0 - interface(Complex64::ONE, Complex64::new(n, k), cos).unpolarised();
            ((1.0 - f64::from(usual(0.01, 10.0, cos as f32))) / exact - 1.0).abs()
        })
        .fold(0.0, f64::max);
    assert_near(worst, 4.3e-3, 2e-4);
}

#[test]
fn f16_alpha_squared_is_subnormal() {
    let alpha = 0.0078125;
    assert_eq!(alpha * alpha, F16_MIN_NORMAL);
    assert!(0.0078f64.powi(2) < F16_MIN_NORMAL);
    // In f64 nothing happens there, nor far below.
    assert_near(scaled_distribution(Distribution::Ggx, 1e-8, 1.0, 1e-16), 0.25, 1e-12);
}

#[test]
fn opposite_directions_have_no_half_vector_and_give_zero() {
    let ndf = Anisotropic::new(Distribution::Ggx, 0.3, 0.1).expect("alphas are positive");
    let sampler = VisibleNormals { ndf };
    let wo = DVec3::new(1.0, 0.0, 0.0);
    assert_eq!(sampler.pdf_solid_angle(wo, -wo), 0.0);
    let wo = DVec3::new(0.6, 0.0, 0.8);
    assert_eq!(sampler.pdf_solid_angle(wo, -wo), 0.0);
    assert_eq!(sampler.pdf_solid_angle(DVec3::Z, -DVec3::Z), 0.0);
    assert_eq!(CosineHemisphere.pdf_solid_angle(wo, -wo), 0.0);
}

/// V-cavities mask nothing at mirror directions: f grows as 1/cos^2, f cos as 1/cos.
#[test]
fn v_cavities_grow_at_grazing() {
    let d = distribution(Distribution::Beckmann, 0.3, 1.0, 0.0);
    for cos in [0.1, 0.01, 0.001] {
        assert_eq!(v_cavity(cos, cos, 1.0, cos), 1.0);
        let f = d * v_cavity(cos, cos, 1.0, cos) / (4.0 * cos * cos);
        assert_near(f * cos * cos, 0.25 * d, 1e-12);
    }
    for (cos_i, cos_o) in [(0.0, 0.5), (0.5, 0.0), (-0.1, 0.5)] {
        assert_eq!(v_cavity(cos_i, cos_o, 0.8, 0.3), 0.0);
    }
}

#[test]
fn one_bounce_off_the_roughest_ggx_is_31_percent() {
    let statistics = FacetStatistics::new(Distribution::Ggx, 1.0, 1.0, Effort { first: 24, later: 24 }, 1);
    let mirror = ReflectanceCurves::new(1, |_, _| 1.0);
    assert_near(statistics.single_scattering(&mirror)[0], 1.0 - 2f64.ln(), 2e-5);
    assert_near(statistics.albedo(&mirror)[0], 1.0, 1e-8);
    for (alpha, single) in [(0.1, 0.9883040565), (0.25, 0.9158124302), (0.5, 0.6878485151), (0.75, 0.4639165109)] {
        let statistics = FacetStatistics::new(Distribution::Ggx, alpha, 1.0, Effort { first: 32, later: 8 }, 1);
        assert_near(statistics.single_scattering(&mirror)[0], single, 2e-5);
    }
}

/// A film of air in glass, 100 nm, at 60 degrees: light tunnels. Some renderers return 1.
#[test]
fn total_reflection_is_frustrated_by_a_thin_film() {
    let cos = 60f64.to_radians().cos();
    let film = [FilmLayer { ior: real(1.0), waves: 100.0 / 550.0 }];
    assert_near(coated(real(1.5), &film, real(1.5), cos).unpolarised(), 0.63127563, 5e-9);
    let published = BelcourBarla { above: 1.5, film: 1.0, thickness_nm: 100.0, below: real(1.5), orders: 2 };
    assert_eq!(published.monochrome(550.0, cos), 1.0);
}

/// Some renderers force the film's index towards the outside as it vanishes; here nothing is needed.
#[test]
fn a_vanishing_film_tends_to_the_bare_interface() {
    let base = Complex64::new(0.213, 4.05);
    for cos in [0.1, 0.5, 1.0] {
        let bare = interface(Complex64::ONE, base, cos).unpolarised();
        let mut last = f64::INFINITY;
        for nm in [10.0, 1.0, 0.1, 0.01, 0.0] {
            let film = [FilmLayer { ior: real(1.5), waves: nm / 690.0 }];
            let error = (coated(Complex64::ONE, &film, base, cos).unpolarised() - bare).abs();
            assert!(error <= last, "{cos} {nm}: {error} after {last}");
            last = error;
        }
        assert!(last < 1e-14, "{last}");
    }
}

/// Printed 1.022; 1.0376 from Johnson and Christy. Eight bits clip either; the float keeps it.
#[test]
fn the_red_of_gold_is_above_one() {
    let gold = F0_TABLE.iter().find(|entry| entry.name == "Gold").expect("gold is in the table");
    assert_eq!((gold.linear[0], gold.srgb[0]), (1.022, 255));
    let red = gold.computed().expect("its data set exists")[0];
    assert_near(red, 1.0376, 1e-4);
    // No wavelength reflects more than falls on it: the colour is out of the gamut, not the energy.
    let ior = &dataset("au").expect("gold is built in").ior;
    for nm in (360..=830).step_by(5) {
        assert!(interface(Complex64::ONE, ior.at(f64::from(nm)), 1.0).unpolarised() < 1.0);
    }
}

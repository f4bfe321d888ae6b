//! Oracle numbers, each computed two ways outside this project, to the digits given.
//!
//! Every test that the list of such numbers names, `docs/oracles.md`, exists.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

use std::f64::consts::{LN_2, PI};
use std::path::{Path, PathBuf};

use glam::DVec3;
use luthier_optics::fresnel::{dielectric_average, interface};
use luthier_optics::masking::{Correlation, smith};
use luthier_optics::microfacet::Anisotropic;
use luthier_optics::microfacet::{distribution, lambda};
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::sampling::VisibleNormals;
use luthier_optics::schlick::{schlick, schlick_average};
use luthier_optics::stack::Distribution;
use num_complex::Complex64;

/// Half a unit of the tenth digit after the point.
const TEN_DIGITS: f64 = 5e-11;

fn reflectance(above: f64, below: f64, cos: f64) -> f64 {
    interface(Complex64::new(above, 0.0), Complex64::new(below, 0.0), cos).unpolarised()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} against {expected}");
}

/// Integral over `low..high`; the square gathers points at `low`, so that a square root there is smooth.
fn integral(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let width = high - low;
    gauss_legendre(120).into_iter().map(|(x, w)| 2.0 * x * w * width * f(low + width * x * x)).sum()
}

#[test]
fn hemispherical_fresnel_from_both_sides_to_ten_digits() {
    for (n, outside, inside) in
        [(1.33, 0.0659308493, 0.4719491488), (1.5, 0.0917779593, 0.5963457597), (2.0, 0.1605966371, 0.7901491593)]
    {
        assert_near(dielectric_average(n), outside, TEN_DIGITS);
        assert_near(integral(0.0, 1.0, |cos| 2.0 * cos * reflectance(1.0, n, cos)), outside, TEN_DIGITS);
        assert_near(1.0 - (1.0 - dielectric_average(n)) / (n * n), inside, TEN_DIGITS);
        // Cosines up to the critical angle reflect everything: their share is its squared cosine.
        let critical_sq = 1.0 - 1.0 / (n * n);
        let through = integral(critical_sq.sqrt(), 1.0, |cos| 2.0 * cos * reflectance(n, 1.0, cos));
        assert_near(critical_sq + through, inside, TEN_DIGITS);
    }
}

#[test]
fn schlick_averages_to_f0_and_a_twenty_first_of_the_rest() {
    for f0 in [0.0, 0.02, 0.04, 0.5, 1.0] {
        assert_near(schlick_average(f0), f0 + (1.0 - f0) / 21.0, 1e-15);
        assert_near(integral(0.0, 1.0, |cos| 2.0 * cos * schlick(f0, cos)), schlick_average(f0), 1e-14);
    }
}

/// A coat of n = 1.5 on a diffuse base: bounces between them are a geometric series.
#[test]
fn smooth_coat_on_lambert_to_eight_digits() {
    let (n, outside) = (1.5, dielectric_average(1.5));
    let inside = 1.0 - (1.0 - outside) / (n * n);
    let albedo = |front: f64, rho: f64| front + (1.0 - front) * (1.0 - inside) * rho / (1.0 - rho * inside);
    for (rho, diffuse, normal) in
        [(0.18, 0.16570257, 0.11813908), (0.5, 0.35295886, 0.31607089), (0.8, 0.65263668, 0.63283341), (1.0, 1.0, 1.0)]
    {
        assert_near(albedo(outside, rho), diffuse, 5e-9);
        assert_near(albedo(reflectance(1.0, n, 1.0), rho), normal, 5e-9);
    }
}

#[test]
fn smooth_coat_on_a_mirror_to_ten_digits() {
    let cos = 0.5f64.sqrt();
    let f = reflectance(1.0, 1.5, cos);
    assert_near(f, 0.0502399110, TEN_DIGITS);
    let cos_t = (1.0 - 0.5 / 2.25f64).sqrt();
    for (depth, expected) in [(0.0, 1.0), (0.1, 0.7992518131), (1.0, 0.1441269347)] {
        let a = (-2.0 * depth / cos_t).exp();
        assert_near(f + (1.0 - f) * (1.0 - f) * a / (1.0 - f * a), expected, TEN_DIGITS);
    }
}

/// One bounce off GGX facets with F = 1, over the facets' tangent t: light leaves at twice their angle.
#[test]
fn ggx_single_scattering_at_the_normal_to_ten_digits() {
    for (alpha, expected) in
        [(0.1, 0.9883040565), (0.25, 0.9158124302), (0.5, 0.6878485151), (0.75, 0.4639165109), (1.0, 1.0 - LN_2)]
    {
        let found = integral(0.0, 1.0, |t| {
            let cos_sq = 1.0 / (1.0 + t * t);
            let d = distribution(Distribution::Ggx, alpha, cos_sq.sqrt(), t * t * cos_sq);
            let cos_i = (1.0 - t * t) * cos_sq;
            let g = smith(Correlation::Height, lambda(Distribution::Ggx, alpha, cos_i), 0.0);
            d * g * 2.0 * PI * t * cos_sq * cos_sq
        });
        assert_near(found, expected, TEN_DIGITS);
    }
}

/// One bounce off GGX facets at a cosine of one half, with height-correlated masking: over the direction of the light.
#[test]
fn ggx_single_scattering_at_60_degrees_to_the_digits_given() {
    let wo = DVec3::new(0.75f64.sqrt(), 0.0, 0.5);
    for (alpha, expected, digit) in [
        (0.1, 0.969205, 1e-6),
        (0.25, 0.857263, 1e-6),
        (0.5, 0.69825, 1e-5),
        (0.75, 0.56462, 1e-5),
        (1.0, 0.45069, 1e-5),
    ] {
        let azimuths = 720;
        let ring = |mu: f64| -> f64 {
            let across = (1.0 - mu * mu).sqrt();
            let lambdas = [mu, wo.z].map(|cos| lambda(Distribution::Ggx, alpha, cos));
            let g = smith(Correlation::Height, lambdas[0], lambdas[1]);
            let sum: f64 = (0..azimuths)
                .map(|j| {
                    let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                    let h = (wo + DVec3::new(across * phi.cos(), across * phi.sin(), mu)).normalize();
                    distribution(Distribution::Ggx, alpha, h.z, h.x * h.x + h.y * h.y)
                })
                .sum();
            sum * g / (4.0 * wo.z) * 2.0 * PI / f64::from(azimuths)
        };
        let found = integral(0.0, 0.5, ring) + integral(0.5, 1.0, ring);
        assert_near(found, expected, 0.5 * digit + 1e-9);
    }
}

#[test]
fn smith_lambda_is_its_closed_form() {
    for alpha in [0.01, 0.3, 1.0] {
        for cos in [0.05, 0.3, 0.7, 0.99] {
            let tan = (1.0f64 - cos * cos).sqrt() / cos;
            let ggx = 0.5 * ((1.0 + alpha * alpha * tan * tan).sqrt() - 1.0);
            assert_near(lambda(Distribution::Ggx, alpha, cos), ggx, 1e-14 * (1.0 + ggx));
            let nu = 1.0 / (alpha * tan);
            let beckmann = 0.5 * (libm::erf(nu) - 1.0) + (-nu * nu).exp() / (2.0 * nu * PI.sqrt());
            assert_near(lambda(Distribution::Beckmann, alpha, cos), beckmann, 1e-14 * (1.0 + beckmann));
        }
    }
}

/// Half of the facets drawn for light from the normal are flatter than alpha (GGX) or alpha sqrt(ln 2) (Beckmann).
#[test]
fn the_median_slope_of_samples_is_alpha_for_ggx_and_less_for_beckmann() {
    for (kind, factor) in [(Distribution::Ggx, 1.0), (Distribution::Beckmann, LN_2.sqrt())] {
        for alpha in [0.005, 0.1, 0.5, 1.0] {
            let sampler = VisibleNormals { ndf: Anisotropic::new(kind, alpha, alpha).expect("alpha is positive") };
            let side = 301;
            let centre = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
            let mut slopes: Vec<f64> = (0..side * side)
                .map(|i| sampler.normal(DVec3::Z, [centre(i / side), centre(i % side)]))
                .map(|m| m.x.hypot(m.y) / m.z)
                .collect();
            slopes.sort_by(f64::total_cmp);
            // Points of a grid: the share below the median is within one row of a half.
            assert_near(slopes[slopes.len() / 2] / (alpha * factor), 1.0, 6e-3);
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Files that may hold `crate::path::name`: a test target, a module of one, unit tests of a module.
fn places(listed: &str) -> (Vec<PathBuf>, &str) {
    let parts: Vec<&str> = listed.split("::").collect();
    let [krate, modules @ .., name] = parts.as_slice() else { panic!("`{listed}` is no crate::path::name") };
    let folder = root().join("crates").join(krate);
    let path = modules.join("/");
    let own = [
        format!("tests/{path}.rs"),
        format!("tests/{path}/mod.rs"),
        format!("src/{path}.rs"),
        format!("src/{path}/tests.rs"),
        format!("src/{path}/mod.rs"),
    ];
    (own.iter().map(|file| folder.join(file)).collect(), name)
}

/// Whether a source has a test of that name: the function is preceded by `#[test]`, attributes and comments aside.
fn has_test(source: &str, name: &str) -> bool {
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let is_named = |line: &str| line.strip_prefix("fn ").is_some_and(|rest| rest.starts_with(&format!("{name}(")));
    lines.iter().enumerate().filter(|(_, line)| is_named(line)).any(|(i, _)| {
        let above = lines[..i].iter().rev().take_while(|line| line.starts_with("#[") || line.starts_with("///"));
        above.into_iter().any(|line| *line == "#[test]")
    })
}

#[test]
fn every_listed_test_exists() {
    let list = std::fs::read_to_string(root().join("docs/oracles.md")).expect("the list is in docs");
    let listed: Vec<&str> = list
        .lines()
        .filter(|line| line.starts_with('|'))
        .flat_map(|line| line.split('`').skip(1).step_by(2))
        .filter(|code| code.starts_with("luthier-"))
        .collect();
    assert!(listed.len() > 60, "{} tests are listed", listed.len());
    for entry in listed {
        let (files, name) = places(entry);
        let found =
            files.iter().filter_map(|file| std::fs::read_to_string(file).ok()).any(|text| has_test(&text, name));
        assert!(found, "docs/oracles.md lists `{entry}`, which does not exist");
    }
    // Every row of its tables names one.
    for line in list.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| case")) {
        assert!(line.contains("`luthier-"), "no test in: {line}");
    }
}

//! Tests of the fit, and of values and samples of fitted lobes.

mod anisotropic;
mod draws;
mod place;
mod short;
mod tilt;
mod weights;

use glam::DVec3;
use luthier_model::Masking;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};

use crate::models::lobes::{FirstInterface, FitSettings, Lobes, Simulation};
use crate::monochrome::Monochrome;
use crate::references::layered_mc::{ColorPaths, InterfaceMode, LayeredMc};

const NM: [f64; 3] = [650.0, 550.0, 450.0];

fn layer(alpha: f64, base: Base) -> Layer {
    let distribution = Distribution::Ggx;
    Layer { films: Vec::new(), surface: Surface { distribution, ..Surface::isotropic(distribution, alpha) }, base }
}

fn coat(absorption_per_um: [f64; 3]) -> Base {
    Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab: Slab { thickness_um: 1.0, absorption_per_um } }
}

fn metal() -> Base {
    Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() }
}

fn stack(layers: Vec<Layer>) -> Stack {
    Stack { exterior: Ior::vacuum(), layers }
}

fn fitted(stack: &Stack, count: usize) -> Lobes {
    let settings = FitSettings { rows: 10, paths: 8000, seed: 5 };
    Simulation::new(stack, &Color::ThreeWavelengths(NM), settings).fit(count)
}

/// A tinted coat of alpha .2 on a metal of alpha .1.
fn lacquered() -> Stack {
    stack(vec![layer(0.2, coat([0.1, 0.2, 0.6])), layer(0.1, metal())])
}

pub(super) fn direction(theta_deg: f64, phi: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(theta_deg.to_radians());
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}

/// The integral of a function over the hemisphere of lights, in the half vectors with `wo`.
pub(super) fn integral(wo: DVec3, f: impl Fn(DVec3) -> f64) -> f64 {
    let rule = gauss_legendre(96);
    let mut sum = 0.0;
    // tan(theta_h) = t^2 / (1 - t): nodes are dense about the mirror direction.
    for (t, weight) in &rule {
        let tan = t * t / (1.0 - t);
        let theta = libm::atan(tan);
        let d_theta = (2.0 * t * (1.0 - t) + t * t) / ((1.0 - t) * (1.0 - t)) / (1.0 + tan * tan) * weight;
        for k in 0..192 {
            let phi = (f64::from(k) + 0.5) / 192.0 * std::f64::consts::TAU;
            let wh = direction(theta.to_degrees(), phi);
            let cos_theta_d = wh.dot(wo);
            let wi = 2.0 * cos_theta_d * wh - wo;
            if cos_theta_d > 0.0 && wi.z > 0.0 {
                let solid_angle = 4.0 * cos_theta_d * libm::sin(theta) * d_theta * std::f64::consts::TAU / 192.0;
                sum += f(wi) * solid_angle;
            }
        }
    }
    sum
}

/// Oracle: optics. Between refracted directions, a metal under a smooth coat shows its own distribution at every angle.
#[test]
fn a_metal_under_a_smooth_coat_is_found_as_it_is() {
    let lobes = fitted(&stack(vec![layer(0.0, coat([0.0; 3])), layer(0.2, metal())]), 1);
    assert!(
        (lobes.frame.index - 1.5).abs() < 1e-9 && lobes.rows[0].lobes[0].tail > 0.8,
        "{} {:?}",
        lobes.frame.index,
        lobes.rows[0].lobes
    );
    // The more of the lobe the critical angle cuts off, the less of it is left to tell its width by.
    for (row, tolerance) in [(9, 0.1), (8, 0.12), (7, 0.2), (6, 0.3)] {
        let lobe = lobes.rows[row].lobes[0];
        assert!(lobe.sharpness.iter().all(|s| (s * 0.2 - 1.0).abs() < tolerance), "{row}: {lobe:?}");
        assert!(lobe.shift.abs() < 0.05, "{row}: {lobe:?}");
    }
}

/// Oracle: paths of the reference with other random numbers, and a quadrature of the values.
#[test]
fn energy_is_that_of_the_simulation() {
    let stack = lacquered();
    let lobes = fitted(&stack, 2);
    for theta_deg in [0.0, 25.0, 50.0, 70.0] {
        let wo = direction(theta_deg, 0.4);
        let prepared = lobes.prepare(wo).unwrap();
        for (channel, nm) in NM.into_iter().enumerate() {
            let mc = LayeredMc { seed: 77, ..LayeredMc::new(InterfaceMode::SmithWalk) };
            let expected = mc.albedo(&Monochrome::new(&stack, nm, channel), wo, 20_000).mean;
            let stated = prepared.albedo_dir()[channel];
            // A third of 8,000 paths each: a standard error of .006 or so.
            assert!((stated - expected).abs() < 0.025, "{theta_deg} {channel}: {stated} {expected}");
            let values = integral(wo, |wi| prepared.eval(wi)[channel]);
            assert!((values - stated).abs() < 0.02, "{theta_deg} {channel}: {values} {stated}");
        }
    }
}

/// Oracle: the integral of the density by quadrature, and the mean of the weights.
#[test]
fn samples_have_their_density() {
    let lobes = fitted(&lacquered(), 1);
    for theta_deg in [10.0, 60.0, 80.0] {
        let wo = direction(theta_deg, 2.0);
        let prepared = lobes.prepare(wo).unwrap();
        let side = 60;
        let (mut drawn, mut mean, mut greatest, mut right) = (0.0, 0.0, 0.0_f64, 0.0);
        let count = f64::from(side * side * side);
        for i in 0..side * side * side {
            let u = [i % side, i / side % side, i / side / side].map(|i| (f64::from(i) + 0.5) / f64::from(side));
            if let Some(sample) = prepared.sample(u) {
                drawn += 1.0 / count;
                mean += sample.weight[1] / count;
                greatest = greatest.max(sample.weight[1]);
                right += if sample.wi.dot(direction(90.0, 2.0)) < -0.5 { 1.0 / count } else { 0.0 };
                assert!((sample.wi.length() - 1.0).abs() < 1e-9 && sample.wi.z > 0.0);
            }
        }
        let whole = integral(wo, |wi| prepared.pdf_solid_angle(wi));
        assert!((whole - drawn).abs() < 0.01, "{theta_deg}: {whole} {drawn}");
        let half =
            integral(wo, |wi| if wi.dot(direction(90.0, 2.0)) < -0.5 { prepared.pdf_solid_angle(wi) } else { 0.0 });
        assert!((half - right).abs() < 0.02, "{theta_deg}: {half} {right}");
        let stated = prepared.albedo_dir()[1];
        assert!((mean - stated).abs() < 0.02, "{theta_deg}: {mean} {stated}");
        assert!(greatest < 2.5 * stated / drawn, "{theta_deg}: {greatest} {stated}");
    }
}

#[test]
fn nothing_comes_from_below_the_horizon_and_everything_is_finite() {
    let lobes = fitted(&lacquered(), 1);
    let below = DVec3::new(0.6, 0.0, -0.8);
    assert_eq!(lobes.eval(below, DVec3::Z), [0.0; 3]);
    assert!(lobes.prepare(below).is_none());
    for theta_o in [0.0, 45.0, 89.99] {
        for theta_i in [0.0, 60.0, 89.999] {
            for phi in [0.0, 1.5, 3.1] {
                let value = lobes.eval(direction(theta_i, phi), direction(theta_o, 0.3));
                assert!(value.iter().all(|v| v.is_finite() && *v >= -1e-6), "{theta_o} {theta_i}: {value:?}");
            }
        }
    }
}

/// A diffuse base alone has no first interface and needs no lobe.
#[test]
fn a_diffuse_base_is_the_wide_remainder() {
    let albedo = [0.2, 0.5, 0.8];
    let matte = stack(vec![layer(0.0, Base::Diffuse(Diffuse { albedo, sigma: 0.0 }))]);
    let lobes = fitted(&matte, 0);
    let found = lobes.eval(direction(40.0, 2.0), direction(30.0, 0.0));
    for (found, albedo) in found.into_iter().zip(albedo) {
        let expected = albedo * libm::cos(40.0_f64.to_radians()) / std::f64::consts::PI;
        assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
    }
}

/// Oracle: total reflection. From a medium of index 1.5 into air, flat light does not reach the base; steep light does.
#[test]
fn flat_views_see_nothing_below_a_thinner_medium() {
    let air = Base::Dielectric { ior: Ior::vacuum(), slab: Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] } };
    let matte = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
    let layers = vec![layer(0.0, air), layer(0.0, matte)];
    let stack = Stack { exterior: Ior::constant(1.5, 0.0).unwrap(), layers };
    let lobes = Simulation::new(&stack, &Color::Spectral, FitSettings { paths: 4096, ..FitSettings::default() }).fit(0);
    let wi = direction(20.0, 2.0);
    // The critical angle is 41.8 degrees.
    for theta_deg in [42.5, 44.0, 70.0] {
        let found = lobes.eval(wi, direction(theta_deg, 0.0))[0];
        // Rows are the nearest to a curve that bends at the kink.
        assert!(found < 4e-3, "{theta_deg}: {found}");
    }
    assert!(lobes.eval(wi, direction(35.0, 0.0))[0] > 0.05);
    // The other way around.
    assert!(lobes.eval(direction(50.0, 2.0), direction(20.0, 0.0))[0] < 0.01);
}

#[test]
fn settings_decide_everything() {
    let stack = lacquered();
    assert_eq!(fitted(&stack, 1).rows, fitted(&stack, 1).rows);
}

/// Oracle: a fit for each number of lobes by itself.
#[test]
fn fits_of_each_number_of_lobes_are_those_alone() {
    let settings = FitSettings { paths: 8192, ..FitSettings::default() };
    let simulation = Simulation::new(&lacquered(), &Color::ThreeWavelengths(NM), settings);
    for (most, lobes) in simulation.fit_each(2).iter().enumerate().skip(1) {
        assert_eq!(lobes.rows, simulation.fit_fewest(most, 0.0).rows, "{most}");
    }
}

/// Oracle: paths of the same coats over a base of another albedo. What the base sends back to itself is closed form for a Lambertian base.
#[test]
fn a_base_of_another_albedo_has_its_light() {
    let color = Color::ThreeWavelengths(NM);
    let clear = Base::Dielectric {
        ior: Ior::constant(1.8, 0.0).unwrap(),
        slab: Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] },
    };
    for (coats, tolerance) in [
        (vec![layer(0.0, coat([0.05, 0.1, 0.4]))], 4e-3),
        (vec![layer(0.15, coat([0.05, 0.1, 0.4]))], 0.02),
        (vec![layer(0.15, coat([0.0; 3])), layer(0.3, clear)], 0.025),
    ] {
        let over = |albedo: [f64; 3]| {
            stack([&coats[..], &[layer(0.0, Base::Diffuse(Diffuse { albedo, sigma: 0.0 }))]].concat())
        };
        let settings = FitSettings { paths: 16_384, ..FitSettings::default() };
        let lobes = Simulation::new(&over([0.8, 0.5, 0.3]), &color, settings).fit_fewest(2, 0.03);
        for albedo in [[0.0; 3], [0.2, 0.5, 0.8], [0.95; 3]] {
            for theta_deg in [0.0, 45.0, 80.0] {
                let wo = direction(theta_deg, 0.3);
                let mut expected = [0.0; 3];
                ColorPaths::new(&over(albedo), &color).trace(99, 60_000, wo, |path| {
                    (0..3).for_each(|c| expected[c] += path.weight[c] / 60_000.0);
                });
                let found = lobes.below(wo).unwrap().over_base(albedo).row().albedo_dir;
                for c in 0..3 {
                    let error = (found[c] - expected[c]).abs();
                    assert!(error < tolerance, "{albedo:?} {theta_deg} {c}: {} {}", found[c], expected[c]);
                }
            }
        }
        let wo = direction(30.0, 0.0);
        let (own, other) = (lobes.below(wo).unwrap(), lobes.below(wo).unwrap().over_base([0.8, 0.5, 0.3]));
        assert!((0..3).all(|c| (own.row().wide[c] - other.row().wide[c]).abs() < 1e-12));
    }
}

/// Oracle: a quadrature over half vectors, in place of drawn normals.
#[test]
fn energy_of_the_first_facet_is_its_integral() {
    let color = Color::ThreeWavelengths(NM);
    let film = |nm| Film { ior: Ior::constant(1.9, 0.0).unwrap(), thickness: FilmThickness { min_nm: nm, max_nm: nm } };
    for (distribution, films) in
        [(Distribution::Ggx, vec![]), (Distribution::Beckmann, vec![]), (Distribution::Ggx, vec![film(400.0)])]
    {
        for [alpha_x, alpha_y] in [[0.02; 2], [0.2; 2], [0.8; 2], [0.05, 0.4]] {
            let surface = Surface { alpha_x, alpha_y, ..Surface::isotropic(distribution, 0.0) };
            let layers = vec![Layer { films: films.clone(), surface, base: metal() }];
            let first = FirstInterface::of(&stack(layers), &color).unwrap();
            for theta_deg in [0.0, 40.0, 70.0, 80.0, 85.0, 89.0] {
                let wo = direction(theta_deg, 0.7);
                let expected = integral(wo, |wi| {
                    let lobe = first.facets.lobe(Masking::Smith, wi, wo);
                    lobe.map_or(0.0, |lobe| lobe.value * first.reflectance.rgb(lobe.cos_theta_d)[1])
                });
                let error = (first.energy(wo)[1] - expected).abs();
                assert!(error < 4e-4, "{distribution:?} {alpha_x} {alpha_y} {theta_deg}: {error:.1e} of {expected}");
            }
        }
    }
}

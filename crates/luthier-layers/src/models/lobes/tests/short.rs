//! Short lobes.

use luthier_optics::color::Color;
use luthier_optics::dielectric_albedo::fresnel_dielectric;
use luthier_optics::ior::{Ior, IorSample};
use luthier_optics::stack::{Base, Diffuse, Distribution, Slab, Stack, Surface};

use super::{NM, coat, direction, integral, lacquered, layer, metal, stack};
use crate::models::lobes::{Curve, FitSettings, Judge, Lobes, Simulation, may_be_short};

const COLOR: Color = Color::ThreeWavelengths(NM);

fn simulated(stack: &Stack) -> Simulation {
    Simulation::new(stack, &COLOR, FitSettings { rows: 10, paths: 8000, seed: 5 })
}

fn short() -> Lobes {
    simulated(&lacquered()).fit_short().unwrap()
}

/// Oracle: Fresnel's equations.
#[test]
fn the_reflectance_is_near_to_fresnels() {
    let curve = short().frame.curve.unwrap();
    for step in 0..=100 {
        let cos_theta = f64::from(step) / 100.0;
        let (found, expected) = (curve.at(cos_theta), fresnel_dielectric(1.5, cos_theta));
        assert!((found - expected).abs() < 2.5e-3, "{cos_theta}: {found} {expected}");
    }
}

/// Oracles: rows of two lobes from the same paths, and a quadrature of the values.
#[test]
fn a_short_lobe_keeps_the_energy_of_the_simulation() {
    let (short, two) = (short(), simulated(&lacquered()).fit(2));
    for (row, other) in short.rows.iter().zip(&two.rows) {
        for (found, expected) in row.albedo_dir.iter().zip(other.albedo_dir) {
            assert!((found - expected).abs() < 1e-5, "{found} {expected}");
        }
        assert_eq!((row.wide, row.lobes.len()), ([0.0; 3], 1));
    }
    for theta_deg in [0.0, 25.0, 50.0, 70.0] {
        let prepared = short.prepare(direction(theta_deg, 0.4)).unwrap();
        for channel in 0..3 {
            let stated = prepared.albedo_dir()[channel];
            let values = integral(direction(theta_deg, 0.4), |wi| prepared.eval(wi)[channel]);
            assert!((values - stated).abs() < 0.012, "{theta_deg} {channel}: {values} {stated}");
        }
    }
}

/// Oracle: a quadrature of the values, which sees what the polynomial of a steep index reflects too much, and that as much is missing below it.
#[test]
fn a_polynomial_keeps_the_energy_of_the_simulation() {
    let steep = Base::Dielectric {
        ior: Ior::constant(2.5, 0.0).unwrap(),
        slab: Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] },
    };
    let own = simulated(&stack(vec![layer(0.2, steep), layer(0.3, metal())])).fit(1);
    let curved = own.clone().of_curve().unwrap();
    let mut bright = own.clone();
    bright.frame.curve = curved.frame.curve;
    let mut most = 0.0_f64;
    for theta_deg in [0.0, 25.0, 50.0, 65.0, 75.0] {
        let wo = direction(theta_deg, 0.4);
        let [own, curved, bright] = [&own, &curved, &bright].map(|lobes| lobes.prepare(wo).unwrap());
        let [without, with, more] = [&own, &curved, &bright].map(|lobes| integral(wo, |wi| lobes.eval(wi)[0]));
        most = most.max((more - without).abs());
        assert!((own.albedo_dir()[0] - curved.albedo_dir()[0]).abs() < 1e-9, "{theta_deg}");
        assert!((with - without).abs() < 2e-4, "{theta_deg}: {with} {without}");
    }
    assert!(most > 8e-4, "{most}");
}

/// One lobe with the tail of GGX is near to light of GGX. A judge sees what the reflectance adds.
#[test]
fn a_judge_tells_how_near_it_is() {
    let judge = Judge::new(&lacquered(), &COLOR, None);
    let (short, none) = (short(), simulated(&lacquered()).fit(0));
    let [near, far] = [&short, &none].map(|lobes| judge.error_of(|_| lobes.clone()).lobe);
    assert!(near < 0.06 && far > 0.3, "{near} {far}");
    let mut bright = short.clone();
    let Some(Curve(numbers)) = &mut bright.frame.curve else { panic!("no curve") };
    numbers[0] += 0.3;
    let found = judge.error_of(|_| bright.clone()).lobe;
    assert!(found > near + 0.05, "{found} {near}");
}

/// Colours of a metal have no one polynomial, and anisotropic facets none at all.
#[test]
fn coloured_and_anisotropic_first_interfaces_have_no_polynomial() {
    let mut brushed = lacquered();
    brushed.layers[0].surface = Surface { distribution: Distribution::Ggx, alpha_x: 0.4, alpha_y: 0.15, rotation: 0.3 };
    let steps = [(0.2, 3.9), (0.9, 2.4), (1.2, 2.2)];
    let colored = NM.into_iter().zip(steps).map(|(wavelength_nm, (n, k))| IorSample { wavelength_nm, n, k });
    let copper = Base::Conductor { ior: Ior::sampled(colored.rev().collect()).unwrap() };
    assert!(simulated(&stack(vec![layer(0.2, metal())])).fit(0).of_curve().is_some());
    for other in [stack(vec![layer(0.2, copper)]), brushed] {
        assert!(simulated(&other).fit(0).of_curve().is_none(), "{other:?}");
    }
}

#[test]
fn anisotropic_stacks_and_diffuse_bases_have_none() {
    let mut brushed = lacquered();
    brushed.layers[1].surface = Surface { distribution: Distribution::Ggx, alpha_x: 0.4, alpha_y: 0.15, rotation: 0.3 };
    let base = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
    let painted = stack(vec![layer(0.2, coat([0.0; 3])), layer(0.2, coat([0.0; 3])), layer(0.0, base)]);
    let bare = stack(vec![layer(0.2, metal())]);
    assert!(may_be_short(&lacquered()));
    for other in [brushed, painted, bare] {
        assert!(!may_be_short(&other), "{other:?}");
    }
}

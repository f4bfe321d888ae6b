//! Weights of draws: a bound on the largest, over stacks, places and views.

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};

use super::{NM, coat, direction, layer, metal, stack};
use crate::models::lobes::{Family, FitSettings, Lobes, Mix, Paint, Simulation, Slopes, Varied, Varying, most_lobes};

const SETTINGS: FitSettings = FitSettings { rows: 10, paths: 8000, seed: 5 };

/// Views, degrees from the normal.
const VIEWS: [f64; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0];

const DRAWN: u32 = 1 << 13;

/// A limit of the largest weight over the albedo, each the mean of its channels. Facets of GGX of an index of 1.33 over black have 1.6; the aim is [`AIM`].
const LIMIT: f64 = 1.61;

const AIM: f64 = 1.5;

/// Share of the views whose largest weight may be above [`AIM`].
const BEYOND: f64 = 0.03;

/// Greatest weight of the draws of a view, over the albedo.
fn greatest(lobes: &Lobes, wo: DVec3) -> f64 {
    let prepared = lobes.prepare(wo).unwrap();
    let albedo: f64 = prepared.albedo_dir().iter().sum();
    // A lattice (Roberts 2018), whose second number is denser at both ends every other time.
    let steps = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    let draws = (0..DRAWN).filter_map(|i| {
        let [choice, u, v] = steps.map(|step: f64| (0.5 + step * f64::from(i)).fract());
        let u = if i % 2 == 0 { u } else { u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) };
        prepared.sample([choice, u, v])
    });
    draws.map(|sample| sample.weight.iter().sum::<f64>() / albedo).fold(0.0, f64::max)
}

/// Greatest weights of all views.
fn of_views(name: &str, lobes: &Lobes) -> Vec<f64> {
    let found: Vec<f64> = VIEWS.iter().map(|&theta| greatest(lobes, direction(theta, 0.4))).collect();
    eprintln!("{name:36} {}", found.iter().map(|weight| format!("{weight:.2}")).collect::<Vec<_>>().join(" "));
    found
}

fn judge(found: &[f64], limit: f64, share_beyond: f64) {
    let beyond = found.iter().filter(|weight| **weight > AIM).count() as f64 / found.len() as f64;
    let most = found.iter().copied().fold(0.0, f64::max);
    eprintln!("{} views: {most:.3} at most, {beyond:.3} of them above {AIM}", found.len());
    assert!(most < limit && beyond <= share_beyond, "{most} {beyond}");
}

fn clear(index: f64) -> Base {
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] };
    Base::Dielectric { ior: Ior::constant(index, 0.0).unwrap(), slab }
}

fn matt(albedo: [f64; 3]) -> Layer {
    layer(0.0, Base::Diffuse(Diffuse { albedo, sigma: 0.0 }))
}

fn fitted(stack: &Stack) -> Lobes {
    Simulation::new(stack, &Color::ThreeWavelengths(NM), SETTINGS).fit_fewest(most_lobes(stack), 0.03)
}

/// Coats of all roughnesses over black, red and white, over metals, and metals; one of them brushed.
#[test]
fn weights_of_materials_are_bounded() {
    let mut found = Vec::new();
    for alpha in [0.01, 0.1, 0.3, 0.6, 1.0] {
        for (index, albedo) in [(1.33, [0.0; 3]), (1.5, [0.0; 3]), (1.5, [0.8, 0.1, 0.05]), (1.9, [0.9; 3])] {
            let lobes = fitted(&stack(vec![layer(alpha, clear(index)), matt(albedo)]));
            found.extend(of_views(&format!("{alpha} of {index} over {albedo:?}"), &lobes));
        }
        for (base, tint) in [(0.05, 0.0), (0.2, 2.0), (0.5, 0.0)] {
            let lobes = fitted(&stack(vec![layer(alpha, coat([tint, 0.5 * tint, 0.0])), layer(base, metal())]));
            found.extend(of_views(&format!("{alpha} over a metal of {base}"), &lobes));
        }
        found.extend(of_views(&format!("metal of {alpha}"), &fitted(&stack(vec![layer(alpha, metal())]))));
    }
    for alpha in [0.05, 0.2, 0.4, 0.7, 1.0] {
        for albedo in [[0.0; 3], [0.5, 0.2, 0.1]] {
            let mut rough = stack(vec![layer(alpha, clear(1.5)), matt(albedo)]);
            rough.layers[0].surface.distribution = Distribution::Beckmann;
            found.extend(of_views(&format!("Beckmann {alpha} over {albedo:?}"), &fitted(&rough)));
        }
    }
    let mut brushed = stack(vec![layer(0.2, coat([0.0; 3])), layer(0.3, metal())]);
    brushed.layers[1].surface = Surface { distribution: Distribution::Ggx, alpha_x: 0.4, alpha_y: 0.15, rotation: 0.3 };
    found.extend(of_views("brushed", &fitted(&brushed)));
    judge(&found, LIMIT, BEYOND);
}

#[test]
fn weights_of_short_lobes_are_bounded() {
    let mut found = Vec::new();
    for (coat_alpha, base) in [(0.01, 0.2), (0.1, 0.05), (0.1, 0.3), (0.3, 0.2), (0.6, 0.5)] {
        for tint in [0.0, 2.0] {
            let lacquered = stack(vec![layer(coat_alpha, coat([tint, 0.5 * tint, 0.0])), layer(base, metal())]);
            let simulation = Simulation::new(&lacquered, &Color::ThreeWavelengths(NM), SETTINGS);
            if let Some(lobes) = simulation.fit_short() {
                found.extend(of_views(&format!("{coat_alpha} over a metal of {base}, tint {tint}"), &lobes));
            }
        }
    }
    assert!(found.len() >= 8 * VIEWS.len(), "{}", found.len());
    judge(&found, LIMIT, BEYOND);
}

/// A family with and without metal, below coats and without.
#[test]
fn weights_at_places_of_a_family_are_bounded() {
    let interface = Base::Dielectric {
        ior: Ior::constant(1.5 * DIELECTRIC_INDEX, 0.0).unwrap().with_f0([0.04; 3]),
        slab: Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] },
    };
    let whole = stack(vec![layer(0.3, coat([0.0; 3])), layer(0.5, interface), matt([0.5; 3])]);
    let family = Family::new(&whole, [0.05, 0.5], [0.1, 0.8], true).unwrap();
    let varied = Varied::with(&whole, &Color::ThreeWavelengths(NM), Some(Varying::Family(family)), SETTINGS);
    let mut found = Vec::new();
    let brushed = Slopes { along: [0.6, 0.2], turn: [0.6, 0.8] };
    let places: [[Slopes; 2]; 5] = [
        [0.05.into(), 0.1.into()],
        [0.05.into(), 0.6.into()],
        [0.25.into(), 0.3.into()],
        [0.5.into(), 0.8.into()],
        [0.2.into(), brushed],
    ];
    for slopes in places {
        for (shade, metallic) in [([0.9, 0.6, 0.3], 1.0), ([0.7, 0.4, 0.2], 0.0), ([0.02; 3], 0.0), ([0.8; 3], 0.5)] {
            let level = family.apply(&whole, slopes);
            let mix = Mix { metal: shade, tint: [1.0; 3], dielectric: [0.04; 3], matt: shade, metallic };
            let lobes = varied.painted(slopes, &Paint::of(&level).mixed(mix)).unwrap();
            found.extend(of_views(&format!("{:?} {shade:?} {metallic}", slopes.map(|slope| slope.along)), &lobes));
        }
    }
    judge(&found, AIM, 0.0);
}

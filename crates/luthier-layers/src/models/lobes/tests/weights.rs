//! Weights of draws: a bound on the largest, over stacks, places and views.

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Layer, Slab, Stack};

use super::{NM, direction, layer, metal, stack};
use crate::models::lobes::{FitSettings, Lobes, Simulation, most_lobes};

const SETTINGS: FitSettings = FitSettings { rows: 10, paths: 8000, seed: 5 };

/// Views, degrees from the normal.
const VIEWS: [f64; 10] = [0.0, 15.0, 30.0, 45.0, 52.0, 60.0, 70.0, 75.0, 80.0, 85.0];

const DRAWN: u32 = 1 << 14;

/// Greatest weight of the draws of a view, the mean of its channels, over that of the albedo; and the share of draws without weight.
fn greatest(lobes: &Lobes, wo: DVec3) -> (f64, f64, usize) {
    let prepared = lobes.prepare(wo).unwrap();
    let albedo: f64 = prepared.albedo_dir().iter().sum();
    // A lattice (Roberts 2018), whose second number is denser at both ends.
    let steps = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    let (mut most, mut lost, mut part) = (0.0, 0.0, 0);
    for i in 0..DRAWN {
        let [choice, u, v] = steps.map(|step: f64| (0.5 + step * f64::from(i)).fract());
        let u = if i % 2 == 0 { u } else { u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) };
        match prepared.sample([choice, u, v]) {
            Some(sample) => {
                let weight = sample.weight.iter().sum::<f64>() / albedo;
                if weight > most {
                    (most, part) = (weight, sample.part);
                }
            }
            None => lost += if i % 2 == 0 { 2.0 / f64::from(DRAWN) } else { 0.0 },
        }
    }
    (most, lost, part)
}

fn clear(index: f64, absorption_per_um: [f64; 3]) -> Base {
    Base::Dielectric { ior: Ior::constant(index, 0.0).unwrap(), slab: Slab { thickness_um: 1.0, absorption_per_um } }
}

fn matt(albedo: [f64; 3]) -> Layer {
    layer(0.0, Base::Diffuse(Diffuse { albedo, sigma: 0.0 }))
}

fn fitted(stack: &Stack) -> Lobes {
    Simulation::new(stack, &Color::ThreeWavelengths(NM), SETTINGS).fit_fewest(most_lobes(stack), 0.03)
}

fn report(name: &str, lobes: &Lobes) -> f64 {
    let mut worst = 0.0_f64;
    let mut line = format!("{name:28}");
    for theta in VIEWS {
        let wo = direction(theta, 0.4);
        let (most, lost, part) = greatest(lobes, wo);
        let below = lobes.below(wo).unwrap();
        let row = below.row();
        let shares: Vec<String> = row.lobes.iter().map(|lobe| format!("{:.2}", lobe.share)).collect();
        if [0.0, 45.0, 75.0, 85.0].contains(&theta) {
            let n = lobes.frame.index;
            let sin = libm::hypot(wo.x, wo.y);
            let radius = 1.0 / ((wo.z * wo.z + n * n - 1.0).sqrt() + (n * n - 1.0).max(0.0).sqrt());
            let total: f64 = row.albedo_dir.iter().sum();
            for lobe in &row.lobes {
                let shape = lobe.in_plane(sin);
                let e: f64 = lobe.strength.iter().sum::<f64>() * lobe.share / total;
                eprintln!("LOBE {name} {theta} n {n:.2} share {:.2} e {e:.2} mid {:.2} w {:.2} {:.2} t {:.2}", lobe.share, (shape.middle[0] - sin * radius) / radius, shape.width[0] / radius, shape.width[1] / radius, shape.tail);
            }
        }
        line += &format!(" {theta}: {most:.2}@{part} l{:.0}% s{}", lost * 100.0, shares.join(","));
        worst = worst.max(most);
    }
    let wide = lobes.frame.wide;
    eprintln!("{line} WIDE {:?} {:.3} max {:.3} crit {:?}", wide.falloff(), wide.integral(), (0..101).map(|i| wide.value(f64::from(i) * 0.01)).fold(0.0, f64::max) / wide.integral(), lobes.axis.critical());
    worst
}

#[test]
fn weights_of_uniform_materials_are_bounded() {
    let mut worst = 0.0_f64;
    for alpha in [0.01, 0.1, 0.3, 0.6, 1.0] {
        for index in [1.33, 1.5, 1.9] {
            for albedo in [[0.0; 3], [0.03; 3], [0.8, 0.1, 0.05], [0.9; 3]] {
                let lobes = fitted(&stack(vec![layer(alpha, clear(index, [0.0; 3])), matt(albedo)]));
                worst = worst.max(report(&format!("{alpha} {index} matt {albedo:?}"), &lobes));
            }
        }
        for base in [0.05, 0.2, 0.5] {
            for tint in [0.0, 2.0] {
                let lobes = fitted(&stack(vec![layer(alpha, clear(1.5, [tint, 0.5 * tint, 0.0])), layer(base, metal())]));
                worst = worst.max(report(&format!("{alpha} metal {base} {tint}"), &lobes));
            }
        }
        worst = worst.max(report(&format!("{alpha} metal"), &fitted(&stack(vec![layer(alpha, metal())]))));
    }
    eprintln!("{worst}");
}

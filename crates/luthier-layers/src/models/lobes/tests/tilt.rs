//! Lobes that flakes tilt, against a walk of light between a smooth coat and a tilted metal; lobes of many normals, against their mean.

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::fresnel::interface;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Layer, Slab, Stack, Surface};
use num_complex::Complex64;

use crate::formulas::facets::Facets;
use crate::frame;
use crate::models::lobes::{Below, FitSettings, Lobes, Simulation};

const INDEX: f64 = 1.5;
const METAL: [f64; 2] = [0.3, 3.0];
const ALPHA: f64 = 0.2;

fn coated_metal() -> Stack {
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] };
    let layer = |alpha, base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, alpha), base };
    let coat = layer(0.0, Base::Dielectric { ior: Ior::constant(INDEX, 0.0).unwrap(), slab });
    let metal = layer(ALPHA, Base::Conductor { ior: Ior::constant(METAL[0], METAL[1]).unwrap() });
    Stack { exterior: Ior::vacuum(), layers: vec![coat, metal] }
}

/// Energies on a grid over the projected hemisphere.
const SIDE: usize = 20;

type Grid = Vec<f64>;

fn cell(wi: DVec3) -> usize {
    let at = |x: f64| ((0.5 * (x + 1.0) * SIDE as f64) as usize).min(SIDE - 1);
    at(wi.x) * SIDE + at(wi.y)
}

/// Paths of light from the eye: refracted at the plane of the coat, mirrored by facets of the metal around its tilted normal, and at the coat
/// let out or mirrored back. The metal's light that its own facets block is lost.
fn walked(wo: DVec3, normal: DVec3, paths: u64) -> Grid {
    let facets = Facets::new(&Surface::isotropic(Distribution::Ggx, ALPHA));
    let [outside, coat, metal] =
        [Complex64::new(1.0, 0.0), Complex64::new(INDEX, 0.0), Complex64::new(METAL[0], METAL[1])];
    // Into the frame of a normal and back: the least rotation, whose inverse has the normal's mirror image.
    let back = DVec3::new(-normal.x, -normal.y, normal.z);
    let mut grid = vec![0.0; SIDE * SIDE];
    let mut state = 7_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let reflected = interface(outside, coat, wo.z).unpolarised();
    for _ in 0..paths {
        let (x, y) = (wo.x / INDEX, wo.y / INDEX);
        let mut w = DVec3::new(x, y, (1.0 - x * x - y * y).sqrt());
        let mut weight = (1.0 - reflected) / paths as f64;
        for _ in 0..20 {
            let from = frame::local(normal, w);
            if from.z <= 0.0 {
                break;
            }
            let wh = facets.sample(from, [uniform(), uniform()]);
            let to = 2.0 * from.dot(wh) * wh - from;
            w = frame::local(back, to);
            if to.z <= 0.0 || w.z <= 0.0 {
                break;
            }
            let (lambda_from, lambda_to) = (facets.lambda(from), facets.lambda(to));
            weight *= interface(coat, metal, from.dot(wh)).unpolarised() * (1.0 + lambda_from)
                / (1.0 + lambda_from + lambda_to);
            let inside = interface(coat, outside, w.z).unpolarised();
            if uniform() >= inside {
                let (x, y) = (w.x * INDEX, w.y * INDEX);
                grid[cell(DVec3::new(x, y, 0.0))] += weight;
                break;
            }
            // Mirrored by the coat: towards the metal from the other side.
            w = DVec3::new(-w.x, -w.y, w.z);
        }
    }
    grid
}

/// The light below of a model, by the midpoint rule.
fn modelled(lobes: &Lobes, wo: DVec3, normal: DVec3) -> Grid {
    let below = lobes.below(wo).unwrap().tilted(normal, INDEX);
    gathered(20, |wi| below.eval(wi)[1])
}

/// A function of the light, by the midpoint rule with so many points along each side of a cell.
fn gathered(finer: usize, value: impl Fn(DVec3) -> f64) -> Grid {
    let mut grid = vec![0.0; SIDE * SIDE];
    let fine = SIDE * finer;
    let at = |i: usize| 2.0 * (i as f64 + 0.5) / fine as f64 - 1.0;
    for (i, j) in (0..fine).flat_map(|i| (0..fine).map(move |j| (i, j))) {
        let (x, y) = (at(i), at(j));
        let cos_sq = 1.0 - x * x - y * y;
        if cos_sq > 0.0 {
            let wi = DVec3::new(x, y, cos_sq.sqrt());
            grid[cell(wi)] += value(wi) / wi.z * 4.0 / (fine * fine) as f64;
        }
    }
    grid
}

fn lobe_error(model: &Grid, truth: &Grid) -> f64 {
    let moved: f64 = model.iter().zip(truth).map(|(a, b)| (a - b).abs()).sum();
    0.5 * moved / truth.iter().sum::<f64>()
}

fn fitted() -> Lobes {
    let settings = FitSettings { rows: 19, paths: 16_000, seed: 1 };
    Simulation::new(&coated_metal(), &Color::ThreeWavelengths([550.0; 3]), settings).fit(1)
}

/// Oracle: the mean of the model over normals whose slopes are normal with the variance, by the midpoint rule.
#[test]
fn a_variance_of_slopes_is_the_mean_over_normals() {
    let lobes = fitted();
    const STEPS: i32 = 13;
    for theta_deg in [0.0, 40.0, 60.0] {
        let (sin, cos) = libm::sincos(f64::to_radians(theta_deg));
        let wo = DVec3::new(sin * 0.6, sin * 0.8, cos);
        for deviation in [0.05, 0.15] {
            let slopes = |i: i32| 2.5 * f64::from(2 * i + 1 - STEPS) / f64::from(STEPS);
            let mut normals = Vec::new();
            let mut total = 0.0;
            for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
                let (x, y) = (slopes(i), slopes(j));
                let weight = libm::exp(-0.5 * (x * x + y * y));
                let normal = DVec3::new(deviation * x, deviation * y, 1.0).normalize();
                let below = lobes.below(frame::local(normal, wo));
                normals.push((weight, normal, below));
                total += weight;
            }
            let mean = |wi: DVec3| {
                let value = |(weight, normal, below): &(f64, DVec3, Option<Below>)| {
                    let here = frame::local(*normal, wi);
                    let value = below.as_ref().filter(|_| here.z > 0.0).map_or(0.0, |below| below.eval(here)[1]);
                    weight / total * value
                };
                normals.iter().map(value).sum::<f64>()
            };
            let truth = gathered(4, mean);
            let below = lobes.below(wo).unwrap();
            let wide = below.clone().widened(wo, deviation * deviation);
            let [found, left] = [wide, below].map(|below| lobe_error(&gathered(4, |wi| below.eval(wi)[1]), &truth));
            // A third of the error that the variance makes goes, at least; of a deviation of .15 the slopes are a distribution of another shape.
            assert!(found < 0.7 * left && found < 0.05, "{theta_deg} {deviation}: {found} {left}");
        }
    }
}

/// The lobe error of a tilted fit is little more than that of the fit, and a fraction of that of a fit that is not tilted.
#[test]
fn tilted_lobes_are_those_of_a_tilted_metal() {
    let lobes = fitted();
    let normal = |tilt_deg: f64, phi: f64| {
        let (sin, cos) = libm::sincos(f64::to_radians(tilt_deg));
        DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
    };
    for theta_deg in [0.0, 40.0, 65.0] {
        let (sin, cos) = libm::sincos(f64::to_radians(theta_deg));
        let wo = DVec3::new(sin * 0.6, sin * 0.8, cos);
        let straight = lobe_error(&modelled(&lobes, wo, DVec3::Z), &walked(wo, DVec3::Z, 200_000));
        for (tilt_deg, phi) in [(5.0, 0.3), (10.0, 2.5), (20.0, 4.0)] {
            let truth = walked(wo, normal(tilt_deg, phi), 200_000);
            let tilted = lobe_error(&modelled(&lobes, wo, normal(tilt_deg, phi)), &truth);
            let left = lobe_error(&modelled(&lobes, wo, DVec3::Z), &truth);
            // At 20 degrees terms of second order count, and much of the light no longer leaves the coat.
            let most = if tilt_deg <= 10.0 { straight + 0.06 } else { 0.6 };
            assert!(tilted < most && tilted < 0.8 * left, "{theta_deg} {tilt_deg}: {straight} {tilted} {left}");
        }
    }
}

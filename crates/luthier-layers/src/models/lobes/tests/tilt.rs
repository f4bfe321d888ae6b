//! Lobes that flakes and own normals tilt, against walks of light between a smooth coat and a tilted base; lobes of many normals, against their mean.

use glam::DVec3;
use luthier_model::ShadingModel;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::fresnel::interface;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};
use num_complex::Complex64;

use crate::effects::layer_sample::LayerSample;
use crate::formulas::facets::Facets;
use crate::frame;
use crate::layers::ALPHA_MIN;
use crate::models::lobes::{Below, Family, FitSettings, Lobes, Paint, Simulation, Varied, Varying};
use crate::models::parts::Parts;
use crate::models::shade::{ShaderTerms, Under};
use crate::models::statistics::diffuse_base::Veil;
use crate::models::statistics::energy::Energy;
use crate::terms::Terms;
use crate::twins::shaded::{Part, Place, Shaded};
use crate::twins::terms::Exact;

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

/// A direction at an angle to the normal, in degrees, and an azimuth.
fn leaning(tilt_deg: f64, phi: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(f64::to_radians(tilt_deg));
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}

/// The eye in the tests of tilts.
fn eye(theta_deg: f64) -> DVec3 {
    leaning(theta_deg, EYE_PHI)
}

const EYE_PHI: f64 = 0.927_295_218;

/// The lobe error of a tilted fit is little more than that of the fit, and a fraction of that of a fit that is not tilted.
#[test]
fn tilted_lobes_are_those_of_a_tilted_metal() {
    let lobes = fitted();
    for theta_deg in [0.0, 40.0, 65.0, 80.0] {
        let wo = eye(theta_deg);
        let straight = lobe_error(&modelled(&lobes, wo, DVec3::Z), &walked(wo, DVec3::Z, 200_000));
        for (tilt_deg, phi, most) in [
            (5.0, 0.3, 0.02),
            (5.0, 2.5, 0.02),
            (10.0, EYE_PHI, 0.03),
            (10.0, 4.0, 0.08),
            (20.0, EYE_PHI, 0.11),
            (20.0, 4.0, 0.6),
        ] {
            let normal = leaning(tilt_deg, phi);
            let truth = walked(wo, normal, 200_000);
            let tilted = lobe_error(&modelled(&lobes, wo, normal), &truth);
            let left = lobe_error(&modelled(&lobes, wo, DVec3::Z), &truth);
            // At 20 degrees terms of second order count, and much of the light no longer leaves the coat.
            assert!(
                tilted < straight + most && tilted < 0.8 * left,
                "{theta_deg} {tilt_deg} {phi}: {straight} {tilted} {left}"
            );
        }
    }
}

/// Light from everywhere that a place returns, over one for each sort of lobes: round and long, with the tails of both distributions.
#[test]
fn tilted_lobes_return_no_more_than_falls_in() {
    for (distribution, alpha, coat_alpha) in [
        (Distribution::Ggx, 0.2, 0.0),
        (Distribution::Ggx, 0.5, 0.1),
        (Distribution::Beckmann, 0.05, 0.05),
        (Distribution::Ggx, 0.05, 0.3),
    ] {
        let mut stack = coated_metal();
        stack.layers[0].surface = Surface::isotropic(distribution, coat_alpha);
        let white = Base::Conductor { ior: Ior::constant(0.0, 1000.0).unwrap() };
        stack.layers[1] = Layer { films: vec![], surface: Surface::isotropic(distribution, alpha), base: white };
        let lobes = Lobes::of(&stack, &Color::ThreeWavelengths([550.0; 3]));
        for theta_deg in [0.0, 40.0, 65.0, 80.0, 88.0] {
            let wo = eye(theta_deg);
            let first = lobes.first.as_ref().unwrap().energy(wo)[1];
            for (tilt_deg, most) in [(5.0, 1.003), (10.0, 1.003), (20.0, 1.01), (40.0, 1.01)] {
                for phi in [0.3, EYE_PHI, 2.5, 4.0] {
                    let below = lobes.below(wo).unwrap().tilted(leaning(tilt_deg, phi), INDEX);
                    let found = first + gathered(20, |wi| below.eval(wi)[1]).iter().sum::<f64>();
                    let stated = below.row().albedo_dir[1];
                    let case = format!("{distribution:?} {alpha} {theta_deg} {tilt_deg} {phi}: {found} {stated}");
                    assert!(found < most && (found - stated).abs() < 0.1, "{case}");
                }
            }
        }
    }
}

/// Between two directions on either side of a boundary of a normal: that of the medium of index `into`, from the one of index `from`.
fn across(w: DVec3, normal: DVec3, from: f64, into: f64) -> DVec3 {
    // The part along the boundary keeps its length times the index.
    let along = (w - normal * w.dot(normal)) * (from / into);
    along + normal * (1.0 - along.length_squared()).max(0.0).sqrt() * w.dot(normal).signum()
}

/// Paths of light from the eye, in the frame of the surface, through a smooth coat of a normal of its own to a base of another. `bounce` has a direction
/// from the base, and its weight, for one to it in the frame of the base.
fn walked_between(
    wo: DVec3,
    coat: DVec3,
    base: DVec3,
    paths: u64,
    bounce: impl Fn(DVec3, &mut dyn FnMut() -> f64) -> Option<(DVec3, f64)>,
) -> Grid {
    let [outside, inside] = [Complex64::new(1.0, 0.0), Complex64::new(INDEX, 0.0)];
    let mut grid = vec![0.0; SIDE * SIDE];
    let mut state = 11_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..paths {
        let mut w = across(wo, coat, 1.0, INDEX);
        let mut weight = (1.0 - interface(outside, inside, wo.dot(coat)).unpolarised()) / paths as f64;
        for _ in 0..30 {
            let from = frame::local(base, w);
            let Some((to, share)) = (from.z > 0.0).then(|| bounce(from, &mut uniform)).flatten() else { break };
            weight *= share;
            w = frame::local(DVec3::new(-base.x, -base.y, base.z), to);
            let up = w.dot(coat);
            if up <= 0.0 {
                break;
            }
            if uniform() >= interface(inside, outside, up).unpolarised() {
                let wi = across(w, coat, INDEX, 1.0);
                if wi.z > 0.0 {
                    grid[cell(wi)] += weight;
                }
                break;
            }
            // Mirrored by the coat: towards the base from the other side.
            w = 2.0 * up * coat - w;
        }
    }
    grid
}

/// `f cos_theta_i` of the twin without the first facets, of a stack whose layers have normals of their own, on the grid of the surface.
fn twin_below(stack: &Stack, lobes: &Lobes, own: [DVec3; 2], flake: DVec3, wo: DVec3) -> Grid {
    let color = Color::ThreeWavelengths([550.0; 3]);
    let layers = own.map(|normal| LayerSample { normal, ..LayerSample::NONE });
    let under = Under { flake_normal: flake, ..Under::NONE };
    let place = Place { layers: layers.to_vec(), under, ..Place::NONE };
    // A first interface that reflects nothing.
    let terms = |_: Part, _: &Stack, _: &Stack| Some(Dark(Exact::with_lobes(stack, color, lobes.clone())));
    let parts = Parts::PLAIN;
    let shaded = Shaded::of_terms(terms, ShadingModel::Lobes, stack, [550.0; 3], color, &place, parts).unwrap();
    gathered(20, |wi| shaded.eval(wi, wo)[1])
}

/// Terms of lobes without the light of the first interface.
#[derive(Debug)]
struct Dark(Exact);

impl Terms for Dark {
    fn fresnel(&self, _: usize, _: f64) -> Rgb {
        [0.0; 3]
    }
}

impl Energy<3> for Dark {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
        self.0.fgd(layer, cos_theta_i, alpha)
    }
}

impl ShaderTerms for Dark {
    fn veil(&self) -> Veil<3> {
        self.0.veil()
    }

    fn below(&self, wo: DVec3) -> Option<Below> {
        self.0.below(wo)
    }
}

/// Own normals of the coat, of the base and of both, over a metal, and flakes beside them. Oracle: paths in the frame of the surface, which know no relative normals.
#[test]
fn own_normals_are_those_of_tilted_interfaces() {
    let (stack, lobes) = (coated_metal(), fitted());
    let facets = Facets::new(&Surface::isotropic(Distribution::Ggx, ALPHA));
    let [coat, metal] = [Complex64::new(INDEX, 0.0), Complex64::new(METAL[0], METAL[1])];
    let bounce = |from: DVec3, uniform: &mut dyn FnMut() -> f64| {
        let wh = facets.sample(from, [uniform(), uniform()]);
        let to = 2.0 * from.dot(wh) * wh - from;
        let (lambda_from, lambda_to) = (facets.lambda(from), facets.lambda(to));
        let passed = (1.0 + lambda_from) / (1.0 + lambda_from + lambda_to);
        (to.z > 0.0).then(|| (to, interface(coat, metal, from.dot(wh)).unpolarised() * passed))
    };
    for theta_deg in [10.0, 50.0] {
        let wo = eye(theta_deg);
        // Flakes turn what lies below the coat in the frame of the coat, and the metal has its own normal there.
        let error = |own: [DVec3; 2], flake: DVec3| {
            let back = |normal: DVec3| DVec3::new(-normal.x, -normal.y, normal.z);
            let turned = frame::local(back(flake), frame::local(own[0], own[1]));
            let truth = walked_between(wo, own[0], frame::local(back(own[0]), turned), 100_000, bounce);
            lobe_error(&twin_below(&stack, &lobes, own, flake, wo), &truth)
        };
        let straight = error([DVec3::Z; 2], DVec3::Z);
        for (tilt_deg, most) in [(5.0, 0.03), (10.0, 0.1), (20.0, 0.6)] {
            let [a, b] = [leaning(tilt_deg, 2.0), leaning(0.5 * tilt_deg, -0.4)];
            for own in [[a, DVec3::Z], [DVec3::Z, a], [a, a], [a, b]] {
                let found = error(own, DVec3::Z);
                assert!(found < straight + most, "{theta_deg} {tilt_deg} {own:?}: {found} {straight}");
            }
            // Beside flakes, the metal leans against the coat by as much as above.
            let (flake, less) = (leaning(0.5 * tilt_deg, 0.5), leaning(0.5 * tilt_deg, -0.4));
            for own in [[less, DVec3::Z], [DVec3::Z, less]] {
                let found = error(own, flake);
                assert!(found < straight + most, "{theta_deg} {tilt_deg} {own:?}, flakes: {found} {straight}");
            }
        }
    }
}

/// Own normals over a diffuse base, which has no lobe, with rows of the stack and with those of a family in a colour that no fit saw. Oracle: paths in the frame
/// of the surface.
#[test]
fn a_diffuse_base_leans() {
    const WHITE: f64 = 0.7;
    let mut stack = coated_metal();
    stack.layers[1].surface = Surface::smooth();
    stack.layers[1].base = Base::Diffuse(Diffuse { albedo: [WHITE; 3], sigma: 0.0 });
    let color = Color::ThreeWavelengths([550.0; 3]);
    let lobes = Lobes::of(&stack, &color);
    let mut darker = stack.clone();
    darker.layers[1].base = Base::Diffuse(Diffuse { albedo: [0.4; 3], sigma: 0.0 });
    let family = Family::new(&darker, [ALPHA_MIN; 2], [ALPHA_MIN; 2], false).unwrap();
    let settings = FitSettings { rows: 10, paths: 16_000, seed: 1 };
    let varied = Varied::with(&darker, &color, Some(Varying::Family(family)), settings);
    let of_family = varied.painted([ALPHA_MIN; 2], &Paint::of(&stack)).unwrap();
    let bounce = |_: DVec3, uniform: &mut dyn FnMut() -> f64| {
        let (u, (sin, cos)) = (uniform(), libm::sincos(std::f64::consts::TAU * uniform()));
        Some((DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt()), WHITE))
    };
    for theta_deg in [10.0, 60.0] {
        let wo = eye(theta_deg);
        for tilt_deg in [5.0, 10.0, 20.0] {
            let a = leaning(tilt_deg, 2.0);
            for own in [[a, DVec3::Z], [DVec3::Z, a], [a, a]] {
                let truth = walked_between(wo, own[0], own[1], 400_000, bounce);
                let [found, left] =
                    [own, [own[0]; 2]].map(|own| lobe_error(&twin_below(&stack, &lobes, own, DVec3::Z, wo), &truth));
                let painted = lobe_error(&twin_below(&stack, &of_family, own, DVec3::Z, wo), &truth);
                assert!(painted < found + 0.03, "{theta_deg} {tilt_deg} {own:?}: {painted} {found} {left}");
                assert!(
                    found < 0.03 + 0.1 * f64::from(tilt_deg >= 20.0),
                    "{theta_deg} {tilt_deg} {own:?}: {found} {left}"
                );
            }
        }
    }
}

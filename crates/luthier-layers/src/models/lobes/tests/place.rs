//! Rows over a factor and a base of another colour together, against the stack that these make of one place.
//!
//! Oracle: paths of that stack, which no fit has seen.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};

use super::direction;
use crate::models::lobes::{FitSettings, Judge, Lobes, Varied, Varying};
use crate::monochrome::Monochrome;
use crate::references::layered_mc::{ColorPaths, InterfaceMode, LayeredMc};

const NM: [f64; 3] = [650.0, 550.0, 450.0];
const COLOR: Color = Color::ThreeWavelengths(NM);
const SETTINGS: FitSettings = FitSettings { rows: FitSettings::DEFAULT_ROWS, paths: 16_384, seed: 0 };

/// A lacquer over a white base: what absorbs, the slope parameter of its facets, and its films.
fn lacquered(absorption_per_um: Rgb, alpha: f64, films: Vec<Film>) -> Stack {
    let coat = Base::Dielectric {
        ior: Ior::constant(1.5, 0.0).unwrap(),
        slab: Slab { thickness_um: 255.0, absorption_per_um },
    };
    let layer = |alpha, films, base| Layer { films, surface: Surface::isotropic(Distribution::Ggx, alpha), base };
    let base = Base::Diffuse(Diffuse { albedo: [1.0; 3], sigma: 0.0 });
    Stack { exterior: Ior::vacuum(), layers: vec![layer(alpha, films, coat), layer(0.0, vec![], base)] }
}

fn over(mut stack: Stack, color: Rgb) -> Stack {
    stack.layers[1].base = Base::Diffuse(Diffuse { albedo: color, sigma: 0.0 });
    stack
}

/// Lobes with the light of a base of another colour in every row.
fn painted(mut lobes: Lobes, color: Rgb) -> Lobes {
    let simulated = lobes.frame.base.unwrap().albedo;
    for row in &mut lobes.rows {
        let more = row.base.unwrap().more(simulated, color);
        (0..3).for_each(|c| {
            row.wide[c] += more[c];
            row.albedo_dir[c] += more[c];
        });
    }
    lobes
}

fn albedo(stack: &Stack, wo: DVec3) -> Rgb {
    const PATHS: u64 = 100_000;
    let mut sum = [0.0; 3];
    ColorPaths::new(stack, &COLOR).trace(77, PATHS, wo, |path| {
        (0..3).for_each(|c| sum[c] += path.weight[c] / PATHS as f64);
    });
    sum
}

/// A sunburst guitar: amber lacquer over wood, thin in the middle. Of a white base, blue light of the nominal thickness is next to nothing.
#[test]
fn wood_under_thin_lacquer_is_not_violet() {
    let stack = lacquered([0.0006, 0.004, 0.016], 0.09, vec![]);
    let varied = Varied::with(&stack, &COLOR, Some(Varying::Slab), SETTINGS);
    let color = [204.0, 156.0, 96.0].map(|x| x / 255.0);
    for factor in [15.0 / 255.0, 0.2, 0.6] {
        let lobes = varied.at(factor);
        let here = Varying::Slab.apply(&over(stack.clone(), color), factor);
        for theta_deg in [5.0, 40.0, 65.0, 80.0] {
            let wo = direction(theta_deg, 0.3);
            let expected = albedo(&here, wo);
            let found = lobes.below(wo).unwrap().over_base(color).row().albedo_dir;
            for c in 0..3 {
                assert!((found[c] - expected[c]).abs() < 0.012, "{factor} {theta_deg}: {found:?} {expected:?}");
            }
        }
    }
}

/// Every factor that rows may be over, with colours from nearly black to white: errors as judges have them, with the noise of their paths.
#[test]
fn a_base_has_its_colour_at_every_factor() {
    let film = |ior| Film { ior, thickness: FilmThickness { min_nm: 100.0, max_nm: 500.0 } };
    let filmed = lacquered([0.0; 3], 0.2, vec![film(Ior::constant(2.0, 0.0).unwrap())]);
    let tinted = lacquered([0.0006, 0.002, 0.008], 0.4, vec![]);
    let clear = lacquered([0.0; 3], 0.5, vec![]);
    let of_film = Varying::film(&filmed).unwrap();
    for (stack, varying, factors) in [
        (&clear, Varying::Alpha, [0.9, 0.5, 0.07]),
        (&tinted, Varying::Alpha, [0.7, 0.3, 0.02]),
        (&tinted, Varying::Slab, [0.8, 0.25, 0.03]),
        (&filmed, of_film, [1.6, 0.9, 0.4]),
    ] {
        let varied = Varied::with(stack, &COLOR, Some(varying), SETTINGS);
        for (factor, color) in factors.into_iter().zip([[0.02, 0.3, 0.9], [0.8, 0.6, 0.3], [0.1, 0.02, 0.5]]) {
            let here = varying.apply(&over(stack.clone(), color), factor);
            let lobes = painted(varied.at(factor), color);
            let error = Judge::new(&here, &COLOR, None).error_of(|_| lobes.clone());
            eprintln!("{varying:?} {factor} {color:?}: {error:?}");
            assert!(error.lobe < 0.08 && error.albedo < 0.02, "{varying:?} {factor} {color:?}: {error:?}");
        }
    }
}

/// Light that grazes the surface reaches no facet: all of it is masked. Oracle: the simulation, with its own estimate of values.
#[test]
fn light_vanishes_at_grazing_incidence_between_nodes() {
    for alpha in [0.1, 0.4] {
        let stack = over(lacquered([0.0; 3], alpha, vec![]), [0.8; 3]);
        let varied = Varied::with(&stack, &COLOR, Some(Varying::Alpha), SETTINGS);
        for factor in [1.0, 0.55, 0.2] {
            let (lobes, here) = (varied.at(factor), Varying::Alpha.apply(&stack, factor));
            let one = Monochrome::new(&here, NM[1], 1);
            for (theta_i, theta_o, phi) in
                [(89.9, 0.0, 0.0), (89.9, 60.0, 1.5), (89.9, 40.0, 3.0), (88.0, 10.0, 1.0), (85.0, 50.0, 2.0)]
            {
                let (wi, wo) = (direction(theta_i, phi), direction(theta_o, 0.0));
                let mc = LayeredMc { samples: 20_000, seed: 5, ..LayeredMc::new(InterfaceMode::SmithWalk) };
                let expected = mc.estimate(&one, wi, wo);
                let found = lobes.eval(wi, wo)[1];
                eprintln!(
                    "{alpha} {factor} {theta_i} {theta_o}: {found:.6} {:.6} {:.6}",
                    expected.mean, expected.std_err
                );
                assert!(
                    (found - expected.mean).abs() < 4.0 * expected.std_err + 2e-4 + 0.06 * expected.mean,
                    "{alpha} {factor} {theta_i} {theta_o}: {found} {expected:?}"
                );
            }
        }
    }
}

/// Between nodes light is that of lobes that were fitted there: 99 of 100 random pairs. Both have noise.
#[test]
fn rows_between_nodes_are_those_of_the_place() {
    let stack = over(lacquered([0.0; 3], 0.4, vec![]), [0.8; 3]);
    let varied = Varied::with(&stack, &COLOR, Some(Varying::Alpha), FitSettings::default());
    let part = |i: u32, step: f64| (f64::from(i) * step).fract();
    for factor in [0.85, 0.45, 0.12] {
        let (between, here) = (varied.at(factor), Varying::Alpha.apply(&stack, factor));
        let alone = Lobes::of(&here, &COLOR);
        let error = |i: u32| {
            let angle = |u: f64| libm::acos(u).to_degrees();
            let wi = direction(angle(part(i, 0.754_877_666)), std::f64::consts::TAU * part(i, 0.569_840_291));
            let wo = direction(angle(part(i, 0.819_172_513)), std::f64::consts::TAU * part(i, 0.671_043_606));
            let [found, expected] = [&between, &alone].map(|lobes| lobes.eval(wi, wo)[1]);
            (found - expected).abs() / expected.max(0.01)
        };
        let mut errors: Vec<f64> = (1..=10_000).map(error).collect();
        errors.sort_by(f64::total_cmp);
        eprintln!("{factor}: 99 of 100 within {:.4}", errors[9_900]);
        assert!(errors[9_900] < 0.02, "{factor}: {}", errors[9_900]);
    }
}

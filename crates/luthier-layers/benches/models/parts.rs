//! Benchmarks of parts that have no name in the registry: models of places, sampling, colour forms, and preparations.

use std::f64::consts::FRAC_PI_3;

use divan::{Bencher, black_box};
use glam::DVec2;
use luthier_layers::directional_albedo::directional_albedo;
use luthier_layers::effects::flakes::FlakeMean;
use luthier_layers::effects::fluorescence::Fluorescent;
use luthier_layers::effects::heterogeneous::{self, Map, Switch};
use luthier_layers::effects::patina::PatinaAt;
use luthier_layers::effects::textured::TextureSample;
use luthier_layers::formulas::oren_nayar;
use luthier_layers::layers::Layers;
use luthier_layers::models::elek::Elek;
use luthier_layers::models::statistics::evaluate::Prepared;
use luthier_layers::models::weidlich_wilkie::sampling::Sampler;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::noise::perlin::Perlin;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_layers::twins::terms::Exact;
use luthier_optics::color::Color;

use crate::inputs::{Draw, SAMPLES, SOME, draws, each};
use crate::stacks::{bare_conductor, coated_conductor, film_slab_diffuse, green};

fn place(draw: &Draw) -> DVec2 {
    DVec2::new(draw.u[0], draw.u[1])
}

/// Lambert at 0.
#[divan::bench(args = [0.0, 0.3], sample_size = SOME, sample_count = SAMPLES)]
fn oren_nayar_sigma(bencher: Bencher<'_, '_>, sigma: f64) {
    each(bencher, &draws(), |draw| oren_nayar::brdf_scalar(0.5, sigma, draw.wi, draw.wo));
}

/// A normal, a roughness and a thickness in front of Elek's model.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn textured_elek(bencher: Bencher<'_, '_>) {
    let stack = green(&coated_conductor());
    each(bencher, &draws(), |draw| {
        let texture =
            TextureSample { alpha_factor: 0.5 + draw.u[0], slab_factor: 0.5 + draw.u[1], ..TextureSample::NONE };
        texture.eval(&Elek::default(), &stack, draw.wi, draw.wo)
    });
}

/// One flake where [`FlakeMean`] has 256.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn flake_at_a_place(bencher: Bencher<'_, '_>) {
    let (flakes, stack) = (FlakeMean::default().flakes, green(&coated_conductor()));
    each(bencher, &draws(), |draw| flakes.eval(&stack, place(draw), 1.0, draw.wi, draw.wo));
}

#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn patina_at_a_place(bencher: Bencher<'_, '_>) {
    let (patina, stack) = (PatinaAt::default().patina, green(&coated_conductor()));
    each(bencher, &draws(), |draw| patina.eval(&stack, draw.u[2], draw.wi, draw.wo));
}

/// A glitter map over Voronoi cells of two stacks, with Elek's model.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn glitter_over_cells(bencher: Bencher<'_, '_>) {
    let cells = Voronoi { seed: 1, frequency: 8.0 };
    let under = Box::new(Map::Cells { cells, stacks: vec![0, 1] });
    let glitter = Voronoi { seed: 2, frequency: 100.0 };
    heterogeneous(bencher, &Map::Glitter { cells: glitter, stacks: vec![0], filled: 0.3, tilt: FRAC_PI_3, under });
}

/// Two stacks switched by noise of four octaves, with Elek's model.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn switched_by_noise(bencher: Bencher<'_, '_>) {
    let noise = Perlin { seed: 1, frequency: 8.0, octaves: 4 };
    let switch = Switch::Noise { noise, between: [0.0, 1.0] };
    let (inside, outside) = (Box::new(Map::Uniform(1)), Box::new(Map::Uniform(0)));
    heterogeneous(bencher, &Map::Switch { switch, inside, outside });
}

fn heterogeneous(bencher: Bencher<'_, '_>, map: &Map) {
    let stacks = [bare_conductor(), coated_conductor()].map(|stack| green(&stack));
    each(bencher, &draws(), |draw| {
        heterogeneous::eval(&Elek::default(), &stacks, map.pick(place(draw)), draw.wi, draw.wo)
    });
}

/// One pair of eight bins.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn fluorescence(bencher: Bencher<'_, '_>) {
    let bins = 8;
    let mut matrix = vec![0.0; bins * bins];
    for from in 0..bins {
        for to in from..bins {
            matrix[to * bins + from] = 0.8 / (bins - from) as f64;
        }
    }
    let base = Fluorescent::new(vec![green(&film_slab_diffuse()); bins], &matrix).expect("a matrix without gain");
    each(bencher, &draws(), |draw| base.eval(draw.wi, (draw.u[0] * 8.0) as usize, draw.wo, (draw.u[1] * 8.0) as usize));
}

/// A direction of the mixture, the weights for the eye included.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn weidlich_wilkie_sample(bencher: Bencher<'_, '_>) {
    let stack = green(&coated_conductor());
    each(bencher, &draws(), |draw| Sampler::new(&stack, draw.wo).sample(draw.u));
}

/// The density of the mixture, the weights for the eye included.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn weidlich_wilkie_density(bencher: Bencher<'_, '_>) {
    let stack = green(&coated_conductor());
    each(bencher, &draws(), |draw| Sampler::new(&stack, draw.wo).pdf_solid_angle(draw.wi));
}

/// The colour form of Elek's model with terms ready to evaluate: what shaders are judged against.
#[divan::bench(args = ["three_wavelengths", "spectral"], sample_size = SOME, sample_count = SAMPLES, max_time = 1)]
fn elek_rgb(bencher: Bencher<'_, '_>, color: &str) {
    let stack = coated_conductor();
    let color = if color == "spectral" { Color::Spectral } else { Color::ThreeWavelengths([645.0, 525.0, 445.0]) };
    let (layers, terms) = (Layers::isotropic_rgb(&stack).layers, Exact::new(&stack, color));
    each(bencher, &draws(), |draw| Elek::default().eval_with(&layers, &terms, draw.wi, draw.wo));
}

/// The stack at one wavelength.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn stack_at_a_wavelength(bencher: Bencher<'_, '_>) {
    let stack = coated_conductor();
    each(bencher, &draws(), |draw| Monochrome::new(&stack, 400.0 + 300.0 * draw.u[0], 1));
}

/// The energies of a stack that Belcour's and Yamaguchi's models compute before their first value.
#[divan::bench(sample_size = 1, sample_count = 8)]
fn belcour_preparation(bencher: Bencher<'_, '_>) {
    let stack = green(&coated_conductor());
    bencher.bench(|| Prepared::new(black_box(&stack)));
}

/// The hemisphere seen from one direction, by quadrature.
#[divan::bench(sample_size = 1, sample_count = 16, max_time = 2)]
fn elek_directional_albedo(bencher: Bencher<'_, '_>) {
    let stack = green(&coated_conductor());
    each(bencher, &draws(), |draw| directional_albedo(&Elek::default(), &stack, draw.wo));
}

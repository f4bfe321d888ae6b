//! Time of the evaluations that a bake is made of: `cargo bench -p luthier-optics`.

use divan::{Bencher, black_box};
use glam::DVec3;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves};
use luthier_optics::color::Color;
use luthier_optics::constants::dataset;
use luthier_optics::film_color::BelcourBarla;
use luthier_optics::fresnel::{FilmLayer, coated, interface};
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::microfacet::{lambda, scaled_distribution};
use luthier_optics::ndf::Anisotropic;
use luthier_optics::sampling::{Sampler, VisibleNormals};
use luthier_optics::schlick::{F82, schlick};
use luthier_optics::stack::Distribution;
use luthier_optics::visible_normals;
use num_complex::Complex64;

const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];

fn main() {
    divan::main();
}

#[divan::bench]
fn fresnel_conductor() -> f64 {
    interface(Complex64::ONE, black_box(Complex64::new(3.2, 3.3)), black_box(0.4)).unpolarised()
}

#[divan::bench]
fn fresnel_one_film() -> f64 {
    let film = [FilmLayer { ior: Complex64::new(1.33, 0.0), waves: black_box(0.6) }];
    coated(Complex64::ONE, &film, black_box(Complex64::new(3.2, 3.3)), black_box(0.4)).unpolarised()
}

#[divan::bench]
fn fresnel_spectral_rgb(bencher: Bencher<'_, '_>) {
    let gold = dataset("au").map_or_else(Ior::vacuum, |d| d.ior.clone());
    let sampled = Interface { above: Ior::vacuum(), films: Vec::new(), below: gold }.sampled(&Color::Spectral);
    bencher.bench(|| sampled.rgb(black_box(0.4)));
}

#[divan::bench(args = BOTH)]
fn distribution(distribution: Distribution) -> f64 {
    scaled_distribution(distribution, black_box(0.2), black_box(0.98), black_box(0.0396))
}

#[divan::bench(args = BOTH)]
fn smith_lambda(distribution: Distribution) -> f64 {
    lambda(distribution, black_box(0.2), black_box(0.3))
}

#[divan::bench(args = BOTH)]
fn visible_normal(distribution: Distribution) -> DVec3 {
    let w = DVec3::new(black_box(0.8), 0.0, 0.6);
    visible_normals::sample(distribution, black_box(0.4), w, [black_box(0.3), black_box(0.7)])
}

/// A reflected direction of an anisotropic surface, with its density.
#[divan::bench(args = BOTH)]
fn reflected_direction(bencher: Bencher<'_, '_>, distribution: Distribution) {
    let wo = DVec3::new(0.48, 0.64, 0.6);
    if let Ok(ndf) = Anisotropic::new(distribution, 0.4, 0.1) {
        let sampler = VisibleNormals { ndf };
        bencher.bench(|| sampler.sample(black_box(wo), black_box([0.3, 0.7, 0.5])));
    }
}

#[divan::bench]
fn fresnel_schlick() -> f64 {
    schlick(black_box(0.65), black_box(0.4))
}

#[divan::bench]
fn fresnel_f82() -> f64 {
    F82 { f0: black_box(0.65), tint: 0.74 }.eval(black_box(0.4))
}

/// A film to RGB in closed form.
#[divan::bench]
fn film_belcour_barla() -> [f64; 3] {
    BelcourBarla { above: 1.0, film: 1.33, thickness_nm: black_box(320.0), below: Complex64::ONE, orders: 2 }
        .rgb(black_box(0.4))
}

/// One node of an FGD table, at the baker's effort.
#[divan::bench(args = BOTH)]
fn facet_statistics(distribution: Distribution) -> FacetStatistics {
    FacetStatistics::new(distribution, black_box(0.4), black_box(0.3), Effort { first: 20, later: 26 }, 1)
}

/// The albedo of one node for 16 wavelengths.
#[divan::bench(args = BOTH)]
fn albedo_16_wavelengths(bencher: Bencher<'_, '_>, distribution: Distribution) {
    let statistics = FacetStatistics::new(distribution, 0.4, 0.3, Effort { first: 20, later: 26 }, 1);
    let metal = |k: usize, cos| interface(Complex64::ONE, Complex64::new(0.2 + k as f64 * 0.1, 3.0), cos).unpolarised();
    let curves = ReflectanceCurves::new(16, metal);
    bencher.bench(|| statistics.albedo(black_box(&curves)));
}

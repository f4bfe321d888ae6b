//! Benchmarks of the reflectance of interfaces with films.

use crate::inputs::{INPUTS, SAMPLES, SOME, draws, each};
use divan::Bencher;
use luthier_optics::color::Color;
use luthier_optics::film_color::{BelcourBarla, granier_two_beam};
use luthier_optics::fresnel::{FilmLayer, coated};
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Film, FilmThickness};
use num_complex::Complex64;

const METAL: Complex64 = Complex64::new(3.2, 3.3);
const BELCOUR_BARLA: BelcourBarla =
    BelcourBarla { above: 1.0, film: 1.33, thickness_nm: 320.0, below: METAL, orders: 2 };

fn against_cosine<O>(bencher: Bencher<'_, '_>, f: impl Fn(f64) -> O) {
    each(bencher, &draws(), |draw| f(draw.wi.z));
}

/// The recursion of Airy's formula; one film is Airy's formula itself.
#[divan::bench(args = [1, 2, 8], sample_size = INPUTS)]
fn airy_recursion(bencher: Bencher<'_, '_>, count: usize) {
    let film = |i| FilmLayer { ior: Complex64::new(if i % 2 == 0 { 1.33 } else { 2.2 }, 0.0), waves: 0.6 };
    let films: Vec<FilmLayer> = (0..count).map(film).collect();
    against_cosine(bencher, |cos| coated(Complex64::ONE, &films, METAL, cos).unpolarised());
}

/// One film at all 95 wavelengths, to RGB.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn airy_spectral_rgb(bencher: Bencher<'_, '_>) {
    let thickness = FilmThickness { min_nm: 320.0, max_nm: 320.0 };
    let index = |n, k| Ior::constant(n, k).expect("a valid index");
    let film = Film { ior: index(1.33, 0.0), thickness };
    let interface = Interface { above: Ior::vacuum(), films: vec![film], below: index(METAL.re, METAL.im) };
    let sampled = interface.sampled(&Color::Spectral);
    against_cosine(bencher, |cos| sampled.rgb(cos));
}

#[divan::bench(sample_size = INPUTS)]
fn belcour_barla_rgb(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| BELCOUR_BARLA.rgb(cos));
}

#[divan::bench(sample_size = INPUTS)]
fn belcour_barla_rgb_tinted(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| BELCOUR_BARLA.rgb_tinted(cos));
}

#[divan::bench(sample_size = INPUTS)]
fn belcour_barla_one_wavelength(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| BELCOUR_BARLA.monochrome(550.0, cos));
}

#[divan::bench(sample_size = INPUTS)]
fn granier_two_beam_rgb(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| granier_two_beam([1.34, 1.33, 1.32], [645.0, 525.0, 445.0], 320.0, cos));
}

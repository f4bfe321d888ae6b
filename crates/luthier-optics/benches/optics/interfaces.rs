//! Benchmarks of the reflectance of bare interfaces.

use crate::inputs::{INPUTS, SAMPLES, SOME, draws, each};
use divan::Bencher;
use luthier_optics::color::Color;
use luthier_optics::constants::dataset;
use luthier_optics::fresnel::interface;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::{F82, Lazanyi, complex_f0, schlick};
use num_complex::Complex64;

const GLASS: Complex64 = Complex64::new(1.5, 0.0);
const AIR_IN_GLASS: Complex64 = Complex64::new(1.0 / 1.5, 0.0);
const METAL: Complex64 = Complex64::new(3.2, 3.3);

fn against_cosine<O>(bencher: Bencher<'_, '_>, f: impl Fn(f64) -> O) {
    each(bencher, &draws(), |draw| f(draw.wi.z));
}

#[divan::bench(sample_size = INPUTS)]
fn fresnel_dielectric(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| interface(Complex64::ONE, GLASS, cos).unpolarised());
}

/// Reflectance from the denser side, total reflection included.
#[divan::bench(sample_size = INPUTS)]
fn fresnel_dielectric_inside(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| interface(Complex64::ONE, AIR_IN_GLASS, cos).unpolarised());
}

#[divan::bench(sample_size = INPUTS)]
fn fresnel_conductor(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| interface(Complex64::ONE, METAL, cos).unpolarised());
}

#[divan::bench(name = "schlick", sample_size = INPUTS)]
fn schlick_form(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| schlick(0.65, cos));
}

#[divan::bench(name = "complex_f0", sample_size = INPUTS)]
fn schlick_complex_f0(bencher: Bencher<'_, '_>) {
    against_cosine(bencher, |cos| complex_f0(1.0, METAL, cos));
}

#[divan::bench(sample_size = INPUTS)]
fn lazanyi(bencher: Bencher<'_, '_>) {
    let fit = Lazanyi::fit(1.0, METAL);
    against_cosine(bencher, |cos| fit.eval(cos));
}

#[divan::bench(sample_size = INPUTS)]
fn f82(bencher: Bencher<'_, '_>) {
    let fit = F82::of(1.0, METAL);
    against_cosine(bencher, |cos| fit.eval(cos));
}

/// The exact reflectance of gold at all 95 wavelengths, to RGB.
#[divan::bench(sample_size = SOME, sample_count = SAMPLES)]
fn fresnel_conductor_spectral_rgb(bencher: Bencher<'_, '_>) {
    let gold = dataset("au").expect("gold is built in").ior.clone();
    let sampled = Interface { above: Ior::vacuum(), films: Vec::new(), below: gold }.sampled(&Color::Spectral);
    against_cosine(bencher, |cos| sampled.rgb(cos));
}

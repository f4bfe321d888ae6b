//! Benchmarks of the samplers and their densities.

use crate::inputs::{INPUTS, draws, each};
use divan::Bencher;
use luthier_optics::microfacet::Anisotropic;
use luthier_optics::sampling::{CosineHemisphere, Mixture, Sampler, VisibleNormals};
use luthier_optics::stack::Distribution;
use luthier_optics::stack::Distribution::{Beckmann, Ggx};
use luthier_optics::visible_normals;

fn reflections(kind: Distribution) -> VisibleNormals {
    VisibleNormals { ndf: Anisotropic::new(kind, 0.4, 0.1).expect("valid slopes") }
}

fn mixture_with(kind: Distribution) -> Mixture {
    Mixture::default().with(1.0, CosineHemisphere).with(3.0, reflections(kind))
}

fn sample(bencher: Bencher<'_, '_>, sampler: &impl Sampler) {
    each(bencher, &draws(), |draw| sampler.sample(draw.wo, draw.u));
}

fn density(bencher: Bencher<'_, '_>, sampler: &impl Sampler) {
    each(bencher, &draws(), |draw| sampler.pdf_solid_angle(draw.wo, draw.wi));
}

/// The normal alone, isotropic.
#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn visible_normal(bencher: Bencher<'_, '_>, kind: Distribution) {
    each(bencher, &draws(), |draw| visible_normals::sample(kind, 0.3, draw.wo, [draw.u[0], draw.u[1]]));
}

/// A reflected direction of an anisotropic surface, with its density.
#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn visible_normals_sample(bencher: Bencher<'_, '_>, kind: Distribution) {
    sample(bencher, &reflections(kind));
}

#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn visible_normals_density(bencher: Bencher<'_, '_>, kind: Distribution) {
    density(bencher, &reflections(kind));
}

#[divan::bench(sample_size = INPUTS)]
fn cosine_sample(bencher: Bencher<'_, '_>) {
    sample(bencher, &CosineHemisphere);
}

#[divan::bench(sample_size = INPUTS)]
fn cosine_density(bencher: Bencher<'_, '_>) {
    density(bencher, &CosineHemisphere);
}

/// Cosine one time in four, visible normals otherwise.
#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn mixture_sample(bencher: Bencher<'_, '_>, kind: Distribution) {
    sample(bencher, &mixture_with(kind));
}

#[divan::bench(args = [Beckmann, Ggx], sample_size = INPUTS)]
fn mixture_density(bencher: Bencher<'_, '_>, kind: Distribution) {
    density(bencher, &mixture_with(kind));
}

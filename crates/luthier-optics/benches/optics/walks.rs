//! Benchmarks of walks between facets.

use crate::inputs::{INPUTS, SAMPLES, SOME, draws, each};
use divan::Bencher;
use luthier_optics::albedo::ReflectanceCurves;
use luthier_optics::fresnel::interface;
use luthier_optics::microsurface::{TransparentFacets, Walk, crossed_and_returned, reflecting_walk};
use luthier_optics::stack::Distribution;
use luthier_optics::stack::Distribution::{Beckmann, Ggx};
use num_complex::Complex64;

fn walks() -> Vec<(f64, Walk)> {
    std::iter::zip(draws(), 0..INPUTS).map(|(draw, index)| (draw.wi.z, Walk { seed: 1, index })).collect()
}

/// All facets of a walk on a perfect reflector, alpha 0.5.
#[divan::bench(args = [Beckmann, Ggx], sample_size = SOME, sample_count = SAMPLES)]
fn reflecting(bencher: Bencher<'_, '_>, kind: Distribution) {
    each(bencher, &walks(), |&(cos, walk)| {
        let mut sum = 0.0;
        reflecting_walk(kind, 0.5, cos, walk, |facet| sum += facet.leaving * facet.cos_theta_d);
        sum
    });
}

/// Light that crosses a rough dielectric and comes back, alpha 0.5, index 1.5.
#[divan::bench(args = [Beckmann, Ggx], sample_size = SOME, sample_count = SAMPLES)]
fn crossing(bencher: Bencher<'_, '_>, kind: Distribution) {
    let glass = |_, cos| interface(Complex64::ONE, Complex64::new(1.5, 0.0), cos).unpolarised();
    let curve = ReflectanceCurves::new(1, glass);
    let facets = TransparentFacets { eta: 1.5, from_above: |cos| curve.at(0, cos) };
    each(bencher, &walks(), |&(cos, walk)| crossed_and_returned(kind, 0.5, facets, cos, walk));
}

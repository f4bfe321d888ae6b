//! Benchmarks of one node of each table, as the baker computes it.

use crate::inputs::{draws, each};
use divan::Bencher;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves};
use luthier_optics::fresnel::interface;
use luthier_optics::stack::Distribution;
use luthier_optics::stack::Distribution::{Beckmann, Ggx};
use num_complex::Complex64;

/// Effort of the baker.
const EFFORT: Effort = Effort { first: 20, later: 26 };

/// One node of an FGD table.
#[divan::bench(args = [Beckmann, Ggx], sample_size = 1, sample_count = 128)]
fn facet_statistics(bencher: Bencher<'_, '_>, kind: Distribution) {
    each(bencher, &draws(), |draw| FacetStatistics::new(kind, 0.4, draw.wi.z, EFFORT, 1));
}

/// The albedo of one node for 16 wavelengths.
#[divan::bench(args = [Beckmann, Ggx], sample_size = 1, sample_count = 128)]
fn albedo_16_wavelengths(bencher: Bencher<'_, '_>, kind: Distribution) {
    let cosines = draws().into_iter().take(32).map(|draw| draw.wi.z);
    let nodes: Vec<FacetStatistics> = cosines.map(|cos| FacetStatistics::new(kind, 0.4, cos, EFFORT, 1)).collect();
    let metal = |k: usize, cos| interface(Complex64::ONE, Complex64::new(0.2 + k as f64 * 0.1, 3.0), cos).unpolarised();
    let curves = ReflectanceCurves::new(16, metal);
    each(bencher, &nodes, |node| node.albedo(&curves));
}

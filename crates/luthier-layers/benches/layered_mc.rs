//! Speed of the Monte Carlo reference: `cargo bench -p luthier-layers --bench layered_mc`.
//!
//! One thread. Items are paths from the eye (`paths`), or samples of a value, each of which takes one path from
//! either side and their connections (`values`).

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

/// Per call: half a millisecond and more, which is short for the scheduler of the machine.
const SAMPLES: u64 = 2_000;

/// Slope of the coat, and what happens at rough interfaces.
const CASES: [(f64, InterfaceMode); 4] = [
    (0.0, InterfaceMode::SmithWalk),
    (0.0, InterfaceMode::OneFacet),
    (0.1, InterfaceMode::SmithWalk),
    (0.1, InterfaceMode::OneFacet),
];

fn main() {
    divan::main();
}

/// A coat of index 1.5 that absorbs a little, over rough gold at 550 nm.
fn coated_conductor(alpha_coat: f64) -> Monochrome {
    let surface = |alpha| Surface::isotropic(Distribution::Ggx, alpha);
    let gold = MonochromeBelow::Conductor { ior: Complex64::new(0.42, 2.35) };
    Monochrome::bare(&[(surface(alpha_coat), MonochromeBelow::dielectric(1.5, 0.1)), (surface(0.3), gold)])
}

fn direction(cos: f64, phi: f64) -> DVec3 {
    let sin = libm::sqrt(1.0 - cos * cos);
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}

#[divan::bench(args = CASES, sample_size = 1, sample_count = 500)]
fn paths(bencher: Bencher<'_, '_>, (alpha_coat, mode): (f64, InterfaceMode)) {
    let (mc, stack) = (LayeredMc { mode, samples: SAMPLES, seed: 1 }, coated_conductor(alpha_coat));
    bencher
        .counter(ItemsCount::new(SAMPLES))
        .bench(|| mc.albedo(black_box(&stack), black_box(direction(0.7, 0.0)), SAMPLES));
}

#[divan::bench(args = CASES, sample_size = 1, sample_count = 100)]
fn values(bencher: Bencher<'_, '_>, (alpha_coat, mode): (f64, InterfaceMode)) {
    let (mc, stack) = (LayeredMc { mode, samples: SAMPLES, seed: 1 }, coated_conductor(alpha_coat));
    bencher
        .counter(ItemsCount::new(SAMPLES))
        .bench(|| mc.estimate(black_box(&stack), black_box(direction(0.8, 3.0)), black_box(direction(0.7, 0.0))));
}

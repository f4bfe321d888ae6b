//! Samples of layered surfaces against their densities, by Pearson's test.
//!
//! Cells are graded around the mirror direction, so that one grid serves lobes of any width. Draws without a direction are a cell too, in which
//! none belong.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::model::Model;
use luthier_layers::models::weidlich_wilkie::WeidlichWilkie;
use luthier_layers::models::weidlich_wilkie::sampling::Sampler;
use luthier_layers::monochrome::Monochrome;
use luthier_optics::stack::{Distribution, Surface};

use crate::sphere::{at, coordinate, direction, frame, mirrored, radius};
use crate::stacks::{WHITE, dielectric, ggx, lambert};

const RINGS: usize = 40;
const SECTORS: usize = 16;
const SAMPLES: usize = 100_000;

/// Standard normal deviate that a test may reach: p = 0.01 shared by 27 tests (Sidak).
const LIMIT: f64 = 3.37;

/// Uniform numbers: SplitMix64.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Deviate of Pearson's statistic (Wilson and Hilferty 1931), cells pooled to five expected samples at least.
fn deviate(centre: DVec3, mut sample: impl FnMut() -> Option<DVec3>, pdf: impl Fn(DVec3) -> f64) -> f64 {
    let axes = frame(centre);
    let mut observed = vec![0.0; RINGS * SECTORS + 1];
    for _ in 0..SAMPLES {
        let cell = sample().map_or(RINGS * SECTORS, |w| {
            let [x, y, z] = axes.map(|axis| axis.dot(w));
            let ring = (coordinate(x.hypot(y).atan2(z)) * RINGS as f64) as usize;
            let sector = ((y.atan2(x) / (2.0 * PI)).rem_euclid(1.0) * SECTORS as f64) as usize;
            ring.min(RINGS - 1) * SECTORS + sector.min(SECTORS - 1)
        });
        observed[cell] += 1.0;
    }
    let mut expected: Vec<f64> = (0..RINGS * SECTORS)
        .map(|cell| {
            // Outer cells are wide and may be cut by the horizon, or by the edge of what passes a medium of a small index.
            let n = if cell / SECTORS > RINGS - 12 { 96 } else { 12 };
            let mut sum = 0.0;
            for i in 0..n {
                let u = ((cell / SECTORS) as f64 + (f64::from(i) + 0.5) / f64::from(n)) / RINGS as f64;
                let (r, slope) = radius(u);
                for j in 0..n {
                    let v = ((cell % SECTORS) as f64 + (f64::from(j) + 0.5) / f64::from(n)) / SECTORS as f64;
                    sum += pdf(direction(axes, r, 2.0 * PI * v)) * r.sin() * slope;
                }
            }
            sum * 2.0 * PI * SAMPLES as f64 / ((RINGS * SECTORS) as f64 * f64::from(n * n))
        })
        .collect();
    let found: f64 = expected.iter().sum();
    assert!((found / SAMPLES as f64 - 1.0).abs() < 5e-3, "the density integrates to {}", found / SAMPLES as f64);
    expected.push(0.0);

    let (mut statistic, mut cells) = (0.0, 0.0);
    let (mut pool_observed, mut pool_expected) = (0.0, 0.0);
    for (o, e) in observed.into_iter().zip(expected) {
        pool_observed += o;
        pool_expected += e;
        if pool_expected >= 5.0 {
            statistic += (pool_observed - pool_expected) * (pool_observed - pool_expected) / pool_expected;
            cells += 1.0;
            (pool_observed, pool_expected) = (0.0, 0.0);
        }
    }
    assert!(pool_observed < 25.0, "{pool_observed} samples where {pool_expected} belong");
    let freedom = f64::max(cells - 1.0, 1.0);
    let spread = 2.0 / (9.0 * freedom);
    ((statistic / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}

fn stacks() -> Vec<Monochrome> {
    let brushed = Surface { distribution: Distribution::Beckmann, alpha_x: 0.5, alpha_y: 0.15, rotation: 0.6 };
    vec![
        Monochrome::bare(&[(ggx(0.005), dielectric(1.5, 0.2)), (ggx(0.2), WHITE)]),
        Monochrome::bare(&[(ggx(0.4), dielectric(1.5, 0.0)), (ggx(0.0), lambert(0.8))]),
        Monochrome::bare(&[(ggx(0.1), dielectric(1.3, 0.1)), (brushed, dielectric(1.7, 0.1)), (ggx(0.3), WHITE)]),
        Monochrome::bare(&[
            (ggx(0.1), dielectric(1.5, 0.0)),
            (ggx(0.2), dielectric(0.9, 0.0)),
            (ggx(0.4), dielectric(1.4, 0.0)),
            (ggx(0.0), lambert(0.6)),
        ]),
        Monochrome::bare(&[(ggx(0.3), dielectric(0.8, 0.0)), (ggx(0.0), lambert(0.6))]),
    ]
}

#[test]
fn local_samples_follow_their_density() {
    for (number, stack) in stacks().iter().enumerate() {
        for theta in [0.0, 50.0, 85.0] {
            let wo = at(theta);
            let sampler = Sampler::new(stack, wo);
            let mut numbers = Numbers(7 + number as u64);
            let sample = || {
                let u = [numbers.next(), numbers.next(), numbers.next()];
                sampler.sample(u).map(|(wi, pdf)| {
                    assert_eq!(pdf, sampler.pdf_solid_angle(wi));
                    wi
                })
            };
            let found = deviate(mirrored(wo), sample, |wi| sampler.pdf_solid_angle(wi));
            assert!(found < LIMIT, "stack {number} at {theta}: {found} standard deviations");
        }
    }
}

#[test]
fn proposals_of_each_layer_follow_their_density() {
    for (number, stack) in stacks().iter().enumerate() {
        let wo = at(50.0);
        let sampler = Sampler::new(stack, wo);
        assert_eq!(sampler.count(), stack.layers.len());
        for layer in 0..sampler.count() {
            let mut numbers = Numbers(3 + layer as u64);
            let sample = || {
                sampler.propose(layer, [numbers.next(), numbers.next()]).map(|p| {
                    assert_eq!((p.layer, p.pdf_solid_angle), (layer, sampler.pdf_of_layer(layer, p.wi)));
                    p.wi
                })
            };
            let found = deviate(mirrored(wo), sample, |wi| sampler.pdf_of_layer(layer, wi));
            assert!(found < LIMIT, "stack {number} layer {layer}: {found} standard deviations");
        }
    }
}

/// Both sampling methods give the model's own integral.
#[test]
fn both_methods_estimate_the_albedo() {
    let model = WeidlichWilkie::default();
    for (number, stack) in stacks().iter().enumerate() {
        let wo = at(40.0);
        let sampler = Sampler::new(stack, wo);
        let mut numbers = Numbers(11);
        let expected = crate::sphere::furnace(&model, stack, wo);
        let n = 40_000;
        let mut sums = [[0.0; 2]; 2];
        for _ in 0..n {
            let local = sampler
                .sample([numbers.next(), numbers.next(), numbers.next()])
                .map_or(0.0, |(wi, pdf)| model.eval(stack, wi, wo) / pdf);
            // Multiple proposals (balance heuristic over the layers): each is worth the model over the sum of their densities.
            let proposals: Vec<_> = (0..sampler.count())
                .filter_map(|layer| sampler.propose(layer, [numbers.next(), numbers.next()]))
                .collect();
            let carried = |p: &luthier_layers::models::weidlich_wilkie::sampling::Proposal| {
                model.eval(stack, p.wi, wo) / sampler.sum_of_densities(p.wi)
            };
            let global = Sampler::follow(&proposals, carried, numbers.next()).map_or(0.0, |(p, q)| carried(&p) / q);
            for (sum, value) in sums.iter_mut().zip([local, global]) {
                sum[0] += value;
                sum[1] += value * value;
            }
        }
        for (method, [sum, sum_sq]) in ["local", "global"].into_iter().zip(sums) {
            let mean = sum / f64::from(n);
            let error = ((sum_sq / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
            assert!((mean - expected).abs() < 4.0 * error + 1e-3, "{method} {number}: {mean} +- {error} {expected}");
        }
    }
}

#[test]
fn nothing_is_followed_when_nothing_is_carried() {
    let stack = &stacks()[0];
    let sampler = Sampler::new(stack, at(20.0));
    let proposals: Vec<_> = (0..2).filter_map(|k| sampler.propose(k, [0.3, 0.6])).collect();
    assert!(Sampler::follow(&proposals, |_| 0.0, 0.5).is_none());
    let (chosen, probability) = Sampler::follow(&proposals, |p| if p.layer == 1 { 3.0 } else { 1.0 }, 0.5).unwrap();
    assert_eq!((chosen.layer, probability), (1, 0.75));
    assert_eq!(Sampler::new(stack, -at(20.0)).count(), 0);
    assert!(Sampler::new(stack, -at(20.0)).sample([0.1, 0.2, 0.3]).is_none());
}

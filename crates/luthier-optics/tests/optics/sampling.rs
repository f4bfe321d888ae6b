//! Samples of directions against the densities that the samplers report: Pearson's chi-square.
//!
//! Reflected directions are binned by their half vector, in slopes over the alphas, so that the cells fit the lobe at every alpha; the
//! draws that are lost below the horizon are a cell of their own. The expected counts integrate `pdf_solid_angle`.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::microfacet::Anisotropic;
use luthier_optics::sampling::{CosineHemisphere, Mixture, Sampler, VisibleNormals};
use luthier_optics::stack::Distribution;

use crate::brute_force::Random;
use crate::visible_normals::{SAMPLES, SIGNIFICANCE, chi_square, deviations};

/// Cells of the half vector's slope radius (its arc tangent) and azimuth.
const CELLS: [usize; 2] = [20, 24];

/// Midpoints per cell along each axis.
const POINTS: usize = 24;

const ALPHAS: [[f64; 2]; 4] = [[0.005, 0.005], [0.005, 0.05], [0.4, 0.1], [1.0, 0.3]];

/// Cosine of `wo`: the normal, 45 degrees, grazing.
const COSINES: [f64; 3] = [1.0, std::f64::consts::FRAC_1_SQRT_2, 0.02];

fn direction(cos: f64, phi: f64) -> DVec3 {
    let sin = (1.0 - cos * cos).sqrt();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

fn passes(expected: &[f64], counts: &[u32], tests: f64) -> Result<(), (f64, f64)> {
    // Sidak's correction.
    let each = 1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / tests);
    let (sum, freedom) = chi_square(expected, counts);
    let chance = 0.5 * libm::erfc(deviations(sum, freedom) / 2f64.sqrt());
    if chance > each { Ok(()) } else { Err((sum, freedom)) }
}

/// Probability of every cell of half vectors, and of the lost draws.
fn expected_of_normals(sampler: &VisibleNormals, wo: DVec3) -> Vec<f64> {
    let [alpha_x, alpha_y] = sampler.ndf.alphas();
    let mut cells = vec![0.0; CELLS[0] * CELLS[1]];
    let steps = CELLS.map(|n| n * POINTS);
    for i in 0..steps[0] {
        let r = (0.5 * PI * (i as f64 + 0.5) / steps[0] as f64).tan();
        for j in 0..steps[1] {
            let phi = 2.0 * PI * (j as f64 + 0.5) / steps[1] as f64;
            let wh = DVec3::new(-alpha_x * r * phi.cos(), -alpha_y * r * phi.sin(), 1.0).normalize();
            let cos_d = wo.dot(wh);
            let wi = 2.0 * cos_d * wh - wo;
            if cos_d <= 0.0 || wi.z <= 0.0 {
                continue;
            }
            // Solid angle of wi over that of wh, of wh over slopes, of slopes over (radius, azimuth).
            let measure = 4.0 * cos_d * wh.z.powi(3) * alpha_x * alpha_y * r * (1.0 + r * r);
            cells[i / POINTS * CELLS[1] + j / POINTS] += sampler.pdf_solid_angle(wo, wi.normalize()) * measure;
        }
    }
    let step = PI * PI / (steps[0] * steps[1]) as f64;
    for cell in &mut cells {
        *cell *= step;
    }
    cells.push((1.0 - cells.iter().sum::<f64>()).max(0.0));
    cells
}

fn observed_normals(sampler: &VisibleNormals, wo: DVec3, seed: u64) -> Vec<u32> {
    let [alpha_x, alpha_y] = sampler.ndf.alphas();
    let mut counts = vec![0; CELLS[0] * CELLS[1] + 1];
    let mut random = Random::new(seed, 7);
    for _ in 0..SAMPLES {
        let u = [random.next(), random.next(), random.next()];
        let cell = sampler.sample(wo, u).map_or(CELLS[0] * CELLS[1], |sample| {
            let wh = (sample.wi + wo).normalize();
            let (x, y) = (-wh.x / (wh.z * alpha_x), -wh.y / (wh.z * alpha_y));
            let radius = x.hypot(y).atan() / (0.5 * PI);
            let azimuth = (y.atan2(x) / (2.0 * PI)).rem_euclid(1.0);
            let [i, j] = [(radius, CELLS[0]), (azimuth, CELLS[1])].map(|(t, n)| ((t * n as f64) as usize).min(n - 1));
            i * CELLS[1] + j
        });
        counts[cell] += 1;
    }
    counts
}

fn check_normals(distribution: Distribution) {
    let tests = 2.0 * (ALPHAS.len() * COSINES.len()) as f64;
    for (i, [alpha_x, alpha_y]) in ALPHAS.into_iter().enumerate() {
        for (j, cos) in COSINES.into_iter().enumerate() {
            let ndf = Anisotropic::new(distribution, alpha_x, alpha_y).expect("alphas are positive");
            let (sampler, wo) = (VisibleNormals { ndf }, direction(cos, 0.7));
            let counts = observed_normals(&sampler, wo, (i * COSINES.len() + j) as u64);
            let result = passes(&expected_of_normals(&sampler, wo), &counts, tests);
            assert!(result.is_ok(), "{distribution:?} {alpha_x} {alpha_y} cos {cos}: {result:?}");
        }
    }
}

#[test]
fn reflections_at_beckmann_normals_follow_their_density() {
    check_normals(Distribution::Beckmann);
}

#[test]
fn reflections_at_ggx_normals_follow_their_density() {
    check_normals(Distribution::Ggx);
}

/// Checks a sampler over equal cells of (cosine, azimuth) of the hemisphere.
fn check_hemisphere(sampler: &dyn Sampler, wo: DVec3, seed: u64) {
    let mut expected = vec![0.0; CELLS[0] * CELLS[1]];
    let steps = CELLS.map(|n| n * POINTS);
    for i in 0..steps[0] {
        for j in 0..steps[1] {
            let wi = direction((i as f64 + 0.5) / steps[0] as f64, 2.0 * PI * (j as f64 + 0.5) / steps[1] as f64);
            expected[i / POINTS * CELLS[1] + j / POINTS] += sampler.pdf_solid_angle(wo, wi);
        }
    }
    for cell in &mut expected {
        *cell *= 2.0 * PI / (steps[0] * steps[1]) as f64;
    }
    expected.push((1.0 - expected.iter().sum::<f64>()).max(0.0));
    let mut counts = vec![0; expected.len()];
    let mut random = Random::new(seed, 8);
    for _ in 0..SAMPLES {
        let u = [random.next(), random.next(), random.next()];
        let cell = sampler.sample(wo, u).map_or(CELLS[0] * CELLS[1], |sample| {
            let azimuth = (sample.wi.y.atan2(sample.wi.x) / (2.0 * PI)).rem_euclid(1.0);
            let [i, j] =
                [(sample.wi.z, CELLS[0]), (azimuth, CELLS[1])].map(|(t, n)| ((t * n as f64) as usize).min(n - 1));
            i * CELLS[1] + j
        });
        counts[cell] += 1;
    }
    let result = passes(&expected, &counts, 4.0);
    assert!(result.is_ok(), "{wo}: {result:?}");
}

#[test]
fn cosine_samples_follow_their_density() {
    check_hemisphere(&CosineHemisphere, direction(0.5, 0.0), 100);
}

#[test]
fn mixtures_follow_their_density() {
    for (i, cos) in [0.95, 0.5, 0.1].into_iter().enumerate() {
        let part = |distribution, alpha_x, alpha_y| VisibleNormals {
            ndf: Anisotropic::new(distribution, alpha_x, alpha_y).expect("alphas are positive"),
        };
        let inner = Mixture::default().with(1.0, CosineHemisphere).with(2.0, part(Distribution::Ggx, 0.5, 0.3));
        let mixture = Mixture::default().with(3.0, inner).with(2.0, part(Distribution::Beckmann, 0.4, 0.4));
        check_hemisphere(&mixture, direction(cos, 1.1), 200 + i as u64);
    }
}

/// The reported density prices a draw correctly: the mean of f/pdf over draws is the integral of f. Here f is the visible-normal
/// density itself times a cosine, against midpoints over the hemisphere.
#[test]
fn estimates_with_the_mixture_match_quadrature() {
    let ndf = Anisotropic::new(Distribution::Ggx, 0.5, 0.3).expect("alphas are positive");
    let wo = direction(0.6, 0.4);
    let lobe = VisibleNormals { ndf };
    let f = |wi: DVec3| lobe.pdf_solid_angle(wo, wi) * wi.z;
    let n = 400;
    let quadrature: f64 = (0..n * n)
        .map(|k| {
            f(direction((f64::from(k / n) + 0.5) / f64::from(n), 2.0 * PI * (f64::from(k % n) + 0.5) / f64::from(n)))
        })
        .sum::<f64>()
        * 2.0
        * PI
        / f64::from(n * n);
    let mixture = Mixture::default().with(1.0, CosineHemisphere).with(1.0, lobe);
    let mut random = Random::new(5, 9);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..SAMPLES {
        let u = [random.next(), random.next(), random.next()];
        let value = mixture.sample(wo, u).map_or(0.0, |s| f(s.wi) / s.pdf_solid_angle);
        sum += value;
        squares += value * value;
    }
    let count = f64::from(SAMPLES);
    let mean = sum / count;
    let sigma = ((squares / count - mean * mean) / count).sqrt();
    assert!((mean - quadrature).abs() < 4.0 * sigma, "{mean} +- {sigma} against {quadrature}");
}

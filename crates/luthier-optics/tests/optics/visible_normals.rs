//! Samples of visible normals against their density: Pearson's chi-square over cells of slope space.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::stack::Distribution;
use luthier_optics::visible_normals::sample;

use crate::brute_force::Random;

pub(crate) const SAMPLES: u32 = 1 << 18;

/// Cells of the slope's radius and azimuth.
const CELLS: [usize; 2] = [24, 32];

/// Midpoints per cell along each axis.
const POINTS: usize = 24;

/// Cells that expect fewer samples than this are pooled.
const POOL_BELOW: f64 = 5.0;

/// Chance that any of all the comparisons of this file fails although all is well.
pub(crate) const SIGNIFICANCE: f64 = 0.01;

const ALPHAS: [f64; 4] = [0.005, 0.1, 0.5, 1.0];

/// The normal, 45 degrees, grazing, and two directions from below, as the rays of a walk have them.
const COSINES: [f64; 5] = [1.0, std::f64::consts::FRAC_1_SQRT_2, 0.02, -0.02, -0.3];

/// The least slope, over alpha, that a direction sees: 0 from above.
fn least_slope(alpha: f64, cos: f64) -> f64 {
    (-cos / (alpha * (1.0 - cos * cos).sqrt())).max(0.0)
}

/// Probability of every cell. In slopes (x, y) over alpha, visible normals have the density
/// max(0, cos - alpha x sin) P(x, y) up to a constant, with P = exp(-r^2)/pi (Beckmann) or 1/(pi (1 + r^2)^2) (GGX).
/// The radius is taken through its arc tangent, from the least slope that is seen.
fn expected(distribution: Distribution, alpha: f64, cos: f64) -> Vec<f64> {
    let sin = (1.0 - cos * cos).sqrt();
    let start = least_slope(alpha, cos).atan();
    let mut cells = vec![0.0; CELLS[0] * CELLS[1]];
    let steps = CELLS.map(|n| n * POINTS);
    for i in 0..steps[0] {
        let r = (start + (0.5 * PI - start) * (i as f64 + 0.5) / steps[0] as f64).tan();
        let slopes = match distribution {
            Distribution::Beckmann => (-r * r).exp(),
            Distribution::Ggx => (1.0 + r * r).powi(-2),
            other => panic!("no oracle of {}", other.name()),
        };
        let weight = slopes * r * (1.0 + r * r);
        for j in 0..steps[1] {
            let phi = 2.0 * PI * (j as f64 + 0.5) / steps[1] as f64;
            let seen = (cos - alpha * r * phi.cos() * sin).max(0.0);
            cells[i / POINTS * CELLS[1] + j / POINTS] += weight * seen;
        }
    }
    let total: f64 = cells.iter().sum();
    cells.iter().map(|c| c / total).collect()
}

fn observed(distribution: Distribution, alpha: f64, cos: f64, seed: u64) -> Vec<u32> {
    let w = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let start = least_slope(alpha, cos).atan();
    let mut counts = vec![0; CELLS[0] * CELLS[1]];
    let mut random = Random::new(seed, 0);
    for _ in 0..SAMPLES {
        let m = sample(distribution, alpha, w, [random.next(), random.next()]);
        assert!(m.z > 0.0 && m.dot(w) > -1e-9, "{m} is not seen from {w}");
        let (x, y) = (-m.x / (m.z * alpha), -m.y / (m.z * alpha));
        let radius = (x.hypot(y).atan() - start).max(0.0) / (0.5 * PI - start);
        let azimuth = (y.atan2(x) / (2.0 * PI)).rem_euclid(1.0);
        let [i, j] = [(radius, CELLS[0]), (azimuth, CELLS[1])].map(|(t, n)| ((t * n as f64) as usize).min(n - 1));
        counts[i * CELLS[1] + j] += 1;
    }
    counts
}

/// Pearson's sum and its degrees of freedom.
pub(crate) fn chi_square(expected: &[f64], observed: &[u32]) -> (f64, f64) {
    let term = |expected: f64, found: f64| (found - expected) * (found - expected) / expected;
    let (mut sum, mut cells, mut pool) = (0.0, 0.0, [0.0; 2]);
    for (share, &count) in expected.iter().zip(observed) {
        let expected = share * f64::from(SAMPLES);
        if expected < POOL_BELOW {
            pool = [pool[0] + expected, pool[1] + f64::from(count)];
        } else {
            sum += term(expected, f64::from(count));
            cells += 1.0;
        }
    }
    if pool[0] >= POOL_BELOW {
        sum += term(pool[0], pool[1]);
        cells += 1.0;
    } else {
        assert!(pool[1] < 40.0, "{} samples where {} are expected", pool[1], pool[0]);
    }
    (sum, cells - 1.0)
}

/// Number of standard deviations by which a chi-square is above its mean (Wilson and Hilferty 1931): its cube root is normal.
pub(crate) fn deviations(chi_square: f64, freedom: f64) -> f64 {
    let variance = 2.0 / (9.0 * freedom);
    ((chi_square / freedom).cbrt() - (1.0 - variance)) / variance.sqrt()
}

fn check(distribution: Distribution) {
    let tests = 2.0 * (ALPHAS.len() * COSINES.len()) as f64;
    // Sidak's correction.
    let each = 1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / tests);
    for (i, alpha) in ALPHAS.into_iter().enumerate() {
        for (j, cos) in COSINES.into_iter().enumerate() {
            if distribution == Distribution::Beckmann && least_slope(alpha, cos) > 6.0 {
                // One facet in 1e16 is as steep: no ray meets it.
                continue;
            }
            let counts = observed(distribution, alpha, cos, (i * COSINES.len() + j) as u64);
            let (sum, freedom) = chi_square(&expected(distribution, alpha, cos), &counts);
            let chance = 0.5 * libm::erfc(deviations(sum, freedom) / 2f64.sqrt());
            assert!(chance > each, "{distribution:?} alpha {alpha} cos {cos}: {sum} for {freedom} degrees of freedom");
        }
    }
}

#[test]
fn beckmann_samples_follow_their_density() {
    check(Distribution::Beckmann);
}

#[test]
fn ggx_samples_follow_their_density() {
    check(Distribution::Ggx);
}

//! The two errors of one view: of the albedo and of the lobe.

use std::f64::consts::PI;

use super::energies::Energies;
use super::paths::Histogram;
use super::report::{Quantity, ViewError};

/// The errors of energies against the reference, with their standard errors.
///
/// The standard error of the lobe error is of first order, for fixed signs of the differences. In a cell whose difference is noise, its absolute
/// value still adds to the lobe error. [`ViewError::lobe_floor`] is the lobe error if all differences are noise.
pub(super) fn compare(found: &Energies, reference: &Histogram, wavelength_nm: f64, theta_deg: f64) -> ViewError {
    let albedo_ref = reference.albedo();
    let albedo = found.energies.iter().sum::<f64>();
    let moved: f64 = found.energies.iter().zip(&reference.energies).map(|(e, r)| (e - r).abs()).sum();
    let lobe = share_of(albedo_ref, 0.5 * moved);
    let differences = found.energies.iter().zip(&reference.energies).map(|(e, r)| e - r);
    let half_signs: Vec<f64> = differences.map(|d| if d.abs() > 0.0 { 0.5_f64.copysign(d) } else { 0.0 }).collect();
    let of_reference = reference.variance(|cell| half_signs[cell] + lobe);
    let lobe_std_err = libm::sqrt(of_reference + found.variance(|cell| half_signs[cell]));
    let variances = (0..reference.energies.len()).map(|cell: usize| {
        reference.cell_variance(cell) + found.noise.as_ref().map_or(0.0, |paths| paths.cell_variance(cell))
    });
    let lobe_noise: f64 = variances.map(libm::sqrt).sum();
    ViewError {
        wavelength_nm,
        theta_deg,
        albedo: Quantity {
            error: (albedo - albedo_ref).abs(),
            std_err: libm::sqrt(reference.variance(|_| 1.0) + found.variance(|_| 1.0)),
            quadrature_change: found.change[0],
        },
        lobe: Quantity {
            error: lobe,
            std_err: share_of(albedo_ref, lobe_std_err),
            quadrature_change: share_of(albedo_ref, found.change[1]),
        },
        lobe_floor: share_of(albedo_ref, energy_that_noise_moves(lobe_noise)),
        albedo_model: albedo,
        albedo_reference: albedo_ref,
    }
}

/// An energy as a share of some light. Without light, any energy is an infinite share.
fn share_of(light: f64, energy: f64) -> f64 {
    if energy == 0.0 { 0.0 } else { energy / light }
}

/// Energy that noise moves on average, from the sum of the standard deviations of all cells. It is half the sum of mean absolute values, and the mean
/// absolute value of a normal variable is sqrt(2 / pi) times its deviation.
pub(super) fn energy_that_noise_moves(deviations: f64) -> f64 {
    0.5 * libm::sqrt(2.0 / PI) * deviations
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(energies: &[f64]) -> Energies {
        Energies { energies: energies.to_vec(), change: [0.0; 2], noise: None }
    }

    /// `count` paths of weight 1 with the given chances.
    fn paths(energies: &[f64], count: f64) -> Histogram {
        Histogram { energies: energies.to_vec(), squares: energies.to_vec(), count, families: Vec::new() }
    }

    #[test]
    fn lobes_with_known_errors() {
        let reference = paths(&[0.5, 0.3, 0.0, 0.0], 1e4);
        let error = |energies: &[f64]| compare(&exact(energies), &reference, 550.0, 0.0);
        let same = error(&[0.5, 0.3, 0.0, 0.0]);
        assert!(same.albedo.error < 1e-15 && same.lobe.error < 1e-15);
        // The same energy elsewhere.
        let apart = error(&[0.0, 0.0, 0.7, 0.1]);
        assert!(apart.albedo.error < 1e-15 && (apart.lobe.error - 1.0).abs() < 1e-15);
        // Black: half of the light is in neither.
        let black = error(&[0.0; 4]);
        assert!((black.albedo.error - 0.8).abs() < 1e-15 && (black.lobe.error - 0.5).abs() < 1e-15);
        // A quarter of the light moved.
        assert!((error(&[0.3, 0.5, 0.0, 0.0]).lobe.error - 0.25).abs() < 1e-15);
        // Standard error of a share of 0.8 of ten thousand paths.
        assert!((same.albedo.std_err - 0.004).abs() < 1e-15);
        assert!(compare(&exact(&[0.1]), &paths(&[0.0], 10.0), 550.0, 0.0).lobe.error.is_infinite());
    }

    /// Oracle: the spread over many references, drawn by a small generator.
    #[test]
    fn standard_error_and_floor_are_those_of_repetition() {
        let chances = [0.4, 0.2, 0.1, 0.05];
        let model = [0.3, 0.25, 0.2, 0.1];
        let (runs, count) = (400, 1000);
        let mut state = 1u64;
        let (mut errors, mut floors, mut std_err, mut floor) = (Vec::new(), 0.0, 0.0, 0.0);
        for _ in 0..runs {
            let mut energies = [0.0; 4];
            for _ in 0..count {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let mut u = (state >> 11) as f64 / (1u64 << 53) as f64;
                for (energy, chance) in energies.iter_mut().zip(chances) {
                    if (0.0..chance).contains(&u) {
                        *energy += 1.0 / f64::from(count);
                    }
                    u -= chance;
                }
            }
            let reference = paths(&energies, f64::from(count));
            let view = compare(&exact(&model), &reference, 550.0, 0.0);
            errors.push(view.lobe.error);
            std_err += view.lobe.std_err / f64::from(runs);
            let same = compare(&exact(&chances), &reference, 550.0, 0.0);
            floors += same.lobe.error / f64::from(runs);
            floor += same.lobe_floor / f64::from(runs);
        }
        let mean = errors.iter().sum::<f64>() / f64::from(runs);
        let variance = errors.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / f64::from(runs - 1);
        // Relative standard error of a deviation from 400 runs: 3.5%.
        assert!((libm::sqrt(variance) / std_err - 1.0).abs() < 0.15, "{} {std_err}", libm::sqrt(variance));
        assert!((floors / floor - 1.0).abs() < 0.15, "{floors} {floor}");
    }
}

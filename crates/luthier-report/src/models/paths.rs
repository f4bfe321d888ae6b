//! Histogram of the reference's paths over cells.

use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::LayeredMc;

use super::cells::{CELLS, Cells};
use super::compare::energy_that_noise_moves;

/// Paths by the cell in which they end.
#[derive(Debug, Clone)]
pub(super) struct Histogram {
    /// Mean weight per path, by cell: the energy of the cell.
    pub(super) energies: Vec<f64>,
    /// Mean squared weight per path, by cell.
    pub(super) squares: Vec<f64>,
    /// Number of paths.
    pub(super) count: f64,
    /// Energies of each family of paths. If there are families, variances are those between them.
    pub(super) families: Vec<Vec<f64>>,
}

impl Histogram {
    /// The histogram of as many paths as the estimator has samples.
    pub(super) fn trace(estimator: LayeredMc, stack: &Monochrome, cells: &Cells) -> Self {
        let (mut energies, mut squares) = (vec![0.0; CELLS], vec![0.0; CELLS]);
        for (wi, weight) in estimator.paths(stack, cells.wo).flatten() {
            let cell = cells.cell(wi);
            energies[cell] += weight;
            squares[cell] += weight * weight;
        }
        let count = estimator.samples as f64;
        energies.iter_mut().chain(&mut squares).for_each(|sum| *sum /= count);
        Self { energies, squares, count, families: Vec::new() }
    }

    /// The histogram of families with equal numbers of paths, `count` in all.
    pub(super) fn of_families(families: Vec<Vec<f64>>, count: f64) -> Self {
        let sums = (0..CELLS).map(|cell| families.iter().map(|energies| energies[cell]).sum::<f64>());
        let energies = sums.map(|sum| sum / families.len() as f64).collect();
        Self { energies, squares: vec![0.0; CELLS], count, families }
    }

    /// Variance of the mean of the families' values.
    fn variance_between(&self, value: impl Fn(&[f64]) -> f64) -> f64 {
        let values: Vec<f64> = self.families.iter().map(|energies| value(energies)).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count * (count - 1.0))
    }

    /// Directional albedo.
    pub(super) fn albedo(&self) -> f64 {
        self.energies.iter().sum()
    }

    /// Variance of the energy of a cell.
    pub(super) fn cell_variance(&self, cell: usize) -> f64 {
        if !self.families.is_empty() {
            return self.variance_between(|energies| energies[cell]);
        }
        (self.squares[cell] - self.energies[cell] * self.energies[cell]).max(0.0) / self.count
    }

    /// [`ViewError::lobe_floor`](super::ViewError::lobe_floor) of a model without noise.
    pub(super) fn lobe_floor(&self) -> f64 {
        let deviations: f64 = (0..CELLS).map(|cell| self.cell_variance(cell).sqrt()).sum();
        if deviations == 0.0 { 0.0 } else { energy_that_noise_moves(deviations) / self.albedo() }
    }

    /// Variance of a sum of the cells' energies with factors.
    pub(super) fn variance(&self, factor: impl Fn(usize) -> f64) -> f64 {
        if !self.families.is_empty() {
            return self.variance_between(|energies| {
                energies.iter().enumerate().map(|(cell, energy)| factor(cell) * energy).sum()
            });
        }
        let (mut mean, mut square) = (0.0, 0.0);
        for (cell, (energy, squared)) in self.energies.iter().zip(&self.squares).enumerate() {
            let factor = factor(cell);
            mean += factor * energy;
            square += factor * factor * squared;
        }
        (square - mean * mean).max(0.0) / self.count
    }
}

//! The reference: where its paths go.

use luthier_layers::layered_mc::LayeredMc;
use luthier_layers::monochrome::Monochrome;

use super::cells::{CELLS, Cells};

/// Paths by the cell in which they end.
#[derive(Debug, Clone)]
pub(super) struct Histogram {
    /// Mean weight per path, by cell: the energy of the cell.
    pub(super) energies: Vec<f64>,
    /// Mean squared weight per path, by cell.
    pub(super) squares: Vec<f64>,
    /// Number of paths.
    pub(super) count: f64,
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
        Self { energies, squares, count }
    }

    /// Directional albedo.
    pub(super) fn albedo(&self) -> f64 {
        self.energies.iter().sum()
    }

    /// Variance of the energy of a cell.
    pub(super) fn cell_variance(&self, cell: usize) -> f64 {
        (self.squares[cell] - self.energies[cell] * self.energies[cell]).max(0.0) / self.count
    }

    /// Variance of a sum of the cells' energies with factors.
    pub(super) fn variance(&self, factor: impl Fn(usize) -> f64) -> f64 {
        let (mut mean, mut square) = (0.0, 0.0);
        for (cell, (energy, squared)) in self.energies.iter().zip(&self.squares).enumerate() {
            let factor = factor(cell);
            mean += factor * energy;
            square += factor * factor * squared;
        }
        (square - mean * mean).max(0.0) / self.count
    }
}

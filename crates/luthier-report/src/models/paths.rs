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
    /// Energies of each family of paths, where there are some; then variances are those between them.
    pub(super) families: Vec<Vec<f64>>,
}

/// Families of even paths.
const FAMILIES: u64 = 16;

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

    /// The histogram of [`FAMILIES`] families of even paths, together about as many as the estimator has samples: less noise, for the time
    /// of as many paths.
    pub(super) fn trace_evenly(estimator: LayeredMc, stack: &Monochrome, cells: &Cells) -> Self {
        let samples = estimator.samples.div_ceil(FAMILIES);
        let family = |number: u64| {
            let mut energies = vec![0.0; CELLS];
            let estimator = LayeredMc { samples, seed: estimator.seed + number, ..estimator };
            for (wi, weight) in estimator.even_paths(stack, cells.wo).flatten() {
                energies[cells.cell(wi)] += weight / samples as f64;
            }
            energies
        };
        let families: Vec<Vec<f64>> = (0..FAMILIES).map(family).collect();
        let mean = |cell: usize| families.iter().map(|energies| energies[cell]).sum::<f64>() / FAMILIES as f64;
        let energies = (0..CELLS).map(mean).collect();
        Self { energies, squares: vec![0.0; CELLS], count: (samples * FAMILIES) as f64, families }
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

    /// Variance of a sum of the cells' energies with factors.
    pub(super) fn variance(&self, factor: impl Fn(usize) -> f64) -> f64 {
        if !self.families.is_empty() {
            let sum = |energies: &[f64]| energies.iter().enumerate().map(|(cell, energy)| factor(cell) * energy).sum();
            return self.variance_between(sum);
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

#[cfg(test)]
mod tests {
    use luthier_layers::layered_mc::InterfaceMode;
    use luthier_layers::monochrome::MonochromeBelow;
    use luthier_optics::stack::{Distribution, Surface};

    use super::*;
    use crate::models::cells::Cells;

    /// Families of even paths find what independent paths find, with less noise, and say how much less.
    #[test]
    fn even_paths_agree_and_have_less_noise() {
        let rough = Surface::isotropic(Distribution::Ggx, 0.3);
        let base = MonochromeBelow::Diffuse { albedo: 0.5, sigma: 0.0 };
        let stack = Monochrome::bare(&[(rough, MonochromeBelow::dielectric(1.5, 0.2)), (rough, base)]);
        let cells = Cells::new(glam::DVec3::new(0.6, 0.0, 0.8));
        let estimator = LayeredMc { mode: InterfaceMode::SmithWalk, samples: 40_000, seed: 5 };
        let (even, plain) =
            (Histogram::trace_evenly(estimator, &stack, &cells), Histogram::trace(estimator, &stack, &cells));
        let [even_variance, plain_variance] = [&even, &plain].map(|histogram| histogram.variance(|_| 1.0));
        let apart = (even.albedo() - plain.albedo()).abs();
        assert!(apart < 4.0 * (even_variance + plain_variance).sqrt(), "{apart} {even_variance} {plain_variance}");
        assert!(even_variance < 0.25 * plain_variance, "{even_variance} {plain_variance}");
        let sum = |histogram: &Histogram| (0..CELLS).map(|cell| histogram.cell_variance(cell)).sum::<f64>();
        assert!(sum(&even) < sum(&plain), "{} {}", sum(&even), sum(&plain));
    }
}

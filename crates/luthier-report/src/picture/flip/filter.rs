//! Separable filters. Beyond its edges a picture repeats its edge pixels.

/// Weights from -radius to radius.
pub(super) struct Kernel(Vec<f64>);

impl Kernel {
    pub(super) fn new(radius: i32, weight: impl Fn(f64) -> f64) -> Self {
        Self((-radius..=radius).map(|x| weight(f64::from(x))).collect())
    }

    pub(super) fn sum(&self) -> f64 {
        self.0.iter().sum()
    }

    /// Weights that sum to 1.
    pub(super) fn normalised(self) -> Self {
        let sum = self.sum();
        Self(self.0.into_iter().map(|w| w / sum).collect())
    }

    /// Scales positive weights to a sum of 1, and negative ones to -1.
    pub(super) fn balanced(self) -> Self {
        let [positive, negative] = [1.0, -1.0].map(|sign| self.0.iter().map(|w| (sign * w).max(0.0)).sum::<f64>());
        Self(self.0.iter().map(|w| if *w > 0.0 { w / positive } else { w / negative }).collect())
    }
}

/// A plane filtered by `across` along its rows and by `down` along its columns.
pub(super) fn convolved(plane: &[f64], [width, height]: [usize; 2], across: &Kernel, down: &Kernel) -> Vec<f64> {
    let at =
        |i: usize, step: usize, kernel: &Kernel, last: usize| (i + step).saturating_sub(kernel.0.len() / 2).min(last);
    let mut rows = Vec::with_capacity(plane.len());
    for row in plane.chunks_exact(width) {
        for x in 0..width {
            let terms = across.0.iter().enumerate().map(|(k, w)| w * row[at(x, k, across, width - 1)]);
            rows.push(terms.sum::<f64>());
        }
    }
    let mut out = vec![0.0; plane.len()];
    for (y, row) in out.chunks_exact_mut(width).enumerate() {
        for (k, weight) in down.0.iter().enumerate() {
            let source = at(y, k, down, height - 1) * width;
            row.iter_mut().zip(&rows[source..source + width]).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    out
}

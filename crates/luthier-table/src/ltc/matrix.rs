//! Small dense matrices, in a fixed order of operations, because bytes of tables depend on it.

/// A square matrix.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    size: usize,
    data: Vec<f64>,
}

impl Matrix {
    pub(super) fn zeros(size: usize) -> Self {
        Self { size, data: vec![0.0; size * size] }
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.data.iter_mut().zip(&other.data).for_each(|(a, b)| *a += b);
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.size);
        for (row, into) in self.data.chunks_exact(self.size).zip(product.data.chunks_exact_mut(self.size)) {
            for (factor, from) in row.iter().zip(other.data.chunks_exact(self.size)) {
                into.iter_mut().zip(from).for_each(|(a, b)| *a += factor * b);
            }
        }
        product
    }

    /// The inverse of the identity less this, times another. Elimination needs no pivots, because rows of this sum to
    /// less than 1.
    pub(super) fn identity_less_inverse_times(mut self, other: &Self) -> Self {
        let n = self.size;
        self.data.iter_mut().for_each(|value| *value = -*value);
        (0..n).for_each(|i| self[(i, i)] += 1.0);
        let mut solution = other.clone();
        for pivot in 0..n {
            let inverse = 1.0 / self[(pivot, pivot)];
            for row in 0..n {
                let factor = self[(row, pivot)] * inverse;
                if row == pivot || factor == 0.0 {
                    continue;
                }
                for k in pivot..n {
                    let value = self[(pivot, k)];
                    self[(row, k)] -= factor * value;
                }
                for k in 0..n {
                    let value = solution[(pivot, k)];
                    solution[(row, k)] -= factor * value;
                }
            }
        }
        for row in 0..n {
            let inverse = 1.0 / self[(row, row)];
            (0..n).for_each(|k| solution[(row, k)] *= inverse);
        }
        solution
    }
}

impl std::ops::Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.data[row * self.size + column]
    }
}

impl std::ops::IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self.data[row * self.size + column]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elimination_inverts() {
        let mut a = Matrix::zeros(3);
        let mut b = Matrix::zeros(3);
        for i in 0..3 {
            for j in 0..3 {
                a[(i, j)] = 0.1 + 0.05 * (i * 3 + j) as f64 * if i == j { -1.0 } else { 0.5 };
                b[(i, j)] = (i + 2 * j) as f64;
            }
        }
        let x = a.clone().identity_less_inverse_times(&b);
        let product = a.times(&x);
        for i in 0..3 {
            for j in 0..3 {
                assert!((x[(i, j)] - product[(i, j)] - b[(i, j)]).abs() < 1e-12);
            }
        }
    }
}

//! Symmetric positive systems, in a fixed order of operations, because bytes of tables depend on it. No library is used: nalgebra fuses products
//! on some machines.

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds a vector, times a factor.
pub(super) fn add(sum: &mut [f64], factor: f64, vector: &[f64]) {
    sum.iter_mut().zip(vector).for_each(|(s, v)| *s += factor * v);
}

/// The sum of rows, each times its factor.
pub(super) fn combined(rows: &[Vec<f64>], factors: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; rows[0].len()];
    rows.iter().zip(factors).for_each(|(row, factor)| add(&mut sum, *factor, row));
    sum
}

/// The largest magnitude.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| most.max(v.abs()))
}

/// The lower Cholesky factor of a symmetric matrix, whose upper half is not read. None if the matrix is not positive
/// definite.
pub(super) fn cholesky(mut matrix: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    for i in 0..matrix.len() {
        let (before, rest) = matrix.split_at_mut(i);
        let row = &mut rest[0];
        for j in 0..i {
            row[j] = (row[j] - dot(&row[..j], &before[j][..j])) / before[j][j];
        }
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        if pivot <= 0.0 || !pivot.is_finite() {
            return None;
        }
        row[i] = pivot.sqrt();
    }
    Some(matrix)
}

/// The solution for a lower factor L of L L^T.
pub(super) fn solve(factor: &[Vec<f64>], mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for i in 0..n {
        right[i] = (right[i] - dot(&factor[i][..i], &right[..i])) / factor[i][i];
    }
    for i in (0..n).rev() {
        let below: f64 = (i + 1..n).map(|j| factor[j][i] * right[j]).sum();
        right[i] = (right[i] - below) / factor[i][i];
    }
    right
}

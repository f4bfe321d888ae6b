//! Transformations of nodes.

use super::document::Node;
use crate::vector::{V, unit};

/// Columns of a transformation.
pub(super) type Matrix = [[f64; 4]; 4];

pub(super) const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The transformation of a node: a matrix, or else scale, rotation and translation. A rotation of any length counts as
/// a unit quaternion; `None` for length 0.
pub(super) fn of_node(node: &Node) -> Option<Matrix> {
    if let Some(matrix) = &node.matrix {
        return Some(std::array::from_fn(|column| std::array::from_fn(|row| matrix[4 * column + row])));
    }
    let rotation = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let length = rotation.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let [x, y, z, w] = rotation.map(|v| v / length);
    let columns = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let scale = node.scale.unwrap_or([1.0; 3]);
    let [x, y, z] = node.translation.unwrap_or([0.0; 3]);
    let [a, b, c] = [0, 1, 2].map(|k: usize| {
        let [x, y, z] = columns[k].map(|v: f64| v * scale[k]);
        [x, y, z, 0.0]
    });
    Some([a, b, c, [x, y, z, 1.0]])
}

/// The product of two matrices of columns.
pub(super) fn product(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|column| std::array::from_fn(|row| (0..4).map(|k| a[k][row] * b[column][k]).sum()))
}

/// The transformation of a node.
pub(super) struct Turn {
    matrix: Matrix,
    /// Cofactors of the linear part, which transform normals.
    cofactors: [[f64; 3]; 3],
    mirrors: bool,
}

impl Turn {
    pub(super) fn of(matrix: Matrix) -> Self {
        // Each is made of the two columns and rows that follow in the cycle.
        let cofactors: [[f64; 3]; 3] = std::array::from_fn(|i| {
            let [a, b] = [1, 2].map(|k| matrix[(i + k) % 3]);
            std::array::from_fn(|j| a[(j + 1) % 3] * b[(j + 2) % 3] - a[(j + 2) % 3] * b[(j + 1) % 3])
        });
        let determinant: f64 = (0..3).map(|j| matrix[0][j] * cofactors[0][j]).sum();
        Self { matrix, cofactors, mirrors: determinant < 0.0 }
    }

    pub(super) fn point(&self, at: V) -> V {
        let at = at.map(f64::from);
        [0, 1, 2].map(|row| ((0..3).map(|k| self.matrix[k][row] * at[k]).sum::<f64>() + self.matrix[3][row]) as f32)
    }

    fn direction(&self, v: V) -> V {
        let v = v.map(f64::from);
        scaled([0, 1, 2].map(|row| (0..3).map(|k| self.matrix[k][row] * v[k]).sum()))
    }

    pub(super) fn normal(&self, v: V) -> V {
        let v = v.map(f64::from);
        let sign = if self.mirrors { -1.0 } else { 1.0 };
        scaled([0, 1, 2].map(|row| (0..3).map(|k| sign * self.cofactors[k][row] * v[k]).sum()))
    }

    /// A tangent with its sign; `None` without a direction.
    pub(super) fn tangent(&self, [x, y, z, w]: [f32; 4]) -> Option<[f32; 4]> {
        let [x, y, z] = unit(self.direction([x, y, z])).filter(|_| w.is_finite())?;
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        Some([x, y, z, if self.mirrors { -sign } else { sign }])
    }

    /// Winds triangles so that they are counterclockwise from outside after the turn.
    pub(super) fn wound(&self, mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        if self.mirrors {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        triangles
    }
}

/// A direction of any length, within the range of single precision.
fn scaled(v: [f64; 3]) -> V {
    let largest = v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest > 0.0 && largest.is_finite() { v.map(|x| (x / largest) as f32) } else { [0.0; 3] }
}

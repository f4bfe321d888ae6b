//! Normals from triangles.

use crate::soup::Vertex;
use crate::vector::{V, along, angle, cross, sub, unit};

/// Normal of a vertex without a triangle of any area. It is not visible, so any will do.
const ANY: V = [0.0, 1.0, 0.0];

/// Computes the normals of vertices that have 0 in their place: the mean of the normals of the triangles that touch
/// them, weighed by their angles there.
pub(crate) fn complete(vertices: &mut [Vertex], triangles: &[[u32; 3]]) {
    let mut sums = vec![[0.0; 3]; vertices.len()];
    for triangle in triangles {
        let corners = triangle.map(|i| vertices[i as usize].position);
        let [a, b, c] = corners;
        let Some(normal) = unit(cross(sub(b, a), sub(c, a))) else { continue };
        for (k, &i) in triangle.iter().enumerate() {
            let sum = &mut sums[i as usize];
            *sum = along(*sum, angle(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]), normal);
        }
    }
    for (vertex, sum) in vertices.iter_mut().zip(sums).filter(|(vertex, _)| vertex.normal == [0.0; 3]) {
        vertex.normal = unit(sum).unwrap_or(ANY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corner of a cube, one of whose sides is two triangles: its normal is the diagonal, whatever the triangles are.
    #[test]
    fn angles_weigh() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [5.0, 5.0, 5.0]];
        let vertex = |position| Vertex { position, normal: [0.0; 3], tangent: [0.0; 4], uv: [0.0; 2] };
        let mut vertices: Vec<Vertex> = positions.map(vertex).to_vec();
        vertices[1].normal = [1.0, 0.0, 0.0];
        complete(&mut vertices, &[[0, 2, 1], [0, 3, 2], [0, 1, 4], [0, 4, 3]]);
        let expected = -(1.0f32 / 3.0).sqrt();
        assert!(vertices[0].normal.iter().all(|v| (v - expected).abs() < 1e-6), "{:?}", vertices[0].normal);
        assert_eq!((vertices[1].normal, vertices[2].normal), ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]));
        assert_eq!(vertices[5].normal, ANY);
    }
}

//! Openness of the vertices of a mesh to their surroundings.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::bvh::Bvh;
use crate::soup::{Triangle, Vertex};
use crate::vector::{V, across, along, cross};

/// Rays of all vertices together: they take about half a second.
const RAYS: usize = 1 << 19;

/// The openness of each vertex, from rays in fixed directions with the density of the cosine.
pub(crate) fn openness(vertices: &[Vertex], triangles: &[Triangle], bvh: &Bvh) -> Vec<f32> {
    let count = (RAYS / vertices.len().max(1)).clamp(4, 128);
    let directions: Vec<V> = (0..count).map(|i| cosine_weighted(i, count)).collect();
    let mut part = vec![0; vertices.len()];
    for triangle in triangles {
        triangle.corners.iter().for_each(|&i| part[i as usize] = triangle.part);
    }
    let shares = vertices.par_iter().zip(part).map(|(vertex, part)| {
        let n = vertex.normal;
        let t = across(n);
        let b = cross(n, t);
        let origin = along(vertex.position, 2e-3, n);
        let open = directions.iter().filter(|d| {
            let direction = [0, 1, 2].map(|c| d[0] * t[c] + d[1] * b[c] + d[2] * n[c]);
            // The shown part hides from all, plain parts from plain ones.
            let hidden = bvh.nearest(origin, direction, f32::INFINITY, |i| {
                let triangle = triangles[i as usize];
                (part > 0 || triangle.part == 0).then(|| triangle.positions(vertices))
            });
            hidden.is_none()
        });
        open.count() as f32 / count as f32
    });
    shares.collect()
}

/// Hammersley's points, mapped to the hemisphere.
fn cosine_weighted(i: usize, count: usize) -> V {
    let u = (i as f64 + 0.5) / count as f64;
    let turn = f64::from((i as u32).reverse_bits()) / 4_294_967_296.0;
    let (sin, cos) = libm::sincos(2.0 * PI * turn);
    let r = u.sqrt();
    [r * cos, r * sin, (1.0 - u).sqrt()].map(|v| v as f32)
}

//! Tangents from texture coordinates.

use crate::soup::{Soup, Vertex};
use crate::vector::{V, across, along, angle, dot, sub, unit};

/// Computes missing tangents: directions of growing `u`, weighed by the angles at the corner, as in MikkTSpace. A
/// vertex between triangles of both orientations of the texture becomes two. Without texture coordinates, tangents are
/// any direction across the normal.
pub(crate) fn complete(soup: &mut Soup) {
    soup.has_tangents.resize(soup.vertices.len(), false);
    let count = soup.vertices.len();
    // Sums for triangles whose texture is as it is, and for those whose texture is mirrored.
    let mut sums = vec![[[0.0; 3]; 2]; count];
    let mut touched = vec![[false; 2]; count];
    let side =
        |soup: &Soup, corners: [u32; 3]| usize::from(orientation(corners.map(|i| &soup.vertices[i as usize])) < 0.0);
    for triangle in &soup.triangles {
        let corners = triangle.corners.map(|i| &soup.vertices[i as usize]);
        let side = side(soup, triangle.corners);
        let along_u = direction(corners);
        for (k, &i) in triangle.corners.iter().enumerate() {
            let weight = angle(corners[k].position, corners[(k + 1) % 3].position, corners[(k + 2) % 3].position);
            let sum = &mut sums[i as usize][side];
            *sum = along(*sum, weight, along_u);
            touched[i as usize][side] = true;
        }
    }
    // Number of the second vertex, of a vertex that triangles of both orientations touch.
    let mut mirrored = vec![None; count];
    for i in 0..count {
        if soup.has_tangents[i] {
            // Made exactly across the normal: files round.
            let [x, y, z, sign] = soup.vertices[i].tangent;
            soup.vertices[i].tangent = tangent(&soup.vertices[i], [x, y, z], usize::from(sign < 0.0));
            continue;
        }
        let both = touched[i][0] && touched[i][1];
        let vertex = soup.vertices[i];
        let first = usize::from(!touched[i][0] && touched[i][1]);
        soup.vertices[i].tangent = tangent(&vertex, sums[i][first], first);
        if both {
            mirrored[i] = Some(soup.vertices.len() as u32);
            soup.vertices.push(Vertex { tangent: tangent(&vertex, sums[i][1], 1), ..vertex });
        }
    }
    for n in 0..soup.triangles.len() {
        let corners = soup.triangles[n].corners;
        if side(soup, corners) == 1 {
            soup.triangles[n].corners = corners.map(|i| mirrored[i as usize].unwrap_or(i));
        }
    }
}

fn tangent(vertex: &Vertex, sum: V, side: usize) -> [f32; 4] {
    let n = vertex.normal;
    let [x, y, z] = unit(along(sum, -dot(sum, n), n)).unwrap_or_else(|| across(n));
    [x, y, z, if side == 0 { 1.0 } else { -1.0 }]
}

/// Twice the area of a triangle in the texture: positive where `v` falls along `cross(normal, tangent)`.
fn orientation([a, b, c]: [&Vertex; 3]) -> f32 {
    let [b, c] = [b, c].map(|other| [other.uv[0] - a.uv[0], other.uv[1] - a.uv[1]]);
    -(b[0] * c[1] - b[1] * c[0])
}

/// The unit direction of growing `u`; 0 if the texture has no area.
fn direction(corners: [&Vertex; 3]) -> V {
    let [a, b, c] = corners;
    let (ab, ac) = (sub(b.position, a.position), sub(c.position, a.position));
    let (bv, cv) = (b.uv[1] - a.uv[1], c.uv[1] - a.uv[1]);
    let sign = if orientation(corners) < 0.0 { 1.0 } else { -1.0 };
    let sum = [0, 1, 2].map(|i| sign * (cv * ab[i] - bv * ac[i]));
    unit(sum).unwrap_or([0.0; 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triangle;

    fn square(uvs: [[f32; 2]; 4]) -> Soup {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let vertex = |(at, uv): ([f32; 2], [f32; 2])| Vertex {
            position: [at[0], at[1], 0.0],
            normal: [0.0, 0.0, 1.0],
            tangent: [0.0; 4],
            uv,
        };
        Soup {
            vertices: corners.into_iter().zip(uvs).map(vertex).collect(),
            triangles: [[0, 1, 2], [0, 2, 3]].map(|corners| Triangle { corners, part: 0, material: 0 }).to_vec(),
            has_uv: true,
            ..Soup::default()
        }
    }

    /// The picture upright, turned by a right angle, and mirrored.
    #[test]
    fn tangents_follow_u() {
        let upright = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
        let turned = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        let mirrored = upright.map(|[u, v]| [1.0 - u, v]);
        for (uvs, expected) in
            [(upright, [1.0, 0.0, 0.0, 1.0]), (turned, [0.0, 1.0, 0.0, 1.0]), (mirrored, [-1.0, 0.0, 0.0, -1.0])]
        {
            let mut soup = square(uvs);
            complete(&mut soup);
            assert_eq!(soup.vertices.len(), 4);
            for vertex in &soup.vertices {
                let off = vertex.tangent.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(off < 1e-6, "{uvs:?}: {:?}", vertex.tangent);
            }
        }
    }

    /// Two triangles that mirror the picture at their common edge share no vertex afterwards.
    #[test]
    fn mirrored_seams_are_split() {
        let mut soup = square([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0]]);
        complete(&mut soup);
        assert_eq!(soup.vertices.len(), 6);
        let signs = |n: usize| soup.triangles[n].corners.map(|i| soup.vertices[i as usize].tangent[3]);
        assert_eq!((signs(0), signs(1)), ([-1.0; 3], [1.0; 3]));
    }
}

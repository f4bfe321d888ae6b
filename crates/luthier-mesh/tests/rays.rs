//! The tree of boxes against a look at every triangle, and against spheres in closed form.

use luthier_mesh::{Bvh, Mesh, Soup, Triangle, Vertex};

/// A stream of numbers in 0..1: Numerical Recipes' constants.
fn random(state: &mut u32) -> f64 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f64::from(*state >> 8) / f64::from(1u32 << 24)
}

fn point(state: &mut u32, size: f64) -> [f32; 3] {
    std::array::from_fn(|_| ((random(state) - 0.5) * size) as f32)
}

/// Distance by the plane of the triangle and the signs of three areas, in double precision: another way than that of the crate.
fn distance([a, b, c]: [[f32; 3]; 3], origin: [f32; 3], direction: [f32; 3]) -> Option<f64> {
    let v = |v: [f32; 3]| v.map(f64::from);
    let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (a, b, c, o, d) = (v(a), v(b), v(c), v(origin), v(direction));
    let normal = cross(sub(b, a), sub(c, a));
    let t = dot(sub(a, o), normal) / dot(d, normal);
    let at = [0, 1, 2].map(|i| o[i] + t * d[i]);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|&(p, q)| dot(cross(sub(q, p), sub(at, p)), normal) >= 0.0);
    (t > 0.0 && inside).then_some(t)
}

#[test]
fn the_tree_finds_what_a_search_finds() {
    let mut state = 1;
    // Many small triangles, some large ones, some at one place.
    let mut corners: Vec<[[f32; 3]; 3]> = Vec::new();
    for i in 0..600 {
        let size = if i % 50 == 0 { 4.0 } else { 0.3 };
        let at = if i % 7 == 0 { [0.25; 3] } else { point(&mut state, 4.0) };
        corners.push(std::array::from_fn(|_| {
            let off = point(&mut state, size);
            [at[0] + off[0], at[1] + off[1], at[2] + off[2]]
        }));
    }
    let (bvh, order) = Bvh::new(&corners);
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().copied().eq(0..600), "every triangle once");
    let mut met = 0;
    for _ in 0..4000 {
        let (origin, direction) = (point(&mut state, 8.0), point(&mut state, 2.0));
        let found = bvh.nearest(origin, direction, f32::INFINITY, |i| Some(corners[order[i as usize] as usize]));
        let expected = corners.iter().filter_map(|&c| distance(c, origin, direction)).fold(f64::INFINITY, f64::min);
        met += u32::from(found.is_some());
        match found {
            Some(meeting) => {
                assert!((f64::from(meeting.t) - expected).abs() < 1e-3 * expected.max(1.0), "{} {expected}", meeting.t)
            }
            None => assert!(expected.is_infinite(), "missed at {expected}"),
        }
    }
    assert!((300..3900).contains(&met), "{met}");
}

/// A sphere of triangles about a point, as fine as asked for.
fn sphere(radius: f64, rows: u32, soup: &mut Soup, part: u32) {
    let first = soup.vertices.len() as u32;
    for (row, column) in (0..=rows).flat_map(|row| (0..=2 * rows).map(move |column| (row, column))) {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(row) / f64::from(rows));
        let (s, c) = libm::sincos(std::f64::consts::PI * f64::from(column) / f64::from(rows));
        let normal = [sin * s, cos, sin * c].map(|v| v as f32);
        let uv = [f64::from(column) / f64::from(2 * rows), f64::from(row) / f64::from(rows)].map(|v| v as f32);
        let position = normal.map(|v| v * radius as f32);
        soup.vertices.push(Vertex { position, normal, tangent: [0.0; 4], uv });
    }
    let columns = 2 * rows + 1;
    for (row, column) in (0..rows).flat_map(|row| (0..2 * rows).map(move |column| (row, column))) {
        let [a, b] = [first + row * columns + column, first + (row + 1) * columns + column];
        soup.triangles.push(Triangle { corners: [a, b, b + 1], part, material: 0 });
        soup.triangles.push(Triangle { corners: [a, b + 1, a + 1], part, material: 0 });
    }
}

/// A floor below a sphere of radius 1 that touches it: from a point at distance x of the contact, the sphere hides the share
/// (1 / (1 + x^2)) cos of the cosine-weighted hemisphere, with cos = 1 / sqrt(1 + x^2) the cosine to its centre, where it is wholly above the
/// horizon (Lambert's formula for spheres: sin^2 of its radius times the cosine to its centre).
#[test]
fn openness_under_a_sphere_is_lamberts() {
    let mut soup = Soup { plain: vec![[0.5; 3]], has_uv: true, ..Soup::default() };
    sphere(1.0, 48, &mut soup, 0);
    let first = soup.vertices.len() as u32;
    let places = [0.5f32, 1.0, 1.5, 2.0, 3.0, 6.0];
    for x in places {
        for (x, z) in [(x, 0.0), (x, 0.01), (x + 0.01, 0.0)] {
            let normal = [0.0, 1.0, 0.0];
            soup.vertices.push(Vertex { position: [x, -1.0, z], normal, tangent: [0.0; 4], uv: [0.0; 2] });
        }
    }
    soup.triangles.extend((0..places.len() as u32).map(|i| Triangle {
        corners: [0, 1, 2].map(|k| first + 3 * i + k),
        part: 1,
        material: 0,
    }));
    let mesh = Mesh::new(soup).unwrap();
    for (x, i) in places.into_iter().zip((first..).step_by(3)) {
        let distance_sq = f64::from(1.0 + x * x);
        let expected = 1.0 - 1.0 / (distance_sq * distance_sq.sqrt());
        let found = f64::from(mesh.openness()[i as usize]);
        assert!((found - expected).abs() < 0.03, "{x}: {found} for {expected}");
    }
    assert!((mesh.floor().unwrap() + 1.0).abs() < 1e-6);
    assert!(
        mesh.openness()[..first as usize].iter().all(|&open| open > 0.95),
        "the floor does not hide the sphere's surroundings"
    );
}

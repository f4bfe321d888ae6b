//! The model: its bytes, its surface, its tangents.

use luthier_mesh::{Mesh, Soup, model, soup};

fn read(bytes: &[u8]) -> Soup {
    let file = soup(bytes, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap();
    assert!(file.left_out.is_empty());
    file.soup
}

/// The file is what the program makes; `LUTHIER_ACCEPT=1` writes it.
#[test]
fn the_file_is_what_is_made() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/model.glb");
    let made = model::glb();
    if std::env::var_os("LUTHIER_ACCEPT").is_some() {
        std::fs::write(path, &made).unwrap();
    }
    assert!(std::fs::read(path).unwrap() == made, "run this test with LUTHIER_ACCEPT=1");
    assert!(made.len() < 500_000, "{} bytes", made.len());
}

/// Triangles face the side of their normals; tangents are those of the texture coordinates.
#[test]
fn normals_and_tangents_fit_the_triangles() {
    let made = read(&model::glb());
    let sub = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|c| f64::from(a[c] - b[c]));
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for triangle in &made.triangles {
        let [a, b, c] = triangle.corners.map(|i| made.vertices[i as usize]);
        let (ab, ac) = (sub(b.position, a.position), sub(c.position, a.position));
        let normal = [ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]];
        let length = dot(normal, normal).sqrt();
        for vertex in [a, b, c] {
            let cosine = dot(normal, vertex.normal.map(f64::from)) / length;
            assert!(cosine > 0.97, "{cosine} {vertex:?}");
        }
        if triangle.part > 0 {
            continue;
        }
        let [bu, bv] = [0, 1].map(|c| f64::from(b.uv[c] - a.uv[c]));
        let [cu, cv] = [0, 1].map(|k| f64::from(c.uv[k] - a.uv[k]));
        let determinant = bu * cv - bv * cu;
        assert!(determinant < 0.0, "the texture is upright: {a:?} {b:?} {c:?}");
        let along: Vec<f64> = (0..3).map(|i| (cv * ab[i] - bv * ac[i]) / determinant).collect();
        let along_length = along.iter().map(|v| v * v).sum::<f64>().sqrt();
        let mean: Vec<f64> = (0..3).map(|i| f64::from(a.tangent[i] + b.tangent[i] + c.tangent[i]) / 3.0).collect();
        let cosine = along.iter().zip(&mean).map(|(a, b)| a * b).sum::<f64>() / along_length;
        // Triangles at the poles are a column wide.
        assert!(cosine > 0.97, "{cosine} {a:?}");
    }
}

/// Its shown part is in the unit sphere; the floor is closed below it, dark under the stand and open far away.
#[test]
fn it_stands_on_its_floor() {
    let mesh = Mesh::new(read(model::GLB)).unwrap();
    let floor = mesh.floor().unwrap();
    assert!((-1.0..-0.5).contains(&floor) && mesh.plain().len() == 1 && mesh.has_uv());
    let mut corners: Vec<usize> =
        mesh.triangles().iter().filter(|t| t.part == 1).flat_map(|t| t.corners).map(|i| i as usize).collect();
    corners
        .sort_by_key(|&i| (1e4 * libm::hypotf(mesh.vertices()[i].position[0], mesh.vertices()[i].position[2])) as u32);
    let open = |i: usize| mesh.openness()[corners[i]];
    assert!(open(0) < 0.02 && open(corners.len() - 1) > 0.99, "{} {}", open(0), open(corners.len() - 1));
    let ray = mesh.nearest([0.0, 5.0, 0.0], [0.0, -1.0, 0.0]).unwrap();
    assert_eq!(mesh.triangles()[ray.triangle as usize].part, 0);
}

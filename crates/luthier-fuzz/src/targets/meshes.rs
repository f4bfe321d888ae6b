//! glTF: meshes and materials.

use std::collections::BTreeSet;
use std::io::ErrorKind;

use luthier_mesh::{Mesh, TRIANGLES_MAX, soup};

/// Triangles of the largest mesh that is prepared. Larger ones would take the time of the others.
const READY_MAX: usize = 1 << 12;

/// A glTF file; the buffers beside it are the file itself.
pub(super) fn gltf(bytes: &[u8]) {
    let file = match soup(bytes, &|_| Ok(bytes.to_vec())) {
        Ok(file) => file,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    let all = &file.soup;
    assert!(all.triangles.len() <= TRIANGLES_MAX && all.has_tangents.len() == all.vertices.len());
    for triangle in &all.triangles {
        assert!(triangle.part as usize <= all.plain.len());
        assert!(triangle.corners.iter().all(|&corner| (corner as usize) < all.vertices.len()));
    }
    assert!(all.vertices.iter().all(|vertex| vertex.position.iter().all(|value| value.is_finite())));
    if all.triangles.len().max(all.vertices.len()) > READY_MAX {
        return;
    }
    let Ok(mesh) = Mesh::new(file.soup) else { return };
    assert!(mesh.openness().iter().all(|open| (0.0..=1.0).contains(open)));
    assert!(mesh.vertices().iter().all(|vertex| vertex.tangent.iter().all(|value| value.is_finite())));
    for corner in mesh.triangles().iter().filter(|triangle| triangle.part == 0).flat_map(|triangle| triangle.corners) {
        assert!(mesh.vertices()[corner as usize].position.iter().all(|value| value.abs() < 1.001));
    }
    assert!(mesh.bvh().nodes().iter().all(|node| node.next as usize <= mesh.bvh().nodes().len()));
}

/// Materials of a file; files beside it are missing.
pub(super) fn import(bytes: &[u8]) {
    let import = match luthier_import::import("input", bytes, &|_| Err(ErrorKind::NotFound.into())) {
        Ok(import) => import,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    let names: BTreeSet<&str> = import.materials.iter().map(|material| material.name.as_str()).collect();
    assert!(names.len() == import.materials.len() && !names.is_empty());
    for material in &import.materials {
        let parsed = luthier_material::parse("input.toml", &material.text, &|_| Err(ErrorKind::NotFound.into()));
        let parsed = parsed.unwrap_or_else(|errors| panic!("{errors:?} in {}", material.text));
        assert_eq!(parsed.material.name, material.name);
        for line in material.text.lines().filter_map(|line| line.split_once("image = \"")) {
            let path = line.1.split('"').next().unwrap_or_default();
            assert!(import.pictures.contains_key(path), "{path} of {}", material.text);
        }
    }
    // Of glTF the numbers at places, too.
    let missing = |_: &str| Err(ErrorKind::NotFound.into());
    let Ok(found) = luthier_import::gltf_points(bytes, &missing, &|_| vec![[0.3, 0.7], [-1e3, 1e3]]) else { return };
    assert_eq!(found.len(), import.materials.len());
    for point in found.iter().flat_map(|material| &material.points) {
        let shares = point.base_color.iter().chain(&point.alpha).chain(&point.f0).chain(point.coat.iter().flatten());
        assert!(shares.chain([&point.metallic, &point.specular]).all(|share| (0.0..=1.0).contains(share)), "{point:?}");
        assert!(point.turn.is_finite(), "{point:?}");
    }
}

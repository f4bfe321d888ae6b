//! Meshes for the renderer: their words, and the kernel that meets them.

use luthier_mesh::{Mesh, Triangle};

use crate::Shape;
use crate::context::word;
use crate::floor::FADE;

/// The first number of plain parts: `MESH_PLAIN` in `mesh.wgsl`. Those below are shown materials.
const PLAIN: u32 = 1 << 31;

/// Markers in `shading.wgsl`, `around` and `render.wgsl`, with the text that replaces each for closed shapes and for meshes.
const MARKERS: [(&str, &str, &str); 9] = [
    ("$place", "", ", place: Place"),
    ("$radiance", "environment_radiance(frame * wi)", "mesh_radiance(place, frame * wi, seed)"),
    ("$sign", "", " * place.sign"),
    ("$sees", "", " * mesh_sees(place, to_light, light.w, seed)"),
    ("$here", "", ", place"),
    ("$open", "", " * mesh_open(material, place, turned, wo_there, seed)"),
    ("$shown", "", " && hit.part < MESH_PLAIN"),
    ("$behind_environment", "environment_radiance(ray)", "render_behind(hit, ray, environment_radiance(ray), seed)"),
    (
        "$behind_plain",
        "kernel_inputs.backdrop * (1.0 - 0.3 * min(dot(at, at), 2.0))",
        "render_behind(hit, ray, kernel_inputs.backdrop * (1.0 - 0.3 * min(dot(at, at), 2.0)), seed)",
    ),
];

/// A function that a mesh adds to the kernel of pictures.
const BEHIND: &str = "fn render_behind(hit: Hit, ray: vec3<f32>, behind: vec3<f32>, seed: u32) -> vec3<f32> {\n    \
     if hit.found {\n        return mesh_plain(hit, ray, behind, seed);\n    }\n    return behind;\n}\n";

/// The modules of a picture that depend on the shape; `around` is the one that shows the environment.
pub(crate) fn kernel(shape: Shape, around: &str) -> [String; 4] {
    let is_mesh = shape == Shape::Mesh;
    let texts = [include_str!("wgsl/shading.wgsl"), around, include_str!("wgsl/render.wgsl")];
    let [shading, around, render] = texts.map(|text| {
        MARKERS.iter().fold(text.to_owned(), |text, (marker, closed, mesh)| {
            text.replace(marker, if is_mesh { mesh } else { closed })
        })
    });
    let rays = if is_mesh {
        [include_str!("wgsl/mesh.wgsl"), BEHIND].join("\n")
    } else {
        include_str!("wgsl/shape.wgsl").to_owned()
    };
    [rays, shading, around, render]
}

/// The words of a mesh; `first` is the number of its first word.
pub(crate) fn words(mesh: &Mesh, light_angular_radius: f32, first: usize) -> Vec<[u32; 4]> {
    let nodes = mesh.bvh().nodes();
    let nodes_at = first + 2;
    let triangles_at = nodes_at + 2 * nodes.len();
    let vertices_at = triangles_at + mesh.triangles().len();
    let plain_at = vertices_at + 3 * mesh.vertices().len();
    let mut words = vec![
        [nodes_at, nodes.len(), triangles_at, vertices_at].map(|n| n as u32),
        [plain_at as u32, FADE[0].to_bits(), FADE[1].to_bits(), light_angular_radius.to_bits()],
    ];
    for node in nodes {
        let corners = [(node.low, node.next), (node.high, 8 * node.first + node.count)];
        words.extend(corners.map(|([x, y, z], w)| [x.to_bits(), y.to_bits(), z.to_bits(), w]));
    }
    let part = |t: &Triangle| if t.part == 0 { t.material } else { PLAIN + t.part - 1 };
    words.extend(mesh.triangles().iter().map(|t| [t.corners[0], t.corners[1], t.corners[2], part(t)]));
    for (vertex, open) in mesh.vertices().iter().zip(mesh.openness()) {
        let [x, y, z, sign] = vertex.tangent;
        let own =
            [word(vertex.position, vertex.uv[0]), word(vertex.normal, vertex.uv[1]), [x, y, z, sign * (1.0 + open)]];
        words.extend(own.map(|word| word.map(f32::to_bits)));
    }
    words.extend(mesh.plain().iter().map(|color| word(*color, 0.0).map(f32::to_bits)));
    words
}

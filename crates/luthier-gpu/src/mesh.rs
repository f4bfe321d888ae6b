//! Meshes for the renderer: their words, the kernel that meets them, and the floor as surfaces above it see it.

use std::sync::Arc;

use luthier_environment::{Environment, EnvironmentError};
use luthier_lut::Image;
use luthier_mesh::Mesh;

use crate::{Light, RenderSettings, Scene, Shape};

/// Distances from the axis at which a floor begins to fade into what is behind, and has faded.
const FADE: [f32; 2] = [2.5, 9.0];

/// Squared radius of the sphere that shades a floor in place of the shown part, which fills about so much of the unit sphere.
const BALL_SQ: f64 = 0.4;

/// The parts of the kernel that depend on the shape: markers in `shading.wgsl`, `around` and `render.wgsl`, and what stands there for closed shapes and for
/// meshes.
const MARKERS: [(&str, &str, &str); 9] = [
    ("$place", "", ", place: Place"),
    ("$radiance", "environment_radiance(frame * wi)", "mesh_radiance(place, frame * wi, seed)"),
    ("$sign", "", " * place.sign"),
    ("$sees", "", " * mesh_sees(place, to_light, light.w, seed)"),
    ("$here", "", ", place"),
    ("$open", "", " * mesh_open(material, place, turned, wo_there, seed)"),
    ("$shown", "", " && hit.part == 0u"),
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
    let filled = |text: &str| {
        MARKERS.iter().fold(text.to_owned(), |text, (marker, closed, mesh)| {
            text.replace(marker, if is_mesh { mesh } else { closed })
        })
    };
    let rays = if is_mesh {
        [include_str!("wgsl/mesh.wgsl"), BEHIND].join("\n")
    } else {
        include_str!("wgsl/shape.wgsl").to_owned()
    };
    [rays, filled(include_str!("wgsl/shading.wgsl")), filled(around), filled(include_str!("wgsl/render.wgsl"))]
}

/// The words of a mesh, the first of which has this number.
pub(crate) fn words(mesh: &Mesh, light_angular_radius: f32, first: usize) -> Vec<[u32; 4]> {
    let float = |v: [f32; 3], w: f32| [v[0], v[1], v[2], w].map(f32::to_bits);
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
        let bits = |[x, y, z]: [f32; 3], w: u32| [x.to_bits(), y.to_bits(), z.to_bits(), w];
        words.extend([bits(node.low, node.next), bits(node.high, 8 * node.first + node.count)]);
    }
    words.extend(mesh.triangles().iter().map(|t| [t.corners[0], t.corners[1], t.corners[2], t.part]));
    for (vertex, open) in mesh.vertices().iter().zip(mesh.openness()) {
        let [x, y, z, sign] = vertex.tangent;
        words.extend([
            float(vertex.position, vertex.uv[0]),
            float(vertex.normal, vertex.uv[1]),
            float([x, y, z], sign * (1.0 + open)),
        ]);
    }
    words.extend(mesh.plain().iter().map(|color| float(*color, 0.0)));
    words
}

/// An environment with a floor in its lower half, and all that decides it.
#[derive(Debug)]
pub(crate) struct Grounded {
    from: Arc<Environment>,
    lights: Vec<Light>,
    mesh: Arc<Mesh>,
    environment: Arc<Environment>,
}

impl Scene {
    /// The surroundings of the shown part where no rays are sent to the floor: the floor is in them. They are kept for the next picture.
    pub(crate) fn grounded(&self, settings: &RenderSettings) -> Result<Arc<Environment>, EnvironmentError> {
        let Some((mesh, height)) = settings.mesh.as_ref().and_then(|mesh| Some((mesh, mesh.floor()?))) else {
            return Ok(Arc::clone(&settings.environment));
        };
        let mut kept = self.grounded.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let holds = |kept: &&Grounded| {
            Arc::ptr_eq(&kept.from, &settings.environment)
                && kept.lights == settings.lights
                && Arc::ptr_eq(&kept.mesh, mesh)
        };
        if let Some(kept) = kept.as_ref().filter(holds) {
            return Ok(Arc::clone(&kept.environment));
        }
        let albedo = mesh.plain().first().copied().unwrap_or_default();
        let environment = Arc::new(with_floor(&settings.environment, &settings.lights, albedo, f64::from(-height))?);
        *kept = Some(Grounded {
            from: Arc::clone(&settings.environment),
            lights: settings.lights.clone(),
            mesh: Arc::clone(mesh),
            environment: Arc::clone(&environment),
        });
        Ok(environment)
    }
}

/// An environment whose lower half shows a matte floor at a depth below the origin, as it is seen from there: lit by the upper half and by lights, shaded by
/// a sphere about the origin, and fading into the environment with the distance. Radiance and albedo are linear RGB.
fn with_floor(
    from: &Environment,
    lights: &[Light],
    albedo: [f32; 3],
    depth: f64,
) -> Result<Environment, EnvironmentError> {
    let mut map: Image = from.map().clone();
    let up = from.diffuse([0.0, 1.0, 0.0]);
    let [near, far] = FADE.map(f64::from);
    for y in map.height / 2..map.height {
        let polar = std::f64::consts::PI * (f64::from(y) + 0.5) / f64::from(map.height);
        let (sin, cos) = libm::sincos(polar);
        let distance = depth * sin / -cos;
        let shown = {
            let t = ((distance - near) / (far - near)).clamp(0.0, 1.0);
            1.0 - t * t * (3.0 - 2.0 * t)
        };
        // The sphere hides sin^2 of its radius times the cosine to its centre (Lambert).
        let to_centre_sq = depth * depth + distance * distance;
        let open = 1.0 - (BALL_SQ * depth / (to_centre_sq * to_centre_sq.sqrt())).min(1.0);
        for x in 0..map.width {
            let azimuth = 2.0 * std::f64::consts::PI * ((f64::from(x) + 0.5) / f64::from(map.width) - 0.5);
            let (s, c) = libm::sincos(azimuth);
            let at = [distance * s, -depth, -distance * c];
            let direct = lights.iter().fold([0.0; 3], |sum, light| {
                let irradiance = light.irradiance(at, [0.0, 1.0, 0.0]);
                [0, 1, 2].map(|k| sum[k] + irradiance[k] / std::f64::consts::PI)
            });
            for (k, value) in map.texel_mut(x, y).iter_mut().enumerate() {
                let floor = f64::from(albedo[k]) * (up[k] * open + direct[k]);
                *value = (f64::from(*value) * (1.0 - shown) + floor * shown) as f32;
            }
        }
    }
    Environment::new(map)
}

//! The floor below a mesh, as surfaces above it see it.

use std::sync::Arc;

use luthier_environment::{Environment, EnvironmentError};
use luthier_lut::Image;
use luthier_mesh::Mesh;

use crate::Light;

/// Distances from the axis at which a floor begins to fade into the background, and at which it is gone.
pub(crate) const FADE: [f32; 2] = [2.5, 9.0];

/// Squared radius of the sphere that shades a floor in place of the shown part. The part lies in the unit sphere and covers about 40 % of its
/// disc.
const BALL_SQ: f64 = 0.4;

/// An environment with a floor in its lower half, and the inputs that it was made from.
#[derive(Debug)]
pub(crate) struct Grounded {
    from: Arc<Environment>,
    lights: Vec<Light>,
    mesh: Arc<Mesh>,
    /// The environment with the floor.
    pub(crate) environment: Arc<Environment>,
}

impl Grounded {
    /// The surroundings of a mesh; `None` if the mesh has no floor.
    pub(crate) fn new(
        from: &Arc<Environment>,
        lights: &[Light],
        mesh: &Arc<Mesh>,
    ) -> Result<Option<Self>, EnvironmentError> {
        let Some(height) = mesh.floor() else { return Ok(None) };
        let albedo = mesh.plain().first().copied().unwrap_or_default();
        let environment = Arc::new(with_floor(from, lights, albedo, f64::from(-height))?);
        Ok(Some(Self { from: Arc::clone(from), lights: lights.to_vec(), mesh: Arc::clone(mesh), environment }))
    }

    /// Whether these inputs made it.
    pub(crate) fn is_of(&self, from: &Arc<Environment>, lights: &[Light], mesh: &Arc<Mesh>) -> bool {
        Arc::ptr_eq(&self.from, from) && self.lights == lights && Arc::ptr_eq(&self.mesh, mesh)
    }
}

/// An environment whose lower half shows a matte floor, `depth` below the origin and seen from there. The upper half and the lights light the
/// floor, a sphere about the origin shades it, and it fades into the environment with the distance. Radiance and albedo are linear RGB.
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

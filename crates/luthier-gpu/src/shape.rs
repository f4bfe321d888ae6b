//! Shapes that are rendered, and the camera that sees them.

use glam::DVec3;

use crate::GpuError;
use crate::error::setting;

/// Shape of a picture. All shapes are centred on the origin; +y is up.
///
/// ```
/// use luthier_gpu::Shape;
///
/// // A grid shows 25 materials from +z; a plane lies flat, and its camera is above it.
/// assert_eq!(Shape::Grid.materials(), 25);
/// assert!(Shape::Plane.camera().eye[1] > 0.0 && Shape::Sphere.camera().eye[1] == 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// The unit sphere. Tangents follow the parallels.
    Sphere,
    /// A ring of radius 0.72 around the y axis, 0.3 thick to each side. Tangents follow the ring.
    Torus,
    /// A square of side 2 in the plane y = 0, facing up. Tangents along +x.
    Plane,
    /// Five by five spheres in the plane z = 0: one material each, row by row from the top left.
    Grid,
    /// The triangles of [`RenderSettings::mesh`](crate::RenderSettings::mesh), within the unit sphere: the shown part takes the material.
    Mesh,
}

/// Spheres along a side of the grid.
pub const GRID_SIDE: u32 = 5;

/// The camera. The picture is square and in perspective.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The eye.
    pub eye: [f32; 3],
    /// Point that the camera looks at; +y of the world is up in the picture.
    pub target: [f32; 3],
    /// Half the side of the picture, measured at the distance of the target.
    pub half_extent: f32,
}

impl Shape {
    /// Number of materials that the shape takes.
    pub fn materials(self) -> usize {
        match self {
            Self::Grid => (GRID_SIDE * GRID_SIDE) as usize,
            _ => 1,
        }
    }

    /// A long lens on the whole shape: from +z at the height of the centre, or from above where a shape lies flat.
    pub fn camera(self) -> Camera {
        let (distance, elevation, half_extent): (f64, f64, f32) = match self {
            Self::Sphere => (7.0, 0.0, 1.22),
            Self::Torus => (7.0, 0.65, 1.14),
            Self::Plane => (7.0, 0.5, 1.35),
            Self::Grid => (16.0, 0.0, 2.75),
            Self::Mesh => (7.0, 0.3, 1.1),
        };
        let (sin, cos) = libm::sincos(elevation);
        let eye = [0.0, distance * sin, distance * cos].map(|v| v as f32);
        Camera { eye, target: [0.0; 3], half_extent }
    }

    /// Its number in `shape.wgsl`.
    pub(crate) fn number(self) -> u32 {
        match self {
            Self::Sphere => 0,
            Self::Torus => 1,
            Self::Plane => 2,
            Self::Grid => 3,
            Self::Mesh => 4,
        }
    }
}

impl Camera {
    pub(crate) fn check(&self) -> Result<(), GpuError> {
        let sight = self.sight();
        let across = (sight[0] * sight[0] + sight[2] * sight[2]).sqrt();
        let finite = self.eye.iter().chain(&self.target).all(|v| v.is_finite());
        if !finite || across < 1e-6 {
            return Err(setting("camera", format!("{self:?}"), "the eye is neither at, above nor below the target"));
        }
        if self.half_extent.is_finite() && self.half_extent > 0.0 {
            return Ok(());
        }
        Err(setting("camera.half_extent", self.half_extent.to_string(), "finite and positive"))
    }

    /// The words of the camera in `picture.wgsl`: eye; target; half the picture to the right; half the picture up.
    pub(crate) fn words(&self) -> [[f32; 4]; 4] {
        let sight = self.sight();
        let forward = sight / sight.length();
        let level = forward.cross(DVec3::Y);
        let right = level / level.length();
        let up = right.cross(forward);
        let [right, up] = [right, up].map(|v| (v * f64::from(self.half_extent)).as_vec3().to_array());
        [self.eye, self.target, right, up].map(|[x, y, z]| [x, y, z, 0.0])
    }

    fn sight(&self) -> DVec3 {
        DVec3::from(self.target.map(f64::from)) - DVec3::from(self.eye.map(f64::from))
    }
}

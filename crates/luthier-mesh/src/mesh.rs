//! Meshes as pictures take them.

use crate::bvh::Bvh;
use crate::openness::openness;
use crate::vector::{dot, sub};
use crate::{MeshError, tangents};

/// The most triangles of a mesh.
pub const TRIANGLES_MAX: usize = 1 << 19;

/// A corner of triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Position; +y is up.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent across the normal, along which `u` grows, and the sign of the bitangent: `sign cross(normal, tangent)` is where `v` falls.
    pub tangent: [f32; 4],
    /// Texture coordinates; the top left of a picture is 0, 0.
    pub uv: [f32; 2],
}

/// Three corners, counterclockwise from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    /// Numbers of the vertices.
    pub corners: [u32; 3],
    /// 0 takes the material that is shown; from 1 on, a colour of [`Soup::plain`].
    pub part: u32,
}

/// Triangles before they are made ready.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Soup {
    /// All corners. Tangents count where [`Soup::has_tangents`] is set.
    pub vertices: Vec<Vertex>,
    /// All triangles.
    pub triangles: Vec<Triangle>,
    /// Colours of matte parts that take no material: albedos, linear Rec.709.
    pub plain: Vec<[f32; 3]>,
    /// Whether all shown vertices have texture coordinates.
    pub has_uv: bool,
    /// Whether vertices have tangents, by number. Others get them from texture coordinates.
    pub has_tangents: Vec<bool>,
}

/// Triangles in a tree of boxes, with what rays and shaders want of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) openness: Vec<f32>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) bvh: Bvh,
    plain: Vec<[f32; 3]>,
    has_uv: bool,
    floor: Option<f32>,
}

impl Mesh {
    /// Triangles made ready: those of part 0 moved and scaled into the unit sphere about the origin, which they touch, and the others with them;
    /// tangents where there are none; a tree of boxes; how open each vertex is to its surroundings.
    ///
    /// # Errors
    /// [`MeshError::Empty`] without a triangle of part 0, [`MeshError::TooLarge`].
    pub fn new(mut soup: Soup) -> Result<Self, MeshError> {
        if soup.triangles.len() > TRIANGLES_MAX {
            return Err(MeshError::TooLarge { count: soup.triangles.len(), limit: TRIANGLES_MAX });
        }
        soup.triangles.retain(|triangle| has_area(triangle.corners.map(|i| soup.vertices[i as usize].position)));
        fit(&mut soup)?;
        tangents::complete(&mut soup);
        let corner = |i: u32| soup.vertices[i as usize].position;
        let corners: Vec<[[f32; 3]; 3]> = soup.triangles.iter().map(|t| t.corners.map(corner)).collect();
        let (bvh, order) = Bvh::new(&corners);
        let triangles = order.iter().map(|&i| soup.triangles[i as usize]).collect();
        let floor = floor(&soup);
        let Soup { vertices, plain, has_uv, .. } = soup;
        let mut mesh = Self { openness: vec![1.0; vertices.len()], vertices, triangles, bvh, plain, has_uv, floor };
        mesh.openness = openness(&mesh);
        Ok(mesh)
    }

    /// The corners.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// How open each vertex is: the share of a cosine-weighted hemisphere that no triangle hides. Plain parts hide nothing from the shown part:
    /// they have a colour of their own, which is in its surroundings.
    pub fn openness(&self) -> &[f32] {
        &self.openness
    }

    /// The triangles, in the order of the leaves of the tree.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The tree of boxes.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// Colours of the parts from 1 on: albedos, linear Rec.709.
    pub fn plain(&self) -> &[[f32; 3]] {
        &self.plain
    }

    /// Whether the shown part has texture coordinates.
    pub fn has_uv(&self) -> bool {
        self.has_uv
    }

    /// Height of a level floor: the plane that holds a plain part which lies below all that is shown.
    pub fn floor(&self) -> Option<f32> {
        self.floor
    }
}

fn has_area([a, b, c]: [[f32; 3]; 3]) -> bool {
    let normal = crate::vector::cross(sub(b, a), sub(c, a));
    dot(normal, normal) > 0.0
}

/// Plain parts are no further away than this.
const FAR: f64 = 1e6;

/// Moves the shown part to the origin and scales it.
fn fit(soup: &mut Soup) -> Result<(), MeshError> {
    let shown = || soup.triangles.iter().filter(|t| t.part == 0).flat_map(|t| t.corners);
    let position = |i: u32| soup.vertices[i as usize].position.map(f64::from);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for at in shown().map(position) {
        (0..3).for_each(|c| (low[c], high[c]) = (low[c].min(at[c]), high[c].max(at[c])));
    }
    if shown().next().is_none() {
        return Err(MeshError::Empty);
    }
    let centre = [0, 1, 2].map(|c| 0.5 * (low[c] + high[c]));
    let length = |at: [f64; 3]| (0..3).map(|c| (at[c] - centre[c]) * (at[c] - centre[c])).sum::<f64>().sqrt();
    let radius = shown().map(|i| length(position(i))).fold(0.0, f64::max);
    for vertex in &mut soup.vertices {
        let far = |c: usize| ((f64::from(vertex.position[c]) - centre[c]) / radius).clamp(-FAR, FAR);
        vertex.position = [0, 1, 2].map(|c| far(c) as f32);
    }
    Ok(())
}

/// The height of a plain part that is level and below the rest.
fn floor(soup: &Soup) -> Option<f32> {
    let heights = |is_shown: bool| {
        let triangles = soup.triangles.iter().filter(move |t| (t.part == 0) == is_shown);
        triangles.flat_map(|t| t.corners).map(|i| soup.vertices[i as usize].position[1])
    };
    let lowest = heights(true).fold(f32::INFINITY, f32::min);
    let (low, high) = heights(false).fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    (low.is_finite() && high - low < 1e-4 && low <= lowest + 1e-4).then_some(low)
}

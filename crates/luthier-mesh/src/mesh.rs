//! Meshes as pictures take them.

use crate::bvh::{Bvh, Meeting};
use crate::error::MeshError;
use crate::openness::openness;
use crate::soup::{Soup, TRIANGLES_MAX, Triangle, Vertex};
use crate::tangents;
use crate::vector::{cross, dot, sub};

/// Triangles in a tree of boxes, with the data that rays and shaders need.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    vertices: Vec<Vertex>,
    openness: Vec<f32>,
    triangles: Vec<Triangle>,
    bvh: Bvh,
    plain: Vec<[f32; 3]>,
    has_uv: bool,
    floor: Option<f32>,
}

impl Mesh {
    /// Prepares triangles for pictures. Part 0 is moved and scaled to fill the unit sphere about the origin, and the
    /// other parts move with it. Missing tangents, a tree of boxes and the openness of each vertex are computed.
    ///
    /// # Errors
    /// [`MeshError::Empty`] without a triangle of part 0, [`MeshError::TooLarge`].
    pub fn new(mut soup: Soup) -> Result<Self, MeshError> {
        if soup.triangles.len() > TRIANGLES_MAX {
            return Err(MeshError::TooLarge { count: soup.triangles.len(), limit: TRIANGLES_MAX });
        }
        soup.triangles.retain(|triangle| has_area(triangle.positions(&soup.vertices)));
        fit(&mut soup)?;
        tangents::complete(&mut soup);
        let corners: Vec<[[f32; 3]; 3]> = soup.triangles.iter().map(|t| t.positions(&soup.vertices)).collect();
        let (bvh, order) = Bvh::new(&corners);
        let triangles: Vec<Triangle> = order.iter().map(|&i| soup.triangles[i as usize]).collect();
        let floor = floor(&soup);
        let Soup { vertices, plain, has_uv, .. } = soup;
        Ok(Self { openness: openness(&vertices, &triangles, &bvh), vertices, triangles, bvh, plain, has_uv, floor })
    }

    /// The corners.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Openness of each vertex: the share of a cosine-weighted hemisphere that no triangle hides. Plain parts hide
    /// nothing from the shown part, because their own colour is part of its surroundings.
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

    /// How many materials are shown: numbers of triangles are less.
    pub fn materials(&self) -> usize {
        let shown = self.triangles.iter().filter(|triangle| triangle.part == 0);
        shown.map(|triangle| triangle.material as usize + 1).max().unwrap_or(0)
    }

    /// Whether the shown part has texture coordinates.
    pub fn has_uv(&self) -> bool {
        self.has_uv
    }

    /// The nearest triangle that a ray meets.
    pub fn nearest(&self, origin: [f32; 3], direction: [f32; 3]) -> Option<Meeting> {
        self.bvh
            .nearest(origin, direction, f32::INFINITY, |i| Some(self.triangles[i as usize].positions(&self.vertices)))
    }

    /// Height of a level floor: a plain part in one level plane, below everything shown.
    pub fn floor(&self) -> Option<f32> {
        self.floor
    }
}

fn has_area([a, b, c]: [[f32; 3]; 3]) -> bool {
    let normal = cross(sub(b, a), sub(c, a));
    dot(normal, normal) > 0.0
}

/// Largest coordinate of plain parts.
const FAR: f64 = 1e6;

/// Moves the shown part to the origin and scales it.
fn fit(soup: &mut Soup) -> Result<(), MeshError> {
    let shown = soup.triangles.iter().filter(|t| t.part == 0).flat_map(|t| t.corners);
    let shown = shown.map(|i| soup.vertices[i as usize].position.map(f64::from));
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for at in shown.clone() {
        (0..3).for_each(|c| (low[c], high[c]) = (low[c].min(at[c]), high[c].max(at[c])));
    }
    if shown.clone().next().is_none() {
        return Err(MeshError::Empty);
    }
    let centre = [0, 1, 2].map(|c| 0.5 * (low[c] + high[c]));
    let radii = shown.map(|at| (0..3).map(|c| (at[c] - centre[c]) * (at[c] - centre[c])).sum::<f64>().sqrt());
    let radius = radii.fold(0.0, f64::max);
    for vertex in &mut soup.vertices {
        let scaled = [0, 1, 2].map(|c: usize| (f64::from(vertex.position[c]) - centre[c]) / radius);
        vertex.position = scaled.map(|v| v.clamp(-FAR, FAR) as f32);
    }
    Ok(())
}

/// The height of the plain part, if it is level and below the rest.
fn floor(soup: &Soup) -> Option<f32> {
    let [shown, plain] = [true, false].map(|is_shown| {
        let triangles = soup.triangles.iter().filter(move |t| (t.part == 0) == is_shown);
        triangles.flat_map(|t| t.corners).map(|i| soup.vertices[i as usize].position[1])
    });
    let lowest = shown.fold(f32::INFINITY, f32::min);
    let (low, high) = plain.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    (low.is_finite() && high - low < 1e-4 && low <= lowest + 1e-4).then_some(low)
}

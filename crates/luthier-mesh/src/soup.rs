//! Triangles as read from files.

/// The most triangles of a mesh.
pub const TRIANGLES_MAX: usize = 1 << 19;

/// A corner of triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Position; +y is up.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent across the normal, in the direction of growing `u`, and the sign of the bitangent: `v` falls along
    /// `sign cross(normal, tangent)`.
    pub tangent: [f32; 4],
    /// Texture coordinates; the top left of a picture is 0, 0.
    pub uv: [f32; 2],
}

/// Three corners, counterclockwise from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    /// Numbers of the vertices.
    pub corners: [u32; 3],
    /// 0 takes a shown material; numbers from 1 on are colours of [`Soup::plain`].
    pub part: u32,
    /// Which of the shown materials it takes: 0 but in [`scene`](crate::scene).
    pub material: u32,
}

/// Triangles before they are prepared for pictures.
///
/// ```
/// use luthier_mesh::{Mesh, Soup, Triangle, Vertex};
///
/// let corners = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
/// let blank = Vertex { position: [0.0; 3], normal: [0.0, 0.0, 1.0], tangent: [0.0; 4], uv: [0.0; 2] };
/// let vertices = corners.map(|position| Vertex { position, ..blank }).to_vec();
/// let triangles = vec![Triangle { corners: [0, 1, 2], part: 0, material: 0 }];
/// let mesh = Mesh::new(Soup { vertices, triangles, ..Soup::default() })?;
/// assert!(mesh.vertices().iter().all(|vertex| vertex.position[0].abs() < 1.0)); // fitted into the unit sphere
/// # Ok::<(), luthier_mesh::MeshError>(())
/// ```
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

impl Triangle {
    /// Positions of its corners.
    pub(crate) fn positions(&self, vertices: &[Vertex]) -> [[f32; 3]; 3] {
        self.corners.map(|i| vertices[i as usize].position)
    }
}

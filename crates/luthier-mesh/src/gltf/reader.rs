//! Triangles of nodes, meshes and primitives.

use std::borrow::Cow;

use super::accessor::{Numbers, Owner};
use super::buffers::Buffers;
use super::document::{Document, Primitive};
use super::extensions::{COMPRESSIONS, OF_NODES};
use super::materials::{Placement, plain_color};
use super::turn::{IDENTITY, Matrix, Turn, of_node, product};
use crate::error::MeshError;
use crate::normals;
use crate::soup::{Soup, TRIANGLES_MAX, Triangle, Vertex};
use crate::vector::{cross, sub, unit};

/// Most levels of nodes below a scene.
const DEPTH_MAX: usize = 64;

/// Most nodes of a scene, each counted as often as it is reached.
const NODES_MAX: usize = 1 << 16;

/// Most vertices and corners that are read, unused ones included. Meshes may share them, so their number is not limited
/// by the size of the file.
const LOOKS_MAX: usize = 128 * TRIANGLES_MAX;

/// Contents of a glTF file.
///
/// ```
/// use luthier_mesh::{model, soup};
///
/// let file = soup(model::GLB, &|_| Err(std::io::ErrorKind::NotFound.into()))?;
/// assert_eq!(file.soup.plain.len(), 1); // the floor
/// assert!(file.soup.has_uv && file.left_out.is_empty());
/// # Ok::<(), luthier_mesh::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// Its triangles.
    pub soup: Soup,
    /// Parts of the file that are not shown, or shown otherwise: a phrase each, without repetition.
    pub left_out: Vec<String>,
}

pub(super) struct Reader<'a> {
    numbers: Numbers<'a>,
    soup: Soup,
    left_out: Vec<Cow<'static, str>>,
    nodes: usize,
    looks: usize,
    /// Whether triangles keep the numbers of their materials, none of which is plain.
    keeps_materials: bool,
    /// Normals and tangents without a direction, and texture coordinates that are not finite.
    mended: [usize; 3],
}

/// Vertices and triangles of a primitive.
struct Piece {
    vertices: Vec<Vertex>,
    has_tangent: Vec<bool>,
    triangles: Vec<[u32; 3]>,
    /// Every triangle has corners of its own and is flat.
    flat: bool,
    part: u32,
    material: u32,
}

impl<'a> Reader<'a> {
    pub(super) fn new(document: &'a Document, buffers: &'a Buffers<'a>, keeps_materials: bool) -> Self {
        let soup = Soup { has_uv: true, ..Soup::default() };
        let numbers = Numbers { document, buffers };
        Self { numbers, soup, left_out: Vec::new(), nodes: 0, looks: 0, keeps_materials, mended: [0; 3] }
    }

    pub(super) fn leave_out(&mut self, what: impl Into<Cow<'static, str>>) {
        let what = what.into();
        if !self.left_out.contains(&what) {
            self.left_out.push(what);
        }
    }

    pub(super) fn finish(mut self) -> File {
        let [normals, tangents, uvs] = self.mended;
        let mended = [
            (normals, "normals have no direction and are computed from the triangles"),
            (tangents, "tangents have no direction and are computed from the texture coordinates"),
            (uvs, "texture coordinates are not finite and count as 0"),
        ];
        for (count, sentence) in mended.iter().filter(|(count, _)| *count > 0) {
            self.leave_out(format!("{count} {sentence}"));
        }
        File { soup: self.soup, left_out: self.left_out.into_iter().map(Cow::into_owned).collect() }
    }

    /// Reads the default scene, or the first. Without scenes, reads all nodes; without nodes, all meshes.
    pub(super) fn scene(&mut self) -> Result<(), MeshError> {
        let document = self.numbers.document;
        let nodes = &document.nodes;
        if document.scenes.len() > 1 {
            self.leave_out("scenes other than the default one");
        }
        if let Some(scene) = document.scenes.get(document.scene.unwrap_or(0)) {
            return scene.nodes.iter().try_for_each(|&node| self.node(node, IDENTITY, 0));
        }
        if let Some(number) = document.scene {
            return Err(MeshError::Gltf(format!("scene {number} is not there")));
        }
        if nodes.is_empty() {
            if !document.meshes.is_empty() {
                self.leave_out("it has no scene and no nodes: all meshes are shown, in one place");
            }
            return (0..document.meshes.len()).try_for_each(|mesh| self.mesh(mesh, IDENTITY));
        }
        self.leave_out("it has no scene: all nodes are shown");
        let mut is_root = vec![true; nodes.len()];
        for &child in nodes.iter().flat_map(|node| &node.children) {
            if let Some(root) = is_root.get_mut(child) {
                *root = false;
            }
        }
        (0..nodes.len()).filter(|&node| is_root[node]).try_for_each(|node| self.node(node, IDENTITY, 0))
    }

    fn node(&mut self, index: usize, above: Matrix, depth: usize) -> Result<(), MeshError> {
        self.nodes += 1;
        if depth > DEPTH_MAX || self.nodes > NODES_MAX {
            return Err(MeshError::Gltf(format!("more than {DEPTH_MAX} levels of nodes, or {NODES_MAX} nodes")));
        }
        let node = self.numbers.document.nodes.get(index);
        let node = node.ok_or_else(|| MeshError::Gltf(format!("node {index} is not there")))?;
        let here =
            of_node(node).ok_or_else(|| MeshError::Gltf(format!("the rotation of node {index} is no quaternion")))?;
        let here = product(above, here);
        if let Some(mesh) = node.mesh {
            if node.skin.is_some() {
                self.leave_out("skins: bodies stand as their vertices do");
            }
            for (_, phrase) in OF_NODES.iter().filter(|(name, _)| node.extensions.contains_key(*name)) {
                self.leave_out(*phrase);
            }
            self.mesh(mesh, here)?;
        }
        node.children.iter().try_for_each(|&child| self.node(child, here, depth + 1))
    }

    fn mesh(&mut self, index: usize, matrix: Matrix) -> Result<(), MeshError> {
        let mesh = self.numbers.document.meshes.get(index);
        let mesh = mesh.ok_or_else(|| MeshError::Gltf(format!("mesh {index} is not there")))?;
        let name = mesh.name.clone().unwrap_or_else(|| index.to_string());
        mesh.primitives.iter().try_for_each(|primitive| self.primitive(&name, primitive, &Turn::of(matrix)))
    }

    fn primitive(&mut self, mesh: &str, primitive: &Primitive, turn: &Turn) -> Result<(), MeshError> {
        let mode = primitive.mode.unwrap_or(LIST);
        if mode < LIST {
            self.leave_out("points and lines");
            return Ok(());
        }
        if !primitive.targets.is_empty() {
            self.leave_out("morph targets");
        }
        let Some(positions) = primitive.attributes.positions else {
            self.leave_out("parts without positions");
            return Ok(());
        };
        let (numbers, owner) = (self.numbers, |what| Owner { what, mesh });
        if numbers.accessor(positions, owner("positions"))?.buffer_view.is_none()
            && let Some(name) = COMPRESSIONS.iter().find(|name| primitive.extensions.contains_key(**name))
        {
            return Err(MeshError::Compressed((*name).to_owned()));
        }
        let positions = numbers.floats::<3>(positions, owner("positions"))?;
        let count = positions.len();
        let corners = match primitive.indices {
            Some(accessor) => numbers.indices(accessor, owner("indices"))?,
            None => (0..count as u32).collect(),
        };
        self.looks += count + corners.len();
        if self.looks > LOOKS_MAX {
            return Err(MeshError::Gltf(
                "its parts share too many vertices: export each with vertices of its own".to_owned(),
            ));
        }
        if let Some(number) = corners.iter().find(|&&i| i as usize >= count) {
            return Err(owner("indices").refuse(format!("vertex {number} of {count}")));
        }
        let triangles = triangles(&corners, mode)
            .ok_or_else(|| MeshError::Gltf(format!("mesh `{mesh}` has a mode {mode}, which glTF does not have")))?;
        if mode == LIST && corners.len() % 3 != 0 {
            self.leave_out("corners at the end of a part that make no triangle");
        }
        let (used, triangles) = used(count, &turn.wound(triangles));

        let mut vertices = Vec::with_capacity(used.len());
        for &i in &used {
            let position = turn.point(positions[i]);
            if position.iter().any(|value| !value.is_finite()) {
                let reason = if positions[i].iter().any(|value| !value.is_finite()) {
                    format!("vertex {i} is at {:?}: mend or delete it", positions[i])
                } else {
                    "a node moves them out of the range of numbers".to_owned()
                };
                return Err(owner("positions").refuse(reason));
            }
            vertices.push(Vertex { position, normal: [0.0; 3], tangent: [0.0; 4], uv: [0.0; 2] });
        }
        let mut flat = true;
        if let Some(accessor) = primitive.attributes.normals {
            let all = numbers.floats::<3>(accessor, owner("normals"))?;
            owner("normals").check_count(all.len(), count)?;
            for (vertex, &i) in vertices.iter_mut().zip(&used) {
                vertex.normal = unit(turn.normal(all[i])).unwrap_or([0.0; 3]);
            }
            let missing = vertices.iter().filter(|vertex| vertex.normal == [0.0; 3]).count();
            self.mended[0] += missing;
            flat = missing == vertices.len();
            if !flat && missing > 0 {
                normals::complete(&mut vertices, &triangles);
            }
        }
        let mut has_tangent = vec![false; vertices.len()];
        if let Some(accessor) = primitive.attributes.tangents {
            let all = numbers.floats::<4>(accessor, owner("tangents"))?;
            owner("tangents").check_count(all.len(), count)?;
            for ((vertex, has), &i) in vertices.iter_mut().zip(&mut has_tangent).zip(&used) {
                if let Some(tangent) = turn.tangent(all[i]) {
                    (vertex.tangent, *has) = (tangent, true);
                }
            }
            self.mended[1] += has_tangent.iter().filter(|has| !**has).count();
        }
        let (part, material) = if self.keeps_materials {
            let count = self.numbers.document.materials.len();
            (0, primitive.material.filter(|&index| index < count).unwrap_or(count) as u32)
        } else {
            (self.part(primitive)?, 0)
        };
        if let Some(accessor) = primitive.attributes.uvs {
            let all = numbers.floats::<2>(accessor, owner("texture coordinates"))?;
            owner("texture coordinates").check_count(all.len(), count)?;
            let placement = self.placement(primitive, accessor);
            for (vertex, &i) in vertices.iter_mut().zip(&used) {
                let uv = placement.map_or(all[i], |placement| placement.of_uv(all[i]));
                let is_finite = uv.iter().all(|value| value.is_finite());
                vertex.uv = if is_finite { uv } else { [0.0; 2] };
                self.mended[2] += usize::from(!is_finite);
            }
        } else {
            self.soup.has_uv &= part > 0 || self.keeps_materials;
        }
        self.add(&Piece { vertices, has_tangent, triangles, flat, part, material })
    }

    /// The placement of textures, if texture coordinates are whole numbers: such a placement contains their scale.
    fn placement(&mut self, primitive: &Primitive, uvs: usize) -> Option<Placement> {
        if self.keeps_materials {
            // Maps of the materials have their own.
            return None;
        }
        let document = self.numbers.document;
        let placement = Placement::of(document.materials.get(primitive.material?)?)?;
        if document.accessors.get(uvs)?.component_type == FLOAT {
            self.leave_out("placements of textures (KHR_texture_transform): maps lie as texture coordinates do");
            return None;
        }
        Some(placement)
    }

    /// The number of a part by its plain colour, or 0.
    fn part(&mut self, primitive: &Primitive) -> Result<u32, MeshError> {
        let material = primitive.material.and_then(|index| self.numbers.document.materials.get(index));
        let Some(color) = plain_color(material)? else { return Ok(0) };
        let known = self.soup.plain.iter().position(|other| *other == color);
        let place = known.unwrap_or_else(|| {
            self.soup.plain.push(color);
            self.soup.plain.len() - 1
        });
        Ok(place as u32 + 1)
    }

    fn add(&mut self, piece: &Piece) -> Result<(), MeshError> {
        let &Piece { ref vertices, ref has_tangent, ref triangles, flat, part, material } = piece;
        let all = &mut self.soup;
        let count = all.triangles.len() + triangles.len();
        if count > TRIANGLES_MAX || all.vertices.len() + vertices.len() > 3 * TRIANGLES_MAX {
            return Err(MeshError::TooLarge { count, limit: TRIANGLES_MAX });
        }
        let first = all.vertices.len() as u32;
        if !flat {
            all.vertices.extend(vertices);
            all.has_tangents.extend(has_tangent);
            all.triangles.extend(triangles.iter().map(|t| Triangle { corners: t.map(|i| first + i), part, material }));
            return Ok(());
        }
        for triangle in triangles {
            let corners = triangle.map(|i| vertices[i as usize]);
            let [a, b, c] = corners.map(|vertex| vertex.position);
            let Some(normal) = unit(cross(sub(b, a), sub(c, a))) else { continue };
            let first = all.vertices.len() as u32;
            all.vertices.extend(corners.map(|vertex| Vertex { normal, ..vertex }));
            all.has_tangents.extend(triangle.map(|i| has_tangent[i as usize]));
            all.triangles.push(Triangle { corners: [first, first + 1, first + 2], part, material });
        }
        Ok(())
    }
}

/// The type code of floats.
const FLOAT: u32 = 5126;

/// Modes of primitives.
const LIST: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

/// The triangles of a list, a strip or a fan; `None` for other modes.
fn triangles(corners: &[u32], mode: u32) -> Option<Vec<[u32; 3]>> {
    Some(match mode {
        LIST => corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        STRIP => {
            let windows = corners.windows(3).enumerate();
            windows.map(|(n, t)| if n % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }).collect()
        }
        FAN => corners.windows(2).skip(1).map(|t| [corners[0], t[0], t[1]]).collect(),
        _ => return None,
    })
}

/// The numbers of the vertices that triangles use, and the triangles by places in this list.
fn used(count: usize, triangles: &[[u32; 3]]) -> (Vec<usize>, Vec<[u32; 3]>) {
    let mut places = vec![None; count];
    for &corner in triangles.iter().flatten() {
        places[corner as usize] = Some(0);
    }
    let used: Vec<usize> = (0..count).filter(|&i| places[i].is_some()).collect();
    for (place, &i) in used.iter().enumerate() {
        places[i] = Some(place as u32);
    }
    (used, triangles.iter().map(|t| t.map(|i| places[i as usize].unwrap_or(0))).collect())
}

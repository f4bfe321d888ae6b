//! glTF 2.0 files, text or binary.

use std::io;

use gltf::Semantic;
use gltf::mesh::Mode;

use crate::accessor::{floats, indices};
use crate::buffers::buffers;
use crate::vector::{V, cross, sub, unit};
use crate::{MeshError, Soup, TRIANGLES_MAX, Triangle, Vertex};

/// Name of glTF materials whose parts keep their colour.
const PLAIN: &str = "plain";

/// Levels of nodes below a scene.
const DEPTH_MAX: usize = 64;

/// Nodes of a scene, counted as often as they are met.
const NODES_MAX: usize = 1 << 16;

/// Extensions that change nothing of what is read, or that readers of numbers of any type know.
const KNOWN_EXTENSIONS: [&str; 2] = ["KHR_mesh_quantization", "KHR_materials_unlit"];

/// Contents of a glTF file.
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// Its triangles.
    pub soup: Soup,
    /// Parts of it that are not shown, or not as the file moves them: a phrase each, each once.
    pub left_out: Vec<&'static str>,
}

struct Reader<'a> {
    buffers: &'a [Vec<u8>],
    soup: Soup,
    left_out: Vec<&'static str>,
    nodes: usize,
}

/// The triangles of the default scene of a glTF 2.0 file, binary or text. `files` reads buffers beside the file by their relative paths. Normals that are
/// missing are those of the triangles. The material of the file does not count, but for parts whose material is named `plain`: these keep its base
/// colour.
///
/// # Errors
/// [`MeshError`]: no glTF, extensions that the file cannot do without, buffers that cannot be read, numbers that do not fit, more than
/// [`TRIANGLES_MAX`] triangles.
pub fn soup(bytes: &[u8], files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<File, MeshError> {
    // The reader takes the length of the header from that of the file without a look.
    let length = bytes.get(8..12).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
    if bytes.starts_with(b"glTF") && length.is_none_or(|length| length < 12) {
        return Err(MeshError::Gltf("it ends in its header".to_owned()));
    }
    let invalid = |error: gltf::Error| MeshError::Gltf(error.to_string());
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(bytes).map_err(invalid)?;
    let root = document.into_json();
    // The validation takes it for granted that these are there.
    let mut named =
        root.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|primitive| primitive.attributes.values());
    if named.any(|accessor| accessor.value() >= root.accessors.len()) {
        return Err(MeshError::Gltf("a mesh names an accessor that is not there".to_owned()));
    }
    let document = gltf::Document::from_json(root).map_err(invalid)?;
    let unknown = document.extensions_required().find(|name| !KNOWN_EXTENSIONS.contains(name));
    if let Some(extension) = unknown {
        return Err(MeshError::Extension(extension.to_owned()));
    }
    let buffers = buffers(&document, blob.as_deref(), files)?;
    let mut reader =
        Reader { buffers: &buffers, soup: Soup { has_uv: true, ..Soup::default() }, left_out: Vec::new(), nodes: 0 };
    if document.animations().next().is_some() {
        reader.leave_out("animations");
    }
    let scene = document.default_scene().or_else(|| document.scenes().next()).ok_or(MeshError::Empty)?;
    for node in scene.nodes() {
        reader.node(&node, IDENTITY, 0)?;
    }
    Ok(File { soup: reader.soup, left_out: reader.left_out })
}

type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The product of two matrices of columns.
fn product(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|column| std::array::from_fn(|row| (0..4).map(|k| a[k][row] * b[column][k]).sum()))
}

impl Reader<'_> {
    fn leave_out(&mut self, what: &'static str) {
        if !self.left_out.contains(&what) {
            self.left_out.push(what);
        }
    }

    fn node(&mut self, node: &gltf::Node<'_>, above: Matrix, depth: usize) -> Result<(), MeshError> {
        self.nodes += 1;
        if depth > DEPTH_MAX || self.nodes > NODES_MAX {
            return Err(MeshError::Gltf(format!("more than {DEPTH_MAX} levels of nodes, or {NODES_MAX} nodes")));
        }
        let here = product(above, node.transform().matrix().map(|column| column.map(f64::from)));
        if node.skin().is_some() {
            self.leave_out("skins: bodies stand as their vertices do");
        }
        if let Some(mesh) = node.mesh() {
            let name = mesh.name().map_or_else(|| mesh.index().to_string(), str::to_owned);
            for primitive in mesh.primitives() {
                self.primitive(&name, &primitive, here)?;
            }
        }
        node.children().try_for_each(|child| self.node(&child, here, depth + 1))
    }

    fn primitive(&mut self, mesh: &str, primitive: &gltf::Primitive<'_>, matrix: Matrix) -> Result<(), MeshError> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.leave_out("points and lines");
            return Ok(());
        }
        if primitive.morph_targets().next().is_some() {
            self.leave_out("morph targets");
        }
        let refused = |what| move |reason| MeshError::Accessor { what, mesh: mesh.to_owned(), reason };
        let get = |semantic: Semantic| primitive.get(&semantic);
        let positions = get(Semantic::Positions).ok_or("there are none".to_owned());
        let positions: Vec<V> =
            positions.and_then(|accessor| floats(&accessor, self.buffers)).map_err(refused("positions"))?;
        let count = positions.len();
        let fitting =
            |values: usize| if values == count { Ok(()) } else { Err(format!("{values} for {count} positions")) };
        let normals = self.optional::<3>(get(Semantic::Normals), &fitting).map_err(refused("normals"))?;
        let tangents = self.optional::<4>(get(Semantic::Tangents), &fitting).map_err(refused("tangents"))?;
        let uvs = self.optional::<2>(get(Semantic::TexCoords(0)), &fitting).map_err(refused("texture coordinates"))?;
        let numbers = match primitive.indices() {
            Some(accessor) => indices(&accessor, self.buffers).map_err(refused("indices"))?,
            None => (0..count as u32).collect(),
        };
        if let Some(number) = numbers.iter().find(|&&i| i as usize >= count) {
            return Err(refused("indices")(format!("vertex {number} of {count}")));
        }
        let part = self.part(&primitive.material());
        self.soup.has_uv &= uvs.is_some() || part > 0;

        let turn = Turn::of(matrix);
        let place = |i: usize| Vertex {
            position: turn.point(positions[i]),
            normal: normals.as_ref().and_then(|all| unit(turn.normal(all[i]))).unwrap_or([0.0, 0.0, 0.0]),
            tangent: tangents.as_ref().map_or([0.0; 4], |all| turn.tangent(all[i])),
            uv: uvs.as_ref().map_or([0.0; 2], |all| all[i]),
        };
        let vertices: Vec<Vertex> = (0..count).map(place).collect();
        if vertices.iter().flat_map(|v| v.position).any(|value| !value.is_finite()) {
            return Err(refused("positions")("a node moves them out of the range of numbers".to_owned()));
        }
        let has_tangents = tangents.is_some() && vertices.iter().all(|v| v.tangent[..3] != [0.0; 3]);
        let triangles = turn.wound(triangles(&numbers, primitive.mode()));
        self.add(&vertices, &triangles, part, has_tangents)
    }

    /// The numbers of an attribute that may be missing.
    fn optional<const N: usize>(
        &self,
        accessor: Option<gltf::Accessor<'_>>,
        fitting: &dyn Fn(usize) -> Result<(), String>,
    ) -> Result<Option<Vec<[f32; N]>>, String> {
        let Some(accessor) = accessor else { return Ok(None) };
        let values = floats(&accessor, self.buffers)?;
        fitting(values.len())?;
        Ok(Some(values))
    }

    fn part(&mut self, material: &gltf::Material<'_>) -> u32 {
        if material.name() != Some(PLAIN) {
            return 0;
        }
        let [r, g, b, _] = material.pbr_metallic_roughness().base_color_factor();
        let color = [r, g, b].map(|v| v.clamp(0.0, 1.0));
        let known = self.soup.plain.iter().position(|other| *other == color);
        let place = known.unwrap_or_else(|| {
            self.soup.plain.push(color);
            self.soup.plain.len() - 1
        });
        place as u32 + 1
    }

    fn add(
        &mut self,
        vertices: &[Vertex],
        triangles: &[[u32; 3]],
        part: u32,
        has_tangents: bool,
    ) -> Result<(), MeshError> {
        let all = &mut self.soup;
        let count = all.triangles.len() + triangles.len();
        if count > TRIANGLES_MAX || all.vertices.len() + vertices.len() > 3 * TRIANGLES_MAX {
            return Err(MeshError::TooLarge { count, limit: TRIANGLES_MAX });
        }
        let first = all.vertices.len() as u32;
        if vertices.iter().all(|vertex| vertex.normal != [0.0; 3]) {
            all.vertices.extend(vertices);
            all.triangles.extend(triangles.iter().map(|t| Triangle { corners: t.map(|i| first + i), part }));
        } else {
            // Without normals, every triangle has corners of its own and is flat.
            for corners in triangles.iter().map(|t| t.map(|i| vertices[i as usize])) {
                let [a, b, c] = corners.map(|vertex| vertex.position);
                let Some(normal) = unit(cross(sub(b, a), sub(c, a))) else { continue };
                let first = all.vertices.len() as u32;
                all.vertices.extend(corners.map(|vertex| Vertex { normal, ..vertex }));
                all.triangles.push(Triangle { corners: [first, first + 1, first + 2], part });
            }
        }
        all.has_tangents.resize(all.vertices.len(), has_tangents);
        Ok(())
    }
}

/// The triangles of a list, a strip or a fan.
fn triangles(numbers: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let wound = |(n, t): (usize, &[u32])| if n % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
            numbers.windows(3).enumerate().map(wound).collect()
        }
        Mode::TriangleFan => numbers.windows(2).skip(1).map(|t| [numbers[0], t[0], t[1]]).collect(),
        _ => numbers.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    }
}

/// The transformation of a node.
struct Turn {
    matrix: Matrix,
    /// Cofactors of the linear part: they turn normals.
    cofactors: [[f64; 3]; 3],
    mirrors: bool,
}

impl Turn {
    fn of(matrix: Matrix) -> Self {
        let c = |column: usize, row: usize| matrix[column % 3][row % 3];
        let cofactor = |i: usize, j: usize| c(i + 1, j + 1) * c(i + 2, j + 2) - c(i + 1, j + 2) * c(i + 2, j + 1);
        let cofactors: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| cofactor(i, j)));
        let determinant: f64 = (0..3).map(|j| c(0, j) * cofactors[0][j]).sum();
        Self { matrix, cofactors, mirrors: determinant < 0.0 }
    }

    fn point(&self, at: V) -> V {
        let at = at.map(f64::from);
        [0, 1, 2].map(|row| ((0..3).map(|k| self.matrix[k][row] * at[k]).sum::<f64>() + self.matrix[3][row]) as f32)
    }

    fn direction(&self, v: V) -> V {
        let v = v.map(f64::from);
        scaled([0, 1, 2].map(|row| (0..3).map(|k| self.matrix[k][row] * v[k]).sum()))
    }

    fn normal(&self, v: V) -> V {
        let v = v.map(f64::from);
        let sign = if self.mirrors { -1.0 } else { 1.0 };
        scaled([0, 1, 2].map(|row| (0..3).map(|k| sign * self.cofactors[k][row] * v[k]).sum()))
    }

    /// A tangent with its sign. None, which is 0, where it has no direction.
    fn tangent(&self, [x, y, z, w]: [f32; 4]) -> [f32; 4] {
        let [x, y, z] = unit(self.direction([x, y, z])).unwrap_or([0.0; 3]);
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        [x, y, z, if self.mirrors { -sign } else { sign }]
    }

    /// Triangles that are counterclockwise from outside after the turn.
    fn wound(&self, mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        if self.mirrors {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        triangles
    }
}

/// A direction of any length, within the range of single precision.
fn scaled(v: [f64; 3]) -> V {
    let largest = v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest > 0.0 && largest.is_finite() { v.map(|x| (x / largest) as f32) } else { [0.0; 3] }
}

//! glTF files: what of them is read, and what is refused.

use std::io;

use luthier_mesh::{File, Mesh, MeshError, soup};

fn no_files(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

/// Four corners of a square at z = 0, counterclockwise, and the numbers of two triangles.
fn square() -> Vec<u8> {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes));
    bytes
}

const TEXT: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0$node}],
"meshes":[{"name":"square","primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0$primitive}]}],
"materials":[{"name":"$material","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,1]}}],
"buffers":[{"byteLength":60,"uri":"square.bin"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]$more}"#;

fn text(parts: &[(&str, &str)]) -> String {
    let text = parts.iter().fold(TEXT.to_owned(), |text, (marker, part)| text.replace(marker, part));
    ["$node", "$primitive", "$more"]
        .iter()
        .fold(text, |text, marker| text.replace(marker, ""))
        .replace("$material", "any")
}

fn read(text: &str) -> Result<File, MeshError> {
    soup(text.as_bytes(), &|name| if name == "square.bin" { Ok(square()) } else { no_files(name) })
}

#[test]
fn a_square_has_two_triangles_and_flat_normals() {
    let file = read(&text(&[])).unwrap();
    assert!(file.left_out.is_empty() && !file.soup.has_uv && file.soup.plain.is_empty());
    // Without normals, triangles share no corner.
    assert_eq!((file.soup.vertices.len(), file.soup.triangles.len()), (6, 2));
    assert!(file.soup.vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
    // Ready, it is about the origin and in the unit sphere.
    let mesh = Mesh::new(file.soup).unwrap();
    let corner = mesh.vertices()[0].position;
    assert!(corner.iter().zip([-0.5f32.sqrt(), -0.5f32.sqrt(), 0.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{corner:?}");
}

/// A node turns, scales unevenly, mirrors and moves: positions by hand; the triangle stays counterclockwise from outside.
#[test]
fn nodes_move_what_they_hold() {
    let node = r#","children":[1],"translation":[0,0,5]},{"mesh":0,"scale":[-2,3,1],"translation":[1,0,0]"#;
    let file = read(&text(&[("$node", node)])).unwrap();
    assert_eq!(file.soup.triangles.len(), 4);
    let moved: Vec<_> = file.soup.vertices[6..9].iter().map(|vertex| vertex.position).collect();
    // Corners 0, 1, 2 at (1 - 2 x, 3 y, 5), in the other order.
    assert_eq!(moved, [[1.0, 0.0, 5.0], [-1.0, 3.0, 5.0], [-1.0, 0.0, 5.0]]);
    assert!(file.soup.vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
}

#[test]
fn plain_parts_keep_their_colour_and_are_not_enough() {
    let file = read(&text(&[("$material", "plain")])).unwrap();
    assert_eq!(file.soup.plain, [[0.5, 0.25, 0.125]]);
    assert!(file.soup.triangles.iter().all(|triangle| triangle.part == 1));
    assert!(matches!(Mesh::new(file.soup), Err(MeshError::Empty)));
}

#[test]
fn what_is_not_shown_is_said() {
    let file = read(&text(&[("$primitive", ",\"mode\":1")])).unwrap();
    assert_eq!(file.left_out, ["points and lines"]);
    let file = read(&text(&[("$primitive", ",\"targets\":[{\"POSITION\":0}]")])).unwrap();
    assert_eq!(file.left_out, ["morph targets"]);
    // 0 1 2, 2 1 0, 2 0 2 and 2 0 3: the third has no area.
    let strip = read(&text(&[("$primitive", ",\"mode\":5")])).unwrap();
    let sides: Vec<f32> = strip.soup.vertices.iter().step_by(3).map(|vertex| vertex.normal[2]).collect();
    assert_eq!(sides, [1.0, -1.0, -1.0]);
}

#[test]
fn what_cannot_be_read_is_refused_with_a_reason() {
    let message = |text: &str| read(text).unwrap_err().to_string();
    let refused = |from: &str, to: &str| message(&text(&[]).replace(from, to));
    assert!(refused("square.bin", "other.bin").contains("other.bin"));
    assert!(refused("square.bin", "../square.bin").contains("beside"));
    assert!(refused("\"byteLength\":60", "\"byteLength\":61").contains("60 bytes of 61"));
    assert!(refused("\"count\":4", "\"count\":5").contains("5 elements do not fit"));
    assert!(
        refused("\"byteOffset\":48", "\"byteOffset\":12").contains("vertex 16256 of 4"),
        "numbers that are half of 1.0"
    );
    assert!(refused("\"scenes\":[{\"nodes\":[0]}]", "\"scenes\":[{\"nodes\":[0]}],\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"extensionsUsed\":[\"KHR_draco_mesh_compression\"]").contains("KHR_draco_mesh_compression"));
    assert!(refused("\"mesh\":0", "\"mesh\":7").contains("no glTF"));
    assert!(
        refused("\"nodes\":[{", "\"nodes\":[{\"children\":[0],").contains("levels"),
        "a node that is its own child"
    );
    for bytes in [&b"glTF\x02\0\0\0\0\0\0\0"[..], b"glTF", b"", b"{}", b"solid cube"] {
        assert!(soup(bytes, &no_files).is_err(), "{bytes:?}");
    }
}

//! glTF files as other programs write them: what is read of them, what is passed over, and what is told.

use std::io;

use luthier_mesh::{File, Mesh, MeshError, soup};
use serde_json::{Value, json};

fn no_files(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

/// A tent of two triangles over the corners of a square, with buffers in the file.
struct Tent {
    json: Value,
    bytes: Vec<u8>,
}

/// Corners of the tent, whose ridge is from corner 1 to corner 3.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];

impl Tent {
    fn new() -> Self {
        let mut tent = Self {
            json: json!({
                "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"name": "tent", "primitives": [{"attributes": {}}]}], "buffers": [{}], "bufferViews": [], "accessors": [],
            }),
            bytes: Vec::new(),
        };
        let indices = tent.accessor(5123, "SCALAR", 6, &bytes(&[0u16, 1, 3, 1, 2, 3], u16::to_le_bytes));
        tent.json["meshes"][0]["primitives"][0]["indices"] = indices.into();
        tent
    }

    fn standing() -> Self {
        let mut tent = Self::new();
        tent.floats("POSITION", "VEC3", CORNERS.as_flattened());
        tent
    }

    /// Adds an accessor of so many elements, and says its number.
    fn accessor(&mut self, kind: u32, shape: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let all = self.json["accessors"].as_array_mut().unwrap();
        all.push(json!({"bufferView": view, "componentType": kind, "type": shape, "count": count}));
        all.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let all = self.json["bufferViews"].as_array_mut().unwrap();
        all.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        all.len() - 1
    }

    fn attribute(&mut self, name: &str, kind: u32, shape: &str, bytes: &[u8]) -> usize {
        let number = self.accessor(kind, shape, 4, bytes);
        self.primitive()["attributes"][name] = number.into();
        number
    }

    fn floats(&mut self, name: &str, shape: &str, values: &[f32]) -> usize {
        self.attribute(name, 5126, shape, &bytes(values, f32::to_le_bytes))
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    fn text(&self) -> String {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({"byteLength": self.bytes.len(), "uri": "tent.bin"});
        json.to_string()
    }

    fn read(&self) -> Result<File, MeshError> {
        soup(self.text().as_bytes(), &|name| if name == "tent.bin" { Ok(self.bytes.clone()) } else { no_files(name) })
    }

    /// A binary file with these chunks behind the text.
    fn glb(&self, chunks: &[(&[u8; 4], u32, &[u8])]) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({"byteLength": self.bytes.len()});
        let text = json.to_string().into_bytes();
        let mut file = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        let text = (b"JSON", text.len() as u32, &text[..]);
        for (kind, length, bytes) in [text].iter().chain(chunks) {
            file.extend(length.to_le_bytes());
            file.extend(*kind);
            file.extend(*bytes);
        }
        file
    }
}

fn bytes<T: Copy, const N: usize>(values: &[T], of: fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|&value| of(value)).collect()
}

fn positions(file: &File) -> Vec<[f32; 3]> {
    file.soup.triangles.iter().flat_map(|t| t.corners).map(|i| file.soup.vertices[i as usize].position).collect()
}

fn expected_positions() -> Vec<[f32; 3]> {
    [0, 1, 3, 1, 2, 3].map(|i| CORNERS[i]).to_vec()
}

/// `KHR_mesh_quantization`: whole numbers as they are, with a node that scales them, and such over their largest value.
#[test]
fn whole_numbers_are_positions() {
    let quantized = |kind, normalized: bool, scale: f64, bytes: &[u8]| {
        let mut tent = Tent::new();
        let number = tent.attribute("POSITION", kind, "VEC3", bytes);
        tent.json["accessors"][number]["normalized"] = normalized.into();
        tent.json["nodes"][0]["scale"] = json!([scale, scale, scale]);
        for list in ["extensionsUsed", "extensionsRequired"] {
            tent.json[list] = json!(["KHR_mesh_quantization"]);
        }
        tent.read().unwrap()
    };
    let of = |one: i32| CORNERS.as_flattened().iter().map(|v| *v as i32 * one).collect::<Vec<_>>();
    let small = |one| of(one).iter().map(|v| *v as u8).collect::<Vec<_>>();
    let large = |one| of(one).iter().flat_map(|v| (*v as u16).to_le_bytes()).collect::<Vec<_>>();
    for (file, size) in [
        (quantized(5120, false, 0.25, &small(4)), 1.0),
        (quantized(5120, true, 1.0, &small(127)), 1.0),
        (quantized(5121, false, 0.125, &small(8)), 1.0),
        (quantized(5121, true, 1.0, &small(255)), 1.0),
        (quantized(5122, false, 1.0 / 4096.0, &large(4096)), 1.0),
        (quantized(5122, true, 1.0, &large(32767)), 1.0),
        (quantized(5123, true, 2.0, &large(65535)), 2.0),
        // Both smallest numbers are -1.
        (quantized(5122, true, 1.0, &large(-32768)), -1.0),
        (quantized(5122, true, 1.0, &large(-32767)), -1.0),
    ] {
        let expected: Vec<_> = expected_positions().iter().map(|p| p.map(|v| v * size)).collect();
        assert!(file.left_out.is_empty() && positions(&file) == expected, "{:?}", positions(&file));
    }
}

/// Oracle: the extension's specification. Scale, then a quarter turn, then the offset: (u, v) becomes (2 v' + .25, -.5 u').
#[test]
fn whole_texture_coordinates_have_their_scale_in_the_placement() {
    let mut tent = Tent::standing();
    let number = tent.attribute("TEXCOORD_0", 5121, "VEC2", &[0, 0, 255, 0, 255, 255, 0, 255]);
    tent.json["accessors"][number]["normalized"] = true.into();
    tent.primitive()["material"] = 0.into();
    let placement = json!({"scale": [0.5, 2], "rotation": std::f64::consts::FRAC_PI_2, "offset": [0.25, 0]});
    tent.json["materials"] =
        json!([{"normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": placement}}}]);
    let file = tent.read().unwrap();
    // The corners 0, 1 and 3 are those of the first triangle, and 1, 2 and 3 of the second.
    for (vertex, expected) in
        file.soup.vertices.iter().zip([[0.25, 0.0], [0.25, -0.5], [2.25, 0.0], [0.25, -0.5], [2.25, -0.5], [2.25, 0.0]])
    {
        assert!(vertex.uv.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{:?} {expected:?}", vertex.uv);
    }
    tent.floats("TEXCOORD_0", "VEC2", &[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
    let file = tent.read().unwrap();
    assert!(file.soup.vertices[4].uv == [1.0, 1.0] && file.left_out[0].contains("KHR_texture_transform"));
}

/// Nothing that triangles do without hinders them, whatever it is.
#[test]
fn what_is_not_read_may_be_anything() {
    let mut tent = Tent::standing();
    tent.primitive()["attributes"]["_CUSTOM"] = 77.into();
    tent.primitive()["attributes"]["COLOR_0"] = 78.into();
    for (name, odd) in [
        ("animations", json!([{"channels": [{"sampler": 0, "target": {"path": "translation"}}], "samplers": []}])),
        ("cameras", json!([{"type": "fish-eye"}])),
        ("skins", json!([{"joints": [99]}])),
        ("images", json!([{"mimeType": "image/any"}])),
        ("textures", json!(5)),
        ("samplers", json!([{"wrapS": -1}])),
        ("materials", json!([{"alphaMode": "ODD", "pbrMetallicRoughness": {"baseColorFactor": [1]}}])),
        ("extensions", json!({"VENDOR_any": [[1]]})),
    ] {
        tent.json[name] = odd;
    }
    tent.json["accessors"].as_array_mut().unwrap().push(json!({"componentType": 1, "type": "ODD"}));
    // A buffer of pictures alone is not looked for.
    tent.json["buffers"].as_array_mut().unwrap().push(json!({"uri": "pictures.bin", "byteLength": 9}));
    let file = tent.read().unwrap();
    assert_eq!((positions(&file), file.left_out), (expected_positions(), vec!["animations".to_owned()]));
}

/// Three vertices keep the normals of the file; that of the fourth, in one triangle, is this triangle's.
#[test]
fn one_normal_without_direction_flattens_nothing() {
    for bad in [[0.0f32; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
        let mut tent = Tent::standing();
        tent.floats("NORMAL", "VEC3", [bad, [0.0, 0.0, 2.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].as_flattened());
        let file = tent.read().unwrap();
        assert_eq!(file.soup.vertices.len(), 4);
        let normal = |i: usize| file.soup.vertices[i].normal;
        assert_eq!([1, 2, 3].map(normal), [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        // (1, 0, 1) x (0, 1, 1).
        let expected = [-1.0f32, -1.0, 1.0].map(|v| v / 3f32.sqrt());
        assert!(normal(0).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{:?}", normal(0));
        assert!(file.left_out[0].starts_with("1 normals have no direction"), "{:?}", file.left_out);
    }
    // Where none has a direction, triangles are flat, as they are without normals.
    let mut tent = Tent::standing();
    let without = tent.read().unwrap();
    tent.floats("NORMAL", "VEC3", &[0.0; 12]);
    let file = tent.read().unwrap();
    assert_eq!(file.soup, without.soup);
    assert!(file.left_out[0].starts_with("4 normals"));
}

#[test]
fn tangents_and_texture_coordinates_that_are_no_numbers() {
    let mut tent = Tent::standing();
    tent.floats("NORMAL", "VEC3", [[0.0f32, 0.0, 1.0]; 4].as_flattened());
    let uvs = [[0.0f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    tent.floats("TEXCOORD_0", "VEC2", uvs.as_flattened());
    let mut tangents = [[0.0f32, 1.0, 0.0, -1.0]; 4];
    tangents[2] = [f32::NAN; 4];
    tangents[3] = [0.0; 4];
    tent.floats("TANGENT", "VEC4", tangents.as_flattened());
    let file = tent.read().unwrap();
    assert_eq!(file.soup.has_tangents, [true, true, false, false]);
    assert!(file.left_out[0].starts_with("2 tangents"));
    // u grows along x, and falls with no other: by hand.
    let mesh = Mesh::new(file.soup).unwrap();
    assert_eq!(mesh.vertices()[0].tangent, [0.0, 1.0, 0.0, -1.0]);
    let recomputed = mesh.vertices()[2].tangent;
    assert!((recomputed[0] - 1.0).abs() < 1e-6 && recomputed[3] == 1.0, "{recomputed:?}");

    tent.floats("TEXCOORD_0", "VEC2", &[0.0, 1.0, f32::INFINITY, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let file = tent.read().unwrap();
    assert!(
        file.soup.vertices[1].uv == [0.0; 2]
            && file.left_out.iter().any(|what| what.starts_with("1 texture coordinates"))
    );
}

#[test]
fn positions_that_are_no_numbers_are_refused_where_they_are_used() {
    let mut corners = CORNERS;
    corners[2][1] = f32::NAN;
    let mut tent = Tent::new();
    tent.floats("POSITION", "VEC3", corners.as_flattened());
    let message = tent.read().unwrap_err().to_string();
    assert!(message.contains("`tent`") && message.contains("vertex 2 ") && message.contains("NaN"), "{message}");
    let first = tent.accessor(5121, "SCALAR", 3, &[0, 1, 3]);
    tent.primitive()["indices"] = first.into();
    assert_eq!(positions(&tent.read().unwrap()), [CORNERS[0], CORNERS[1], CORNERS[3]]);
}

#[test]
fn encodings_and_versions() {
    let tent = Tent::standing();
    let read = |bytes: &[u8]| soup(bytes, &|_| Ok(tent.bytes.clone()));
    let marked = [b"\xef\xbb\xbf", tent.text().as_bytes()].concat();
    assert_eq!(read(&marked).unwrap(), tent.read().unwrap());
    let wide: Vec<u8> = "\u{feff}{}".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(read(&wide).unwrap_err().to_string().contains("UTF-8"));
    let old = json!({"asset": {"version": "1.0"}, "scenes": {"first": {"nodes": ["root"]}}, "nodes": {}}).to_string();
    assert!(read(old.as_bytes()).unwrap_err().to_string().contains("glTF 1.0"));
    assert!(matches!(read(b"glTF\x01\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0"), Err(MeshError::Version(_))));
    let newer = tent.text().replace("\"version\":\"2.0\"", "\"version\":\"2.0\",\"minVersion\":\"2.1\"");
    assert!(matches!(read(newer.as_bytes()), Err(MeshError::Version(version)) if version == "2.1"));
    assert!(read(tent.text().replace("\"2.0\"", "\"2.1\"").as_bytes()).is_ok());
    assert!(read(b"{\"asset\":{}}").unwrap_err().to_string().contains("asset.version"));
}

/// Zeros of the specification where there is no buffer view, and elements that are given one by one.
#[test]
fn sparse_numbers() {
    let mut tent = Tent::new();
    let places = tent.view(&[1, 2, 3]);
    let values = tent.view(&bytes(CORNERS[1..].as_flattened(), f32::to_le_bytes));
    let sparse =
        json!({"count": 3, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": values}});
    tent.json["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "type": "VEC3", "count": 4, "sparse": sparse}));
    tent.primitive()["attributes"]["POSITION"] = 1.into();
    assert_eq!(positions(&tent.read().unwrap()), expected_positions());
    // Over a buffer view, others stay.
    let moved: Vec<f32> = CORNERS.as_flattened().iter().map(|v| v + 7.0).collect();
    let all = tent.view(&bytes(&moved, f32::to_le_bytes));
    tent.json["accessors"][1]["bufferView"] = all.into();
    assert_eq!(positions(&tent.read().unwrap())[..2], [[7.0; 3], CORNERS[1]]);
    tent.json["accessors"][1]["count"] = 3.into();
    assert!(tent.read().unwrap_err().to_string().contains("sparse element 3 of 3"));
    tent.json["accessors"][1]["count"] = (1u64 << 40).into();
    assert!(tent.read().unwrap_err().to_string().contains("coarser"));
}

#[test]
fn files_without_a_scene() {
    let mut tent = Tent::standing();
    for name in ["scene", "scenes"] {
        tent.json.as_object_mut().unwrap().remove(name);
    }
    tent.json["nodes"] = json!([{"mesh": 0}, {"children": [0], "translation": [0, 0, 3]}]);
    let file = tent.read().unwrap();
    assert!(positions(&file)[0] == [0.0, 0.0, 3.0] && file.soup.triangles.len() == 2);
    assert!(file.left_out[0].contains("no scene"));
    tent.json.as_object_mut().unwrap().remove("nodes");
    let file = tent.read().unwrap();
    assert!(positions(&file) == expected_positions() && file.left_out[0].contains("no nodes"));
    tent.json["scene"] = 3.into();
    assert!(tent.read().unwrap_err().to_string().contains("scene 3"));
    // Nothing to show is no fault of the format.
    let empty = soup(br#"{"asset":{"version":"2.0"}}"#, &no_files).unwrap();
    assert!(matches!(Mesh::new(empty.soup), Err(MeshError::Empty)));
}

#[test]
fn chunks_of_binary_files() {
    let tent = Tent::standing();
    let whole = tent.read().unwrap();
    let binary = (b"BIN\0", tent.bytes.len() as u32, &tent.bytes[..]);
    let read = |file: &[u8]| soup(file, &no_files);
    assert_eq!(read(&tent.glb(&[binary])).unwrap(), whole);
    assert_eq!(read(&tent.glb(&[(b"XYZ\0", 5, b"hello"), binary, (b"END\0", 900, b"")])).unwrap(), whole);
    // Padding that the length of a chunk leaves out.
    assert_eq!(read(&tent.glb(&[(b"XYZ\0", 5, b"hello\0\0\0"), binary])).unwrap(), whole);
    let mut longer = tent.bytes.clone();
    longer.extend([0; 3]);
    assert_eq!(read(&tent.glb(&[(b"BIN\0", longer.len() as u32, &longer)])).unwrap(), whole);
    let cut = tent.glb(&[binary]);
    assert!(read(&cut[..cut.len() - 1]).unwrap_err().to_string().contains("cut off"));
    assert!(read(&tent.glb(&[])).unwrap_err().to_string().contains("buffer `number 0`"));
}

#[test]
fn extensions_that_files_cannot_do_without() {
    let required = |name: &str| {
        let mut tent = Tent::standing();
        tent.json["extensionsRequired"] = json!([name]);
        tent.read()
    };
    for name in ["KHR_materials_unlit", "KHR_texture_basisu", "EXT_texture_webp", "KHR_lights_punctual"] {
        let file = required(name).unwrap();
        assert!(positions(&file) == expected_positions() && file.left_out == [format!("the extension {name}")]);
    }
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
        let message = required(name).unwrap_err().to_string();
        assert!(message.contains(name) && message.contains("without compression"), "{message}");
    }
    assert!(matches!(required("EXT_mesh_gpu_instancing"), Err(MeshError::Extension(_))));
    // A compression beside the plain numbers, and one in their place.
    let mut tent = Tent::standing();
    tent.primitive()["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    assert_eq!(positions(&tent.read().unwrap()), expected_positions());
    tent.json["accessors"][1].as_object_mut().unwrap().remove("bufferView");
    assert!(matches!(tent.read(), Err(MeshError::Compressed(_))));
}

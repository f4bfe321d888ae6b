//! Binary glTF.

use super::lathe::Part;

/// The file: one node, a shown part with all attributes, and a plain part with positions and normals.
pub(super) fn glb(shown: &Part, floor: &Part, albedo: f64) -> Vec<u8> {
    let mut bin = Vec::new();
    let mut views = Vec::new();
    let mut accessors = Vec::new();
    let mut add = |bytes: &[u8], target: u32, what: String| {
        views.push(format!(
            r#"{{"buffer":0,"byteOffset":{},"byteLength":{},"target":{target}}}"#,
            bin.len(),
            bytes.len()
        ));
        accessors.push(format!(r#"{{"bufferView":{},{what}}}"#, views.len() - 1));
        bin.extend_from_slice(bytes);
        bin.resize(bin.len().next_multiple_of(4), 0);
    };
    for (part, is_shown) in [(shown, true), (floor, false)] {
        let count = part.positions.len();
        let (low, high) = bounds(&part.positions);
        let limits = format!(r#""componentType":5126,"count":{count},"type":"VEC3","min":{low:?},"max":{high:?}"#);
        add(&bytes(&part.positions), ARRAY, limits);
        let vectors = |kind: &str| format!(r#""componentType":5126,"count":{count},"type":"{kind}""#);
        add(&bytes(&part.normals), ARRAY, vectors("VEC3"));
        if is_shown {
            add(&bytes(&part.tangents), ARRAY, vectors("VEC4"));
            add(&bytes(&part.uvs), ARRAY, vectors("VEC2"));
        }
        let indices: Vec<u8> = part.triangles.iter().flatten().flat_map(|&i| (i as u16).to_le_bytes()).collect();
        let about = format!(r#""componentType":5123,"count":{},"type":"SCALAR""#, 3 * part.triangles.len());
        add(&indices, ELEMENTS, about);
    }
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"luthier"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"name":"model","mesh":0}}],
"meshes":[{{"name":"model","primitives":[
{{"attributes":{{"POSITION":0,"NORMAL":1,"TANGENT":2,"TEXCOORD_0":3}},"indices":4,"material":0}},
{{"attributes":{{"POSITION":5,"NORMAL":6}},"indices":7,"material":1}}]}}],
"materials":[{{"name":"shown"}},{{"name":"plain","pbrMetallicRoughness":{{"baseColorFactor":[{albedo},{albedo},{albedo},1],"metallicFactor":0}}}}],
"buffers":[{{"byteLength":{}}}],"bufferViews":[{}],"accessors":[{}]}}"#,
        bin.len(),
        views.join(","),
        accessors.join(",")
    );
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let word = |n: usize| (n as u32).to_le_bytes();
    let chunks: [&[u8]; 9] = [
        b"glTF",
        &word(2),
        &word(28 + json.len() + bin.len()),
        &word(json.len()),
        b"JSON",
        &json,
        &word(bin.len()),
        b"BIN\0",
        &bin,
    ];
    chunks.concat()
}

/// Targets of buffer views: attributes of vertices, and indices.
const ARRAY: u32 = 34962;
const ELEMENTS: u32 = 34963;

fn bytes<const N: usize>(values: &[[f32; N]]) -> Vec<u8> {
    values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect()
}

fn bounds(positions: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    positions.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), at| {
        ([0, 1, 2].map(|c| low[c].min(at[c])), [0, 1, 2].map(|c| high[c].max(at[c])))
    })
}

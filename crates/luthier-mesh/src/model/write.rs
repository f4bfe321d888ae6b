//! Binary glTF.

use super::lathe::Part;

/// The file: one node, a shown part with all attributes, and a plain part with positions and normals.
pub(super) fn glb(shown: &Part, floor: &Part, albedo: f64) -> Vec<u8> {
    let mut parts = Vec::new();
    for (part, is_shown) in [(shown, true), (floor, false)] {
        let count = part.positions.len();
        let (low, high) = bounds(&part.positions);
        let limits = format!(r#""componentType":5126,"count":{count},"type":"VEC3","min":{low:?},"max":{high:?}"#);
        parts.push((bytes(&part.positions), ARRAY, limits));
        parts.push((bytes(&part.normals), ARRAY, vectors("VEC3", count)));
        if is_shown {
            parts.push((bytes(&part.tangents), ARRAY, vectors("VEC4", count)));
            parts.push((bytes(&part.uvs), ARRAY, vectors("VEC2", count)));
        }
        let indices: Vec<u8> = part.triangles.iter().flatten().flat_map(|&i| (i as u16).to_le_bytes()).collect();
        let about = format!(r#""componentType":5123,"count":{},"type":"SCALAR""#, 3 * part.triangles.len());
        parts.push((indices, ELEMENTS, about));
    }
    let (mut bin, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
    for (number, (bytes, target, about)) in parts.into_iter().enumerate() {
        let (offset, length) = (bin.len(), bytes.len());
        views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length},"target":{target}}}"#));
        accessors.push(format!(r#"{{"bufferView":{number},{about}}}"#));
        bin.extend_from_slice(&bytes);
        bin.resize(bin.len().next_multiple_of(4), 0);
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
    let [version, length, json_length, bin_length] =
        [2, 28 + json.len() + bin.len(), json.len(), bin.len()].map(|n| (n as u32).to_le_bytes());
    let chunks: [&[u8]; 9] = [b"glTF", &version, &length, &json_length, b"JSON", &json, &bin_length, b"BIN\0", &bin];
    chunks.concat()
}

fn vectors(kind: &str, count: usize) -> String {
    format!(r#""componentType":5126,"count":{count},"type":"{kind}""#)
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

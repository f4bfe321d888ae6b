//! `report` of a glTF file.

use serde_json::{Value, json};

use crate::workshop::Workshop;

/// A square of texture coordinates from 0 to 1 with some of three materials: a mirror of a given description, lacquer, and one whose picture is missing. The
/// texels of texture 0 are black and white.
pub(crate) fn scene(mirror: &Value, shown: &[u32]) -> String {
    let corners: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = corners.concat().iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend(corners.iter().flat_map(|[x, y, _]| [*x, *y]).flat_map(f32::to_le_bytes));
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()));
    let picture = luthier_texture::png::encode_rgb(2, 1, &[0, 0, 0, 255, 255, 255]).unwrap();
    let uri = |kind: &str, bytes: &[u8]| format!("data:{kind};base64,{}", base64(bytes));
    let view = |offset: usize, length: usize| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let primitive =
        |material: u32| json!({ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": material });
    let text = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "uri": uri("application/octet-stream", &bytes), "byteLength": bytes.len() }],
        "bufferViews": [view(0, 48), view(48, 32), view(80, 12)],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "images": [{ "uri": uri("image/png", &picture) }, { "uri": "missing.png" }],
        "textures": [{ "source": 0 }, { "source": 1 }],
        "materials": [
            { "name": "Mirror", "pbrMetallicRoughness": mirror },
            {
                "name": "Lacquer",
                "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0, 1, 1], "metallicFactor": 0, "roughnessFactor": 1 },
                "extensions": {
                    "KHR_materials_clearcoat": { "clearcoatFactor": 1 },
                    "KHR_materials_specular": { "specularFactor": 0 },
                    "KHR_materials_sheen": {},
                },
            },
            { "pbrMetallicRoughness": { "baseColorTexture": { "index": 1 }, "roughnessFactor": 0 } },
        ],
        "meshes": [{ "primitives": shown.iter().map(|material| primitive(*material)).collect::<Vec<_>>() }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "scene": 0,
    });
    text.to_string()
}

fn base64(bytes: &[u8]) -> String {
    let letters: Vec<char> = ('A'..='Z').chain('a'..='z').chain('0'..='9').chain(['+', '/']).collect();
    let chunk = |three: &[u8]| -> String {
        let word = three.iter().fold(0_u32, |word, byte| word << 8 | u32::from(*byte)) << (8 * (3 - three.len()));
        let of = |i: usize| letters[(word >> (18 - 6 * i)) as usize & 63];
        (0..4).map(|i| if i <= three.len() { of(i) } else { '=' }).collect()
    };
    bytes.chunks(3).map(chunk).collect()
}

fn mirror() -> Value {
    json!({ "baseColorTexture": { "index": 0 }, "roughnessFactor": 0 })
}

fn albedo(material: &Value, angle: usize, way: &str) -> [f64; 3] {
    let found = &material["albedos"][angle][way];
    [0, 1, 2].map(|c: usize| found[c].as_f64().unwrap_or_else(|| panic!("{material}")))
}

/// Oracles by hand. A mirror of black and white squares reflects half along the normal, by all three ways, and by Schlick's form f + (1 - f)(1 - cos)^5 elsewhere.
/// Below a smooth coat glTF's formula has the coat's Schlick and the rest of the colour, whose interface reflects nothing; the layers mean the same colour.
#[test]
fn formulas_simulation_and_models_are_compared() {
    let workshop = Workshop::with(&[("scene.gltf", &scene(&mirror(), &[0, 1]))]);
    let report = workshop.run(&["report", "scene.gltf", "--reference=4096", "--json"]).exits(0).json();
    assert_eq!((report["scene"].as_str(), report["paths"].as_u64()), (Some("scene.gltf"), Some(4096)));
    let [mirror, lacquer, white] = report["materials"].as_array().unwrap().as_slice() else { panic!("{report}") };
    assert_eq!((mirror["name"].as_str(), mirror["places"].as_u64()), (Some("mirror"), Some(16)));
    let grazing = |deg: f64| libm::pow(1.0 - libm::cos(deg.to_radians()), 5.0);
    for (angle, deg) in [0.0, 30.0, 60.0, 75.0, 85.0].into_iter().enumerate() {
        assert_eq!(mirror["albedos"][angle]["theta_deg"], deg);
        let half = albedo(mirror, angle, "gltf")[0];
        let mean = (half - grazing(deg)) / (1.0 - grazing(deg));
        assert!((mean - 0.5).abs() < 0.06, "{deg}: {mean}");
        let share = 0.04 + 0.96 * grazing(deg);
        let found = albedo(lacquer, angle, "gltf");
        for (found, color) in found.iter().zip([0.5, 0.0, 1.0]) {
            assert!((found - (share + (1.0 - share) * color)).abs() < 3e-3, "{deg}: {found} {color}");
        }
    }
    for way in ["simulated", "model"] {
        let (of_mirror, of_lacquer) = (albedo(mirror, 0, way)[0], albedo(lacquer, 0, way));
        assert!((of_mirror - albedo(mirror, 0, "gltf")[0]).abs() < 0.01, "{way}: {of_mirror}");
        assert!((of_lacquer[0] - 0.52).abs() < 0.03 && of_lacquer[1] < 0.1, "{way}: {of_lacquer:?}");
        assert!((albedo(white, 0, way)[0] - 1.0).abs() < 0.01);
    }
    assert_eq!(lacquer["places"], 1);
    assert_eq!(lacquer["formula_leaves_out"], json!(["KHR_materials_sheen"]));
    let largest = &mirror["largest"]["gltf"][0];
    assert!(largest["difference"].as_f64().is_some_and(|most| most.abs() < 0.05), "{largest}");
    // A picture that is missing is white in both.
    assert!(white["formula_leaves_out"][0].as_str().unwrap().starts_with("baseColorTexture: "), "{white}");
    assert_eq!(white["dropped"], json!(["baseColorTexture"]));
    assert!(albedo(white, 0, "gltf")[0] > 0.99);

    let said = workshop.run(&["report", "scene.gltf", "--reference=256"]).exits(0).stdout;
    for part in [
        "3 materials",
        "\nmirror, 16 places\n",
        "glTF's formula less simulated",
        "not in the layers: KHR_materials_sheen",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert!(!workshop.path("out").exists());
}

#[test]
fn broken_scenes_are_refused() {
    let nothing = "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{}]}";
    let wrong = scene(&json!({ "roughnessFactor": "rough" }), &[0]);
    let workshop = Workshop::with(&[
        ("no.glb", "schema = 1\n"),
        ("nothing.gltf", nothing),
        ("wrong.gltf", &wrong),
        ("m.gltf", &scene(&mirror(), &[0, 1])),
    ]);
    workshop.run(&["report", "no.glb"]).fails(1, &["no.glb", "no glTF"]);
    workshop.run(&["report", "nothing.gltf"]).fails(1, &["nothing.gltf", "no materials"]);
    workshop.run(&["report", "wrong.gltf"]).fails(1, &["wrong.gltf", "`Mirror`", "rough"]);
    workshop.run(&["report", "missing.glb", "--json"]).told_error(3, "files");
    workshop.run(&["report", "m.gltf", "--out", "out"]).fails(2, &["--out"]);
    workshop.run(&["report", "m.gltf", "--max-error", "1"]).fails(2, &["--max-error"]);
    workshop.run(&["report", "m.toml"]).fails(1, &["m.toml", ".glb"]);
    // Materials do without a mesh that cannot be read.
    let compressed =
        scene(&mirror(), &[0]).replacen('{', "{\"extensionsRequired\": [\"KHR_draco_mesh_compression\"],", 1);
    workshop.write("packed.gltf", compressed);
    workshop.run(&["report", "packed.gltf", "--reference=64"]).exits(0).says(&["packed.gltf", "places are all over"]);
}

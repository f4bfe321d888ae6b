//! Materials of glTF 2.0: every property, the round numbers of the formats, and broken files.

use std::io::{self, ErrorKind};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use luthier_import::{Fate, Import, ImportError, Imported, gltf, gltf_points};
use luthier_material::{Material, parse};
use serde_json::{Value, json};

/// Two texels, as a data URI.
pub(crate) fn picture(texels: [[u8; 3]; 2]) -> Value {
    let bytes = luthier_texture::png::encode_rgb(2, 1, &texels.concat()).unwrap();
    json!({ "name": "texels", "uri": format!("data:image/png;base64,{}", STANDARD.encode(bytes)) })
}

fn none(_: &str) -> io::Result<Vec<u8>> {
    Err(ErrorKind::NotFound.into())
}

/// The import of one material, whose texture 0 has these texels.
fn import(texels: [[u8; 3]; 2], material: Value) -> Import {
    let text = json!({
        "asset": { "version": "2.0" },
        "images": [picture(texels)],
        "textures": [{ "source": 0 }],
        "materials": [material],
    });
    gltf("test.gltf", text.to_string().as_bytes(), &none).unwrap()
}

const GREY: [[u8; 3]; 2] = [[128; 3]; 2];

/// The one material of an import, read back.
fn read(import: &Import) -> (&Imported, Material) {
    let [imported] = import.materials.as_slice() else { panic!("{import:?}") };
    let parsed = parse("x.toml", &imported.text, &|_| Err(ErrorKind::NotFound.into()));
    let parsed = parsed.unwrap_or_else(|errors| panic!("{errors:?}\n{}", imported.text));
    (imported, parsed.material)
}

fn fate(imported: &Imported, property: &str) -> Vec<Fate> {
    imported.lines.iter().filter(|line| line.property == property).map(|line| line.fate).collect()
}

/// Values of a computed picture, from 0 to 1.
fn values(import: &Import, path: &str) -> Vec<[f64; 3]> {
    let bytes = import.pictures.get(path).unwrap_or_else(|| panic!("no {path} in {:?}", import.pictures.keys()));
    let picture = luthier_texture::picture::decode(bytes).unwrap().picture;
    let [width, height] = picture.size();
    let texel = |x, y| picture.texel(x, y).map(f64::from);
    (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| texel(x, y))
        .map(|[r, g, b, _]| [r, g, b])
        .collect()
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-4, "{found} {expected}");
}

/// The defaults of the specification: white metal of the roughness 1.
#[test]
fn an_empty_material_is_white_metal() {
    let found = import(GREY, json!({}));
    let (imported, material) = read(&found);
    assert_eq!((imported.name.as_str(), imported.source_name.as_str()), ("material-0", ""));
    let [metal] = material.stack.layers.as_slice() else { panic!("{:?}", material.stack) };
    assert_eq!([metal.surface.alpha_x, metal.surface.alpha_y], [1.0; 2]);
    assert!(imported.text.contains("base_color = 1.0\nmetallic = 1.0\n"), "{}", imported.text);
    assert!(found.pictures.is_empty());
}

/// Roughness .4: alpha is .16; strength .5 of glTF gives .37 and .16 (`KHR_materials_anisotropy`).
#[test]
fn anisotropy_has_the_round_numbers_of_the_format() {
    let material = json!({
        "pbrMetallicRoughness": { "roughnessFactor": 0.4 },
        "extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyRotation": 0.5 } },
    });
    let found = import(GREY, material);
    let (_, material) = read(&found);
    let surface = material.stack.layers[0].surface;
    close(surface.alpha_x, 0.37);
    close(surface.alpha_y, 0.16);
    close(surface.rotation, 0.5);
}

/// Directions of 0 and 45 degrees from the tangent are texels of 0 and 90; strengths are those of B.
#[test]
fn textures_of_anisotropy_become_slopes_and_doubled_angles() {
    // (1, 0) with all of the strength, and (1, 1) over its length with none.
    let texels = [[255, 128, 255], [218, 218, 0]];
    let material = json!({
        "pbrMetallicRoughness": { "roughnessFactor": 0.4 },
        "extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyTexture": { "index": 0 } } },
    });
    let found = import(texels, material);
    let (imported, material) = read(&found);
    close(material.stack.layers[0].surface.alpha_x, 0.37);
    let [first, second] = values(&found, "maps/texels-alpha-x.png")[..] else { panic!() };
    close(first[0], 1.0);
    close(second[0], 0.16 / 0.37);
    let [first, second] = values(&found, "maps/texels-tangent.png")[..] else { panic!() };
    // 128 of 255 is .004 from the middle.
    assert!((first[0] - 1.0).abs() < 1e-3 && (first[1] - 0.5).abs() < 5e-3, "{first:?}");
    assert!((second[0] - 0.5).abs() < 1e-3 && (second[1] - 1.0).abs() < 1e-3, "{second:?}");
    assert_eq!(fate(imported, "anisotropyTexture (direction)"), [Fate::ClosedForm]);
}

/// Without a coat the roughness of a texture is luthier's own; below one it is a picture of slope parameters, whose texels are squares.
#[test]
fn roughness_below_a_coat_is_squared() {
    let texels = [[0, 51, 0], [0, 204, 255]];
    let metallic = json!({ "roughnessFactor": 0.5, "metallicRoughnessTexture": { "index": 0 } });
    let bare = import(texels, json!({ "pbrMetallicRoughness": metallic }));
    let text = &read(&bare).0.text;
    assert!(text.contains("roughness = 0.5\n") && text.contains("channel = \"g\""), "{text}");
    assert!(text.contains("metallic = { image = \"maps/texels.png\", channel = \"b\" }"), "{text}");
    let coat = json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1 } });
    let coated = import(texels, json!({ "pbrMetallicRoughness": metallic, "extensions": coat }));
    let (imported, material) = read(&coated);
    // The largest roughness is .5 times .8.
    close(material.stack.layers[1].surface.alpha_x, 0.16);
    close(material.stack.layers[0].surface.alpha_x, 0.01);
    let found: Vec<f64> = values(&coated, "maps/texels-alpha.png").iter().map(|texel| texel[0]).collect();
    close(found[0], 0.0625);
    close(found[1], 1.0);
    assert_eq!(fate(imported, "metallicRoughnessTexture (roughness)"), [Fate::ClosedForm]);
}

/// A coat of 1.5 that leaves its base as bright as its colour; weight and normals from textures.
#[test]
fn a_coat_is_a_layer() {
    let texture = json!({ "index": 0, "extensions": { "KHR_texture_transform": {
        "offset": [0.25, 0.5], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2, 3] } } });
    let material = json!({
        "name": "Ümlaut / Lack",
        "pbrMetallicRoughness": { "baseColorFactor": [0.4, 0.25, 0.12, 0.5], "metallicFactor": 0 },
        "normalTexture": { "index": 0, "scale": 0.5 },
        "alphaMode": "BLEND",
        "extensions": { "KHR_materials_clearcoat": {
            "clearcoatFactor": 0.75, "clearcoatTexture": texture, "clearcoatNormalTexture": { "index": 0 } } },
    });
    let found = import([[128, 128, 255]; 2], material);
    let (imported, material) = read(&found);
    assert_eq!(imported.name, "mlaut-lack");
    assert!(imported.text.contains("weight = 0.75\ndarkening = false"), "{}", imported.text);
    // glTF turns from v to u, luthier from u to v.
    let placed = "transform = { offset = [0.25, 0.5], rotation_deg = -90.0, scale = [2.0, 3.0] }";
    assert!(imported.text.contains(placed), "{}", imported.text);
    assert!(imported.text.contains("bumps = { image = \"maps/texels.png\" }"), "{}", imported.text);
    assert!(imported.text.contains("bumps = { image = \"maps/texels.png\", scale = 0.5 }"), "{}", imported.text);
    assert_eq!(material.stack.layers.len(), 3);
    assert_eq!(fate(imported, "alphaMode, baseColorFactor.a"), [Fate::Host]);
    // Both normals alike turn the whole surface.
    let alike = json!({
        "normalTexture": { "index": 0 },
        "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatNormalTexture": { "index": 0 } } },
    });
    let text = import([[128, 128, 255]; 2], alike).materials[0].text.clone();
    assert!(text.contains("normal = {") && !text.contains("bumps"), "{text}");
}

/// F0 of indices, specular weights and colours, and its textures.
#[test]
fn reflectances_follow_index_and_specular() {
    let of = |extensions: Value| {
        let found = import(
            [[255, 0, 128], [128; 3]],
            json!({ "pbrMetallicRoughness": { "metallicFactor": 0 }, "extensions": extensions }),
        );
        read(&found).0.text.clone()
    };
    assert!(of(json!({ "KHR_materials_ior": { "ior": 2.0 } })).contains("\nf0 = 0.111111\n"));
    let tinted = of(json!({ "KHR_materials_ior": { "ior": 2.0 }, "KHR_materials_specular": {
        "specularFactor": 0.5, "specularColorFactor": [1, 2, 20] } }));
    assert!(tinted.contains("\nf0 = [0.0555556, 0.111111, 0.5]\n"), "{tinted}");
    let textured = of(json!({ "KHR_materials_specular": { "specularColorTexture": { "index": 0 } } }));
    assert!(textured.contains("f0 = { image = \"maps/texels.png\", srgb = true }"), "{textured}");
    assert!(textured.contains("base_color = { image = \"maps/white.png\" }"), "{textured}");
    let both = of(json!({ "KHR_materials_specular": {
        "specularColorTexture": { "index": 0 }, "specularTexture": { "index": 0 } } }));
    assert!(both.contains("f0 = { image = \"maps/texels-f0.png\" }"), "{both}");
}

/// A surface that is half a metal is a blend of two, as in glTF, and not one interface between.
#[test]
fn half_a_metal_is_a_blend() {
    let found = import(GREY, json!({ "pbrMetallicRoughness": { "metallicFactor": 0.5 } }));
    let text = &read(&found).0.text;
    assert!(text.contains("metallic = 0.5") && text.contains("metallic = { image = \"maps/white.png\" }"), "{text}");
    let ior = json!({ "KHR_materials_ior": { "ior": 1.8 } });
    let found = import(GREY, json!({ "pbrMetallicRoughness": { "metallicFactor": 0.5 }, "extensions": ior }));
    let text = &read(&found).0.text;
    assert!(text.contains("base_color = { image = \"maps/white.png\" }"), "{text}");
}

/// Films of one thickness and of a texture, whose range may be turned over; a weight below a coat is lost, and told.
#[test]
fn films_are_layers() {
    let film = |given: Value| json!({ "pbrMetallicRoughness": { "metallicFactor": 0 }, "extensions": { "KHR_materials_iridescence": given } });
    let found = import(GREY, film(json!({ "iridescenceFactor": 0.5 })));
    let text = &read(&found).0.text;
    assert!(text.contains("type = \"thin-film\"\nior = 1.3\nthickness_nm = 400.0\nweight = 0.5\n"), "{text}");
    let texels = [[0, 0, 0], [0, 255, 0]];
    let given = json!({ "iridescenceFactor": 1, "iridescenceThicknessMinimum": 500, "iridescenceThicknessMaximum": 300,
        "iridescenceThicknessTexture": { "index": 0 } });
    let found = import(texels, film(given.clone()));
    let text = &read(&found).0.text;
    assert!(text.contains("min = 300.0, max = 500.0"), "{text}");
    assert_eq!(values(&found, "maps/texels-thickness.png")[0][0], 1.0);
    let mut coated = film(json!({ "iridescenceFactor": 0.5 }));
    coated["extensions"]["KHR_materials_clearcoat"] = json!({ "clearcoatFactor": 1 });
    let found = import(GREY, coated);
    assert_eq!(fate(read(&found).0, "iridescenceFactor"), [Fate::Dropped]);
}

/// Pictures of two materials that are computed from one picture in two places are two.
#[test]
fn a_picture_in_another_place_is_another_picture() {
    let of = |place: &str, member: &str| {
        let mut material = json!({
            "pbrMetallicRoughness": { "roughnessFactor": 0.5 },
            "extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": 0.5 } },
        });
        material[place][member] = json!({ "index": 0 });
        material
    };
    let rough = of("pbrMetallicRoughness", "metallicRoughnessTexture");
    let mut strong = of("pbrMetallicRoughness", "none");
    strong["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"] = json!({ "index": 0 });
    let text = json!({
        "asset": { "version": "2.0" }, "images": [picture([[0, 255, 51], [0, 51, 255]])], "textures": [{ "source": 0 }],
        "materials": [rough, strong],
    });
    let found = gltf("test.gltf", text.to_string().as_bytes(), &none).unwrap();
    let first: Vec<f64> = values(&found, "maps/texels-alpha-x.png").iter().map(|texel| texel[0]).collect();
    let second: Vec<f64> = values(&found, "maps/texels-alpha-x-2.png").iter().map(|texel| texel[0]).collect();
    // Roughness .5 and .1 with the strength .5; then the strengths .1 and .5 with the roughness .5.
    let alpha_x = |roughness: f64, strength: f64| {
        let alpha = roughness * roughness;
        alpha + (1.0 - alpha) * strength * strength
    };
    let most = alpha_x(0.5, 0.5);
    close(first[0], 1.0);
    close(first[1], alpha_x(0.1, 0.5) / most);
    close(second[0], alpha_x(0.5, 0.1) / most);
    close(second[1], 1.0);
}

/// Textures that lie differently have the placement of the first, and that is told; names of any letters are comments of one line.
#[test]
fn placements_and_names_are_told() {
    let placed = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [5, 5] } } });
    let material = json!({
        "name": "nul\u{0}\u{1b}[31m\u{b}",
        "pbrMetallicRoughness": { "metallicFactor": 0 },
        "extensions": { "KHR_materials_specular": { "specularColorTexture": { "index": 0 }, "specularTexture": placed } },
    });
    let found = import(GREY, material);
    let (imported, _) = read(&found);
    assert!(!imported.text.contains("transform"), "{}", imported.text);
    let fates = fate(imported, "specularColorTexture, specularTexture");
    assert!(fates.contains(&Fate::Approximated), "{fates:?}");
    assert!(!imported.text.contains('\u{1b}') && !imported.source_name.contains('\u{0}'), "{}", imported.text);
}

/// Nothing is lost without a line: light through the surface, unknown extensions, pictures that cannot be read.
#[test]
fn losses_are_told() {
    let material = json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 7 } },
        "emissiveFactor": [1, 1, 1],
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1 },
            "KHR_materials_volume": {}, "KHR_materials_sheen": {}, "KHR_materials_unlit": {}, "VENDOR_new": {},
            "KHR_materials_clearcoat": { "clearcoatFactor": -1, "clearcoatColor": 3 },
        },
        "extras": {},
    });
    let found = import(GREY, material);
    let (imported, _) = read(&found);
    for (property, expected) in [
        ("baseColorTexture", Fate::Dropped),
        ("emissiveFactor, emissiveTexture", Fate::Host),
        ("KHR_materials_transmission", Fate::Dropped),
        ("KHR_materials_volume", Fate::Dropped),
        ("KHR_materials_sheen", Fate::Dropped),
        ("KHR_materials_unlit", Fate::Host),
        ("VENDOR_new", Fate::Dropped),
        ("KHR_materials_clearcoat.clearcoatColor", Fate::Dropped),
        ("clearcoatFactor", Fate::Approximated),
        ("extras", Fate::Host),
    ] {
        assert_eq!(fate(imported, property), [expected], "{property}");
    }
    assert!(imported.text.contains("# VENDOR_new, dropped: "), "{}", imported.text);
}

#[test]
fn broken_files_have_one_error() {
    let of = |text: &str| gltf("x.gltf", text.as_bytes(), &none).unwrap_err();
    assert!(matches!(of("{\"asset\": {\"version\": \"2.0\"}}"), ImportError::Empty(_)));
    assert!(matches!(of("nothing"), ImportError::Gltf(_)));
    let text = "{\"asset\": {\"version\": \"2.0\"}, \"materials\": [\n{},\n{\"name\": \"clay\", \"pbrMetallicRoughness\": {\"metallicFactor\": \"no\"}}]}";
    let error = of(text).to_string();
    assert!(error.starts_with("material 1 `clay`: invalid type: string \"no\"") && error.contains("line 3"), "{error}");
    // Arrays are no objects, and a texture has a number.
    for (material, expected) in [
        ("[]", "it is no object"),
        ("{\"normalTexture\": [0]}", "`normalTexture` is no object"),
        ("{\"normalTexture\": {}}", "missing field `index`"),
        ("{\"extensions\": {\"KHR_materials_ior\": [1.5]}}", "`KHR_materials_ior` is no object"),
    ] {
        let error = of(&format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"materials\": [{material}]}}")).to_string();
        assert!(error.contains(expected), "{error}");
    }
    let text = "{\"asset\": {\"version\": \"2.0\"}, \"materials\": [{}], \"extensionsRequired\": [\"FOO_bar\", \"KHR_texture_transform\"]}";
    let lines = gltf("x.gltf", text.as_bytes(), &none).unwrap().lines;
    assert_eq!(lines.iter().map(|line| line.property.as_str()).collect::<Vec<_>>(), ["FOO_bar"]);
}

/// By hand: texel 128 is 0.215861 by the sRGB curve and 0.501961 as it stands, and alpha is the square of the roughness. Texel 1 of the picture is white.
#[test]
fn points_have_factors_times_texels() {
    let text = json!({
        "asset": { "version": "2.0" },
        "images": [picture([[128; 3], [255; 3]])],
        "textures": [{ "source": 0 }],
        "materials": [{
            "name": "paint",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.5, 1, 2, 1], "baseColorTexture": { "index": 0 }, "metallicFactor": 0.5, "roughnessFactor": 0.8,
                "metallicRoughnessTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0.5, 0] } } },
            },
            "extensions": {
                "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatTexture": { "index": 0 }, "clearcoatRoughnessFactor": 0.5 },
                "KHR_materials_ior": { "ior": 2 },
                "KHR_materials_specular": { "specularFactor": 0.25, "specularColorFactor": [1, 9, 20] },
                "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyRotation": 0.3 },
                "KHR_materials_sheen": {}, "KHR_materials_unlit": {},
            },
        }, { "emissiveTexture": { "index": 7 }, "normalTexture": { "index": 7 } }, { "pbrMetallicRoughness": { "baseColorTexture": { "index": 7 } } }],
    });
    let places = |number: usize| if number == 0 { vec![[0.25, 0.5], [0.75, 0.5]] } else { vec![[0.0; 2]] };
    let found = gltf_points(text.to_string().as_bytes(), &none, &places).unwrap();
    let [dark, light] = found[0].points.as_slice() else { panic!("{found:?}") };
    close(dark.base_color[0], 0.5 * 0.215_861);
    close(dark.base_color[2], 0.215_861);
    assert_eq!(light.base_color, [0.5, 1.0, 1.0]);
    // Metal and roughness are half a picture ahead.
    close(dark.metallic, 0.5);
    close(light.metallic, 0.5 * 0.501_961);
    close(dark.alpha[1], 0.64);
    close(dark.alpha[0], 0.64 + 0.36 * 0.25);
    close(light.alpha[1], 0.64 * 0.501_961 * 0.501_961);
    assert_eq!((dark.turn, dark.specular), (0.3, 0.25));
    close(dark.f0[0], 1.0 / 9.0);
    assert_eq!([dark.f0[1], dark.f0[2]], [1.0; 2]);
    close(dark.coat.unwrap()[0], 0.501_961);
    assert_eq!(light.coat, Some([1.0, 0.25]));
    assert_eq!(
        (found[0].name.as_str(), found[0].left_out.as_slice()),
        ("paint", &["KHR_materials_sheen".to_owned()][..])
    );
    assert!(found[1].left_out.is_empty(), "{:?}", found[1].left_out);
    assert!(found[2].left_out[0].starts_with("baseColorTexture: "), "{:?}", found[2].left_out);
    assert_eq!(found[2].points[0].base_color, [1.0; 3]);
}

//! `luthier table`: what it bakes is read back, and judged by `luthier audit` or by other readers.

use serde_json::Value;

use crate::workshop::Workshop;

/// Baked tables are as their preset states, in the eyes of the audit.
#[test]
fn presets_pass_the_audit() {
    let workshop = Workshop::new();
    let raw = |size: &'static str, channels: &'static str, samples: &'static str| {
        vec!["--size", size, "--channels", channels, "--samples", samples]
    };
    for (preset, file, read) in [
        ("bevy", "dfg.ktx2", vec![]),
        ("babylon", "brdf.png", vec!["--channel", "r,g"]),
        ("filament", "dfg.bin", [raw("128x128", "3", "half"), vec!["--channel", "r,g"]].concat()),
        ("godot", "godot.bin", [raw("128x128", "4", "half"), vec!["--channel", "r,g"]].concat()),
        ("hdrp", "fgd.exr", vec!["--channel", "r,g"]),
        ("unreal", "gf.bin", raw("128x32", "2", "unorm16")),
    ] {
        workshop.run(&["table", "dfg", "--preset", preset, "-o", file]).exits(0);
        let audit = workshop.run(&[&["audit", file, "--preset", preset][..], &read].concat()).exits(0);
        assert!(audit.stdout.contains("\nas stated\n"), "{preset}: {}", audit.stdout);
    }
}

/// The table of the glTF viewer is a PNG of linear bytes, whatever its size.
#[test]
fn a_png_holds_values_and_no_colours() {
    let workshop = Workshop::new();
    workshop.run(&["table", "dfg", "--preset", "gltf", "--size", "64x64", "-o", "lut.png"]).exits(0);
    let audit = ["audit", "lut.png", "--preset", "gltf", "--channel", "r,g"];
    let audit = workshop.run(&audit).exits(0);
    assert!(audit.stdout.contains("\nas stated\n"), "{}", audit.stdout);
}

/// The module of three.js has one word for every channel, and exports what the renderer imports.
#[test]
fn the_module_of_three_js_holds_the_table() {
    let workshop = Workshop::new();
    workshop.run(&["table", "dfg", "--preset", "three", "-o", "DFGLUTData.js"]).exits(0);
    let text = std::fs::read_to_string(workshop.path("DFGLUTData.js")).unwrap();
    assert!(text.contains("export const DFG_LUT_DATA = new Uint16Array( ["), "{text}");
    assert!(
        text.contains("export function getDFGLUT()") && text.contains("DataTexture( DFG_LUT_DATA, 16, 16,"),
        "{text}"
    );
    assert_eq!(text.matches("0x").count(), 16 * 16 * 2);
    let wide = ["table", "dfg", "--preset", "three", "--size", "64x32", "-o", "wide.js"];
    workshop.run(&wide).exits(0);
    let text = std::fs::read_to_string(workshop.path("wide.js")).unwrap();
    assert_eq!((text.matches("0x").count(), text.contains("64, 32,")), (64 * 32 * 2, true));
}

/// A file says what it holds: the statement and the error stand in its metadata, and are those that the command prints.
#[test]
fn files_say_what_they_hold() {
    let workshop = Workshop::new();
    let printed = workshop.run(&["table", "dfg", "--preset", "bevy", "-o", "dfg.ktx2", "--json"]).exits(0).json();
    workshop.run(&["table", "dfg", "--preset", "babylon", "--size", "32x32", "-o", "brdf.png"]).exits(0);
    let said = |file: &str| -> Value {
        let bytes = std::fs::read(workshop.path(file)).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let from = text.find("{\"error\"").unwrap();
        serde_json::Deserializer::from_str(&text[from..]).into_iter().next().unwrap().unwrap()
    };
    let ktx2 = said("dfg.ktx2");
    assert_eq!((&ktx2["table"], &ktx2["error"]["max_abs_err"]), (&printed["table"], &printed["error"]["max_abs_err"]));
    assert_eq!(printed["files"][0]["file"], "dfg.ktx2");
    assert_eq!(said("brdf.png")["table"]["stored"], "rgbd");
}

/// A searched table holds its limit, also in the eyes of the audit, and is smaller for a larger limit.
#[test]
fn searched_tables_hold_their_limit() {
    let workshop = Workshop::new();
    let found = |limit: &str, file: &str| -> Value {
        workshop.run(&["table", "dfg", "--max-abs", limit, "-o", file, "--json"]).exits(0).json()
    };
    let (coarse, fine) = (found("1e-2", "coarse.ktx2"), found("2e-3", "fine.ktx2"));
    let texels =
        |value: &Value| value["table"]["size"][0].as_u64().unwrap() * value["table"]["size"][1].as_u64().unwrap();
    assert!(texels(&coarse) < texels(&fine));
    assert!(fine["error"]["max_abs_err"].as_f64().unwrap() <= 2e-3);
    // The audit knows no loss: it judges the bias.
    let axes = fine["table"]["axes"].as_str().unwrap();
    let statement =
        ["--model", "ggx-correlated", "--axes", axes, "--nodes", "ends", "--values", "bias", "--channel", "r"];
    let limits = ["--min-alpha", "0.01", "--max-error", "2e-3"];
    workshop.run(&[&["audit", "fine.ktx2"][..], &statement, &limits].concat()).exits(0);
}

/// A closed form is a shader in the language of the ending; look-ups of tables stand beside them.
#[test]
fn shaders_are_written_in_the_languages_asked_for() {
    let workshop = Workshop::new();
    let text = |file: &str| std::fs::read_to_string(workshop.path(file)).unwrap();
    let closed = ["table", "dfg", "--max-abs", "1e-2", "--closed", "-o", "closed.es300.glsl", "--shader", "wgsl,hlsl"];
    let said = workshop.run(&closed).exits(0);
    assert!(said.stdout.contains("multiply-adds") && said.stdout.contains("holds 0.01"), "{}", said.stdout);
    assert!(text("closed.wgsl").contains("fn luthier_dfg(") && text("closed.hlsl").contains("luthier_dfg("));
    assert!(text("closed.es300.glsl").contains("vec2 luthier_dfg(float cos_theta, float alpha) {"));
    let table = ["table", "dfg", "--preset", "bevy", "-o", "dfg.ktx2", "--shader", "wgsl,msl,spirv", "--bind", "1,4,5"];
    workshop.run(&table).exits(0);
    assert!(text("dfg.wgsl").contains("@group(1) @binding(4) var luthier_dfg_table"), "{}", text("dfg.wgsl"));
    assert!(text("dfg.metal").contains("luthier_dfg("));
    assert_eq!(std::fs::read(workshop.path("dfg.spv")).unwrap()[..4], [3, 2, 0x23, 7]);
}

/// The page has a map for the table, and one for the table beside it, whose error is the one that the audit finds.
#[test]
fn the_page_shows_both_tables() {
    let workshop = Workshop::new();
    workshop.run(&["table", "dfg", "--preset", "bevy", "-o", "small.ktx2", "--size", "16x16"]).exits(0);
    let page = ["table", "dfg", "--preset", "bevy", "-o", "dfg.ktx2", "--report", "dfg.html", "--beside", "small.ktx2"];
    workshop.run(&page).exits(0);
    let html = std::fs::read_to_string(workshop.path("dfg.html")).unwrap();
    assert_eq!(html.matches("<svg").count(), 2);
    assert!(html.contains("small.ktx2 (16 x 16)") && html.contains("Layout read in"), "{html}");
}

/// The other functions: files of the endings asked for, with the sizes that their texels take.
#[test]
fn other_functions_are_baked() {
    let workshop = Workshop::new();
    let size = |file: &str| std::fs::metadata(workshop.path(file)).unwrap().len();
    workshop.run(&["table", "cloth", "--size", "16x8", "-o", "cloth.bin"]).exits(0);
    assert_eq!(size("cloth.bin"), 16 * 8 * 2);
    workshop.run(&["table", "energy", "--size", "8x8", "-o", "metal.bin"]).exits(0);
    assert_eq!(size("metal.bin"), 8 * 8 * 2);
    let glass =
        ["table", "energy", "--surface", "from-denser", "--axes", "cos_theta,roughness,sqrt_f0", "--size", "4x4x3"];
    workshop.run(&[&glass[..], &["--values", "reflected,transmitted", "-o", "glass.bin"]].concat()).exits(0);
    assert_eq!(size("glass.bin"), 4 * 4 * 3 * 2 * 2);
    let film = ["table", "film", "--film", "1.33", "--base", "1.5", "--size", "8x16", "-o", "film.bin", "--json"];
    let film = workshop.run(&film).exits(0).json();
    assert_eq!((size("film.bin"), film["table"]["color"].as_str()), (8 * 16 * 3 * 2, Some("spectral, D65")));
}

/// One table of reflectance for all materials, in the layout of Weidlich and Wilkie 2009: a node at normal incidence, by hand.
#[test]
fn reflectances_of_all_materials_are_baked() {
    let workshop = Workshop::new();
    let told = workshop.run(&["table", "fresnel", "-o", "f.exr", "--shader", "wgsl,hlsl", "--json"]).exits(0).json();
    assert_eq!(told["table"]["size"], serde_json::json!([128, 32, 32]));
    let (image, _) = luthier_texture::exr::decode(&std::fs::read(workshop.path("f.exr")).unwrap()).unwrap();
    assert_eq!((image.width, image.height, image.channels), (128, 32 * 32, 1));
    // Normal incidence, n of the 4th node, k of the 11th: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    let [n, k] = [0.05 + 4.95 * 3.0 / 31.0, 10.0 * 10.0 / 31.0];
    let f0 = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
    assert!((f64::from(image.texel(127, 32 * 10 + 3)[0]) - f0).abs() < 1e-6);
    for (file, text) in [("f.wgsl", "fn luthier_reflectance("), ("f.hlsl", "float luthier_reflectance(")] {
        assert!(std::fs::read_to_string(workshop.path(file)).unwrap().contains(text), "{file}");
    }
    let page = ["table", "fresnel", "--size", "16x8x8", "-o", "f.bin", "--report", "f.html"];
    workshop.run(&page).exits(0);
    assert!(std::fs::read_to_string(workshop.path("f.html")).unwrap().contains("Table of reflectances"));
    assert_eq!(std::fs::metadata(workshop.path("f.bin")).unwrap().len(), 16 * 8 * 8 * 2);
}

/// Linearly transformed cosines: both tables of engines in a folder, and sheen, with the errors of the paper's kind.
#[test]
fn lobes_are_fitted() {
    let workshop = Workshop::new();
    let ltc = workshop.run(&["table", "ltc", "-o", "ltc", "--no-zstd", "--json"]).exits(0).json();
    for file in ["ltc/ltc_1.ktx2", "ltc/ltc_2.ktx2"] {
        let texture = luthier_texture::ktx2::decode(&std::fs::read(workshop.path(file)).unwrap()).unwrap();
        assert_eq!((texture.width, texture.height, texture.bytes.len()), (64, 64, 64 * 64 * 8));
    }
    let median = |value: &Value| value["median"].as_f64().unwrap();
    assert!(median(&ltc["error"]["between_texels"]) < 0.025 && median(&ltc["error"]["rectangles_absolute"]) < 0.005);
    let sheen = workshop.run(&["table", "sheen", "-o", "sheen.bin", "--json"]).exits(0).json();
    assert!(median(&sheen["error"]["lobe"]) < 0.035);
    assert_eq!(std::fs::metadata(workshop.path("sheen.bin")).unwrap().len(), 32 * 32 * 3 * 2);
}

/// The albedo of a metal in a file, read back: at normal incidence on the roughest surface it is 1 - ln 2, by hand.
#[test]
fn values_are_read_back() {
    let workshop = Workshop::new();
    workshop.run(&["table", "energy", "--values", "albedo,loss", "--size", "8x8", "-o", "metal.exr"]).exits(0);
    let bytes = std::fs::read(workshop.path("metal.exr")).unwrap();
    let (image, metadata) = luthier_texture::exr::decode(&bytes).unwrap();
    // D = 1/pi and G = 2c/(1 + c): the integral of c/(1 + c) over the cosine c of reflected light.
    let corner = image.texel(7, 7);
    assert!((f64::from(corner[0]) - (1.0 - std::f64::consts::LN_2)).abs() < 2e-6, "{corner:?}");
    assert!((corner[0] + corner[1] - 1.0).abs() < 1e-6);
    assert!(metadata.iter().any(|(key, value)| key == "luthier.table" && value.contains("\"energy\"")));
}

/// Limits on the error and on the bytes: a metal's table, and a split sum beside a closed form, whose look-up is written without being asked for.
#[test]
fn limits_are_held() {
    let workshop = Workshop::new();
    let metal = ["table", "energy", "--values", "loss", "--max-abs", "5e-3", "-o", "metal.ktx2", "--json"];
    let metal = workshop.run(&metal).exits(0).json();
    assert!(metal["error"]["max_abs_err"].as_f64().unwrap() <= 5e-3 && metal["table"]["nodes"] == "ends");
    let small = ["table", "dfg", "--max-abs", "2e-3", "--max-bytes", "1200", "-o", "small.bin", "--json"];
    let small = workshop.run(&small).exits(0).json();
    assert!(small["error"]["max_abs_err"].as_f64().unwrap() <= 2e-3 && small["table"]["beside_form"].is_object());
    let bytes = std::fs::metadata(workshop.path("small.bin")).unwrap().len();
    assert!(bytes <= 1200 && small["table"]["bytes"] == bytes, "{bytes}");
    assert!(std::fs::read_to_string(workshop.path("small.wgsl")).unwrap().contains("fn luthier_dfg_form("));
    workshop.run(&["table", "dfg", "--max-abs", "1e-5", "--max-bytes", "64", "-o", "none.bin"]).fails(1, &["64 bytes"]);
    assert!(!workshop.path("none.bin").exists() && !workshop.path("none.wgsl").exists());
}

#[test]
fn what_cannot_be_baked_is_refused() {
    let workshop = Workshop::new();
    let refused = |arguments: &[&str], code: i32, words: &str| {
        std::fs::write(workshop.path("x.ktx2"), "before").unwrap();
        workshop.run(&[&["table"][..], arguments, &["-o", "x.ktx2"]].concat()).fails(code, &[words]);
        assert_eq!(std::fs::read(workshop.path("x.ktx2")).unwrap(), b"before");
    };
    refused(&["dfg", "--preset", "nothing"], 2, "nothing");
    workshop.run(&["table", "dfg", "--preset", "nothing", "-o", "x.ktx2"]).exits(2).says(&["babylon, bevy"]);
    refused(&["dfg", "--max-abs", "1e-3", "--masking", "smith"], 2, "correlated");
    refused(&["dfg", "--max-abs", "0"], 2, "--max-abs");
    refused(&["dfg"], 2, "required");
    refused(&["dfg", "--max-abs", "1e-2", "--closed"], 2, ".es300.glsl");
    refused(&["dfg", "--preset", "bevy", "--size", "2x2000"], 2, "4 to 1024");
    refused(&["energy", "--surface", "from-rarer"], 2, "sqrt_f0");
    refused(&["energy", "--axes", "cos_theta"], 2, "cos_theta");
    refused(&["energy", "--preset", "maya"], 2, "maya");
    refused(&["energy", "--size", "1024x1024"], 2, "65536 at most");
    refused(&["energy", "--surface", "from-denser", "--max-abs", "1e-3"], 2, "reflector");
    refused(&["film", "--film", "water", "--base", "1.5"], 2, "index of refraction");
    refused(&["film", "--film", "1.3", "--base", "1.5", "--axes", "cos_theta,roughness"], 2, "thickness");
    refused(&["fresnel", "--axes", "cos_theta,ior_n"], 2, "ior_k");
    refused(&["fresnel", "--size", "128x128x128"], 2, "one below the other");
    refused(&["fresnel", "--size", "128x32"], 2, "three axes");
    workshop.run(&["table", "cloth", "-o", "cloth.tga"]).fails(2, &[".ktx2"]);
    workshop.run(&["table", "cloth", "--size", "8x8", "-o", "nowhere/cloth.bin"]).fails(3, &["nowhere"]);
}

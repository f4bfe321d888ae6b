//! Tables ship where a shader reads them, and where someone asks.

use std::collections::{BTreeMap, BTreeSet};

use luthier_workshop::material_texts::NOISE;
use luthier_workshop::root;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use serde_json::Value as Json;

use crate::machine::{Machine, Value, vector};
use crate::workshop::Workshop;

const KINDS: [&str; 8] = ["fresnel", "distribution", "fgd", "phase", "thickness", "film", "escape", "lobes"];

/// Functions that a caller calls to shade.
const ENTRIES: [&str; 3] = ["luthier_eval", "luthier_eval_at", "luthier_film_place"];

/// A material without an interface, so that it asks for nothing; tables of its set have these sizes, and are baked in a moment.
const FRAME: &str = "schema = 1\nname = \"frame\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n\
                     [bake]\nfgd = { size = [8, 8] }\nthickness = { size = 16 }\n";

/// Coated metal, bare metal, a film that varies and one that does not; their files ask for nothing.
fn set() -> Workshop {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.5 }\nalpha = 0.3\n";
    let varying = format!(
        "[[layer]]\ntype = \"thin-film\"\nior = 1.33\n[layer.thickness_nm]\nmin = 100\nmax = 400\nextent_um = 1000\nmap = {NOISE}\n"
    );
    let even = "[[layer]]\ntype = \"thin-film\"\nior = 1.33\nthickness_nm = 300\n";
    let workshop = Workshop::with(&[("m/frame.toml", FRAME)]);
    for (name, layers) in [
        ("coated", [coat, metal].concat()),
        ("bare", metal.to_owned()),
        ("varying", [&varying, coat].concat()),
        ("even", [even, coat].concat()),
    ] {
        workshop.write(&format!("m/{name}.toml"), format!("schema = 1\nname = \"{name}\"\n{layers}"));
    }
    workshop
}

/// Kinds of textures that a shader binds, and those that its functions of shading reach.
fn textures(wgsl: &str) -> [BTreeSet<String>; 2] {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap();
    let info =
        Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16_IN_FLOAT32).validate(&module).unwrap();
    let bound: Vec<_> = module
        .global_variables
        .iter()
        .filter(|(_, global)| matches!(module.types[global.ty].inner, naga::TypeInner::Image { .. }))
        .map(|(handle, global)| (handle, global.name.as_deref().unwrap().strip_prefix("luthier_").unwrap().to_owned()))
        .collect();
    let entries = module.functions.iter().filter(|(_, f)| ENTRIES.contains(&f.name.as_deref().unwrap_or_default()));
    let read = entries
        .flat_map(|(function, _)| {
            bound.iter().filter(|(global, _)| !info[function][*global].is_empty()).collect::<Vec<_>>()
        })
        .map(|(_, kind)| kind.clone())
        .collect();
    [bound.iter().map(|(_, kind)| kind.clone()).collect(), read]
}

fn baked(manifest: &Json) -> BTreeSet<String> {
    manifest["tables"].as_array().unwrap().iter().map(|table| table["kind"].as_str().unwrap().to_owned()).collect()
}

fn kinds(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

#[test]
fn what_is_baked_is_what_the_shader_of_each_model_reads() {
    let workshop = set();
    for (model, expected) in [
        ("elek", &["fresnel", "thickness", "film"][..]),
        ("weidlich-wilkie", &["fresnel", "thickness", "film"]),
        ("microfacet", &["fresnel", "thickness", "film"]),
        ("granier-heidrich", &["fresnel", "phase", "thickness"]),
        ("belcour", &["fgd", "escape"]),
        ("yamaguchi", &["fgd", "escape"]),
        ("phong", &[]),
    ] {
        workshop.run(&["bake", "m", "--model", model, "--quiet"]).exits(0);
        let [bound, read] = textures(&workshop.text("out/shaders/baked.wgsl"));
        assert_eq!(bound, kinds(expected), "{model}");
        assert_eq!(read, bound, "{model}");
        assert_eq!(baked(&workshop.json("out/manifest.json")), bound, "{model}");
    }
}

#[test]
fn any_kind_is_baked_and_bound_on_request() {
    let workshop = set();
    let words = ["bake", "m/bare.toml", "m/frame.toml", "--model", "elek", "--tables", "fgd", "--quiet"];
    workshop.run(&words).exits(0);
    let [bound, read] = textures(&workshop.text("out/shaders/baked.wgsl"));
    assert_eq!((bound, read), (kinds(&["fresnel", "fgd"]), kinds(&["fresnel"])));
    assert_eq!(baked(&workshop.json("out/manifest.json")), kinds(&["fresnel", "fgd"]));
    assert!(workshop.text("out/shaders/baked.wgsl").contains("fn luthier_lookup_fgd("));

    // From a file, and from the shader's command line.
    workshop.edit("m/bare.toml", |text| text + "[bake]\ntables = [\"distribution\"]\n");
    let run = workshop.run(&["shader", "m/bare.toml", "--model", "elek", "--tables", "fgd"]).exits(0);
    let [bound, read] = textures(&run.stdout);
    assert_eq!(bound, kinds(&["fresnel", "distribution", "fgd"]));
    assert_eq!(read, kinds(&["fresnel", "distribution"]));

    workshop.run(&["bake", "m/bare.toml", "--tables", "albedo"]).exits(2).says(&["albedo", "fgd"]);
    workshop.edit("m/bare.toml", |text| text.replace("\"distribution\"", "\"fdg\""));
    workshop.run(&["bake", "m/bare.toml"]).exits(1).says(&["m/bare.toml:", "fdg", "did you mean `\"fgd\"`?"]);
    workshop.edit("m/bare.toml", |text| text.replace("\"fdg\"", "\"phase\""));
    let run = workshop.run(&["check", "m/bare.toml"]).exits(0);
    assert!(run.stderr.contains("no layer has a film"), "{}", run.stderr);
}

/// Tables that no shader reads take no part of a budget.
#[test]
fn bytes_count_what_ships() {
    let workshop = set();
    let limit = ["bake", "m/coated.toml", "m/frame.toml", "--max-bytes", "400", "--quiet", "--no-fit"];
    workshop.run(&limit).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let bytes: u64 = manifest["tables"].as_array().unwrap().iter().map(|t| t["texel_bytes"].as_u64().unwrap()).sum();
    assert!(bytes <= 400, "{bytes}");
    workshop.run(&[&limit[..], &["--tables", "fgd"]].concat()).fails(1, &["the budget cannot be met"]);
}

/// In words for people and in JSON.
#[test]
fn a_broken_budget_names_its_material() {
    let workshop = set();
    workshop.write("m/bare.toml", workshop.text("m/bare.toml") + "\n[budget]\nmax_abs = 1e-9\n");
    let line = workshop.text("m/bare.toml").lines().position(|line| line.starts_with("max_abs")).unwrap() + 1;
    let run = workshop.run(&["bake", "m/bare.toml", "m/coated.toml", "--no-fit", "--json", "--quiet"]).exits(1);
    let error = run.json()["error"].clone();
    let place = format!("under max_abs = 1e-9 of m/bare.toml:{line}");
    let message = error["message"].as_str().unwrap();
    assert!(
        message.contains("the budget cannot be met: no fresnel table is good enough for layer 0 of `"),
        "{message}"
    );
    assert!(message.contains(&place) && run.stderr.contains(message), "{message}\n{}", run.stderr);
    let [diagnostic] = error["diagnostics"].as_array().unwrap().as_slice() else { panic!("{error}") };
    assert!(message.contains(&format!("({}:", diagnostic["file"].as_str().unwrap())), "{error}");
    // Alone it is both.
    let run = workshop.run(&["bake", "m/bare.toml", "--no-fit", "--json", "--quiet"]).exits(1);
    let diagnostic = &run.json()["error"]["diagnostics"][0];
    assert_eq!((&diagnostic["file"], &diagnostic["line"]), (&"m/bare.toml".into(), &line.into()));
}

/// The papers make every kind but those of films that vary under a path, and of lobes, which the other materials have.
#[test]
fn the_shipped_materials_make_every_kind() {
    let workshop = Workshop::with(&[("frame.toml", FRAME.replace("size = 16 ", "size = 256 ").as_str())]);
    let at = |name: &str| root().join("materials").join(name).display().to_string();
    workshop.run(&["bake", &at("papers"), "frame.toml", "--quiet"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let papers = kinds(&["fresnel", "distribution", "fgd", "phase", "thickness", "escape"]);
    assert_eq!(baked(&manifest), papers);
    let table = |kind: &str| {
        let tables = manifest["tables"].as_array().unwrap();
        tables.iter().find(|table| table["kind"] == kind).unwrap().clone()
    };
    let axis = |kind: &str, axis: &str| table(kind)["layout"][axis]["size"].as_u64().unwrap();
    assert_eq!(axis("fresnel", "x"), 128, "Elek's rows");
    assert_eq!([axis("distribution", "x"), axis("distribution", "y")], [512; 2], "Elek's D");
    let power = &table("distribution")["layout"]["x"]["mapping"];
    assert!(power.to_string().contains('8'), "{power}");
    let [bound, read] = textures(&workshop.text("out/shaders/baked.wgsl"));
    assert_eq!((&bound, &read), (&papers, &papers), "every table has a reader");
    has_models(
        &manifest,
        &[
            ("chromium-car-paint", "elek"),
            ("copper-patina", "elek"),
            ("granier-film", "granier-heidrich"),
            ("yamaguchi-brushed", "yamaguchi"),
            ("car-paint", "weidlich-wilkie"),
        ],
    );

    let others = ["soap-film.toml", "varnished-brass.toml", "polished-gold.toml", "brushed-aluminium.toml"].map(at);
    let others: Vec<&str> = others.iter().map(String::as_str).collect();
    workshop.run(&[&["bake", "frame.toml", "--quiet"], &others[..]].concat()).exits(0);
    let manifest = workshop.json("out/manifest.json");
    assert_eq!(papers.union(&baked(&manifest)).cloned().collect::<BTreeSet<_>>(), kinds(&KINDS));
    let [bound, read] = textures(&workshop.text("out/shaders/baked.wgsl"));
    assert_eq!(bound, read, "every table has a reader");
    has_models(&manifest, &[("varnished-brass", "lobes"), ("polished-gold", "elek"), ("brushed-aluminium", "lobes")]);
}

fn has_models(manifest: &Json, expected: &[(&str, &str)]) {
    let materials = manifest["materials"].as_array().unwrap();
    for (name, model) in expected {
        let material = materials.iter().find(|material| material["name"] == *name).unwrap();
        assert_eq!(material["model"], *model, "{name}");
    }
}

/// Along the brush and across it the facets that mirror differ by D of GGX alone: (x^2 / alpha_x^2 + y^2 / alpha_y^2 + z^2)^-2.
#[test]
fn brushed_aluminium_is_brushed_in_its_shader() {
    let workshop = Workshop::new();
    let material = root().join("materials/brushed-aluminium.toml");
    workshop.run(&["bake", material.to_str().unwrap(), "--no-fit", "--quiet"]).exits(0);
    let buffer: Vec<[f32; 4]> = std::fs::read(workshop.path("out/materials.bin"))
        .unwrap()
        .chunks_exact(16)
        .map(|word| [0, 4, 8, 12].map(|at| f32::from_le_bytes(word[at..at + 4].try_into().unwrap())))
        .collect();
    let texture = luthier_texture::ktx2::decode(&std::fs::read(workshop.path("out/tables/fresnel.ktx2")).unwrap());
    let textures = BTreeMap::from([("luthier_fresnel".to_owned(), texture.unwrap().image().unwrap())]);
    let machine = Machine::new(&workshop.text("out/shaders/baked.wgsl"), &buffer, textures);
    let reflectance = |[theta_i, theta_o]: [f64; 2], azimuth: f64| {
        let towards = |theta: f64, phi: f64| {
            let ((sin, cos), (y, x)) = (libm::sincos(theta.to_radians()), libm::sincos(phi.to_radians()));
            vector(&[sin * x, sin * y, cos].map(|v| v as f32))
        };
        let (wi, wo) = (towards(theta_i, azimuth), towards(theta_o, azimuth + 180.0));
        f64::from(machine.call("luthier_eval", vec![Value::U(0), wi, wo]).floats()[0])
    };
    for angles in [[40.0, 10.0], [60.0, 30.0], [25.0, 0.0]] {
        let half = 0.5_f64 * (angles[0] - angles[1]);
        let (sin, cos) = libm::sincos(half.to_radians());
        let (sin_sq, cos_sq) = (sin * sin, cos * cos);
        let falloff = |alpha: f64| 1.0 / libm::pow(sin_sq / (alpha * alpha) + cos_sq, 2.0);
        let (along, across) = (reflectance(angles, 0.0), reflectance(angles, 90.0));
        let expected = falloff(0.08) / falloff(0.35);
        assert!((along / across / expected - 1.0).abs() < 1e-3, "{angles:?}: {along} {across} {expected}");
    }
}

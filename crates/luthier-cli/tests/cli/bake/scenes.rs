//! `luthier bake SCENE`: models chosen by their error, and only their code and tables.

use luthier_workshop::{material_files, root};
use serde_json::Value;

use crate::workshop::Workshop;

/// Rough metal: Phong's lobe is far off, the others differ by what bounces between facets.
const METAL: &str = "schema = 1\nname = \"metal\"\n\n[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.0 }\n\
                     alpha_x = 0.09\nalpha_y = 0.11\n";

/// A diffuse base whose slopes are hardly seen.
const CLAY: &str =
    "schema = 1\nname = \"clay\"\n\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.3, 0.2]\nsigma = 0.25\n";

const SCENE: &str = "scene = 1\nname = \"shelf\"\n\n[[material]]\nfile = \"parts/metal.toml\"\n\n[[material]]\n\
                     file = \"parts/clay.toml\"\n\n[[light]]\ntype = \"directional\"\nfrom_eye_deg = 50\n\n\
                     [view]\nangles_deg = [0, 45]\nfootprint_deg = 1\n\n[budget]\nmax_rel = 0.3\n";

fn shelf() -> Workshop {
    Workshop::with(&[("parts/metal.toml", METAL), ("parts/clay.toml", CLAY), ("shelf.toml", SCENE)])
}

fn models(choice: &Value) -> Vec<&str> {
    let materials = choice["materials"].as_array().unwrap();
    let chosen = |m: &'_ Value| m["chosen"].as_u64().unwrap() as usize;
    materials.iter().map(|m| m["tried"][chosen(m)]["model"].as_str().unwrap()).collect()
}

#[test]
fn the_form_of_a_scene_is_chosen() {
    shelf().run(&["bake", "shelf.toml", "--form", "full"]).fails(2, &["leave out --form"]);
}

/// The second criterion of budgets: tighter costs no less, weighs no less and errs no more, and something changes on the way.
#[test]
fn a_tightened_budget_is_monotone() {
    let run = shelf().run(&["bake", "shelf.toml", "--budgets", "1.5,0.4,0.3,0.1", "--json"]).exits(0);
    let all = run.json();
    let steps = all["scenes"][0].as_array().unwrap();
    assert_eq!(steps.len(), 4);
    let worst = |step: &Value| {
        let materials = step["choice"]["materials"].as_array().unwrap();
        let of = |m: &Value| m["tried"][m["chosen"].as_u64().unwrap() as usize].clone();
        materials.iter().map(|m| of(m)["error"]["max_rel"].as_f64().unwrap()).fold(0.0, f64::max)
    };
    for (step, budget) in steps.iter().zip([1.5, 0.4, 0.3, 0.1]) {
        assert!(worst(step) <= 0.75 * budget, "{budget}: {}", worst(step));
    }
    for pair in steps.windows(2) {
        let number = |key: &str| [0, 1].map(|i: usize| pair[i][key].as_f64().unwrap());
        for key in ["cost", "texel_bytes"] {
            let [loose, tight] = number(key);
            assert!(loose <= tight, "{key}: {loose} {tight}");
        }
        // Noise of the reference falls from step to step, and the error of one model with it.
        assert!(worst(&pair[1]) <= worst(&pair[0]) + 0.01, "{} {}", worst(&pair[0]), worst(&pair[1]));
    }
    let chosen: Vec<Vec<&str>> = steps.iter().map(|step| models(&step["choice"])).collect();
    assert!(chosen[0] != chosen[3] && steps[0]["cost"] != steps[3]["cost"], "{chosen:?}");
}

/// A bake has the code and the tables of the chosen models only, says why, and does not depend on threads.
#[test]
fn only_what_was_chosen_is_written() {
    let workshop = shelf();
    let said = workshop.run(&["bake", "shelf.toml", "--out", "a", "--threads", "1"]).exits(0).stdout;
    workshop.run(&["bake", "shelf.toml", "--out", "b", "--threads", "2", "-q"]).exits(0);
    assert!(workshop.tree("a") == workshop.tree("b"));
    let manifest = workshop.json("a/manifest.json");
    let choice = &manifest["choice"];
    assert_eq!((choice["scene"].as_str(), choice["form"].as_str()), (Some("shelf"), Some("baked")));
    for (i, material) in choice["materials"].as_array().unwrap().iter().enumerate() {
        let tried = material["tried"].as_array().unwrap();
        let chosen = &tried[material["chosen"].as_u64().unwrap() as usize];
        assert_eq!(chosen["verdict"], "holds");
        assert_eq!(manifest["materials"][i]["model"], chosen["model"]);
        let reason = material["reason"].as_str().unwrap();
        assert!(said.contains(reason) && reason.contains("the cheapest that holds"), "{said}");
        // Nothing cheaper holds.
        assert!(tried.iter().all(|t| t["verdict"] != "holds" || t == chosen));
        if let Some(next) = material["next_cheaper"].as_u64() {
            assert!(tried[next as usize]["cost"].as_f64() < chosen["cost"].as_f64());
            assert!(reason.contains("would have"), "{reason}");
        }
    }
    assert!(!workshop.path("a/shaders/full.wgsl").exists());
    let wgsl = workshop.text("a/shaders/baked.wgsl");
    let tables: Vec<&str> =
        manifest["tables"].as_array().unwrap().iter().map(|t| t["kind"].as_str().unwrap()).collect();
    for kind in ["fresnel", "distribution", "fgd", "escape", "film", "phase"] {
        assert_eq!(wgsl.contains(&format!("luthier_lookup_{kind}")), tables.contains(&kind), "{kind} {tables:?}");
    }
    assert_eq!(tables, ["fresnel"]);
    // The judge reads the materials again, and finds in the tables what is said of them.
    workshop.run(&["report", "--out", "a", "--no-device", "--pairs", "64"]).exits(0);
}

#[test]
fn what_nothing_holds_is_refused_or_said() {
    let workshop = shelf();
    workshop.edit("shelf.toml", |text| text.replace("max_rel = 0.3", "max_rel = 1e-4\n[target]\nmax_cost = 55"));
    let run = workshop.run(&["bake", "shelf.toml"]).fails(1, &["no model holds the budget"]);
    assert!(run.stderr.contains("metal: phong") && run.stderr.contains("comes nearest"), "{}", run.stderr);
    assert!(!workshop.path("out").exists());
    let run = workshop.run(&["bake", "shelf.toml", "--allow-miss"]).exits(0);
    assert!(run.stdout.contains("none holds; this comes nearest"), "{}", run.stdout);
    workshop.edit("shelf.toml", |text| text.replace("max_cost = 55", "max_cost = 2"));
    // A limit without a device is one of cycles on RDNA2; the device of a limit decides its unit.
    workshop.run(&["bake", "shelf.toml"]).fails(1, &["cycles on rdna2, more than 2 cycles"]);
    workshop.edit("shelf.toml", |text| text.replace("max_cost = 2", "max_cost = 0.1\ndevice = \"h100\""));
    workshop.run(&["bake", "shelf.toml"]).fails(1, &["ps on h100, more than 0.1 ps"]);
    workshop.run(&["bake", "shelf.toml", "--device", "gcn5"]).fails(1, &["cycles on gcn5, more than 0 cycles"]);
}

/// The answer names the device of its costs, in the text and in the manifest, and devices that order candidates otherwise.
#[test]
fn the_device_of_the_costs_is_named() {
    let workshop = shelf();
    let run = workshop.run(&["bake", "shelf.toml", "--out", "a"]).exits(0);
    assert!(run.stdout.contains("costs: picoseconds an evaluation on h100 (NVIDIA H100"), "{}", run.stdout);
    let of = |folder: &str| workshop.json(&format!("{folder}/manifest.json"))["choice"].clone();
    let [name, unit] = ["name", "unit"].map(|key| of("a")["device"][key].clone());
    assert_eq!((name, unit), ("h100".into(), "ps".into()));
    let run = workshop.run(&["bake", "shelf.toml", "--out", "b", "--device", "rdna2"]).exits(0);
    assert!(run.stdout.contains("costs: cycles per wave of 64 on rdna2 (navi21)"), "{}", run.stdout);
    assert_eq!(of("b")["device"]["unit"], "cycles");
    assert_eq!(of("b")["neighbours_differ"], 0.0);
    // A file of costs is a device, too.
    let costs = luthier_cost::DeviceCost::shipped("h100").unwrap();
    let toy = luthier_cost::DeviceCost { name: "toy".to_owned(), ..costs };
    workshop.write("toy.json", toy.to_json().unwrap());
    let run = workshop.run(&["bake", "shelf.toml", "--out", "c", "--costs", "toy.json"]).exits(0);
    assert!(run.stdout.contains("an evaluation on toy"), "{}", run.stdout);
    assert_eq!(models(&of("c")), models(&of("a")));
    workshop.write("toy.json", "{}");
    workshop.run(&["bake", "shelf.toml", "--costs", "toy.json"]).fails(1, &["toy.json", "JSON"]);
    workshop.run(&["bake", "shelf.toml", "--device", "abacus"]).fails(2, &["abacus"]);
    // Of materials the device decides the layout of rows alone.
    workshop.run(&["bake", "parts/clay.toml", "--device", "h100"]).exits(0);
}

/// Coats over gold and over paint, which `lobes` alone holds.
fn coats() -> Workshop {
    let gold = "schema = 1\nname = \"gold\"\n\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n\n[[layer]]\ntype = \"conductor\"\n\
                ior = \"au\"\nalpha = 0.3\n";
    let glaze = "schema = 1\nname = \"glaze\"\n\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n\n[[layer]]\ntype = \"diffuse\"\n\
                 albedo = [0.6, 0.2, 0.1]\n";
    let scene = SCENE.replace("max_rel = 0.3", "max_rel = 0.15");
    Workshop::with(&[("parts/metal.toml", gold), ("parts/clay.toml", glaze), ("shelf.toml", &scene)])
}

/// A scene takes the cheapest form of `lobes` that holds for each material.
#[test]
fn forms_of_lobes_are_candidates() {
    let workshop = coats();
    let run = workshop.run(&["bake", "shelf.toml", "--out", "a"]).exits(0);
    let manifest = workshop.json("a/manifest.json");
    let forms = |manifest: &Value| -> Vec<String> {
        let of = |m: &Value| m["tried"][m["chosen"].as_u64().unwrap() as usize]["lobes"].clone();
        let materials = manifest["choice"]["materials"].as_array().unwrap();
        materials.iter().map(|m| of(m).as_str().unwrap_or("-").to_owned()).collect()
    };
    assert_eq!(forms(&manifest), ["one-width", "no-lobe"], "{}", run.stdout);
    assert!(run.stdout.contains("gold: lobes with one lobe of one width for "), "{}", run.stdout);
    let lobes = |i: usize| manifest["materials"][i]["constants"]["lobes"].clone();
    assert_eq!([0, 1].map(|i| lobes(i)["lobes"].as_u64()), [Some(1), Some(0)]);
    // A limit of a material on the errors of its rows is searched as it stands.
    workshop.edit("parts/metal.toml", |text| format!("{text}\n[budget]\nmax_lobe_err = 0.1\n"));
    workshop.run(&["bake", "shelf.toml", "--out", "b", "-q", "--allow-miss"]).exits(0);
    let manifest = workshop.json("b/manifest.json");
    assert_eq!(forms(&manifest), ["-", "-"]);
    assert!(manifest["searches"].to_string().contains("max_lobe_err"), "{}", manifest["searches"]);
}

/// Shaders read rows of one width beside rows without a lobe as the f64 does.
#[cfg(feature = "gpu")]
#[test]
fn forms_of_lobes_in_one_set_are_read_as_they_are() {
    let workshop = coats();
    workshop.run(&["bake", "shelf.toml", "-q"]).exits(0);
    let run = workshop.run(&["report", "--pairs", "256"]);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    let report = workshop.json("out/report/report.json");
    let error = report["max_arithmetic_error"].as_f64().unwrap();
    assert!(error > 0.0 && error < 1e-5, "{error}");
}

/// Where all neighbours differ, a scene takes no more models than where none does, and its cost has those of the neighbours.
#[test]
fn neighbours_that_differ_draw_models_together() {
    let workshop = shelf();
    let choice = |share: &str| {
        let text = SCENE.replace("footprint_deg = 1\n", &format!("footprint_deg = 1\nneighbours_differ = {share}\n"));
        workshop.write("shelf.toml", text.replace("max_rel = 0.3", "max_rel = 1.5"));
        workshop.run(&["bake", "shelf.toml", "--json", "--no-fit"]).exits(0).json()["choice"].clone()
    };
    let [none, all] = ["0", "1"].map(choice);
    let distinct = |choice: &Value| models(choice).into_iter().collect::<std::collections::BTreeSet<_>>().len();
    assert!(distinct(&all) <= distinct(&none), "{:?} {:?}", models(&none), models(&all));
    assert!(all["cost"].as_f64() >= none["cost"].as_f64(), "{} {}", none["cost"], all["cost"]);
    assert_eq!(all["neighbours_differ"], 1.0);
}

/// Where there is no room for tables the form without them is taken, if its error is small enough.
#[test]
fn a_target_without_textures_gets_the_full_form() {
    let workshop = shelf();
    workshop.edit("shelf.toml", |text| format!("{text}\n[target]\nformats = []\n"));
    workshop.run(&["bake", "shelf.toml", "-q"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    assert_eq!(manifest["choice"]["form"], "full");
    assert_eq!(manifest["tables"].as_array().map(Vec::len), Some(0));
    assert_eq!(manifest["bindings"].as_array().map(Vec::len), Some(1));
    assert!(workshop.path("out/shaders/full.wgsl").exists() && !workshop.path("out/shaders/baked.wgsl").exists());
    workshop.edit("shelf.toml", |text| text.replace("formats = []", "max_bytes = 1"));
    workshop.run(&["bake", "shelf.toml", "-q"]).exits(0);
    assert_eq!(workshop.json("out/manifest.json")["choice"]["form"], "full");
}

/// Formats that the target lacks are not searched, and the tables that ship have one that it has.
#[test]
fn a_target_keeps_the_search_to_its_formats() {
    let workshop = shelf();
    let formats = |workshop: &Workshop| -> Vec<String> {
        workshop.run(&["bake", "shelf.toml", "-q"]).exits(0);
        let manifest = workshop.json("out/manifest.json");
        assert_eq!(manifest["choice"]["form"], "baked");
        let tables = manifest["tables"].as_array().unwrap();
        tables.iter().map(|table| table["format"].as_str().unwrap().to_owned()).collect()
    };
    let free = formats(&workshop);
    assert!(!free.is_empty() && free.iter().all(|format| format != "rgba16float"), "{free:?}");
    workshop.edit("shelf.toml", |text| format!("{text}\n[target]\nformats = [\"rgba16float\"]\n"));
    assert_eq!(formats(&workshop), vec!["rgba16float"; free.len()]);
}

#[test]
fn mistakes_name_the_place_and_a_way_out() {
    let workshop = shelf();
    workshop.edit("shelf.toml", |text| text.replace("from_eye_deg", "from_eye"));
    let run = workshop.run(&["bake", "shelf.toml"]).exits(1);
    run.says(&["shelf.toml:12:1", "unknown key `from_eye`", "did you mean `from_eye_deg`?", "nothing was written"]);
    workshop.write("shelf.toml", SCENE.replace("metal.toml", "mettle.toml"));
    workshop.run(&["bake", "shelf.toml"]).exits(1).says(&["mettle.toml", "no such file", "shelf.toml:"]);
    workshop.write("shelf.toml", SCENE);
    workshop.run(&["bake", "shelf.toml", "parts/clay.toml"]).fails(2, &["is a scene"]);
    workshop.run(&["bake", "shelf.toml", "--model", "elek"]).fails(2, &["--model"]);
    workshop.run(&["bake", "parts/clay.toml", "--allow-miss"]).fails(2, &["for scenes"]);
    let schema = workshop.run(&["schema", "--scene"]).exits(0).json();
    assert!(schema["properties"]["light"].is_object() && schema["properties"]["layer"].is_null());
}

/// The scenes that ship hold their budgets.
#[test]
fn the_jeweller_s_window_holds() {
    let workshop = Workshop::new();
    let scene = root().join("materials/scenes/jewellery.toml");
    let run = workshop.run(&["bake", scene.to_str().unwrap(), "--json"]).exits(0);
    let choice = &run.json()["choice"];
    assert_eq!(models(choice).len(), 3);
    for scene in material_files("materials/scenes") {
        let text = std::fs::read_to_string(&scene).unwrap();
        assert!(luthier_material::parse_scene("scene.toml", &text).is_ok(), "{}", scene.display());
    }
}

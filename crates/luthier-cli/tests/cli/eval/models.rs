//! `models`, and that `eval` reaches each.

use luthier_workshop::material_texts::filmed;
use serde_json::Value;

use crate::workshop::Workshop;

/// Names in the order of the list.
fn listed(workshop: &Workshop) -> Vec<Value> {
    workshop.run(&["models", "--json"]).exits(0).json().as_array().unwrap().clone()
}

/// All that the papers' models are made of, and what judges them.
const NEEDED: [&str; 46] = [
    "microfacet",
    "microfacet-beckmann",
    "microfacet-ggx",
    "microfacet-blinn-phong",
    "microfacet-abc",
    "microfacet-sgd",
    "microfacet-implicit",
    "microfacet-v-cavity",
    "microfacet-kelemen",
    "microfacet-schlick-smith",
    "microfacet-smith-separable",
    "microfacet-schlick",
    "microfacet-complex-f0",
    "microfacet-lazanyi",
    "microfacet-f82",
    "microfacet-transfer-matrix",
    "microfacet-granier-film",
    "microfacet-belcour-barla",
    "lambert",
    "oren-nayar",
    "phong",
    "weidlich-wilkie",
    "weidlich-wilkie-directions",
    "weidlich-wilkie-facet",
    "weidlich-wilkie-corrected",
    "elek",
    "granier-heidrich",
    "belcour",
    "belcour-half-vector",
    "yamaguchi",
    "yamaguchi-half-vector",
    "fluorescence",
    "flakes",
    "patina",
    "heterogeneous",
    "heterogeneous-glitter",
    "heterogeneous-switch",
    "density-cosine",
    "density-visible-normals",
    "density-mixture",
    "density-layers-local",
    "density-layers-global",
    "random-walk",
    "layered-mc",
    "layered-mc-one-facet",
    "closed-form",
];

#[test]
fn the_list_names_every_model() {
    let workshop = Workshop::new();
    let models = listed(&workshop);
    let names: Vec<&str> = models.iter().map(|model| model["name"].as_str().unwrap()).collect();
    for needed in NEEDED {
        assert!(names.contains(&needed), "{needed}");
    }
    let text = workshop.run(&["models"]).exits(0).stdout;
    let is_name = |line: &&str| line.starts_with("  ") && !line.starts_with("   ");
    assert_eq!(text.lines().filter(is_name).map(str::trim).collect::<Vec<_>>(), names);
    let headings = text.lines().filter(|line| line.ends_with(':') && !line.starts_with(' ')).count();
    assert_eq!(headings, 5, "{text}");
    for model in &models {
        for key in ["kind", "source", "domain", "leaves_out"] {
            assert!(model[key].as_str().is_some_and(|text| !text.is_empty()), "{}: {key}", model["name"]);
        }
        assert!(model["reciprocal"].is_boolean() && model["conserves_energy"].is_boolean(), "{model}");
    }
    let patina = models.iter().find(|model| model["name"] == "patina").unwrap();
    assert_eq!(patina["inputs"], serde_json::json!(["extent", "map"]));
    assert!(text.contains("takes:      --extent, --map"), "{text}");
}

/// A film on a rough coat on a diffuse base: each model says something finite of it, most of them more than zero.
#[test]
fn every_listed_model_is_reached() {
    let workshop = Workshop::with(&[("f.toml", &filmed("f"))]);
    for model in listed(&workshop) {
        let name = model["name"].as_str().unwrap();
        let args =
            ["eval", "f.toml", "--model", name, "--wi", "30,0", "--wo", "45,180", "--json", "--wavelength", "550"];
        let json = workshop.run(&args).exits(0).json();
        assert_eq!((&json["model"], &json["material"]), (&model["name"], &Value::from("f")));
        let value = json["values"][0]["value"][0].as_f64().unwrap();
        assert!(value > 0.0 && value.is_finite(), "{name}: {value}");
        // Colour, of the models that take a moment for it.
        if model["kind"] == "surface" || model["kind"] == "density" {
            let args = [&args[..8], &["--rgb", "--json"]].concat();
            let json = workshop.run(&args).exits(0).json();
            assert_eq!(json["color"], "spectral");
            for channel in json["values"][0]["value"].as_array().unwrap() {
                assert!(channel.as_f64().is_some_and(f64::is_finite), "{name}: {json}");
            }
        }
    }
}

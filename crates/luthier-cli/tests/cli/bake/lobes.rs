//! Bakes with the model `lobes`.

use luthier_workshop::material_texts::lacquer;

use crate::workshop::Workshop;

#[test]
fn lobes_have_a_tile_a_record_and_one_form() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a"))]);
    workshop.run(&["bake", "a.toml", "-q", "--model", "lobes", "--target", "wgsl"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let material = &manifest["materials"][0];
    assert_eq!(material["layers"][0]["lobes_tile"], 0);
    assert!(material["layers"][1].get("lobes_tile").is_none(), "{material}");
    assert!(material["constants"]["lobes"]["index"].as_f64().unwrap() >= 1.0, "{material}");
    let forms: Vec<&str> = manifest["shaders"].as_array().unwrap().iter().filter_map(|s| s["form"].as_str()).collect();
    assert_eq!(forms, ["baked"]);
    let constant = workshop.run(&["shader", "a.toml", "--model", "lobes", "--constant"]).exits(0).stdout;
    for number in material["constants"]["lobes"]["falloff"].as_array().unwrap() {
        let number = format!("{:?}", number.as_f64().unwrap() as f32);
        assert!(constant.contains(&number), "the shader has the numbers of the fit: {number} {constant}");
    }
    let before = workshop.text("out/manifest.json");
    let refused = ["bake", "a.toml", "--model", "lobes", "--form", "full"];
    workshop.run(&refused).fails(1, &["`a` has no `full` shader", "ask for the `baked` form"]);
    assert_eq!(workshop.text("out/manifest.json"), before);
}

/// Oracle: paths of the reference with other random numbers, four standard errors and what the model itself is off.
#[test]
fn the_albedo_of_lobes_is_that_of_the_reference() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a"))]);
    let albedo = |model: &[&str]| {
        let args = ["eval", "a.toml", "--albedo", "--angles", "20,65", "--wavelength", "645", "--json", "--model"];
        let json = workshop.run(&[&args[..], model].concat()).exits(0).json();
        [0, 1].map(|i: usize| [&json["albedo"][i]["albedo"], &json["albedo"][i]["error"]].map(|v| v.as_f64().unwrap()))
    };
    let found = albedo(&["lobes"]);
    let expected = albedo(&["layered-mc", "--samples", "60000"]);
    for ([found, _], [expected, sigma]) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 4.0 * sigma + 2e-3 && sigma < 2e-3, "{found} {expected} {sigma}");
    }
}

//! Warnings about the energy of models, and the light that defaults return.

use std::path::Path;

use luthier::Source;
use luthier::refusals::{Returned, of_energy, returned};
use luthier_manifest::ShadingModel;
use luthier_material::Material;

const COAT: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\n";
const GOLD: &str = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\n";
const WHITE: &str = "[[layer]]\ntype = \"conductor\"\nf0 = 1\nroughness = 0.7\n";
const COPPER: &str =
    "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.955, 0.638, 0.538]\nmetallic = 1\nroughness = 0.4\n";
const PAINTED: &str = "maps = { base_color = \"c.png\", metallic = \"m.png\" }\n";

fn material(body: &str, model: Option<&str>) -> Material {
    let bake = model.map_or_else(String::new, |model| format!("[bake]\nmodel = \"{model}\"\n"));
    let source = Source::of_text(Path::new("x.toml"), format!("schema = 1\nname = \"x\"\n{body}{bake}"));
    source.parsed.unwrap_or_else(|errors| panic!("{}", errors[0].message)).material
}

fn most(found: &[Returned]) -> f64 {
    found.iter().map(|found| found.model).fold(0.0, f64::max)
}

/// Oracle: a lossless metal returns all light, whatever its slopes. The figure of the model is that of `eval --albedo`.
#[test]
fn a_model_that_loses_light_is_told() {
    let named = material(WHITE, Some("elek"));
    let doubt = of_energy(&named, None).unwrap();
    assert!(
        doubt.message.contains("is off by 0.29: it returns 0.71 of the light, seen at 0 degrees"),
        "{}",
        doubt.message
    );
    assert!(doubt.message.contains("returns 1.00") && doubt.hint.unwrap().contains("leave the model out"));
    let open = material(WHITE, None);
    assert_eq!((open.model(), of_energy(&open, None)), (ShadingModel::Lobes, None));
    let told = of_energy(&open, Some(ShadingModel::Elek)).unwrap();
    assert_eq!(told.message, doubt.message);
    // One bounce of a smooth metal is all its light.
    for model in [None, Some("elek")] {
        assert_eq!(of_energy(&material(&(GOLD.to_owned() + "alpha = 0.005\n"), model), None), None);
    }
}

/// A coat over engines' copper with textures: white texels make copper of it.
#[test]
fn more_light_than_falls_in_is_told_and_no_default() {
    let body = COAT.to_owned() + "alpha = 0.05\n" + COPPER + PAINTED;
    let named = material(&body, Some("elek"));
    let gains = most(&returned(&named, ShadingModel::Elek));
    let message = of_energy(&named, None).unwrap().message;
    assert!(gains > 1.5 && message.contains(&format!("returns {gains:.2} times the light that falls in")), "{message}");
    let open = material(&body, None);
    assert_eq!((open.model(), of_energy(&open, None)), (ShadingModel::Lobes, None));
    let found = returned(&open, ShadingModel::Belcour);
    assert!(most(&found) <= 1.0, "{found:?}");
    // The simulation is that of copper below the coat, which no engine's key says.
    let copper = COAT.to_owned()
        + "alpha = 0.05\n[[layer]]\ntype = \"conductor\"\nf0 = [0.955, 0.638, 0.538]\nroughness = 0.4\n";
    let plain = returned(&material(&copper, None), ShadingModel::Belcour);
    for (textured, plain) in found.iter().zip(&plain) {
        let error = (textured.simulated.unwrap() - plain.simulated.unwrap()).abs();
        assert!(error < 0.02 && textured.angle_deg == plain.angle_deg, "{textured:?} {plain:?}");
    }
}

/// Whatever keeps a file from `lobes`: no default returns more than falls in.
#[test]
fn no_default_gains_light() {
    let maps = |maps: &str| format!("[layer.maps]\n{maps}\n");
    let (rough, slab) = ("alpha = 0.3\n", "alpha = 0.1\nthickness_um = 1\nabsorption_per_um = 0.2\n");
    let metal = GOLD.to_owned() + rough;
    for body in [
        COAT.to_owned() + slab + &maps("roughness = \"r.png\"\nthickness = \"t.png\"") + &metal,
        COAT.to_owned() + rough + &metal + &maps("bumps = \"b.png\""),
        COAT.to_owned() + rough + &metal + &maps("alpha = \"a.png\""),
        COAT.to_owned() + "alpha = 0.01\n" + GOLD + "alpha_x = 0.1\nalpha_y = 0.4\n" + &maps("tangent = \"t.png\""),
        COAT.to_owned() + "alpha = 0.01\n" + COPPER + PAINTED,
        COPPER.to_owned() + PAINTED,
    ] {
        let open = material(&body, None);
        let found = returned(&open, open.model());
        assert!(most(&found) <= 1.02, "{body}: {} {found:?}", open.model());
    }
}

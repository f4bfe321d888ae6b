//! Surfaces that reflect by Schlick's formula: from files to the device, in every model, and by hand.

use luthier::{Bake, MemoryStore};
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_manifest::{FunctionGroup, ShadingModel};
use luthier_material::{Material, parse};
use luthier_optics::color::Color;

use super::draws;
use super::twin::{compare_sets, gpu};
use crate::workshop::Workshop;

const COPPER: &str = "[[layer]]\ntype = \"conductor\"\nf0 = [0.955, 0.638, 0.538]\n";

/// Copper; the surface of engines in the middle and as a dielectric; a coat with an F0 over a brushed metal; an F0 below an index.
fn materials(model: &str) -> Vec<Material> {
    let engine = |metallic: f64, surface: &str| {
        format!(
            "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.955, 0.638, 0.538]\nmetallic = {metallic}\n{surface}\n"
        )
    };
    let bodies = [
        ("copper", format!("{COPPER}roughness = 0.5\n")),
        ("middle", engine(0.5, "roughness = 0.4")),
        ("plastic", engine(0.0, "roughness = 0.3\nsigma = 0.3")),
        (
            "coated",
            "[[layer]]\ntype = \"dielectric\"\nf0 = [0.04, 0.06, 0.1]\nroughness = 0.4\nthickness_um = 10\n\
             absorption_per_um = [0.01, 0.02, 0.03]\n"
                .to_owned()
                + COPPER
                + "alpha_x = 0.2\nalpha_y = 0.4\nrotation_deg = 30\ndistribution = \"beckmann\"\n",
        ),
        (
            "below",
            "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nroughness = 0.4\n[[layer]]\ntype = \"dielectric\"\nf0 = 0.02\n\
             ior = 1.8\nroughness = 0.6\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.6\n"
                .to_owned(),
        ),
        ("indexed", "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 0.5\n".to_owned()),
    ];
    let material = |(name, body): (&str, String)| {
        let text = format!("schema = 1\nname = \"{name}\"\n{body}");
        let mut material = parse(name, &text, &|_| Err(std::io::Error::other("none"))).unwrap().material;
        material.bake.model = ShadingModel::from_name(model);
        material
    };
    bodies.into_iter().map(material).collect()
}

/// Each surface in a set of its own and all in one, with an index among them: the shaders differ.
#[test]
fn the_device_agrees_with_f64_in_every_model() {
    let Some(gpu) = gpu() else { return };
    let three = [645.0, 525.0, 445.0];
    for model in ["elek", "weidlich-wilkie", "granier-heidrich", "phong", "microfacet"] {
        // Phong's coefficients are in the material's own colour.
        let color = if model == "phong" { Color::Spectral } else { Color::ThreeWavelengths(three) };
        compare_sets(&gpu, model, &materials(model), |material| {
            Shaded::new(model.parse().unwrap(), &material.stack, three, color, &Place::NONE).unwrap()
        });
    }
}

/// Shaders of both forms with all functions, of every model: naga has to take them.
#[test]
fn every_model_has_its_shaders() {
    let store = MemoryStore::default();
    for model in ShadingModel::NAMES {
        let functions = FunctionGroup::NAMES.iter().filter_map(|name| FunctionGroup::from_name(name)).collect();
        let bake = Bake { refuses: false, functions, ..Bake::wgsl(&[]) };
        let materials = materials(model);
        // Energies and simulations of rough layers are slow.
        let some = if ["belcour", "yamaguchi", "lobes"].contains(model) { &materials[1..2] } else { &materials };
        bake.package(some, &store).unwrap();
    }
}

/// Directions are drawn as the density says: of beams, which take the F0 in place of the index, and of facets.
#[test]
fn directions_are_drawn_as_the_density_says() {
    for model in ["granier-heidrich", "elek"] {
        let materials = &materials(model)[..4];
        let Some(scene) = draws::scene(materials) else { return };
        let mut found = draws::Found::default();
        for (number, material) in (0..).zip(materials) {
            for (seed, theta) in (0..).zip(draws::EYES) {
                let what = format!("{model} {} {theta}", material.name);
                draws::judge(&scene, number, theta, 1000 + u64::from(number) * 8 + seed, &what, &mut found);
            }
        }
        assert!(found.faults.is_empty(), "{}", found.faults.join("\n"));
    }
}

/// The command, by hand: at the mirror direction of 60 degrees the values of a surface of one facet are as 1/32 more of the light than F0,
/// and at one wavelength those of the channel nearest to it.
#[test]
fn the_command_reflects_the_formula() {
    let workshop = Workshop::new();
    let file = |f0: &str| {
        workshop.write(
            "metal.toml",
            format!("schema = 1\nname = \"metal\"\n[[layer]]\ntype = \"conductor\"\nf0 = {f0}\nalpha = 0.3\n"),
        );
    };
    let base = ["eval", "metal.toml", "--model", "microfacet", "--wi", "60,0", "--wo", "60,180", "--json"];
    let value = |more: &[&str], c: usize| {
        let json = workshop.run(&[&base, more].concat()).exits(0).json();
        json["values"][0]["value"][c].as_f64().unwrap()
    };
    file("1");
    let white = value(&[], 0);
    file("[0.955, 0.638, 0.538]");
    for (c, (f0, nm)) in [(0.955, "700"), (0.638, "550"), (0.538, "400")].into_iter().enumerate() {
        let expected = f0 + (1.0 - f0) / 32.0;
        for found in [value(&[], c), value(&["--three-wavelengths"], c), value(&["--wavelength", nm], 0)] {
            assert!((found / white - expected).abs() < 1e-5, "{f0}: {found} {white}");
        }
    }
    workshop.run(&["eval", "metal.toml", "--polarised"]).fails(1, &["f0", "polarisation"]);
}

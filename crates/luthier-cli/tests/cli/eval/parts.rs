//! Parts of a model that a file chooses, on the device: maskings and reflectances against their f64 twins, and drawn directions.

use glam::DVec3;
use luthier::{Bake, MemoryStore};
use luthier_export::Shader;
use luthier_layers::models::parts::Parts;
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_manifest::{BeamsRecord, ColorMode, Form, Masking, Reflectance, ShadingModel};
use luthier_material::{Material, parse};
use luthier_optics::color::Color;
use luthier_shader::{MaterialSet, Target, emit};

use super::draws::{Found, judge, scene};
use super::twin::{error, gpu, pairs, wide};

/// Largest difference between a device and its twin: reflectances as f32, and D in closed form.
const TOLERANCE: f64 = 2e-5;

const CHROMIUM: &str = "[[layer]]\ntype = \"conductor\"\nior = { n = [3.2, 3.18, 2.9], k = [4.2, 4.41, 4.0], wavelengths_nm = [400, 550, 700] }\n";
const COPPER: &str = "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\n";
const COAT: &str =
    "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nthickness_um = 10\nabsorption_per_um = [0.01, 0.02, 0.03]\n";
const BRUSHED: &str = "alpha_x = 0.4\nalpha_y = 0.15\nrotation_deg = 20\ndistribution = \"beckmann\"\n";

fn material(name: &str, layers: &str, bake: &str) -> Material {
    let text = format!("schema = 1\nname = \"{name}\"\n{layers}\n[bake]\n{bake}\n");
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    parse(&format!("{name}.toml"), &text, &no_files).unwrap_or_else(|errors| panic!("{errors:?}: {text}")).material
}

/// A metal, smooth and brushed, for each masking.
fn masked() -> Vec<Material> {
    let one = |masking: &Masking| {
        let bake = |reflectance: &str| {
            format!("model = \"microfacet\"\nmasking = \"{}\"\nreflectance = \"{reflectance}\"", masking.name())
        };
        let isotropic = format!("{CHROMIUM}alpha = 0.3\n");
        [
            material(&format!("{}-round", masking.name()), &isotropic, &bake("exact")),
            material(&format!("{}-brushed", masking.name()), &format!("{COPPER}{BRUSHED}"), &bake("lazanyi")),
        ]
    };
    Masking::ALL.iter().flat_map(one).collect()
}

/// Metals and coats of each model, for each reflectance, in both colours; films where they are known.
fn reflecting() -> Vec<Material> {
    let mut materials = Vec::new();
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie, ShadingModel::Microfacet] {
        for reflectance in [Reflectance::Exact, Reflectance::Approximate, Reflectance::Lazanyi] {
            for color in ColorMode::NAMES {
                let film = if reflectance == Reflectance::Exact {
                    "[[layer]]\ntype = \"thin-film\"\nior = 1.35\nthickness_nm = 300\n"
                } else {
                    ""
                };
                let layers = format!("{COAT}roughness = 0.5\n{film}{COPPER}roughness = 0.6\n");
                let (reflectance, model) = (reflectance.name(), model.name());
                let bake = format!("model = \"{model}\"\nreflectance = \"{reflectance}\"\ncolor = \"{color}\"");
                materials.push(material(&format!("{model}-{reflectance}-{color}"), &layers, &bake));
            }
        }
    }
    materials
}

fn of_beams(parts: Parts, beams: &BeamsRecord) -> Parts {
    let weights = [beams.specular_weight, beams.diffuse_weight];
    parts.with_beams(beams.inner_alpha_ratio, weights, beams.inner_normal, beams.lobe_height)
}

fn parts(material: &Material) -> (Parts, Reflectance) {
    let (masking, reflectance) =
        (material.bake.masking.unwrap_or_default(), material.bake.reflectance.unwrap_or_default());
    let diffuse_term = material.bake.diffuse_term.unwrap_or_default();
    let path = material.bake.path_parts(material.model());
    let parts = Parts { masking, reflectance, path, diffuse_term, ..Parts::PLAIN };
    (material.beams().map_or(parts, |beams| of_beams(parts, &beams)), reflectance)
}

/// Compares a set in both forms, D in closed form; what is read from rows has the errors of rows, and is left out.
fn compare(materials: &[Material], worst: &mut f64) {
    let Some(gpu) = gpu() else { return };
    let pairs = pairs();
    let mut package = Bake::wgsl(&[Form::Baked, Form::Full]).package(materials, &MemoryStore::default()).unwrap();
    let set = MaterialSet::from_manifest(&package.manifest).with_closed_distribution();
    let baked = emit(&set, Form::Baked, Target::Wgsl).unwrap();
    let full = package.wgsl(Form::Full).unwrap().to_owned();
    package.shaders = vec![Shader::wgsl(Form::Full, full), Shader::wgsl(Form::Baked, baked)];
    for form in [Form::Full, Form::Baked] {
        let scene = gpu.scene(&package, form).unwrap();
        for (number, material) in (0..).zip(materials) {
            let (parts, reflectance) = parts(material);
            if form == Form::Baked && reflectance == Reflectance::Table {
                continue;
            }
            let wavelengths_nm = material.bake.wavelengths_nm();
            let is_spectral = reflectance.is_fitted() && material.bake.color != Some(ColorMode::ThreeWavelengths);
            let color = if is_spectral { Color::Spectral } else { Color::ThreeWavelengths(wavelengths_nm) };
            let model = material.model().name();
            let stack = material.reflecting_stack();
            let twin =
                Shaded::with(model.parse().unwrap(), &stack, wavelengths_nm, color, &Place::NONE, parts).unwrap();
            let found = scene.evaluate(number, &pairs).unwrap();
            let mut most: f64 = 0.0;
            for (&(wi, wo), found) in pairs.iter().zip(found) {
                let expected: [f64; 3] = twin.eval(wide(wi), wide(wo));
                let error = error(found, expected);
                assert!(error < TOLERANCE, "{form} {}: {wi:?} {wo:?}: {found:?}, {expected:?}", material.name);
                most = most.max(error);
            }
            eprintln!("{form} {}: at most {most:.1e}", material.name);
            *worst = worst.max(most);
        }
    }
}

#[test]
fn maskings_of_files_are_those_of_their_twins() {
    let (materials, mut worst) = (masked(), 0.0);
    // Side by side with the default and with rows of a table, and each alone.
    let plain = material("plain", &format!("{COAT}roughness = 0.5\n{COPPER}roughness = 0.3\n"), "model = \"elek\"");
    compare(&[materials.clone(), vec![plain]].concat(), &mut worst);
    materials.iter().for_each(|material| compare(std::slice::from_ref(material), &mut worst));
    eprintln!("maskings: at most {worst:.1e}");
}

#[test]
fn reflectances_of_files_are_those_of_their_twins() {
    let (materials, mut worst) = (reflecting(), 0.0);
    let plain = material("plain", &format!("{COAT}roughness = 0.5\n{COPPER}roughness = 0.3\n"), "model = \"elek\"");
    compare(&[materials.clone(), vec![plain]].concat(), &mut worst);
    // Sets of one source of reflectances, and of two curves.
    let fitted = |material: &&Material| material.bake.reflectance.is_some_and(Reflectance::is_fitted);
    compare(&materials.iter().filter(fitted).cloned().collect::<Vec<_>>(), &mut worst);
    materials.iter().for_each(|material| compare(std::slice::from_ref(material), &mut worst));
    eprintln!("reflectances: at most {worst:.1e}");
}

/// Coats over metals and bases of both models, exact and by a curve, with a choice of how light passes.
fn passing(choice: &str) -> Vec<Material> {
    let base = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.3]\nsigma = 0.3\n";
    let metal = format!("{COPPER}{BRUSHED}");
    let mut materials = Vec::new();
    for model in ["elek", "weidlich-wilkie"] {
        for (name, below) in [("metal", metal.as_str()), ("base", base)] {
            for reflectance in ["exact", "lazanyi"] {
                let layers =
                    format!("{COAT}alpha = 0.5\n[[layer]]\ntype = \"dielectric\"\nior = 2.4\nalpha = 0.3\n{below}");
                let bake = format!("model = \"{model}\"\nreflectance = \"{reflectance}\"\n{choice}");
                materials.push(material(&format!("{model}-{name}-{reflectance}"), &layers, &bake));
            }
        }
    }
    materials
}

#[test]
fn what_is_not_reflected_inside_is_that_of_the_twin() {
    let (materials, mut worst) = (passing("internal_reflection = \"none\""), 0.0);
    let layers = format!("{COAT}roughness = 0.5\n{COPPER}roughness = 0.3\n");
    let plain = material("plain", &layers, "model = \"weidlich-wilkie\"\nreflectance = \"exact\"");
    compare(&[materials.clone(), vec![plain.clone()], masked()].concat(), &mut worst);
    materials.iter().for_each(|material| compare(std::slice::from_ref(material), &mut worst));
    eprintln!("internal reflection: at most {worst:.1e}");
    // Light of a fluorescent base and behind flakes goes the same ways.
    let (wi, wo) = (DVec3::new(0.8, 0.1, 0.4).normalize(), DVec3::new(-0.6, 0.2, 0.5).normalize());
    let nm = plain.bake.wavelengths_nm();
    let value = |parts| {
        let color = Color::ThreeWavelengths(nm);
        Shaded::with(ShadingModel::WeidlichWilkie, &plain.stack, nm, color, &Place::NONE, parts).unwrap().eval(wi, wo)
            [1]
    };
    let (facets, none) = (value(Parts::PLAIN), value(parts(&materials[0]).0));
    assert!(none > 1.01 * facets, "{none} {facets}");
}

/// Transmission at the directions' own angles, and lower interfaces as in air, beside each other and alone.
#[test]
fn ways_through_interfaces_are_those_of_the_twin() {
    let directions = passing("internal_reflection = \"directions\"");
    let in_air = passing("lower_reflectance = \"in-air\"");
    let both = passing("internal_reflection = \"directions\"\nlower_reflectance = \"in-air\"");
    let mut worst = 0.0;
    for set in [&directions, &in_air, &both] {
        compare(set, &mut worst);
        compare(&set[..1], &mut worst);
    }
    let named = |choice: &str, set: &[Material]| {
        set.iter().map(|one| Material { name: format!("{}-{choice}", one.name), ..one.clone() }).collect::<Vec<_>>()
    };
    let whole = passing("internal_reflection = \"none\"");
    compare(&[directions.clone(), named("air", &in_air), named("whole", &whole)].concat(), &mut worst);
    eprintln!("ways through interfaces: at most {worst:.1e}");
    let (wi, wo) = (DVec3::new(0.8, 0.1, 0.4).normalize(), DVec3::new(-0.6, 0.2, 0.5).normalize());
    let value = |material: &Material| {
        let nm = material.bake.wavelengths_nm();
        let (color, stack) = (Color::ThreeWavelengths(nm), material.reflecting_stack());
        let model = material.model().name();
        Shaded::with(model.parse().unwrap(), &stack, nm, color, &Place::NONE, parts(material).0).unwrap().eval(wi, wo)
            [1]
    };
    let plain = passing("");
    for i in 0..plain.len() {
        let values = [&plain, &directions, &in_air, &both].map(|set| value(&set[i]));
        for (a, b) in [(0, 1), (0, 2), (1, 3), (2, 3)] {
            assert!((values[a] / values[b] - 1.0).abs() > 1e-3, "{}: {values:?}", plain[i].name);
        }
    }
}

/// Light on lower interfaces by their own cosine, beside materials without the choice. By hand: at 65 degrees on an index of 1.5, cosines are in the
/// ratio 1.885; the light of a base stays.
#[test]
fn lower_cosines_are_those_of_the_twin() {
    let of_elek = |bake: &str| {
        let all = [COPPER, "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n"].map(|base| {
            let slab = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n";
            let name = if base == COPPER { "copper" } else { "paint" };
            let rough = if base == COPPER { "alpha = 0.4\n" } else { "" };
            material(
                &format!("{name}{}", bake.len()),
                &format!("{slab}{base}{rough}"),
                &format!("model = \"elek\"\nreflectance = \"exact\"\n{bake}"),
            )
        });
        all.to_vec()
    };
    let (plain, inside) = (of_elek(""), of_elek("lower_cosine = \"inside\""));
    let mut worst = 0.0;
    compare(&inside, &mut worst);
    compare(&[plain.clone(), inside.clone()].concat(), &mut worst);
    let both = of_elek("lower_cosine = \"inside\"\ninternal_reflection = \"directions\"");
    compare(&[both, plain.clone()].concat(), &mut worst);
    eprintln!("lower cosines: at most {worst:.1e}");
    let at = |theta_deg: f64| {
        let (sin, cos) = libm::sincos(theta_deg.to_radians());
        DVec3::new(sin, 0.0, cos)
    };
    let (wi, wo) = (at(65.0), at(-50.0));
    let value = |material: &Material, layers: usize| {
        let nm = material.bake.wavelengths_nm();
        let mut stack = material.stack.clone();
        stack.layers.truncate(layers);
        let color = Color::ThreeWavelengths(nm);
        Shaded::with(ShadingModel::Elek, &stack, nm, color, &Place::NONE, parts(material).0).unwrap().eval(wi, wo)[1]
    };
    let below = |set: &[Material], i: usize| value(&set[i], 2) - value(&set[i], 1);
    assert!((below(&inside, 0) / below(&plain, 0) - 1.885).abs() < 5e-4, "{}", below(&inside, 0) / below(&plain, 0));
    assert_eq!(below(&inside, 1), below(&plain, 1));
}

/// Choices of interfaces below the first, and of all, alone, beside each other and beside materials without them: the shader against the twin.
#[test]
fn lower_layers_are_those_of_the_twin() {
    let chosen = [
        "masking = \"kelemen\"",
        "lower_facets = \"phong\"",
        "lower_facets = \"blinn-phong\"\ninternal_reflection = \"directions\"",
        "diffuse_part = \"beside\"",
        "diffuse_part = \"beside\"\ninternal_reflection = \"directions\"",
    ];
    let (mut worst, mut all) = (0.0, passing(""));
    for (i, choice) in chosen.into_iter().enumerate() {
        let mut set = passing(choice);
        compare(&set, &mut worst);
        compare(&set[set.len() - 1..], &mut worst);
        set.iter_mut().for_each(|material| material.name.push_str(&format!("-{i}")));
        all.append(&mut set);
    }
    let of_course = |bake: &str| passing(bake).into_iter().filter(|material| material.name.starts_with("weidlich"));
    let rougher: Vec<Material> = of_course("lower_alpha = \"at-least-above\"").collect();
    compare(&rougher, &mut worst);
    let both = of_course("lower_alpha = \"at-least-above\"\nlower_facets = \"phong\"");
    for (i, set) in [rougher, both.collect()].into_iter().enumerate() {
        all.extend(set.into_iter().map(|one| Material { name: format!("{}-rougher-{i}", one.name), ..one }));
    }
    compare(&all, &mut worst);
    eprintln!("lower layers: at most {worst:.1e}");
}

/// Energies of level facets beside those of the table, in sets and alone.
#[test]
fn energies_of_level_facets_are_those_of_the_twin() {
    let mut materials = Vec::new();
    for model in ["belcour", "yamaguchi"] {
        for reflectance in ["exact", "approximate", "lazanyi"] {
            let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\nthickness_um = 1\nabsorption_per_um = [0.1, 0.3, 0.6]\n";
            let layers = format!("{coat}{COPPER}alpha_x = 0.3\nalpha_y = 0.1\n");
            let bake = format!("model = \"{model}\"\nreflectance = \"{reflectance}\"");
            materials.push(material(&format!("{model}-{reflectance}"), &layers, &bake));
        }
    }
    let mut worst = 0.0;
    compare(&materials, &mut worst);
    let plain = material(
        "plain",
        &format!("{COAT}alpha = 0.3\n{COPPER}alpha = 0.3\n"),
        "model = \"belcour\"\nfgd = { size = [12, 12] }",
    );
    let table = material("table", &format!("{COAT}alpha = 0.3\n{COPPER}alpha = 0.3\n"), "model = \"elek\"");
    compare(&[materials[0].clone(), materials[4].clone(), table], &mut worst);
    materials.iter().for_each(|material| compare(std::slice::from_ref(material), &mut worst));
    eprintln!("level facets: at most {worst:.1e}");
    // Beside a material that reads the table, the baked shader still computes these.
    let set = [materials[0].clone(), plain];
    let package = Bake::wgsl(&[Form::Baked]).package(&set, &MemoryStore::default()).unwrap();
    let entry = &package.manifest.materials[0];
    assert!(entry.layers.iter().all(|layer| layer.tiles[luthier_lut::TableKind::Fgd].is_none()));
    let Some(gpu) = gpu() else { return };
    let scene = gpu.scene(&package, Form::Baked).unwrap();
    let nm = set[0].bake.wavelengths_nm();
    let (parts, color) = (parts(&set[0]).0, Color::ThreeWavelengths(nm));
    let twin = Shaded::with(ShadingModel::Belcour, &set[0].stack, nm, color, &Place::NONE, parts).unwrap();
    for (&(wi, wo), found) in pairs().iter().zip(scene.evaluate(0, &pairs()).unwrap()) {
        let expected = twin.eval(wide(wi), wide(wo));
        assert!(error(found, expected) < TOLERANCE, "{wi:?} {wo:?}: {found:?}, {expected:?}");
    }
}

/// Bases beside the facets of the first interface, in sets with materials that add none. By hand: the values differ by `albedo cos / pi` of a Lambertian
/// base, whatever lies above it.
#[test]
fn added_bases_are_those_of_the_twin() {
    let one = |name: &str, layers: &str, bake: &str| {
        material(name, layers, &format!("model = \"microfacet\"\nreflectance = \"exact\"\n{bake}"))
    };
    let slab = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n";
    let matte = |sigma: f64| format!("[[layer]]\ntype = \"diffuse\"\nalbedo = [0.7, 0.4, 0.2]\nsigma = {sigma}\n");
    let (lambert, rough) = (format!("{slab}{}", matte(0.0)), format!("{slab}{}", matte(0.5)));
    let added = "diffuse_term = \"added\"";
    let set = [
        one("lambert", &lambert, added),
        one("rough", &rough, added),
        one("smith", &lambert, ""),
        one("cavities", &lambert, &format!("{added}\nmasking = \"v-cavity\"")),
        one("copper", &format!("{COPPER}alpha = 0.2\n"), added),
        one("base-alone", &matte(0.5), added),
    ];
    let mut worst = 0.0;
    compare(&set, &mut worst);
    set.iter().for_each(|material| compare(std::slice::from_ref(material), &mut worst));
    eprintln!("added bases: at most {worst:.1e}");
    let value = |material: &Material, wi: DVec3, wo: DVec3| {
        let nm = material.bake.wavelengths_nm();
        let (parts, color) = (parts(material).0, Color::ThreeWavelengths(nm));
        Shaded::with(ShadingModel::Microfacet, &material.stack, nm, color, &Place::NONE, parts).unwrap().eval(wi, wo)
    };
    for (wi, wo) in pairs() {
        let (wi, wo) = (wide(wi), wide(wo));
        let [with, without] = [0, 2].map(|i: usize| value(&set[i], wi, wo));
        for (c, albedo) in [0.7, 0.4, 0.2].into_iter().enumerate() {
            let expected = if wi.z > 0.0 && wo.z > 0.0 { albedo * wi.z / std::f64::consts::PI } else { 0.0 };
            assert!((with[c] - without[c] - expected).abs() < 1e-12 * (1.0 + with[c]), "{wi} {wo}");
        }
    }
    let mut found = Found::default();
    let Some(scene) = scene(&set) else { return };
    for (number, material) in (0..).zip(&set) {
        for theta in [20.0, 70.0] {
            let name = format!("{} {theta}", material.name);
            judge(&scene, number, theta, 2000 + u64::from(number), &name, &mut found);
        }
    }
    assert!(found.faults.is_empty(), "{}", found.faults.join("\n"));
}

/// Films, slabs and metals with numbers of Granier and Heidrich's model; some alike, some not.
fn beams() -> Vec<Material> {
    let film = "[[layer]]\ntype = \"thin-film\"\nior = { n = [1.6, 1.45, 1.4], wavelengths_nm = [445, 525, 645] }\nthickness_nm = 400\n";
    let slab = "[[layer]]\ntype = \"dielectric\"\nior = { n = [1.8, 1.6, 1.5], wavelengths_nm = [445, 525, 645] }\n";
    let schlick = "[[layer]]\ntype = \"dielectric\"\nf0 = [0.05, 0.08, 0.1]\n";
    let base = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.3]\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3 }\n";
    let weights = "specular_weight = 0.9\ndiffuse_weight = 0.4\n";
    let lean = "inner_tilt_deg = 14\ninner_azimuth_deg = 30\n";
    let height = "lobe_height = \"one\"\n";
    let rows = [
        ("all-film", format!("{film}{slab}exponents = [90, 170]\n{base}"), format!("{weights}{lean}")),
        ("all-slab", format!("{slab}exponents = [300, 20]\n{base}"), format!("{weights}{lean}")),
        ("all-schlick", format!("{schlick}exponents = [90, 9000]\n{base}"), format!("{weights}{lean}")),
        ("lean-alone", format!("{slab}alpha = 0.15\n{base}"), lean.to_owned()),
        ("weights-alone", format!("{film}{metal}alpha = 0.2\n"), "specular_weight = 0.5\n".to_owned()),
        ("exponents-alone", format!("{film}{metal}exponents = [130, 40]\n"), String::new()),
        ("metal", format!("{metal}alpha = 0.2\n"), "specular_weight = 0.5\n".to_owned()),
        ("height-film", format!("{film}{slab}exponents = [90, 170]\n{base}"), format!("{weights}{lean}{height}")),
        ("height-slab", format!("{slab}exponents = [3, 20]\n{base}"), height.to_owned()),
        ("height-schlick", format!("{schlick}exponents = [90, 9000]\n{base}"), height.to_owned()),
        ("height-metal", format!("{metal}alpha = 0.2\n"), height.to_owned()),
        ("alike", format!("{slab}exponents = [130, 130]\n{base}"), String::new()),
    ];
    let one = |(name, layers, numbers): (&str, String, String)| {
        let table = if numbers.is_empty() { String::new() } else { format!("[bake.granier-heidrich]\n{numbers}") };
        material(name, &layers, &format!("model = \"granier-heidrich\"\n{table}"))
    };
    rows.into_iter().map(one).collect()
}

#[test]
fn exponents_weights_and_leans_are_those_of_the_twin() {
    let (materials, mut worst) = (beams(), 0.0);
    let alike = materials.last().unwrap();
    assert!(alike.beams().is_none() && materials[..11].iter().all(|material| material.beams().is_some()));
    compare(&materials, &mut worst);
    let plain = material("plain", &format!("{COAT}roughness = 0.5\n{COPPER}roughness = 0.3\n"), "model = \"elek\"");
    compare(&[plain, materials[0].clone(), alike.clone()], &mut worst);
    materials.iter().for_each(|material| compare(std::slice::from_ref(material), &mut worst));
    eprintln!("beams: at most {worst:.1e}");
}

/// A place has a factor on both slope parameters, and its lean comes on top.
#[test]
fn places_roughen_and_tilt_both_boundaries() {
    let lean = DVec3::new(0.1, -0.05, 1.0).normalize();
    let body = format!(
        "var place = luthier_place();\nplace.alpha_factor = 1.5;\nplace.inner_normal = vec3<f32>({}, {}, {});\n\
         return luthier_eval_at(place, material, wi, wo);",
        lean.x as f32, lean.y as f32, lean.z as f32
    );
    let Some(gpu) = gpu() else { return };
    let varying = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\nthickness_nm = { min = 100, max = 300, extent_um = 10, map = { noise = { seed = 1, \
                   frequency = 4, octaves = 1 } } }\n";
    let varying = material("varying", &format!("{varying}{COPPER}alpha = 0.2\n"), "model = \"granier-heidrich\"");
    for own in beams() {
        let set = [own.clone(), varying.clone()];
        let mut package = Bake::wgsl(&[Form::Full]).package(&set, &MemoryStore::default()).unwrap();
        let wgsl = package.wgsl(Form::Full).unwrap().replace("fn luthier_eval(", "fn emitted_eval(")
            + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
        package.shaders = vec![Shader::wgsl(Form::Full, wgsl)];
        let found = gpu.scene(&package, Form::Full).unwrap().evaluate(0, &pairs()).unwrap();
        let mut place = Place::NONE;
        place.sample.alpha_factor = 1.5;
        place.under.inner_normal = lean;
        let nm = own.bake.wavelengths_nm();
        let color = Color::ThreeWavelengths(nm);
        let twin = Shaded::with(ShadingModel::GranierHeidrich, &own.stack, nm, color, &place, parts(&own).0).unwrap();
        for ((wi, wo), found) in pairs().into_iter().zip(found) {
            let expected = twin.eval(wide(wi), wide(wo));
            assert!(error(found, expected) < TOLERANCE, "{}: {wi:?} {wo:?} {found:?} {expected:?}", own.name);
        }
    }
}

#[test]
fn directions_are_drawn_without_bias_from_leaning_beams() {
    let materials = beams();
    let mut found = Found::default();
    for set in [materials.clone(), vec![materials[1].clone()], vec![materials[5].clone()]] {
        let Some(scene) = scene(&set) else { return };
        for (number, material) in (0..).zip(&set) {
            for theta in [20.0, 70.0] {
                judge(
                    &scene,
                    number,
                    theta,
                    1000 + u64::from(number),
                    &format!("{} {theta}", material.name),
                    &mut found,
                );
            }
        }
    }
    assert!(found.faults.is_empty(), "{}", found.faults.join("\n"));
}

/// Effects go on above chosen reflectances: patina dims them, and has some of its own.
#[test]
fn tarnish_dims_chosen_reflectances() {
    let effects = "[effects.patina]\nextent = 0.5\ntransition = 0.4\ndiffuse_albedo = [0.1, 0.3, 0.2]\ntarnish = [0.5, 0.6, 0.7]\n\
                   map = { noise = { seed = 1, frequency = 4, octaves = 2 } }\n";
    let layers = format!("{COAT}roughness = 0.5\n{COPPER}roughness = 0.6\n{effects}");
    for (reflectance, way) in [
        ("exact", ""),
        ("approximate", ""),
        ("lazanyi", ""),
        ("exact", "internal_reflection = \"directions\"\nlower_reflectance = \"in-air\""),
    ] {
        let bake = format!("model = \"elek\"\nreflectance = \"{reflectance}\"\n{way}");
        let grown = material("grown", &layers, &bake);
        let Some(gpu) = gpu() else { return };
        let mut package =
            Bake::wgsl(&[Form::Full]).package(std::slice::from_ref(&grown), &MemoryStore::default()).unwrap();
        let body =
            "var place = luthier_place();\nplace.patina = 0.4;\nreturn luthier_eval_at(place, material, wi, wo);";
        let wgsl = package.wgsl(Form::Full).unwrap().replace("fn luthier_eval(", "fn emitted_eval(")
            + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
        package.shaders = vec![Shader::wgsl(Form::Full, wgsl)];
        let found = gpu.scene(&package, Form::Full).unwrap().evaluate(0, &pairs()).unwrap();
        let (parts, reflectance) = parts(&grown);
        let wavelengths_nm = grown.bake.wavelengths_nm();
        let color = if reflectance.is_fitted() { Color::Spectral } else { Color::ThreeWavelengths(wavelengths_nm) };
        let growth = luthier_layers::twins::shaded::Growth {
            amount: 0.4,
            diffuse_albedo: [0.1, 0.3, 0.2],
            base_alpha: None,
            tarnish: [0.5, 0.6, 0.7],
        };
        let place = Place { patina: Some(growth), ..Place::NONE };
        let stack = grown.reflecting_stack();
        let twin = Shaded::with(ShadingModel::Elek, &stack, wavelengths_nm, color, &place, parts).unwrap();
        for ((wi, wo), found) in pairs().into_iter().zip(found) {
            let expected = twin.eval(wide(wi), wide(wo));
            assert!(error(found, expected) < 5.0 * TOLERANCE, "{reflectance}: {found:?} {expected:?}");
        }
    }
}

/// Weights are f cos over the density whatever the masking, so that their mean is the integral.
#[test]
fn directions_are_drawn_without_bias_under_each_masking() {
    let materials: Vec<Material> = masked().into_iter().step_by(2).collect();
    let Some(scene) = scene(&materials) else { return };
    let mut found = Found::default();
    for (number, material) in (0..).zip(&materials) {
        for theta in [20.0, 70.0] {
            judge(&scene, number, theta, 1000 + u64::from(number), &format!("{} {theta}", material.name), &mut found);
        }
    }
    assert!(found.faults.is_empty(), "{}", found.faults.join("\n"));
    assert!(found.albedo < 0.15, "{}", found.albedo);
}

#[test]
fn a_masking_changes_what_is_seen() {
    let materials = masked();
    let (wi, wo) = (DVec3::new(0.8, 0.1, 0.4).normalize(), DVec3::new(-0.6, 0.2, 0.5).normalize());
    let value = |material: &Material| {
        let (parts, _) = parts(material);
        let nm = material.bake.wavelengths_nm();
        let color = Color::ThreeWavelengths(nm);
        Shaded::with(ShadingModel::Microfacet, &material.stack, nm, color, &Place::NONE, parts).unwrap().eval(wi, wo)[1]
    };
    let values: Vec<f64> = materials.iter().step_by(2).map(value).collect();
    for (i, a) in values.iter().enumerate() {
        assert!(values[..i].iter().all(|b| (a / b - 1.0).abs() > 1e-3), "{values:?}");
    }
}

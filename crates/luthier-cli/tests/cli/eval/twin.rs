//! `eval` is the f64 twin of the emitted shaders: every shipped material on the device.

use std::f64::consts::TAU;
use std::path::PathBuf;

use glam::DVec3;
use luthier::{Bake, MemoryStore};
use luthier_export::Shader;
use luthier_gpu::{Gpu, GpuError};
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_manifest::{ColorMode, Form, ShadingModel};
use luthier_material::{Material, parse};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_workshop::{material_files, root};

use crate::workshop::Workshop;

/// Largest difference between the device and `eval`, relative to the larger of the value and a tenth of a white Lambert surface's BRDF.
const TOLERANCE: f64 = 1e-4;
/// The difference of sets of one kind of surface: reflectances as f32, and D in closed form.
const SETS: f64 = 2e-5;
/// That of rows of lobes as half floats, linear between nodes of other sums.
const ROWS: f64 = 2e-3;
const FLOOR: f64 = 0.1 * std::f64::consts::FRAC_1_PI;

/// The models whose `full` form is `eval`'s at three wavelengths. That of `belcour` and `yamaguchi` takes facets as level, and nothing
/// as totally reflected, because it has no tables of energies; its header says so.
const MODELS: [&str; 5] = ["elek", "weidlich-wilkie", "granier-heidrich", "phong", "microfacet"];

/// Pairs of directions of each kind.
const PAIRS: u32 = 150;

pub(super) type Pair = ([f32; 3], [f32; 3]);

pub(crate) fn gpu() -> Option<Gpu> {
    match Gpu::open() {
        Ok(gpu) => Some(gpu),
        Err(error @ GpuError::NoAdapter) if std::env::var_os("CI").is_none() => {
            eprintln!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// The folders of the shipped materials.
const FOLDERS: [&str; 2] = ["materials", "materials/papers"];

/// Shipped materials, shaded by a model. One of each name: the paper's where it is in a paper alone.
pub(super) fn shipped(model: &str) -> Vec<Material> {
    let [everyday, papers] = FOLDERS.map(|folder| shipped_in(folder, model));
    let is_other = |material: &Material| everyday.iter().all(|other| other.name != material.name);
    let others: Vec<Material> = papers.into_iter().filter(is_other).collect();
    [everyday, others].concat()
}

/// The shipped materials of a folder, shaded by a model.
fn shipped_in(folder: &str, model: &str) -> Vec<Material> {
    let material = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).unwrap();
        let read = |name: &str| std::fs::read_to_string(root().join(folder).join(name));
        let mut material = parse(&path.display().to_string(), &text, &read).unwrap().material;
        material.bake.model = ShadingModel::from_name(model);
        material
    };
    material_files(folder).iter().map(material).collect()
}

/// The form `full` of some materials, or that of lobes, with another body of `luthier_eval`, if there is one, over the emitted functions.
fn scene(gpu: &Gpu, materials: &[Material], body: Option<&str>) -> luthier_gpu::Scene {
    let form = if materials.iter().all(|material| material.model().has(Form::Full)) { Form::Full } else { Form::Baked };
    let bake = Bake { refuses: false, ..Bake::wgsl(&[form]) };
    let mut package = bake.package(materials, &MemoryStore::default()).unwrap();
    if let Some(body) = body {
        let wgsl = package.wgsl(form).unwrap().replace("fn luthier_eval(", "fn emitted_eval(")
            + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
        package.shaders = vec![Shader::wgsl(form, wgsl)];
    }
    gpu.scene(&package, form).unwrap()
}

fn unit(z: f64, phi: f64) -> DVec3 {
    let sin = libm::sqrt((1.0 - z * z).max(0.0));
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), z)
}

/// Directions over the hemisphere, and near the mirror direction by 0.1 to 20 degrees; as a device has them.
pub(super) fn pairs() -> Vec<Pair> {
    let part = |i: u32, step: f64| (f64::from(i) * step).fract();
    let narrow = |w: DVec3| w.as_vec3().to_array();
    let one = |i: u32| {
        let wi = unit(0.02 + 0.97 * part(i, 0.754_877_666), TAU * part(i, 0.569_840_291));
        let anywhere = unit(0.02 + 0.97 * part(i, 0.819_172_513), TAU * part(i, 0.671_043_606));
        let spread = libm::pow(10.0, -2.75 + 2.3 * part(i, 0.549_700_478));
        let mirrored = DVec3::new(-wi.x, -wi.y, wi.z);
        let near = (mirrored + spread * unit(0.0, TAU * part(i, 0.321_928_095))).normalize();
        [
            (narrow(wi), narrow(anywhere)),
            (narrow(wi), narrow(DVec3::new(near.x, near.y, near.z.abs().max(0.01)).normalize())),
        ]
    };
    (1..=PAIRS).flat_map(one).collect()
}

pub(super) fn wide(w: [f32; 3]) -> DVec3 {
    DVec3::from(w.map(f64::from))
}

pub(super) fn error(found: [f32; 3], expected: Rgb) -> f64 {
    let brightest = expected.iter().fold(FLOOR, |most, value| most.max(*value));
    let apart = |c: usize| (f64::from(found[c]) - expected[c]).abs() / brightest;
    (0..3).map(apart).fold(0.0, f64::max)
}

/// Compares the form `full` of materials with twins of them: each in a set of its own and all in one, whose shaders differ.
pub(super) fn compare_sets(gpu: &Gpu, model: &str, materials: &[Material], twin: impl Fn(&Material) -> Shaded) {
    let pairs = pairs();
    let mut sets: Vec<&[Material]> = materials.iter().map(std::slice::from_ref).collect();
    sets.push(materials);
    let mut worst: f64 = 0.0;
    for set in sets {
        let scene = scene(gpu, set, None);
        for (number, material) in set.iter().enumerate() {
            let twin = twin(material);
            for (&(wi, wo), found) in pairs.iter().zip(scene.evaluate(number as u32, &pairs).unwrap()) {
                let expected = twin.eval(wide(wi), wide(wo));
                let error = error(found, expected);
                worst = worst.max(error);
                assert!(error < SETS, "{model}, {}: {wi:?} {wo:?}: {found:?} {expected:?}", material.name);
            }
        }
    }
    eprintln!("{model}: at most {worst:.1e}");
}

/// The function that `eval --three-wavelengths --no-effects` prints, against `luthier_eval`.
#[test]
fn every_shipped_material_agrees_with_its_full_shaders() {
    let Some(gpu) = gpu() else { return };
    let pairs = pairs();
    let mut compared = 0;
    for (model, folder) in MODELS.into_iter().flat_map(|model| FOLDERS.map(|folder| (model, folder))) {
        let materials = shipped_in(folder, model);
        let scene = scene(&gpu, &materials, None);
        let mut worst = (0.0, "");
        for (number, material) in materials.iter().enumerate() {
            let wavelengths_nm = material.bake.wavelengths_nm();
            let color = Color::ThreeWavelengths(wavelengths_nm);
            // Phong's coefficients are in the material's own colour in both forms.
            let is_spectral = material.bake.color != Some(ColorMode::ThreeWavelengths);
            let color = if model == "phong" && is_spectral { Color::Spectral } else { color };
            let twin =
                Shaded::new(model.parse().unwrap(), &material.stack, wavelengths_nm, color, &Place::NONE).unwrap();
            let found = scene.evaluate(number as u32, &pairs).unwrap();
            for (&(wi, wo), found) in pairs.iter().zip(found) {
                let expected = twin.eval(wide(wi), wide(wo));
                let error = error(found, expected);
                assert!(error < TOLERANCE, "{model}, {}: {wi:?} {wo:?}: {found:?}, eval {expected:?}", material.name);
                compared += usize::from(expected.iter().any(|value| *value > FLOOR));
                if error > worst.0 {
                    worst = (error, &material.name);
                }
            }
        }
        eprintln!("{model}: at most {:.1e}, {}", worst.0, worst.1);
    }
    assert!(compared > 5000, "{compared}");
}

/// The command with the effects of the files, against `luthier_eval_at` with the place that the shader makes.
#[test]
fn effects_of_the_file_are_those_of_the_shader() {
    let Some(gpu) = gpu() else { return };
    let workshop = Workshop::new();
    let angles: Vec<[f64; 4]> = (0..300u32)
        .map(|i| {
            let part = |step: f64| (f64::from(i + 1) * step).fract();
            [88.0 * part(0.7549), 360.0 * part(0.5698), 88.0 * part(0.8191), 360.0 * part(0.671)]
        })
        .collect();
    let list: Vec<String> = angles.iter().map(|a| a.map(|angle| angle.to_string()).join(",")).collect();
    workshop.write("pairs.csv", list.join("\n"));
    let direction = |theta: f64, phi: f64| unit(libm::cos(theta.to_radians()), phi.to_radians());
    let pairs: Vec<Pair> = angles
        .iter()
        .map(|&[a, b, c, d]| (direction(a, b).as_vec3().to_array(), direction(c, d).as_vec3().to_array()))
        .collect();
    for (model, tolerance) in [("elek", TOLERANCE), ("weidlich-wilkie", TOLERANCE), ("lobes", ROWS)] {
        for material in shipped(model) {
            let effects = &material.effects;
            let (flakes, patina) = (effects.flakes.is_some() && model != "lobes", effects.patina.is_some());
            // What the device makes of the place, and how the command is told: the middle of a cell of flakes; a value of the map.
            let uv = "0.00132,0.00223";
            let (make, more): (&str, &[&str]) = match (flakes, patina) {
                (true, _) => (
                    "place.flake_normal = luthier_flake_normal(material, vec2<f32>(0.00132, 0.00223), 0.5);",
                    &["--uv", uv, "--distance", "0.5"],
                ),
                (_, true) => ("place.patina = luthier_patina_amount(material, 0.375);", &["--map", "0.375"]),
                _ => continue,
            };
            let body =
                format!("var place = luthier_place();\n{make}\nreturn luthier_eval_at(place, material, wi, wo);");
            let found = scene(&gpu, std::slice::from_ref(&material), Some(&body)).evaluate(0, &pairs).unwrap();
            let base = [
                "eval",
                &material.source,
                "--model",
                model,
                "--three-wavelengths",
                "--json",
                "--directions",
                "pairs.csv",
            ];
            let of = |more: &[&str]| -> Vec<Rgb> {
                let json = workshop.run(&[&base, more].concat()).exits(0).json();
                let rows = json["values"].as_array().unwrap();
                rows.iter().map(|row| [0, 1, 2].map(|c: usize| row["value"][c].as_f64().unwrap())).collect()
            };
            let (with, without) = (of(more), of(&["--no-effects"]));
            let worst = found.iter().zip(&with).map(|(f, e)| error(*f, *e)).fold(0.0, f64::max);
            let ignored = found.iter().zip(&without).map(|(f, e)| error(*f, *e)).fold(0.0, f64::max);
            eprintln!("{model}, {}: {worst:.1e}; without effects {ignored:.1e}", material.name);
            assert!(worst < tolerance && ignored > 0.1, "{model}, {}: {worst} {ignored}", material.name);
        }
    }
}

//! Values of an element: with it and without it, in f64 and on the device.

use std::path::Path;
use std::sync::LazyLock;

use glam::DVec3;
use luthier::{Bake, Files, MemoryStore, Source, SurfaceSource};
use luthier_export::{Package, Shader};
use luthier_gpu::Gpu;
use luthier_manifest::{Form, FunctionGroup, Functions, ShadingModel};
use luthier_material::Material;
use luthier_workshop::root;

use super::element::Element;
use crate::eval::twin::gpu;
use crate::workshop::Workshop;

/// theta_i, phi_i, theta_o, phi_o in degrees: apart, near the mirror direction, and flat.
const PAIRS: [[f64; 4]; 3] = [[30.0, 0.0, 45.0, 140.0], [10.0, 20.0, 12.0, 200.0], [65.0, 0.0, 50.0, 190.0]];

/// Differences are relative to the larger of the value and a tenth of a white Lambert surface's BRDF.
const FLOOR: f64 = 0.1 * std::f64::consts::FRAC_1_PI;

/// The least difference that an element has to make.
const SEEN: f64 = 1e-3;

/// One adapter for all elements; `None` where there is none and the test may be skipped.
pub(super) static GPU: LazyLock<Option<Gpu>> = LazyLock::new(gpu);

/// Numbers of an element.
#[derive(Debug)]
pub(super) enum Number {
    /// The value with the element and that without it, where these differ most, and how device and f64 were compared.
    Values([f64; 2], String),
    /// None yet.
    Open,
    /// Left to another run.
    Unmeasured,
    /// A page that has the number.
    Page(String),
}

/// Measures an element, and asserts that it is there: its values differ from those without it, its function and its table are in the shader,
/// and the device agrees with f64.
pub(super) fn measured(element: &Element, gpu: &Gpu) -> Number {
    let name = element.name();
    if !element.is_measured() {
        return Number::Open;
    }
    let package = shaders(element);
    if let Some(package) = &package {
        let form = form(element);
        let text = package.wgsl(form).unwrap();
        let function = element.cell("function");
        assert!(text.contains(&format!("fn {function}(")), "{name}: no `{function}` in the shader");
        read_table(element, package);
    }
    if let Some(page) = element.get("page") {
        let says = element.cell("says");
        let text = std::fs::read_to_string(root().join("docs/pages").join(page)).unwrap();
        assert!(text.contains(says), "{name}: {page} does not say `{says}`");
        return Number::Page(page.to_owned());
    }
    let (with, without, compared) = if element.get("measured").is_some() {
        let with = device(element, gpu, package.as_ref().unwrap());
        let without = device(element, gpu, &package_of(element, &element.without().unwrap()));
        let compared = match element.get("device_place") {
            Some(_) => "the table on the device".to_owned(),
            None => within(element, &with, &in_f64(element, true)),
        };
        (with, without, compared)
    } else {
        let (with, without) = (in_f64(element, true), in_f64(element, false));
        let compared = match &package {
            Some(package) if element.get("f64_model").is_none() => {
                within(element, &device(element, gpu, package), &with)
            }
            _ => "f64 alone".to_owned(),
        };
        (with, without, compared)
    };
    let apart = |i: usize| (with[i] - without[i]).abs() / with[i].abs().max(without[i].abs()).max(FLOOR);
    let most = (0..with.len()).max_by(|&a, &b| apart(a).total_cmp(&apart(b))).unwrap();
    assert!(apart(most) > SEEN, "{name}: {with:?} with it, {without:?} without it");
    Number::Values([with[most], without[most]], compared)
}

/// The kinds of tables that the shader of the form `baked` reads, against the cell of the page.
fn read_table(element: &Element, package: &Package) {
    let kind = element.cell("table");
    if kind.contains(' ') {
        return;
    }
    let text = package.wgsl(Form::Baked).unwrap();
    assert!(text.contains(&format!("fn luthier_lookup_{kind}(")), "{}: no look-up of {kind}", element.name());
}

fn form(element: &Element) -> Form {
    match element.get("form") {
        Some("baked") => Form::Baked,
        _ if element.cell("model") == "lobes" => Form::Baked,
        _ => Form::Full,
    }
}

/// The shaders of the file with the element, unless no shader has it.
fn shaders(element: &Element) -> Option<Package> {
    if ["open", "none"].iter().any(|word| element.cell("function").starts_with(word)) {
        return None;
    }
    Some(package_of(element, &element.with()?))
}

/// A folder with a file, and all that it may name.
fn folder(element: &Element, text: &str) -> Workshop {
    let workshop = Workshop::with(&[("m.toml", text)]);
    if let Some(matrix) = element.get("matrix") {
        workshop.write("matrix.csv", matrix.trim_start());
    }
    for (name, texel) in [
        ("map.png", [128, 128, 255]),
        ("bumps.png", [153, 140, 252]),
        ("tangent.png", [64, 230, 128]),
        ("colors.png", [128, 64, 200]),
    ] {
        image::RgbImage::from_pixel(4, 4, image::Rgb(texel)).save(workshop.path(name)).unwrap();
    }
    // At the middle of the second texel of both: slopes of (100 - 20) / 255 and (80 - 40) / 255 of the height over two texels.
    let heights = image::GrayImage::from_fn(4, 4, |x, y| image::Luma([(40 * x + 20 * y) as u8]));
    heights.save(workshop.path("heights.png")).unwrap();
    workshop
}

/// Writes the second material and the surface, where an element has them.
fn write_other(element: &Element, workshop: &Workshop) {
    if let Some(other) = element.get("other") {
        workshop.write("other.toml", format!("schema = 1\nname = \"other\"\n{other}"));
    }
    if let Some(surface) = element.surface() {
        workshop.write("s.toml", surface);
    }
}

fn material(element: &Element, path: &Path) -> Material {
    let read = Source::read(path).unwrap().parsed;
    let material = read.unwrap_or_else(|errors| panic!("{}: {errors:?}", element.name()));
    let mut material = material.material;
    material.bake.model = ShadingModel::from_name(element.cell("model"));
    // Both forms mean the same.
    material.bake.color = Some(luthier_manifest::ColorMode::ThreeWavelengths);
    material
}

fn package_of(element: &Element, text: &str) -> Package {
    let groups = element.list("functions").into_iter().map(|name| FunctionGroup::from_name(name).unwrap());
    let functions: Functions = groups.collect();
    let mut forms = vec![form(element)];
    if !element.cell("table").contains(' ') && forms[0] == Form::Full {
        forms.push(Form::Baked);
    }
    let workshop = folder(element, text);
    write_other(element, &workshop);
    let (mut files, mut surfaces) = (vec![workshop.path("m.toml")], Vec::new());
    if element.surface().is_some() {
        let found = Files::read(&[workshop.path("s.toml")]).unwrap();
        files = found.materials.into_iter().map(|file| file.path).collect();
        surfaces = found.surfaces.iter().filter_map(SurfaceSource::entry).collect();
    }
    let materials: Vec<Material> = files.iter().map(|path| material(element, path)).collect();
    let bake = Bake { refuses: false, functions, surfaces, ..Bake::wgsl(&forms) };
    bake.package(&materials, &MemoryStore::default()).unwrap_or_else(|error| panic!("{}: {error}", element.name()))
}

/// Values of the shader at all pairs, channel by channel.
fn device(element: &Element, gpu: &Gpu, package: &Package) -> Vec<f64> {
    let form = form(element);
    let mut package = package.clone();
    if let Some(make) = element.get("place").or(element.get("device_place")) {
        let material = if element.surface().is_some() { "pick.material" } else { "material" };
        let body = format!("var place = luthier_place();\n{make}\nreturn luthier_eval_at(place, {material}, wi, wo);");
        let wgsl = package.wgsl(form).unwrap().replace("fn luthier_eval(", "fn emitted_eval(")
            + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
        package.shaders = vec![Shader::wgsl(form, wgsl)];
    }
    let pairs = PAIRS.map(|[a, b, c, d]| (direction(a, b), direction(c, d)));
    let scene = gpu.scene(&package, form).unwrap_or_else(|error| panic!("{}: {error}", element.name()));
    scene.evaluate(0, &pairs).unwrap().into_iter().flatten().map(f64::from).collect()
}

fn direction(theta: f64, phi: f64) -> [f32; 3] {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    DVec3::new(libm::sin(theta) * libm::cos(phi), libm::sin(theta) * libm::sin(phi), libm::cos(theta))
        .as_vec3()
        .to_array()
}

/// Values of `luthier eval` at all pairs, channel by channel.
fn in_f64(element: &Element, with: bool) -> Vec<f64> {
    let text = if with { element.with() } else { element.without() };
    let workshop = folder(element, &text.unwrap());
    workshop.write("pairs.csv", PAIRS.map(|pair| pair.map(|angle| angle.to_string()).join(",")).join("\n"));
    let mut extra: Vec<&str> = element.list(if with { "options" } else { "options_without" });
    let model = match (with, element.get("other_model")) {
        (false, Some(other)) => {
            extra = Vec::new();
            other
        }
        _ => element.get("f64_model").unwrap_or(element.cell("model")),
    };
    let alone = model == element.get("f64_model").unwrap_or(element.cell("model"));
    write_other(element, &workshop);
    let is_surface = element.surface().is_some();
    if element.get("other").is_some() && alone && !is_surface {
        extra.extend(["--other", "other.toml"]);
    }
    let file = if is_surface && with { "s.toml" } else { "m.toml" };
    let mut arguments = vec!["eval", file, "--model", model, "--json", "--directions", "pairs.csv"];
    let single = if with { Vec::new() } else { element.list("wavelengths_without") };
    if !single.is_empty() {
        let channels: Vec<Vec<f64>> = single
            .iter()
            .map(|nm| listed(&workshop, &[&arguments[..], &["--wavelength", nm], &extra].concat()))
            .collect();
        return (0..PAIRS.len()).flat_map(|pair| channels.iter().map(move |channel| channel[pair])).collect();
    }
    if !["--wavelength", "--rgb"].iter().any(|option| extra.contains(option)) {
        arguments.push("--three-wavelengths");
    }
    listed(&workshop, &[&arguments[..], &extra].concat())
}

/// The values that a command lists.
fn listed(workshop: &Workshop, arguments: &[&str]) -> Vec<f64> {
    let json = workshop.run(arguments).exits(0).json();
    let rows = json["values"].as_array().unwrap();
    rows.iter().flat_map(|row| row["value"].as_array().unwrap()).map(|value| value.as_f64().unwrap()).collect()
}

/// Asserts that the device agrees with f64, and says within what.
fn within(element: &Element, found: &[f64], expected: &[f64]) -> String {
    for (found, expected) in found.chunks(3).zip(expected.chunks(3)) {
        let brightest = expected.iter().fold(FLOOR, |most, value| most.max(*value));
        for (f, e) in found.iter().zip(expected) {
            let error = (f - e).abs() / brightest;
            assert!(error < element.tolerance(), "{}: device {found:?}, f64 {expected:?}", element.name());
        }
    }
    format!("{:.0e}", element.tolerance())
}

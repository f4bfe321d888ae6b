//! A glTF file: how far the formula of engines, and the model of a bake, are from the layers that its materials mean.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use luthier::Bake;
use luthier_export::label;
use luthier_import::{Fate, GltfPoint, Imported};
use luthier_manifest::PlaceValues;
use luthier_mesh::Soup;
use luthier_optics::Rgb;
use luthier_report::{AlbedoSettings, AlbedosAt, Places, albedos};
use luthier_terminal::{Bar, Failure, Outcome, complain, print};
use serde_json::{Value, json};

use crate::cli::{ReportOptions, Shading};
use crate::meshes::judged::{formula, subject};
use crate::meshes::scene_file::{SceneFile, is_scene};
use crate::store::store;

/// Places of a material that varies.
const PLACES: usize = 16;

/// Findings on a material.
struct Found<'a> {
    imported: &'a Imported,
    model: &'static str,
    /// Distinct places that count.
    places: usize,
    albedos: Vec<AlbedosAt>,
    /// Parts of the material that the formula leaves out.
    left_out: Vec<String>,
}

/// Compares, and prints.
pub(super) fn run(path: &Path, options: &ReportOptions) -> Outcome {
    if !is_scene(&path.to_string_lossy()) {
        let text =
            format!("{} is no scene: name a .glb or .gltf file, or the folder of a bake by --out", path.display());
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    let file = SceneFile::read(path)?;
    let all: BTreeSet<usize> = (0..file.import.materials.len()).collect();
    let laid = file.lay(&all, &Shading::default())?;
    let bake = Bake { targets: Vec::new(), ..Bake::default() };
    let package = bake.package(&laid.materials, store()?)?;
    let mut settings = AlbedoSettings::default();
    if let Some(paths) = options.reference {
        settings.paths = paths.get().into();
    }
    let none = Soup::default();
    let soup = match &file.triangles {
        Ok(triangles) => &triangles.soup,
        Err(error) => {
            complain(&format!("warning: {}: {error}; places are all over the textures", path.display()));
            &none
        }
    };
    let places: Vec<Vec<[f64; 2]>> = all.iter().map(|number| on_triangles(soup, *number)).collect();
    let points = file.points(&|number| places[number].clone())?;
    let subject = subject(&package, &laid)?;
    let bar = Bar::new("simulating");
    let mut found = Vec::new();
    for (number, (imported, points)) in file.import.materials.iter().zip(points).enumerate() {
        let missing = || Failure::Input(anyhow::anyhow!("{}: no material `{}`", path.display(), imported.name));
        let own = package.manifest.material_index(&imported.name).ok_or_else(missing)? as usize;
        let varied = Places::of(&subject, own);
        let values = |uv: &[f64; 2]| varied.as_ref().map_or(PlaceValues::NONE, |all| all.at(&subject, own, *uv));
        let mut here: Vec<(PlaceValues, GltfPoint)> = places[number].iter().map(values).zip(points.points).collect();
        // A material that is the same everywhere is judged once.
        if here.iter().all(|one| *one == here[0]) {
            here.truncate(1);
        }
        let here: Vec<_> = here.into_iter().map(|(values, point)| (values, formula(&point))).collect();
        let albedos = albedos(&subject, own, &here, &settings).map_err(Failure::input)?;
        let model = package.manifest.materials[own].model.name();
        found.push(Found { imported, model, places: here.len(), albedos, left_out: points.left_out });
        bar.set(number as u64 + 1, all.len() as u64);
    }
    drop(bar);
    print(&if options.json { format!("{:#}", json(path, &settings, &found)) } else { text(path, &settings, &found) })
}

/// Texture coordinates of places on the triangles of a material, spread evenly over their area; over all coordinates where it has no triangle.
fn on_triangles(soup: &Soup, material: usize) -> Vec<[f64; 2]> {
    let own = soup.triangles.iter().filter(|triangle| triangle.material as usize == material);
    let corners: Vec<_> = own.map(|triangle| triangle.corners.map(|i| soup.vertices[i as usize])).collect();
    let mut total = 0.0;
    let areas: Vec<f64> = corners
        .iter()
        .map(|[a, b, c]| {
            let [x, y, z] = [a, b, c].map(|v| glam::DVec3::from(v.position.map(f64::from)));
            total += (y - x).cross(z - x).length();
            total
        })
        .collect();
    (0..PLACES)
        .map(|n| {
            // Roberts 2018: multiples of the powers of the root of x^3 = x + 1.
            let [s, t] = [0.754_877_666, 0.569_840_291].map(|step: f64| (0.5 + step * n as f64).fract());
            if total <= 0.0 {
                return [s, t];
            }
            let at = total * (n as f64 + 0.5) / PLACES as f64;
            let triangle = areas.partition_point(|sum| *sum <= at).min(corners.len() - 1);
            // Evenly over a triangle (Turk 1990).
            let [s, t] = [1.0 - s.sqrt(), t * s.sqrt()];
            let [a, b, c] = corners[triangle].map(|v| v.uv.map(f64::from));
            [0, 1].map(|i: usize| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]))
        })
        .collect()
}

/// The largest difference from the simulation in each channel, with its angle.
fn largest(albedos: &[AlbedosAt], of: impl Fn(&AlbedosAt) -> Rgb) -> [(f64, f64); 3] {
    [0, 1, 2].map(|c: usize| {
        let differences = albedos.iter().map(|at| (of(at)[c] - at.simulated[c], at.theta_deg));
        differences.fold((0.0, 0.0), |most: (f64, f64), one| if one.0.abs() > most.0.abs() { one } else { most })
    })
}

/// Properties that are neither in the formula nor in the layers.
fn dropped(imported: &Imported) -> Vec<&str> {
    let lines = imported.lines.iter().filter(|line| line.fate == Fate::Dropped);
    lines.map(|line| line.property.as_str()).collect()
}

fn json(path: &Path, settings: &AlbedoSettings, found: &[Found<'_>]) -> Value {
    let listed = |largest: [(f64, f64); 3]| -> Value {
        largest
            .iter()
            .map(|(difference, theta_deg)| json!({"difference": difference, "theta_deg": theta_deg}))
            .collect()
    };
    let materials = found.iter().map(|Found { imported, model, places, albedos, left_out }| {
        let rows = albedos.iter().map(|AlbedosAt { theta_deg, formula, simulated, std_err, model }| {
            json!({"theta_deg": theta_deg, "gltf": formula, "simulated": simulated, "std_err": std_err, "model": model})
        });
        json!({
            "name": imported.name,
            "source_name": imported.source_name,
            "model": model,
            "places": places,
            "albedos": rows.collect::<Vec<_>>(),
            "largest": {"gltf": listed(largest(albedos, |at| at.formula)), "model": listed(largest(albedos, |at| at.model))},
            "formula_leaves_out": left_out,
            "dropped": dropped(imported),
        })
    });
    let (materials, paths) = (materials.collect::<Vec<_>>(), settings.paths);
    json!({"generator": luthier_export::GENERATOR, "scene": label(path), "paths": paths, "materials": materials})
}

fn text(path: &Path, settings: &AlbedoSettings, found: &[Found<'_>]) -> String {
    let counted =
        |count: usize, what: &str| if count == 1 { format!("one {what}") } else { format!("{count} {what}s") };
    let mut out = format!(
        "{}: albedos of {} in a white furnace, with {} paths from each angle\n",
        path.display(),
        counted(found.len(), "material"),
        settings.paths
    );
    let rgb = |values: Rgb| values.map(|value| format!("{value:.3}")).join(" ");
    for Found { imported, model, places, albedos, left_out } in found {
        // Writing to a String does not fail.
        let _ = writeln!(out, "\n{}, {}", imported.name, counted(*places, "place"));
        let _ = writeln!(out, "  {:>5}  {:17}  {:17}  {model}", "angle", "glTF's formula", "simulated");
        for at in albedos {
            let _ =
                writeln!(out, "  {:>5}  {}  {}  {}", at.theta_deg, rgb(at.formula), rgb(at.simulated), rgb(at.model));
        }
        let noise = albedos.iter().flat_map(|at| at.std_err).fold(0.0, f64::max);
        for (name, largest) in
            [("glTF's formula", largest(albedos, |at| at.formula)), (model, largest(albedos, |at| at.model))]
        {
            let [r, g, b] = largest.map(|(difference, theta_deg)| format!("{difference:+.3} ({theta_deg} degrees)"));
            let _ = writeln!(out, "  {name} less simulated, at most: red {r}, green {g}, blue {b}");
        }
        let _ = writeln!(out, "  standard error of the simulation: {noise:.4} at most");
        for (what, names) in
            [("not in glTF's formula", left_out.join(", ")), ("not in the layers", dropped(imported).join(", "))]
        {
            if !names.is_empty() {
                let _ = writeln!(out, "  {what}: {names}");
            }
        }
    }
    out
}

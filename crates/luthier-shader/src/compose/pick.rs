//! `luthier_pick`: the material at a place of a surface. The numbers of surfaces are constants of the code.

use std::fmt::Write as _;

use luthier_manifest::{CellsRecord, SurfaceEntry, SwitchBy};

use crate::MaterialSet;

/// The function, for a set with surfaces.
pub(super) fn pick(set: &MaterialSet<'_>) -> Option<String> {
    let [.., last] = set.surfaces else { return None };
    let mut out = String::from(
        "/// Material of a place of a surface, and the normal there: Voronoi cells of several materials, and tilted particles on top\n\
         /// of them (Weidlich and Wilkie 2009, section 5.2.1).\n\
         fn luthier_pick(surface: u32, uv: vec2<f32>) -> LuthierPick {\n",
    );
    for (number, surface) in set.surfaces[..set.surfaces.len() - 1].iter().enumerate() {
        let _ = write!(out, "    if surface == {number}u {{\n{}    }}\n", indented(&body(surface)));
    }
    let _ = writeln!(out, "{}}}", body(last));
    Some(out)
}

fn body(surface: &SurfaceEntry) -> String {
    let mut out = String::new();
    if let Some(glitter) = &surface.glitter {
        // 1 - cos without cancellation.
        let half = libm::sin(0.5 * glitter.tilt);
        let (filled, lack) = (glitter.filled as f32, (2.0 * half * half) as f32);
        let _ = write!(
            out,
            "    let particle = {};\n    if luthier_unit(particle, 3u) < {filled:?} {{\n{}    }}\n",
            cell(&glitter.cells),
            indented(&chosen(&glitter.cells, "particle", &format!("luthier_tilted(particle, {lack:?})")))
        );
    }
    for switch in &surface.switches {
        let _ = write!(out, "    if {} {{\n{}    }}\n", inside(&switch.by), indented(&grain(&switch.cells)));
    }
    out + &grain(&surface.cells)
}

/// The condition of a switch.
fn inside(by: &SwitchBy) -> String {
    match *by {
        SwitchBy::Noise { seed, frequency, octaves, between: [least, most] } => format!(
            "luthier_within(luthier_perlin({seed}u, uv * {:?}, {octaves}u), {:?}, {:?})",
            frequency as f32, least as f32, most as f32
        ),
        SwitchBy::Tiles { seed, frequency, share } => {
            format!("luthier_unit(luthier_voronoi({seed}u, uv * {:?}), 2u) < {:?}", frequency as f32, share as f32)
        }
    }
}

/// Statements that return the material of a grain, which is flat.
fn grain(cells: &CellsRecord) -> String {
    format!("    let cell = {};\n", cell(cells)) + &chosen(cells, "cell", "vec3<f32>(0.0, 0.0, 1.0)")
}

fn cell(cells: &CellsRecord) -> String {
    format!("luthier_voronoi({}u, uv * {:?})", cells.seed, cells.frequency as f32)
}

/// Statements that return one of the materials.
fn chosen(cells: &CellsRecord, cell: &str, normal: &str) -> String {
    let numbers: Vec<String> = cells.materials.iter().map(|material| format!("{material}u")).collect();
    match numbers.as_slice() {
        [one] => format!("    return LuthierPick({one}, {normal});\n"),
        several => {
            let (count, list) = (several.len(), several.join(", "));
            format!(
                "    var materials = array<u32, {count}>({list});\n    \
                 return LuthierPick(materials[luthier_chosen({cell}, {count}u)], {normal});\n"
            )
        }
    }
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}

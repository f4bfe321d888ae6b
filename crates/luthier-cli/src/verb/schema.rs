//! `schema`: the JSON Schemas of files.

use luthier_terminal::{Outcome, print};

/// Prints the JSON Schema of material files, of scene files, or of surface files.
pub(crate) fn run(scene: bool, surface: bool) -> Outcome {
    let schema = match (scene, surface) {
        (true, _) => luthier_material::scene_schema(),
        (_, true) => luthier_material::surface_schema(),
        _ => luthier_material::schema(),
    };
    print(&format!("{schema:#}"))
}

//! `schema`: the JSON Schemas of files.

use luthier_terminal::{Outcome, print};

/// Prints the JSON Schema of material files, or of scene files.
pub(crate) fn run(scene: bool) -> Outcome {
    let schema = if scene { luthier_material::scene_schema() } else { luthier_material::schema() };
    print(&format!("{schema:#}"))
}

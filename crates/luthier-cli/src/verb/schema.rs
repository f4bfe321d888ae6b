use crate::failure::Outcome;
use crate::output::print;

/// Prints the JSON Schema of material files, or of scene files.
pub(crate) fn run(scene: bool) -> Outcome {
    let schema = if scene { luthier_material::scene_schema() } else { luthier_material::schema() };
    print(&format!("{schema:#}"))
}

use crate::failure::Outcome;
use crate::output::print;

/// Prints the JSON Schema of material files.
pub(crate) fn run() -> Outcome {
    print(&format!("{:#}", luthier_material::schema()))
}

use luthier_shader::{MaterialSet, TableFace, Target, complete, complete_spirv, emit, emit_spirv};

use crate::bake_files::material_entries;
use crate::cli::ShaderOptions;
use crate::failure::{Failure, Outcome, files};
use crate::materials::{read, read_image, shaded, valid};
use crate::output::print_bytes;

/// Prints or writes the shader of some materials, without baking them.
pub(crate) fn run(options: &ShaderOptions) -> Outcome {
    let materials = shaded(valid(read(&options.sources.paths)?, false)?, &options.shading);
    let outline = luthier_bake::outline(&materials, &read_image).map_err(Failure::input)?;
    let entries = material_entries(&materials, &outline.materials, &mut Vec::new())?;
    let tables = outline.tables.into_iter().map(|(kind, layout, format)| TableFace { kind, layout, format }).collect();
    let set = MaterialSet { materials: &entries, tables };
    let (form, target) = (options.form.into(), options.target.into());
    let bytes = match (target, options.complete) {
        (Target::SpirV, true) => complete_spirv(&set, form),
        (Target::SpirV, false) => emit_spirv(&set, form),
        (_, true) => complete(&set, form, target).map(String::into_bytes),
        (_, false) => emit(&set, form, target).map(String::into_bytes),
    };
    let bytes = bytes.map_err(Failure::input)?;
    match &options.output {
        Some(path) => std::fs::write(path, bytes).map_err(files(path, "write")),
        None => print_bytes(&bytes, target != Target::SpirV),
    }
}

use luthier_shader::{MaterialSet, TableFace, complete, emit};

use crate::bake_files::material_entries;
use crate::cli::ShaderOptions;
use crate::failure::{Failure, Outcome};
use crate::materials::{read, read_image, shaded, valid};
use crate::output::print;

/// Prints the shader of some materials, without baking them.
pub(crate) fn run(options: &ShaderOptions) -> Outcome {
    let materials = shaded(valid(read(&options.sources.paths)?, false)?, &options.shading);
    let outline = luthier_bake::outline(&materials, &read_image).map_err(Failure::input)?;
    let entries = material_entries(&materials, &outline.materials);
    let tables = outline.tables.into_iter().map(|(kind, layout, format)| TableFace { kind, layout, format }).collect();
    let set = MaterialSet { materials: &entries, tables };
    let (form, target) = (options.form.into(), options.target.into());
    let text = if options.complete { complete(&set, form, target) } else { emit(&set, form, target) };
    print(&text.map_err(Failure::input)?)
}

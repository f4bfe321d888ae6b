//! Materials that a command works on.

use luthier_export::{Source, of_model, refuse};
use luthier_lut::TableKind;
use luthier_material::{Diagnostic, Material};

use crate::cli::Shading;
use crate::failure::{Broken, Failure, Outcome};
use crate::output::{complain, has_colour};

/// Prints diagnostics of a text to standard error.
pub(crate) fn print_diagnostics<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>, text: &str) {
    let colour = has_colour();
    for diagnostic in diagnostics {
        let rendered = if colour { diagnostic.render_coloured(text) } else { diagnostic.render(text) };
        complain(&format!("{rendered}\n"));
    }
}

/// Prints all diagnostics of a file to standard error.
pub(crate) fn print_source(source: &Source) {
    print_diagnostics(source.diagnostics(), &source.text);
}

/// The materials of all files; or, when any is invalid, its diagnostics and a failure.
pub(crate) fn valid(sources: Vec<Source>, quiet: bool) -> Outcome<Vec<Material>> {
    let broken = sources.iter().filter(|s| s.parsed.is_err()).count();
    if broken > 0 {
        let broken_sources = || sources.iter().filter(|s| s.parsed.is_err());
        broken_sources().for_each(print_source);
        let sentence = format!("{broken} of {} material files cannot be used; nothing was written", sources.len());
        let diagnostics = broken_sources().flat_map(Source::diagnostics).cloned().collect();
        return Err(Failure::input(Broken { sentence, diagnostics }));
    }
    if !quiet {
        for source in &sources {
            print_source(source);
        }
    }
    Ok(sources.into_iter().filter_map(|s| s.parsed.ok()).map(|parsed| parsed.material).collect())
}

/// The materials that can be baked, shaded by the model that the command line asks for; or, when anything is refused, its diagnostics
/// and a failure.
pub(crate) fn bakeable(mut sources: Vec<Source>, shading: &Shading, quiet: bool) -> Outcome<Vec<Material>> {
    refuse(&mut sources, |material| of_model(material, shading.model));
    Ok(shaded(valid(sources, quiet)?, shading))
}

/// The materials, shaded by the model that the command line asks for, with its tables.
pub(crate) fn shaded(mut materials: Vec<Material>, shading: &Shading) -> Vec<Material> {
    if shading.model.is_some() {
        materials.iter_mut().for_each(|material| material.bake.model = shading.model);
    }
    with_tables(materials, &shading.tables)
}

/// The materials, each asking for some kinds of tables beside its own.
pub(crate) fn with_tables(mut materials: Vec<Material>, tables: &[TableKind]) -> Vec<Material> {
    materials.iter_mut().for_each(|material| material.bake.tables.extend(tables));
    materials
}

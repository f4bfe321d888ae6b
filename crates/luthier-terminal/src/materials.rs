//! Materials of files that a command line names.

use luthier::Source;
use luthier_material::{Diagnostic, Material};

use crate::{Broken, Failure, Outcome, complain, diagnostic as as_json, has_colour, has_events, tell};

/// Prints diagnostics of a text to standard error; as events where the command line asks for them.
pub fn print_diagnostics<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>, text: &str) {
    let colour = has_colour();
    for diagnostic in diagnostics {
        if has_events() {
            let mut event = as_json(diagnostic);
            event["event"] = "diagnostic".into();
            tell(&event);
            continue;
        }
        let rendered = if colour { diagnostic.render_coloured(text) } else { diagnostic.render(text) };
        complain(&format!("{rendered}\n"));
    }
}

/// Prints all diagnostics of a file to standard error.
fn print_source(source: &Source) {
    print_diagnostics(source.diagnostics(), &source.text);
}

/// The materials of all files. If any file is invalid, its diagnostics are printed and the result is a failure.
pub fn valid(sources: Vec<Source>, quiet: bool) -> Outcome<Vec<Material>> {
    let broken: Vec<&Source> = sources.iter().filter(|s| s.parsed.is_err()).collect();
    if !broken.is_empty() {
        broken.iter().for_each(|source| print_source(source));
        let (count, all) = (broken.len(), sources.len());
        let sentence = format!("{count} of {all} material files cannot be used; nothing was written");
        let diagnostics = broken.into_iter().flat_map(Source::diagnostics).cloned().collect();
        return Err(Failure::input(Broken { sentence, diagnostics }));
    }
    if !quiet {
        for source in &sources {
            print_source(source);
        }
    }
    Ok(sources.into_iter().filter_map(|s| s.parsed.ok()).map(|parsed| parsed.material).collect())
}

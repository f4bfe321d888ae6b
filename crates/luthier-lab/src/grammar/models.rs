//! Models that show a key, by what `luthier check` says of its sample.

use std::path::Path;

use luthier_export::{Source, of_model, of_text};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::{Diagnostic, Material, Severity, left_out};
use luthier_terminal::{Outcome, valid};

use super::samples::Sample;

/// The materials of a sample, by value. Maps are those of the lab.
pub(crate) fn materials(sample: &Sample) -> Outcome<Vec<Material>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/sample.toml");
    let sources: Vec<Source> = sample.texts().into_iter().map(|text| of_text(&path, text)).collect();
    valid(sources, true)
}

/// Which models show a key, in a sentence.
pub(crate) fn sentence(sample: &Sample) -> Outcome<String> {
    if sample.is_surface() {
        return Ok("All models show it.".to_owned());
    }
    if sample.key == "bake.model" {
        return Ok("It is the model.".to_owned());
    }
    let materials = materials(sample)?;
    let (mut shown, mut partly, mut refused, mut dropped) = (vec![], vec![], vec![], vec![]);
    for model in ShadingModel::ALL {
        let name = format!("`{}`", model.name());
        let forms: Vec<Vec<Form>> = materials.iter().map(|material| hidden(material, sample.at, model)).collect();
        if materials.iter().any(|material| is_refused(material, sample.at, model)) {
            refused.push(name);
        } else if forms.iter().any(|forms| forms.len() == Form::ALL.len()) {
            dropped.push(name);
        } else if let Some(form) = forms.iter().flatten().next() {
            let other = if *form == Form::Baked { Form::Full } else { Form::Baked };
            partly.push(format!("{name} (in the form `{other}`)"));
        } else {
            shown.push(name);
        }
    }
    let all = shown.len() == ShadingModel::ALL.len();
    shown.extend(partly);
    let mut sentence = if all { "All models show it.".to_owned() } else { format!("Shown by {}.", shown.join(", ")) };
    if !dropped.is_empty() {
        sentence.push_str(&format!(" Left out, with a warning, by {}.", dropped.join(", ")));
    }
    if !refused.is_empty() {
        sentence.push_str(&format!(" Refused for {}.", refused.join(", ")));
    }
    Ok(sentence)
}

/// Forms in which a model leaves out what stands at a key.
fn hidden(material: &Material, at: &str, model: ShadingModel) -> Vec<Form> {
    left_out(material, model).into_iter().filter(|part| part.key == at).flat_map(|part| part.forms).collect()
}

/// Whether a file with this model is refused because of the key.
fn is_refused(material: &Material, at: &str, model: ShadingModel) -> bool {
    let place = material.places.span(at);
    let is_there = |doubt: &Diagnostic| doubt.span.start < place.end && place.start < doubt.span.end;
    let doubts = of_model(material, Some(model));
    material.places.has(at) && doubts.iter().any(|doubt| doubt.severity == Severity::Error && is_there(doubt))
}

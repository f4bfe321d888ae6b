//! Models that show a key, found by checking its sample.

use luthier::Source;
use luthier::refusals::of_model;
use luthier_manifest::ModelPart;
use luthier_manifest::{Form, Masking, ShadingModel};
use luthier_material::{Material, left_out};
use luthier_terminal::{Outcome, valid};

use super::samples::Sample;

/// The materials of a sample, one for each value. Their maps are in the lab's folder.
pub(crate) fn materials(sample: &Sample) -> Outcome<Vec<Material>> {
    let path = crate::maps::maps("sample.toml");
    let sources: Vec<Source> = sample.texts().into_iter().map(|text| Source::of_text(&path, text)).collect();
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
    let (mut shown, mut partly, mut dropped, mut refused) = (vec![], vec![], vec![], vec![]);
    for model in ShadingModel::ALL {
        let name = format!("`{}`", model.name());
        let of_values: Vec<Shown> = materials.iter().map(|material| of_value(material, sample.at, model)).collect();
        if of_values.contains(&Shown::Refused) {
            refused.push(name.clone() + &some(sample, &of_values, Shown::Refused));
        }
        if of_values.contains(&Shown::Not) {
            dropped.push(name.clone() + &some(sample, &of_values, Shown::Not));
        }
        if of_values.contains(&Shown::WithMasking) {
            partly.push(format!("{name} (with `masking = \"{}\"`)", MASKING.name()));
        } else if let Some(form) = Form::ALL.into_iter().find(|form| of_values.contains(&Shown::In(*form))) {
            partly.push(format!("{name} (in the form `{form}`)"));
        } else if !of_values.contains(&Shown::Refused) && !of_values.contains(&Shown::Not) {
            shown.push(name);
        }
    }
    if shown.len() == ShadingModel::ALL.len() {
        return Ok("All models show it.".to_owned());
    }
    shown.extend(partly);
    let mut sentence = format!("Shown by {}.", shown.join(", "));
    for (words, names) in [("Left out, with a warning, by", dropped), ("Refused for", refused)] {
        if !names.is_empty() {
            sentence.push_str(&format!(" {words} {}.", names.join(", ")));
        }
    }
    Ok(sentence)
}

/// How a model shows a value.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shown {
    Whole,
    /// In one form of the shader alone.
    In(Form),
    /// Only if the file has another masking than the default.
    WithMasking,
    Not,
    Refused,
}

/// A masking that any distribution has.
const MASKING: Masking = Masking::VCavity;

fn of_value(material: &Material, at: &str, model: ShadingModel) -> Shown {
    if at.split('|').any(|key| is_refused(material, key, model)) {
        let mut other = material.clone();
        other.bake.masking = Some(MASKING);
        let takes = model.takes(ModelPart::Masking) && material.bake.masking.is_none();
        return if takes && !is_refused(&other, at, model) { Shown::WithMasking } else { Shown::Refused };
    }
    match left_out(material, model).into_iter().find(|part| at.split('|').any(|key| hides(&part.key, key))) {
        None => Shown::Whole,
        Some(part) if part.forms.len() == Form::ALL.len() => Shown::Not,
        Some(part) => Form::ALL.into_iter().find(|form| !part.forms.contains(form)).map_or(Shown::Not, Shown::In),
    }
}

/// True where the part that a model leaves out is `key` or its layer.
fn hides(left_out: &str, key: &str) -> bool {
    let [above, layer] = [left_out, key]
        .map(|key| key.strip_prefix("layer.").and_then(|rest| rest.split('.').next()?.parse::<usize>().ok()));
    left_out == key || left_out.ends_with(".type") && !left_out.contains("film") && above <= layer
}

/// The values that a model shows in a way, in brackets; empty if it is all of them.
fn some(sample: &Sample, of_values: &[Shown], which: Shown) -> String {
    let is_choice = sample.labels().all(|label| label.starts_with('\''));
    if !is_choice || of_values.iter().all(|shown| *shown == which) {
        return String::new();
    }
    let named = sample.labels().zip(of_values).filter(|(_, shown)| **shown == which);
    let values: Vec<String> = named.map(|(label, _)| format!("`{}`", label.replace('\'', "\""))).collect();
    format!(" ({})", values.join(", "))
}

/// True where a file with this model is refused because of the key.
fn is_refused(material: &Material, at: &str, model: ShadingModel) -> bool {
    let place = material.places.span(at);
    let doubts = of_model(material, Some(model));
    material.places.has(at)
        && doubts.iter().any(|doubt| doubt.is_error() && doubt.span.start < place.end && place.start < doubt.span.end)
}

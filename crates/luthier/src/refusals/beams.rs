//! Errors about numbers of the model `granier-heidrich`: the material has another model, or lacks the part that a number describes. A warning about
//! lobes that do not carry their light.

use std::f64::consts::PI;

use luthier_layers::layers::ALPHA_MIN;
use luthier_manifest::ModelPart;
use luthier_manifest::{LobeHeight, ShadingModel};
use luthier_material::{Diagnostic, Material, Severity};
use luthier_optics::stack::Base;

const TABLE: &str = "bake.granier-heidrich";
const EXPONENTS: &str = "layer.0.exponents";
const LEAN: &str = "layer.0.maps.lean";

/// The keys of the model's numbers that a material has: exponents and the lean of the first layer, and the table of
/// `[bake]`.
pub(crate) fn keys(material: &Material) -> impl Iterator<Item = &'static str> {
    let has_exponents = material.layers.first().is_some_and(|first| first.exponents.is_some());
    let has_lean = material.layers.first().is_some_and(|first| first.maps.lean.is_some());
    let given = [(EXPONENTS, has_exponents), (LEAN, has_lean), (TABLE, material.bake.beams.is_some())];
    given.into_iter().filter(|(_, is_given)| *is_given).map(|(key, _)| key)
}

/// Errors and warnings for a material that `model` shades.
pub(crate) fn of_beams(material: &Material, model: ShadingModel) -> Vec<Diagnostic> {
    if !model.takes(ModelPart::Beams) {
        return keys(material).map(|key| of_other_model(material, model, key)).collect();
    }
    let mut errors: Vec<_> = of_height(material).into_iter().collect();
    let Some(first) = material.stack.layers.first() else { return errors };
    let has_inner = !first.films.is_empty() || matches!(first.base, Base::Dielectric { .. });
    let tilt = format!("{TABLE}.inner_tilt_deg");
    if !has_inner && material.bake.beams.is_some_and(|beams| beams.inner_tilt != 0.0) {
        let message = "the first interface has neither film nor slab, so that no inner boundary could lean".to_owned();
        errors.push(error(material, &tilt, message, "leave it out, or put a film or a dielectric on top"));
    }
    if !has_inner && material.layers.first().is_some_and(|first| first.maps.lean.is_some()) {
        let message = "the first interface has neither film nor slab, so that no inner boundary could lean".to_owned();
        errors.push(error(material, LEAN, message, "leave it out, or put a film or a dielectric on top"));
    }
    if let (false, Some([outer, inner])) = (has_inner, material.layers.first().and_then(|first| first.exponents)) {
        let message = format!(
            "the first interface has neither film nor slab, so that no inner boundary has a lobe of exponent {inner}"
        );
        let hint = format!("write `alpha = {:.6}`, which is the exponent {outer}", (2.0 / (outer + 2.0)).sqrt());
        errors.push(error(material, EXPONENTS, message, &hint));
    }
    if let Base::Dielectric { ior, .. } = &first.base
        && ior.f82_tint() != [1.0; 3]
    {
        let message = "`granier-heidrich` shows no edge tint of an interface that lets light through".to_owned();
        errors.push(error(
            material,
            "layer.0.f82_tint",
            message,
            "leave it out, write `metallic = 1`, or name another model",
        ));
    }
    let weight = format!("{TABLE}.diffuse_weight");
    let has_base = material.stack.layers.last().is_some_and(|last| matches!(last.base, Base::Diffuse(_)));
    if !has_base && material.places.has(&weight) {
        let message = "the material has no diffuse base, whose light this weight is a factor on".to_owned();
        errors.push(error(material, &weight, message, "leave it out, or add a layer of type `diffuse`"));
    }
    errors
}

/// The warning about lobes of height one, with the share of its light at the normal that each carries.
fn of_height(material: &Material) -> Option<Diagnostic> {
    (material.bake.beams?.lobe_height == LobeHeight::One).then_some(())?;
    let [outer, inner] = exponents(material)?.map(|e| 2.0 * PI / (e + 1.0));
    let message = format!(
        "lobes of height one carry 2 pi / (e + 1) of their light at the normal: {outer:.3} of it outside, and {inner:.3} n^2 of it from an inner \
         boundary"
    );
    let hint = "`scaled`, the default, has each lobe carry all of it".to_owned();
    Some(material.diagnostic(Severity::Warning, &format!("{TABLE}.lobe_height"), message, Some(hint)))
}

/// The exponents of both lobes; `None` without a surface.
fn exponents(material: &Material) -> Option<[f64; 2]> {
    let first = material.stack.layers.first().filter(|first| !matches!(first.base, Base::Diffuse(_)))?;
    let alpha = first.surface.alpha_isotropic().max(ALPHA_MIN);
    let of_surface = 2.0 / (alpha * alpha) - 2.0;
    Some(material.layers.first().and_then(|given| given.exponents).unwrap_or([of_surface; 2]))
}

/// The error for a key of beams in a material of a model without beams.
fn of_other_model(material: &Material, model: ShadingModel, key: &str) -> Diagnostic {
    let name = key.rsplit_once('.').map_or(key, |(_, name)| name);
    let (what, hint) = match key {
        TABLE => ("numbers", "leave the table out, or write `[bake] model = \"granier-heidrich\"`"),
        LEAN => ("a lean", "leave the map out, or write `[bake] model = \"granier-heidrich\"`"),
        _ => ("lobes", "write `alpha` or `roughness`, or `[bake] model = \"granier-heidrich\"`"),
    };
    let message = format!("`{name}` gives {what} of the model `granier-heidrich`, and this material has `{model}`");
    error(material, key, message, hint)
}

fn error(material: &Material, key: &str, message: String, hint: &str) -> Diagnostic {
    material.diagnostic(Severity::Error, key, message, Some(hint.to_owned()))
}

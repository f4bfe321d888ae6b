//! Doubts about the model that shades a material: parts that it leaves out, quantities outside its domain.

use luthier_bake::{VARIED_LAYERS_MAX, is_too_deep};
use luthier_layers::domain::{Outside, outside};
use luthier_manifest::{Feature, Form, ShadingModel};
use luthier_material::{Diagnostic, LeftOut, Material, Severity, left_out};
use luthier_model::Quantity;

use super::parts::of_parts;

/// Warnings about a material in its model, and errors where the result would be useless. `asked` is the model of the command line.
///
/// ```
/// use luthier::{ShadingModel, refusals};
///
/// let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n\
///             [[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
/// let coat = luthier::parse("coat.toml", text)?;
/// assert!(refusals::of_model(&coat, None).is_empty());
/// // One interface alone: the layer below is left out.
/// assert!(!refusals::of_model(&coat, Some(ShadingModel::Microfacet)).is_empty());
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_model(material: &Material, asked: Option<ShadingModel>) -> Vec<Diagnostic> {
    let model = asked.unwrap_or_else(|| material.model());
    let dropped = left_out(material, model);
    let mut doubts = of_domain(material, asked);
    if let Some(layer) = material.film_of_lobes().filter(|_| !model.is_fitted()) {
        doubts.push(film_of_lobes(material, model, layer));
    }
    if asked.is_none() {
        doubts.extend(material.unfit_for_lobes().iter().map(|part| instead(material, part)));
    }
    // A model without the distribution of a layer is refused: an error says so.
    let dropped = dropped.iter().filter(|part| part.feature != Feature::Distribution);
    doubts.extend(dropped.map(|part| dropped_part(material, model, part)));
    doubts.extend(of_parts(material, asked));
    doubts
}

/// Warnings for a material in a scene: only values outside the model's domain. The scene picks the model, so missing features are not reported.
///
/// ```
/// use luthier::{ShadingModel, refusals};
///
/// let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 2.4\nalpha = 0.1\n\
///             [[layer]]\ntype = \"conductor\"\nior = \"ag\"\nalpha = 0.3\n";
/// let coat = luthier::parse("coat.toml", text)?;
/// let warnings = refusals::of_domain(&coat, Some(ShadingModel::WeidlichWilkie));
/// assert!(warnings[0].message.contains("2.4 is outside the domain"), "{warnings:?}");
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_domain(material: &Material, asked: Option<ShadingModel>) -> Vec<Diagnostic> {
    let model = asked.unwrap_or_else(|| material.model());
    let mut found: Vec<Diagnostic> =
        outside(model, &material.stack).iter().map(|outside| domain(material, model, outside)).collect();
    let mut shaded = material.clone();
    shaded.bake.model = Some(model);
    found.extend(is_too_deep(&shaded).then(|| too_deep(material)));
    found
}

/// A warning for a stack of more layers than are fitted, at the first layer that is too many.
fn too_deep(material: &Material) -> Diagnostic {
    let (layers, most) = (material.stack.layers.len(), VARIED_LAYERS_MAX);
    let message = format!(
        "`lobes` fits stacks of at most {most} layers where a map, a film that varies, patina or tangents vary them, and this one has {layers}: its fits would take minutes"
    );
    let hint = "join layers, or write `[bake] model = \"elek\"`, which simulates nothing".to_owned();
    material.diagnostic(Severity::Error, &format!("layer.{most}"), message, Some(hint))
}

/// An error for a film over maps of the F0 in a model that has one reflectance for all places.
fn film_of_lobes(material: &Material, model: ShadingModel, layer: usize) -> Diagnostic {
    let (film, hint) = if material.layers[layer].metallic.is_some() {
        (
            "film on a surface whose maps give each place another F0",
            "leave the film out, or leave out the maps of `base_color` and `metallic`",
        )
    } else {
        ("film that varies below the first layer", "write one number for its thickness")
    };
    let message = format!("`{}` shows no {film}: only `lobes` does", model.name());
    material.diagnostic(Severity::Error, &format!("layer.{layer}.film.0.type"), message, Some(hint.to_owned()))
}

/// A warning where the default model is not `lobes`, with the reason.
fn instead(material: &Material, part: &LeftOut) -> Diagnostic {
    let (model, feature) = (material.model().name(), part.feature.name());
    let message = format!("the default model, `lobes`, does not show {feature}: `{model}` takes its place");
    let hint = match material.model_without_fit().name() {
        closed if closed != model => format!(
            "write `[bake] model = \"{model}\"` to choose it; `\"{closed}\"` is cheaper, and too bright for coats over metals"
        ),
        _ => format!("write `[bake] model = \"{model}\"` to choose it; it has one bounce for each interface"),
    };
    material.diagnostic(Severity::Warning, &part.key, message, Some(hint))
}

fn dropped_part(material: &Material, model: ShadingModel, part: &LeftOut) -> Diagnostic {
    let LeftOut { feature, key, forms } = part;
    let able = ShadingModel::ALL.into_iter().filter(|other| forms.iter().all(|&form| other.honours(*feature, form)));
    let able: Vec<ShadingModel> = able.collect();
    let whole: Vec<ShadingModel> = able.iter().copied().filter(|other| left_out(material, *other).is_empty()).collect();
    let listed = if whole.is_empty() { able } else { whole };
    let names: Vec<String> = listed.iter().map(|other| format!("`{}`", other.name())).collect();
    let other_form = Form::ALL.into_iter().find(|form| !forms.contains(form));
    let here = match forms.as_slice() {
        [form] => format!(" in its `{form}` form"),
        _ => String::new(),
    };
    let hint = match (names.as_slice(), other_form) {
        ([], Some(form)) => format!("read the `{form}` form"),
        ([], None) => "no model shows it: leave it out".to_owned(),
        (names, form) => {
            let form = form.map_or_else(String::new, |form| format!(", or read the `{form}` form"));
            format!("shown by {}: write `[bake] model = ...`{form}", names.join(", "))
        }
    };
    let message = format!("the model `{}` leaves out {}{here}", model.name(), feature.name());
    material.diagnostic(Severity::Warning, key, message, Some(hint))
}

fn domain(material: &Material, model: ShadingModel, outside: &Outside) -> Diagnostic {
    let Outside { layer, limit, value } = outside;
    let model = model.name();
    let severity = if limit.refuses { Severity::Error } else { Severity::Warning };
    let key = match limit.quantity {
        Quantity::Alpha => {
            let keys = ["roughness", "alpha", "slope_deg", "alpha_x", "exponent", "abc", "sgd"];
            keys.into_iter().find(|key| material.places.has(&format!("layer.{layer}.{key}"))).unwrap_or("type")
        }
        Quantity::FilmNm => "film.0.thickness_nm",
        Quantity::OpticalDepth => "absorption_per_um",
        Quantity::Index | Quantity::MetalK | Quantity::Layers => "ior",
    };
    let name = limit.quantity.name();
    let message = format!("{name} {} is outside the domain of `{model}`: {}", short(*value), limit.reason);
    let hint = match limit.quantity {
        Quantity::Index | Quantity::Layers => "write `[bake] model = \"belcour\"`, which has it".to_owned(),
        _ => format!("`{model}` may be used from {} to {}", short(limit.least), short(limit.most)),
    };
    material.diagnostic(severity, &format!("layer.{layer}.{key}"), message, Some(hint))
}

/// A number in four digits, without trailing zeros.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) || rounded == 0.0 { format!("{rounded}") } else { format!("{rounded:e}") }
}

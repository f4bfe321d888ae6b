//! Materials that leave the domain of the model that shades them.

use luthier_layers::domain::{Outside, Quantity, outside};
use luthier_lut::ShadingModel;
use luthier_material::{Diagnostic, LayerPart, ModelSetting, Parsed, Severity};

use crate::materials::Source;

/// Adds a warning for all that is outside the domain, and makes a file unusable whose values would be wrong beyond use. `asked` is the model
/// of the command line.
pub(crate) fn check(sources: &mut [Source], asked: Option<ModelSetting>) {
    for source in sources {
        let Ok(parsed) = &mut source.parsed else { continue };
        let model = asked.or(parsed.material.bake.model).map_or(ShadingModel::Elek.name(), ModelSetting::name);
        let found: Vec<Diagnostic> =
            outside(model, &parsed.material.stack).iter().map(|o| diagnostic(parsed, model, o)).collect();
        parsed.warnings.extend(found);
        parsed.warnings.sort_by_key(|d| (d.span.start, d.span.end));
        if parsed.warnings.iter().any(|d| d.severity == Severity::Error) {
            let all = std::mem::take(&mut parsed.warnings);
            source.parsed = Err(all.into_iter().filter(|d| d.severity == Severity::Error).collect());
        }
    }
}

fn diagnostic(parsed: &Parsed, model: &str, outside: &Outside) -> Diagnostic {
    let Outside { layer, limit, value } = outside;
    let severity = if limit.refuses { Severity::Error } else { Severity::Warning };
    let part = match limit.quantity {
        Quantity::Alpha => LayerPart::Surface,
        Quantity::FilmNm => LayerPart::Film,
        Quantity::OpticalDepth => LayerPart::Slab,
        Quantity::Index | Quantity::MetalK | Quantity::Layers => LayerPart::Index,
    };
    let name = limit.quantity.name();
    let message = format!("{name} {} is outside the domain of `{model}`: {}", short(*value), limit.reason);
    let hint = match limit.quantity {
        Quantity::Index | Quantity::Layers => "write `[bake] model = \"belcour\"`, which has it".to_owned(),
        _ => format!("`{model}` may be used from {} to {}", short(limit.least), short(limit.most)),
    };
    parsed.diagnostic(severity, *layer, part, message, Some(hint))
}

/// A number in four digits, without trailing zeros.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) || rounded == 0.0 { format!("{rounded}") } else { format!("{rounded:e}") }
}

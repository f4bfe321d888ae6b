//! Decoder of coats that do not darken the base below them (`darkening = false`).

use std::ops::Range;

use luthier_optics::Rgb;
use luthier_optics::brightening::Brightening;
use luthier_optics::ior::Ior;
use luthier_optics::stack::Surface;

use super::live;
use crate::bake_settings::SODIUM_D_NM;
use crate::diagnostic::Sink;
use crate::section::Section;

/// A base below a coat that does not darken it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Brightened {
    pub(super) shares: Brightening,
    /// Share of the surface that the coat covers.
    weight: f64,
}

impl Brightened {
    /// The base below a coat where the coat says so, with the media above and in the coat, and the surface of a metal.
    pub(super) fn of(coat: &Section<'_>, media: [&Ior; 2], metal: Option<&Surface>) -> Option<Self> {
        span(coat)?;
        // The index at this wavelength bends directions.
        let [exterior, within] = media.map(|medium| medium.at(SODIUM_D_NM).re);
        let eta = within / exterior;
        let alpha = metal.map_or(0.0, |surface| libm::sqrt(surface.alpha_x * surface.alpha_y));
        let is_index = eta.is_finite() && eta > 0.0;
        is_index.then(|| Self {
            shares: Brightening::below(eta, alpha),
            weight: coat.number("weight").unwrap_or(1.0).clamp(0.0, 1.0),
        })
    }

    /// The albedo of a diffuse base of a colour.
    pub(super) fn matt(&self, color: Rgb) -> Rgb {
        self.shares.matt(color, self.weight)
    }

    /// The F0 of a metal of a colour.
    pub(super) fn metal(&self, color: Rgb) -> Rgb {
        self.shares.metal(color, self.weight)
    }
}

/// Where a layer says that it does not darken the base below it. Layers of other types lack the key.
fn span(layer: &Section<'_>) -> Option<Range<usize>> {
    (layer.text("type") == Some("dielectric") && layer.flag("darkening") == Some(false))
        .then(|| layer.key_span("darkening"))
}

/// Refuses `darkening = false` of layers that are no coat, or above a base without a colour that could be brighter.
pub(super) fn check(document: &Section<'_>, sink: &mut Sink<'_>) {
    let sections = document.sections("layer");
    let layers: Vec<&Section<'_>> = sections.iter().filter(|at| at.text("type") != Some("thin-film")).collect();
    for (number, layer) in layers.iter().enumerate() {
        let Some(span) = span(layer) else { continue };
        if number > 0 {
            let hint = "leave it out, or move the layer to the top".to_owned();
            sink.error(span, "only the first layer, a coat, leaves the base below it undarkened", Some(hint));
            continue;
        }
        if document.section("effects").is_some_and(|effects| effects.has("patina")) {
            let hint = "leave one of them out, or write a `weight` in place of the patina".to_owned();
            sink.error(span, "`darkening = false` beside `patina`: where none has grown there is no coat", Some(hint));
        } else if let Some((message, hint)) = layers.get(1).map_or(Some(NO_BASE), |base| refusal(layer, base)) {
            sink.error(span, message, Some(hint.to_owned()));
        }
    }
}

/// A message and a hint.
type Refusal = (&'static str, &'static str);

const NO_BASE: Refusal =
    ("below this coat is no base that it could darken", "add the base below it, or leave `darkening` out");

/// Why the base below a coat cannot be brighter.
fn refusal(coat: &Section<'_>, base: &Section<'_>) -> Option<Refusal> {
    let has_map = live::varies;
    match base.text("type") {
        Some("dielectric") => Some((
            "below this coat lies another dielectric, and `darkening = false` is for a base of a colour",
            "leave it out, or make one layer of the two coats",
        )),
        Some("conductor") if base.has("ior") => Some((
            "the metal below this coat has an index, and no colour that could be brighter",
            "give it an `f0` in place of its `ior`, or leave `darkening` out",
        )),
        Some("diffuse") if base.has("reradiation") => Some((
            "the base below this coat is fluorescent, and has no colour that could be brighter",
            "give it an `albedo` in place of `reradiation`, or leave `darkening` out",
        )),
        Some("diffuse") if has_map(base, "albedo") => Some((
            "the base below this coat has a map of its `albedo`, whose texels cannot be brighter",
            "write the base as `type = \"metallic-roughness\"` with a map of `base_color`, or leave `darkening` out",
        )),
        Some("conductor") if has_map(base, "f0") => None,
        Some("metallic-roughness") if has_map(base, "base_color") || has_map(base, "metallic") => None,
        Some("metallic-roughness") if has_map(coat, "weight") => Some((
            "with a map of the weight of this coat, each place needs a colour of its own",
            "write `maps = { base_color = \"white.png\" }` in the layer below, a white picture, or leave `darkening` out",
        )),
        Some(_) if has_map(coat, "weight") => Some((
            "with a map of the weight of this coat, each place needs a colour of its own",
            "write the base as `type = \"metallic-roughness\"` with a map of `base_color`, or leave `darkening` out",
        )),
        _ => None,
    }
}

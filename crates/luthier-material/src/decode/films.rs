//! Decoder of `thin-film` layers, which become films of the layer that follows.

use std::ops::Range as Span;

use luthier_optics::ior::Ior;
use luthier_optics::stack::{Film, FilmThickness};

use super::ior::Read;
use super::{effects, maps, picture};
use crate::diagnostic::Sink;
use crate::doubt::Sources;
use crate::grammar::{NOT_NEGATIVE, POSITIVE};
use crate::material::FilmVariation;
use crate::picture::{PictureRef, TexelUse, VariationSource};
use crate::section::Section;
use crate::suggest::short;

/// A film that waits for the layer that it coats.
pub(super) struct Pending<'t> {
    /// Its table.
    pub(super) at: Section<'t>,
    pub(super) film: Film,
    pub(super) variation: Option<FilmVariation>,
    /// Share of the surface that it covers, and the map that multiplies it.
    pub(super) weight: f64,
    pub(super) weight_map: Option<PictureRef>,
    /// Span of the weight, if that is below 1 or in a map.
    pub(super) weight_span: Option<Span<usize>>,
    /// Span of the `type` of the film.
    pub(super) span: Span<usize>,
    /// Span of the thickness of the film.
    pub(super) thickness_span: Span<usize>,
}

/// One `thin-film` layer.
pub(super) fn decode<'t>(at: Section<'t>, read: Read<'_>, sink: &mut Sink<'_>, sources: &mut Sources) -> Pending<'t> {
    let ior = super::ior::decode(&at, "ior", read, sink, sources).unwrap_or_else(Ior::vacuum);
    let (thickness, variation) = match at.section("thickness_nm") {
        Some(range) => varying(&range, sink),
        None => {
            let nm = at.number("thickness_nm").unwrap_or(1.0);
            (FilmThickness { min_nm: nm, max_nm: nm }, None)
        }
    };
    maps::check(&at, 0, sink);
    Pending {
        film: Film { ior, thickness },
        variation,
        weight: at.number("weight").unwrap_or(1.0),
        weight_map: maps::decode(&at).weight,
        weight_span: effects::weight_span(&at),
        span: at.value_span("type"),
        thickness_span: at.value_span("thickness_nm"),
        at,
    }
}

impl Pending<'_> {
    /// A hint with the thickness that makes the film even.
    pub(super) fn evened(&self) -> Option<String> {
        let nm = self.film.thickness.nominal_nm();
        POSITIVE.contains(nm).then(|| format!("write `thickness_nm = {}`", short(nm)))
    }
}

/// Refuses weights of films that are not alone on the first layer, or lie beside something else that says where the surface is another.
pub(super) fn check_weights(films: &[Pending<'_>], at: &Section<'_>, number: usize, sink: &mut Sink<'_>) {
    for film in films {
        let Some(span) = film.weight_span.clone() else { continue };
        let (message, hint) = if number > 0 {
            ("only a film of the first layer has a weight", "leave it out")
        } else if films.len() > 1 {
            ("a film has a weight where it is the only one of its interface", "leave it out, or leave one film")
        } else if effects::weight_span(at).is_some() {
            ("a weight of the film beside one of the layer that it lies on", "leave one of them out")
        } else if at.flag("darkening") == Some(false) {
            (
                "a weight of a film beside `darkening = false`: the base would need a colour for either",
                "leave one of them out",
            )
        } else {
            continue;
        };
        sink.error(span, message, Some(hint.to_owned()));
    }
}

fn varying(at: &Section<'_>, sink: &mut Sink<'_>) -> (FilmThickness, Option<FilmVariation>) {
    let min_nm = at.number("min").unwrap_or(0.0);
    let max_nm = at.number("max").unwrap_or(min_nm);
    // The checker has reported ends that are out of range by themselves.
    if min_nm > max_nm && [min_nm, max_nm].into_iter().all(|nm| NOT_NEGATIVE.contains(nm)) {
        let hint = format!("write `min = {}, max = {}`", short(max_nm), short(min_nm));
        let message = format!("the range is upside down: min {} is above max {}", short(min_nm), short(max_nm));
        sink.error(at.span.clone(), message, Some(hint));
    }
    let variation = map(at, "map", sink).zip(at.number("extent_um"));
    if let Some(transform) = at.section("map").filter(|map| map.has("transform")) {
        let hint = "say by `extent_um` how wide one repeat is, or turn the picture itself".to_owned();
        let message = "the map of a film lies as the texture coordinates do";
        sink.error(transform.key_span("transform"), message, Some(hint));
    }
    let variation = variation.map(|(source, extent_um)| FilmVariation { source, extent_um });
    (FilmThickness { min_nm, max_nm }, variation)
}

/// A map of one number: noise or a picture.
pub(super) fn map(of: &Section<'_>, key: &str, sink: &mut Sink<'_>) -> Option<VariationSource> {
    if let Some(picture) = picture::under(of, key) {
        if let Some(at) = of.section(key) {
            picture::check(&at, TexelUse::Number, sink);
        }
        return Some(VariationSource::Image(picture));
    }
    let at = of.section(key)?;
    picture::check_absent(&at, sink);
    let noise = at.section("noise")?;
    Some(VariationSource::Noise {
        seed: noise.integer("seed").unwrap_or(0),
        frequency: noise.number("frequency").unwrap_or(4.0),
        octaves: noise.integer("octaves").unwrap_or(4),
    })
}

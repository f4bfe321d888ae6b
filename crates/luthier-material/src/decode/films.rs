use std::ops::Range as Span;

use luthier_optics::ior::Ior;
use luthier_optics::stack::{Film, FilmThickness};

use super::Read;
use crate::diagnostic::Sink;
use crate::doubt::Sources;
use crate::material::{FilmVariation, VariationSource};
use crate::section::Section;
use crate::suggest::short;

/// A film that waits for the layer that it coats.
pub(super) struct Pending {
    pub(super) film: Film,
    pub(super) variation: Option<FilmVariation>,
    /// Of its `type`.
    pub(super) span: Span<usize>,
    /// Of its thickness.
    pub(super) thickness_span: Span<usize>,
}

/// One `thin-film` layer.
pub(super) fn decode(at: &Section<'_>, read: Read<'_>, sink: &mut Sink<'_>, sources: &mut Sources) -> Pending {
    let ior = super::ior::decode(at, "ior", read, sink, sources).unwrap_or_else(Ior::vacuum);
    let (thickness, variation) = match at.section("thickness_nm") {
        Some(range) => varying(&range, sink),
        None => {
            let nm = at.number("thickness_nm").unwrap_or(1.0);
            (FilmThickness { min_nm: nm, max_nm: nm }, None)
        }
    };
    Pending {
        film: Film { ior, thickness },
        variation,
        span: at.value_span("type"),
        thickness_span: at.value_span("thickness_nm"),
    }
}

fn varying(at: &Section<'_>, sink: &mut Sink<'_>) -> (FilmThickness, Option<FilmVariation>) {
    let (min_nm, max_nm) = (at.number("min").unwrap_or(0.0), at.number("max").unwrap_or(f64::MAX));
    if min_nm > max_nm && !sink.has_error_in(&at.span) {
        let hint = format!("write `min = {}, max = {}`", short(max_nm), short(min_nm));
        let message = format!("the range is upside down: min {} is above max {}", short(min_nm), short(max_nm));
        sink.error(at.span.clone(), message, Some(hint));
    }
    let variation = at.section("map").and_then(|map| self::map(&map)).zip(at.number("extent_um"));
    let variation = variation.map(|(source, extent_um)| FilmVariation { source, extent_um });
    (FilmThickness { min_nm, max_nm }, variation)
}

/// A scalar map: noise or an image.
pub(super) fn map(at: &Section<'_>) -> Option<VariationSource> {
    if let Some(path) = at.path("image") {
        return Some(VariationSource::Image { path });
    }
    let noise = at.section("noise")?;
    Some(VariationSource::Noise {
        seed: noise.integer("seed").unwrap_or(0),
        frequency: noise.number("frequency").unwrap_or(4.0),
        octaves: noise.integer("octaves").unwrap_or(4),
    })
}

use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Layer, Slab, Surface};

use super::{Read, films, ior, surface};
use crate::diagnostic::Sink;
use crate::doubt::{LayerSource, Sources};
use crate::material::{LayerExtras, Maps};
use crate::section::Section;

/// The layers of the stack, and what each has beyond its physics.
pub(super) fn decode(
    document: &Section<'_>,
    read: Read<'_>,
    sink: &mut Sink<'_>,
    sources: &mut Sources,
) -> (Vec<Layer>, Vec<LayerExtras>) {
    let sections = document.sections("layer");
    let mut layers = Vec::new();
    let mut extras = Vec::new();
    let mut pending: Vec<films::Pending> = Vec::new();

    for (i, at) in sections.iter().enumerate() {
        let kind = at.text("type").unwrap_or_default();
        if kind == "thin-film" {
            pending.push(films::decode(at, read, sink, sources));
            continue;
        }
        let opaque = matches!(kind, "conductor" | "diffuse");
        let below = sections.len() - 1 - i;
        if opaque && below > 0 {
            let layers = if below == 1 { "the layer".to_owned() } else { format!("the {below} layers") };
            let message = format!("nothing is seen below a {kind}: it must be the last layer");
            let hint = format!("move it to the end, or remove {layers} below it");
            sink.error(at.value_span("type"), message, Some(hint));
        }
        let index = |sink: &mut Sink<'_>, sources: &mut Sources| {
            ior::decode(at, "ior", read, sink, sources).unwrap_or_else(Ior::vacuum)
        };
        let base = match kind {
            "dielectric" => Base::Dielectric { ior: index(sink, sources), slab: slab(at) },
            "conductor" => Base::Conductor { ior: index(sink, sources) },
            "diffuse" => Base::Diffuse(Diffuse {
                albedo: at.rgb("albedo").unwrap_or([0.0; 3]),
                sigma: at.number("sigma").unwrap_or(0.0),
            }),
            // The checker has reported it.
            _ => continue,
        };
        let films = std::mem::take(&mut pending);
        if kind == "diffuse" {
            uncoatable(&films, sink);
        }
        let surface = if kind == "diffuse" { Surface::smooth() } else { surface::decode(at, sink) };
        sources.layers.push(LayerSource::of(at, films.iter().map(|f| f.thickness_span.clone()).collect()));
        extras.push(LayerExtras { film_variation: variation(&films, sink), maps: maps(at) });
        layers.push(Layer { films: films.into_iter().map(|f| f.film).collect(), surface, base });
    }
    if let Some(last) = pending.last() {
        let hint = "add the dielectric or the conductor that it lies on".to_owned();
        sink.error(last.span.clone(), "a thin film coats the next layer, but none follows", Some(hint));
    }
    (layers, extras)
}

fn slab(at: &Section<'_>) -> Slab {
    Slab {
        thickness_um: at.number("thickness_um").unwrap_or(0.0),
        absorption_per_um: at.rgb("absorption_per_um").unwrap_or([0.0; 3]),
    }
}

fn uncoatable(films: &[films::Pending], sink: &mut Sink<'_>) {
    for film in films {
        let hint = "put a dielectric between them".to_owned();
        sink.error(film.span.clone(), "a diffuse base has no interface that a film could coat", Some(hint));
    }
}

/// The variation of the top film; those below it must be even.
fn variation(films: &[films::Pending], sink: &mut Sink<'_>) -> Option<crate::material::FilmVariation> {
    let (top, below) = films.split_first()?;
    for film in below.iter().filter(|f| f.variation.is_some()) {
        let hint = format!("write `thickness_nm = {}`", crate::suggest::short(film.film.thickness.nominal_nm()));
        sink.error(film.thickness_span.clone(), "only the top film of an interface may vary in thickness", Some(hint));
    }
    top.variation.clone()
}

fn maps(at: &Section<'_>) -> Maps {
    let Some(maps) = at.section("maps") else { return Maps::default() };
    Maps { normal: maps.path("normal"), roughness: maps.path("roughness"), thickness: maps.path("thickness") }
}

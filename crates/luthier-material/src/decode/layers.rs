//! Decoder of the list of layers.

use luthier_manifest::MapSlot;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Layer, Slab, Surface};

use super::darkening::Brightened;
use super::ior::Read;
use super::{effects, films, ior, live, maps, reradiation, schlick, surface};
use crate::diagnostic::Sink;
use crate::doubt::Sources;
use crate::grammar::LAYERS_MAX;
use crate::material::{FilmVariation, LayerExtras, Live, Maps, TexelRanges};
use crate::section::Section;

/// The layers of the stack, and the properties of each beyond its physics.
pub(super) fn decode(
    document: &Section<'_>,
    exterior: &Ior,
    read: Read<'_>,
    sink: &mut Sink<'_>,
    sources: &mut Sources,
) -> (Vec<Layer>, Vec<LayerExtras>) {
    let mut sections = document.sections("layer");
    sections.truncate(LAYERS_MAX);
    let mut layers = Vec::new();
    let mut extras = Vec::new();
    let mut pending: Vec<films::Pending<'_>> = Vec::new();

    for (i, at) in sections.iter().enumerate() {
        let kind = at.text("type").unwrap_or_default();
        if kind == "thin-film" {
            pending.push(films::decode(at.clone(), read, sink, sources));
            continue;
        }
        let opaque = matches!(kind, "conductor" | "diffuse" | "metallic-roughness");
        let below = sections.len() - 1 - i;
        if opaque && below > 0 {
            let layers = if below == 1 { "the layer".to_owned() } else { format!("the {below} layers") };
            let message = format!("nothing is seen below a {kind}: it must be the last layer");
            let hint = format!("move it to the end, or remove {layers} below it");
            sink.error(at.value_span("type"), message, Some(hint));
        }
        let above = match layers.last() {
            Some(Layer { base: Base::Dielectric { ior, .. }, .. }) => ior,
            _ => exterior,
        };
        let surface = if kind == "diffuse" { Surface::smooth() } else { surface::decode(at, sink) };
        // Of a coat and its base no layer lies between.
        let coat = sections.iter().find(|at| at.text("type") != Some("thin-film")).filter(|_| layers.len() == 1);
        // The slopes of what can be no metal decide nothing.
        let is_metal = kind == "conductor" || is_metallic(at);
        let metal = is_metal.then_some(&surface);
        let brightened = coat.filter(|_| opaque).and_then(|coat| Brightened::of(coat, [exterior, above], metal));
        let mut below = None;
        let matrix = if kind == "diffuse" { reradiation::decode(at, read, sink) } else { None };
        let base = match kind {
            "dielectric" if at.has("f0") => {
                let ior = at.has("ior").then(|| index(at, read, sink, sources));
                Base::Dielectric { ior: schlick::dielectric(at, ior, above, sink), slab: slab(at) }
            }
            "dielectric" => {
                let ior = index(at, read, sink, sources);
                ior::check_clear(&ior, at, "ior", sink);
                Base::Dielectric { ior, slab: slab(at) }
            }
            "conductor" if at.has("f0") && schlick::maps_f0(at) => {
                let (interface, diffuse) = schlick::textured_conductor(at, above, brightened, sink);
                below = diffuse;
                interface
            }
            "conductor" if at.has("f0") => Base::Conductor { ior: schlick::conductor(at, brightened, sink) },
            "conductor" => {
                schlick::check_tint_of_index(at, sink);
                Base::Conductor { ior: index(at, read, sink, sources) }
            }
            "metallic-roughness" => {
                let (interface, diffuse) = schlick::metallic_roughness(at, above, brightened, sink);
                below = diffuse;
                interface
            }
            "diffuse" => {
                let color = matrix.map(reradiation::albedo).or_else(|| at.reflectance("albedo")).unwrap_or([0.0; 3]);
                let albedo = brightened.map_or(color, |below| below.matt(color));
                Base::Diffuse(Diffuse { albedo, sigma: at.number("sigma").unwrap_or(0.0) })
            }
            // The checker has reported it.
            _ => continue,
        };
        let films = std::mem::take(&mut pending);
        if kind == "diffuse" {
            uncoatable(&films, sink);
        }
        schlick::check_films(at, &films, layers.len(), sink);
        maps::check(at, layers.len(), sink);
        maps::check_f0(at, layers.len(), sections.get(i + 1), sink);
        live::check(at, layers.len(), &surface, sink);
        let number = layers.len();
        let key = format!("layer.{number}");
        sources.places.add(&key, at);
        films.iter().enumerate().for_each(|(i, film)| sources.places.add(&format!("{key}.film.{i}"), &film.at));
        films::check_weights(&films, at, number, sink);
        let weighed = films.first().filter(|film| film.weight_span.is_some());
        let extra = LayerExtras {
            weight: weighed.map_or_else(|| at.number("weight").unwrap_or(1.0), |film| film.weight),
            weighs_film: weighed.is_some(),
            reradiation: matrix,
            film_variation: variation(&films, sink),
            exponents: surface::exponents(at),
            maps: match weighed {
                Some(film) => Maps { weight: film.weight_map.clone(), ..maps::decode(at) },
                None => maps::decode(at),
            },
            live: live::decode(at, &surface),
            metallic: schlick::textured(at),
            stated: schlick::stated(at),
            texels: TexelRanges::default(),
            brightening: brightened.map(|below| below.shares),
        };
        check_weight(at, number, sections.len() - 1 - i, sink);
        if number > 0 {
            only_the_first_has_exponents(at, sink);
            if !schlick::carries_films_that_vary(at) {
                only_the_first_film_varies(&films, sink);
            }
        }
        extras.push(extra);
        layers.push(Layer { films: films.into_iter().map(|f| f.film).collect(), surface, base });
        if let Some(diffuse) = below {
            sources.places.add(&format!("layer.{}", layers.len()), at);
            // Interface and base of the surface have one normal.
            let maps = Maps { bumps: maps::decode(at).bumps, ..Maps::default() };
            let bumps = live::decode(at, &surface).of(MapSlot::Bumps);
            let live = Live::new(bumps.into_iter().collect());
            extras.push(LayerExtras { maps, live, ..LayerExtras::default() });
            let base = Base::Diffuse(diffuse);
            layers.push(Layer { films: Vec::new(), surface: Surface::smooth(), base });
        }
    }
    if let Some(last) = pending.last() {
        let hint = "add the dielectric or the conductor that it lies on".to_owned();
        sink.error(last.span.clone(), "a thin film coats the next layer, but none follows", Some(hint));
    }
    (layers, extras)
}

/// Whether a `metallic-roughness` layer is a metal to some share, or at some places.
fn is_metallic(at: &Section<'_>) -> bool {
    at.number("metallic").is_some_and(|metallic| metallic > 0.0) || schlick::textured(at).is_some()
}

/// The index of a layer. Vacuum stands in for a wrong one, which has been reported.
fn index(at: &Section<'_>, read: Read<'_>, sink: &mut Sink<'_>, sources: &mut Sources) -> Ior {
    ior::decode(at, "ior", read, sink, sources).unwrap_or_else(Ior::vacuum)
}

fn slab(at: &Section<'_>) -> Slab {
    Slab {
        thickness_um: at.number("thickness_um").unwrap_or(0.0),
        absorption_per_um: at.rgb("absorption_per_um").unwrap_or([0.0; 3]),
    }
}

fn uncoatable(films: &[films::Pending<'_>], sink: &mut Sink<'_>) {
    for film in films {
        let hint = "put a dielectric between them".to_owned();
        sink.error(film.span.clone(), "a diffuse base has no interface that a film could coat", Some(hint));
    }
}

/// The variation of the top film; those below it must be even.
fn variation(films: &[films::Pending<'_>], sink: &mut Sink<'_>) -> Option<FilmVariation> {
    let (top, below) = films.split_first()?;
    for film in below.iter().filter(|f| f.variation.is_some()) {
        let message = "only the top film of an interface may vary in thickness";
        sink.error(film.thickness_span.clone(), message, film.evened());
    }
    top.variation.clone()
}

/// Reports a weight of a layer that is none of a coat: the first one, with layers below that are bare elsewhere. A weight of 1 says nothing.
fn check_weight(at: &Section<'_>, number: usize, below: usize, sink: &mut Sink<'_>) {
    let Some(span) = effects::weight_span(at) else { return };
    let (message, hint) = match (number, below) {
        (0, 0) => (
            "a weight needs layers below this one: where it is not, there would be no surface",
            "add the layers below, or leave the weight out",
        ),
        (0, _) => return,
        _ => (
            "only the first layer has a weight: it says where the layers below it are bare",
            "leave it out, or move the layer to the top",
        ),
    };
    sink.error(span, message, Some(hint.to_owned()));
}

/// Reports exponents of a layer below the first: the model has lobes of the first alone.
fn only_the_first_has_exponents(at: &Section<'_>, sink: &mut Sink<'_>) {
    if at.has("exponents") {
        let message = "exponents belong to the first layer: the model granier-heidrich has lobes of no other";
        let hint = "write `smooth = true`: its surface is not seen".to_owned();
        sink.error(at.value_span("exponents"), message, Some(hint));
    }
}

/// Reports a film that varies below the first layer on a medium without an F0, where no rows are over its thickness.
fn only_the_first_film_varies(films: &[films::Pending<'_>], sink: &mut Sink<'_>) {
    if let Some(film) = films.first().filter(|film| film.variation.is_some()) {
        let message = "a film below the first layer varies in thickness on metals with an F0 alone: a `conductor` with `f0`, or `metallic-roughness`";
        sink.error(film.thickness_span.clone(), message, film.evened());
    }
}

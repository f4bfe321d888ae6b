//! Decoder of interfaces that reflect by Schlick's formula: an F0 in place of an index, and the surface of engines.

use luthier_optics::Rgb;
use luthier_optics::f0_table::printed_f0;
use luthier_optics::ior::{Ior, IorSample};
use luthier_optics::schlick::{DIELECTRIC_F0, DIELECTRIC_INDEX, F82, index_of_f0, metallic_and_tinted};
use luthier_optics::stack::{Base, Diffuse, Layer, Slab, Stack};

use super::darkening::Brightened;
use super::{effects, films, live};
use crate::bake_settings::SODIUM_D_NM;
use crate::diagnostic::Sink;
use crate::grammar::INDEX;
use crate::material::Metallic;
use crate::section::Section;
use crate::suggest::short;

/// The opaque medium of a conductor with an `f0`, which is brighter below a coat that does not darken it.
pub(super) fn conductor(at: &Section<'_>, brightened: Option<Brightened>, sink: &mut Sink<'_>) -> Ior {
    let f0 = f0(at, sink);
    Ior::vacuum().with_f0(brightened.map_or(f0, |below| below.metal(f0))).with_f82_tint(f82_tint(at))
}

/// The layers of a conductor whose F0 a map multiplies: those of a `metallic-roughness` surface that is a metal in all places.
pub(super) fn textured_conductor(
    at: &Section<'_>,
    above: &Ior,
    brightened: Option<Brightened>,
    sink: &mut Sink<'_>,
) -> (Base, Option<Diffuse>) {
    let color = f0(at, sink);
    let (metal, matt) = brightened.map_or((color, color), |below| (below.metal(color), below.matt(color)));
    let metal = metal.map(|f0| F82 { f0, tint: 1.0 });
    over_diffuse(above, metallic_and_tinted(metal, [DIELECTRIC_F0; 3], matt, 0.0, DIELECTRIC_INDEX), 0.0)
}

/// An interface that bends light as the usual dielectric does, over a diffuse base of an albedo.
fn over_diffuse(above: &Ior, (curves, albedo): ([F82; 3], Rgb), sigma: f64) -> (Base, Option<Diffuse>) {
    let ior = Ior::engine(above, DIELECTRIC_INDEX).with_f82(curves);
    let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
    (Base::Dielectric { ior, slab }, Some(Diffuse { albedo, sigma }))
}

/// The edge tint of a metal; 1 is none.
fn f82_tint(at: &Section<'_>) -> Rgb {
    at.reflectance("f82_tint").unwrap_or([1.0; 3])
}

/// Reports an edge tint beside an index, which has its own reflectance at every angle.
pub(super) fn check_tint_of_index(at: &Section<'_>, sink: &mut Sink<'_>) {
    if at.has("f82_tint") {
        let message = "an `ior` has its own reflectance at the edge: `f82_tint` is for a metal with an `f0`";
        let hint = "leave it out, or give the metal an `f0` in place of its `ior`".to_owned();
        sink.error(at.key_span("f82_tint"), message, Some(hint));
    }
}

/// The medium of a dielectric with an `f0`: of the index that the file gives beside it, or else of the one whose reflectance against the
/// medium above is the mean of the three numbers.
pub(super) fn dielectric(at: &Section<'_>, given: Option<Ior>, above: &Ior, sink: &mut Sink<'_>) -> Ior {
    let f0 = f0(at, sink);
    let Some(ior) = given else {
        let mean = f0.iter().sum::<f64>() / 3.0;
        let found = relative(above, index_of_f0(mean));
        if let Some(ior) = found.filter(|ior| ior.samples().iter().all(|s| INDEX.contains(s.n))) {
            return ior.with_f0(f0);
        }
        if !sink.has_error_in(&at.value_span("f0")) {
            let hint = "give it beside `f0` as `ior`, or write `type = \"conductor\"`".to_owned();
            sink.error(at.value_span("f0"), "a medium that reflects everything has no index", Some(hint));
        }
        return Ior::vacuum().with_f0(f0);
    };
    let n = ior.at(SODIUM_D_NM).re;
    let is_plain = ior.is_constant() && ior.samples().iter().all(|s| s.k == 0.0);
    let most_above = most(above);
    if !is_plain {
        let message = "beside `f0` an index bends directions only: it is one real number";
        sink.error(at.value_span("ior"), message, Some(format!("write `ior = {}`, or leave `f0` out", short(n))));
    } else if n < most_above && !sink.has_error_in(&at.value_span("ior")) {
        let message = format!("`f0` is for media of no lower index than that above, {}", short(most_above));
        let hint = "leave `ior` out, or leave `f0` out: an index has total reflection, Schlick's formula none";
        sink.error(at.value_span("ior"), message, Some(hint.to_owned()));
    }
    ior.with_f0(f0)
}

/// The interface of a `metallic-roughness` layer, and the diffuse base below it, which a metal lacks:
///
/// - F0 is `f = d + metallic (base_color - d)`, where d is the `f0` of the dielectric, 0.04 if absent;
/// - the index is 1.5 times that of the medium above, whatever the F0 is, so that maps of it and of the metal leave the directions of light;
/// - the albedo of the base is `c / (t + c (1 - t))`, so that it shows `c = base_color (1 - metallic)` of the light that enters;
///   `t = (1 - f)(20/21) / 1.5^2` is the share of the base's light that the smooth interface passes.
///
/// By Saunderson 1942 the surface then reflects `F(cos) + (1 - F(cos)) c` of the light from any direction, as the model of engines does, and
/// its diffuse term is that of Kelemen and Szirmay-Kalos 2001, `c (1 - F(i))(1 - F(o)) / (pi (1 - (f + (1 - f)/21)))`.
///
/// An edge tint is of the metal alone, so that a mixture has its share of it.
///
/// Below a coat that does not darken it the base colour is brighter, one for the metal and another for the rest.
pub(super) fn metallic_roughness(
    at: &Section<'_>,
    above: &Ior,
    brightened: Option<Brightened>,
    sink: &mut Sink<'_>,
) -> (Base, Option<Diffuse>) {
    let color = at.reflectance("base_color").unwrap_or([0.0; 3]);
    // Textures decide at each place how metallic the surface is; the bake has the surface without metal.
    let metallic = if textured(at).is_some() { 0.0 } else { at.number("metallic").unwrap_or(0.0) };
    if metallic >= 1.0 {
        if at.has("sigma") {
            let hint = "leave it out, or give a `metallic` below 1".to_owned();
            sink.warn(
                at.key_span("sigma"),
                "a metal has no diffuse base: its `sigma` is of no consequence",
                Some(hint),
            );
        }
        let f0 = brightened.map_or(color, |below| below.metal(color));
        return (Base::Conductor { ior: Ior::vacuum().with_f0(f0).with_f82_tint(f82_tint(at)) }, None);
    }
    if at.has("f82_tint") && metallic == 0.0 && textured(at).is_none() {
        let hint = "leave it out, or give a `metallic` above 0".to_owned();
        sink.warn(
            at.key_span("f82_tint"),
            "an edge tint is of a metal: without one it is of no consequence",
            Some(hint),
        );
    }
    let (metal, matt) = brightened.map_or((color, color), |below| (below.metal(color), below.matt(color)));
    let tint = f82_tint(at);
    let metal = [0, 1, 2].map(|c: usize| F82 { f0: metal[c], tint: tint[c] });
    let mixed = metallic_and_tinted(metal, dielectric_f0(at, sink), matt, metallic, DIELECTRIC_INDEX);
    over_diffuse(above, mixed, at.number("sigma").unwrap_or(0.0))
}

/// Base colour and metal of a `metallic-roughness` layer, where maps of the file multiply them; or F0 of a conductor, where a map does.
pub(super) fn textured(at: &Section<'_>) -> Option<Metallic> {
    let is_varied = match at.text("type") {
        Some("conductor") => maps_f0(at),
        _ => ["base_color", "metallic", "f0"].iter().any(|key| live::varies(at, key)),
    };
    stated(at).filter(|_| is_varied)
}

/// Base colour and metal of a `metallic-roughness` layer, or F0 of a conductor, as the file has them.
pub(super) fn stated(at: &Section<'_>) -> Option<Metallic> {
    let of_file = |key: &str| {
        let printed = at.text(key).and_then(printed_f0).map(|printed| printed.map(|value| value.min(1.0)));
        printed.or_else(|| at.reflectance(key))
    };
    let f82_tint = f82_tint(at);
    match at.text("type") {
        Some("conductor") => {
            let base_color = of_file("f0")?;
            Some(Metallic { base_color, metallic: 1.0, f82_tint, dielectric: [DIELECTRIC_F0; 3], is_metal: true })
        }
        Some("metallic-roughness") => Some(Metallic {
            base_color: at.reflectance("base_color").unwrap_or([0.0; 3]),
            metallic: at.number("metallic").unwrap_or(0.0),
            f82_tint,
            dielectric: of_file("f0").unwrap_or([DIELECTRIC_F0; 3]),
            is_metal: false,
        }),
        _ => None,
    }
}

/// Whether a map multiplies the F0 of a layer.
pub(super) fn maps_f0(at: &Section<'_>) -> bool {
    at.section("maps").is_some_and(|maps| maps.has("f0"))
}

/// Reports a patina over an interface with an F0 that would lie below a denser medium where no patina has grown.
pub(super) fn check_bare(document: &Section<'_>, stack: &Stack, sink: &mut Sink<'_>) {
    let Some(Layer { base: Base::Dielectric { ior, .. }, .. }) = stack.layers.get(1) else { return };
    let least = ior.samples().iter().fold(f64::INFINITY, |least: f64, s| least.min(s.n));
    if ior.f0().is_some() && least < most(&stack.exterior) {
        let span = document.section("effects").map_or(0..0, |effects| effects.key_span("patina"));
        let message = "the layer below the patina has an `f0` and a lower index than the exterior, which it meets where none has grown";
        sink.error(span, message, Some("give that layer an `ior` in place of its `f0`".to_owned()));
    }
}

/// Reports a weight of a coat over a dielectric with an F0 alone, whose index follows from the medium above: where the coat is not, that is the exterior. A
/// dielectric that has an index, too, keeps it; a `metallic-roughness` layer bends light by the same ratio in either place.
pub(super) fn check_below_weight(document: &Section<'_>, sink: &mut Sink<'_>) {
    let sections = document.sections("layer");
    let layers: Vec<&Section<'_>> = sections.iter().filter(|at| at.text("type") != Some("thin-film")).collect();
    let [first, below, ..] = layers.as_slice() else { return };
    if let Some(span) = effects::weight_span(first)
        && below.text("type") == Some("dielectric")
        && below.has("f0")
        && !below.has("ior")
    {
        let message = "below this coat lies a dielectric with an `f0`: the medium above decides how that bends light, and the coat is there in places only";
        let hint =
            "give that layer an `ior` beside its `f0` or in its place, or write it as `type = \"metallic-roughness\"`";
        sink.error(span, message, Some(hint.to_owned()));
    }
}

/// Whether a film that varies may lie below the first layer on this one: its F0 decides the reflectance of the film.
pub(super) fn carries_films_that_vary(at: &Section<'_>) -> bool {
    match at.text("type") {
        Some("conductor") => at.has("f0"),
        Some("metallic-roughness") => textured(at).is_some() || at.number("metallic").is_some_and(|share| share >= 1.0),
        _ => false,
    }
}

/// Reports films on a metal with an edge tint, which they know nothing of; and a second film, or one that absorbs, on a surface whose texels give it another F0
/// at each place, or that varies below the first layer.
pub(super) fn check_films(at: &Section<'_>, films: &[films::Pending<'_>], number: usize, sink: &mut Sink<'_>) {
    if at.has("f82_tint") && !at.has("ior") && !films.is_empty() {
        let message =
            "an edge tint below a film: films interfere by the F0 of a metal, whose tint is of its bare reflectance";
        sink.error(at.key_span("f82_tint"), message, Some("leave it out, or leave the film out".to_owned()));
    }
    let varies = number > 0 && films.iter().any(|film| film.variation.is_some());
    let is_mapped = textured(at).is_some() || maps_f0(at);
    if !(is_mapped || varies && carries_films_that_vary(at)) {
        return;
    }
    let base = match is_mapped {
        true => "a surface whose maps give each place another F0, by which it interferes",
        false => "an F0 below the first layer, where films vary",
    };
    for (i, film) in films.iter().enumerate() {
        let is_conductor = at.text("type") == Some("conductor");
        let (span, message, hint) = if is_mapped && at.has("f0") && !is_conductor || maps_f0(at) && number > 0 {
            let message =
                "a film on a surface with an `f0` of its own and maps that vary it: films interfere by the F0";
            (film.span.clone(), message.to_owned(), "leave the film out, or the maps")
        } else if i > 0 {
            (film.span.clone(), format!("a second film on {base}"), "leave one film")
        } else if !film.film.is_clear() {
            let message = format!("a film that absorbs on {base}: its closed forms are those of clear films");
            (film.at.value_span("ior"), message, "give it a real index")
        } else {
            continue;
        };
        sink.error(span, message, Some(hint.to_owned()));
    }
}

/// The F0 of the dielectric of a `metallic-roughness` layer.
fn dielectric_f0(at: &Section<'_>, sink: &mut Sink<'_>) -> Rgb {
    if at.has("f0") { f0(at, sink) } else { [DIELECTRIC_F0; 3] }
}

/// The F0 of an interface, as numbers or by the name of a substance. The gold of the lecture has a red above 1, which counts as 1.
fn f0(at: &Section<'_>, sink: &mut Sink<'_>) -> Rgb {
    let Some(printed) = at.text("f0").and_then(printed_f0) else {
        return at.reflectance("f0").unwrap_or([0.0; 3]);
    };
    if let Some(most) = printed.into_iter().find(|value| *value > 1.0) {
        let message =
            format!("`f0` is {} as the lecture prints it, more light than falls in: it is read as 1", short(most));
        sink.warn(at.value_span("f0"), message, Some("gold by its index is `ior = \"au\"`".to_owned()));
    }
    printed.map(|value| value.min(1.0))
}

/// The largest real index of a medium.
fn most(ior: &Ior) -> f64 {
    ior.samples().iter().fold(0.0, |most: f64, s| most.max(s.n))
}

/// The real index of a medium times a factor; `None` where that is no index.
fn relative(above: &Ior, factor: f64) -> Option<Ior> {
    Ior::sampled(above.samples().iter().map(|s| IorSample { n: s.n * factor, k: 0.0, ..*s }).collect()).ok()
}

//! Decoder of the maps of a layer.

use luthier_manifest::MapSlot;

use super::{effects, live, picture};
use crate::diagnostic::Sink;
use crate::material::{LayerExtras, Maps};
use crate::section::Section;

/// The maps of a layer.
pub(super) fn decode(at: &Section<'_>) -> Maps {
    let Some(maps) = at.section("maps") else { return Maps::default() };
    Maps {
        normal: picture::under(&maps, "normal"),
        roughness: picture::under(&maps, "roughness"),
        thickness: picture::under(&maps, "thickness"),
        absorption: picture::under(&maps, "absorption"),
        weight: picture::under(&maps, "weight"),
        bumps: picture::under(&maps, "bumps"),
        alpha: picture::under(&maps, "alpha"),
        alpha_x: picture::under(&maps, "alpha_x"),
        alpha_y: picture::under(&maps, "alpha_y"),
        tangent: picture::under(&maps, "tangent"),
        albedo: picture::under(&maps, "albedo"),
        base_color: picture::under(&maps, "base_color"),
        metallic: picture::under(&maps, "metallic"),
        f0: picture::under(&maps, "f0"),
        lean: picture::under(&maps, "lean"),
    }
}

/// Refuses maps of the whole surface in a layer below the first, and maps of two slope parameters and a tangent where there is one slope
/// parameter.
pub(super) fn check(at: &Section<'_>, number: usize, sink: &mut Sink<'_>) {
    let Some(maps) = at.section("maps") else { return };
    for (name, own, does) in [
        ("normal", "bumps", "tilts this layer alone"),
        ("roughness", "alpha", "scales the slope parameter of this layer alone"),
    ] {
        if number > 0 && maps.has(name) {
            let message = format!("a {name} map belongs to the first layer: it is that of the whole surface");
            let hint = format!("write `{own}`, which {does}, or move it to the first layer");
            sink.error(maps.value_span(name), message, Some(hint));
        }
    }
    if number > 0 && maps.has("lean") {
        let message = "a lean is that of the inner boundary of the first interface's film or slab";
        sink.error(maps.value_span("lean"), message, Some("move it to the first layer, or write `bumps`".to_owned()));
    }
    check_metallic(at, &maps, sink);
    for map in decode(at).named() {
        if let Some(table) = maps.section(map.key) {
            picture::check(&table, map.texels(), sink);
        }
    }
    for name in ["alpha_x", "alpha_y", "tangent"] {
        if maps.has(name) && !(at.has("alpha_x") && at.has("alpha_y")) {
            let what = if name == "tangent" { "turns the axes" } else { "scales one of the two slope parameters" };
            let message = format!("the map `{name}` {what} of an anisotropic surface, which this layer has not");
            let hint = "give the layer `alpha_x` and `alpha_y`, which may be equal".to_owned();
            sink.error(maps.value_span(name), message, Some(hint));
        }
    }
}

/// Refuses maps of an F0 of interfaces that have none, or whose F0 decides more than how much they reflect.
pub(super) fn check_f0(at: &Section<'_>, number: usize, next: Option<&Section<'_>>, sink: &mut Sink<'_>) {
    let Some(maps) = at.section("maps").filter(|maps| maps.has("f0")) else { return };
    let is_dielectric = at.text("type") == Some("dielectric");
    let is_bright = at.reflectance("f0").is_some_and(|f0| f0.into_iter().any(|f0| f0 > F0_MAX));
    let (message, hint) = if !at.has("f0") && at.text("type") != Some("metallic-roughness") {
        ("a map of `f0` scales an `f0`, which this layer has not", "give the layer an `f0` in place of its `ior`")
    } else if is_dielectric && next.is_none_or(|next| next.text("type") != Some("diffuse")) {
        (
            "a map of `f0` is for a metal, or for the dielectric on a diffuse base: other interfaces have one F0 in all places",
            "leave it out, or write a `weight` with a map in its place",
        )
    } else if is_dielectric && number == 0 && effects::weight_span(at).is_some() {
        ("a map of `f0` beside a weight of the same layer: both say how much of it is there", "leave one of them out")
    } else if is_bright && at.text("type") != Some("conductor") {
        (
            "below an `f0` this large, hardly any light is left that texels could scale",
            "write `f0 = 0.9` at most, or make the layer a `conductor`",
        )
    } else {
        return;
    };
    sink.error(maps.value_span("f0"), message, Some(hint.to_owned()));
}

/// Largest F0 of a dielectric with a map of it: tables have what it does not reflect in steps, which texels multiply.
const F0_MAX: f64 = 0.9;

/// Refuses maps of colour and metal that would say too little: a texture of the base colour alone leaves open how metallic a place is.
fn check_metallic(at: &Section<'_>, maps: &Section<'_>, sink: &mut Sink<'_>) {
    let metallic = at.number("metallic").unwrap_or(0.0);
    if maps.has("base_color") && !live::varies(at, "metallic") && metallic > 0.0 {
        let message = "a map of `base_color` on a metal needs one of `metallic` beside it";
        let hint = "write `metallic = \"white.png\"` under `maps`, a white picture, or `metallic = 0`".to_owned();
        sink.error(maps.value_span("base_color"), message, Some(hint));
    }
    let is_engine = at.text("type") == Some("metallic-roughness");
    let names_f0 = maps.has("f0") || at.has("f0") && live::varies(at, "metallic");
    if is_engine && names_f0 && !live::varies(at, "base_color") {
        let key = if maps.has("f0") { "f0" } else { "metallic" };
        let message =
            "the F0 of the dielectric decides the albedo of the base below it, which needs a map of `base_color`";
        let hint = "write `base_color = \"white.png\"` under `maps`, a white picture".to_owned();
        sink.error(maps.value_span(key), message, Some(hint));
    }
    if maps.has("albedo") && at.has("reradiation") {
        let message = "a map of the albedo needs an albedo, and this base has `reradiation`";
        sink.error(
            maps.value_span("albedo"),
            message,
            Some("give the base an `albedo`, or leave the map out".to_owned()),
        );
    }
}

/// Refuses maps of single layers beside a patina, which decides the same quantities.
pub(super) fn check_effects(document: &Section<'_>, extras: &[LayerExtras], sink: &mut Sink<'_>) {
    let Some(effects) = document.section("effects") else { return };
    let varied = extras.iter().enumerate().flat_map(|(i, extra)| extra.varied().map(move |(key, slot)| (i, key, slot)));
    let varied: Vec<(usize, String, MapSlot)> = varied.collect();
    let clash = varied.iter().find(|(i, _, slot)| match *slot {
        // A weight beside a patina is refused by itself.
        MapSlot::Normal | MapSlot::Roughness | MapSlot::Weight => false,
        MapSlot::Thickness => *i > 0,
        _ => true,
    });
    if let (true, Some((layer, key, _))) = (effects.has("patina"), clash) {
        let what = match key.split_once('.') {
            Some(("live", name)) => format!("the live `{name}`"),
            Some((_, name)) => format!("the map `{name}`"),
            None => format!("`{key}`"),
        };
        let message = format!("`patina` beside {what} of layer {}: no model has both", layer + 1);
        sink.error(effects.key_span("patina"), message, Some(format!("leave `patina` or `{key}` out")));
    }
}

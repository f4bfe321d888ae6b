//! Decoder of the section `[effects]`.

use std::ops::Range;

use luthier_optics::Rgb;
use luthier_optics::stack::{Base, Stack};

use super::{films, picture};
use crate::diagnostic::Sink;
use crate::effects::{Effects, FlakeSource, Flakes, Glitter, Patina};
use crate::grammar::UNIT;
use crate::picture::TexelUse;
use crate::section::Section;
use crate::suggest::short;

/// The effects of a material.
pub(super) fn decode(document: &Section<'_>, stack: &Stack, is_fluorescent: bool, sink: &mut Sink<'_>) -> Effects {
    check_weight(document, is_fluorescent, sink);
    let Some(at) = document.section("effects") else { return Effects::default() };
    for effect in ["flakes", "patina"] {
        if at.has(effect) && stack.layers.len() == 1 {
            let hint = "add a dielectric `[[layer]]` on top".to_owned();
            sink.error(at.key_span(effect), format!("`{effect}` needs a layer below the first interface"), Some(hint));
        }
    }
    if is_fluorescent && at.has("patina") {
        let hint = "give the base an `albedo` in place of `reradiation`, or leave the patina out".to_owned();
        sink.error(at.key_span("patina"), "no model has patina over a base with `reradiation`", Some(hint));
    }
    Effects {
        flakes: at.section("flakes").and_then(|at| flakes(&at, sink)),
        patina: at.section("patina").and_then(|at| patina(&at, stack, sink)),
        glitter: at.section("glitter").map(|at| glitter(&at)),
    }
}

/// Where a layer says that it covers a part of the surface: its weight below 1, a map of it, or one that a program sets.
pub(super) fn weight_span(layer: &Section<'_>) -> Option<Range<usize>> {
    let is_partial = layer.number("weight").is_some_and(|weight| weight < 1.0);
    let mut tables = ["maps", "live"].into_iter().filter_map(|table| layer.section(table));
    let varied = tables.find(|table| table.has("weight"));
    if is_partial { Some(layer.key_span("weight")) } else { varied.map(|table| table.key_span("weight")) }
}

/// Refuses a weight of the first layer beside what no model shows with it.
fn check_weight(document: &Section<'_>, is_fluorescent: bool, sink: &mut Sink<'_>) {
    let layers = document.sections("layer");
    let count = layers.iter().take_while(|at| at.text("type") == Some("thin-film")).count() + 1;
    let Some(span) = layers.iter().take(count).find_map(weight_span) else {
        return;
    };
    if document.section("effects").is_some_and(|effects| effects.has("patina")) {
        let hint = "leave one of them out: the map of the patina says where the first layer has grown".to_owned();
        sink.error(span, "`weight` beside `patina`: both say where the first layer is", Some(hint));
    } else if is_fluorescent {
        let hint = "give the base an `albedo` in place of `reradiation`, or leave the weight out".to_owned();
        sink.error(span, "no model has a weight over a base with `reradiation`", Some(hint));
    }
}

fn glitter(at: &Section<'_>) -> Glitter {
    Glitter {
        seed: at.integer("seed").unwrap_or(0),
        frequency: at.number("frequency").unwrap_or(200.0),
        filled: at.number("filled").unwrap_or(0.1),
        tilt: at.number("tilt_deg").unwrap_or(15.0).to_radians(),
    }
}

fn flakes(at: &Section<'_>, sink: &mut Sink<'_>) -> Option<Flakes> {
    if let Some(normals) = at.section("normal_map") {
        picture::check(&normals, TexelUse::Normal, sink);
    }
    let source = match picture::under(at, "normal_map") {
        Some(picture) => FlakeSource::NormalMap(picture),
        None if at.has("height_map") => {
            let heights = at.section("height_map")?;
            picture::check(&heights, TexelUse::Number, sink);
            FlakeSource::HeightMap { picture: picture::of(&heights)?, height: heights.number("height")? }
        }
        None => {
            let cells = at.section("cells")?;
            FlakeSource::Cells {
                seed: cells.integer("seed").unwrap_or(0),
                count: cells.integer("count").unwrap_or(64),
                spread: cells.number("spread_deg").unwrap_or(15.0).to_radians(),
            }
        }
    };
    Some(Flakes {
        source,
        tiling: at.number("tiling").unwrap_or(1000.0),
        scale: at.number("scale").unwrap_or(1.0),
        fade_start: at.number("fade_start").unwrap_or(1.0),
    })
}

fn patina(at: &Section<'_>, stack: &Stack, sink: &mut Sink<'_>) -> Option<Patina> {
    let (extent, transition) = (at.number("extent")?, at.number("transition")?);
    let (least, most) = (-transition, 1.0 + transition);
    // The checker has reported an extent or a transition that is out of range by itself.
    if !(least..=most).contains(&extent) && extent.is_finite() && UNIT.contains(transition) {
        let message =
            format!("`extent` runs from -transition to 1 + transition, {} to {} here", short(least), short(most));
        let hint = format!("the nearest allowed is `extent = {}`", short(extent.clamp(least, most)));
        sink.error(at.value_span("extent"), message, Some(hint));
    }
    Some(Patina {
        extent,
        transition,
        map: films::map(at, "map", sink)?,
        diffuse_albedo: scattered(at, stack, sink),
        base_alpha: at.number("base_alpha"),
        tarnish: at.rgb("tarnish").unwrap_or([1.0; 3]),
    })
}

/// The diffuse reflectance of a patina: stated, or a part of the light that the first layer does not absorb (Elek 2010, section 4.2).
fn scattered(at: &Section<'_>, stack: &Stack, sink: &mut Sink<'_>) -> Rgb {
    let Some(part) = at.number("diffuse_remainder") else { return at.rgb("diffuse_albedo").unwrap_or([0.0; 3]) };
    if at.has("diffuse_albedo") {
        let message = "a second diffuse reflectance: `diffuse_albedo` is given already";
        let hint = "keep one of `diffuse_albedo` and `diffuse_remainder`, which takes its colour from the first layer's absorption";
        sink.error(at.key_span("diffuse_remainder"), message, Some(hint.to_owned()));
    }
    match stack.layers.first().map(|layer| &layer.base) {
        Some(Base::Dielectric { slab, .. }) => slab.optical_depth().map(|depth| part * libm::exp(-depth)),
        _ => [part; 3],
    }
}

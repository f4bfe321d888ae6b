//! Models that walk through the layers one by one, written out: one step for each depth of the deepest material.

use std::fmt::Write as _;

use luthier_layers::models::room;
use luthier_manifest::{LayerRecord, MaterialEntry, ShadingModel};

use crate::MaterialSet;
use crate::compose::face::parts_function;
use crate::compose::feature::Feature;
use crate::compose::features::Features;
use crate::compose::stacks::{are_bases, depths, diffuse_at, is_diffuse, stacks, step};
use crate::compose::{function, text};
use crate::identifiers::rename;

/// The modules of a model, `luthier_eval_<model>` last.
pub(crate) fn modules(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> Vec<String> {
    let steps = if is_clamped(model, features) { room(model).kernels.eval } else { "" };
    vec![text(steps, features), text(&eval(set, model, features), features)]
}

/// Whether a model clamps slope parameters in this set. Models with one slope parameter do, if some interface is smoother than one above it;
/// models with two, if a material asks for it. Otherwise they share a path.
fn is_clamped(model: ShadingModel, features: &Features) -> bool {
    features.has(if model.facts().is_isotropic { Feature::Clamped } else { Feature::RougherBelow })
}

/// Whether layers of a material of a model are bare in places.
fn has_cover(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    set.materials.iter().any(|material| material.model == model && material.constants.bare().is_some())
}

/// Whether a material of a model has patina.
fn has_patina(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    set.materials.iter().any(|material| material.model == model && material.constants.patina.is_some())
}

/// Whether materials of a model have a weight of a film, and whether some leave layers below the first bare.
fn covers(set: &MaterialSet<'_>, model: ShadingModel) -> (bool, bool) {
    let mut of_model = set.materials.iter().filter(|material| material.model == model);
    let is_film = |material: &MaterialEntry| material.weighs_film_of_path();
    (of_model.clone().any(is_film), of_model.any(|material| material.constants.bare().is_some() && !is_film(material)))
}

/// The function of a model that adds an interface to a `LuthierPath`.
fn interface(model: ShadingModel, features: &Features) -> String {
    let owner = if is_clamped(model, features) { model.name().replace('-', "_") } else { "add".to_owned() };
    format!("luthier_{owner}_interface")
}

/// `luthier_eval_<model>` of a model.
fn eval(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> String {
    let interface = &interface(model, features);
    let name = function(model);
    let layers = stacks(set, model);
    let has_cover = has_cover(set, model);
    let (name, bare) =
        if has_cover { (name.replace("luthier_eval", "luthier_stack"), " is_bare: bool,") } else { (name, "") };
    let (weighs_films, weighs_layers) = covers(set, model);
    let without = match (weighs_films, weighs_layers) {
        (false, true) => "; where it is bare, without the first layer",
        (true, false) => "; where it is bare, without the film",
        (true, true) => "; where it is bare, without the first layer or without the film on it",
        (false, false) => "",
    };
    // Whether the first layer is missing.
    let missing = if weighs_films { "is_bare && !is_film" } else { "is_bare" };
    let is_lit = features.has(Feature::Fluorescent);
    let (lit, given, what) = match is_lit {
        true => ("_lit", ", light: vec3<f32>", "Light to the eye, of light of a colour, by"),
        false => ("", "", "f cos_theta_i of"),
    };
    let mut out = format!(
        "/// {what} the model `{}`, both directions above the horizon{without}.\n\
         fn {name}{lit}($place_parameter material: u32,{bare} wi: vec3<f32>, wo: vec3<f32>{given}) -> vec3<f32> {{\n",
        model.name()
    );
    if are_bases(&layers) {
        let here = if features.has(Feature::OwnNormals) { "_here" } else { "" };
        let base = match is_lit {
            true => format!("luthier_reradiated(layer, wi{here}, wo{here}, light)"),
            false => format!("$diffuse(layer, wi{here}, wo{here})"),
        };
        out.push_str("    let layer = $layer(material, 0u);\n");
        if features.has(Feature::OwnNormals) {
            out.push_str(
                "    let wi_here = luthier_local(layer.normal, wi);\n    \
                 let wo_here = luthier_local(layer.normal, wo);\n    \
                 if min(wi_here.z, wo_here.z) <= 0.0 {\n        return vec3<f32>(0.0);\n    }\n",
            );
        }
        let _ = write!(out, "    return wi{here}.z * {base};\n}}\n");
        return out + &cover(set, model, features) + &white(model, features);
    }
    let (least, depth) = depths(&layers);
    if least < depth || depth > 1 && has_cover || weighs_films {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    if weighs_films && weighs_layers {
        out.push_str("    let is_film = luthier_weighs_film(material);\n");
    }
    let below = match (features.has(Feature::Flakes), weighs_layers) {
        (false, _) => String::new(),
        (true, false) => ", place.flake_normal".to_owned(),
        (true, true) => format!(", select(place.flake_normal, vec3<f32>(0.0, 0.0, 1.0), {missing})"),
    };
    let alpha = if features.has(Feature::Clamped) { "0.0, " } else { "" };
    let outer = if features.has(Feature::InnerCosine) { ", down.z" } else { "" };
    let light = if is_lit { ", light" } else { "" };
    let _ = writeln!(
        out,
        "    // Products of lower cosines would underflow; the outer one stays as it is.\n    \
             let down = vec3<f32>(wi.xy, max(wi.z, 1e-16));\n    \
             let up = vec3<f32>(wo.xy, max(wo.z, 1e-16));\n    \
             var path = LuthierPath(down, up, wi.xy + wo.xy, vec3<f32>(1.0){light}, vec3<f32>(0.0), {alpha}true{below}{outer});"
    );
    for i in 0..depth {
        // The layer below patina or a coat, or that below a film, has a second record, for bare places.
        let index = match i {
            0 if weighs_films => "select(0u, count, is_bare)".to_owned(),
            1 if weighs_layers => format!("select(1u, count, {missing})"),
            _ => format!("{i}u"),
        };
        let diffuse = diffuse_at(&layers, i);
        let (mut lines, mut layer) = (Vec::new(), format!("$layer(material, {index})"));
        if diffuse == (true, false) {
            // Materials differ here: the record is read once, for the kind and for the step.
            lines.push(format!("let layer_{i} = {layer};"));
            layer = format!("layer_{i}");
        }
        let base = [format!("path = luthier_add_diffuse(path, {layer});")];
        lines.extend(step(diffuse, &layer, base, [format!("path = {interface}(path, {layer});")]));
        let indent = if i == 0 && !weighs_layers { "    " } else { "        " };
        let step: String = lines.iter().map(|line| format!("{indent}{line}\n")).collect();
        let _ = match i {
            0 if weighs_layers && weighs_films => write!(out, "    if !is_bare || is_film {{\n{step}    }}\n"),
            0 if weighs_layers => write!(out, "    if !is_bare {{\n{step}    }}\n"),
            0 => write!(out, "{step}"),
            _ if i < least => write!(out, "    if path.open {{\n{step}    }}\n"),
            _ => write!(out, "    if path.open & (count > {i}u) {{\n{step}    }}\n"),
        };
    }
    out.push_str("    return wi.z * path.total;\n}\n");
    out + &cover(set, model, features) + &white(model, features)
}

/// The function of a model for white light. Functions beside `luthier_eval` call it if that of the set takes light of a colour.
fn white(model: ShadingModel, features: &Features) -> String {
    if !(features.has(Feature::Fluorescent) && features.has(Feature::Face)) {
        return String::new();
    }
    let name = function(model);
    format!(
        "\n/// f cos_theta_i of the model `{}`, both directions above the horizon.\n\
         fn {name}($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n    \
         return {name}_lit($place_argument material, wi, wo, vec3<f32>(1.0));\n}}\n",
        model.name()
    )
}

/// Statements that find the share of the surface that the first layer covers.
fn amount(features: &Features) -> &'static str {
    if features.has(Feature::Weight) {
        "let cover = luthier_cover(place, material);\n    let amount = select(1.0, cover, cover >= 0.0);"
    } else {
        "let amount = select(1.0, place.patina, place.patina >= 0.0);"
    }
}

/// The function of a model that shows patina or the weight of a coat: light with and without the first layer, blended.
fn cover(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> String {
    if !has_cover(set, model) {
        return String::new();
    }
    let name = function(model);
    let stack = name.replace("luthier_eval", "luthier_stack");
    let (lit, given, light, factor) = match features.has(Feature::Fluorescent) {
        true => ("_lit", ", light: vec3<f32>", ", light", "light * "),
        false => ("", "", "", ""),
    };
    let (what, scattered) = match has_patina(set, model) {
        true => {
            ("with patina (Elek 2010, section 4.2)", format!("{factor}luthier_patina_diffuse(place, material, wi, wo)"))
        }
        false if covers(set, model).0 => {
            ("with and without a coat or a film, by its weight", "vec3<f32>(0.0)".to_owned())
        }
        false => ("with and without a coat, by its weight", "vec3<f32>(0.0)".to_owned()),
    };
    let amount = amount(features);
    format!(
        "\n/// f cos_theta_i of the model `{}` {what}.\n\
         fn {name}{lit}(place: LuthierPlace, material: u32, wi: vec3<f32>, wo: vec3<f32>{given}) -> vec3<f32> {{\n    \
             var value = {scattered};\n    \
             {amount}\n    \
             if amount < 1.0 {{\n        \
                 value += (1.0 - amount) * {stack}{lit}(place, material, true, wi, wo{light});\n    \
             }}\n    \
             if amount > 0.0 {{\n        \
                 value += amount * {stack}{lit}(place, material, false, wi, wo{light});\n    \
             }}\n    \
             return value;\n\
         }}\n",
        model.name()
    )
}

/// Number of interfaces down to the lowest one of a model's materials.
fn interfaces(set: &MaterialSet<'_>, model: ShadingModel) -> usize {
    let stacks = stacks(set, model);
    let lowest = stacks.iter().filter_map(|layers| layers.iter().rposition(|layer| !is_diffuse(layer)));
    lowest.map(|last| last + 1).max().unwrap_or(0)
}

/// Number of the parts of a model: its interfaces, and with patina or the weight of a coat those of the bare stacks, which begin one layer below the top.
pub(crate) fn parts_count(set: &MaterialSet<'_>, model: ShadingModel) -> usize {
    let depth = interfaces(set, model);
    if covers(set, model).1 { (2 * depth).saturating_sub(1) } else { depth }
}

/// `luthier_parts_<model>`: the interfaces as light from the mirror direction meets them, and the light of a base for light at a mean cosine.
pub(crate) fn parts(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> String {
    let mut out = format!(
        "/// The parts of the model `{}`.\n\
         fn {}(given: LuthierPrepared, $place_parameter material: u32, wo: vec3<f32>) -> LuthierPrepared {{\n    \
             var prepared = given;\n    let light = luthier_mean_light(wo);\n",
        model.name(),
        parts_function(model)
    );
    let layers = stacks(set, model);
    let count = interfaces(set, model);
    if count == 0 {
        let diffuse = match features.has(Feature::Fluorescent) {
            true => "luthier_reradiated(layer, light, wo, vec3<f32>(1.0))",
            false => "$diffuse(layer, light, wo)",
        };
        let base = format!("let layer = $layer(material, 0u);\n    prepared.wide = LUTHIER_PI * {diffuse};");
        return format!("{out}    {base}\n    return prepared;\n}}\n");
    }
    let has_cover = has_cover(set, model);
    let (least, depth) = depths(&layers);
    if least < depth || has_cover {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    if has_cover {
        if has_patina(set, model) {
            out.push_str(
                "    prepared.wide = luthier_patina_diffuse(place, material, light, wo) * (LUTHIER_PI / light.z);\n",
            );
        }
        let _ = write!(out, "    {}\n    if amount > 0.0 {{\n", amount(features));
        let whole = Walk { share: "amount", is_bare: false, is_filmless: false, first_part: 0 };
        out.push_str(&walk(&layers, model, features, &whole));
        out.push_str("    }\n");
        let (weighs_films, weighs_layers) = covers(set, model);
        let [of_layer, of_film] = match (weighs_films, weighs_layers) {
            (true, true) => [" && !luthier_weighs_film(material)", " && luthier_weighs_film(material)"],
            _ => ["", ""],
        };
        if weighs_layers {
            let bare = Walk { share: "1.0 - amount", is_bare: true, is_filmless: false, first_part: count };
            let walk = walk(&layers, model, features, &bare);
            let _ = write!(out, "    if amount < 1.0{of_layer} {{\n{walk}    }}\n");
        }
        if weighs_films {
            let bare = Walk { share: "1.0 - amount", is_bare: false, is_filmless: true, first_part: 0 };
            let walk = walk(&layers, model, features, &bare);
            let _ = write!(out, "    if amount < 1.0{of_film} {{\n{walk}    }}\n");
        }
    } else {
        let whole = Walk { share: "1.0", is_bare: false, is_filmless: false, first_part: 0 };
        out.push_str(&walk(&layers, model, features, &whole));
    }
    out + "    return prepared;\n}\n"
}

/// A way down the layers.
struct Walk<'w> {
    /// Share of the surface on which light takes it.
    share: &'w str,
    /// Whether the first layer is missing.
    is_bare: bool,
    /// Whether the film on it is: its parts are those of the walk before, and have the light of both.
    is_filmless: bool,
    /// Number of the part of its first interface.
    first_part: usize,
}

/// A statement with numbers behind `layer` and `next`. naga renames all but the first of several values with one name in a function.
pub(super) fn of_layer(statement: &str, i: usize) -> String {
    let numbered = rename(statement, |word| matches!(word, "layer" | "next").then(|| format!("{word}_{i}")));
    numbered.replace(&format!("$layer_{i}("), "$layer(")
}

fn walk(layers: &[&[LayerRecord]], model: ShadingModel, features: &Features, walk: &Walk<'_>) -> String {
    const LEVEL: &str = "vec3<f32>(0.0, 0.0, 1.0)";
    let (has_flakes, is_clamped) = (features.has(Feature::Flakes), features.has(Feature::Clamped));
    let is_folded = features.has(Feature::Folded) && features.has(Feature::Media);
    let interface = interface(model, features);
    let is_isotropic = model.facts().is_isotropic;
    let (alpha, axis) = match () {
        () if is_isotropic && is_clamped => ("vec2<f32>(next.alpha_above)", "vec2<f32>(1.0, 0.0)"),
        () if features.has(Feature::RougherBelow) => {
            ("max(layer.alpha_xy, vec2<f32>(select(0.0, path.alpha_above, layer.rougher_below)))", "layer.rotation")
        }
        () if !is_isotropic && features.has(Feature::Anisotropic) => ("layer.alpha_xy", "layer.rotation"),
        () => ("vec2<f32>(layer.alpha)", "vec2<f32>(1.0, 0.0)"),
    };
    let normal = if walk.is_bare { LEVEL } else { "place.flake_normal" };
    let below = if has_flakes { format!(", {normal}") } else { String::new() };
    let clamp = if is_clamped { "0.0, " } else { "" };
    let lit = if features.has(Feature::Fluorescent) { ", vec3<f32>(1.0)" } else { "" };
    let rest = format!("vec3<f32>({}){lit}, vec3<f32>(0.0), {clamp}true{below}", walk.share);
    let [of_path, of_mean] =
        [", wo.z", ", light.z"].map(|outer| if features.has(Feature::InnerCosine) { outer } else { "" });
    let mut lines = vec![
        format!("var path = LuthierPath(vec3<f32>(-wo.xy, wo.z), wo, vec2<f32>(0.0), {rest}{of_path});"),
        format!("var mean = LuthierPath(light, wo, light.xy + wo.xy, {rest}{of_mean});"),
    ];
    let (least, depth) = depths(layers);
    let first = usize::from(walk.is_bare);
    if depth > first + 1 {
        lines.push("var eta = 1.0;".to_owned());
        if has_flakes {
            lines.push("var outer_eta = 1.0;".to_owned());
        }
        if is_folded {
            lines.push("var least = 1.0;".to_owned());
        }
    }
    for i in first..depth {
        let is_second = walk.is_bare && i == 1 || walk.is_filmless && i == 0;
        let index = if is_second { "count".to_owned() } else { format!("{i}u") };
        let has_own = features.has(Feature::OwnNormals);
        let media = match (i == first, has_flakes) {
            // Nothing lies above the first layer: index 1, and a level normal unless a map turns it.
            (true, _) if has_own => "1.0, layer.normal, 1.0".to_owned(),
            (false, false) if has_own => "eta, layer.normal, 1.0".to_owned(),
            (true, _) => format!("1.0, {LEVEL}, 1.0"),
            (false, false) => format!("eta, {LEVEL}, 1.0"),
            (false, true) => format!("outer_eta, {normal}, eta"),
        };
        let narrowest = match (is_folded, i == first) {
            (false, _) => "",
            (true, true) => ", 1.0",
            (true, false) => ", least",
        };
        let part = format!("luthier_path_part(path, layer, {alpha}, {axis}, {media}{narrowest})");
        let number = walk.first_part + i - first;
        let mut add = vec![
            format!("let next = {interface}(path, layer);"),
            match walk.is_filmless {
                true => format!("prepared.parts[{number}] = luthier_joined_part(prepared.parts[{number}], {part});"),
                false => format!("prepared.parts[{number}] = {part};"),
            },
            "if mean.open {".to_owned(),
            format!("    mean = {interface}(mean, layer);"),
            "}".to_owned(),
            "path = luthier_path_mirrored(next);".to_owned(),
        ];
        if i + 1 < depth {
            let eta = if i == first && has_flakes { "outer_eta" } else { "eta" };
            add.push(format!("{eta} = {eta} / layer.inverse_eta;"));
            if is_folded {
                add.push(format!("least = min(least, {eta});"));
            }
        }
        let base = [
            "if mean.open {",
            "    mean.total = vec3<f32>(0.0);",
            "    mean = luthier_add_diffuse(mean, layer);",
            "    prepared.wide += LUTHIER_PI * mean.total;",
            "}",
            "path.open = false;",
        ]
        .map(str::to_owned);
        lines.push(match i {
            _ if i == first && first < least => "{".to_owned(),
            _ if i < least => "if path.open {".to_owned(),
            _ => format!("if path.open & (count > {i}u) {{"),
        });
        let mut steps = vec![format!("let layer = $layer(material, {index});")];
        steps.extend(step(diffuse_at(layers, i), "layer", base, add));
        let named = if walk.is_filmless { 2 * depth } else { walk.first_part };
        lines.extend(steps.iter().map(|line| format!("    {}", of_layer(line, named + i))));
        lines.push("}".to_owned());
    }
    let indent = if walk.share == "1.0" { "    " } else { "        " };
    lines.iter().map(|line| format!("{indent}{line}\n")).collect()
}

//! Further functions for renderers: a material prepared for a view, its light, drawn directions, its albedo.

use std::fmt::Write as _;

use luthier_layers::models::path;
use luthier_layers::models::room;
use luthier_manifest::{FunctionGroup, MaterialEntry, ShadingModel};
use luthier_model::Family;

use crate::MaterialSet;
use crate::compose::feature::Feature;
use crate::compose::features::Features;
use crate::compose::stacks::{are_bases, is_diffuse, stacks};
use crate::compose::{by_model, case, chain, function, on_first, statistics, text};

/// Number in place of a model's for a bare base of the model `lobes`, which has no rows.
const BASE: &str = "255u";

/// Name of the function that fills the parts of a material of a model.
pub(crate) fn parts_function(model: ShadingModel) -> String {
    function(model).replace("luthier_eval", "luthier_parts")
}

/// The modules of the groups of functions beside `eval`.
pub(crate) fn modules(set: &MaterialSet<'_>, features: &Features) -> Vec<String> {
    if set.functions.is_eval_alone() {
        return Vec::new();
    }
    let parts = count(set, features);
    let mut modules = vec![include_str!("../wgsl/face/prepared.wgsl").to_owned()];
    if features.has(Feature::Chain) {
        modules.push(path::PARTS.to_owned());
    }
    modules.extend(set.models().map(|model| match model.facts().family {
        Family::Path => chain::parts(set, model, features),
        Family::Statistics => statistics::parts(set, model),
        Family::Beams | Family::Coefficients | Family::Facets | Family::Lobes => room(model).kernels.parts.to_owned(),
    }));
    modules.extend([prepare(set, features, parts), light(set, features)]);
    if set.functions.has(FunctionGroup::Sample) {
        if features.has(Feature::Visible) {
            modules.push(include_str!("../wgsl/face/visible.wgsl").to_owned());
        }
        if features.has(Feature::Lobes) {
            modules.extend(set.models().map(|model| room(model).kernels.sample.to_owned()));
        }
        modules.push(include_str!("../wgsl/face/sample.wgsl").to_owned());
        if set.functions.has(FunctionGroup::Propose) {
            modules.push(include_str!("../wgsl/face/propose.wgsl").to_owned());
        }
    }
    if features.has(Feature::Environment) {
        modules.push(include_str!("../wgsl/face/surroundings.wgsl").to_owned());
        modules.push(include_str!("../wgsl/face/environment.wgsl").to_owned());
    }
    if set.functions.has(FunctionGroup::Albedo) {
        modules.push(include_str!("../wgsl/face/albedo.wgsl").to_owned());
        modules.push(albedo(features, parts));
    }
    let least = if features.has(Feature::Folded) && features.has(Feature::Media) { ", least: f32" } else { "" };
    let prepared = if features.has(Feature::LobesSides) { "LuthierPreparedSides" } else { "LuthierPreparedLobes" };
    let words = [
        ("$parts", format!("{parts}u")),
        ("$model_base", BASE.to_owned()),
        ("$sides", sides(features).to_owned()),
        ("$prepared_lobes", prepared.to_owned()),
        ("$least", least.to_owned()),
        ("$model_lobes", set.models().find(|model| model.is_fitted()).map(number).unwrap_or_default()),
    ];
    // A condition governs one statement: what stands for several comes after conditions.
    let unrolled = unrolled(parts, features);
    modules.into_iter().map(|module| replaced(text(&replaced(module, &words), features), &unrolled)).collect()
}

/// End of the names of functions of the model `lobes` that see a prepared material: they see both sides of a coat with a weight, where some material has
/// these.
fn sides(features: &Features) -> &'static str {
    if features.has(Feature::LobesSides) { "sides" } else { "lobes" }
}

/// A text with values in place of words.
fn replaced(text: String, values: &[(&str, String)]) -> String {
    values.iter().fold(text, |text, (word, value)| text.replace(word, value))
}

/// Greatest number of lobes, outside of the model `lobes`, of a material of the set.
fn count(set: &MaterialSet<'_>, features: &Features) -> usize {
    set.materials.iter().map(|material| count_of(set, material, features)).max().unwrap_or(0)
}

/// Number of lobes of a material, none of the model `lobes`.
fn count_of(set: &MaterialSet<'_>, material: &MaterialEntry, features: &Features) -> usize {
    let is_base = material.layers.first().is_none_or(is_diffuse);
    match material.model.facts().family {
        Family::Lobes => 0,
        Family::Coefficients => 1,
        Family::Facets | Family::Beams if is_base => 0,
        Family::Facets => 1,
        Family::Beams if !features.has(Feature::GranierTransparent) => 1,
        // With a tilted inner boundary the beams of the channels part.
        Family::Beams if features.has(Feature::GranierTilted) => 4,
        Family::Beams => 2,
        Family::Path => chain::parts_count(set, material.model),
        Family::Statistics => material.layers.iter().rposition(|layer| !is_diffuse(layer)).map_or(0, |i| i + 1),
    }
}

fn number(model: ShadingModel) -> String {
    format!("{}u", model.number())
}

/// `luthier_prepare`, and `luthier_prepare_at` if a surface varies.
fn prepare(set: &MaterialSet<'_>, features: &Features, parts: usize) -> String {
    const SUMMARY: &str = "A material for light seen from wo: unit, in the local frame, away from the surface.";
    let has_place = features.has(Feature::Place);
    let (here, on_first) = on_first(set, features);
    let (name, parameters, eye) = match has_place {
        true => {
            ("luthier_prepare_at", "place: LuthierPlace, material: u32", format!("luthier_local({here}.normal, wo)"))
        }
        false => ("luthier_prepare", "material: u32", "wo".to_owned()),
    };
    let mut out = format!(
        "/// {SUMMARY}\nfn {name}({parameters}, wo: vec3<f32>) -> LuthierPrepared {{\n{on_first}    let eye = {eye};\n    \
         var prepared: LuthierPrepared;\n    prepared.material = material;\n"
    );
    if has_place {
        let _ = writeln!(out, "    prepared.place = {here};\n    prepared.open = min(wo.z, eye.z) > 0.0;");
    } else {
        out.push_str("    prepared.open = eye.z > 0.0;\n");
    }
    // Results for an eye below the horizon are not shown; the limit keeps them finite.
    out.push_str("    prepared.wo = vec3<f32>(eye.xy, max(eye.z, 1e-16));\n");
    for i in 0..parts {
        let _ = writeln!(out, "    prepared.parts[{i}] = luthier_no_part();");
    }
    if features.has(Feature::Several) {
        out.push_str("    prepared.model = luthier_whole(luthier_materials[luthier_header(material)].z);\n");
    }
    let (first, others) = by_model(set, "prepared.model", |model| {
        let place = if has_place { format!("{here}, ") } else { String::new() };
        format!("{}(prepared, {place}material, prepared.wo)", parts_function(model))
    });
    let _ = writeln!(out, "{others}    return {first};\n}}");
    if has_place {
        out.push_str(
            "\n/// `luthier_prepare_at` at a place without textures.\nfn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {\n    \
             return luthier_prepare_at(luthier_place(), material, wo);\n}\n",
        );
    }
    out
}

/// `luthier_light`. Models that keep values of the view (lobes, statistics) use them for every light; others evaluate anew.
fn light(set: &MaterialSet<'_>, features: &Features) -> String {
    let mut out = String::from(
        "/// f cos_theta_i, RGB, of a prepared material for light from wi: that of `luthier_eval`.\n\
         fn luthier_light(prepared: LuthierPrepared, wi: vec3<f32>) -> vec3<f32> {\n    \
         if wi.z <= 0.0 || !prepared.open {\n        return vec3<f32>(0.0);\n    }\n",
    );
    let wi = if features.has(Feature::Place) {
        out.push_str(
            "    let wi_here = luthier_local(prepared.place.normal, wi);\n    \
             if wi_here.z <= 0.0 {\n        return vec3<f32>(0.0);\n    }\n",
        );
        "wi_here"
    } else {
        "wi"
    };
    let place = if features.has(Feature::Place) { "prepared.place, " } else { "" };
    let lit = if features.has(Feature::Fluorescent) { light_of_a_colour(set, &out, place, wi) } else { String::new() };
    let (first, others) = by_model(set, "prepared.model", |model| match model.facts().family {
        Family::Lobes if features.has(Feature::Lobes) => {
            format!("luthier_light_{}(prepared.lobes, {wi})", sides(features))
        }
        Family::Statistics if !are_bases(&stacks(set, model)) => {
            let light = function(model).replace("luthier_eval", "luthier_light");
            format!("{light}(prepared, {place}prepared.material, {wi}, prepared.wo)")
        }
        _ => format!("{}({place}prepared.material, {wi}, prepared.wo)", function(model)),
    });
    out.push_str(&others);
    let fitted = set.models().find(|model| model.is_fitted());
    if let Some(model) = fitted.filter(|_| features.has(Feature::Lobes) && features.has(Feature::LobesDiffuse)) {
        let call = format!("{}({place}prepared.material, {wi}, prepared.wo)", function(model));
        out.push_str(&case("prepared.model", BASE, &call));
    }
    let _ = writeln!(out, "    return {first};\n}}");
    if lit.is_empty() { out } else { format!("{out}\n{lit}") }
}

/// `luthier_light_lit`. Its checks are those at the beginning of `luthier_light`, the text `light`.
fn light_of_a_colour(set: &MaterialSet<'_>, light: &str, place: &str, wi: &str) -> String {
    let mut out = String::from(
        "/// Light that a prepared material sends from wi to the eye, RGB, of light of a colour: that of `luthier_eval_lit`.\n\
         fn luthier_light_lit(prepared: LuthierPrepared, wi: vec3<f32>, light: vec3<f32>) -> vec3<f32> {\n",
    );
    out.extend(light.lines().skip(2).flat_map(|line| [line, "\n"]));
    let models: Vec<ShadingModel> = set.models().collect();
    let is_alone = models.len() == 1;
    for model in models.into_iter().filter(|model| model.is_path()) {
        let call = format!("{}_lit({place}prepared.material, {wi}, prepared.wo, light)", function(model));
        if is_alone {
            return format!("{out}    return {call};\n}}\n");
        }
        out.push_str(&case("prepared.model", &number(model), &call));
    }
    out + "    return light * luthier_light(prepared, wi);\n}\n"
}

/// `luthier_albedo`.
fn albedo(features: &Features, parts: usize) -> String {
    let mut sum = String::from("prepared.wide");
    for i in 0..parts {
        let part = format!("prepared.parts[{i}]");
        let _ = write!(sum, "\n        + {part}.energy * luthier_leaving_share({part}, prepared.wo)");
    }
    let mut out = String::from(
        "/// Directional albedo of a prepared material, RGB: of `lobes` that of its rows, of other models an estimate from their parts.\n\
         fn luthier_albedo(prepared: LuthierPrepared) -> vec3<f32> {\n    if !prepared.open {\n        return vec3<f32>(0.0);\n    }\n",
    );
    let lobes = format!("luthier_albedo_{}(prepared.lobes)", sides(features));
    match (features.has(Feature::Lobes), features.has(Feature::Several)) {
        (true, false) => out.push_str(&format!("    return {lobes};\n}}\n")),
        (has_lobes, _) => {
            if has_lobes {
                out.push_str(&case("prepared.model", "$model_lobes", &lobes));
            }
            out.push_str(&format!("    return {sum};\n}}\n"));
        }
    }
    out
}

/// Words in the modules of drawn directions and of the environment, each with statements for every part in its place.
fn unrolled(parts: usize, features: &Features) -> [(&'static str, String); 8] {
    let spilled = if features.has(Feature::Visible) { parts } else { 0 };
    let spill = each(spilled, |i| format!("    chance += luthier_spill(prepared.parts[{i}]);\n"));
    let density = each(parts, |i| {
        format!(
            "    let chance_{i} = luthier_chance(prepared.parts[{i}]);\n    \
             density += chance_{i} * luthier_part_density(prepared.parts[{i}], prepared.wo, wi);\n    total += chance_{i};\n"
        )
    });
    let total = each(parts, |i| format!("    total += luthier_chance(prepared.parts[{i}]);\n"));
    let choice = each(parts, |i| {
        format!(
            "    if choice >= below {{\n        part = prepared.parts[{i}];\n        drawn.part = {i}u;\n    }}\n    \
             below += luthier_chance(prepared.parts[{i}]);\n"
        )
    });
    let proposed = each(parts, |i| {
        format!(
            "    if luthier_chance(prepared.parts[{i}]) > 0.0 {{\n        \
             density += luthier_part_density(prepared.parts[{i}], prepared.wo, wi);\n    }}\n"
        )
    });
    let part =
        each(parts, |i| format!("        if part == {i}u {{\n            lobe = prepared.parts[{i}];\n        }}\n"));
    // The model `lobes` draws from all its lobes at once: a set of it alone has one proposal.
    let is_whole = features.has(Feature::Lobes) && !features.has(Feature::Several);
    let proposals = if is_whole { 1 } else { parts + 1 };
    let end = format!("    if choice >= below {{\n        drawn.part = {parts}u;\n    }}\n");
    let shown =
        each(parts, |i| format!("    light += luthier_environment_part(prepared.parts[{i}], prepared.wo, frame);\n"));
    [
        ("    $each_shown\n", shown),
        ("    $each_spill\n", spill),
        ("    $each_density\n", density),
        ("    $each_total\n", total),
        ("    $each_proposed\n", proposed),
        ("        $each_part\n", part),
        ("$proposals", format!("{proposals}u")),
        ("    $each_choice\n", choice + &end),
    ]
}

/// Statements of every part.
fn each(parts: usize, statements: impl Fn(usize) -> String) -> String {
    (0..parts).map(statements).collect()
}

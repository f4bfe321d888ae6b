//! Functions for renderers beside `luthier_eval`: a material prepared for a view, its light, drawn directions, its albedo.

use std::fmt::Write as _;

use luthier_layers::models::path;
use luthier_layers::models::room;
use luthier_manifest::{FunctionGroup, LayerKind, LayerRecord, MaterialEntry, ShadingModel};
use luthier_model::Family;

use crate::MaterialSet;
use crate::compose::feature::Feature;
use crate::compose::features::Features;
use crate::compose::{chain, function, statistics, text};

/// Number in place of a model's for a base alone of the model `lobes`, which has no rows.
const BASE: &str = "255u";

/// The function that fills the parts of a material, by its model.
pub(crate) fn parts_function(model: ShadingModel) -> String {
    function(model).replace("luthier_eval", "luthier_parts")
}

/// The modules of the groups of functions beside `eval`.
pub(crate) fn modules(set: &MaterialSet<'_>, features: &Features) -> Vec<String> {
    if set.functions.is_eval_alone() {
        return Vec::new();
    }
    let parts = count(set, features);
    let least = if features.has(Feature::Folded) && features.has(Feature::Media) { ", least: f32" } else { "" };
    let module = |wgsl: &str| {
        let wgsl = wgsl.replace("$parts", &format!("{parts}u")).replace("$model_base", BASE).replace("$least", least);
        let fitted = set.models().find(|model| model.is_fitted()).map(number).unwrap_or_default();
        text(&wgsl.replace("$model_lobes", &fitted), features)
    };
    let mut modules = vec![module(include_str!("../wgsl/face/prepared.wgsl"))];
    if features.has(Feature::Chain) {
        modules.push(module(path::PARTS));
    }
    for model in set.models() {
        modules.push(match model.facts().family {
            Family::Path => module(&chain::parts(set, model, features)),
            Family::Statistics => module(&statistics::parts(set, model)),
            Family::Beams | Family::Coefficients | Family::Facets | Family::Lobes => module(room(model).kernels.parts),
        });
    }
    modules.extend([module(&prepare(set, features, parts)), module(&light(set, features))]);
    if set.functions.has(FunctionGroup::Sample) {
        if features.has(Feature::Visible) || features.has(Feature::Coat) {
            modules.push(module(include_str!("../wgsl/face/visible.wgsl")));
        }
        if features.has(Feature::Lobes) {
            modules.extend(set.models().map(|model| module(room(model).kernels.sample)));
        }
        modules.push(unrolled(&module(include_str!("../wgsl/face/sample.wgsl")), parts, features));
        if set.functions.has(FunctionGroup::Propose) {
            modules.push(unrolled(&module(include_str!("../wgsl/face/propose.wgsl")), parts, features));
        }
    }
    if features.has(Feature::Environment) {
        modules.push(module(include_str!("../wgsl/face/environment.wgsl")));
    }
    if set.functions.has(FunctionGroup::Albedo) {
        modules.push(module(include_str!("../wgsl/face/albedo.wgsl")));
        modules.push(module(&albedo(features, parts)));
    }
    modules
}

/// Greatest number of lobes, outside of the model `lobes`, of a material of the set.
fn count(set: &MaterialSet<'_>, features: &Features) -> usize {
    let is_interface = |layer: &LayerRecord| layer.kind != LayerKind::Diffuse;
    let of = |material: &MaterialEntry| {
        let first = material.layers.first();
        match material.model.facts().family {
            Family::Lobes => 0,
            Family::Coefficients => 1,
            Family::Facets => usize::from(first.is_some_and(is_interface)),
            Family::Beams => match first {
                Some(layer) if layer.kind == LayerKind::Diffuse => 0,
                Some(_) if !features.has(Feature::GranierTransparent) => 1,
                // With a tilted inner boundary the beams of the channels part.
                _ if features.has(Feature::GranierTilted) => 4,
                _ => 2,
            },
            Family::Path => chain::parts_count(set, material.model, features.has(Feature::ChainPatina)),
            Family::Statistics => material.layers.iter().rposition(is_interface).map_or(0, |i| i + 1),
        }
    };
    set.materials.iter().map(of).max().unwrap_or(0)
}

fn number(model: ShadingModel) -> String {
    format!("{}u", model.number())
}

/// `luthier_prepare`, and `luthier_prepare_at` where surfaces vary.
fn prepare(set: &MaterialSet<'_>, features: &Features, parts: usize) -> String {
    const SUMMARY: &str = "A material for light seen from wo: unit, in the local frame, away from the surface.";
    let has_place = features.has(Feature::Place);
    let (name, parameters, eye) = match has_place {
        true => ("luthier_prepare_at", "place: LuthierPlace, material: u32", "luthier_local(place.normal, wo)"),
        false => ("luthier_prepare", "material: u32", "wo"),
    };
    let mut out = format!(
        "/// {SUMMARY}\nfn {name}({parameters}, wo: vec3<f32>) -> LuthierPrepared {{\n    let eye = {eye};\n    \
         var prepared: LuthierPrepared;\n    prepared.material = material;\n"
    );
    if has_place {
        out.push_str("    prepared.place = place;\n    prepared.open = min(wo.z, eye.z) > 0.0;\n");
    } else {
        out.push_str("    prepared.open = eye.z > 0.0;\n");
    }
    // What comes of an eye below the horizon is not shown.
    out.push_str("    prepared.wo = vec3<f32>(eye.xy, max(eye.z, 1e-16));\n");
    for i in 0..parts {
        let _ = writeln!(out, "    prepared.parts[{i}] = luthier_no_part();");
    }
    if features.has(Feature::Several) {
        out.push_str("    prepared.model = luthier_whole(luthier_materials[luthier_header(material)].z);\n");
    }
    let models: Vec<ShadingModel> = set.models().collect();
    let call = |model| format!("return {}(prepared, $place_argument material, prepared.wo);", parts_function(model));
    if let [first, others @ ..] = models.as_slice() {
        for &other in others {
            let _ = writeln!(out, "    if prepared.model == {} {{\n        {}\n    }}", number(other), call(other));
        }
        let _ = writeln!(out, "    {}\n}}", call(*first));
    }
    if has_place {
        out.push_str(
            "\n/// `luthier_prepare_at` at a place without textures.\nfn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {\n    \
             return luthier_prepare_at(luthier_place(), material, wo);\n}\n",
        );
    }
    out
}

/// `luthier_light`: what a view decides is not computed again where a model has such.
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
    let eval = |model| format!("return {}({place}prepared.material, {wi}, prepared.wo);", function(model));
    let call = |model: ShadingModel| match model.facts().family {
        Family::Lobes if features.has(Feature::Lobes) => format!("return luthier_light_lobes(prepared.lobes, {wi});"),
        Family::Statistics if !statistics::is_bare(set, model) => {
            let light = function(model).replace("luthier_eval", "luthier_light");
            format!("return {light}(prepared, {place}prepared.material, {wi}, prepared.wo);")
        }
        _ => eval(model),
    };
    let models: Vec<ShadingModel> = set.models().collect();
    if let [first, others @ ..] = models.as_slice() {
        let case = |number: &str, call: &str| format!("    if prepared.model == {number} {{\n        {call}\n    }}\n");
        for &other in others {
            out.push_str(&case(&number(other), &call(other)));
        }
        let fitted = models.iter().copied().find(|model| model.is_fitted());
        if let Some(model) = fitted.filter(|_| features.has(Feature::Lobes) && features.has(Feature::LobesDiffuse)) {
            out.push_str(&case(BASE, &eval(model)));
        }
        let _ = writeln!(out, "    {}\n}}", call(*first));
    }
    if lit.is_empty() { out } else { format!("{out}\n{lit}") }
}

/// `luthier_light_lit`; `light` is the beginning of `luthier_light`.
fn light_of_a_colour(set: &MaterialSet<'_>, light: &str, place: &str, wi: &str) -> String {
    let mut out = String::from(
        "/// Light that a prepared material sends from wi to the eye, RGB, of light of a colour: that of `luthier_eval_lit`.\n\
         fn luthier_light_lit(prepared: LuthierPrepared, wi: vec3<f32>, light: vec3<f32>) -> vec3<f32> {\n",
    );
    out.extend(light.lines().skip(2).flat_map(|line| [line, "\n"]));
    let models: Vec<ShadingModel> = set.models().collect();
    let is_alone = models.len() == 1;
    for model in models.into_iter().filter(|model| model.is_path()) {
        let call = format!("return {}_lit({place}prepared.material, {wi}, prepared.wo, light);", function(model));
        if is_alone {
            return format!("{out}    {call}\n}}\n");
        }
        let _ = write!(out, "    if prepared.model == {} {{\n        {call}\n    }}\n", number(model));
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
    let lobes = "return luthier_albedo_lobes(prepared.lobes);";
    match (features.has(Feature::Lobes), features.has(Feature::Several)) {
        (true, false) => out.push_str(&format!("    {lobes}\n}}\n")),
        (has_lobes, _) => {
            if has_lobes {
                out.push_str(&format!("    if prepared.model == $model_lobes {{\n        {lobes}\n    }}\n"));
            }
            out.push_str(&format!("    return {sum};\n}}\n"));
        }
    }
    out
}

/// The module of drawn directions with a statement for each part.
fn unrolled(module: &str, parts: usize, features: &Features) -> String {
    let each = |line: &dyn Fn(usize) -> String| (0..parts).map(line).collect::<String>();
    let spill = if features.has(Feature::Visible) {
        each(&|i| format!("    chance += luthier_spill(prepared.parts[{i}]);\n"))
    } else {
        String::new()
    };
    let density = each(&|i| {
        format!(
            "    let chance_{i} = luthier_chance(prepared.parts[{i}]);\n    \
             density += chance_{i} * luthier_part_density(prepared.parts[{i}], prepared.wo, wi);\n    total += chance_{i};\n"
        )
    });
    let total = each(&|i| format!("    total += luthier_chance(prepared.parts[{i}]);\n"));
    let choice = each(&|i| {
        format!(
            "    if choice >= below {{\n        part = prepared.parts[{i}];\n        drawn.part = {i}u;\n    }}\n    \
             below += luthier_chance(prepared.parts[{i}]);\n"
        )
    });
    let proposed = each(&|i| {
        format!(
            "    if luthier_chance(prepared.parts[{i}]) > 0.0 {{\n        \
             density += luthier_part_density(prepared.parts[{i}], prepared.wo, wi);\n    }}\n"
        )
    });
    let part = each(&|i| format!("        if part == {i}u {{\n            lobe = prepared.parts[{i}];\n        }}\n"));
    // Of `lobes` alone the draw of the whole is the only proposal.
    let is_whole = features.has(Feature::Lobes) && !features.has(Feature::Several);
    let proposals = if is_whole { 1 } else { parts + 1 };
    let end = format!("    if choice >= below {{\n        drawn.part = {parts}u;\n    }}\n");
    module
        .replace("    $each_spill\n", &spill)
        .replace("    $each_density\n", &density)
        .replace("    $each_total\n", &total)
        .replace("    $each_proposed\n", &proposed)
        .replace("        $each_part\n", &part)
        .replace("$proposals", &format!("{proposals}u"))
        .replace("    $each_choice\n", &format!("{choice}{end}"))
}

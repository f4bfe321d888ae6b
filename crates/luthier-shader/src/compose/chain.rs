//! Models that go through the layers one by one, written out: one step for every layer that a material of the set may have.

use std::fmt::Write as _;

use luthier_manifest::{LayerKind, ShadingModel};

use crate::MaterialSet;
use crate::compose::features::Features;
use crate::compose::function;

/// `luthier_eval_<model>` of a model, whose function `interface` adds an interface to a `LuthierPath`.
pub(crate) fn eval(set: &MaterialSet<'_>, model: ShadingModel, interface: &str, features: &Features) -> String {
    let name = function(model);
    let layers: Vec<_> = set.materials.iter().filter(|m| m.model == model).map(|m| m.layers.as_slice()).collect();
    let has_patina = features.has("patina");
    let (name, bare) =
        if has_patina { (name.replace("luthier_eval", "luthier_stack"), " is_bare: bool,") } else { (name, "") };
    let without = if has_patina { "; where it is bare, without the first layer" } else { "" };
    let mut out = format!(
        "/// f cos_theta_i of the model `{}`, both directions above the horizon{without}.\n\
         fn {name}($place_parameter material: u32,{bare} wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n",
        model.name()
    );
    let is_diffuse = |layer: &luthier_manifest::LayerRecord| layer.kind == LayerKind::Diffuse;
    if layers.iter().all(|layers| layers.first().is_some_and(is_diffuse)) {
        out.push_str("    let layer = $layer(material, 0u);\n    return wi.z * $diffuse(layer, wi, wo);\n}\n");
        return out + &patina(model, features);
    }
    let depth = layers.iter().map(|layers| layers.len()).max().unwrap_or(0);
    let least = layers.iter().map(|layers| layers.len()).min().unwrap_or(0);
    if least < depth || depth > 1 && has_patina {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    let below = match (features.has("flakes"), has_patina) {
        (false, _) => "",
        (true, false) => ", place.flake_normal",
        (true, true) => ", select(place.flake_normal, vec3<f32>(0.0, 0.0, 1.0), is_bare)",
    };
    let alpha = if features.has("clamped") { "0.0, " } else { "" };
    let _ = writeln!(
        out,
        "    // Products of lower cosines would underflow; the outer one stays as it is.\n    \
             let down = vec3<f32>(wi.xy, max(wi.z, 1e-16));\n    \
             let up = vec3<f32>(wo.xy, max(wo.z, 1e-16));\n    \
             var path = LuthierPath(down, up, wi.xy + wo.xy, vec3<f32>(1.0), vec3<f32>(0.0), {alpha}true{below});"
    );
    for i in 0..depth {
        let here = || layers.iter().filter_map(|layers| layers.get(i));
        // What lies below patina has a record of its own for where it is bare.
        let index = if has_patina && i == 1 { "select(1u, count, is_bare)".to_owned() } else { format!("{i}u") };
        let add = |function: &str| format!("path = {function}(path, $layer(material, {index}));");
        let step = match (here().any(is_diffuse), here().all(is_diffuse)) {
            (false, _) => vec![add(interface)],
            (true, true) => vec![add("luthier_add_diffuse")],
            (true, false) => vec![
                format!("let layer_{i} = $layer(material, {index});"),
                format!("if layer_{i}.kind == LUTHIER_DIFFUSE {{"),
                format!("    path = luthier_add_diffuse(path, layer_{i});"),
                "} else {".to_owned(),
                format!("    path = {interface}(path, layer_{i});"),
                "}".to_owned(),
            ],
        };
        let indent = if i == 0 && !has_patina { "    " } else { "        " };
        let step: String = step.iter().map(|line| format!("{indent}{line}\n")).collect();
        let _ = match i {
            0 if has_patina => write!(out, "    if !is_bare {{\n{step}    }}\n"),
            0 => write!(out, "{step}"),
            _ if i < least => write!(out, "    if path.open {{\n{step}    }}\n"),
            _ => write!(out, "    if path.open & (count > {i}u) {{\n{step}    }}\n"),
        };
    }
    out.push_str("    return wi.z * path.total;\n}\n");
    out + &patina(model, features)
}

/// The function of a model where a material of the set has patina: with and without the first layer, blended.
fn patina(model: ShadingModel, features: &Features) -> String {
    if !features.has("patina") {
        return String::new();
    }
    let name = function(model);
    let stack = name.replace("luthier_eval", "luthier_stack");
    format!(
        "\n/// f cos_theta_i of the model `{}` with patina (Elek 2010, section 4.2).\n\
         fn {name}(place: LuthierPlace, material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n    \
             var value = luthier_patina_diffuse(place, material, wi, wo);\n    \
             let amount = select(1.0, place.patina, place.patina >= 0.0);\n    \
             if amount < 1.0 {{\n        \
                 value += (1.0 - amount) * {stack}(place, material, true, wi, wo);\n    \
             }}\n    \
             if amount > 0.0 {{\n        \
                 value += amount * {stack}(place, material, false, wi, wo);\n    \
             }}\n    \
             return value;\n\
         }}\n",
        model.name()
    )
}

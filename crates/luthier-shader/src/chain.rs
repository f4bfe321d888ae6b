//! Models that go through the layers one by one, written out: one step for every layer that a material of the set may have.

use std::fmt::Write as _;

use luthier_lut::{LayerKind, ShadingModel};

use crate::MaterialSet;
use crate::features::Features;
use crate::wgsl::function;

/// `luthier_eval_<model>` of a model, whose function `interface` adds an interface to a `LuthierPath`.
pub(crate) fn eval(set: &MaterialSet<'_>, model: ShadingModel, interface: &str, features: &Features) -> String {
    let name = function(model);
    let layers: Vec<_> = set.materials.iter().filter(|m| m.model == model).map(|m| m.layers.as_slice()).collect();
    let mut out = format!(
        "/// f cos_theta_i of the model `{}`, both directions above the horizon.\n\
         fn {name}($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n",
        model.name()
    );
    let is_diffuse = |layer: &luthier_lut::LayerRecord| layer.kind == LayerKind::Diffuse;
    if layers.iter().all(|layers| layers.first().is_some_and(is_diffuse)) {
        let diffuse =
            if features.has("oren_nayar") { "luthier_diffuse(layer, wi, wo)" } else { "luthier_diffuse(layer)" };
        let _ = writeln!(out, "    let layer = $layer(material, 0u);\n    return wi.z * {diffuse};\n}}");
        return out;
    }
    let depth = layers.iter().map(|layers| layers.len()).max().unwrap_or(0);
    if depth > 1 {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    out.push_str("    var path = LuthierPath(wi, wo, wi.xy + wo.xy, vec3<f32>(wi.z), vec3<f32>(0.0), 0.0, true);\n");
    for i in 0..depth {
        let here = || layers.iter().filter_map(|layers| layers.get(i));
        let add = |function: &str| format!("path = {function}(path, $layer(material, {i}u));");
        let step = match (here().any(is_diffuse), here().all(is_diffuse)) {
            (false, _) => vec![add(interface)],
            (true, true) => vec![add("luthier_add_diffuse")],
            (true, false) => vec![
                format!("let layer_{i} = $layer(material, {i}u);"),
                format!("if layer_{i}.kind == LUTHIER_DIFFUSE {{"),
                format!("    path = luthier_add_diffuse(path, layer_{i});"),
                "} else {".to_owned(),
                format!("    path = {interface}(path, layer_{i});"),
                "}".to_owned(),
            ],
        };
        let indent = if i == 0 { "    " } else { "        " };
        let step: String = step.iter().map(|line| format!("{indent}{line}\n")).collect();
        let _ = match i {
            0 => write!(out, "{step}"),
            _ => write!(out, "    if path.open & (count > {i}u) {{\n{step}    }}\n"),
        };
    }
    out.push_str("    return path.reflected;\n}\n");
    out
}

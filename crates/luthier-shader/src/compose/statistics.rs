//! Belcour's and Yamaguchi's models, which differ in the type of a spread only: written out, one step for every layer that a
//! material of the set may have.

use std::fmt::Write as _;

use luthier_manifest::{LayerKind, LayerRecord, ShadingModel};

use crate::MaterialSet;
use crate::compose::features::Features;
use crate::compose::{function, text};

/// The modules of a model, `luthier_eval_<model>` last.
pub(crate) fn modules(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> Vec<String> {
    let (path, spread, spreads) = match model {
        ShadingModel::Yamaguchi => ("LuthierYamaguchi", "vec3<f32>", include_str!("../wgsl/models/yamaguchi.wgsl")),
        _ => ("LuthierBelcour", "f32", include_str!("../wgsl/models/belcour.wgsl")),
    };
    let named = |module: String| {
        let mut module = module.replace("$Path", path).replace("$spread", spread);
        for name in ["start", "add_base", "add", "interface_spread", "mean_alpha", "limited"] {
            module = module.replace(&format!("${name}("), &format!("luthier_{}_{name}(", model.name()));
        }
        module
    };
    if is_bare(set, model) {
        return vec![text(&eval(set, model), features)];
    }
    vec![
        named(text(include_str!("../wgsl/models/statistics_path.wgsl"), features)),
        text(spreads, features),
        text(&eval(set, model), features),
    ]
}

/// Whether every material of a model is a diffuse base alone.
fn is_bare(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    layers(set, model).iter().all(|layers| layers.first().is_some_and(is_diffuse))
}

fn layers<'a>(set: &MaterialSet<'a>, model: ShadingModel) -> Vec<&'a [LayerRecord]> {
    set.materials.iter().filter(|m| m.model == model).map(|m| m.layers.as_slice()).collect()
}

fn is_diffuse(layer: &LayerRecord) -> bool {
    layer.kind == LayerKind::Diffuse
}

fn eval(set: &MaterialSet<'_>, model: ShadingModel) -> String {
    let (name, prefix) = (function(model), format!("luthier_{}", model.name()));
    let layers = layers(set, model);
    let mut out = format!(
        "/// f cos_theta_i of the model `{}`, both directions above the horizon. Lobes have the statistics of the eye's direction.\n\
         fn {name}($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n",
        model.name()
    );
    if is_bare(set, model) {
        return out + "    let layer = $layer(material, 0u);\n    return wi.z * $diffuse(layer, wi, wo);\n}\n";
    }
    let depth = layers.iter().map(|layers| layers.len()).max().unwrap_or(0);
    if depth > 1 {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    let _ = writeln!(out, "    var sum = vec3<f32>(0.0);\n    var eye = {prefix}_start(wo.z);");
    for i in 0..depth {
        let here = || layers.iter().filter_map(|layers| layers.get(i));
        let mut step = vec![format!("let layer_{i} = $layer(material, {i}u);")];
        let interface = [format!("eye = {prefix}_add(eye, layer_{i});"), format!("sum += {prefix}_lobe(eye, wi, wo);")];
        // The other direction takes the same way down; every layer above a base is an interface.
        let above = (0..i).map(|k| format!("light = {prefix}_add(light, $layer(material, {k}u));"));
        let base = std::iter::once(format!("var light = {prefix}_start(wi.z);"))
            .chain(above)
            .chain([format!("sum += {prefix}_add_base(material, layer_{i}, light, eye, wi, wo);")]);
        match (here().any(is_diffuse), here().all(is_diffuse)) {
            (false, _) => step.extend(interface),
            (true, true) => step.extend(base),
            (true, false) => {
                let indented = |lines: &mut dyn Iterator<Item = String>| lines.map(|l| format!("    {l}")).collect();
                let (base, interface): (Vec<String>, Vec<String>) =
                    (indented(&mut base.chain(["eye.open = false;".to_owned()])), indented(&mut interface.into_iter()));
                step.push(format!("if layer_{i}.kind == LUTHIER_DIFFUSE {{"));
                step.extend(base);
                step.push("} else {".to_owned());
                step.extend(interface);
                step.push("}".to_owned());
            }
        }
        let indent = if i == 0 { "    " } else { "        " };
        let step: String = step.iter().map(|line| format!("{indent}{line}\n")).collect();
        let _ = match i {
            0 => write!(out, "{step}"),
            _ => write!(out, "    if eye.open & (count > {i}u) {{\n{step}    }}\n"),
        };
    }
    out.push_str("    return sum;\n}\n");
    out
}

//! Models that follow statistics of light, written out: one step for each depth of the deepest material. The models differ in the type of a
//! spread only.

use std::fmt::Write as _;

use luthier_layers::models::room;
use luthier_layers::models::statistics;
use luthier_manifest::ShadingModel;

use crate::MaterialSet;
use crate::compose::chain::of_layer;
use crate::compose::face::parts_function;
use crate::compose::features::Features;
use crate::compose::stacks::{are_bases, depths, diffuse_at, is_diffuse, stacks, step};
use crate::compose::{function, text};

/// The modules of a model, `luthier_eval_<model>` last.
pub(crate) fn modules(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> Vec<String> {
    if are_bases(&stacks(set, model)) {
        return vec![text(&eval(set, model), features)];
    }
    vec![
        named(text(statistics::ADDING, features), model),
        text(room(model).kernels.eval, features),
        text(&eval(set, model), features),
    ]
}

/// The module that adds layers, with the types and functions of a model in place of `$Path`, `$spread` and `$add(`.
fn named(module: String, model: ShadingModel) -> String {
    let name = model.name();
    let path = format!("Luthier{}{}", name[..1].to_uppercase(), &name[1..]);
    let spread = if model.facts().is_isotropic { "f32" } else { "vec3<f32>" };
    let module = module.replace("$Path", &path).replace("$spread", spread);
    ["start", "add_base", "add", "interface_spread", "mean_alpha", "limited"].iter().fold(module, |module, function| {
        module.replace(&format!("${function}("), &format!("luthier_{name}_{function}("))
    })
}

/// Statements that take light at a cosine down to layer `i`: every layer above a base is an interface.
fn down(prefix: &str, cosine: &str, i: usize) -> Vec<String> {
    let above = (0..i).map(|k| format!("light = {prefix}_add(light, $layer(material, {k}u));"));
    std::iter::once(format!("var light = {prefix}_start({cosine});")).chain(above).collect()
}

fn eval(set: &MaterialSet<'_>, model: ShadingModel) -> String {
    let (name, prefix) = (function(model), format!("luthier_{}", model.name()));
    let layers = stacks(set, model);
    let mut out = format!(
        "/// f cos_theta_i of the model `{}`, both directions above the horizon. Lobes have the statistics of the eye's direction.\n\
         fn {name}($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n",
        model.name()
    );
    if are_bases(&layers) {
        return out + "    let layer = $layer(material, 0u);\n    return wi.z * $diffuse(layer, wi, wo);\n}\n";
    }
    let (_, depth) = depths(&layers);
    if depth > 1 {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    let _ = writeln!(out, "    var sum = vec3<f32>(0.0);\n    var eye = {prefix}_start(wo.z);");
    for i in 0..depth {
        let (has_base, is_base) = diffuse_at(&layers, i);
        let mut lines = vec![format!("let layer_{i} = $layer(material, {i}u);")];
        let interface = [format!("eye = {prefix}_add(eye, layer_{i});"), format!("sum += {prefix}_lobe(eye, wi, wo);")];
        // The other direction takes the same way down.
        let mut base = down(&prefix, "wi.z", i);
        base.push(format!("sum += {prefix}_add_base(material, layer_{i}, light, eye, wi, wo);"));
        if !is_base {
            base.push("eye.open = false;".to_owned());
        }
        lines.extend(step((has_base, is_base), &format!("layer_{i}"), base, interface));
        let indent = if i == 0 { "    " } else { "        " };
        let step: String = lines.iter().map(|line| format!("{indent}{line}\n")).collect();
        let _ = match i {
            0 => write!(out, "{step}"),
            _ => write!(out, "    if eye.open & (count > {i}u) {{\n{step}    }}\n"),
        };
    }
    out.push_str("    return sum;\n}\n");
    out
}

/// `luthier_parts_<model>`, which keeps the lobes of the eye's direction for all lights, and `luthier_light_<model>`.
pub(crate) fn parts(set: &MaterialSet<'_>, model: ShadingModel) -> String {
    let prefix = format!("luthier_{}", model.name());
    let mut out = format!(
        "/// The parts of the model `{}`: its lobes, and its base.\n\
         fn {}(given: LuthierPrepared, $place_parameter material: u32, wo: vec3<f32>) -> LuthierPrepared {{\n    \
             var prepared = given;\n",
        model.name(),
        parts_function(model)
    );
    let layers = stacks(set, model);
    if are_bases(&layers) {
        return out
            + "    let layer = $layer(material, 0u);\n    let light = luthier_mean_light(wo);\n    \
               prepared.wide = LUTHIER_PI * $diffuse(layer, light, wo);\n    return prepared;\n}\n";
    }
    let (_, depth) = depths(&layers);
    if depth > 1 {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    let has_base = layers.iter().flat_map(|layers| layers.iter()).any(is_diffuse);
    if has_base {
        out.push_str("    let mean = luthier_mean_light(wo);\n");
    }
    let _ = writeln!(out, "    var eye = {prefix}_start(wo.z);");
    let mut light = format!(
        "\n/// f cos_theta_i of the model `{}`, its lobes as they are prepared.\n\
         fn luthier_light_{}(prepared: LuthierPrepared, $place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n    \
             var sum = vec3<f32>(0.0);\n",
        model.name(),
        model.name()
    );
    for i in 0..depth {
        let (has_base, is_base) = diffuse_at(&layers, i);
        let interface =
            [format!("eye = {prefix}_add(eye, layer);"), format!("prepared.parts[{i}] = {prefix}_part(eye);")];
        let mut base = down(&prefix, "mean.z", i);
        base.extend([
            format!(
                "prepared.wide = {prefix}_add_base(material, layer, light, eye, mean, wo) * (LUTHIER_PI / mean.z);"
            ),
            format!("prepared.base = {}u;", i + 1),
            "prepared.base_share = eye.t0i;".to_owned(),
            "prepared.base_cos = eye.cos_theta;".to_owned(),
            "prepared.base_eta = eye.eta;".to_owned(),
            "eye.open = false;".to_owned(),
        ]);
        if !is_base {
            let _ = writeln!(
                light,
                "    sum += prepared.parts[{i}].energy * luthier_ggx_lobe(prepared.parts[{i}].alpha, prepared.parts[{i}].axis, wi, wo);"
            );
        }
        if has_base {
            let _ = writeln!(light, "    if prepared.base == {}u {{", i + 1);
            let mut step = down(&prefix, "wi.z", i);
            step.extend([
                format!("var eye = {prefix}_start(1.0);"),
                "eye.t0i = prepared.base_share;".to_owned(),
                "eye.cos_theta = prepared.base_cos;".to_owned(),
                "eye.eta = prepared.base_eta;".to_owned(),
                format!("sum += {prefix}_add_base(material, $layer(material, {i}u), light, eye, wi, wo);"),
            ]);
            light.extend(step.iter().map(|line| format!("        {line}\n")));
            light.push_str("    }\n");
        }
        let mut lines = vec![format!("let layer = $layer(material, {i}u);")];
        lines.extend(step((has_base, is_base), "layer", base, interface));
        out.push_str(&match i {
            0 => "    {\n".to_owned(),
            _ => format!("    if eye.open & (count > {i}u) {{\n"),
        });
        out.extend(lines.iter().map(|line| format!("        {}\n", of_layer(line, i))));
        out.push_str("    }\n");
    }
    out + "    return prepared;\n}\n" + &light + "    return sum;\n}\n"
}

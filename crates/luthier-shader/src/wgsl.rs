//! Composition: the modules that a set needs, and `luthier_eval` written out layer by layer.

use std::fmt::Write as _;

use luthier_lut::LayerKind;

use crate::features::Features;
use crate::lookup::lookup;
use crate::module::prune;
use crate::{Form, MaterialSet, ShaderError, bindings};

/// Where the material buffer lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Buffer {
    /// Storage, of any length.
    Storage,
    /// Uniform, as long as it must be.
    Uniform,
}

/// WGSL of a set, without the header comment.
pub(crate) fn compose(set: &MaterialSet<'_>, form: Form, buffer: Buffer) -> Result<String, ShaderError> {
    set.check(form)?;
    let features = Features::of(set, form);
    let has = |name| features.has(name);
    let mut parts = vec![constants(set)?, declarations(set, form, buffer)];
    for table in set.tables_read(form) {
        parts.push(lookup(table, &features)?);
    }
    let modules = [
        (has("bilinear"), include_str!("wgsl/bilinear.wgsl")),
        (true, include_str!("wgsl/layer.wgsl")),
        (has("oren_nayar"), include_str!("wgsl/oren_nayar.wgsl")),
        (has("diffuse") && !has("oren_nayar"), include_str!("wgsl/lambert.wgsl")),
        (has("full") && has("interface"), include_str!("wgsl/complex.wgsl")),
        (has("full") && has("bare"), include_str!("wgsl/fresnel.wgsl")),
        (has("full") && has("film"), include_str!("wgsl/film.wgsl")),
        (has("full") && has("beckmann"), include_str!("wgsl/beckmann.wgsl")),
        (has("full") && has("ggx"), include_str!("wgsl/ggx.wgsl")),
        (has("full") && has("interface"), include_str!("wgsl/terms_full.wgsl")),
        (!has("full") && has("interface"), include_str!("wgsl/terms_baked.wgsl")),
        (has("interface"), include_str!("wgsl/interface.wgsl")),
        (has("interface") && has("diffuse"), include_str!("wgsl/base.wgsl")),
    ];
    parts.extend(modules.iter().filter(|(used, _)| *used).map(|(_, module)| prune(module, &features)));
    parts.push(eval(set, &features));
    Ok(parts.join("\n"))
}

/// Numbers of the materials, by name.
fn constants(set: &MaterialSet<'_>) -> Result<String, ShaderError> {
    let mut out = String::new();
    for (i, constant) in set.constants()?.iter().enumerate() {
        let _ = writeln!(out, "const {constant}: u32 = {i}u;");
    }
    Ok(out)
}

fn declarations(set: &MaterialSet<'_>, form: Form, buffer: Buffer) -> String {
    let mut out = String::new();
    for entry in bindings(set, form) {
        let (space, resource) = match (entry.resource.as_str(), buffer) {
            ("buffer", Buffer::Storage) => ("<storage, read>", "array<vec4<f32>>".to_owned()),
            ("buffer", Buffer::Uniform) => ("<uniform>", format!("array<vec4<f32>, {}>", set.words())),
            _ => ("", entry.resource),
        };
        let _ = writeln!(out, "@group(0) @binding({}) var{space} {}: {resource};", entry.binding, entry.name);
    }
    out
}

/// `luthier_eval`, with one step for every layer that a material of the set may have.
fn eval(set: &MaterialSet<'_>, features: &Features) -> String {
    let diffuse = if features.has("oren_nayar") { "luthier_diffuse(layer, wi, wo)" } else { "luthier_diffuse(layer)" };
    let mut out = String::from(
        "/// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away\n\
         /// from the surface. Zero when either is not above the horizon.\n\
         fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {\n\
         \x20   if min(wi.z, wo.z) <= 0.0 {\n        return vec3<f32>(0.0);\n    }\n",
    );
    if !features.has("interface") {
        let _ = writeln!(out, "    let layer = luthier_layer(material, 0u);\n    return wi.z * {diffuse};\n}}");
        return out;
    }
    let depth = set.materials.iter().map(|m| m.layers.len()).max().unwrap_or(0);
    if depth > 1 {
        out.push_str("    let count = luthier_layer_count(material);\n");
    }
    out.push_str("    var path = LuthierPath(wi, wo, vec3<f32>(wi.z), vec3<f32>(0.0), 0.0, true);\n");
    for i in 0..depth {
        let mut here = set.materials.iter().filter_map(|m| m.layers.get(i)).map(|l| l.kind == LayerKind::Diffuse);
        let has_diffuse = here.clone().any(|is_diffuse| is_diffuse);
        let add = match (has_diffuse, here.any(|is_diffuse| !is_diffuse)) {
            (true, true) => "luthier_add_layer",
            (true, false) => "luthier_add_diffuse",
            _ => "luthier_add_interface",
        };
        let step = format!("path = {add}(path, luthier_layer(material, {i}u));");
        let _ = match i {
            0 => writeln!(out, "    {step}"),
            _ => writeln!(out, "    if path.open & (count > {i}u) {{\n        {step}\n    }}"),
        };
    }
    out.push_str("    return path.reflected;\n}\n");
    out
}

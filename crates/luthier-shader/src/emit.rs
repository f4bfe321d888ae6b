use std::fmt::Write as _;

use luthier_lut::{Axis, Mapping, ShadingModel};

use crate::glsl;
use crate::wgsl::{Buffer, compose};
use crate::{Form, MaterialSet, ShaderError, Target, bindings, validate};

/// Words of the smallest uniform block that GLSL ES 3.00 guarantees (16 KiB).
const UNIFORM_WORDS: usize = 1024;

/// A snippet to paste: functions, bindings and constants for the materials of a set, without an entry point. It has been
/// parsed and validated.
///
/// # Errors
/// See [`ShaderError`]: materials that no shader can be emitted for, or a defect found by naga.
pub fn emit(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    let buffer = if target == Target::GlslEs300 { Buffer::Uniform } else { Buffer::Storage };
    let wgsl = compose(set, form, buffer)?;
    let body = match target {
        Target::Wgsl => {
            validate(&wgsl)?;
            wgsl
        }
        Target::Glsl450 | Target::GlslEs300 => {
            let words = set.words();
            if buffer == Buffer::Uniform && words > UNIFORM_WORDS {
                return Err(ShaderError::UniformBlockTooLarge { words, limit: UNIFORM_WORDS });
            }
            glsl::from_wgsl(&wgsl, set, form, target)?
        }
    };
    Ok(format!("{}\n{body}", header(set, form, target)))
}

/// A complete fragment shader around the snippet: `luthier_eval` for interpolated directions and a flat material number.
///
/// # Errors
/// As [`emit`].
pub fn complete(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    let snippet = emit(set, form, target)?;
    Ok(match target {
        Target::Wgsl => {
            let shader = format!("{snippet}\n{}", include_str!("wgsl/fragment.wgsl"));
            validate(&shader)?;
            shader
        }
        Target::Glsl450 => format!("#version 450 core\n{snippet}\n{}", include_str!("glsl/fragment_450.glsl")),
        Target::GlslEs300 => {
            let precision = "precision highp float;\nprecision highp int;\n";
            format!("#version 300 es\n{precision}{snippet}\n{}", include_str!("glsl/fragment_es300.glsl"))
        }
    })
}

/// The comment at the top: what this is, what it reads, what to bind.
fn header(set: &MaterialSet<'_>, form: Form, target: Target) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "// luthier {}, form {form}, {target}. Generated: bake again instead of editing.",
        env!("CARGO_PKG_VERSION")
    );
    let models: Vec<&str> = set.models().map(ShadingModel::title).collect();
    let _ = writeln!(out, "// Model{}: {}.", if models.len() == 1 { "" } else { "s" }, models.join("; "));
    let _ = match form {
        Form::Baked => writeln!(out, "// Fresnel reflectance and slope distribution are read from tables."),
        Form::Full => writeln!(out, "// No tables: Fresnel equations at three wavelengths, closed forms of D."),
    };
    if target == Target::GlslEs300 {
        out.push_str("// Needs `precision highp float;` and `precision highp int;` above.\n");
    }
    if set.tables_read(form).next().is_some() {
        out.push_str("//\n// Tables, in texels:\n");
        for table in set.tables_read(form) {
            let ([width, height], [tile_width, tile_height]) = (table.layout.size(), table.layout.tile_size());
            let mut axes = axis(&table.layout.x);
            if let Some(y) = &table.layout.y {
                let _ = write!(axes, ", {}", axis(y));
            }
            let (name, format, tiles) = (table.kind.name(), table.format, table.layout.tiles);
            let plural = if tiles == 1 { "" } else { "s" };
            let _ = writeln!(
                out,
                "//   {name:<13} {width} x {height} {format}, {tiles} tile{plural} of {tile_width} x {tile_height}; {axes}"
            );
        }
    }
    out.push_str("//\n");
    out.push_str(if target == Target::GlslEs300 { "// Bindings, by name:\n" } else { "// Bindings, group 0:\n" });
    for entry in bindings(set, form) {
        if target != Target::Wgsl && entry.resource == "sampler" {
            out.push_str("//   each texture filtered linearly, clamped to its edge\n");
            continue;
        }
        let resource = match (entry.resource.as_str(), target) {
            ("buffer", Target::GlslEs300) => format!("uniform block LuthierMaterials (std140), {} vec4", set.words()),
            ("buffer", Target::Glsl450) => format!("storage block LuthierMaterials (std430), {} vec4", set.words()),
            ("buffer", Target::Wgsl) => format!("storage buffer, {} vec4", set.words()),
            ("sampler", _) => "sampler, linear, clamp to edge".to_owned(),
            (_, Target::Wgsl) => "texture".to_owned(),
            _ => "sampler2D".to_owned(),
        };
        let number = if target == Target::GlslEs300 { String::new() } else { format!("{} ", entry.binding) };
        let _ = writeln!(out, "//   {number}{}: {resource}", entry.name);
    }
    out.push_str("//\n// Materials:\n");
    for (i, material) in set.materials.iter().enumerate() {
        let layers = material.layers.len();
        let _ = writeln!(
            out,
            "//   {i} {}, {}, {layers} layer{}",
            material.name,
            material.model.name(),
            if layers == 1 { "" } else { "s" }
        );
    }
    out
}

/// `cos_theta 0..1, u^2`.
fn axis(axis: &Axis) -> String {
    let mapping = match axis.mapping {
        Mapping::Linear => String::new(),
        Mapping::Power { exponent } => format!(" as u^{exponent}"),
        Mapping::Logarithmic => " logarithmic".to_owned(),
        Mapping::Periodic => " repeating".to_owned(),
    };
    format!("{} {}..{}{mapping}", axis.quantity, axis.min as f32, axis.max as f32)
}

//! Snippets and complete shaders, each under a comment that says how to use it.

mod binding_lines;

use std::fmt::Write as _;

use luthier_lut::{Axis, Mapping, ShadingModel, TableKind};

use self::binding_lines::binding_lines;
use crate::compose::{Buffer, compose};
use crate::languages::{glsl, hlsl, msl};
use crate::{Form, MaterialSet, ShaderError, Target, validate};

/// The entry point of a complete shader, in WGSL.
pub(crate) const FRAGMENT: &str = include_str!("../wgsl/fragment.wgsl");

/// A snippet to paste: functions, bindings and constants for the materials of a set, without an entry point. It has been
/// parsed and validated.
///
/// # Errors
/// See [`ShaderError`]: materials that no shader can be emitted for, a defect found by naga, or SPIR-V, which is no text.
pub fn emit(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    text(set, form, target, "", None)
}

/// The snippet for one material, whose numbers are constants of the code: it binds no buffer, and what depends on them alone is
/// computed when the shader is compiled. Same functions; the number of the material is not looked at.
///
/// # Errors
/// As [`emit`], and [`ShaderError::NotOne`] for sets of any other length than 1.
pub fn emit_constant(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    if set.materials.len() != 1 {
        return Err(ShaderError::NotOne(set.materials.len()));
    }
    text(set, form, target, "", Some(Buffer::Constant))
}

/// A complete fragment shader around the snippet: `luthier_eval` for interpolated directions and a flat material number.
/// Its entry point is `main`; in MSL, where no function may have that name, `main_`.
///
/// # Errors
/// As [`emit`].
pub fn complete(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    Ok(match target {
        Target::Wgsl | Target::Hlsl | Target::Msl | Target::SpirV => text(set, form, target, FRAGMENT, None)?,
        Target::Glsl450 => {
            let snippet = emit(set, form, target)?;
            format!("#version 450 core\n{snippet}\n{}", include_str!("../glsl/fragment_450.glsl"))
        }
        Target::GlslEs300 => {
            let snippet = emit(set, form, target)?;
            let precision = "precision highp float;\nprecision highp int;\n";
            format!("#version 300 es\n{precision}{snippet}\n{}", include_str!("../glsl/fragment_es300.glsl"))
        }
    })
}

/// A snippet and what WGSL is to follow it, in a language of text; the buffer where the language has it, unless given.
fn text(
    set: &MaterialSet<'_>,
    form: Form,
    target: Target,
    more: &str,
    buffer: Option<Buffer>,
) -> Result<String, ShaderError> {
    let is_constant = buffer == Some(Buffer::Constant);
    let wgsl = if is_constant { compose(set, form, Buffer::Constant)? } else { body(set, form, target, more)? };
    let body = match target {
        Target::Wgsl => {
            validate(&wgsl)?;
            wgsl
        }
        Target::Glsl450 | Target::GlslEs300 => glsl::from_wgsl(&wgsl, set, form, target)?,
        Target::Hlsl => hlsl::from_wgsl(&wgsl, set, form)?,
        Target::Msl => msl::from_wgsl(&wgsl, set, form)?,
        Target::SpirV => return Err(ShaderError::NotText),
    };
    Ok(format!("{}\n{body}", header(set, form, target, is_constant)))
}

/// The WGSL that a target is made from, and what WGSL is to follow it.
pub(crate) fn body(set: &MaterialSet<'_>, form: Form, target: Target, more: &str) -> Result<String, ShaderError> {
    let buffer = match target {
        Target::GlslEs300 => Buffer::Texture,
        // Arrays of any length would want a table of lengths as one more argument.
        Target::Msl => Buffer::Sized,
        Target::Wgsl | Target::Glsl450 | Target::Hlsl | Target::SpirV => Buffer::Storage,
    };
    let wgsl = compose(set, form, buffer)?;
    Ok(if more.is_empty() { wgsl } else { format!("{wgsl}\n{more}") })
}

/// The comment at the top: what this is, what it reads, what to bind.
fn header(set: &MaterialSet<'_>, form: Form, target: Target, is_constant: bool) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "// luthier {}, form {form}, {target}. Generated: bake again instead of editing.",
        env!("CARGO_PKG_VERSION")
    );
    let models: Vec<&str> = set.models().map(ShadingModel::title).collect();
    let _ = writeln!(out, "// Model{}: {}.", if models.len() == 1 { "" } else { "s" }, models.join("; "));
    let reads = |kind| set.tables_read(form).any(|table| table.kind == kind);
    out.push_str(match form {
        Form::Full => "// No tables: Fresnel equations at three wavelengths, closed forms of D.\n",
        Form::Baked if !reads(TableKind::Fresnel) => "",
        Form::Baked if reads(TableKind::Distribution) => {
            "// Fresnel reflectance and slope distribution are read from tables.\n"
        }
        Form::Baked => "// Fresnel reflectance is read from tables; closed forms of D.\n",
    });
    if set.models().any(|model| matches!(model, ShadingModel::Belcour | ShadingModel::Yamaguchi)) {
        out.push_str(match form {
            Form::Baked => {
                "// belcour, yamaguchi: energies and total reflection are read from tables, lobes are closed forms of GGX.\n"
            }
            Form::Full => {
                "// belcour, yamaguchi: facets count as level in energies, and no part of a lobe is totally reflected. Albedos of coated\n\
                 // metals are up to 0.3 too high.\n"
            }
        });
    }
    out.push_str(match target {
        Target::GlslEs300 => "// Needs `precision highp float;` and `precision highp int;` above.\n",
        Target::Hlsl => "// Shader model 5.1. Checked by glslang, not by a compiler of Direct3D.\n",
        Target::Msl => "// Metal 2.0. Not checked by a Metal compiler.\n",
        Target::Wgsl | Target::Glsl450 | Target::SpirV => "",
    });
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
    out.push_str(&binding_lines(set, form, target, is_constant));
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
        Mapping::Rational { bend } => format!(" bent by {bend}"),
        Mapping::Logarithmic => " logarithmic".to_owned(),
        Mapping::Periodic => " repeating".to_owned(),
    };
    format!("{} {}..{}{mapping}", axis.quantity, axis.min as f32, axis.max as f32)
}

//! The part of the comment at the top that says what to bind.

use std::fmt::Write as _;

use luthier_lut::MaterialTexture;

use crate::{Form, MaterialSet, Target, bindings};

/// Lines of the header comment that say what to bind and where, in the words of a language.
pub(crate) fn binding_lines(set: &MaterialSet<'_>, form: Form, target: Target, is_constant: bool) -> String {
    let mut out = String::from("//\n");
    out.push_str(match target {
        Target::Wgsl | Target::Glsl450 | Target::SpirV => "// Bindings, group 0:\n",
        Target::GlslEs300 => "// Bindings, by name:\n",
        Target::Hlsl => "// Registers, space0:\n",
        Target::Msl => {
            "// Bindings, by argument index of a complete shader. A function takes those that it reads, in this order, as its last\n// arguments:\n"
        },
    });
    let is_glsl = matches!(target, Target::Glsl450 | Target::GlslEs300);
    let words = set.words();
    for entry in bindings(set, form).iter().filter(|entry| !(is_constant && entry.resource == "buffer")) {
        let (number, name) = (entry.binding, &entry.name);
        if is_glsl && entry.resource == "sampler" {
            out.push_str("//   each table filtered linearly, clamped to its edge\n");
            continue;
        }
        let _ = match (entry.resource.as_str(), target) {
            ("buffer", Target::Wgsl | Target::SpirV) => {
                writeln!(out, "//   {number} {name}: storage buffer, {words} vec4")
            }
            ("buffer", Target::Glsl450) => {
                writeln!(out, "//   {number} {name}: storage block LuthierMaterials (std430), {words} vec4")
            }
            ("buffer", Target::GlslEs300) => {
                let MaterialTexture { width, height } = MaterialTexture::of(words);
                writeln!(out, "//   {name}: sampler2D, RGBA32F, {width} x {height}, not filtered")
            }
            ("buffer", Target::Hlsl) => writeln!(out, "//   t{number} {name}: ByteAddressBuffer, {words} float4"),
            ("buffer", Target::Msl) => {
                writeln!(out, "//   buffer({number}) {name}: device LuthierMaterials const&, {words} float4")
            }
            ("sampler", Target::Hlsl) => writeln!(out, "//   s{number} {name}: SamplerState, linear, clamp to edge"),
            ("sampler", Target::Msl) => writeln!(out, "//   sampler({number}) {name}: sampler, linear, clamp to edge"),
            ("sampler", _) => writeln!(out, "//   {number} {name}: sampler, linear, clamp to edge"),
            (_, Target::Wgsl | Target::SpirV) => writeln!(out, "//   {number} {name}: texture"),
            (_, Target::Glsl450) => writeln!(out, "//   {number} {name}: sampler2D"),
            (_, Target::GlslEs300) => writeln!(out, "//   {name}: sampler2D"),
            (_, Target::Hlsl) => writeln!(out, "//   t{number} {name}: Texture2D<float4>"),
            (_, Target::Msl) => writeln!(out, "//   texture({number}) {name}: texture2d<float>"),
        };
    }
    out
}

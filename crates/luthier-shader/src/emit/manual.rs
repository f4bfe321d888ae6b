//! The comment at the top of a text: a manual for readers without any other page.

use std::fmt::Write as _;

use luthier_lut::{Axis, Mapping, TableKind};
use luthier_manifest::{
    BindingEntry, DiffusePart, DiffuseTerm, InternalReflection, LobeHeight, LowerAlpha, LowerCosine, LowerFacets,
    LowerReflectance, Masking, MaterialEntry, MaterialTexture, Reflectance, ShadingModel,
};

use super::Part;
use crate::functions::FUNCTIONS;
use crate::identifiers::camel_case;
use crate::{Form, MaterialSet, RESERVED_BINDINGS, ShaderError, Target, bindings};

/// Longest line of the comment.
const WIDTH: usize = 140;
/// The most materials that are listed one by one. A longer list is cut to its first and its last.
const LISTED: usize = 6;

/// The manual of a text that was made from this WGSL.
pub(super) fn manual(
    set: &MaterialSet<'_>,
    form: Form,
    target: Target,
    part: Part,
    wgsl: &str,
) -> Result<String, ShaderError> {
    let version = env!("CARGO_PKG_VERSION");
    let title = format!("luthier {version}, form {form}, {target}. Generated: bake again instead of editing.");
    let sections = [
        std::iter::once(title).chain(note(target, part)).collect(),
        materials(set, part)?,
        models(set, form),
        functions(set, form, target, part, wgsl),
        resources(set, form, target, part),
    ];
    let mut out = String::new();
    for section in sections {
        out.push_str(if out.is_empty() { "" } else { "//\n" });
        section.iter().for_each(|text| comment(&mut out, text));
    }
    Ok(out)
}

/// Writes a text as lines of a comment. Entries of lists begin with two spaces, and their further lines with four.
fn comment(out: &mut String, text: &str) {
    let indent = if text.starts_with("  ") { "  " } else { "" };
    let mut line = format!("//{indent}");
    for word in text.trim_start().split(' ') {
        if line.len() + word.len() >= WIDTH {
            let _ = writeln!(out, "{line}");
            line = format!("//{indent}{indent}");
        }
        let _ = write!(line, " {word}");
    }
    let _ = writeln!(out, "{line}");
}

fn materials(set: &MaterialSet<'_>, part: Part) -> Result<Vec<String>, ShaderError> {
    let constants = set.constants()?;
    let mut texts = Vec::new();
    match (&*set.materials, constants.as_slice()) {
        ([first, .., last], [constant, ..]) if constants.len() > LISTED => {
            let (count, ends) = (constants.len(), [0, constants.len() - 1].map(|place| set.number(place)));
            let ([start, end], first, last) = (ends, &first.name, &last.name);
            texts.push(format!("Materials: {count}, from {start} ({first}) to {end} ({last})."));
            texts.push(format!("The number of each is a constant, as {constant} is."));
        }
        (materials, constants) => {
            texts.push("Materials, each a number and a constant:".to_owned());
            texts.extend(constants.iter().zip(materials).enumerate().map(|(place, (constant, material))| {
                let i = set.number(place);
                let (model, layers) = (material.model.name(), counted(material.layers.len() as u32, "layer"));
                format!("  {i} {}, {constant}: {model}, {layers}", material.name)
            }));
        }
    }
    if set.within.is_some() {
        texts.push(
            "The buffer has others, whose models have no such form: no function here is for their numbers.".to_owned(),
        );
    }
    if part == Part::Constant {
        texts.push("What the material is made of is in the code. Functions do not look at its number.".to_owned());
    }
    Ok(texts)
}

fn models(set: &MaterialSet<'_>, form: Form) -> Vec<String> {
    let titles: Vec<&str> = set.models().map(ShadingModel::title).collect();
    let plural = if titles.len() == 1 { "" } else { "s" };
    let mut texts = vec![format!("Model{plural}: {}.", titles.join("; "))];
    let read: Vec<TableKind> = set.tables_read(form).map(|table| table.kind).collect();
    let terms = match form {
        Form::Full => "No tables: Fresnel equations at three wavelengths, closed forms of D.",
        Form::Baked if !read.contains(&TableKind::Fresnel) => "",
        Form::Baked if read.contains(&TableKind::Distribution) => {
            "Fresnel reflectance and slope distribution are read from tables."
        }
        Form::Baked => "Fresnel reflectance is read from tables; closed forms of D.",
    };
    let statistics = match form {
        _ if !set.models().any(ShadingModel::is_statistical) => "",
        Form::Baked => {
            "belcour, yamaguchi: energies and total reflection are read from tables, lobes are closed forms of GGX."
        }
        Form::Full => {
            "belcour, yamaguchi: facets count as level in energies, and no part of a lobe is totally reflected. Albedos of coated \
             metals are up to 0.3 too high."
        }
    };
    texts.extend([terms, statistics].iter().filter(|text| !text.is_empty()).map(|text| (*text).to_owned()));
    texts.extend(parts(set));
    texts
}

/// Lines for parts that materials choose in place of the defaults: one for each part, with the first of its materials.
fn parts(set: &MaterialSet<'_>) -> Vec<String> {
    let mut texts = Vec::new();
    for masking in Masking::ALL.into_iter().filter(|masking| *masking != Masking::default()) {
        texts.extend(part(set, "Masking", masking.title(), |m| m.parts().0 == masking));
    }
    for reflectance in Reflectance::ALL.into_iter().filter(|reflectance| *reflectance != Reflectance::default()) {
        texts.extend(part(set, "Reflectance", reflectance.title(), |m| m.parts().1 == reflectance));
    }
    for internal in InternalReflection::ALL.into_iter().filter(|internal| *internal != InternalReflection::default()) {
        texts.extend(part(set, "Internal reflection", internal.title(), |m| m.internal_reflection() == internal));
    }
    let in_air = LowerReflectance::InAir;
    texts.extend(part(set, "Reflectance of lower interfaces", in_air.title(), |m| m.lower_reflectance() == in_air));
    let inside = LowerCosine::Inside;
    texts.extend(part(set, "Light on lower interfaces", inside.title(), |m| m.lower_cosine() == inside));
    for facets in LowerFacets::ALL.into_iter().skip(1) {
        texts.extend(part(set, "Reflection of lower interfaces", facets.title(), |m| m.lower_facets() == facets));
    }
    let rougher = LowerAlpha::AtLeastAbove;
    texts.extend(part(set, "Slope parameters of lower interfaces", rougher.title(), |m| m.lower_alpha() == rougher));
    let beside = DiffusePart::Beside;
    texts.extend(part(set, "Diffuse base", beside.title(), |m| m.diffuse_part() == beside));
    let own = "its own, in words 1 and 2 of its header";
    texts.extend(part(set, "Exponents, weights and inner boundary", own, |m| m.constants.beams.is_some()));
    let added = DiffuseTerm::Added;
    texts.extend(part(set, "Diffuse term", added.title(), |m| m.constants.diffuse_term == added));
    let one = LobeHeight::One;
    let has_one = |m: &MaterialEntry| m.constants.beams.is_some_and(|beams| beams.lobe_height == one);
    texts.extend(part(set, "Lobes", one.title(), has_one));
    texts
}

/// The line of a part, if a material chooses it.
fn part(set: &MaterialSet<'_>, part: &str, title: &str, is_chosen: impl Fn(&MaterialEntry) -> bool) -> Option<String> {
    let mut chosen = set.materials.iter().filter(|material| is_chosen(material));
    let first = &chosen.next()?.name;
    let more = match chosen.count() {
        0 => String::new(),
        others => format!(" and {others} more"),
    };
    Some(format!("{part} of {first}{more}: {title}."))
}

fn functions(set: &MaterialSet<'_>, form: Form, target: Target, part: Part, wgsl: &str) -> Vec<String> {
    let there = FUNCTIONS
        .iter()
        .filter(|(call, _)| call.split('(').next().is_some_and(|name| wgsl.contains(&format!("fn {name}("))));
    let mut texts = vec!["Functions:".to_owned()];
    texts.extend(there.map(|(call, gives)| format!("  {call}: {gives}")));
    let tables: Vec<&str> = set.tables_read(form).map(|table| table.kind.name()).collect();
    if !tables.is_empty() {
        texts.push(format!("  luthier_lookup_T(tile, ...): a value of the table T, which is {}", tables.join(", ")));
    }
    if part == Part::Complete {
        let name = if target == Target::Msl { "main_" } else { "main" };
        texts.push(format!(
            "  {name}: a fragment shader, whose output is luthier_bounded of luthier_eval, with alpha 1"
        ));
        texts.push("Inputs 0 and 1 are wi and wo. Input 2 is the number of the material, not interpolated.".to_owned());
    }
    texts.push(
        "wi points to the light and wo to the eye. Both are unit vectors in the local frame of the surface, away from it. +z is the \
         normal, +x the tangent. Values are 0 where either is not above the horizon."
            .to_owned(),
    );
    texts
}

/// Each binding with its number, name, kind, format and filter, and instructions to fill them.
fn resources(set: &MaterialSet<'_>, form: Form, target: Target, part: Part) -> Vec<String> {
    let has_buffer = part != Part::Constant;
    let is_numbered = target != Target::GlslEs300;
    let mut entries = bindings(set, form);
    entries.retain(|entry| match entry.resource.as_str() {
        "buffer" => has_buffer,
        // In GLSL a texture and its sampler are one.
        "sampler" => !matches!(target, Target::Glsl450 | Target::GlslEs300),
        _ => true,
    });
    if entries.is_empty() {
        return vec!["Bindings: none.".to_owned()];
    }
    // Arguments of functions in MSL come in the order of the declarations.
    if target != Target::Msl {
        entries.sort_by_key(|entry| entry.binding);
    }
    let heading = match target {
        Target::Wgsl | Target::Glsl450 | Target::SpirV => &format!("Bindings, group {}:", set.names.group),
        Target::GlslEs300 => "Bindings, by name:",
        Target::Hlsl => &format!("Registers, space{}:", set.names.group),
        Target::Msl => "Bindings, by argument index of a complete shader:",
    };
    let mut texts = vec![heading.to_owned()];
    texts.extend(entries.iter().map(|entry| format!("  {}", resource(set, form, target, entry))));
    let mut how = Vec::new();
    if target == Target::Msl {
        how.push("A function takes those that it reads as its last arguments, in this order.".to_owned());
    }
    if has_buffer {
        how.push("luthier_materials is materials.bin of the bake, byte for byte.".to_owned());
    }
    if set.tables_read(form).any(|table| table.format.has_steps()) && target != Target::GlslEs300 {
        how.push("A buffer of texels has those of the KTX2 file of its name, row by row.".to_owned());
    }
    if set.tables_read(form).any(|table| !table.format.has_steps() || target == Target::GlslEs300) {
        how.push(
            "Textures are the KTX2 files of the bake: one level, linear values, the first row at coordinate 0."
                .to_owned(),
        );
        how.push("Filters clamp to the edge.".to_owned());
    }
    if set.shows_environment(form) {
        how.push(
            "The two cubes are KTX2 files of `luthier environment`; their sampler is linear between levels, too."
                .to_owned(),
        );
    }
    how.push(match is_numbered {
        true => match set.names.first_binding {
            0 => format!("Numbers from {RESERVED_BINDINGS} up are yours."),
            first => format!("Numbers below {first} and from {} up are yours.", first + RESERVED_BINDINGS),
        },
        false => "Set each sampler2D to a texture unit.".to_owned(),
    });
    texts.push(how.join(" "));
    texts
}

/// A binding in the words of a language.
fn resource(set: &MaterialSet<'_>, form: Form, target: Target, entry: &BindingEntry) -> String {
    let BindingEntry { binding, name, resource } = entry;
    let words = set.words();
    let kind = match (resource.as_str(), target) {
        ("buffer", Target::Wgsl | Target::SpirV) => format!("storage buffer, {words} vec4"),
        ("buffer", Target::Glsl450) => format!("storage block LuthierMaterials (std430), {words} vec4"),
        ("buffer", Target::GlslEs300) => {
            let MaterialTexture { width, height } = MaterialTexture::of(words);
            format!("sampler2D, RGBA32F, {width} x {height}, not filtered")
        }
        ("buffer", Target::Hlsl) => format!("ByteAddressBuffer (a raw view), {words} float4"),
        ("buffer", Target::Msl) => format!("device LuthierMaterials const&, {words} float4"),
        (BindingEntry::STEPS, Target::Wgsl | Target::SpirV) => "storage buffer of vec4<u32>".to_owned(),
        (BindingEntry::STEPS, Target::Glsl450) => format!("storage block {} (std430) of uvec4", camel_case(name)),
        (BindingEntry::STEPS, Target::GlslEs300) => "usampler2D, RGBA32UI".to_owned(),
        (BindingEntry::STEPS, Target::Hlsl) => "ByteAddressBuffer (a raw view) of uint4".to_owned(),
        (BindingEntry::STEPS, Target::Msl) => format!("device {} const& of uint4", camel_case(name)),
        ("sampler", Target::Hlsl) => "SamplerState, linear, clamp to edge".to_owned(),
        ("sampler", _) => "sampler, linear, clamp to edge".to_owned(),
        ("texture_cube<f32>", Target::Glsl450 | Target::GlslEs300) => "samplerCube".to_owned(),
        ("texture_cube<f32>", Target::Hlsl) => "TextureCube<float4>".to_owned(),
        ("texture_cube<f32>", Target::Msl) => "texturecube<float>".to_owned(),
        (kind, Target::Wgsl | Target::SpirV) => kind.to_owned(),
        (_, Target::Glsl450 | Target::GlslEs300) => "sampler2D".to_owned(),
        (_, Target::Hlsl) => "Texture2D<float4>".to_owned(),
        (_, Target::Msl) => "texture2d<float>".to_owned(),
    };
    let place = match (target, resource.as_str()) {
        (Target::GlslEs300, _) => String::new(),
        (Target::Hlsl, "sampler") => format!("s{binding} "),
        (Target::Hlsl, _) => format!("t{binding} "),
        (Target::Msl, "sampler") => format!("sampler({binding}) "),
        (Target::Msl, _) if entry.is_buffer() => format!("buffer({binding}) "),
        (Target::Msl, _) => format!("texture({binding}) "),
        _ => format!("{binding} "),
    };
    let mut text = format!("{place}{name}: {kind}");
    for table in set.tables_read(form).filter(|table| format!("luthier_{}", table.kind.name()) == *name) {
        let ([width, height], [across, down]) = (table.layout.size(), table.layout.tile_size());
        let filter = if table.format.is_filterable() { "filtered" } else { "not filtered" };
        let axes: Vec<String> = std::iter::once(&table.layout.x).chain(&table.layout.y).map(axis).collect();
        let (format, tiles, axes) = (table.format, counted(table.layout.tiles, "tile"), axes.join(", "));
        let _ = write!(text, ", {format}, {width} x {height}, {filter}; {tiles} of {across} x {down}: {axes}");
    }
    text
}

/// Requirements of a language, and checks that its texts lack; `None` if there are none of both.
fn note(target: Target, part: Part) -> Option<String> {
    let note = match target {
        Target::GlslEs300 if part != Part::Complete => {
            "Needs `precision highp float;` and `precision highp int;` above."
        }
        Target::Hlsl => "Shader model 5.1. Checked by glslang, not by a compiler of Direct3D.",
        Target::Msl => "Metal 2.0. Not checked by a Metal compiler.",
        _ => return None,
    };
    Some(note.to_owned())
}

/// `1 layer`, `2 layers`.
fn counted(count: u32, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// `cos_theta 0..1 as u^2`.
fn axis(axis: &Axis) -> String {
    let mapping = match axis.mapping {
        Mapping::Linear => String::new(),
        Mapping::Power { exponent } => format!(" as u^{exponent}"),
        Mapping::Rational { bend } => format!(" bent by {bend}"),
        Mapping::Logarithmic => " logarithmic".to_owned(),
        Mapping::Periodic => " repeating".to_owned(),
        Mapping::Apart => " side by side".to_owned(),
    };
    format!("{} {}..{}{mapping}", axis.quantity, axis.min as f32, axis.max as f32)
}

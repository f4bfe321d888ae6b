//! Composition: the modules that a set needs, one function per model in use, and `luthier_eval` that chooses among them.

mod blocks;
mod chain;
mod face;
mod feature;
mod features;
mod lookup;
mod masking;
mod members;
mod pick;
mod reached;
mod shown;
mod slopes;
mod stacks;
mod statistics;
mod words;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use luthier_layers::models::path;
use luthier_layers::models::room;
use luthier_layers::models::room::Kernels;
use luthier_lut::TableKind;
use luthier_manifest::{BindingEntry, MapSlot, MaterialEntry, MaterialTexture, SIDE, ShadingModel, material_buffer};
use luthier_model::Family;

use self::blocks::prune;
use self::feature::Feature;
use self::features::Features;
pub(crate) use self::lookup::calls;
use self::lookup::lookup;
use self::reached::reached;
use self::words::numbered;
use crate::{Form, MaterialSet, ShaderError, TableFace, bindings};

/// Place of the material buffer in a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Buffer {
    /// Storage, of any length.
    Storage,
    /// Storage with the length of the set, for a language that has to state it.
    Sized,
    /// A texture of whole words, for a language without storage.
    Texture,
    /// No buffer: the numbers of one material are constants.
    Constant,
}

/// WGSL of a set, without the header comment.
pub(crate) fn compose(set: &MaterialSet<'_>, form: Form, buffer: Buffer) -> Result<String, ShaderError> {
    set.check(form)?;
    let features = Features::of(set, form);
    let mut parts = vec![constants(set)?, declarations(set, form, buffer)];
    parts.extend([include_str!("../wgsl/pi.wgsl"), include_str!("../wgsl/interface/choose.wgsl")].map(str::to_owned));
    for table in set.tables_read(form) {
        parts.push(lookup(table, &features)?);
    }
    // Models of statistics need no closed form of D: their lobes have slope parameters of their own, not those of the layers.
    let facets = features.has(Feature::Chain) || features.has(Feature::Smith) || features.has(Feature::Coat);
    let masking = masking::module(set, &features);
    let place = place(set, form);
    // `reached` removes functions without a call. A condition here is for a module with public functions, and for one that shares names with another.
    let modules = [
        (true, include_str!("../wgsl/tables/bilinear.wgsl")),
        (true, include_str!("../wgsl/tables/stepped.wgsl")),
        (true, include_str!("../wgsl/layer.wgsl")),
        (features.has(Feature::Place), place.as_str()),
        (true, include_str!("../wgsl/surface/local.wgsl")),
        (true, include_str!("../wgsl/surface/hash.wgsl")),
        (features.has(Feature::Flakes), include_str!("../wgsl/surface/flakes.wgsl")),
        (features.has(Feature::Patina), include_str!("../wgsl/surface/patina.wgsl")),
        (features.has(Feature::Weight), include_str!("../wgsl/surface/cover.wgsl")),
        (true, include_str!("../wgsl/surface/glitter.wgsl")),
        (true, include_str!("../wgsl/surface/perlin.wgsl")),
        (true, include_str!("../wgsl/surface/pick.wgsl")),
        (true, include_str!("../wgsl/interface/power_lobe.wgsl")),
        (features.has(Feature::OrenNayar), include_str!("../wgsl/base/oren_nayar.wgsl")),
        (!features.has(Feature::OrenNayar), include_str!("../wgsl/base/lambert.wgsl")),
        (true, include_str!("../wgsl/base/reradiated.wgsl")),
        (true, include_str!("../wgsl/interface/complex.wgsl")),
        (features.has(Feature::Computed), include_str!("../wgsl/interface/fresnel.wgsl")),
        (features.has(Feature::Computed), include_str!("../wgsl/interface/film.wgsl")),
        (true, include_str!("../wgsl/interface/schlick.wgsl")),
        (true, include_str!("../wgsl/interface/beckmann.wgsl")),
        (true, include_str!("../wgsl/interface/ggx.wgsl")),
        (true, include_str!("../wgsl/interface/log_one_plus.wgsl")),
        (true, include_str!("../wgsl/interface/blinn.wgsl")),
        (true, include_str!("../wgsl/interface/abc.wgsl")),
        (true, include_str!("../wgsl/interface/sgd.wgsl")),
        (features.has(Feature::Computed), include_str!("../wgsl/interface/full_terms.wgsl")),
        (features.has(Feature::Closed) && facets, include_str!("../wgsl/interface/closed_terms.wgsl")),
        (!features.has(Feature::Full), include_str!("../wgsl/interface/baked_terms.wgsl")),
        (true, include_str!("../wgsl/interface/chosen_reflectance.wgsl")),
        (is_textured(&features), include_str!("../wgsl/interface/textured_reflectance.wgsl")),
        (true, include_str!("../wgsl/interface/slopes.wgsl")),
        (true, masking.as_str()),
        (true, include_str!("../wgsl/interface/smith.wgsl")),
        (features.has(Feature::Chain), path::EVAL),
        (features.has(Feature::Statistics), luthier_layers::models::statistics::SPREAD),
    ];
    parts.extend(modules.iter().filter(|(used, _)| *used).map(|(_, module)| text(module, &features)));
    for model in set.models() {
        parts.extend(self::model(set, model, &features));
    }
    parts.extend(face::modules(set, &features));
    parts.extend(pick::pick(set));
    parts.push(eval(set, &features));
    parts.push(include_str!("../wgsl/bounded.wgsl").to_owned());
    parts.retain(|part| !part.trim().is_empty());
    // Programs around a shader read these members of a layer, whether its own functions do or not.
    let kept: &[&str] = if features.has(Feature::Interface) { &["kind", "alpha"] } else { &["kind"] };
    let wgsl = parts.join("\n").replace("$base_layer", &base_layer(set));
    let wgsl = match buffer {
        Buffer::Constant => wgsl.replace("    return material * LUTHIER_MATERIAL_WORDS;\n", "    return 0u;\n"),
        Buffer::Texture => read_from_texture(set, form, &wgsl),
        Buffer::Storage | Buffer::Sized => wgsl,
    };
    Ok(reached(&wgsl, kept))
}

/// The number of the layer that is the base of families: a constant where all have the same.
fn base_layer(set: &MaterialSet<'_>) -> String {
    let sides: Vec<MaterialEntry> = set.materials.iter().filter_map(MaterialEntry::side).collect();
    let materials = set.materials.iter().chain(&sides).filter(|material| material.model.is_fitted());
    let numbers: BTreeSet<u32> =
        materials.filter_map(|material| Some(material.constants.lobes?.family()?.interface)).collect();
    match numbers.first().filter(|_| numbers.len() == 1) {
        Some(number) => format!("{number}u"),
        None => "u32(tilt_word.z)".to_owned(),
    }
}

/// The module of places, with the number of layers that have values of their own.
fn place(set: &MaterialSet<'_>, form: Form) -> String {
    let shown = set.materials.iter().flat_map(|material| material.shown_layer_maps(form));
    let shown = shown.filter(|(layer, slot)| slot.is_of_layer_place(*layer));
    let count = shown.map(|(layer, _)| layer + 1).max().unwrap_or(0);
    let framed = set.materials.iter().filter(|material| has_level_layers(material, form));
    let count = framed.map(|material| material.layers.len() as u32).fold(count, u32::max);
    let each: String = (0..count).map(|i| format!("    place.layers[{i}] = luthier_layer_place();\n")).collect();
    let each_on_first: String = (1..count)
        .map(|i| {
            format!("    next.layers[{i}].normal = luthier_local(next.normal, luthier_local(back, place.layers[{i}].normal));\n")
        })
        .collect();
    let module = include_str!("../wgsl/surface/place.wgsl").replace("    $each_layer\n", &each);
    let module = module.replace("    $each_on_first\n", &each_on_first);
    let each_on_surface: String = (0..count)
        .map(|i| format!("        next.layers[{i}].normal = luthier_local(back, place.layers[{i}].normal);\n"))
        .collect();
    let module = module.replace("        $each_on_surface\n", &each_on_surface);
    let each_below_coat: String = (0..count)
        .map(|i| match i + 1 {
            below if below < count => format!("    next.layers[{i}] = place.layers[{below}];\n"),
            _ => format!("    next.layers[{i}] = luthier_layer_place();\n"),
        })
        .collect();
    let module = module.replace("    $each_below_coat\n", &each_below_coat);
    module.replace("$layers", &format!("{count}u"))
}

/// Whether layers of a material that no map turns still have places: they lean against a first one that a map turns, or against either side of a weight.
fn has_level_layers(material: &MaterialEntry, form: Form) -> bool {
    let mut maps = material.shown_layer_maps(form).filter(|_| material.model.is_fitted());
    maps.any(|(layer, slot)| slot == MapSlot::Bumps && (layer == 0 || material.side().is_some()))
}

/// The lines of a module that a set keeps, with these words replaced:
///
/// - If a material of the set varies over its surface, `$place_parameter` declares a `LuthierPlace`, `$place_argument` passes it on, and
///   `$layer(` reads a layer at that place. Otherwise the first two vanish, and `$layer(` reads the record.
/// - `$diffuse(` is the BRDF of a base. Directions are arguments only if a base is rough.
/// - `$free_slopes` returns D of the distributions of the set.
/// - `$tiles` declares the members of a layer that point into tables, and `$assign_tiles` reads them.
/// - `$distribution_read` is pi alpha^2 D from the table. It is named as the term itself unless some layer has D computed.
pub(crate) fn text(module: &str, features: &Features) -> String {
    let [parameter, argument, layer] = if features.has(Feature::Place) {
        ["place: LuthierPlace, ", "place, ", "luthier_layer_at(place, "]
    } else {
        ["", "", "luthier_layer("]
    };
    let text = module.replace("    $tiles\n", &tiles()).replace("    $assign_tiles\n", &assign_tiles());
    let text = prune(&text, features).replace("    $free_slopes\n", &slopes::returned(features));
    let text =
        text.replace("$place_parameter ", parameter).replace("$place_argument ", argument).replace("$layer(", layer);
    let term = if features.has(Feature::Closed) { "luthier_distribution_read" } else { "luthier_distribution_term" };
    let text = reflectances(&numbered(&text).replace("$distribution_read", term), features);
    if features.has(Feature::OrenNayar) {
        return text.replace("$diffuse(", "luthier_diffuse(");
    }
    let mut parts = text.split("$diffuse(layer");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.filter_map(|part| part.split_once(')')).fold(first, |out, (_, after)| out + "luthier_diffuse(layer)" + after)
}

/// Whether reflectances of layers are those of a place: maps give it another F0, or a film another thickness over an F0.
fn is_textured(features: &Features) -> bool {
    features.has(Feature::OwnF0) || features.has(Feature::FilmF0)
}

/// The text with names for the functions that give the reflectance of a layer. A single one is `luthier_fresnel_term` itself; several get names of
/// their own, and `luthier_fresnel_term` chooses among them.
fn reflectances(text: &str, features: &Features) -> String {
    let is_one = !features.has(Feature::SeveralReflectances);
    // Look-ups of tables have the short names of these functions.
    let text = match features.has(Feature::Computed) && !features.has(Feature::Full) {
        true => {
            text.replace("luthier_fresnel(", "luthier_fresnel_exact(").replace("luthier_film(", "luthier_film_exact(")
        }
        false => text.to_owned(),
    };
    let chosen = if is_textured(features) { "luthier_fresnel_given" } else { "luthier_fresnel_term" };
    let text = text.replace("$fresnel_chosen", chosen);
    ["read", "computed", "fitted"].iter().fold(text, |text, how| {
        let name = match (is_one, is_textured(features)) {
            (true, false) => "luthier_fresnel_term".to_owned(),
            (true, true) => "luthier_fresnel_given".to_owned(),
            (false, _) => format!("luthier_fresnel_{how}"),
        };
        text.replace(&format!("$fresnel_{how}"), &name)
    })
}

/// The members of a layer that point into tables.
fn tiles() -> String {
    let names = TableKind::ALL.into_iter().filter(|kind| kind.facts().slot.is_some()).map(TableKind::name);
    names.map(|name| format!("    /// Tile in `luthier_{name}`.\n    {name}_tile: f32,\n")).collect()
}

/// Statements that read all tiles of a layer from its words in the buffer. `reached` removes those of members that are left out.
fn assign_tiles() -> String {
    let assignments = TableKind::ALL.into_iter().filter_map(|kind| {
        let [word, component] = kind.facts().slot?;
        let read = words::layer(word);
        Some(format!("    layer.{}_tile = {read}.{};\n", kind.name(), ["x", "y", "z", "w"][component]))
    });
    assignments.collect()
}

/// The modules of a model: the kernels of its room, or, for families whose function depends on the stacks, steps and a function of these steps.
fn model(set: &MaterialSet<'_>, model: ShadingModel, features: &Features) -> Vec<String> {
    let Kernels { eval, environment, .. } = room(model).kernels;
    let mut modules = match model.facts().family {
        Family::Path => chain::modules(set, model, features),
        Family::Statistics => statistics::modules(set, model, features),
        Family::Beams | Family::Coefficients | Family::Facets | Family::Lobes => vec![text(eval, features)],
    };
    if features.has(Feature::Environment) {
        modules.push(text(&shown::directions(environment, set.functions.environment_reads()), features));
    }
    modules
}

/// Constants with the numbers of materials and surfaces.
fn constants(set: &MaterialSet<'_>) -> Result<String, ShaderError> {
    let mut out = String::new();
    for (place, constant) in set.constants()?.iter().enumerate() {
        let _ = writeln!(out, "const {constant}: u32 = {}u;", set.number(place));
    }
    for (i, constant) in set.surface_constants()?.iter().enumerate() {
        let _ = writeln!(out, "const {constant}: u32 = {i}u;");
    }
    Ok(out)
}

fn declarations(set: &MaterialSet<'_>, form: Form, buffer: Buffer) -> String {
    let mut out = String::new();
    for entry in bindings(set, form) {
        let (space, resource) = match (entry.resource.as_str(), buffer) {
            ("buffer", Buffer::Storage) => ("<storage, read>", "array<vec4<f32>>".to_owned()),
            ("buffer", Buffer::Constant) => {
                out.push_str(&numbers(set));
                continue;
            }
            ("buffer", Buffer::Sized) => ("<storage, read>", format!("array<vec4<f32>, {}>", set.words())),
            ("buffer", Buffer::Texture) => ("", "texture_2d<f32>".to_owned()),
            (BindingEntry::STEPS, Buffer::Storage | Buffer::Constant) => {
                ("<storage, read>", "array<vec4<u32>>".to_owned())
            }
            (BindingEntry::STEPS, Buffer::Sized) => {
                ("<storage, read>", format!("array<vec4<u32>, {}>", texels(set, &entry.name)))
            }
            (BindingEntry::STEPS, Buffer::Texture) => ("", "texture_2d<u32>".to_owned()),
            _ => ("", entry.resource),
        };
        let (group, binding) = (set.names.group, entry.binding);
        let _ = writeln!(out, "@group({group}) @binding({binding}) var{space} {}: {resource};", entry.name);
    }
    if buffer == Buffer::Texture {
        out.push_str(&word(set));
        set.tables_read(form).filter(|table| table.format.has_steps()).for_each(|table| out.push_str(&texel(table)));
    }
    out
}

/// Texels of the table of a binding.
fn texels(set: &MaterialSet<'_>, name: &str) -> u32 {
    let table = set.tables.iter().find(|table| format!("luthier_{}", table.kind.name()) == name);
    table.map_or(0, |table| table.layout.size().iter().product())
}

/// The function that reads a texel with steps in a texture.
fn texel(table: &TableFace) -> String {
    let (name, [width, height]) = (table.kind.name(), table.layout.size());
    let place = match height {
        1 => "i32(index), 0".to_owned(),
        _ => format!("i32(index % {width}u), i32(index / {width}u)"),
    };
    format!(
        "\n/// A texel of the table, which is a texture.\nfn luthier_{name}_texel(index: u32) -> vec4<u32> {{\n    \
         return textureLoad(luthier_{name}, vec2<i32>({place}), 0);\n}}\n"
    )
}

/// The function that reads a word of a material buffer in a texture.
fn word(set: &MaterialSet<'_>) -> String {
    let texel = match MaterialTexture::of(set.words()).height {
        1 => "i32(index), 0".to_owned(),
        _ => format!("i32(index & {}u), i32(index >> {}u)", SIDE - 1, SIDE.ilog2()),
    };
    format!(
        "\n/// A word of the material buffer, which is a texture.\nfn luthier_word(index: u32) -> vec4<f32> {{\n    \
         return textureLoad(luthier_materials, vec2<i32>({texel}), 0);\n}}\n"
    )
}

/// The text with calls of [`word`] in place of indices into the material buffer, and of [`texel`] in place of those into tables with steps.
fn read_from_texture(set: &MaterialSet<'_>, form: Form, wgsl: &str) -> String {
    let stepped = set.tables_read(form).filter(|table| table.format.has_steps()).map(|table| table.kind.name());
    stepped.fold(called(wgsl, "luthier_materials[", "luthier_word"), |text, name| {
        called(&text, &format!("luthier_{name}["), &format!("luthier_{name}_texel"))
    })
}

/// The text with calls of a function in place of indices into a buffer, which begin with an opening.
fn called(wgsl: &str, opening: &str, function: &str) -> String {
    let mut out = String::with_capacity(wgsl.len());
    let mut rest = wgsl;
    // No index contains another, so the next bracket closes it.
    while let Some((before, (index, after))) =
        rest.split_once(opening).and_then(|(before, rest)| Some((before, rest.split_once(']')?)))
    {
        out.push_str(&format!("{before}{function}({index})"));
        rest = after;
    }
    out + rest
}

/// The words of the material buffer as a constant.
fn numbers(set: &MaterialSet<'_>) -> String {
    let words = material_buffer(&set.materials);
    let mut out = format!("const luthier_materials = array<vec4<f32>, {}>(\n", words.len());
    for [x, y, z, w] in words {
        let _ = writeln!(out, "    vec4<f32>({x:?}, {y:?}, {z:?}, {w:?}),");
    }
    out.push_str(");\n");
    out
}

/// The functions that choose the model of a material: `luthier_eval`, and `luthier_eval_at` if a surface varies.
fn eval(set: &MaterialSet<'_>, features: &Features) -> String {
    const SUMMARY: &str = "/// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away\n\
         /// from the surface. Zero when either is not above the horizon. See `luthier_bounded` for the range.\n";
    let guard = "    if min(wi.z, wo.z) <= 0.0 {\n        return vec3<f32>(0.0);\n    }\n";
    let mut body = String::from(guard);
    let turned = features.has(Feature::Place);
    let (here, on_first) = on_first(set, features);
    body.push_str(&on_first);
    if turned {
        let _ = writeln!(body, "    let wi_here = luthier_local({here}.normal, wi);");
        let _ = writeln!(body, "    let wo_here = luthier_local({here}.normal, wo);");
        body.push_str(&guard.replace("wi.z", "wi_here.z").replace("wo.z", "wo_here.z"));
    }
    let at_place = format!("{here}, material, wi_here, wo_here");
    let arguments = if turned { at_place.as_str() } else { "material, wi, wo" };
    let (first, others) = by_model(set, "model", |model| {
        let name = function(model);
        match (features.has(Feature::Fluorescent), model.is_path()) {
            (false, _) => format!("{name}({arguments})"),
            (true, true) => format!("{name}_lit({arguments}, light)"),
            (true, false) => format!("light * {name}({arguments})"),
        }
    });
    if !others.is_empty() {
        body.push_str("    let model = luthier_whole(luthier_materials[luthier_header(material)].z);\n");
    }
    let _ = writeln!(body, "{others}    return {first};");
    let parameters = "material: u32, wi: vec3<f32>, wo: vec3<f32>";
    if features.has(Feature::Fluorescent) {
        return lit(&body, turned, parameters, SUMMARY);
    }
    if turned {
        format!(
            "{SUMMARY}fn luthier_eval_at(place: LuthierPlace, {parameters}) -> vec3<f32> {{\n{body}}}\n\n\
             /// f cos_theta_i of a material, RGB, at a place without textures: `luthier_eval_at` there.\n\
             fn luthier_eval({parameters}) -> vec3<f32> {{\n    return luthier_eval_at(luthier_place(), material, wi, wo);\n}}\n"
        )
    } else {
        format!("{SUMMARY}fn luthier_eval({parameters}) -> vec3<f32> {{\n{body}}}\n")
    }
}

/// The name of the place in functions of the face, and statements that make it: materials of `lobes` have the frame of their first interface's own normal.
fn on_first(set: &MaterialSet<'_>, features: &Features) -> (&'static str, String) {
    if !features.has(Feature::LobesBumps) {
        return ("place", String::new());
    }
    let next = match features.has(Feature::LobesSideFrames) {
        true => "luthier_place_of_lobes(place, material)",
        false => "luthier_place_on_first(place)",
    };
    let model = set.models().find(|model| model.is_fitted());
    let statements = match model.filter(|_| set.models().count() > 1) {
        None => format!("    let here = {next};\n"),
        Some(model) => format!(
            "    var here = place;\n    if luthier_whole(luthier_materials[luthier_header(material)].z) == {}u {{\n        \
             here = {next};\n    }}\n",
            model.number()
        ),
    };
    ("here", statements)
}

/// [`eval`] for a set with a fluorescent base. Functions take the light, because reflected light is not the product of a factor and the light.
fn lit(body: &str, turned: bool, parameters: &str, summary: &str) -> String {
    const SUMMARY: &str = "/// Light that a material sends from wi to wo, RGB: `luthier_eval` for light of a colour, of which a fluorescent base\n\
         /// sends some out in other channels. Linear in the light; `luthier_eval` is that of white light, (1, 1, 1), D65.\n";
    if turned {
        format!(
            "{SUMMARY}fn luthier_eval_lit_at(place: LuthierPlace, {parameters}, light: vec3<f32>) -> vec3<f32> {{\n{body}}}\n\n\
             /// `luthier_eval_lit_at` at a place without textures.\n\
             fn luthier_eval_lit({parameters}, light: vec3<f32>) -> vec3<f32> {{\n    \
             return luthier_eval_lit_at(luthier_place(), material, wi, wo, light);\n}}\n\n\
             {summary}fn luthier_eval_at(place: LuthierPlace, {parameters}) -> vec3<f32> {{\n    \
             return luthier_eval_lit_at(place, material, wi, wo, vec3<f32>(1.0));\n}}\n\n\
             /// f cos_theta_i of a material, RGB, at a place without textures: `luthier_eval_at` there.\n\
             fn luthier_eval({parameters}) -> vec3<f32> {{\n    return luthier_eval_at(luthier_place(), material, wi, wo);\n}}\n"
        )
    } else {
        format!(
            "{SUMMARY}fn luthier_eval_lit({parameters}, light: vec3<f32>) -> vec3<f32> {{\n{body}}}\n\n\
             {summary}fn luthier_eval({parameters}) -> vec3<f32> {{\n    \
             return luthier_eval_lit(material, wi, wo, vec3<f32>(1.0));\n}}\n"
        )
    }
}

/// The function of a model.
pub(crate) fn function(model: ShadingModel) -> String {
    format!("luthier_eval_{}", model.name().replace('-', "_"))
}

/// The call for the first model of a set, and statements that return the calls for the others where `number` is theirs.
fn by_model(set: &MaterialSet<'_>, number: &str, call: impl Fn(ShadingModel) -> String) -> (String, String) {
    let mut models = set.models();
    let first = models.next().map(&call).unwrap_or_default();
    (first, models.map(|other| case(number, &format!("{}u", other.number()), &call(other))).collect())
}

/// A statement that returns a call where a number has a value.
fn case(number: &str, value: &str, call: &str) -> String {
    format!("    if {number} == {value} {{\n        return {call};\n    }}\n")
}

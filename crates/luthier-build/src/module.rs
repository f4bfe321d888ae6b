//! The text of the module that a program includes.

use std::fmt::Write as _;

use luthier::{Error, Manifest, Target};
use luthier_shader::{identifier, surface_identifier};

/// Constants of a program that embeds a package. Files are found relative to the module, in the folder `folder`.
pub(crate) fn text(manifest: &Manifest, folder: &str) -> Result<String, Error> {
    let mut text = format!("// Written by luthier-build for {}: each build writes it anew.\n", manifest.generator);
    let mut files = vec!["manifest.json"];
    let include = |word: &str, path: &str| format!("include_{word}!({:?})", format!("{folder}/{path}"));
    item(&mut text, "The manifest: all files and records of the bake.", "MANIFEST", "&str", &include("str", files[0]));
    let buffer = manifest.material_buffer.path.as_str();
    files.push(buffer);
    let about = "Records of all materials, as they are uploaded: little-endian, four floats of 32 bits for each word.";
    item(&mut text, about, "MATERIAL_BUFFER", "&[u8]", &include("bytes", buffer));

    let mut numbers = Vec::new();
    for (number, material) in manifest.materials.iter().enumerate() {
        numbers.push((identifier(&material.name)?, number, &material.name, &material.source));
        files.extend(material.maps.iter().map(|map| map.file.path.as_str()));
    }
    let names: Vec<&String> = manifest.materials.iter().map(|material| &material.name).collect();
    let mut inside = constants("LUTHIER_MATERIAL_", &numbers);
    let kind = format!("[&str; {}]", names.len());
    item(&mut inside, "Names of the materials, in the order of their numbers.", "NAMES", &kind, &format!("{names:?}"));
    module(&mut text, "Numbers of the materials in the shader.", "material", &inside);

    let mut numbers = Vec::new();
    for (number, surface) in manifest.surfaces.iter().enumerate() {
        numbers.push((surface_identifier(&surface.name)?, number, &surface.name, &surface.source));
    }
    if !numbers.is_empty() {
        let inside = constants("LUTHIER_SURFACE_", &numbers);
        module(&mut text, "Numbers of the surfaces in the shader.", "surface", &inside);
    }

    let mut inside = String::new();
    for shader in &manifest.shaders {
        let (form, target) = (shader.form.name(), shader.target);
        let name = format!("{form}_{}", target.name()).replace('-', "_").to_ascii_uppercase();
        let about = format!("The shader of the form `{form}` in the language `{}`.", target.name());
        let (kind, word) = if target == Target::SpirV { ("&[u8]", "bytes") } else { ("&str", "str") };
        item(&mut inside, &about, &name, kind, &include(word, &shader.file.path));
        files.push(&shader.file.path);
    }
    module(&mut text, "Shaders: functions only, which a program puts before its own text.", "shader", &inside);

    let mut inside = String::new();
    for table in &manifest.tables {
        let name = table.kind.name();
        let constant = name.replace('-', "_").to_ascii_uppercase();
        item(&mut inside, &format!("The table `{name}`."), &constant, "&[u8]", &include("bytes", &table.texture.path));
        files.push(&table.texture.path);
    }
    module(&mut text, "Tables: KTX2 files.", "table", &inside);

    let listed = files.iter().map(|path| format!("    ({path:?}, {}),\n", include("bytes", path)));
    let list = format!("&[\n{}]", listed.collect::<String>());
    let about = "All files that a program reads, by the paths that the manifest names.";
    item(&mut text, about, "FILES", "&[(&str, &[u8])]", &list);
    Ok(text)
}

/// Numbers by the constants that shaders have for them, without their prefix.
fn constants(prefix: &str, numbers: &[(String, usize, &String, &String)]) -> String {
    let mut text = String::new();
    for (constant, number, name, source) in numbers {
        let short = constant.strip_prefix(prefix).unwrap_or(constant);
        // A name of Rust begins with no digit.
        let digit = if short.starts_with(|c: char| c.is_ascii_digit()) { "_" } else { "" };
        item(&mut text, &format!("`{name}`, of {source}."), &format!("{digit}{short}"), "u32", &number.to_string());
    }
    text
}

fn module(text: &mut String, about: &str, name: &str, inside: &str) {
    let indented = |line: &str| if line.is_empty() { "\n".to_owned() } else { format!("    {line}\n") };
    let inside: String = inside.trim_start().lines().map(indented).collect();
    let _ = write!(
        text,
        "\n/// {about}\n#[allow(dead_code, reason = \"a program takes what it needs\")]\npub mod {name} {{\n{inside}}}\n"
    );
}

fn item(text: &mut String, about: &str, name: &str, kind: &str, value: &str) {
    let _ = write!(
        text,
        "\n/// {about}\n#[allow(dead_code, reason = \"a program takes what it needs\")]\npub const {name}: {kind} = {value};\n"
    );
}

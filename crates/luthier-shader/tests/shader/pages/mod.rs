//! The parts of the written pages that are made from the code. To write them anew, run with `LUTHIER_ACCEPT=1`.

mod words;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::scenes::{sets, tables};
use luthier_lut::TableKind;
use luthier_manifest::{FunctionGroup, LAYER_WORDS, MATERIAL_WORDS};
use luthier_shader::{Form, MaterialSet, RESERVED_BINDINGS, bindings};

/// Bindings of the environment.
const ENVIRONMENT: usize = 3;

/// Around a part that is made here.
const BEGIN: &str = "<!-- made by: LUTHIER_ACCEPT=1 cargo test -p luthier-shader pages -->\n";
const END: &str = "<!-- end -->\n";

/// Every number that a bake may bind.
fn numbers() -> String {
    let mut all = BTreeMap::new();
    for (_, materials) in sets() {
        // With every group of functions: the environment binds textures and a sampler of its own.
        let functions = FunctionGroup::ALL.into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
        all.extend(bindings(&set, Form::Baked).into_iter().map(|entry| (entry.binding, entry)));
    }
    let kept = TableKind::ALL.len() + 2;
    assert_eq!(
        all.len(),
        kept + ENVIRONMENT,
        "sets that read every table, the sampler, the buffer and the environment"
    );
    let mut out = String::from("| number | name | what |\n|---|---|---|\n");
    for (number, entry) in all {
        let what = match (entry.name.as_str(), entry.resource.as_str()) {
            ("luthier_environment_map", _) => {
                "blurred levels of the environment, a cube; where `--functions environment` is asked for"
            }
            ("luthier_irradiance_map", _) => "irradiance, a cube; as above",
            ("luthier_environment_sampler", _) => "linear, within mipmaps and between them; as above",
            (_, "buffer") => "the materials: `array<vec4<f32>>`",
            (_, "sampler") => "linear, clamp to edge, no mipmaps",
            _ => "table",
        };
        let _ = writeln!(out, "| {number} | `{}` | {what} |", entry.name);
    }
    let _ = writeln!(out, "| {RESERVED_BINDINGS} and above | yours | |");
    out
}

/// Rows of the table below a heading in the documentation of a source file of luthier-manifest, without links.
fn rows(file: &str, heading: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../luthier-manifest/src").join(file);
    let text = fs::read_to_string(&path).unwrap();
    let lines = text.lines().map(str::trim_start).skip_while(|line| *line != format!("/// {heading}"));
    let rows = lines.map_while(|line| line.strip_prefix("/// |"));
    rows.skip(2).map(|row| format!("|{row}\n").replace("[`", "`").replace("`]", "`")).collect()
}

/// Every word of the material buffer, as the functions that write them are documented.
fn words_of_buffer() -> String {
    let heading = "| header word | x, y, z, w |";
    let mut header = rows("buffer.rs", heading);
    // The other words are those of the constants.
    header.truncate(1);
    header.extend(rows("constants/mod.rs", heading));
    let layer = rows("record.rs", "| word | x, y, z, w |");
    assert_eq!([header.len(), layer.len()], [MATERIAL_WORDS, LAYER_WORDS]);
    let table = |word: &str, rows: Vec<String>| format!("| {word} | x, y, z, w |\n|---|---|\n{}", rows.concat());
    format!("{}\n{}", table("word of a material", header), table("word of a layer", layer))
}

/// The pages of a repository that have such parts, and the parts.
fn parts() -> [(&'static str, String); 2] {
    [("docs/bindings.md", numbers()), ("docs/manifest.md", words_of_buffer())]
}

#[test]
fn pages_say_what_the_code_says() {
    for (page, part) in parts() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(page);
        let text = fs::read_to_string(&path).unwrap().replace("\r\n", "\n");
        let (before, rest) = text.split_once(BEGIN).unwrap_or_else(|| panic!("{page} has no line {BEGIN}"));
        let (found, after) = rest.split_once(END).unwrap_or_else(|| panic!("{page} has no line {END}"));
        if std::env::var_os("LUTHIER_ACCEPT").is_some() {
            fs::write(&path, format!("{before}{BEGIN}{part}{END}{after}")).unwrap();
        } else {
            assert!(found == part, "{page} is out of date; it should have\n{part}");
        }
    }
}

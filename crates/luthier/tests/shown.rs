//! Every public item of the crate that a user meets has a running example, or a reason why it needs none.
//!
//! A function, a method or a type is shown by an example in its own docs, a method also by one in the docs of its type that calls it. Items of
//! other crates count where `lib.rs` gives them on, with the docs that stand there. Fields and variants are shown by their types.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Items without an example, each with the reason. An item that has an example or is gone may not stand here.
const REASONS: &[(&str, &[&str])] = &[
    (
        "facts about a material for crates that bake and judge; a program reads its model, images and places",
        &[
            "Material::adds_base",
            "Material::bare",
            "Material::beams",
            "Material::brightening",
            "Material::color",
            "Material::family",
            "Material::film_of_lobes",
            "Material::has_closed_film",
            "Material::has_further_bounces",
            "Material::has_side",
            "Material::is_bare_in_places",
            "Material::is_whole_in",
            "Material::reflecting_stack",
            "Material::reradiation",
            "Material::side",
            "Material::stack_of",
            "Material::unfit_for_lobes",
            "Material::weighs_film",
            "Material::weight",
        ],
    ),
    (
        "facts about a model for crates that bake and judge; `docs/grammar.md` has them for users",
        &[
            "ShadingModel::facts",
            "ShadingModel::heading_of",
            "ShadingModel::honours",
            "ShadingModel::limits",
            "ShadingModel::number",
            "ShadingModel::reads_some",
            "ShadingModel::takes",
            "ShadingModel::takes_masking",
        ],
    ),
    (
        "inputs and values of a function, which the example of the module `function` makes; the command and the Python module set the others",
        &[
            "Albedo",
            "Albedo::over",
            "Color::sparse_nodes",
            "Inputs",
            "Inputs::layer_maps",
            "Inputs::not_taken",
            "Inputs::shown",
            "Inputs::weight_map",
            "Kind",
            "Kind::columns",
            "Kind::parts",
            "LayerMap",
            "LiveValue",
            "parts",
            "textured",
        ],
    ),
    ("a bake makes it; programs read it", &["Manifest::new", "Manifest::files_mut", "Package::from_parts"]),
    ("has a default that does nothing, and `examples/editor.rs` shows it", &["Observer::found"]),
    ("has a default that calls `get`, for stores that are far away", &["Store::get_all", "Store::touch"]),
    (
        "a part of `Sources::refuse`, for programs that refuse materials by rules of their own",
        &["Sources::refuse_surfaces"],
    ),
    ("needs the file of a picture: `Folder::package` reads them all", &["Folder::map"]),
    ("a name for logs: the hash of the manifest", &["Folder::sha256"]),
];

/// Crates whose items `lib.rs` may give on, and crates that these take items from in turn.
const LOWER: [&str; 4] = ["luthier-export", "luthier-manifest", "luthier-model", "luthier-material"];

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Docs of items by name, methods as `Type::method`.
type Docs = BTreeMap<String, String>;

/// The sources of a crate, Rust alone.
fn sources(folder: &Path, texts: &mut Vec<String>) {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            sources(&path, texts);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            texts.push(fs::read_to_string(path).unwrap());
        }
    }
}

fn texts(name: &str) -> Vec<String> {
    let mut texts = Vec::new();
    sources(&crates().join(name).join("src"), &mut texts);
    texts
}

/// The name after one of some words, such as `pub fn`.
fn named<'l>(line: &'l str, words: &[&str]) -> Option<&'l str> {
    let rest = words.iter().find_map(|word| line.strip_prefix(word))?;
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    Some(&rest[..end]).filter(|name| !name.is_empty())
}

/// Reads the public items of a text, as rustfmt lays it out: members of types are indented once, tests come last.
fn read(text: &str, all: &mut Docs) {
    let (mut docs, mut owner, mut is_trait) = (String::new(), None::<String>, false);
    for line in text.lines().take_while(|line| *line != "mod tests {") {
        let bare = line.trim_start();
        if let Some(comment) = bare.strip_prefix("///") {
            docs.push_str(comment.strip_prefix(' ').unwrap_or(comment));
            docs.push('\n');
            continue;
        }
        if bare.starts_with("#[") {
            continue;
        }
        let is_member = line.starts_with("    ") && !line.starts_with("     ");
        let item = named(bare, &["pub struct ", "pub enum ", "pub type ", "pub trait "]);
        let function = named(bare, &["pub fn ", "pub const fn "]);
        if let Some(name) = item {
            all.insert(name.to_owned(), docs.clone());
            is_trait = bare.starts_with("pub trait ");
            owner = is_trait.then(|| name.to_owned());
        } else if let Some(rest) = line.strip_prefix("impl") {
            let of = rest.strip_prefix('<').map_or(rest, |rest| rest.split_once('>').map_or("", |(_, of)| of));
            owner = named(of, &[" "]).filter(|_| !line.contains(" for ")).map(str::to_owned);
        } else if let Some(name) = function {
            match &owner {
                Some(owner) if is_member => drop(all.insert(format!("{owner}::{name}"), docs.clone())),
                _ if !line.starts_with(' ') => drop(all.insert(name.to_owned(), docs.clone())),
                _ => {}
            }
        } else if let (true, true, Some(name), Some(owner)) = (is_trait, is_member, named(bare, &["fn "]), &owner) {
            all.insert(format!("{owner}::{name}"), docs.clone());
        }
        if line.starts_with('}') {
            (owner, is_trait) = (None, false);
        }
        docs.clear();
    }
}

/// The names of a `pub use`, which may go over several lines, with its path and the docs above it.
fn uses(text: &str) -> Vec<(String, Vec<String>, String)> {
    let (mut found, mut docs, mut open) = (Vec::new(), String::new(), None::<String>);
    for line in text.lines() {
        if let Some(statement) = &mut open {
            statement.push_str(line);
        } else if line.starts_with("pub use ") {
            open = Some(line.to_owned());
        } else if let Some(comment) = line.strip_prefix("///") {
            docs.push_str(comment.strip_prefix(' ').unwrap_or(comment));
            docs.push('\n');
            continue;
        } else if line.starts_with("#[") {
            continue;
        }
        if let Some(statement) = open.take_if(|statement| statement.ends_with(';')) {
            let (path, names) = statement["pub use ".len()..].trim_end_matches(';').rsplit_once("::").unwrap();
            let names = names.trim_matches(['{', '}']).split(',').map(|name| name.trim().to_owned());
            found.push((path.to_owned(), names.filter(|name| !name.is_empty()).collect(), docs.clone()));
        }
        if open.is_none() {
            docs.clear();
        }
    }
    found
}

/// The lines of code of all examples in a doc comment.
fn examples(docs: &str) -> String {
    docs.split("```").skip(1).step_by(2).collect::<Vec<_>>().join("\n")
}

/// Public items of the crate with their docs: its own, and those of other crates that it gives on.
fn items() -> Docs {
    let mut own = Docs::new();
    texts("luthier").iter().for_each(|text| read(text, &mut own));
    let root = fs::read_to_string(crates().join("luthier/src/lib.rs")).unwrap();
    let refusals = fs::read_to_string(crates().join("luthier/src/refusals/mod.rs")).unwrap();
    let function = fs::read_to_string(crates().join("luthier/src/function/mod.rs")).unwrap();
    let modules: Vec<&str> = root.lines().filter(|line| line.starts_with("pub mod ")).collect();
    assert_eq!(modules, ["pub mod function;", "pub mod refusals;"]);

    let mut all = Docs::new();
    for (path, names, docs) in [uses(&root), uses(&refusals), uses(&function)].concat() {
        let lower = path.split("::").next().unwrap_or_default().replace('_', "-");
        let mut known = Docs::new();
        if lower.starts_with("luthier-") {
            let homes = std::iter::once(lower.as_str()).chain(LOWER);
            for text in homes.flat_map(texts) {
                let mut here = Docs::new();
                read(&text, &mut here);
                // The first crate that has a name is the one that is meant.
                here.retain(|name, _| !known.contains_key(name));
                known.append(&mut here);
            }
        } else {
            known.clone_from(&own);
        }
        for name in names {
            let about = known.get(&name).unwrap_or_else(|| panic!("`{name}` of `{path}` is nowhere"));
            all.insert(name.clone(), format!("{docs}\n{about}"));
            let of_type = format!("{name}::");
            all.extend(
                known.iter().filter(|(other, _)| other.starts_with(&of_type)).map(|(n, d)| (n.clone(), d.clone())),
            );
        }
    }
    all
}

#[test]
fn every_public_item_has_an_example_or_a_reason() {
    let items = items();
    let is_shown = |name: &str| {
        let code = examples(&items[name]);
        let of_type = |(owner, method): (&str, &str)| examples(&items[owner]).contains(&format!("{method}("));
        !code.trim().is_empty() || name.split_once("::").is_some_and(of_type)
    };
    let missing: BTreeSet<&str> = items.keys().map(String::as_str).filter(|name| !is_shown(name)).collect();
    let excused: BTreeSet<&str> = REASONS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
    let unexplained: Vec<_> = missing.difference(&excused).collect();
    assert!(unexplained.is_empty(), "no example and no reason: {unexplained:#?}");
    let idle: Vec<_> = excused.difference(&missing).collect();
    assert!(idle.is_empty(), "they have an example, or are gone: {idle:#?}");
    eprintln!(
        "{} items: {} with an example, {} with a reason",
        items.len(),
        items.len() - missing.len(),
        missing.len()
    );
    assert!(items.len() > 150, "{} items: the reader of sources misses some", items.len());
}

/// The reader of sources on a text with all that it has to know.
#[test]
fn the_reader_finds_items_with_their_docs() {
    let text = "/// A.\n///\n/// ```\n/// a.size(); a.len()\n/// ```\n#[derive(Debug)]\npub struct A<'a> {\n    /// Field.\n    pub b: u32,\n}\n\n\
                impl<'a> A<'a> {\n    /// Size.\n    pub fn size(&self) {}\n\n    pub(crate) fn hidden() {}\n}\n\nimpl Default for A<'_> {\n    fn default() {}\n}\n\n\
                /// T.\npub trait T {\n    /// One.\n    fn one(&self);\n}\n\nfn own() {}\n\n/// F.\npub fn f() {}\n\nmod tests {\n    pub fn g() {}\n}\n";
    let mut all = Docs::new();
    read(text, &mut all);
    assert_eq!(all.keys().collect::<Vec<_>>(), ["A", "A::size", "T", "T::one", "f"]);
    assert_eq!((all["T::one"].as_str(), examples(&all["A"]).trim()), ("One.\n", "a.size(); a.len()"));
    let statement = "/// Docs.\n#[doc(inline)]\npub use a_b::{\n    C, D,\n};\npub use e::F;\n";
    let expected = [("a_b", vec!["C", "D"], "Docs.\n"), ("e", vec!["F"], "")];
    let owned = |(path, names, docs): (&str, Vec<&str>, &str)| {
        (path.to_owned(), names.into_iter().map(str::to_owned).collect(), docs.to_owned())
    };
    assert_eq!(uses(statement), expected.map(owned));
}

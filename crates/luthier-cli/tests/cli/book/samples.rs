//! TOML of the pages: whole files, and parts of files in a whole one, pass `luthier check`.

use std::fs;
use std::path::Path;

use luthier_workshop::root;

use super::pages::{Block, Page, pages};
use crate::workshop::Workshop;

/// What a part of a file needs around it.
const HEAD: &str = "schema = 1\nname = \"part\"\n";
const LAYERS: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nroughness = 0.2\n[[layer]]\ntype = \"conductor\"\nior = \"al\"\n\
                      roughness = 0.4\n";

/// Files that samples name.
const FILES: [(&str, &str); 8] = [
    ("rays.png", "rays.png"),
    ("circles.png", "circles.png"),
    ("dents.png", "bumps.png"),
    ("heights.png", "heights.png"),
    ("heat.png", "thickness.png"),
    ("packed.png", "paint.png"),
    ("wood.jpg", "paint.png"),
    ("dye.csv", "dye.csv"),
];

/// A folder with the materials of the repository, and files that samples name beside each other.
fn workshop() -> Workshop {
    let workshop = Workshop::new();
    let mut folders = vec![root().join("materials")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned();
                workshop.write(&name, fs::read(&path).unwrap());
            }
        }
    }
    for (name, map) in FILES {
        workshop.write(name, fs::read(root().join("crates/luthier-lab/maps").join(map)).unwrap());
    }
    workshop
}

/// A file in which a block stands, and its text; `None` for TOML that is none of luthier.
fn file(page: &Page, block: &Block<'_>) -> Option<(String, String)> {
    let stem = format!("{}-{}", Path::new(&page.name).file_stem().unwrap().to_str().unwrap(), block.line);
    let begins = |key: &str| block.text.lines().any(|line| line.starts_with(key));
    let text = &block.text;
    Some(if begins("schema =") {
        (format!("{stem}.toml"), text.clone())
    } else if begins("scene =") {
        (format!("materials/scenes/{stem}.toml"), text.clone())
    } else if begins("surface =") {
        (format!("materials/surfaces/{stem}.toml"), text.clone())
    } else if begins("[[layer]]") {
        (format!("{stem}.toml"), format!("{HEAD}{text}"))
    } else if begins("[effects") || begins("[bake") {
        (format!("{stem}.toml"), format!("{HEAD}{LAYERS}{text}"))
    } else if begins("[budget]") {
        // Limits on lobes are for that model, the default of two layers.
        (format!("{stem}.toml"), format!("{HEAD}{LAYERS}{text}"))
    } else {
        return None;
    })
}

/// Every block of TOML is about luthier, and in order.
#[test]
fn toml_of_pages_passes_check() {
    let workshop = workshop();
    let (mut count, mut failures) = (0, String::new());
    for page in pages() {
        for block in page.blocks().iter().filter(|block| block.language == "toml") {
            let (name, text) = file(&page, block).unwrap_or_else(|| panic!("{}:{} is no file", page.name, block.line));
            workshop.write(&name, text);
            let run = workshop.run(&["check", &name]);
            // The tutorial has a file whose mistakes it explains.
            let expected = if block.above.ends_with("`wrong.toml`:") { 1 } else { 0 };
            if run.code != Some(expected) {
                failures += &format!("{}:{}\n{}\n", page.name, block.line, run.stderr);
            }
            count += 1;
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(count > 25, "{count} samples");
}

/// The README says how many bytes its example has.
#[test]
fn the_readme_counts_its_bake() {
    let pages = pages();
    let page = pages.iter().find(|page| page.name == "README.md").unwrap();
    let blocks = page.blocks();
    let example = blocks.iter().find(|block| block.language == "toml").unwrap();
    let workshop = Workshop::with(&[("enamel.toml", &example.text)]);
    let made = workshop.run(&["bake", "enamel.toml", "--out", "luts", "--no-zstd", "--json"]).exits(0).json();
    let tables = made["tables"].as_array().unwrap();
    let [table] = tables.as_slice() else { panic!("{tables:?}") };
    let bytes = table["texel_bytes"].as_u64().unwrap();
    let said = format!("one texture of {},{:03} bytes", bytes / 1000, bytes % 1000);
    assert!(page.text.contains(&said), "README.md does not say: {said}");
}

/// Recipes are shown as they stand: each has a picture of its name, which `luthier preview` still makes.
#[test]
fn recipes_look_as_pictured_and_have_no_warnings() {
    let workshop = workshop();
    let pages = pages();
    let page = pages.iter().find(|page| page.name == "docs/recipes.md").unwrap();
    let mut count = 0;
    for block in page.blocks().iter().filter(|block| block.language == "toml") {
        workshop.write("recipe.toml", &block.text);
        let run = workshop.run(&["check", "--json", "recipe.toml"]).exits(0).json();
        assert_eq!(run[0]["diagnostics"], serde_json::json!([]), "line {}", block.line);
        let name = run[0]["material"]["name"].as_str().unwrap();
        let picture = format!("images/recipes/{name}.png");
        assert!(page.links().contains(&picture.as_str()), "no picture {picture}");
        #[cfg(feature = "gpu")]
        {
            let arguments = ["preview", "recipe.toml", "--shape", "sphere", "--size", "160", "-o", "made.png"];
            let run = workshop.run(&arguments);
            if run.lacks_adapter() {
                return;
            }
            run.exits(0);
            super::pages::assert_alike(&workshop.path("made.png"), &page.folder().join(picture));
        }
        count += 1;
    }
    assert!(count >= 8, "{count} recipes");
}

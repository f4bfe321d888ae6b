//! Files to begin with: each is what its list, its comments and its sources say.

use std::collections::BTreeSet;
use std::path::Path;

use luthier_material::{Material, SurfaceClass, Template, parse};
use luthier_optics::constants::dataset;

fn material(template: &Template) -> Material {
    let parsed = parse(template.name, template.text, &|_| Err(std::io::ErrorKind::NotFound.into()));
    let parsed = parsed.unwrap_or_else(|errors| panic!("{}: {errors:?}", template.name));
    assert!(parsed.warnings.is_empty(), "{}: {:?}", template.name, parsed.warnings);
    assert_eq!(parsed.material.name, template.name);
    parsed.material
}

#[test]
fn every_file_of_the_folder_is_listed() {
    for (folder, templates) in [("classes", Template::CLASSES), ("presets", Template::PRESETS)] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("templates").join(folder);
        let there = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let listed: BTreeSet<String> = templates.iter().map(|template| format!("{}.toml", template.name)).collect();
        assert_eq!(there.collect::<BTreeSet<_>>(), listed, "{folder}");
        assert!(templates.iter().all(|template| template.description().ends_with('.')), "{folder}");
    }
    assert!(Template::PRESETS.is_sorted_by_key(|preset| preset.name));
}

#[test]
fn a_class_is_that_of_its_name() {
    assert_eq!(Template::CLASSES.len(), SurfaceClass::ALL.len());
    for (template, class) in Template::CLASSES.iter().zip(SurfaceClass::ALL) {
        assert_eq!(template.name, class.name().to_lowercase().replace(' ', "-"));
        assert_eq!(material(template).class, class, "{}", template.name);
    }
}

/// Each data set that a preset names has its papers among the references, and there are no others.
#[test]
fn a_preset_names_the_sources_of_its_numbers() {
    for preset in Template::PRESETS {
        let indices = preset.text.lines().filter_map(|line| line.strip_prefix("ior = \"")?.strip_suffix('"'));
        let mut expected = BTreeSet::new();
        for id in indices {
            let set = dataset(id).unwrap_or_else(|| panic!("{}: {id}", preset.name));
            let mut papers: Vec<String> = set.citation.split("; k: ").map(str::to_owned).collect();
            if !set.doi.is_empty() {
                papers[0] = format!("{}, doi:{}", papers[0], set.doi);
            }
            expected.extend(papers);
            assert!(preset.text.contains(&format!("`luthier ior {id}`")), "{}: {id}", preset.name);
        }
        assert!(!expected.is_empty());
        assert_eq!(material(preset).references.into_iter().collect::<BTreeSet<_>>(), expected, "{}", preset.name);
    }
}

#[test]
fn a_name_is_that_of_the_material() {
    for template in Template::CLASSES.iter().chain(Template::PRESETS) {
        let text = template.called("a-1").unwrap();
        assert_eq!(text.replace("\nname = \"a-1\"\n", &format!("\nname = \"{}\"\n", template.name)), template.text);
    }
    let long = "a".repeat(200);
    for wrong in ["", "-a", "a b", "a.toml", "../a", "ä", "a\"\nname = \"b", "a\\u0062", long.as_str()] {
        assert!(Template::CLASSES[0].called(wrong).is_err(), "{wrong}");
    }
}

//! Models in the sources: crates ask a model for its facts, and few files name single models.

use std::collections::BTreeSet;

use luthier_workshop::root;

use super::sources::sources;

/// Files that name single models, tests and the project's own pages apart.
const NAMING: [(&str, &str); 20] = [
    ("cli/src/simulated.rs", "takes the cheapest model where only stacks count"),
    ("cli/src/verb/bench/", "times everything over Phong's model"),
    ("cli/src/verb/gallery/page.rs", "shows a second model beside that of the file"),
    ("crates/luthier/src/function/inputs.rs", "names the model that could show what another drops"),
    ("crates/luthier/src/refusals/energy.rs", "names the model that returns what the simulation does"),
    ("layers/src/models/belcour/mod.rs", "is the model"),
    ("layers/src/models/elek/mod.rs", "is the model"),
    ("layers/src/models/granier_heidrich/mod.rs", "is the model"),
    ("layers/src/models/lobes/mod.rs", "is the model"),
    ("layers/src/models/lobes/tests/", "are tests of the model"),
    ("layers/src/models/microfacet/mod.rs", "is the model"),
    ("layers/src/models/mod.rs", "has the doors of rooms"),
    ("layers/src/models/phong/mod.rs", "is the model"),
    ("layers/src/models/weidlich_wilkie/mod.rs", "is the model"),
    ("layers/src/models/yamaguchi/mod.rs", "is the model"),
    ("layers/src/twins/shaded/mod.rs", "has Elek's mean of slope parameters, and rows of lobes at a place"),
    ("material/src/default_model.rs", "says what keeps a material from the best model"),
    ("material/src/doubt.rs", "says what two models do with a smooth layer below a rough one"),
    ("report/src/models/colored.rs", "takes one facet for the first bounce"),
    ("scene/src/director.rs", "leaves costs out where rows are not baked"),
];

/// Whether code of a file, tests apart, names a single model.
fn names_a_model(text: &str) -> bool {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let mut lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let single = |rest: &str| {
        let word: String = rest.chars().take_while(|c| c.is_alphanumeric()).collect();
        let model = luthier_manifest::ShadingModel::ALL.into_iter().find(|model| format!("{model:?}") == word);
        model.is_some()
    };
    lines.any(|line| line.split("ShadingModel::").skip(1).any(single))
}

#[test]
fn few_files_name_single_models() {
    let is_test = |name: &str| name.ends_with("/tests.rs") || name.ends_with("_tests.rs");
    let all = sources().into_iter().filter(|(name, _)| !name.starts_with("crates/luthier-lab/") && !is_test(name));
    let found: BTreeSet<String> =
        all.filter(|(_, text)| names_a_model(text)).map(|(name, _)| name.replace("crates/luthier-", "")).collect();
    for name in &found {
        let is_listed = NAMING.iter().any(|(listed, _)| name.starts_with(listed));
        assert!(is_listed, "{name} names single models: ask `ShadingModel::facts`, or say here what it is");
    }
    for (listed, _) in NAMING {
        assert!(found.iter().any(|name| name.starts_with(listed)), "{listed} names no model any more");
    }
}

/// Files of a patch, new ones apart, with the lines of each change that are there before it.
fn changed(patch: &str) -> (BTreeSet<String>, Vec<(String, Vec<String>)>) {
    let (mut new, mut changes) = (BTreeSet::new(), Vec::new());
    for file in patch.split("diff --git ").skip(1) {
        let name = file.lines().next().unwrap().split(" b/").nth(1).unwrap().to_owned();
        if file.contains("\nnew file mode ") {
            new.insert(name);
            continue;
        }
        for change in file.split("\n@@ ").skip(1) {
            let before = change.lines().skip(1).filter(|line| !line.starts_with('+')).map(|line| line[1..].to_owned());
            changes.push((name.clone(), before.collect()));
        }
    }
    (new, changes)
}

/// `scripts/add-model.sh` builds what the patch makes, in the nightly step `kind`.
#[test]
fn a_model_is_one_folder_and_one_row() {
    let patch = std::fs::read_to_string(root().join("scripts/add-model.patch")).unwrap();
    let (new, changes) = changed(&patch);
    let folders: BTreeSet<&str> = new.iter().filter_map(|file| Some(file.rsplit_once('/')?.0)).collect();
    assert_eq!(folders.into_iter().collect::<Vec<_>>(), ["crates/luthier-layers/src/models/neumann"]);
    let files: BTreeSet<&str> = changes.iter().map(|(file, _)| file.as_str()).collect();
    let expected = ["crates/luthier-layers/src/models/mod.rs", "crates/luthier-model/src/rows.rs"];
    assert_eq!(files.into_iter().collect::<Vec<_>>(), expected);
    for (file, before) in &changes {
        let text = std::fs::read_to_string(root().join(file)).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let is_there = lines.windows(before.len()).any(|window| window == before.as_slice());
        assert!(is_there, "scripts/add-model.patch does not apply to {file}: {before:#?}");
    }
}
